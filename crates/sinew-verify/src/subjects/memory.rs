//! Stress that relaxes by a Prony series, under a given strain.

use std::f64::consts::TAU;

use sinew_core::vectors::largest;
use sinew_core::{Inputs, State, System};
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::hyperelastic::prony::{Symmetric, Term, stress, tangent_factor};
use sinew_fem::hyperelastic::{LawError, Tensor};
use sinew_fem::{Element, FibreFamily, Memory, Model, Moduli, ViscousPart};

use crate::bodies::{YOUNGS_MODULUS, of_law};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::sources::PROTOTYPE_OF_MOTIONS;
use crate::subject::Subject;
use crate::tissue::law;
use crate::uniform::{ELEMENTS, Uniform, name};

pub(super) const SUBJECT: Subject = Subject {
    id: "memory",
    title: "Stress that relaxes",
    says: "One dimension, E = 3500 Pa at once, shares .3 and .2 that relax in .05 s and .5 s. Stresses (Pa) at t = 1 s, and the moduli (Pa) of a \
           strain that swings at 2 Hz.",
    checks,
    quoted: &[],
};

const TERMS: [Term; 2] = [
    Term {
        share: 0.3,
        time: 0.05,
    },
    Term {
        share: 0.2,
        time: 0.5,
    },
];

/// `E sum g tau (1 - e^-t/tau) + ..` for a strain that grows linearly, `E (1 - sum g (1 - e^-t/tau))` for a constant
/// one.
const INTEGRAL: Source = Source::ClosedForm(
    "the hereditary integral of the series; Simo and Hughes, Computational Inelasticity, section 10.3",
);

/// The stress (Pa) due to strains, with history variables.
#[derive(Default)]
struct Material {
    strain: f64,
    memories: [Symmetric<f64>; 2],
}

fn along(value: f64) -> Symmetric<f64> {
    [value, 0.0, 0.0, 0.0, 0.0, 0.0]
}

impl Material {
    /// A step of `dt` (s) to another strain; `dt = 0` for a jump.
    fn step(&mut self, dt: f64, strain: f64) -> f64 {
        let change = along(YOUNGS_MODULUS * (strain - self.strain));
        self.strain = strain;
        for (memory, term) in self.memories.iter_mut().zip(&TERMS) {
            *memory = term.over(dt).next(*memory, change);
        }
        stress(&TERMS, along(YOUNGS_MODULUS * strain), &self.memories)[0]
    }
}

fn grown(steps: u32) -> f64 {
    let mut material = Material::default();
    let dt = 1.0 / f64::from(steps);
    let stresses = (1..=steps).map(|step| material.step(dt, 0.1 * f64::from(step) * dt));
    stresses.last().unwrap_or(f64::NAN)
}

fn held(steps: u32, jumps: bool) -> f64 {
    let mut material = Material::default();
    if jumps {
        material.step(0.0, 0.1);
    }
    let dt = 1.0 / f64::from(steps);
    let stresses = (0..steps).map(|_| material.step(dt, 0.1));
    stresses.last().unwrap_or(f64::NAN)
}

/// Storage and loss modulus (Pa) in the tenth second at 2 Hz.
fn swung(per_second: u32) -> [f64; 2] {
    let mut material = Material::default();
    let (mut storage, mut loss) = (0.0, 0.0);
    for step in 1..=10 * per_second {
        let t = f64::from(step) / f64::from(per_second);
        let (sine, cosine) = (2.0 * TAU * t).sin_cos();
        let stress = material.step(1.0 / f64::from(per_second), sine);
        if step > 9 * per_second {
            storage += 2.0 * stress * sine / f64::from(per_second);
            loss += 2.0 * stress * cosine / f64::from(per_second);
        }
    }
    [storage, loss]
}

/// The moduli at 2 Hz: `E (1 - sum g + sum g x^2/(1 + x^2))` and `E sum g x/(1 + x^2)`, x = w tau (Ferry, Viscoelastic
/// Properties of Polymers, chapter 3).
fn moduli() -> [f64; 2] {
    let part = |term: &Term| {
        let x = 2.0 * TAU * term.time;
        [x * x, x].map(|of| term.share * of / (1.0 + x * x))
    };
    let parts = TERMS.map(|term| part(&term));
    let [storage, loss] = [0, 1].map(|k| parts.iter().map(|part| part[k]).sum::<f64>());
    let stays = 1.0 - TERMS.iter().map(|term| term.share).sum::<f64>();
    [YOUNGS_MODULUS * (stays + storage), YOUNGS_MODULUS * loss]
}

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for (name, steps) in [
        ("strain of .1/s, in 10 steps", 10),
        ("strain of .1/s, in 100 steps", 100),
        ("strain of .1/s, in 1000 steps", 1000),
    ] {
        let asked = Asked::value(210.513_265_076, 1e-9);
        checks.push(Check::one(
            name,
            "stress (Pa)",
            asked,
            INTEGRAL,
            move |_| Ok(grown(steps)),
        ));
    }
    for (name, steps) in [
        ("strain of .1 at once, then 1 step", 1),
        ("strain of .1 at once, then 100 steps", 100),
    ] {
        let asked = Asked::value(184.473_470_043, 1e-9);
        checks.push(Check::one(
            name,
            "stress (Pa)",
            asked,
            INTEGRAL,
            move |_| Ok(held(steps, true)),
        ));
    }
    for (name, steps, stress) in [
        ("strain of .1 over a step of .1 s", 10, 185.487_262),
        ("strain of .1 over a step of .01 s", 100, 184.568_839),
        ("strain of .1 over a step of .001 s", 1000, 184.482_950),
    ] {
        let asked = Asked::value(stress, 1e-6);
        let check = Check::one(
            name,
            "stress (Pa)",
            asked,
            PROTOTYPE_OF_MOTIONS,
            move |_| Ok(held(steps, false)),
        );
        checks.push(check.noted("what a jump costs that is taken for a step: order 1"));
    }
    let [storage, loss] = moduli();
    let figures = [
        ("storage modulus (Pa)", Asked::value(storage, 2e-3)),
        ("loss modulus (Pa)", Asked::value(loss, 2e-3)),
    ];
    checks.push(Check::several(
        "strain at 2 Hz, in steps of .0002 s",
        figures,
        Source::ClosedForm("E (1 - sum g + sum g x^2/(1 + x^2)) and E sum g x/(1 + x^2), x = w tau; Ferry, Viscoelastic Properties of Polymers, chapter 3"),
        |_| Ok(swung(5000).into()),
    ));
    let figures = [
        ("storage modulus (Pa)", Asked::value(2_730.914, 1e-3)),
        ("loss modulus (Pa)", Asked::value(580.890, 1e-3)),
    ];
    checks.push(Check::several(
        "strain at 2 Hz, in steps of .01 s",
        figures,
        PROTOTYPE_OF_MOTIONS,
        |_| Ok(swung(100).into()),
    ));
    checks.push(Check::one(
        "slope of the stress at the end of a step of .01 s",
        "over that at once",
        Asked::value(0.969_917_137, 1e-9),
        Source::ClosedForm("1 - sum g + sum g (1 - e^-x)/x, x = dt/tau"),
        |_| Ok(tangent_factor(&TERMS, 0.01)),
    ));
    let off = |is_within: f64| {
        (
            "largest stress off, of the largest",
            Asked::at_most(is_within),
        )
    };
    for element in ELEMENTS {
        let of = name(element);
        for steps in [1, 10, 400] {
            checks.push(Check::several(
                format!("{of}, fibres, strained at once and held for 1 s in {steps} steps"),
                [off(1e-12)],
                INTEGRAL,
                move |_| Ok(vec![held_body(element, steps)?]),
            ));
        }
        for id in ["neo-hookean-iso", "mooney-rivlin"] {
            checks.push(Check::several(
                format!("{id}, {of}, deviatoric stress alone relaxes for .4 s"),
                [off(1e-12)],
                INTEGRAL,
                move |_| Ok(vec![pressure_stays(id, element)?]),
            ));
        }
        for steps in [10, 100] {
            checks.push(Check::several(
                format!("stvk, {of}, Green's strain of .1/s, in {steps} steps"),
                [off(1e-11)],
                INTEGRAL,
                move |_| Ok(vec![grown_body(element, steps)?]),
            ));
        }
    }
    checks
}

/// A gradient of the displacement that stretches, shears and rotates.
const STRAINED: Tensor<f64> = Tensor([[0.2, 0.3, 0.0], [0.0, -0.1, 0.0], [0.1, 0.0, 0.05]]);

/// A body of a law whose stress relaxes, at rest.
fn relaxing(
    id: &'static str,
    element: Element,
    part: ViscousPart,
    with_fibres: bool,
) -> Result<(Uniform, State), LabError> {
    let mut problem = of_law(law(id, YOUNGS_MODULUS, 0.45), element);
    problem.regions[0].tissue.memory = Some(Memory {
        terms: TERMS.into(),
        part,
        moduli: Moduli::Instantaneous,
    });
    if with_fibres {
        let fibres = Fibres::new(Stiffening::Quadratic { eta: 2000.0 });
        problem.regions[0].tissue.fibres = vec![FibreFamily::new(
            fibres.map_err(LawError::from)?,
            [1.0, 0.0, 2.0],
        )];
    }
    let body = Uniform::new(&problem, STRAINED)?;
    let mut state = State::at_rest(body.u.len());
    state.internal = vec![0.0; body.model.internal_variables()];
    Ok((body, state))
}

fn stresses(model: &Model, state: &State) -> Result<Vec<[f64; 6]>, LabError> {
    let mut stress = vec![[0.0; 6]; model.mesh().tets.len()];
    let asked = model.with_memory(&state.internal);
    asked.stress(0.0, &state.u, &mut stress)?;
    Ok(stress)
}

/// The largest difference of two stresses over the largest of the second.
fn apart(found: &[[f64; 6]], expected: &[[f64; 6]]) -> f64 {
    let pairs = found.as_flattened().iter().zip(expected.as_flattened());
    let differences: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
    largest(&differences) / largest(expected.as_flattened())
}

/// The share of a stress that remains at a time (s) after a step of strain.
fn left(t: f64) -> f64 {
    let lost = TERMS
        .iter()
        .map(|term| term.share * (1.0 - f64::exp(-t / term.time)));
    1.0 - lost.sum::<f64>()
}

fn held_body(element: Element, steps: u32) -> Result<f64, LabError> {
    let (body, mut state) = relaxing("neo-hookean", element, ViscousPart::All, true)?;
    state.u.clone_from(&body.u);
    // Not uniform, so that averages over edges and patches matter.
    let waves = state.u.iter_mut().enumerate();
    waves.for_each(|(dof, u)| *u += 1e-3 * (1.7 * dof as f64).sin());
    body.model.accept(&mut state, Inputs::none(), 0.0)?;
    let first = stresses(&body.model, &state)?;
    for _ in 0..steps {
        body.model
            .accept(&mut state, Inputs::none(), 1.0 / f64::from(steps))?;
    }
    let expected: Vec<_> = first.iter().map(|s| s.map(|s| left(1.0) * s)).collect();
    Ok(apart(&stresses(&body.model, &state)?, &expected))
}

fn pressure_stays(id: &'static str, element: Element) -> Result<f64, LabError> {
    let (body, mut state) = relaxing(id, element, ViscousPart::Deviatoric, false)?;
    state.u.clone_from(&body.u);
    body.model.accept(&mut state, Inputs::none(), 0.0)?;
    let first = stresses(&body.model, &state)?;
    body.model.accept(&mut state, Inputs::none(), 0.4)?;
    let expected = first.iter().map(|stress| {
        let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
        std::array::from_fn(|k| {
            let pressure = if k < 3 { mean } else { 0.0 };
            pressure + left(0.4) * (stress[k] - pressure)
        })
    });
    let expected: Vec<[f64; 6]> = expected.collect();
    Ok(apart(&stresses(&body.model, &state)?, &expected))
}

/// A second Piola-Kirchhoff stress that grows linearly.
fn grown_body(element: Element, steps: u32) -> Result<f64, LabError> {
    let (body, mut state) = relaxing("stvk", element, ViscousPart::All, false)?;
    let points = &body.model.mesh().points;
    for step in 1..=steps {
        let stretch = f64::sqrt(1.0 + 0.2 * f64::from(step) / f64::from(steps)) - 1.0;
        let field: Vec<_> = points
            .iter()
            .map(|[x, ..]| [stretch * x, 0.0, 0.0])
            .collect();
        body.model.to_dofs(&field, &mut state.u)?;
        body.model
            .accept(&mut state, Inputs::none(), 1.0 / f64::from(steps))?;
    }
    let elastic = of_law(law("stvk", YOUNGS_MODULUS, 0.45), element);
    let elastic = Uniform::new(&elastic, STRAINED)?.model;
    let mut full = vec![[0.0; 6]; elastic.mesh().tets.len()];
    elastic.stress(0.0, &state.u, &mut full)?;
    let grown: f64 = TERMS.iter().fold(1.0, |left, term| {
        left - term.share * (1.0 - term.time * (1.0 - f64::exp(-1.0 / term.time)))
    });
    let expected: Vec<_> = full.iter().map(|s| s.map(|s| grown * s)).collect();
    Ok(apart(&stresses(&body.model, &state)?, &expected))
}

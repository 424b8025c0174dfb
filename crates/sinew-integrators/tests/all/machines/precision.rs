//! Systems and options for which single precision is refused.

use crate::common::cube::{cube, mass_damping, scene};
use crate::common::{build, plain, sliver};
use sinew_core::{
    Equations, EvaluationError, ForceLaw, Layers, LoadTime, OptionError, Revision, SetupError,
    State, System, Trial,
};
use sinew_fem::{Law, Model, Problem, Region};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers};

/// A mass on a string of 1 m.
struct Pendulum {
    mass: [f64; 1],
    revision: Revision,
}

impl System for Pendulum {
    fn dofs(&self) -> usize {
        1
    }
    fn layers(&self) -> Layers {
        Layers::One
    }
    fn mass(&self) -> &[f64] {
        &self.mass
    }
    fn revision(&self) -> Revision {
        self.revision
    }
    fn equations(&self) -> Equations<'_> {
        Equations::Forces(self)
    }
}

impl ForceLaw for Pendulum {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        out[0] = -9.81 * self.mass[0] * trial.u[0].sin();
        Ok(())
    }
    fn external_force(&self, _when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out[0] = 0.0;
    }
}

#[test]
fn an_error_below_its_rounding_is_refused() {
    let system = cube(3);
    let of = |tolerance: f64| {
        let options = plain()
            .with_text("precision", "f32")
            .with_number("tolerance", tolerance);
        build("propagator", &options).prepare(&system, 1e-3)
    };
    let refused = of(1e-8).unwrap_err();
    assert!(
        matches!(refused, SetupError::Rounding { asked: 1e-8, .. }),
        "{refused}"
    );
    assert_eq!(
        refused.to_string(),
        "`propagator`: f32 may be off by 5e-5, more than the tolerance of 1e-8; take precision = \"f64\", or a \
         tolerance from 5e-5 on"
    );
    assert!(of(1e-3).is_ok());
}

#[test]
fn steps_that_are_no_program_are_refused() {
    let options = plain()
        .with_text("precision", "f32")
        .with_text("kind", "krylov")
        .with_number("tolerance", 1e-3);
    let refused = build("propagator", &options).prepare(&cube(3), 1e-3);
    assert!(
        matches!(refused, Err(SetupError::SinglePrecision { .. })),
        "{refused:?}"
    );
}

#[test]
fn other_words_than_those_listed_are_refused() {
    for (key, word) in [
        ("precision", "f16"),
        ("machine", "gpu"),
        ("threads", "many"),
    ] {
        let refused = sinew_integrators::build("rk4", &plain().with_text(key, word)).err();
        assert!(
            matches!(&refused, Some(OptionError::Value { .. })),
            "{refused:?}"
        );
    }
    let refused = sinew_integrators::build("rk4", &plain().with_number("threads", 0.0)).err();
    assert!(refused.is_some());
}

#[test]
fn the_plain_loops_do_not_pass_for_single_precision() {
    let options = plain()
        .with_text("precision", "f32")
        .with_text("machine", "reference");
    let refused = sinew_integrators::build("rk4", &options).err().unwrap();
    assert!(
        refused
            .to_string()
            .contains("in which machine = \"reference\" computes"),
        "{refused}"
    );
}

#[test]
fn a_run_says_on_which_kernel_it_is() {
    let system = cube(3);
    let kernel = |precision: &str, machine: &str| {
        let options = plain()
            .with_text("precision", precision)
            .with_text("machine", machine);
        let mut method = build("central-difference", &options);
        let mut state = State::at_rest(system.dofs());
        method.step(&system, &mut state, 1e-4).unwrap();
        method.kernel().unwrap()
    };
    assert_eq!(kernel("f64", "reference"), "reference");
    assert!(kernel("f64", "general").starts_with("general f64 "));
    assert!(kernel("f32", "repeated").starts_with("repeated f32 "));
}

#[test]
fn nearly_incompressible_tissue_rounds_more_and_says_how_much() {
    let tissue = |poissons_ratio: f64| {
        let law = Law::linear(3500.0, poissons_ratio);
        scene(3, 0.1, law, mass_damping(20.0))
    };
    let prepared = |system: &Model, tolerance: f64| {
        let options = plain()
            .with_text("precision", "f32")
            .with_number("tolerance", tolerance);
        let mut method = sinew_integrators::build("propagator", &options).unwrap();
        method
            .prepare(system, 1e-3)
            .map(|_| method.computed_by().join("; "))
    };
    // (lambda + 2 mu)/mu = 2 (1 - nu)/(1 - 2 nu), 501 at nu = .499.
    let stiff = tissue(0.499);
    let refused = prepared(&stiff, 3e-4).unwrap_err();
    assert!(
        matches!(refused, SetupError::Rounding { expected, .. } if (expected / 7.47e-4 - 1.0).abs() < 0.01),
        "{refused}"
    );
    let said = prepared(&stiff, 1e-3).unwrap();
    assert!(said.contains("off by about 7.5e-4 of their size"), "{said}");
    let said = prepared(&tissue(0.45), 3e-4).unwrap();
    assert!(said.contains("off by about 5.0e-5 of their size"), "{said}");
}

#[test]
fn machines_that_do_not_fit_are_refused_and_none_takes_their_place() {
    let refused = |id: &str, key: &str, word: &str, system: &dyn System| {
        let options = plain().with_text(key, word);
        let refused = build(id, &options).prepare(system, 1e-4).unwrap_err();
        assert!(matches!(refused, SetupError::Machine { .. }), "{refused:?}");
        refused.to_string()
    };
    let sliver = sliver::model(&sliver::with_sliver(20.0), sliver::MASS_DAMPING);
    let message = refused("central-difference", "machine", "repeated", &sliver);
    assert!(
        message.contains("needs equal rows on a lattice"),
        "{message}"
    );
    let law = Pendulum {
        mass: [0.1],
        revision: Revision::new(),
    };
    let message = refused("central-difference", "precision", "f32", &law);
    assert!(message.contains("leave `precision` out"), "{message}");
    let message = refused("rk4", "machine", "general", &law);
    assert!(message.contains("follow from a law"), "{message}");
    let krylov = plain()
        .with_text("kind", "krylov")
        .with_text("machine", "general");
    let message = build("propagator", &krylov).prepare(&cube(3), 1e-3);
    let message = message.unwrap_err().to_string();
    assert!(message.contains("no machine runs these steps"), "{message}");
}

#[test]
fn stiffnesses_too_far_apart_for_24_bits_are_refused() {
    let law = |factor: f64| Law::linear(factor * 3500.0, 0.45);
    let mut mesh = structured::cube(3, 0.1, Split::Kuhn).unwrap();
    let count = mesh.tets.len() as u32;
    mesh.groups = [("stiff", 1, 0..6), ("soft", 2, 6..count)]
        .map(|(name, tag, members)| Group {
            name: name.into(),
            dim: 3,
            tag,
            members: GroupMembers::Tets(members.collect()),
        })
        .into();
    let prepared = |factor: f64| {
        let region = |group: &str, law: Law| Region::new(law, 1060.0).on(group);
        let problem = Problem::of([region("stiff", law(factor)), region("soft", law(1.0))]);
        let model = Model::build(&mesh, &problem).unwrap();
        let options = plain().with_text("precision", "f32");
        let mut method = sinew_integrators::build("rk4", &options).unwrap();
        method
            .prepare(&model, 1e-5)
            .map(|_| method.computed_by().join("; "))
    };
    // (lambda + 2 mu)/mu is 11 at nu = .45.
    let said = prepared(1e3).unwrap();
    assert!(said.contains("off by about 1.6e-2 of their size"), "{said}");
    let refused = prepared(1e6).unwrap_err().to_string();
    assert!(refused.contains("may be off by 1639 %"), "{refused}");
}

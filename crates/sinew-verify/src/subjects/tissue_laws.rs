//! Laws that bodies and methods fulfil under large deformation.

use sinew_core::vectors::{self, largest, noise, weighted_dot};
use sinew_core::{
    BlockMatrix, ElasticLaw, Inputs, Layers, LoadTime, OptionValue, Options, Ramp, State, System,
    TangentKind, Trial,
};
use sinew_fem::hyperelastic::{Hyperelastic, Tensor};
use sinew_fem::{Element, Law, Model};
use sinew_mesh::structured::{Split, cube};

use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::subject::Subject;
use crate::tissue::{self, COLUMN, EDGE, EDGES, Specimen, YOUNGS_MODULUS};
use crate::vector::{cross, difference, dot};

pub(super) const SUBJECT: Subject = Subject {
    id: "tissue-laws",
    title: "Laws kept under large deformation",
    says: "Tissue with E = 3500 Pa, nu = .45, rho = 1060 kg/m3. Energies are those of motion and deformation, over that at the start; a rise is by \
           a step, beyond the work of a constant load. Forces and own blocks are beside second computations, over the size of what is summed up.",
    checks,
    quoted: &[],
};

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for (steps, is_long) in [(10_000, false), (100_000, true)] {
        let leapfrog = Source::ClosedForm(
            "leapfrog is symplectic: Hairer, Lubich and Wanner, Acta Numer. 12, 2003",
        );
        let case =
            format!("central-difference, twist undamped, half of the stable step, {steps} steps");
        let figures = [
            (
                "change of leapfrog's own energy from the first tenth to the last",
                Asked::value(0.0, 1e-3),
            ),
            (
                "change of the energy of motion and deformation",
                Asked::at_most(1e-3),
            ),
        ];
        let check = Check::several(case, figures, leapfrog, move |_| energy_drift(steps));
        checks.push(check.long(is_long).noted(
            "energy that goes to faster modes is less by up to w^2 dt^2/24 where it is measured: the second figure falls without loss",
        ));
    }
    let order = Source::ClosedForm("a method of order 2");
    checks.push(Check::one(
        "central-difference, release undamped, .5 ms beside .25 ms",
        "ratio of the largest changes of energy",
        Asked::value(4.0, 0.4),
        order,
        |_| Ok(energy_ripple(5e-4)? / energy_ripple(2.5e-4)?),
    ));
    let falls = Source::ClosedForm(
        "Ortiz and Stainier, Comput. Methods Appl. Mech. Eng. 171, 1999, and a limiter",
    );
    for &id in Hyperelastic::IDS {
        let figures = ["p1", "fbar", "fbar-edge"].map(|element| {
            (
                format!("largest rise of energy, {element}"),
                Asked::at_most(1e-12),
            )
        });
        let case =
            format!("cnn-energy, {id}: release, twist and push, 1 to 16 sweeps, 5 to 500 ms");
        checks.push(Check::several(case, figures, falls, move |_| {
            let elements = [Element::P1, Element::Fbar { patch: None }, EDGES];
            elements
                .map(|element| largest_rise(id, element))
                .into_iter()
                .collect()
        }));
    }
    let momentum = Source::ClosedForm("forces of an objective law have no moment");
    for element in [Element::P1, EDGES] {
        checks.push(Check::one(
            format!("central-difference, a stretched and spinning free cube, {element}"),
            "largest change of angular momentum over it",
            Asked::at_most(1e-12),
            momentum,
            move |_| change_of_angular_momentum(element),
        ));
    }
    let scalars = Source::ClosedForm("P = F S: forces are sums of positions, by weights V g.S h");
    for id in ["neo-hookean", "stable-neo-hookean", "stvk"] {
        checks.push(Check::one(
            format!("{id}: forces as one number for each pair of nodes, times positions"),
            "largest difference over the size of the terms",
            Asked::at_most(1e-14),
            scalars,
            move |_| pairs_beside_forces(id),
        ));
    }
    let blocks = Source::ClosedForm("g.(dc/dF).g = 0, since dc/dF contracts two epsilons with g");
    for (id, element, scale) in [
        ("neo-hookean", Element::P1, 0.004),
        ("neo-hookean", EDGES, 0.004),
        ("stable-neo-hookean", Element::P1, 0.03),
        ("stable-neo-hookean", EDGES, 0.03),
        ("stable-neo-hookean-log", Element::P1, 0.03),
    ] {
        let state = if scale > 0.01 {
            "with inverted elements"
        } else {
            "deformed"
        };
        checks.push(Check::one(
            format!("{id}, {element}, {state}: own blocks of nodes without the indefinite part"),
            "largest difference from the tangent's over the largest entry",
            Asked::at_most(1e-14),
            blocks,
            move |_| blocks_beside_tangent(id, element, scale),
        ));
    }
    checks
}

/// Energy of motion and of deformation (J).
fn energy(specimen: &Specimen, state: &State) -> Result<f64, LabError> {
    let mut v = vec![0.0; state.v.len()];
    state.velocity_at_t(&specimen.model, Inputs::none(), &mut v)?;
    let (mut force, model) = (vec![0.0; v.len()], &specimen.model);
    let elastic = model.elastic_force(&at(&state.u), &mut force)?.energy;
    Ok(elastic + 0.5 * weighted_dot(model.mass(), &v, &v))
}

/// A displacement at rest.
fn at(u: &[f64]) -> Trial<'_> {
    Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u,
        v: u,
        internal: &[],
    }
}

/// Energies by central difference, over the first energy.
fn energies(specimen: &Specimen, dt: f64, steps: usize) -> Result<Vec<f64>, LabError> {
    let mut integrator = sinew_integrators::build("central-difference", &Options::new())?;
    let mut state = specimen.start.clone();
    let first = energy(specimen, &state)?;
    let mut energies = Vec::with_capacity(steps);
    for _ in 0..steps {
        integrator.step(&specimen.model, &mut state, dt)?;
        energies.push(energy(specimen, &state)? / first);
    }
    Ok(energies)
}

/// The smallest stable step (s) of the twisting column of 3 x 3 x 18 cells in the course of its motion.
const STABLE: f64 = 1.206e-3;

/// Changes from the first tenth of the steps to the last: of the energy that leapfrog conserves, and of the kinetic and
/// elastic energy.
///
/// A mode of frequency w with an amplitude of energy e has the mean energy `e (1 - w^2 dt^2/8)`, with velocities at the
/// displacement's time, and `e (1 - w^2 dt^2/4)` by `v'M v/2 + (W + W+)/2 - dt^2/4 v'K v` between two displacements.
/// The energy that leapfrog conserves, also if modes exchange energy, is the modified energy `e (1 - w^2 dt^2/12)`: 4/3
/// of the first less 1/3 of the second, to fourth order.
fn energy_drift(steps: usize) -> Result<Vec<f64>, LabError> {
    const APART: usize = 10;
    let problem = tissue::standing(tissue::soft(), Element::P1);
    let specimen = tissue::spun_column([3, 3, 18], COLUMN, 75.0, &problem)?;
    let model = &specimen.model;
    let dt = STABLE / 2.0;
    let mut integrator = sinew_integrators::build("central-difference", &Options::new())?;
    let mut state = specimen.start.clone();
    let mut energies = Vec::with_capacity(steps / APART);
    let mut force = vec![0.0; model.dofs()];
    for step in 0..steps {
        let before = (step % APART == 0).then(|| state.u.clone());
        integrator.step(model, &mut state, dt)?;
        let Some(before) = before else { continue };
        let pairs = before.iter().zip(&state.u);
        let (middle, v): (Vec<f64>, Vec<f64>) =
            pairs.map(|(a, b)| (0.5 * (a + b), (b - a) / dt)).unzip();
        let elastic = model.elastic_force(&at(&before), &mut force)?.energy
            + model.elastic_force(&at(&state.u), &mut force)?.energy;
        model.tangent_product(&at(&middle), TangentKind::Exact, &v, &mut force)?;
        let kinetic = weighted_dot(model.mass(), &v, &v);
        let lag = 0.5 * dt * dt * vectors::dot(&v, &force);
        let between = 0.5 * (kinetic + elastic - lag);
        let plain = energy(&specimen, &state)?;
        energies.push([(4.0 * plain - between) / 3.0, plain]);
    }
    let tenth = energies.len() / 10;
    let mean = |part: &[[f64; 2]], of: usize| part.iter().map(|pair| pair[of]).sum::<f64>();
    let [first, last] = [&energies[..tenth], &energies[energies.len() - tenth..]];
    let change = |of| mean(last, of) / mean(first, of) - 1.0;
    Ok(vec![change(0), change(1)])
}

fn energy_ripple(dt: f64) -> Result<f64, LabError> {
    let specimen = tissue::release(3, tissue::soft(), Element::P1)?;
    let energies = energies(&specimen, dt, (0.2 / dt).round() as usize)?;
    Ok(energies
        .iter()
        .fold(0.0, |most: f64, energy| most.max((energy - 1.0).abs())))
}

/// The largest rise of the energy in a step over that at the start, or over the work of the load, among several starts,
/// kinds and steps.
fn largest_rise(id: &'static str, element: Element) -> Result<f64, LabError> {
    let law = tissue::law(id, YOUNGS_MODULUS, 0.45);
    let standing = tissue::standing(law.clone(), element);
    let specimens = [
        tissue::release(2, law.clone(), element)?,
        tissue::spun_column([2, 2, 6], COLUMN, 75.0, &standing)?,
        tissue::pressed(2, law, element, 10.0, Ramp::Step)?,
    ];
    let mut most = 0.0_f64;
    for specimen in &specimens {
        let load = crate::bodies::loads(&specimen.model);
        for (kind, sweeps, dt) in [
            ("trap", 1, 0.02),
            ("trap", 16, 0.005),
            ("trap", 4, 0.5),
            ("ie", 4, 0.05),
        ] {
            let options = Options::new()
                .with("kind", OptionValue::Text(kind.into()))
                .with_number("sweeps", f64::from(sweeps));
            let mut integrator = sinew_integrators::build("cnn-energy", &options)?;
            let mut state = specimen.start.clone();
            let all = |state: &State| -> Result<f64, LabError> {
                Ok(energy(specimen, state)? - vectors::dot(&load, &state.u))
            };
            let (mut before, mut size) = (all(&state)?, energy(specimen, &state)?);
            for _ in 0..20 {
                integrator.step(&specimen.model, &mut state, dt)?;
                let now = all(&state)?;
                size = size.max(energy(specimen, &state)?);
                most = most.max((now - before) / size);
                before = now;
            }
        }
    }
    Ok(most)
}

fn change_of_angular_momentum(element: Element) -> Result<f64, LabError> {
    let mesh = cube(3, EDGE, Split::Kuhn)?;
    let specimen = Specimen::new(&mesh, &tissue::free(tissue::soft(), element))?;
    let specimen = specimen
        .displaced(|[x, y, z]| [0.2 * x, -0.1 * y + 0.1 * z, 0.15 * z])
        .thrown(|[x, y, z]| {
            [
                8.0 * (z - 0.05) - 5.0 * y,
                5.0 * (x - 0.05),
                -8.0 * (x - 0.05) + 0.1 * z,
            ]
        });
    let mut integrator = sinew_integrators::build("central-difference", &Options::new())?;
    let mut state = specimen.start.clone();
    let momentum = |state: &State| {
        let (mut sum, mut size) = ([0.0; 3], 0.0);
        let nodes = specimen.model.nodes().iter();
        let fields = state
            .u
            .as_chunks::<3>()
            .0
            .iter()
            .zip(state.v.as_chunks::<3>().0);
        for ((node, (u, v)), mass) in nodes
            .zip(fields)
            .zip(specimen.model.mass().iter().step_by(3))
        {
            let point = mesh.points[*node as usize];
            let place = [0, 1, 2].map(|axis| point[axis] + u[axis]);
            let part = cross(place, *v).map(|l| mass * l);
            size += dot(part, part).sqrt();
            sum = [0, 1, 2].map(|axis| sum[axis] + part[axis]);
        }
        (sum, size)
    };
    integrator.step(&specimen.model, &mut state, 1e-3)?;
    let (first, _) = momentum(&state);
    let mut most = 0.0_f64;
    for _ in 0..2000 {
        integrator.step(&specimen.model, &mut state, 1e-3)?;
        let (now, _) = momentum(&state);
        let change = difference(now, first);
        most = most.max((dot(change, change) / dot(first, first)).sqrt());
    }
    Ok(most)
}

/// A cube without supports, its nodes displaced at random by up to `scale` (m).
fn shaken(id: &'static str, element: Element, scale: f64) -> Result<(Model, Vec<f64>), LabError> {
    let law = tissue::law(id, YOUNGS_MODULUS, 0.45);
    let model = Model::build(&cube(3, EDGE, Split::Kuhn)?, &tissue::free(law, element))?;
    let u = noise(model.dofs(), 7).iter().map(|x| scale * x).collect();
    Ok((model, u))
}

fn pairs_beside_forces(id: &'static str) -> Result<f64, LabError> {
    let (model, u) = shaken(id, Element::P1, 0.004)?;
    let Law::Hyperelastic { id, parameters } = tissue::law(id, YOUNGS_MODULUS, 0.45) else {
        return Err(LabError::no_body());
    };
    let law = Hyperelastic::new(id, &parameters)?;
    let mesh = model.mesh();
    let displacement = u.as_chunks::<3>().0;
    let mut sums = vec![[0.0; 3]; mesh.points.len()];
    let mut sizes = vec![0.0; mesh.points.len()];
    for tet in &mesh.tets {
        let rest = tet.map(|node| mesh.points[node as usize]);
        let moved = tet.map(|node| displacement[node as usize]);
        let [p, q, r] = [1, 2, 3].map(|corner| difference(rest[corner], rest[0]));
        let six_volumes = dot(p, cross(q, r));
        let [b, c, d] = [cross(q, r), cross(r, p), cross(p, q)].map(|v| v.map(|x| x / six_volumes));
        let a = [0, 1, 2].map(|axis| -(b[axis] + c[axis] + d[axis]));
        let gradients = [a, b, c, d];
        let h = (0..4).fold(Tensor::zero(), |h, k| {
            h + Tensor::outer(moved[k], gradients[k])
        });
        let f = h + Tensor::identity();
        let cofactor = f.cofactor();
        let volume_ratio = cofactor.contracted(f) / 3.0;
        // S = F^-1 P.
        let s = cofactor
            .transposed_times(law.stress(h))
            .scaled(volume_ratio.recip());
        for (node, g) in tet.iter().zip(gradients) {
            for k in 0..4 {
                let weight = six_volumes / 6.0 * dot(g, s.on(gradients[k]));
                for axis in 0..3 {
                    let term = weight * (rest[k][axis] + moved[k][axis]);
                    sums[*node as usize][axis] += term;
                    sizes[*node as usize] += term.abs();
                }
            }
        }
    }
    let mut force = vec![0.0; u.len()];
    model.elastic_force(&at(&u), &mut force)?;
    let off: Vec<f64> = force
        .iter()
        .zip(sums.as_flattened())
        .map(|(f, sum)| f - sum)
        .collect();
    Ok(largest(&off) / largest(&sizes))
}

fn blocks_beside_tangent(id: &'static str, element: Element, scale: f64) -> Result<f64, LabError> {
    let (model, u) = shaken(id, element, scale)?;
    let mut force = vec![0.0; u.len()];
    let found = model.elastic_force(&at(&u), &mut force)?;
    if scale > 0.01 && found.inverted == 0 {
        return Ok(f64::NAN);
    }
    let mut blocks = vec![0.0; 3 * u.len()];
    model.node_blocks(&at(&u), &mut blocks)?;
    let mut tangent = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
    model.tangent(&at(&u), TangentKind::Exact, &mut tangent)?;
    let mut off = Vec::new();
    for (cell, block) in blocks.as_chunks::<9>().0.iter().enumerate() {
        let own = tangent.block(cell, cell).unwrap_or(&[f64::NAN; 9]);
        off.extend(block.iter().zip(own).map(|(a, b)| a - b));
    }
    Ok(largest(&off) / largest(&blocks))
}

//! Stiffness damping of hyperelastic bodies in motion: the same for all methods, without effect on rotations and
//! translations, and never a source of energy.

use crate::common::{advance, build, plain, relative_error};
use sinew_core::{ElasticLaw, LoadTime, Options, Ramp, State, System, Trial};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{
    Course, Element, Fixed, Law, LoadKind, LoadSpec, Model, Moving, Problem, Rayleigh, Region,
};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

fn tissue(id: &'static str, element: Element) -> Problem {
    Problem::of([
        Region::new(Law::hyperelastic(id, Parameters::new(5000.0, 0.3)), 1000.0)
            .with_element(element),
    ])
    .with_damping(Rayleigh::new(0.0, 0.005))
}

fn sweeps(count: f64) -> Options {
    plain().with_number("sweeps", count)
}

/// Positions (m) of the nodes of a free body.
fn places(mesh: &TetMesh, u: &[f64]) -> Vec<[f64; 3]> {
    let places = mesh.points.iter().zip(u.as_chunks::<3>().0);
    places
        .map(|(point, u)| [0, 1, 2].map(|k| point[k] + u[k]))
        .collect()
}

/// The velocities (m/s) of a rotation about the z axis through the middle of a plate of this width (m).
fn spin(mesh: &TetMesh, width: f64, omega: f64) -> Vec<f64> {
    let middle = 0.5 * width;
    let of = |[x, y, _]: [f64; 3]| [-omega * (y - middle), omega * (x - middle), 0.0];
    mesh.points.iter().flat_map(|point| of(*point)).collect()
}

/// Angular momentum (kg m^2/s) of a free body about z.
fn momentum(mesh: &TetMesh, model: &Model, state: &State, v: &[f64]) -> f64 {
    let places = places(mesh, &state.u);
    let cells = places.iter().zip(v.as_chunks::<3>().0);
    let cells = cells.zip(model.mass().as_chunks::<3>().0);
    let moments = cells.map(|(([x, y, _], v), mass)| mass[0] * (x * v[1] - y * v[0]));
    moments.sum()
}

#[test]
fn a_spinning_plate_keeps_its_angular_momentum() {
    let mesh = structured::block([3, 3, 1], [0.09, 0.09, 0.03], Split::Mirrored).unwrap();
    for (id, element) in [
        ("neo-hookean", Element::P1),
        ("stvk", Element::Fbar { patch: None }),
    ] {
        let model = Model::build(&mesh, &tissue(id, element)).unwrap();
        let start = State::new(vec![0.0; model.dofs()], spin(&mesh, 0.09, 8.0));
        for (method, options, dt, lost) in [
            ("central-difference", plain(), 0.5e-3, 1e-10),
            ("rk4", plain(), 1e-3, 1e-6),
            ("newmark", plain(), 2e-3, 1e-3),
            ("cnn-energy", sweeps(16.0), 2e-3, 1e-3),
        ] {
            let mut state = start.clone();
            let before = momentum(&mesh, &model, &state, &state.v);
            let steps = (0.2 / dt) as usize;
            advance(&mut *build(method, &options), &model, &mut state, steps, dt);
            // Places move along their own velocity, so that any time of the velocity within the step serves.
            let after = momentum(&mesh, &model, &state, &state.v);
            let off = (after / before - 1.0).abs();
            assert!(off < lost, "{id}, {element}, `{method}`: {off:e}");
        }
    }
}

/// In long steps a velocity is the displacement of a step over its length, which strains a rotating body unless damping
/// acts half way.
#[test]
fn damping_brings_no_energy_into_a_plate_that_turns_far_in_a_step() {
    let mesh = structured::block([3, 3, 1], [0.09, 0.09, 0.03], Split::Mirrored).unwrap();
    let mut problem = tissue("neo-hookean", Element::P1);
    problem.damping.stiffness = 0.05;
    let model = Model::build(&mesh, &problem).unwrap();
    for dt in [0.005, 0.02] {
        let mut state = State::new(vec![0.0; model.dofs()], spin(&mesh, 0.09, 20.0));
        let mut method = build("implicit-euler", &plain());
        let mut before = energy(&model, &state);
        for _ in 0..20 {
            advance(&mut *method, &model, &mut state, 1, dt);
            let now = energy(&model, &state);
            assert!(now <= before * (1.0 + 1e-9), "{dt}: {now} {before}");
            before = now;
        }
    }
}

/// Kinetic and elastic energy (J).
fn energy(model: &Model, state: &State) -> f64 {
    let trial = Trial::of(state, LoadTime::at(state.t()));
    let mut force = vec![0.0; state.u.len()];
    let elastic = model.elastic_force(&trial, &mut force).unwrap().energy;
    let masses = model.mass().iter().zip(&state.v);
    let kinetic: f64 = masses.map(|(mass, v)| 0.5 * mass * v * v).sum();
    kinetic + elastic
}

/// Under pressure all round p V is its potential; with that and the elastic one the energy of a free body only
/// decreases.
#[test]
fn under_pressure_that_follows_the_surface_a_damped_body_gains_no_energy() {
    let pressure = 2000.0;
    let mesh = structured::block([3, 3, 1], [0.09, 0.09, 0.03], Split::Mirrored).unwrap();
    let mut problem = tissue("neo-hookean", Element::P1);
    problem.loads = ["bottom", "sides", "top"]
        .map(|group| LoadSpec::new(group, LoadKind::FollowingPressure(pressure)))
        .into();
    let model = Model::build(&mesh, &problem).unwrap();
    let with_pressure = |state: &State| {
        let mut moved = mesh.clone();
        moved.points = places(&mesh, &state.u);
        let volume: f64 = moved.signed_volumes().iter().sum();
        energy(&model, state) + pressure * (volume - 0.09 * 0.09 * 0.03)
    };
    let mut state = State::new(vec![0.0; model.dofs()], spin(&mesh, 0.09, 3.0));
    let mut method = build("newmark", &plain());
    let (mut before, first) = (with_pressure(&state), with_pressure(&state));
    for _ in 0..30 {
        advance(&mut *method, &model, &mut state, 10, 1e-3);
        let now = with_pressure(&state);
        assert!(now < before + 1e-4 * first.abs(), "{now} {before} {first}");
        before = now;
    }
}

/// A beam fixed at one end that falls under its weight, and rotates by some 50 degrees.
fn falling() -> Model {
    let mesh = structured::block([5, 1, 1], [0.2, 0.04, 0.04], Split::Mirrored).unwrap();
    let (held, _): (Vec<u32>, Vec<u32>) =
        (0..mesh.points.len() as u32).partition(|node| mesh.points[*node as usize][0] < 1e-9);
    let mut problem = tissue("neo-hookean", Element::P1);
    problem.fixed.push(Fixed::at(sinew_fem::On::Nodes(held)));
    problem.gravity = Some([0.0, 0.0, -9.81]);
    Model::build(&mesh, &problem).unwrap()
}

#[test]
fn all_methods_converge_to_one_damped_motion() {
    let model = falling();
    let at_end = |method: &str, options: &Options, dt: f64| {
        let mut state = State::at_rest(model.dofs());
        let steps = (0.24 / dt).round() as usize;
        advance(&mut *build(method, options), &model, &mut state, steps, dt);
        state.u
    };
    let exact = [at_end("rk4", &plain(), 0.75e-3)];
    for (method, options, dt) in [
        ("central-difference", plain(), 0.75e-3),
        ("newmark", plain(), 4e-3),
        ("generalized-alpha", plain(), 4e-3),
        ("cnn-energy", sweeps(24.0), 4e-3),
        ("implicit-euler", plain(), 4e-3),
    ] {
        let order = if ["implicit-euler", "central-difference"].contains(&method) {
            1
        } else {
            2
        };
        let [coarse, fine] =
            [dt, 0.5 * dt].map(|dt| relative_error(&[at_end(method, &options, dt)], &exact));
        let expected = 0.6 * f64::from(1 << order);
        assert!(coarse / fine > expected, "`{method}`: {coarse:e} {fine:e}");
        assert!(
            fine < if order == 1 { 0.05 } else { 5e-3 },
            "`{method}`: {fine:e}"
        );
    }
}

/// The change of damping by the displacement is part of the derivative.
#[test]
fn newtons_method_takes_few_iterations_under_damping_by_the_rate_of_strain() {
    let model = falling();
    for method in ["newmark", "implicit-euler", "generalized-alpha"] {
        let (mut integrator, mut state) = (build(method, &plain()), State::at_rest(model.dofs()));
        advance(&mut *integrator, &model, &mut state, 24, 1e-2);
        let facts = integrator.facts();
        let mean = facts
            .iter()
            .find(|fact| fact.name == "newton_iterations_a_step");
        let mean = mean.unwrap().value;
        assert!(mean < 4.0, "`{method}`: {mean} iterations a step");
    }
}

/// A body and its moved part, all with one velocity: there is no strain, and no force.
#[test]
fn a_body_that_glides_with_its_supports_feels_no_damping() {
    let speed = [0.3, -0.2, 0.1];
    for element in [Element::P1, Element::Fbar { patch: None }] {
        let mut problem = tissue("neo-hookean", element);
        problem.moves.push(Moving::new(
            "bottom",
            [Course::new(
                speed,
                Ramp::Table {
                    times: vec![0.0, 1.0],
                    values: vec![0.0, 1.0],
                },
            )],
        ));
        let mesh = structured::cube(2, 0.1, Split::Mirrored).unwrap();
        let model = Model::build(&mesh, &problem).unwrap();
        for kind in ["trap", "ie"] {
            let options = sweeps(1.0).with_text("kind", kind);
            let v = model.nodes().iter().flat_map(|_| speed).collect();
            let mut state = State::new(vec![0.0; model.dofs()], v);
            advance(
                &mut *build("cnn-energy", &options),
                &model,
                &mut state,
                40,
                5e-3,
            );
            let off = state.v.as_chunks::<3>().0.iter();
            let off = off.flat_map(|v| [0, 1, 2].map(|k| (v[k] - speed[k]).abs()));
            let off = off.fold(0.0, f64::max);
            assert!(off < 1e-12, "{element}, {kind}: {off:e} m/s");
            let force = model
                .reaction(state.t(), &state.u, &state.v, &"bottom".into())
                .unwrap();
            let size = force
                .into_iter()
                .fold(0.0, |size: f64, x| size.max(x.abs()));
            assert!(size < 1e-9, "{element}, {kind}: {force:?} N");
        }
    }
}

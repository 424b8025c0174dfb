//! `modal` with Ritz vectors of the loads: exact if they span the motion, statically exact with any number, better than
//! modes at the same number, and with an error as estimated before the run.

use std::f64::consts::TAU;

use crate::common::cube::{altered, cube, mass_damping, scene};
use crate::common::{advance, build, plain, relative_error};
use sinew_core::{
    Damping, Integrator, LinearModel, LinearSystem, Load, OptionValue, Options, Ramp, State, System,
};
use sinew_fem::{Law, Model};
use sinew_integrators::Frame;
use sinew_integrators::implicit::{Modal, static_solution};

const LAW: Law = Law::linear(3500.0, 0.45);

fn ritz(modes: f64) -> Options {
    eigen(modes).with("vectors", OptionValue::Text("ritz".into()))
}

fn eigen(modes: f64) -> Options {
    plain().with_number("modes", modes)
}

fn fact(integrator: &dyn Integrator, name: &str) -> f64 {
    let facts = integrator.facts();
    facts.iter().find(|fact| fact.name == name).unwrap().value
}

/// Displacements after each of `steps` steps from rest.
fn motion(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    dt: f64,
    steps: usize,
) -> Vec<Vec<f64>> {
    let mut state = State::at_rest(system.dofs());
    let mut motion = Vec::new();
    for _ in 0..steps {
        advance(integrator, system, &mut state, 1, dt);
        motion.push(state.u.clone());
    }
    motion
}

/// The motion by polynomials in K, exact to 1e-10 a step.
fn exact(system: &dyn System, dt: f64, steps: usize) -> Vec<Vec<f64>> {
    motion(system, &mut *build("propagator", &plain()), dt, steps)
}

/// Pushes at a side and at an edge that begin and end, in addition to a constant one.
fn several_loads(model: &Model, damping: Damping) -> LinearModel {
    let n = model.dofs() as u32;
    let pulse = |from, to| Ramp::Pulse { from, to };
    let ramps = [Ramp::Step, pulse(0.1, 0.3), pulse(0.2, 5.0)];
    let loads = (0..).zip(ramps).map(|(number, ramp)| Load {
        ramp,
        entries: vec![
            (number, 0.01),
            (n / 2 + 5 * number, -0.02),
            (n - 1 - number, 0.01),
        ],
    });
    altered(model, damping, loads.collect())
}

/// A cube under a traction on its top, a pulse on other nodes besides: every mode is excited.
#[test]
fn as_many_vectors_as_degrees_of_freedom_are_exact() {
    let model = scene(3, 0.1, LAW, mass_damping(0.0));
    let damping = Damping {
        mass: 2.0,
        stiffness: 1e-3,
        extra: None,
    };
    let system = several_loads(&model, damping);
    let mut integrator = build("modal", &ritz(f64::from(system.dofs() as u32)));
    let found = motion(&system, &mut *integrator, 0.02, 30);
    let error = relative_error(&found, &exact(&system, 0.02, 30));
    assert!(error < 1e-8, "{error:e}");
    assert!(fact(&*integrator, "left_out") < 1e-8);
}

/// With one vector for each load, a damped body under loads comes to rest where it would with all its modes.
#[test]
fn the_static_part_is_exact_with_one_vector_for_each_load() {
    let model = scene(6, 0.1, LAW, mass_damping(0.0));
    let damping = Damping {
        mass: 60.0,
        ..Damping::default()
    };
    let system = several_loads(&model, damping);
    let mut state = State::at_rest(system.dofs());
    advance(
        &mut *build("modal", &ritz(3.0)),
        &system,
        &mut state,
        20,
        0.2,
    );
    let mut force = vec![0.0; system.dofs()];
    system.operators().external_force(state.t(), &mut force);
    let rest = static_solution(&system, &force).unwrap();
    let error = relative_error(&[state.u], &[rest]);
    assert!(error < 1e-9, "{error:e}");
}

/// Cubes without damping and with mass damping, over eight of their slowest periods: twelve vectors of each kind, and
/// the error estimated before the run, which is within a factor of 1.5 of the actual one.
#[test]
fn twelve_ritz_vectors_beat_twelve_modes_and_say_their_error() {
    let cases = [scene(10, 0.1, LAW, mass_damping(0.0)), cube(7)];
    for model in cases {
        let mut modal = Frame::new(Modal::with_modes(6));
        modal.prepare(&model, 0.01).unwrap();
        let dt = 8.0 * TAU / modal.frequencies()[0] / 100.0;
        let expected = exact(&model, dt, 100);
        let measured = |options: &Options| {
            let mut integrator = build("modal", options);
            let found = motion(&model, &mut *integrator, dt, 100);
            (relative_error(&found, &expected), integrator)
        };
        let (of_modes, _) = measured(&eigen(12.0));
        for count in [6.0, 12.0, 24.0, 48.0] {
            let (error, integrator) = measured(&ritz(count));
            let stated = fact(&*integrator, "left_out");
            println!("{count}: {error:.3e}, stated {stated:.3e}; 12 modes {of_modes:.3e}");
            assert_eq!(fact(&*integrator, "modes"), count);
            assert!(
                error <= 1.5 * stated && stated <= 1.5 * error,
                "{count}: {error} {stated}"
            );
            let said = integrator.remarks();
            let percent = format!("{:.2} %", 100.0 * stated);
            assert!(said.len() == 1 && said[0].contains(&percent), "{said:?}");
            if count == 12.0 {
                assert!(error < of_modes, "{error} {of_modes}");
            }
        }
    }
}

/// No eigenproblem of the whole: a factor, one solution to test it, and two for each vector.
#[test]
fn a_dozen_vectors_take_a_factor_and_two_dozen_solutions() {
    let model = scene(8, 0.1, LAW, mass_damping(0.0));
    let mut integrator = build("modal", &ritz(12.0));
    let work = integrator.prepare(&model, 0.01).unwrap();
    assert_eq!(work.factorizations, 1);
    assert!(work.solves <= 26, "{}", work.solves);
}

#[test]
fn a_tolerance_is_met_by_the_vectors_that_it_needs() {
    let model = scene(8, 0.1, LAW, mass_damping(0.0));
    let expected = exact(&model, 0.01, 100);
    let mut before = 0.0;
    for tolerance in [0.2, 0.1, 0.05] {
        let options = plain()
            .with("vectors", OptionValue::Text("ritz".into()))
            .with_number("tolerance", tolerance);
        let mut integrator = build("modal", &options);
        let error = relative_error(&motion(&model, &mut *integrator, 0.01, 100), &expected);
        assert!(fact(&*integrator, "left_out") <= tolerance);
        assert!(error <= 1.5 * tolerance, "{error} {tolerance}");
        let vectors = fact(&*integrator, "modes");
        assert!(vectors > before && vectors < 400.0, "{vectors}");
        before = vectors;
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let model = scene(3, 0.1, LAW, mass_damping(0.0));
    let refusal = |system: &dyn System, options: &Options| {
        let error = build("modal", options).prepare(system, 0.01).err();
        error.unwrap().to_string()
    };
    assert_eq!(
        refusal(&altered(&model, Damping::default(), vec![]), &ritz(5.0)),
        "`modal` needs loads to take vectors from for vectors = \"ritz\", which this system does not offer"
    );
    assert_eq!(
        refusal(&several_loads(&model, Damping::default()), &ritz(2.0)),
        "`modal`: these loads need 3 vectors at least for vectors = \"ritz\": one for each ramp, and the rigid \
         motions of a body that floats; ask for more `modes`"
    );
    let error = sinew_integrators::build("modal", &ritz(5.0).with_number("basis", 9.0)).err();
    assert_eq!(
        error.unwrap().to_string(),
        "`modal`: basis = 9: expected nothing with vectors = \"ritz\", which are all of their basis"
    );
}

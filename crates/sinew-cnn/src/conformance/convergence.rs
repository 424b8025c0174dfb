//! Motions compared with exact solutions.

use std::sync::Arc;

use sinew_core::closed_form::DampedOscillator;
use sinew_core::{
    Accuracy, Batch, Inputs, Layers, LinearModel, LinearOperators, LinearSystem, Load,
    LoadOverStep, Ramp, State,
};

use super::dense::motion;
use super::systems::{Changing, Damped, Kind, case, constant_force};
use super::{Make, Method};

/// Every method comes as near to the exact motion as it declares: under a constant load the error against the matrix
/// exponential, and against the closed form of an oscillator, falls with the step at the method's order; an exact
/// method has no error above 1e-9.
pub fn motions_converge_to_the_exact_ones(methods: &[Method], make: &Make) {
    for method in methods.iter().filter(|method| !method.bounds) {
        for layers in [Layers::One, Layers::Three] {
            for damped in [
                Damped::Not,
                Damped::ByMass,
                Damped::ByStiffness,
                Damped::ByDashpots,
            ] {
                let Some(accuracy) = method.accuracy_under(damped) else {
                    continue;
                };
                let kind = Kind {
                    layers,
                    damped,
                    changing: Changing::Not,
                    held: false,
                    cells: [1, 1, 2],
                };
                converges(method, kind, accuracy, make);
            }
        }
        oscillates(method, make);
    }
}

impl Method {
    fn accuracy_under(&self, damped: Damped) -> Option<Accuracy> {
        match damped {
            Damped::Not | Damped::ByMass => Some(self.properties.accuracy),
            Damped::ByStiffness => self.properties.other_damping.stiffness,
            Damped::ByDashpots | Damped::ByAll => self.properties.other_damping.dashpots,
        }
    }
}

/// omega_max dt of the coarser of two steps.
const COARSE: f64 = 0.04;
/// Instants at which errors are taken, and coarse steps between them.
const INSTANTS: usize = 6;
const BETWEEN: usize = 25;

/// The root of the sum of squared errors at some instants, relative, in steps of `dt/refinement`.
fn error(
    method: &Method,
    system: &LinearModel,
    start: &State,
    [dt, refinement]: [f64; 2],
    make: &Make,
    exact: &dyn Fn(f64) -> Vec<f64>,
) -> Option<f64> {
    let step = dt / refinement;
    let program = (method.program)(system, step)?;
    let mut machine = make();
    machine.load(Arc::new(program), system);
    let mut state = start.clone();
    let (mut sum, mut size) = (0.0, 0.0);
    for _ in 0..INSTANTS {
        let steps = BETWEEN * refinement as usize;
        let mut batch = Batch::new(system, Inputs::none(), step, steps);
        let done = machine.run(&mut batch, &mut state);
        assert!(done.is_ok(), "{}: {done:?}", method.name);
        for (u, expected) in state.u.iter().zip(exact(state.t())) {
            sum += (u - expected).powi(2);
            size += expected.powi(2);
        }
    }
    Some(f64::sqrt(sum / size))
}

fn check_order(
    method: &Method,
    what: &str,
    order: Option<u8>,
    dt_at: impl Fn(f64) -> f64,
    error: impl Fn([f64; 2]) -> Option<f64>,
) {
    let name = &method.name;
    let Some(order) = order else {
        let Some(error) = error([dt_at(method.omega_dt), 1.0]) else {
            return;
        };
        assert!(error <= 1e-9, "{name} on {what}: error {error:.1e}");
        return;
    };
    let errors = [1.0, 2.0].map(|refinement| error([dt_at(COARSE), refinement]));
    let [Some(coarse), Some(fine)] = errors else {
        return;
    };
    let observed = (coarse / fine).log2();
    assert!(
        observed >= f64::from(order) - 0.15,
        "{name} on {what}: order {order} declared, {observed:.3} observed ({coarse:.1e}, {fine:.1e})"
    );
}

fn converges(method: &Method, kind: Kind, accuracy: Accuracy, make: &Make) {
    let case = case(kind, 1.0, LoadOverStep::Constant);
    let operators = case.system.operators();
    let force = constant_force(&case.system);
    let exact = |t: f64| {
        let [u, _] = motion(operators, &force, [&case.start.u, &case.start.v], t);
        u
    };
    check_order(
        method,
        &format!("{kind:?}"),
        accuracy.order(kind.damped != Damped::Not),
        |omega_dt| omega_dt * case.dt,
        |steps| error(method, &case.system, &case.start, steps, make, &exact),
    );
}

/// Checks the closed form of an oscillator with mass damping.
fn oscillates(method: &Method, make: &Make) {
    let (mass, omega, alpha, force) = (0.5, 20.0, 3.0, 4.0);
    let load = Load {
        ramp: Ramp::Step,
        entries: vec![(0, force)],
    };
    let operators = LinearOperators::oscillator(mass, mass * omega * omega, mass * alpha);
    let Ok(operators) = operators.and_then(|operators| operators.with_loads(vec![load])) else {
        unreachable!("an oscillator has sound matrices");
    };
    let system = LinearModel::new(operators);
    let closed = DampedOscillator {
        omega,
        damping: alpha,
        load: force / mass,
        displacement: 0.02,
        velocity: -0.5,
    };
    let start = State::new(vec![closed.displacement], vec![closed.velocity]);
    let exact = |t: f64| vec![closed.at(t).0];
    check_order(
        method,
        "an oscillator",
        method.properties.accuracy.order(true),
        |omega_dt| omega_dt / omega,
        |steps| error(method, &system, &start, steps, make, &exact),
    );
}

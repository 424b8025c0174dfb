//! The paper's oscillator: methods beside its closed form.

use sinew_core::spectrum::critical_step;
use sinew_core::{LinearModel, LinearOperators, LinearSystem, Options, State};

use crate::check::{Asked, Check, Source};
use crate::error::VerifyError;
use crate::motion::relative_error;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "oscillator",
    title: "A mass on a spring",
    says: "The oscillator of Zhang, Zhong, Smith and Gu, Technol. Health Care 25, 2017, section 4.1: 0.1 kg, 100 N/m, 1 N s/m, -5 m/s at rest. \
           Errors over the steps of one second beside u(t) = v/w exp(-d t/(2 m)) sin(w t), relative in the mean square; returning 0 \
           scores 100 %. Orders are those that the methods declare.",
    checks,
    quoted: &[],
};

const MASS: f64 = 0.1;
const SPRING: f64 = 100.0;
const DASHPOT: f64 = 1.0;
const VELOCITY: f64 = -5.0;

/// Method, its saturation, step (s), error (%) and half a unit of its last digit.
const ERRORS: &[(&str, Option<f64>, f64, f64, f64)] = &[
    ("forward-euler", None, 0.001, 7.72, 0.005),
    ("cnn", Some(4.0), 0.001, 7.36, 0.005),
    ("cnn", Some(3.2), 0.001, 14.06, 0.005),
    ("cnn", Some(2.0), 0.001, 48.75, 0.005),
    ("cnn", Some(4.0), 0.015, 349.6, 0.05),
    ("cnn", Some(3.2), 0.015, 288.6, 0.05),
    ("cnn", Some(2.0), 0.015, 208.5, 0.05),
    ("cnn", Some(4.0), 0.02, 425.7, 0.05),
    ("cnn", Some(3.2), 0.02, 346.1, 0.05),
    ("cnn", Some(2.0), 0.02, 239.0, 0.05),
    ("symplectic-euler", None, 0.001, 1.50, 0.005),
    ("symplectic-euler", None, 0.015, 24.0, 0.05),
    ("symplectic-euler", None, 0.02, 33.0, 0.05),
    ("central-difference", None, 0.001, 0.0232, 5e-5),
    ("central-difference", None, 0.015, 5.42, 0.005),
    ("central-difference", None, 0.02, 9.93, 0.005),
    ("newmark", None, 0.001, 0.0377, 5e-5),
    ("newmark", None, 0.02, 15.2, 0.05),
    ("implicit-euler", None, 0.001, 6.66, 0.005),
    ("implicit-euler", None, 0.02, 59.1, 0.05),
    ("rk4", None, 0.001, 3.79e-6, 5e-9),
    // Rounding decides between .654 and .655.
    ("rk4", None, 0.02, 0.6545, 5e-4),
];

/// Methods and their orders.
const ORDERS: &[(&str, f64)] = &[
    ("forward-euler", 1.0),
    ("symplectic-euler", 1.0),
    ("implicit-euler", 1.0),
    ("central-difference", 2.0),
    ("newmark", 2.0),
    ("generalized-alpha", 2.0),
    ("modified-leapfrog", 2.0),
    ("rk4", 4.0),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    let worked_out = Source::Independent(
        "each method worked out in Python beside the closed form; its digits as it printed them",
    );
    for &(method, saturation, dt, percent, half_unit) in ERRORS {
        let case = match saturation {
            Some(q) => format!("{method}, Q = {q}, dt = {dt} s"),
            None => format!("{method}, dt = {dt} s"),
        };
        let asked = Asked::value(percent, half_unit);
        checks.push(Check::one(
            case,
            "error (%)",
            asked,
            worked_out,
            move |_| Ok(100.0 * error(method, saturation, dt)?),
        ));
    }
    for &(method, order) in ORDERS {
        let source = Source::ClosedForm(
            "Hairer, Lubich and Wanner, Geometric Numerical Integration; Bathe, Finite Element Procedures, chapter 9",
        );
        checks.push(Check::one(
            method,
            "order between 0.5 and 0.25 ms",
            Asked::value(order, 0.1),
            source,
            move |_| Ok((error(method, None, 5e-4)? / error(method, None, 2.5e-4)?).log2()),
        ));
    }
    let closed_form = Source::ClosedForm("2 sqrt(m/k), any textbook on vibrations");
    let limit = 2.0 * (MASS / SPRING).sqrt();
    checks.push(Check::one(
        "undamped central difference",
        "stable step (s)",
        Asked::relative(limit, 1e-12),
        closed_form,
        |_| Ok(critical_step(model()?.operators())),
    ));
    checks
}

fn model() -> Result<LinearModel, VerifyError> {
    Ok(LinearModel::new(LinearOperators::oscillator(
        MASS, SPRING, DASHPOT,
    )?))
}

/// The displacement (m) at a time (s).
fn exact(t: f64) -> f64 {
    let decay = DASHPOT / (2.0 * MASS);
    let omega = (SPRING / MASS - decay * decay).sqrt();
    VELOCITY / omega * (-decay * t).exp() * (omega * t).sin()
}

fn error(method: &str, saturation: Option<f64>, dt: f64) -> Result<f64, VerifyError> {
    let options = match saturation {
        Some(q) => Options::new().with_number("saturation", q),
        None => Options::new(),
    };
    let (model, mut integrator) = (model()?, sinew_integrators::build(method, &options)?);
    let mut state = State::new(vec![0.0], vec![VELOCITY]);
    let steps = (1.0 / dt - 1e-9).ceil() as usize;
    let mut motion = vec![(0.0, 0.0)];
    for step in 1..=steps {
        integrator.step(&model, &mut state, dt)?;
        motion.push((state.u[0], exact(step as f64 * dt)));
    }
    Ok(relative_error(motion))
}

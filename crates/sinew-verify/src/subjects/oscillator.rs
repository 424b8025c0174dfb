//! The paper's oscillator: methods compared with its closed form.

use sinew_core::spectrum::critical_step;
use sinew_core::{
    LinearModel, LinearOperators, LinearSystem, Options, StableStep, State, StepError,
};

use crate::check::{Asked, Check, Source};
use crate::error::LabError;
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

/// Method, its saturation, step (s), largest |u| (m) in the first second and half a unit of its last digit.
const FIRST_PEAKS: &[(&str, Option<f64>, f64, f64, f64)] = &[
    ("forward-euler", None, 0.001, 0.12901, 5e-6),
    ("cnn", Some(4.0), 0.001, 0.12602, 5e-6),
    ("cnn", Some(3.2), 0.001, 0.11918, 5e-6),
    ("cnn", Some(2.0), 0.001, 0.09979, 5e-6),
    ("cnn", Some(4.0), 0.02, 0.2556, 5e-5),
    ("cnn", Some(3.2), 0.02, 0.2014, 5e-5),
    ("cnn", Some(2.0), 0.02, 0.1282, 5e-5),
];

/// Saturation, step (s) and largest |u| (m) from 18 s to 20 s of the network, with three digits after the point.
const LIMIT_CYCLES: &[(f64, f64, f64)] = &[
    (4.0, 0.015, 0.210),
    (3.2, 0.015, 0.168),
    (2.0, 0.015, 0.105),
    (4.0, 0.02, 0.255),
    (3.2, 0.02, 0.204),
    (2.0, 0.02, 0.128),
    (4.0, 0.001, 0.0),
];

/// Methods and their stable steps (s), with half a unit of the last digit.
const STABLE_STEPS: &[(&str, f64)] = &[
    ("forward-euler", 0.0100),
    ("cnn", 0.0100),
    ("symplectic-euler", 0.0540),
    ("cnn-symplectic", 0.0540),
    ("central-difference", 0.0632),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    let worked_out = Source::Independent(
        "each method worked out in Python beside the closed form; its digits as it printed them",
    );
    let named = |method: &str, saturation: Option<f64>, dt: f64| match saturation {
        Some(q) => format!("{method}, Q = {q}, dt = {dt} s"),
        None => format!("{method}, dt = {dt} s"),
    };
    for &(method, saturation, dt, percent, half_unit) in ERRORS {
        let case = named(method, saturation, dt);
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
    for &(method, saturation, dt, peak, half_unit) in FIRST_PEAKS {
        let figure = "largest displacement of the first second (m)";
        let asked = Asked::value(peak, half_unit);
        let case = named(method, saturation, dt);
        checks.push(Check::one(case, figure, asked, worked_out, move |_| {
            largest_within(method, saturation, dt, [0.0, 1.0])
        }));
    }
    for &(q, dt, peak) in LIMIT_CYCLES {
        let figure = "largest displacement from 18 s to 20 s (m)";
        let asked = match peak {
            0.0 => Asked::at_most(1e-12),
            peak => Asked::value(peak, 5e-4),
        };
        let case = named("cnn", Some(q), dt);
        checks.push(Check::one(case, figure, asked, worked_out, move |_| {
            largest_within("cnn", Some(q), dt, [18.0, 20.0])
        }));
    }
    let for_ever = Source::ClosedForm("a limit cycle");
    let (q, dt) = (4.0, 0.02);
    checks.push(Check::one(
        named("cnn", Some(q), dt),
        "largest displacement from 198 s to 200 s over that from 18 s to 20 s",
        Asked::value(1.0, 0.01),
        for_ever,
        move |_| {
            let [early, late] = [[18.0, 20.0], [198.0, 200.0]]
                .map(|within| largest_within("cnn", Some(q), dt, within));
            Ok(late? / early?)
        },
    ));
    let describing = Source::ClosedForm(
        "(4/pi) Q sqrt(dt m/d), the describing function of a clamp; Gelb and Vander Velde, 1968",
    );
    for dt in [0.011, 0.013, 0.015, 0.02] {
        checks.push(Check::several(
            format!("cnn, dt = {dt} s, limit cycle"),
            [
                (
                    "size over the describing function's, Q = 4",
                    Asked::value(1.0, 0.13),
                ),
                (
                    "the same of Q = 3.2 over that of Q = 4",
                    Asked::value(1.0, 0.01),
                ),
                (
                    "the same of Q = 2 over that of Q = 4",
                    Asked::value(1.0, 0.01),
                ),
            ],
            describing,
            move |_| {
                let size = |q: f64| -> Result<f64, LabError> {
                    let found = largest_within("cnn", Some(q), dt, [98.0, 100.0])?;
                    Ok(found / (4.0 / std::f64::consts::PI * q * f64::sqrt(dt * MASS / DASHPOT)))
                };
                let all = size(4.0)?;
                Ok(vec![all, size(3.2)? / all, size(2.0)? / all])
            },
        ));
    }
    for &(method, step) in STABLE_STEPS {
        let mut figures = vec![("stable step (s)", Asked::value(step, 5e-5))];
        if !method.starts_with("cnn") {
            figures.push(("largest displacement at .95 of it (m)", Asked::at_most(1.0)));
            figures.push((
                "largest displacement at 1.05 of it (m)",
                Asked::at_least(1e3),
            ));
        }
        let is_followed = figures.len() > 1;
        checks.push(Check::several(method, figures, worked_out, move |_| {
            let integrator = sinew_integrators::build(method, &Options::new())?;
            let stable = match integrator.stable_step(&model()?).map_err(StepError::from)? {
                StableStep::UpTo(step) => step,
                StableStep::Any | StableStep::Unknown => f64::NAN,
            };
            let mut figures = vec![stable];
            for share in [0.95, 1.05]
                .into_iter()
                .take(if is_followed { 2 } else { 0 })
            {
                figures.push(largest_within(method, None, share * stable, [0.0, 100.0])?);
            }
            Ok(figures)
        }));
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

fn model() -> Result<LinearModel, LabError> {
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

/// Times (s) and displacements (m) after each step; the motion ends if it exceeds 1 km.
fn motion(
    method: &str,
    saturation: Option<f64>,
    dt: f64,
    duration: f64,
) -> Result<Vec<(f64, f64)>, LabError> {
    let options = match saturation {
        Some(q) => Options::new().with_number("saturation", q),
        None => Options::new(),
    };
    let (model, mut integrator) = (model()?, sinew_integrators::build(method, &options)?);
    let mut state = State::new(vec![0.0], vec![VELOCITY]);
    let steps = (duration / dt - 1e-9).ceil() as usize;
    let mut motion = vec![(0.0, 0.0)];
    for step in 1..=steps {
        integrator.step(&model, &mut state, dt)?;
        motion.push((step as f64 * dt, state.u[0]));
        if state.u[0].abs() > 1e3 {
            break;
        }
    }
    Ok(motion)
}

fn error(method: &str, saturation: Option<f64>, dt: f64) -> Result<f64, LabError> {
    let motion = motion(method, saturation, dt, 1.0)?.into_iter();
    Ok(relative_error(motion.map(|(t, u)| (u, exact(t)))))
}

/// The largest displacement (m) between two times (s).
fn largest_within(
    method: &str,
    saturation: Option<f64>,
    dt: f64,
    [from, to]: [f64; 2],
) -> Result<f64, LabError> {
    let motion = motion(method, saturation, dt, to)?.into_iter();
    let within = motion.filter(|(t, _)| (from - 1e-9..=to + 1e-9).contains(t));
    Ok(within.fold(0.0, |most: f64, (_, u)| most.max(u.abs())))
}

//! Pass marks of large deformations.

use sinew_measure::{MethodChoice, Row};

use super::{equal_error, methods};
use crate::planned::{energy, is_yardstick};
use crate::report::{number, percent};
use crate::results::Mark;
use sinew_verify::MarkVerdict;

/// Largest rise of the energy, over all supplied energy, that counts as rounding.
const ROUNDING: f64 = 1e-11;

/// All marks; `begins` is notified of each that takes time.
pub(super) fn all(rows: &[Row], quick: bool, begins: impl FnMut(&str)) -> Vec<Mark> {
    let mut marks = vec![
        energy_never_rises(rows),
        steps_follow_the_stiffness(rows),
        errors_are_those_of_others(rows),
    ];
    marks.extend(equal_error::marks(quick, begins));
    marks
}

fn mark(case: &str, asked: String, limit: f64) -> Mark {
    Mark {
        case: case.to_owned(),
        asked,
        limit: Some(limit),
        ..Mark::default()
    }
}

fn at(row: &Row) -> String {
    let dt = number::milliseconds(row.dt);
    format!("{}: {}, {dt} ms", row.case, row.label())
}

/// The certificate of the sweeps that lower a step's energy, over all cases, steps, kinds and numbers of sweeps.
fn energy_never_rises(rows: &[Row]) -> Mark {
    let own = rows
        .iter()
        .filter(|row| row.integrator == energy("trap", 4).integrator);
    let rises = own.filter_map(|row| Some((row.energy_rise?, row)));
    let worst = rises.clone().max_by(|a, b| a.0.total_cmp(&b.0));
    let asked = mark(
        "cellular sweeps never raise the energy",
        format!(
            "largest rise over what start and loads brought in at most {}",
            number::short(ROUNDING)
        ),
        ROUNDING,
    );
    let Some((rise, row)) = worst else {
        return asked;
    };
    Mark {
        measured: number::short(rise),
        figure: Some(rise),
        by: format!("the worst of {} runs: {}", rises.count(), at(row)),
        verdict: MarkVerdict::of(rise <= ROUNDING),
        ..asked
    }
}

/// Central difference whose substeps follow the stiffness reaches the end in all cases.
fn steps_follow_the_stiffness(rows: &[Row]) -> Mark {
    let own: Vec<&Row> = rows.iter().filter(|row| is_yardstick(row)).collect();
    let worst = own.iter().max_by(|a, b| error(a).total_cmp(&error(b)));
    let asked = mark(
        "steps by the current stiffness come to the end",
        "error at most 50 % at any step, nothing refused".to_owned(),
        0.5,
    );
    let Some(worst) = worst else {
        return asked;
    };
    let figure = error(worst);
    Mark {
        measured: match figure.is_finite() {
            true => format!("{} %", percent(figure)),
            false => worst.refusal.clone().unwrap_or("diverged".to_owned()),
        },
        figure: figure.is_finite().then_some(figure),
        by: format!("the worst of {} runs: {}", own.len(), at(worst)),
        verdict: MarkVerdict::of(figure <= asked.limit.unwrap_or_default()),
        ..asked
    }
}

/// Errors at 10 ms of an independent implementation, for the methods of a quick run after the yardstick, each with a
/// flag: true if it takes the same steps. Its sweeps start from rest, and those here from the displacement by the
/// velocity.
const OF_OTHERS: [(f64, bool); 2] = [(0.0044, true), (0.0178, false)];

/// The pushed cube at 10 ms, compared with an independent implementation.
fn errors_are_those_of_others(rows: &[Row]) -> Mark {
    let asked = mark(
        "errors are those of an independent implementation",
        "two methods on the pushed cube at 10 ms: the error to 3 %, that of sweeps no larger"
            .to_owned(),
        0.03,
    );
    let apart = |(method, (known, is_same)): (&MethodChoice, &(f64, bool))| {
        let row = rows.iter().find(|row| {
            row.case == "push"
                && row.integrator == method.integrator
                && (row.dt - 0.01).abs() < 1e-9
        })?;
        let beyond = error(row) / known - 1.0;
        let apart = if *is_same {
            beyond.abs()
        } else {
            beyond.max(0.0)
        };
        Some((apart, at(row)))
    };
    let few = methods::few();
    let compared = few.iter().skip(1).zip(&OF_OTHERS);
    let apart: Option<Vec<_>> = compared.map(apart).collect();
    let worst = apart
        .into_iter()
        .flatten()
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((figure, by)) = worst else {
        return asked;
    };
    Mark {
        measured: format!("{} %", percent(figure)),
        figure: figure.is_finite().then_some(figure),
        by,
        verdict: MarkVerdict::of(figure <= asked.limit.unwrap_or_default()),
        ..asked
    }
}

/// The error of a run; infinite for a run without one.
fn error(row: &Row) -> f64 {
    row.sound_error().unwrap_or(f64::INFINITY)
}

//! Short runs that find which methods and steps are worth laps.

use sinew_measure::Case;
use sinew_measure::{Effort, Method, measure};
use sinew_measure::{Outcome, Row};

/// An error and the run of ours that reaches it most cheaply.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Largest error (fraction); none for the run that is the other program's own method and step.
    pub error: Option<f64>,
    /// The run, as its pilot measured it.
    pub row: Row,
}

/// Errors (fractions) that are looked for.
const ERRORS: [f64; 3] = [1e-2, 1e-3, 1e-6];

/// Parts that the distance between two samples is cut into, one step each: all meet the samples, so
/// that errors are taken at the same instants whatever the step.
pub const LADDER: [u32; 15] = [1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 32, 50, 64, 100];

/// A method whose run costs this many times ours in the other program's own step is followed no
/// further down the ladder.
const TOO_DEAR: f64 = 20.0;

/// The same method and step as the other program's first, then the cheapest run for each error, as
/// far as there is one. Cost is CPU time of set-up and steps for the case's duration.
///
/// # Errors
/// A reason in words when the other program's own method cannot run here.
pub fn pilots(
    case: &mut Case,
    integrators: &[String],
    same: (&str, f64),
) -> Result<Vec<Target>, String> {
    let settings = case.simulation().settings();
    let between = settings.duration / settings.samples as f64;
    let method = Method::on(case, same.0);
    let same = measure(case, &method, same.1, Effort::QUICK)?;
    // Nor is one followed once it costs more than a run that already meets the smallest error.
    let mut too_dear = TOO_DEAR * same.cpu_s_per_s;

    let mut rows = Vec::new();
    for integrator in integrators {
        let method = Method::on(case, integrator);
        for parts in LADDER {
            // What cannot run here is no candidate; the bench lists why.
            let Ok(row) = measure(case, &method, between / f64::from(parts), Effort::QUICK) else {
                continue;
            };
            let enough = row.error.is_some_and(|error| error <= ERRORS[2]);
            let dear = row.cpu_s_per_s > too_dear;
            if enough {
                too_dear = too_dear.min(row.cpu_s_per_s);
            }
            rows.push(row);
            if enough || dear {
                break;
            }
        }
    }
    let duration = case.simulation().settings().duration;
    let mut targets = vec![Target {
        error: None,
        row: same,
    }];
    for error in ERRORS {
        if let Some(row) = cheapest(&rows, error, duration) {
            targets.push(Target {
                error: Some(error),
                row: row.clone(),
            });
        }
    }
    Ok(targets)
}

fn cheapest(rows: &[Row], largest_error: f64, duration: f64) -> Option<&Row> {
    let cost = |row: &Row| row.setup_cpu_s + row.cpu_s_per_s * duration;
    rows.iter()
        .filter(|row| row.outcome == Outcome::Finished && row.bounded && !row.guarded)
        .filter(|row| row.error.is_some_and(|error| error <= largest_error))
        .min_by(|a, b| cost(a).total_cmp(&cost(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn set_up_counts_and_what_is_guarded_does_not() {
        let row = |error, setup_cpu_s, cpu_s_per_s| Row {
            error: Some(error),
            setup_cpu_s,
            cpu_s_per_s,
            bounded: true,
            ..Row::default()
        };
        let guarded = Row {
            guarded: true,
            ..row(1e-9, 0.0, 0.01)
        };
        let rows = [row(1e-3, 2.0, 0.1), row(1e-2, 0.0, 1.0), guarded];
        assert_eq!(cheapest(&rows, 1e-2, 1.0), Some(&rows[1]));
        assert_eq!(cheapest(&rows, 1e-2, 3.0), Some(&rows[0]));
        assert_eq!(cheapest(&rows, 1e-3, 1.0), Some(&rows[0]));
        assert_eq!(cheapest(&rows, 1e-4, 1.0), None);
    }
}

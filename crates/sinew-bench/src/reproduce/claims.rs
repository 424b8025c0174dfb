//! The claims, one by one.

use super::figures::{error_in_words, percent};
use super::runs::{LARGE, Runs, SMALL, VOLTAGES};
use crate::report::three;
use sinew_measure::Row;

/// A claim of the paper and the measurement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// The place in the paper.
    pub place: &'static str,
    /// The claim, in short.
    pub says: &'static str,
    /// Description of the measured figures.
    pub measured: String,
    /// Verdict on the claim.
    pub holds: Holds,
}

/// Verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// It is true as written.
    Yes,
    /// It is true in the part that the measurement states.
    InPart,
    /// It is not true.
    No,
}

impl Holds {
    /// One word for tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Yes => "holds",
            Self::InPart => "holds in part",
            Self::No => "does not hold",
        }
    }

    fn all(parts: &[bool]) -> Self {
        match parts.iter().filter(|part| **part).count() {
            n if n == parts.len() => Self::Yes,
            0 => Self::No,
            _ => Self::InPart,
        }
    }
}

/// Error below which two curves of a figure can be called almost identical.
const ALMOST_IDENTICAL: f64 = 0.01;

pub(super) fn claims(runs: &Runs<'_>) -> Vec<Claim> {
    let mut claims = Vec::from(oscillator_at_small_steps(runs));
    claims.extend(oscillator_at_large_steps(runs));
    claims.extend(saturation_voltage(runs));
    claims.extend(cube(runs));
    claims
}

fn error(row: &Row) -> f64 {
    row.error.unwrap_or(f64::INFINITY)
}

fn largest(row: &Row) -> String {
    row.max_u
        .map_or_else(|| "unbounded".into(), |u| format!("{u:.5} m"))
}

fn oscillator_at_small_steps(runs: &Runs<'_>) -> [Claim; 2] {
    let peak = runs
        .reference
        .iter()
        .fold(0.0, |max: f64, (_, u)| max.max(u.abs()));
    let almost = |place, says, row: &Row| Claim {
        place,
        says,
        measured: format!(
            "error {} over a second at dt = {SMALL} s, largest |u| {} (exact {peak:.5} m): close to the eye, not almost identical",
            error_in_words(row),
            largest(row),
        ),
        holds: Holds::all(&[error(row) <= ALMOST_IDENTICAL, error(row) < 0.1]),
    };
    [
        almost(
            "4.1, Fig. 1b",
            "explicit integration at a small step is almost identical to the reference",
            &runs.euler[0].row,
        ),
        almost(
            "4.1, Fig. 2a",
            "the CNN at a small step is almost identical to the reference",
            &runs.network[0][0].row,
        ),
    ]
}

fn oscillator_at_large_steps(runs: &Runs<'_>) -> [Claim; 3] {
    let euler = [&runs.euler[1].row, &runs.euler[2].row];
    let network = [&runs.network[0][1].row, &runs.network[0][2].row];
    let both = |rows: [&Row; 2]| {
        format!(
            "{} at {} s, {} at {} s",
            error_in_words(rows[0]),
            LARGE[0],
            error_in_words(rows[1]),
            LARGE[1]
        )
    };
    [
        Claim {
            place: "4.1, Fig. 1b",
            says: "explicit integration diverges at large steps",
            measured: format!("{}; its limit is d/k = 0.01 s", both(euler)),
            holds: Holds::all(&euler.map(|row| !row.bounded)),
        },
        Claim {
            place: "4.1, Fig. 2a",
            says: "the CNN's solutions are better than those of explicit integration at the same steps",
            measured: format!(
                "{} against {} at {SMALL} s; {} against {}",
                error_in_words(&runs.network[0][0].row),
                error_in_words(&runs.euler[0].row),
                both(network),
                both(euler)
            ),
            holds: Holds::all(&[
                error(&runs.network[0][0].row) < error(&runs.euler[0].row),
                error(network[0]) < error(euler[0]),
                error(network[1]) < error(euler[1]),
            ]),
        },
        Claim {
            place: "4.1, Fig. 2b",
            says: "the CNN's solution remains stable at large steps",
            measured: format!(
                "bounded, but it never settles: errors {}; after 18 s it still swings by {:.3} m, a limit cycle of amplitude about (4/pi) Q sqrt(dt m/d), where the truth is at rest",
                both(network),
                runs.limit_cycles[0]
            ),
            holds: Holds::all(&[
                network.iter().all(|row| row.bounded),
                network.iter().all(|row| row.settles),
            ]),
        },
    ]
}

fn saturation_voltage(runs: &Runs<'_>) -> [Claim; 3] {
    let listed = |index: usize, show: fn(&Row) -> String| {
        let values = VOLTAGES.iter().zip(&runs.network);
        let values =
            values.map(|(q, histories)| format!("Q = {q}: {}", show(&histories[index].row)));
        values.collect::<Vec<_>>().join(", ")
    };
    let errors = |index: usize| [0, 1, 2].map(|q| error(&runs.network[q][index].row));
    let peaks = [0, 1, 2].map(|q| runs.network[q][0].row.max_u.unwrap_or(f64::INFINITY));
    let falls = |values: [f64; 3]| values[0] > values[1] && values[1] > values[2];
    let cycles = runs
        .limit_cycles
        .map(|amplitude| format!("{amplitude:.3}"))
        .join("/");
    [
        Claim {
            place: "4.1, Fig. 3a",
            says: "at a small step Q = 4 and Q = 3.2 are best, because the state never leaves the linear range",
            measured: format!(
                "errors {}; the initial 5 m/s is above every Q, and {} of the steps are saturated at Q = 4",
                listed(0, error_in_words),
                percent(runs.network[0][0].row.saturated)
            ),
            holds: Holds::all(&[
                errors(0)[2] > errors(0)[0].max(errors(0)[1]),
                runs.network[0][0].row.saturated == 0.0,
            ]),
        },
        Claim {
            place: "4.1, Fig. 3a",
            says: "a smaller Q lowers the peak at a small step",
            measured: format!("largest |u| {}", listed(0, largest)),
            holds: Holds::all(&[falls(peaks)]),
        },
        Claim {
            place: "4.1, Fig. 3b",
            says: "at a large step, the smaller Q is, the better the solution",
            measured: format!(
                "errors at {} s {}; all worse than returning zero, with limit cycles of {cycles} m",
                LARGE[1],
                listed(2, error_in_words)
            ),
            holds: Holds::all(&[falls(errors(2)), errors(2).iter().all(|error| *error < 1.0)]),
        },
    ]
}

fn cube(runs: &Runs<'_>) -> [Claim; 5] {
    let [euler_small, network_small] = &runs.cube_small;
    let [euler_large, network_large] = &runs.cube_large;
    let row = &network_large.row;
    let ratio = network_small.row.us_per_step / euler_small.row.us_per_step;
    let settled = row.settles;
    [
        Claim {
            place: "4.2, Fig. 4b",
            says: "CNN and explicit integration are identical at a small step",
            measured: format!(
                "the same bits after {} steps; error of both {}",
                network_small.row.steps,
                error_in_words(&network_small.row)
            ),
            holds: Holds::all(&[euler_small.u == network_small.u]),
        },
        Claim {
            place: "4.2, Fig. 4c",
            says: "explicit integration becomes unstable at a large step",
            measured: format!(
                "displacements pass the cube's edge after {} s and reach {} m after a second",
                three(euler_large.t),
                three(runs.euler_after_a_second)
            ),
            holds: Holds::all(&[!euler_large.row.bounded]),
        },
        Claim {
            place: "4.2, Fig. 4d",
            says: "the CNN remains stable at a large step",
            measured: format!(
                "bounded ({} of motion where {} mm are right), but error {}, {} of all velocities saturated, {} tetrahedra inverted at the end, and it does not settle",
                row.max_u
                    .map_or_else(|| "unbounded".into(), |u| format!("{} mm", three(u * 1e3))),
                three(runs.cube.samples().max_u * 1e3),
                error_in_words(row),
                percent(row.saturated),
                row.inverted
            ),
            holds: Holds::all(&[row.bounded, settled && error(row) < 1.0]),
        },
        Claim {
            place: "4.2",
            says: "one iteration of the CNN costs about as much as one of explicit integration",
            measured: format!(
                "{} times, with errors {} and {} (the paper's 2 ms ran on unknown hardware)",
                three(ratio),
                error_in_words(&network_small.row),
                error_in_words(&euler_small.row)
            ),
            holds: Holds::all(&[(0.7..1.4).contains(&ratio)]),
        },
        Claim {
            place: "abstract, 5",
            says: "stable soft tissue deformation at a large step with the efficiency of explicit integration",
            measured: format!(
                "the efficiency is there; what remains stable at {} s is a motion with an error of {}",
                LARGE[1],
                error_in_words(row)
            ),
            holds: Holds::all(&[row.bounded && (0.7..1.4).contains(&ratio), error(row) < 1.0]),
        },
    ]
}

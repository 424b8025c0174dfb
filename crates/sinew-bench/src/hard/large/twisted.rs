//! A column that is twisted by more than one turn.

use sinew_fem::Element;
use sinew_measure::MethodChoice;

use super::follow::{Planned, follow, reference};
use super::tally::{Demand, Tally};
use super::tally::{LITTLE, ROUNDING};
use crate::hard::mark::Asked;
use crate::hard::methods::{cut, energy_of};
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, COLUMN, Specimen, YOUNGS_MODULUS, rotation_of_top};

/// Angular speed of the top at the start (1/s), which takes it beyond a turn.
const SPIN: f64 = 110.0;

const LAWS: [&str; 4] = [
    "neo-hookean",
    "stable-neo-hookean",
    "corotational",
    "mooney-rivlin",
];

/// Simulated time (s), number of compared instants, and the step of the reference (s).
const DURATION: f64 = 0.25;
const INSTANTS: usize = 50;
const FINE: f64 = 1.25e-4;

/// The largest rotation of the top (rad).
fn farthest(specimen: &Specimen, track: &[Vec<f64>]) -> f64 {
    let mut angle = 0.0_f64;
    let mut farthest = 0.0_f64;
    for u in track {
        angle = rotation_of_top(specimen, u, angle);
        farthest = farthest.max(angle.abs());
    }
    farthest
}

/// The column rotates by more than 360 degrees and back; methods follow it, or keep its energy.
pub(crate) fn check(asked: Asked) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    for law in LAWS {
        let problem = tissue::standing(tissue::law(law, YOUNGS_MODULUS, 0.45), Element::P1);
        let body = tissue::spun_column([2, 2, 12], COLUMN, SPIN, &problem)?;
        let exact = reference(&body, FINE, DURATION, INSTANTS)?;
        let turns = farthest(&body, &exact) / std::f64::consts::TAU;
        tally.demand(
            law.into(),
            Demand::new("a turn over the farthest one", 1.0 / turns, 1.0),
        );
        for (planned, limit) in [
            (Planned::must(MethodChoice::new("newmark"), 0.0005), 0.05),
            (
                Planned::must(MethodChoice::new("central-difference"), 0.0005),
                0.05,
            ),
            (Planned::must(cut("central-difference"), 0.005), 0.1),
        ] {
            let run = follow(&body, &planned, DURATION, INSTANTS)?;
            let demand = Demand::new("error", run.error(&exact), limit);
            tally.judge(law, &planned, &run, demand);
        }
        for (planned, limit) in [
            (Planned::must(energy_of("trap", 4), 0.005), ROUNDING),
            (Planned::must(energy_of("ie", 4), 0.01), ROUNDING),
            (
                Planned::may(MethodChoice::new("implicit-euler"), 0.01),
                ROUNDING,
            ),
            (Planned::may(MethodChoice::new("newmark"), 0.005), LITTLE),
            (
                Planned::may(MethodChoice::new("generalized-alpha"), 0.005),
                LITTLE,
            ),
        ] {
            let run = follow(&body, &planned, DURATION, INSTANTS)?;
            let demand = Demand::new("energy above that at the start", run.excess, limit);
            tally.judge(law, &planned, &run, demand);
        }
    }
    Ok(tally.mark(asked))
}

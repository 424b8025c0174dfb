//! Loads that reverse their direction.

use sinew_core::Ramp;
use sinew_fem::Element;
use sinew_measure::MethodChoice;

use super::follow::{Planned, follow, reference};
use super::tally::{Demand, Tally};
use crate::hard::mark::Asked;
use crate::hard::methods::{cut, energy_of};
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, YOUNGS_MODULUS};

const CELLS: usize = 4;

/// Laws with different responses in compression and tension.
const LAWS: [&str; 3] = ["neo-hookean", "stable-neo-hookean", "corotational"];

/// Simulated time (s), number of compared instants, and the step of the reference (s).
const DURATION: f64 = 0.6;
const INSTANTS: usize = 60;
const FINE: f64 = 2.5e-4;

/// A cube is pressed by 12 N, pulled by 12 N and released, by a smooth load and by one that jumps.
pub(crate) fn check(asked: Asked) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    let smooth = Ramp::Table {
        times: vec![0.0, 0.1, 0.2, 0.3, 0.4],
        values: vec![0.0, 1.0, 0.0, -1.0, 0.0],
    };
    let jumps = Ramp::Hold {
        times: vec![0.0, 0.1, 0.2, 0.3, 0.4],
        values: vec![0.7, -0.7, 0.7, -0.7, 0.0],
    };
    for law in LAWS {
        for (name, ramp, limit) in [("smooth", &smooth, 0.02), ("jumps", &jumps, 0.1)] {
            let tissue = tissue::law(law, YOUNGS_MODULUS, 0.45);
            let body = tissue::pressed(CELLS, tissue, Element::P1, 20.0, ramp.clone())?;
            let exact = reference(&body, FINE, DURATION, INSTANTS)?;
            let about = format!("{law}, {name}");
            for planned in [
                Planned::must(MethodChoice::new("newmark"), 0.005),
                Planned::must(MethodChoice::new("generalized-alpha"), 0.005),
                Planned::must(energy_of("trap", 16), 0.005),
                Planned::must(cut("central-difference"), 0.01),
                Planned::may(MethodChoice::new("central-difference"), 0.0025),
            ] {
                let run = follow(&body, &planned, DURATION, INSTANTS)?;
                let demand = Demand::new("error", run.error(&exact), limit);
                tally.judge(&about, &planned, &run, demand);
            }
        }
    }
    Ok(tally.mark(asked))
}

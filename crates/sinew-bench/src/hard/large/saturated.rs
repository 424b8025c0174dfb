//! Networks whose cells are limited to a speed Q.

use sinew_core::Ramp;
use sinew_fem::Element;
use sinew_measure::MethodChoice;

use super::follow::{Planned, follow, reference};
use super::tally::{Demand, Tally};
use crate::hard::mark::Asked;
use crate::hard::methods::guarded;
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, YOUNGS_MODULUS};

const CELLS: usize = 6;

/// Simulated time (s), number of compared instants, and the step of the reference (s).
const DURATION: f64 = 0.3;
const INSTANTS: usize = 30;
const FINE: f64 = 1.25e-4;

/// Bounds (m/s): one above the speeds of the motion, one below.
const WIDE: f64 = 4.0;
const NARROW: f64 = 0.05;

fn bound(id: &str, limit: f64) -> MethodChoice {
    let mut method = MethodChoice::new(id);
    method.options = method.options.with_number("saturation", limit);
    method
}

/// Below their stable steps networks with a wide bound follow a press; if the bound limits speeds, the network reports
/// it. Beyond, elements invert, which a law refuses or the count of limited speeds shows. Bounds by energy need
/// matrices and are refused.
pub(crate) fn check(asked: Asked) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    for law in ["neo-hookean", "stable-neo-hookean"] {
        // The paper's network is forward Euler, which damping alone makes stable.
        let tissue = tissue::law(law, YOUNGS_MODULUS, 0.45);
        let ramp = Ramp::Sin2 { rise: 0.2 };
        let body = tissue::pressed(CELLS, tissue, Element::P1, 80.0, ramp)?;
        let exact = reference(&body, FINE, DURATION, INSTANTS)?;
        for planned in [
            Planned::must(bound("cnn", WIDE), 2.5e-4),
            Planned::must(bound("cnn-symplectic", WIDE), 1e-3),
            Planned::must(bound("central-difference", WIDE), 1e-3),
            Planned::may(bound("cnn", NARROW), 2.5e-4),
            Planned::may(bound("central-difference", NARROW), 1e-3),
            Planned::may(bound("cnn", WIDE), 5e-4),
            Planned::may(bound("cnn", WIDE), 1e-3),
            Planned::may(bound("cnn", WIDE), 1e-2),
            Planned::may(bound("central-difference", WIDE), 1e-2),
            Planned::may(guarded("cnn"), 2.5e-4),
            Planned::may(guarded("central-difference"), 1e-3),
        ] {
            let run = follow(&body, &planned, DURATION, INSTANTS)?;
            let demand = Demand::new("error", run.error(&exact), 0.01);
            tally.judge(law, &planned, &run, demand);
        }
    }
    Ok(tally.mark(asked))
}

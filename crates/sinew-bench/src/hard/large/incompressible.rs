//! Tissue that hardly changes its volume: nu = .4999.

use sinew_core::Ramp;
use sinew_fem::Element;
use sinew_measure::MethodChoice;

use super::follow::{Planned, follow, reference};
use super::tally::ROUNDING;
use super::tally::{Demand, Tally};
use crate::hard::hard_run::relative_distance;
use crate::hard::mark::Asked;
use crate::hard::methods::{cut, energy_of};
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, EDGES, Specimen, YOUNGS_MODULUS};

const CELLS: usize = 4;

/// Simulated time (s), number of compared instants, and the step of the reference (s).
const DURATION: f64 = 0.3;
const INSTANTS: usize = 30;
const FINE: f64 = 5e-5;

fn specimen(nu: f64, element: Element, ramp: Ramp) -> Result<Specimen, LabError> {
    let law = tissue::law("neo-hookean", YOUNGS_MODULUS, nu);
    tissue::pressed(CELLS, law, element, 10.0, ramp)
}

/// A cube under 12 N deforms like one with nu = .499, and moves as with short steps.
pub(crate) fn check(asked: Asked) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    let rise = Ramp::Sin2 { rise: 0.2 };
    for element in [Element::Fbar { patch: None }, EDGES] {
        let about = element.to_string();
        let body = specimen(0.4999, element, rise.clone())?;
        let other = specimen(0.499, element, rise.clone())?;
        let off = relative_distance(&body.equilibrium()?, &other.equilibrium()?);
        let demand = Demand::new(
            "distance of the equilibrium from that with nu .499",
            off,
            0.01,
        );
        tally.demand(about.clone(), demand);
        let exact = reference(&body, FINE, DURATION, INSTANTS)?;
        for (planned, limit) in [
            (Planned::must(MethodChoice::new("newmark"), 0.01), 0.02),
            (
                Planned::must(MethodChoice::new("generalized-alpha"), 0.01),
                0.02,
            ),
            (
                Planned::must(MethodChoice::new("implicit-euler"), 0.01),
                0.15,
            ),
            (Planned::must(cut("central-difference"), 0.01), 0.005),
            (
                Planned::may(MethodChoice::new("central-difference"), 0.001),
                0.005,
            ),
        ] {
            let run = follow(&body, &planned, DURATION, INSTANTS)?;
            let demand = Demand::new("error", run.error(&exact), limit);
            tally.judge(&about, &planned, &run, demand);
        }
        let loaded = specimen(0.4999, element, Ramp::Step)?;
        for planned in [
            Planned::must(energy_of("trap", 8), 0.01),
            Planned::must(energy_of("ie", 8), 0.01),
        ] {
            let run = follow(&loaded, &planned, DURATION, 1)?;
            let demand = Demand::new("rise of the energy in a step", run.rise, ROUNDING);
            tally.judge(&about, &planned, &run, demand);
        }
    }
    Ok(tally.mark(asked))
}

//! Test with steps ten times as long as the stable one at rest.

use sinew_core::{Ramp, StableStep};
use sinew_fem::Element;
use sinew_measure::MethodChoice;

use super::follow::{Planned, follow};
use super::tally::{Demand, Tally};
use super::tally::{LITTLE, ROUNDING};
use crate::hard::mark::Asked;
use crate::hard::methods::{cut, energy_of};
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, COLUMN, Specimen, YOUNGS_MODULUS};

const CELLS: usize = 4;

/// Steps over the stable one.
const TIMES: f64 = 10.0;

/// Steps of a run.
const STEPS: f64 = 40.0;

/// Explicit methods without substeps, all of which must be refused or fail visibly.
const EXPLICIT: [&str; 6] = [
    "forward-euler",
    "symplectic-euler",
    "central-difference",
    "rk4",
    "cnn",
    "cnn-symplectic",
];

fn specimens(law: &'static str) -> Result<[(&'static str, Specimen); 3], LabError> {
    let tissue = tissue::law(law, YOUNGS_MODULUS, 0.45);
    let standing = tissue::standing(tissue.clone(), Element::P1);
    Ok([
        (
            "release",
            tissue::release(CELLS, tissue.clone(), Element::P1)?,
        ),
        (
            "twist",
            tissue::spun_column([2, 2, 12], COLUMN, 75.0, &standing)?,
        ),
        (
            "push",
            tissue::pressed(CELLS, tissue, Element::P1, 10.0, Ramp::Step)?,
        ),
    ])
}

/// No method gains energy silently: it is refused by name, reports the gain, or stays within the energy of start and
/// loads.
pub(crate) fn check(asked: Asked) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    for law in ["neo-hookean", "stable-neo-hookean", "corotational"] {
        for (name, body) in specimens(law)? {
            let plain = MethodChoice::new("central-difference");
            let StableStep::UpTo(stable) = plain.build()?.stable_step(&body.model)? else {
                return Err(LabError::new("nothing vibrates"));
            };
            let dt = TIMES * stable;
            let falling = [
                Planned::must(energy_of("ie", 4), dt),
                Planned::must(energy_of("trap", 1), dt),
                Planned::must(energy_of("trap", 8), dt),
                Planned::may(MethodChoice::new("implicit-euler"), dt),
            ];
            let others = [
                Planned::may(cut("central-difference"), dt),
                Planned::may(MethodChoice::new("newmark"), dt),
                Planned::may(MethodChoice::new("generalized-alpha"), dt),
            ];
            let explicit = EXPLICIT.map(|id| Planned::may(MethodChoice::new(id), dt));
            let falling = falling.into_iter().map(|planned| (planned, ROUNDING));
            let others = others.into_iter().chain(explicit);
            let others = others.map(|planned| (planned, LITTLE));
            for (planned, limit) in falling.chain(others) {
                let run = follow(&body, &planned, STEPS * dt, 1)?;
                let demand = Demand::new("energy beyond start and work", run.excess, limit);
                tally.judge(&format!("{name}, {law}"), &planned, &run, demand);
            }
        }
    }
    Ok(tally.mark(asked))
}

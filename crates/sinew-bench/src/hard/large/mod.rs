//! Hard cases of tissue under large deformation. Each run ends in a state that is checked with an energy law or a
//! reference, or in a refusal that names the fault.

mod follow;
mod inclusion;
mod incompressible;
mod inverted;
mod long_steps;
mod reversal;
mod saturated;
mod slivers;
mod tally;
mod twisted;

use self::inverted::Start;
use super::mark::Asked;
use crate::results::Mark;
use sinew_verify::LabError;

/// A hard case of tissue.
pub(crate) struct LargeCase {
    pub(crate) asked: Asked,
    /// True if a quick run leaves it out.
    pub(crate) slow: bool,
    pub(crate) check: fn(Asked) -> Result<Mark, LabError>,
}

/// The cases, in the order of the report.
pub(crate) fn all() -> Vec<LargeCase> {
    let case = |case, asked, check| LargeCase {
        // Figures are shares of what is allowed.
        asked: Asked {
            case,
            asked,
            limit: 1.0,
        },
        slow: false,
        check,
    };
    let slow = |case: LargeCase| LargeCase { slow: true, ..case };
    vec![
        case(
            "tissue crushed into a point",
            "energy monotone and finite, explicit methods unfold it",
            |asked| inverted::check(asked, Start::Crushed),
        ),
        slow(case(
            "tissue turned inside out",
            "energy monotone and finite",
            |asked| inverted::check(asked, Start::Mirrored),
        )),
        case(
            "one sliver 100 times thinner, in each law",
            "moves as without it, or is refused by name",
            slivers::check,
        ),
        case(
            "a core 1000 times stiffer, of other laws",
            "equilibria and motions of a core of the same law",
            inclusion::check,
        ),
        case(
            "tissue with nu .4999",
            "equilibrium to 1 % of that with nu .499, errors small",
            incompressible::check,
        ),
        case(
            "networks bound to a speed in tissue",
            "error at most 1 %, or told, or refused by name",
            saturated::check,
        ),
        slow(case(
            "tissue under loads that turn round",
            "errors small, or refused by name",
            reversal::check,
        )),
        slow(case(
            "a column twisted beyond a turn",
            "errors small, energy kept, or refused by name",
            twisted::check,
        )),
        case(
            "tissue at 10 times the stable step",
            "no energy from nothing, or told, or refused by name",
            long_steps::check,
        ),
    ]
}

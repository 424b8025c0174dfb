//! Cubes that start inside out: crushed into a point, or mirrored.

use sinew_fem::Element;
use sinew_measure::MethodChoice;
use sinew_mesh::structured::{Split, cube};

use super::follow::{Planned, follow};
use super::tally::{Demand, Tally};
use super::tally::{LITTLE, ROUNDING};
use crate::hard::mark::Asked;
use crate::hard::methods::{cut, energy_of};
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, EDGE, Specimen, YOUNGS_MODULUS};

/// Laws whose stress restores inverted elements.
const LAWS: [&str; 2] = ["stable-neo-hookean", "stable-neo-hookean-log"];

const CELLS: usize = 6;

/// Simulated time (s).
const DURATION: f64 = 0.5;

/// A start that is inside out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// Every free node at the centre of the cube.
    Crushed,
    /// Every free node at its mirror image below the bottom.
    Mirrored,
}

fn specimen(law: &'static str, start: Start) -> Result<Specimen, LabError> {
    let mut problem = tissue::standing(tissue::law(law, YOUNGS_MODULUS, 0.45), Element::P1);
    problem.damping = tissue::of_mass(10.0);
    let specimen = Specimen::new(&cube(CELLS, EDGE, Split::Mirrored)?, &problem)?;
    Ok(specimen.displaced(|place| match start {
        Start::Crushed => place.map(|x| EDGE / 2.0 - x),
        Start::Mirrored => [0.0, 0.0, -2.0 * place[2]],
    }))
}

/// Methods of decreasing energy never increase it in a step, and other methods never exceed the initial energy. Central
/// difference has to restore the crushed cube to a state without inverted elements; dissipative methods may settle in a
/// fold, and do.
pub(crate) fn check(asked: Asked, start: Start) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    for law in LAWS {
        let specimen = specimen(law, start)?;
        for planned in [
            Planned::must(energy_of("ie", 4), 0.02),
            Planned::must(energy_of("ie", 16), 0.02),
            Planned::must(energy_of("trap", 4), 0.02),
            Planned::may(MethodChoice::new("implicit-euler"), 0.02),
        ] {
            let run = follow(&specimen, &planned, DURATION, 1)?;
            let demand = Demand::new("rise of the energy in a step", run.rise, ROUNDING);
            tally.judge(law, &planned, &run, demand);
        }
        let central = MethodChoice::new("central-difference");
        for planned in [
            Planned::must(central.clone(), 0.0005),
            Planned::must(central, 0.001),
            Planned::may(cut("central-difference"), 0.01),
            Planned::may(MethodChoice::new("newmark"), 0.005),
            Planned::may(MethodChoice::new("generalized-alpha"), 0.005),
        ] {
            let run = follow(&specimen, &planned, DURATION, 1)?;
            let demand = Demand::new("energy above that at the start", run.excess, LITTLE);
            tally.judge(law, &planned, &run, demand);
            if start == Start::Crushed && planned.must_end && run.inverted > 0 {
                let label = planned.label();
                tally.fault(format!(
                    "{law}: {label}: {} elements stay inside out",
                    run.inverted
                ));
            }
        }
    }
    Ok(tally.mark(asked))
}

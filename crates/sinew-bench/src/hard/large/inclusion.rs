//! A core a thousand times stiffer than the tissue around it, of another law.

use sinew_core::Ramp;
use sinew_fem::{Element, LoadKind, LoadSpec, Problem, Region};
use sinew_measure::MethodChoice;

use super::follow::{Planned, follow, reference};
use super::tally::ROUNDING;
use super::tally::{Demand, Tally};
use crate::hard::hard_run::relative_distance;
use crate::hard::mark::Asked;
use crate::hard::meshes::inclusion_cube;
use crate::hard::methods::{cut, energy_of};
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, EDGE, Specimen, YOUNGS_MODULUS};

const CELLS: usize = 4;

/// Modulus of the core over that of the tissue.
const RATIO: f64 = 1000.0;

/// Laws of the core; the tissue is `neo-hookean`.
const CORES: [&str; 4] = [
    "corotational",
    "stable-neo-hookean",
    "stvk",
    "mooney-rivlin",
];

/// Simulated time (s), number of compared instants, and the step of the reference (s).
const DURATION: f64 = 0.3;
const INSTANTS: usize = 30;
const FINE: f64 = 5e-5;

fn specimen(core: &'static str, element: Element, ramp: Ramp) -> Result<Specimen, LabError> {
    let region = |group: &str, law| {
        Region::new(law, tissue::DENSITY)
            .on(group)
            .with_element(element)
    };
    let problem = Problem {
        regions: vec![
            region("tissue", tissue::soft()),
            region("inclusion", tissue::law(core, RATIO * YOUNGS_MODULUS, 0.45)),
        ],
        damping: tissue::of_mass(10.0),
        loads: vec![LoadSpec::new("top", LoadKind::Traction([300.0, 0.0, -800.0])).with_ramp(ramp)],
        ..tissue::standing(tissue::soft(), element)
    };
    Specimen::new(&inclusion_cube(CELLS, CELLS / 2, EDGE)?, &problem)
}

/// Such a stiff core hardly strains: for any law of the core, equilibria and motions equal those with a core of the
/// tissue's law.
pub(crate) fn check(asked: Asked) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    let rise = Ramp::Sin2 { rise: 0.1 };
    let alike = specimen("neo-hookean", Element::P1, rise.clone())?;
    let rest = alike.equilibrium()?;
    let exact = reference(&alike, FINE, DURATION, INSTANTS)?;
    for core in CORES {
        let body = specimen(core, Element::P1, rise.clone())?;
        let off = relative_distance(&body.equilibrium()?, &rest);
        let demand = Demand::new("distance of the equilibrium", off, 2e-3);
        tally.demand(format!("core {core}"), demand);
        for (planned, limit) in [
            (Planned::must(MethodChoice::new("newmark"), 0.005), 0.01),
            (
                Planned::must(MethodChoice::new("generalized-alpha"), 0.005),
                0.01,
            ),
            (
                Planned::must(MethodChoice::new("implicit-euler"), 0.005),
                0.1,
            ),
            (Planned::must(cut("central-difference"), 0.01), 0.005),
            (
                Planned::may(MethodChoice::new("central-difference"), 0.0025),
                0.005,
            ),
        ] {
            let run = follow(&body, &planned, DURATION, INSTANTS)?;
            let demand = Demand::new("error", run.error(&exact), limit);
            tally.judge(&format!("core {core}"), &planned, &run, demand);
        }
    }
    // Few sweeps do not reach through so stiff a body, but keep its energy.
    for element in [Element::P1, Element::Fbar { patch: None }] {
        let body = specimen("corotational", element, Ramp::Step)?;
        for planned in [
            Planned::must(energy_of("trap", 4), 0.01),
            Planned::must(energy_of("ie", 4), 0.01),
        ] {
            let run = follow(&body, &planned, DURATION, 1)?;
            let demand = Demand::new("rise of the energy in a step", run.rise, ROUNDING);
            tally.judge(&format!("{element}"), &planned, &run, demand);
        }
    }
    Ok(tally.mark(asked))
}

//! One thin element in tissue of each law.

use sinew_core::Ramp;
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_fem::{Element, LoadKind, LoadSpec, Problem};
use sinew_measure::MethodChoice;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

use super::follow::{Planned, follow, reference};
use super::tally::{Demand, Tally};
use crate::hard::mark::Asked;
use crate::hard::meshes::sliver_cube;
use crate::hard::methods::{cut, energy_of};
use crate::results::Mark;
use sinew_verify::LabError;
use sinew_verify::tissue::{self, EDGE, Specimen, YOUNGS_MODULUS};

const CELLS: usize = 4;

/// Thickness of the others over that of the thin element.
const THINNESS: f64 = 100.0;

/// Simulated time (s), number of compared instants, and the step of the reference (s).
const DURATION: f64 = 0.3;
const INSTANTS: usize = 30;
const FINE: f64 = 5e-4;

/// The allowed error (fraction): the reference is the motion of a mesh with one node and three elements less.
const LARGEST: f64 = 0.05;

fn specimen(mesh: &TetMesh, law: &'static str) -> Result<Specimen, LabError> {
    let problem = Problem {
        damping: tissue::of_mass(10.0),
        loads: vec![
            LoadSpec::new("top", LoadKind::Traction([200.0, 0.0, -800.0]))
                .with_ramp(Ramp::Sin2 { rise: 0.1 }),
        ],
        ..tissue::standing(tissue::law(law, YOUNGS_MODULUS, 0.45), Element::P1)
    };
    Specimen::new(mesh, &problem)
}

/// The motion of a pressed cube with a thin element is that of the cube without, at their common nodes.
pub(crate) fn check(asked: Asked) -> Result<Mark, LabError> {
    let mut tally = Tally::default();
    let plain = cube(CELLS, EDGE, Split::Kuhn)?;
    let thin = sliver_cube(CELLS, EDGE, THINNESS)?;
    for law in Hyperelastic::IDS {
        let uniform = specimen(&plain, law)?;
        let exact = reference(&uniform, FINE, DURATION, INSTANTS)?;
        let sliver = specimen(&thin, law)?;
        for planned in [
            Planned::must(MethodChoice::new("newmark"), 0.005),
            Planned::must(MethodChoice::new("generalized-alpha"), 0.005),
            Planned::must(energy_of("trap", 16), 0.005),
            Planned::must(cut("central-difference"), 0.01),
            Planned::may(MethodChoice::new("central-difference"), 0.0025),
        ] {
            let mut run = follow(&sliver, &planned, DURATION, INSTANTS)?;
            // The node that cuts the thin element off is the last one.
            for u in &mut run.track {
                u.truncate(uniform.start.u.len());
            }
            let demand = Demand::new("error", run.error(&exact), LARGEST);
            tally.judge(law, &planned, &run, demand);
        }
    }
    Ok(tally.mark(asked))
}

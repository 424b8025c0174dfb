//! Large deformation of nearly incompressible bodies.

use sinew_core::Ramp;
use sinew_core::vectors::largest;

use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::subject::Subject;
use crate::tissue::{self, EDGES, Specimen, relative_error, rotation_of_top};

pub(super) const SUBJECT: Subject = Subject {
    id: "incompressible",
    title: "Large deformation at nearly constant volume",
    says: "A push as among the large motions, where an element that locked would resist ten times more with nu = .4999 than with .499. And the \
           twisting column of Bonet, Gil, Lee and others (Comput. Methods Appl. Mech. Eng. 283, 2015): 1 x 1 x 6 m, neo-hookean, E = 17 MPa, \
           nu = .495, rho = 1100 kg/m3, spun by 105/s, followed by central difference beyond its farthest turn.",
    checks,
    quoted: &[],
};

fn checks() -> Vec<Check> {
    let locking = Source::ClosedForm(
        "the limit nu = 1/2 exists, and motions differ from it in proportion to 1/2 - nu",
    );
    let mut checks = vec![Check::one(
        "push, fbar-edge",
        "motion with nu = .4999 beside that with .499: relative difference",
        Asked::at_most(0.01),
        locking,
        |_| Ok(relative_error(&pressed(0.4999)?, &pressed(0.499)?)),
    )];
    let meshes = Source::Literature(
        "Bonet, Gil, Lee, Aguirre and Ortigosa, Comput. Methods Appl. Mech. Eng. 283, 2015: the column is twisted alike on all meshes",
    );
    for (coarse, fine, is_long) in [(3, 4, false), (4, 6, true)] {
        let case = format!("twisting column, fbar-edge, {coarse} beside {fine} cells across");
        let figure = "farthest turn of the top over that on the finer mesh";
        let check = Check::one(case, figure, Asked::value(1.0, 0.02), meshes, move |_| {
            Ok(farthest_turn(coarse)? / farthest_turn(fine)?)
        });
        checks.push(check.long(is_long));
    }
    checks
}

/// Displacements under a push at 50 instants.
fn pressed(nu: f64) -> Result<Vec<Vec<f64>>, LabError> {
    let law = tissue::law("neo-hookean", tissue::YOUNGS_MODULUS, nu);
    let specimen = tissue::pressed(6, law, EDGES, 10.0, Ramp::Sin2 { rise: 0.2 })?;
    Ok(specimen.by_central_difference(1e-4, 100, 50)?)
}

/// The largest rotation (rad) of the column's top with `across` cells over the width.
fn farthest_turn(across: usize) -> Result<f64, LabError> {
    let law = tissue::law("neo-hookean", 17e6, 0.495);
    let mut problem = tissue::standing(law, EDGES);
    problem.regions[0].density = 1100.0;
    let cells = [across, across, 6 * across];
    let column: Specimen = tissue::spun_column(cells, [1.0, 1.0, 6.0], 105.0, &problem)?;
    // Waves cross a cell in its width over their speed, 750 m/s.
    let dt = 0.3 / (across as f64 * 750.0);
    const SPAN: f64 = 0.2;
    let instants = 200;
    let steps = (SPAN / dt / instants as f64).ceil();
    let dt = SPAN / (steps * instants as f64);
    let track = column.by_central_difference(dt, steps as usize, instants)?;
    let mut angle = 0.0;
    let turns: Vec<f64> = track
        .iter()
        .map(|u| {
            angle = rotation_of_top(&column, u, angle);
            angle
        })
        .collect();
    Ok(largest(&turns))
}

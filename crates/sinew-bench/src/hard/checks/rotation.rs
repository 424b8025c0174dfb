//! Test that the rotation of a scene rotates its motion.

use sinew_measure::{Case, MethodChoice};

use super::{at, largest_difference, trajectory};
use crate::hard::mark::{Asked, Worst};
use crate::hard::methods::{block, chebyshev, cnn};
use crate::hard::pairs::{QuarterTurn, turned};
use crate::report::three;
use crate::results::Mark;
use sinew_verify::LabError;

/// The largest difference between the rotated motion of a scene and the motion of the rotated scene, over the largest
/// displacement: for quarter turns about x, y and z and several methods.
pub(crate) fn check(asked: Asked, case: &Case) -> Result<Mark, LabError> {
    let simulation = case.simulation();
    let (system, start) = (simulation.system(), simulation.initial_state());
    let dt = simulation.dt();
    let critical = case
        .critical_step()
        .ok_or_else(|| LabError::new("nothing vibrates"))?;
    let methods = [
        (block(), dt),
        (chebyshev(4), dt),
        (MethodChoice::new("newmark"), dt),
        (MethodChoice::new("central-difference"), 0.9 * critical),
        (cnn(), dt),
    ];
    let mut worst = Worst::default();
    for axis in 0..3 {
        let turn = QuarterTurn(axis);
        let twin = turned(simulation, turn)?;
        for (method, dt) in &methods {
            let steps = case.run(*dt).steps;
            let here = trajectory(system, start, method, *dt, steps)?;
            let there = trajectory(&*twin.system, &twin.start, method, *dt, steps)?;
            let here: Vec<Vec<f64>> = here.iter().map(|u| turn.of_field(u)).collect();
            let difference = largest_difference(&there, &here);
            worst.include(difference, at(&method.label(), *dt));
        }
    }
    let names: Vec<String> = methods.iter().map(|(method, _)| method.label()).collect();
    let note = format!("largest of {}, turned about x, y and z", names.join(", "));
    Ok(asked.measured(worst.figure, three, worst.by).noting(note))
}

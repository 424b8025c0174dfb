//! Symmetry: a symmetric motion stays symmetric.

use sinew_measure::{Case, MethodChoice};

use super::{at, trajectory};
use crate::hard::mark::{Asked, Worst};
use crate::hard::methods::{block, chebyshev, cnn, cut};
use crate::hard::pairs::body;
use crate::report::three;
use crate::results::Mark;
use sinew_verify::LabError;

/// The largest `|u_x(mirror image) + u_x|`, and the same in y, over the largest displacement, among
/// several methods.
pub(crate) fn check(asked: Asked, case: &Case) -> Result<Mark, LabError> {
    let simulation = case.simulation();
    let (system, start, dt) = (
        simulation.system(),
        simulation.initial_state(),
        simulation.dt(),
    );
    let images = [images(case, 0)?, images(case, 1)?];
    let mut worst = Worst::default();
    let methods = [
        block(),
        chebyshev(4),
        MethodChoice::new("newmark"),
        cut("central-difference"),
    ];
    let drift_of = |method: &MethodChoice| -> Result<f64, LabError> {
        let path = trajectory(system, start, method, dt, case.run(dt).steps)?;
        Ok(drift(&path, &images))
    };
    for method in &methods {
        let drift = drift_of(method)?;
        worst.include(drift, at(&method.label(), dt));
    }
    let names: Vec<String> = methods.iter().map(MethodChoice::label).collect();
    let note = format!(
        "largest of {}, in x and y, at every step; the paper's network, unstable at this step, lets \
         rounding grow to {}",
        names.join(", "),
        three(drift_of(&cnn())?)
    );
    Ok(asked.measured(worst.figure, three, worst.by).noting(note))
}

/// The largest lateral asymmetry of a trajectory over its largest displacement.
fn drift(path: &[Vec<f64>], images: &[Vec<usize>; 2]) -> f64 {
    let larger = |max: f64, x: f64| {
        if x.is_nan() {
            f64::INFINITY
        } else {
            max.max(x.abs())
        }
    };
    let mut drift = 0.0;
    for u in path {
        for (axis, images) in images.iter().enumerate() {
            for (cell, image) in images.iter().enumerate() {
                drift = larger(drift, u[3 * cell + axis] + u[3 * image + axis]);
            }
        }
    }
    drift / path.iter().flatten().copied().fold(0.0, larger)
}

/// The mirror image of each cell in the middle plane across an axis.
fn images(case: &Case, axis: usize) -> Result<Vec<usize>, LabError> {
    let (built, _) = body(case.simulation())
        .ok_or_else(|| LabError::new("an oscillator has no direction and no mirror image"))?;
    let (low, high) = built.mesh.bounding_box();
    let tolerance = 1e-6 * (high[axis] - low[axis]);
    let points: Vec<[f64; 3]> = built
        .model
        .nodes()
        .iter()
        .map(|node| built.mesh.points[*node as usize])
        .collect();
    let image = |point: &[f64; 3]| {
        let mut mirrored = *point;
        mirrored[axis] = low[axis] + high[axis] - point[axis];
        let near = |other: &[f64; 3]| (0..3).all(|i| (other[i] - mirrored[i]).abs() <= tolerance);
        points
            .iter()
            .position(near)
            .ok_or_else(|| LabError::new("the mesh is not its own mirror image"))
    };
    points.iter().map(image).collect()
}

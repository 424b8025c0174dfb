//! The tissue at a tool between two steps of a simulation.

use sinew_tools::vector::{Vector, add, dot, length, scaled, sub};

use crate::matrix::{Matrix, solved, times};
use crate::published::Published;

/// Tissue as a spring at the position of the tool after a step: the force on a tool at y is `f - K (y - y0)`, without
/// tension along f.
///
/// It is the gradient of a convex energy. So the position of a massless tool between this spring and that of a coupling
/// minimises a sum of two convex energies: the tool moves by no more than the device does, and the force on the device,
/// that of the coupling, is no stiffer than the coupling, for any stiffness of the tissue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LocalModel {
    position: Vector,
    force: Vector,
    stiffness: Matrix,
    /// The direction in which the tissue pushes, if it cannot pull.
    normal: Option<Vector>,
}

impl LocalModel {
    /// The tissue as published by a simulation.
    pub(crate) fn of(published: &Published) -> Self {
        let size = length(published.force);
        let pushes = size > 0.0 && !published.may_pull;
        Self {
            position: published.position,
            force: published.force,
            stiffness: published.stiffness,
            normal: pushes.then(|| scaled(published.force, 1.0 / size)),
        }
    }

    /// The equilibrium position (m) of a massless tool that a coupling of this stiffness (N/m) connects to the device
    /// at a position (m).
    pub(crate) fn tool(&self, coupling: f64, device: Vector) -> Vector {
        let at = self.balance(coupling, device, &self.stiffness, self.force);
        let Some(normal) = self.normal else {
            return at;
        };
        let at_tool = sub(self.force, times(&self.stiffness, sub(at, self.position)));
        if dot(normal, at_tool) >= 0.0 {
            return at;
        }
        // The contact is released by removing the component of the force along the normal.
        let along = times(&self.stiffness, normal);
        let size = dot(normal, along);
        let mut released = self.stiffness;
        for (row, a) in released.iter_mut().zip(along) {
            for (entry, b) in row.iter_mut().zip(along) {
                *entry -= a * b / size;
            }
        }
        let force = sub(self.force, scaled(along, dot(normal, self.force) / size));
        self.balance(coupling, device, &released, force)
    }

    /// The position (m) at which the forces of tissue and coupling add up to 0.
    fn balance(&self, coupling: f64, device: Vector, tissue: &Matrix, force: Vector) -> Vector {
        let mut sum = *tissue;
        for (axis, row) in sum.iter_mut().enumerate() {
            row[axis] += coupling;
        }
        let way = scaled(sub(device, self.position), coupling);
        match solved(&sum, add(way, force)) {
            Some(moved) => add(self.position, moved),
            None => device,
        }
    }

    /// The force (N) on a tool at a position (m).
    pub(crate) fn force(&self, at: Vector) -> Vector {
        let force = sub(self.force, times(&self.stiffness, sub(at, self.position)));
        match self.normal {
            Some(normal) if dot(normal, force) < 0.0 => {
                let along = times(&self.stiffness, normal);
                let share = dot(normal, force) / dot(normal, along);
                sub(force, scaled(along, share))
            }
            _ => force,
        }
    }

    /// The elastic energy (J) of the tissue if it resists with a force (N), as a spring; infinite if it has no
    /// stiffness in that direction.
    pub(crate) fn energy(&self, force: Vector) -> f64 {
        let squared = dot(force, force);
        if squared == 0.0 {
            return 0.0;
        }
        0.5 * squared * squared / dot(force, times(&self.stiffness, force)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn wall(stiffness: f64) -> LocalModel {
        let mut published = Published::free_at([0.0; 3]);
        published.force = [0.0, 0.0, 2.0];
        published.stiffness[2][2] = stiffness;
        LocalModel::of(&published)
    }

    #[test]
    fn a_free_tool_is_where_the_device_is() {
        let free = LocalModel::of(&Published::free_at([0.1; 3]));
        let device = [0.3, -0.2, 0.7];
        assert!(length(sub(free.tool(500.0, device), device)) < 1e-15);
    }

    #[test]
    fn springs_in_series_push_until_the_surface_is_left() {
        // Tissue of 250 N/m behind a coupling of 1000 N/m: 200 N/m together, and no force 8 mm above.
        let wall = wall(250.0);
        for z in [-0.02, -0.001, 0.0, 0.005, 0.0079] {
            let tool = wall.tool(1000.0, [0.4, 0.0, z])[2];
            let expected = 200.0 * (0.008 - z);
            assert!((1000.0 * (tool - z) - expected).abs() < 1e-12, "{z}");
        }
        assert_eq!(wall.tool(1000.0, [0.4, 0.0, 0.0081]), [0.4, 0.0, 0.0081]);
        assert_eq!(wall.force([0.0, 0.0, -0.004]), [0.0, 0.0, 3.0]);
        assert_eq!(wall.force([0.0, 0.0, 0.009]), [0.0; 3]);
        assert_eq!(wall.energy([0.0, 0.0, 2.0]), 0.5 * 4.0 / 250.0);
    }

    proptest! {
        /// Consequences of a convex energy: the tool moves by no more than the device, and the force resists.
        #[test]
        fn the_tool_moves_by_no_more_than_the_device(
            factor in prop::array::uniform3(prop::array::uniform3(-30.0..30.0)),
            force in prop::array::uniform3(-2.0..2.0),
            devices in prop::array::uniform2(prop::array::uniform3(-0.02..0.02)),
            may_pull: bool,
        ) {
            let mut published = Published::free_at([0.001, 0.0, -0.002]);
            published.force = force;
            published.may_pull = may_pull;
            for i in 0..3 {
                for j in 0..3 {
                    published.stiffness[i][j] = dot(factor[i], factor[j]);
                }
            }
            let model = LocalModel::of(&published);
            let tools = devices.map(|device| model.tool(400.0, device));
            let moved = sub(tools[1], tools[0]);
            let by = sub(devices[1], devices[0]);
            prop_assert!(length(moved) <= length(by) * (1.0 + 1e-9) + 1e-12);
            // -(F1 - F0) . (x1 - x0) with F = k (y - x).
            prop_assert!(dot(sub(by, moved), by) >= -1e-12);
            // Firmly so: (x - y) is the gradient.
            prop_assert!(dot(sub(by, moved), moved) >= -1e-11);
            // The tool is where tissue and coupling balance.
            let pull = scaled(sub(devices[0], tools[0]), 400.0);
            prop_assert!(length(add(pull, model.force(tools[0]))) < 1e-9);
        }
    }
}

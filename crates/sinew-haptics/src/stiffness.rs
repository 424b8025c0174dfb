//! Resistance of tissue to a slow displacement of a tool.

use sinew_core::{ElasticLaw, EvaluationError, TangentKind, Trial, vectors};
use sinew_tools::vector::{Vector, cross, dot, scaled};

use crate::matrix::Matrix;

/// Squared length of the free part of a normal below which a cell counts as fixed in its direction.
const HELD: f64 = 1e-6;

/// Cells that a tool carries along when it moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Carried {
    /// The cells, each once.
    cells: Vec<Cell>,
}

/// A cell that is carried along.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    cell: u32,
    free: [bool; 3],
    carry: Carry,
}

impl Cell {
    fn of<'v>(&self, vector: &'v mut [f64]) -> &'v mut [f64] {
        &mut vector[3 * self.cell as usize..][..3]
    }

    /// The normal of a smooth surface, without the fixed directions of the cell, and the same vector divided by its
    /// squared length; `None` for a cell that is carried fully, or that cannot move along the normal.
    fn normal(&self) -> Option<[Vector; 2]> {
        let Carry::Along(normal) = self.carry else {
            return None;
        };
        let free = [0, 1, 2].map(|axis| if self.free[axis] { normal[axis] } else { 0.0 });
        let squared = dot(free, free);
        (squared > HELD).then(|| [free, scaled(free, 1.0 / squared)])
    }

    /// Moves it with a tool that moves by 1 m along an axis.
    fn carry(&self, field: &mut [f64], axis: usize) {
        let own = self.of(field);
        match (self.carry, self.normal()) {
            (Carry::Along(normal), Some([free, scaled])) => {
                let by = normal[axis] - sum(&free, own);
                add(own, &scaled, by);
            }
            (Carry::Along(_), None) => {}
            (Carry::Fully, _) => {
                for (other, value) in own.iter_mut().enumerate() {
                    *value = if other == axis && self.free[axis] {
                        1.0
                    } else {
                        0.0
                    };
                }
            }
        }
    }

    /// Removes from a vector the part that would move it relative to a tool at rest.
    fn leave(&self, vector: &mut [f64]) {
        let own = self.of(vector);
        match (self.carry, self.normal()) {
            (Carry::Along(_), Some([free, scaled])) => {
                let along = sum(&free, own);
                add(own, &scaled, -along);
            }
            (Carry::Along(_), None) => {}
            (Carry::Fully, _) => own.fill(0.0),
        }
    }
}

fn sum(normal: &Vector, of_cell: &[f64]) -> f64 {
    normal.iter().zip(of_cell).map(|(n, value)| n * value).sum()
}

fn add(of_cell: &mut [f64], vector: &Vector, factor: f64) {
    for (value, along) in of_cell.iter_mut().zip(vector) {
        *value += factor * along;
    }
}

/// Constraint by which a tool carries a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carry {
    /// Constraint along this unit normal only, as by a smooth surface.
    Along([f64; 3]),
    /// Constraint in all directions, as by a tool that grasps the cell, or on which the cell does not slip.
    Fully,
}

impl Carried {
    fn leave(&self, vector: &mut [f64]) {
        self.cells.iter().for_each(|cell| cell.leave(vector));
    }

    /// Removes all cells, but keeps the allocated memory.
    pub fn clear(&mut self) {
        self.cells.clear();
    }

    /// Adds a cell that moves in the directions that are free.
    pub fn push(&mut self, cell: u32, free: [bool; 3], carry: Carry) {
        self.cells.push(Cell { cell, free, carry });
    }
}

/// The stiffness (N/m) against displacements of a tool: for each direction the least energy of a displacement field
/// that follows the tool at the carried cells.
///
/// With the fields `u_j` of the three directions it is `u_i' K u_j`. This is the quasi-static value: the stiffness over
/// a step, `P/dt^2` of the nodes in contact, is that of their inertia, hundreds of times larger at 1 ms. The fields
/// come from conjugate gradients in the space of fields that do not move carried cells; they are kept, so that a few
/// iterations per step follow a moving tool. Any such field has more energy than the minimum: the result is an upper
/// bound, and has no negative eigenvalue if the tangent has none.
#[derive(Clone, Debug, Default)]
pub struct LocalStiffness {
    fields: [Vec<f64>; 3],
    /// K times each field.
    pulls: [Vec<f64>; 3],
    residual: Vec<f64>,
    direction: Vec<f64>,
    product: Vec<f64>,
    /// Inverse of a third of the trace of each cell's own block.
    scales: Vec<f64>,
    blocks: Vec<f64>,
}

impl LocalStiffness {
    /// The stiffness for a system with this number of degrees of freedom, in cells of three layers.
    #[must_use]
    pub fn new(dofs: usize) -> Self {
        let zeros = || vec![0.0; dofs];
        Self {
            fields: [zeros(), zeros(), zeros()],
            pulls: [zeros(), zeros(), zeros()],
            residual: zeros(),
            direction: zeros(),
            product: zeros(),
            scales: vec![0.0; dofs / 3],
            blocks: vec![0.0; 3 * dofs],
        }
    }

    /// Does more iterations with the tangent at a trial point, and returns the stiffness: 0 if nothing is carried.
    ///
    /// An iteration costs three products with the tangent, and each call three more. If the tangent or the resulting
    /// stiffness is not positive, the tangent with element matrices without negative eigenvalues is used instead.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law is outside its domain.
    pub fn refine(
        &mut self,
        law: &dyn ElasticLaw,
        trial: &Trial<'_>,
        carried: &Carried,
        iterations: usize,
    ) -> Result<Matrix, EvaluationError> {
        if carried.cells.is_empty() {
            self.fields.iter_mut().for_each(|field| field.fill(0.0));
            return Ok([[0.0; 3]; 3]);
        }
        self.scale(law, trial)?;
        for kind in [TangentKind::Exact, TangentKind::Projected] {
            let mut is_sound = true;
            for axis in 0..3 {
                is_sound &= self.refine_field(axis, (law, kind), trial, carried, iterations)?;
            }
            let stiffness = self.gram();
            if (is_sound && is_semidefinite(&stiffness)) || kind == TangentKind::Projected {
                return Ok(stiffness);
            }
        }
        Ok([[0.0; 3]; 3])
    }

    /// The products of the fields with K times the fields.
    fn gram(&self) -> Matrix {
        let product = |a: usize, b: usize| vectors::dot(&self.fields[a], &self.pulls[b]);
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (product(i, j) + product(j, i))))
    }

    fn scale(&mut self, law: &dyn ElasticLaw, trial: &Trial<'_>) -> Result<(), EvaluationError> {
        law.node_blocks(trial, &mut self.blocks)?;
        let blocks = self.blocks.as_chunks::<9>().0;
        for (block, scale) in blocks.iter().zip(&mut self.scales) {
            let trace = block[0] + block[4] + block[8];
            *scale = if trace > 0.0 { 3.0 / trace } else { 0.0 };
        }
        Ok(())
    }

    /// Conjugate gradients for the field of a direction; returns true if the tangent was positive along all search
    /// directions. Scales are equal for all directions of a cell, so that they commute with the projection onto free
    /// displacements.
    fn refine_field(
        &mut self,
        axis: usize,
        (law, kind): (&dyn ElasticLaw, TangentKind),
        trial: &Trial<'_>,
        carried: &Carried,
        iterations: usize,
    ) -> Result<bool, EvaluationError> {
        let Self {
            fields,
            pulls,
            residual,
            direction,
            product,
            scales,
            ..
        } = self;
        let (field, pull) = (&mut fields[axis], &mut pulls[axis]);
        for cell in &carried.cells {
            cell.carry(field, axis);
        }
        law.tangent_product(trial, kind, field, pull)?;
        for (value, pull) in residual.iter_mut().zip(pull.iter()) {
            *value = -pull;
        }
        carried.leave(residual);
        let mut size = scaled_square(residual, scales);
        direction.fill(0.0);
        let mut share = 0.0;
        for _ in 0..iterations {
            if size == 0.0 {
                break;
            }
            for (cell, scale) in scales.iter().enumerate() {
                for index in 3 * cell..3 * cell + 3 {
                    direction[index] = residual[index] * scale + share * direction[index];
                }
            }
            law.tangent_product(trial, kind, direction, product)?;
            let curvature = vectors::dot(direction, product);
            if curvature <= 0.0 {
                return Ok(false);
            }
            let step = size / curvature;
            for index in 0..field.len() {
                field[index] += step * direction[index];
                pull[index] += step * product[index];
                residual[index] -= step * product[index];
            }
            carried.leave(residual);
            let next = scaled_square(residual, scales);
            (share, size) = (next / size, next);
        }
        Ok(true)
    }
}

/// True if a symmetric matrix has no negative eigenvalue, except for rounding: tested by its principal minors.
fn is_semidefinite(matrix: &Matrix) -> bool {
    let [a, b, c] = *matrix;
    let scale = a[0].abs().max(b[1].abs()).max(c[2].abs());
    let small = 1e-9 * scale;
    let minors = [
        a[0] * b[1] - a[1] * a[1],
        a[0] * c[2] - a[2] * a[2],
        b[1] * c[2] - b[2] * b[2],
    ];
    let all = dot(a, cross(b, c));
    a[0].min(b[1]).min(c[2]) >= -small
        && minors.iter().all(|minor| *minor >= -small * scale)
        && all >= -small * scale * scale
}

/// The sum of squares, each times the scale of its cell.
fn scaled_square(vector: &[f64], scales: &[f64]) -> f64 {
    let cells = vector.as_chunks::<3>().0.iter().zip(scales);
    cells
        .map(|(of_cell, scale)| scale * dot(*of_cell, *of_cell))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minors_tell_of_negative_eigenvalues() {
        let matrix = |last: f64| [[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, last]];
        // det = 3 last - 2.
        assert!(is_semidefinite(&matrix(2.0 / 3.0)));
        assert!(is_semidefinite(&[[0.0; 3]; 3]));
        assert!(!is_semidefinite(&matrix(0.66)));
        assert!(!is_semidefinite(&[
            [1.0, 2.0, 0.0],
            [2.0, 1.0, 0.0],
            [0.0, 0.0, 1.0]
        ]));
    }
}

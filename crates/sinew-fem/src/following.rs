//! Pressure that follows a surface as it deforms.

use sinew_core::{BlockMatrix, ElementStiffness, EvaluationError, LoadTime, Ramp};
use sinew_mesh::TetMesh;
use sinew_mesh::vector::{add as plus, cross, sub as minus};

use crate::cells::Cells;
use crate::elements::moving_part;

/// Follower pressure on triangles: the difference of its forces from those on the surface at rest, which are an
/// ordinary load.
///
/// The force on a triangle with the corners a, b and c is `-p/2 (x_b - x_a) x (x_c - x_a)`, a third of it on each: this
/// is exact for a pressure on flat triangles, since each corner's shape function has a third of the area.
#[derive(Clone, Debug)]
pub(crate) struct FollowingPressure {
    /// Place of the load in the problem, which is its place among the model's loads.
    pub(crate) load: usize,
    ramp: Ramp,
    /// Pressure (Pa) at factor 1.
    pressure: f64,
    /// Triangles, seen counter-clockwise from outside.
    triangles: Vec<Triangle>,
}

/// A part of a derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Symmetric,
    Skew,
}

#[derive(Clone, Copy, Debug)]
struct Triangle {
    nodes: [u32; 3],
    /// From the first corner to the others, at rest (m).
    edges: [[f64; 3]; 2],
}

impl Triangle {
    /// The edge (m) opposite each corner, with this displacement.
    fn opposite_edges(&self, displacement: impl Fn(u32) -> [f64; 3]) -> [[f64; 3]; 3] {
        let [a, b, c] = self.nodes.map(displacement);
        // The origin is the first corner's place at rest.
        let corners = [a, plus(self.edges[0], b), plus(self.edges[1], c)];
        [0, 1, 2].map(|k| minus(corners[(k + 1) % 3], corners[(k + 2) % 3]))
    }
}

impl FollowingPressure {
    /// The pressure (Pa) of a load on outward triangles; `None` without any.
    pub(crate) fn new(
        mesh: &TetMesh,
        (load, ramp, pressure): (usize, &Ramp, f64),
        triangles: impl Iterator<Item = [u32; 3]>,
    ) -> Option<Self> {
        let triangles = triangles.map(|nodes| {
            let [a, b, c] = nodes.map(|node| mesh.points[node as usize]);
            Triangle {
                nodes,
                edges: [minus(b, a), minus(c, a)],
            }
        });
        let triangles: Vec<Triangle> = triangles.collect();
        (!triangles.is_empty()).then(|| Self {
            load,
            ramp: ramp.clone(),
            pressure,
            triangles,
        })
    }

    /// The same, with another factor over time.
    pub(crate) fn with_ramp(&self, ramp: Ramp) -> Self {
        Self {
            ramp,
            ..self.clone()
        }
    }

    /// The factor at a time.
    pub(crate) fn factor(&self, when: LoadTime<'_>) -> f64 {
        self.ramp.factor(when)
    }

    /// Calls `add` with nodes and the forces (N) on them at a factor, less those on the surface at rest.
    pub(crate) fn forces(
        &self,
        factor: f64,
        displacement: impl Fn(u32) -> [f64; 3],
        mut add: impl FnMut(u32, [f64; 3]),
    ) {
        let share = factor * self.pressure / -6.0;
        if share == 0.0 {
            return;
        }
        for Triangle { nodes, edges } in &self.triangles {
            let [a, b, c] = nodes.map(&displacement);
            let (first, second) = (minus(b, a), minus(c, a));
            // Of (e + d) x (f + g) what goes beyond e x f, without a difference of large numbers.
            let [e, f] = *edges;
            let changes = [cross(e, second), cross(first, f), cross(first, second)];
            let force = [0, 1, 2]
                .map(|axis| share * changes.iter().map(|change| change[axis]).sum::<f64>());
            nodes.iter().for_each(|node| add(*node, force));
        }
    }

    /// Adds `-factor` times the symmetric part of the derivative (N/m) of the forces: their load stiffness.
    ///
    /// With `w_a = x_b - x_c` and its cyclic permutations, `df_i/dx_j = p/6 [w_j]_x` at each corner i. The part that is
    /// not symmetric cancels along edges between two triangles and remains only at free edges of the loaded surface
    /// (Bufler, ZAMP 35, 1984).
    ///
    /// # Errors
    /// [`EvaluationError`] if the matrix has no block for two corners.
    pub(crate) fn add_stiffness(
        &self,
        factor: f64,
        cells: &Cells,
        displacement: impl Fn(u32) -> [f64; 3],
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        let share = factor * self.pressure / -12.0;
        if share == 0.0 {
            return Ok(());
        }
        let mut moving = ElementStiffness::default();
        for triangle in &self.triangles {
            let opposite = triangle.opposite_edges(&displacement);
            let mut whole = [0.0; 81];
            for i in 0..3 {
                for j in 0..3 {
                    let [x, y, z] = minus(opposite[j], opposite[i]).map(|w| share * w);
                    let rows = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
                    for (row, entries) in rows.iter().enumerate() {
                        let first = (3 * i + row) * 9 + 3 * j;
                        whole[first..first + 3].copy_from_slice(entries);
                    }
                }
            }
            moving_part(&whole, &triangle.nodes, cells, &mut moving);
            out.add_element(&moving.cells, &moving.matrix)?;
        }
        Ok(())
    }

    /// Calls `add` with nodes and a part of the derivative of `-factor` times the forces, times a change of the displacement (N).
    pub(crate) fn stiffness_product(
        &self,
        (part, factor): (Part, f64),
        displacement: impl Fn(u32) -> [f64; 3],
        change: impl Fn(u32) -> [f64; 3],
        mut add: impl FnMut(u32, [f64; 3]),
    ) {
        let share = factor * self.pressure / -12.0;
        for triangle in &self.triangles {
            let opposite = triangle.opposite_edges(&displacement);
            let moved = triangle.nodes.map(&change);
            for i in 0..3 {
                let mut force = [0.0; 3];
                for j in 0..3 {
                    let edge = match part {
                        Part::Symmetric => minus(opposite[j], opposite[i]),
                        Part::Skew => plus(opposite[j], opposite[i]),
                    };
                    force = plus(force, cross(edge, moved[j]));
                }
                add(triangle.nodes[i], force.map(|force| share * force));
            }
        }
    }
}

//! Rows of K, gathered from the tetrahedra at their nodes.

use sinew_core::{BlockMatrix, CutRows};
use sinew_cutting::CuttableBody;
use sinew_mesh::TetMesh;

use super::touched::Touched;
use crate::cells::Cells;
use crate::error::FemError;
use crate::material::Material;
use crate::tetra;
use crate::volumes::flat;

/// Placeholder for a tetrahedron without a shape.
const NONE: u32 = u32::MAX;

/// Rows of K that a split changes. Repeated use allocates nothing.
#[derive(Debug)]
pub(super) struct Gathering {
    /// Place of each tetrahedron among the shapes.
    shape_of: Vec<u32>,
    /// The tetrahedra that have one.
    tets: Vec<u32>,
    shapes: Vec<Shape>,
    row: Row,
    pub(super) rows: CutRows,
}

/// Geometry and moduli that determine the stiffness of a tetrahedron.
#[derive(Clone, Copy, Debug)]
struct Shape {
    volume: f64,
    lame: [f64; 2],
    gradients: [[f64; 3]; 4],
}

/// A row under construction: columns in the order of their insertion, and their blocks.
#[derive(Debug, Default)]
struct Row {
    columns: Vec<u32>,
    blocks: Vec<[f64; 9]>,
    order: Vec<u32>,
}

/// The body after a split, from which rows are gathered.
pub(super) struct Source<'a> {
    pub(super) body: &'a CuttableBody,
    pub(super) mesh: &'a TetMesh,
    pub(super) cells: &'a Cells,
    pub(super) region_of: &'a [u32],
    pub(super) materials: &'a [Material],
    /// Lumped masses (kg) of the nodes.
    pub(super) masses: &'a [f64],
    /// K before the split.
    pub(super) stiffness: &'a BlockMatrix,
}

impl Source<'_> {
    /// The tetrahedra at a node in the order in which an assembly adds them: region by region.
    fn tets_at(&self, node: u32) -> impl Iterator<Item = u32> {
        let regions = 0..self.materials.len() as u32;
        let tets = self.body.tets_at(node);
        regions.flat_map(move |region| {
            let of_region = move |tet: &u32| self.region_of[*tet as usize] == region;
            tets.iter().copied().filter(of_region)
        })
    }
}

impl Row {
    fn clear(&mut self) {
        self.columns.clear();
        self.blocks.clear();
    }

    /// The block of a column, zero at first.
    fn block(&mut self, column: u32) -> &mut [f64; 9] {
        let place = self.columns.iter().position(|other| *other == column);
        let place = place.unwrap_or_else(|| {
            self.columns.push(column);
            self.blocks.push([0.0; 9]);
            self.columns.len() - 1
        });
        &mut self.blocks[place]
    }

    /// Clears the coupling of the fixed components of a cell.
    fn clear_held(&mut self, cell: u32, pinned: &[bool]) {
        for (column, block) in self.columns.iter().zip(&mut self.blocks) {
            for (k, entry) in block.iter_mut().enumerate() {
                if pinned[3 * cell as usize + k / 3] || pinned[3 * *column as usize + k % 3] {
                    *entry = 0.0;
                }
            }
        }
    }
}

impl Gathering {
    /// Scratch space for rows of `cells` cells of a body of `tets` tetrahedra.
    pub(super) fn with_room(cells: usize, tets: usize) -> Self {
        let shapes = tets.min(24 * cells);
        Self {
            shape_of: vec![NONE; tets],
            tets: Vec::with_capacity(shapes),
            shapes: Vec::with_capacity(shapes),
            row: Row {
                columns: Vec::with_capacity(256),
                blocks: Vec::with_capacity(256),
                order: Vec::with_capacity(256),
            },
            rows: CutRows::with_room(4 * cells, 64 * cells),
        }
    }

    /// Gathers the rows of all touched nodes that are cells; the result equals an assembly to the bit.
    pub(super) fn gather(&mut self, of: &Source<'_>, touched: &Touched) -> Result<(), FemError> {
        self.rows.clear();
        for tet in self.tets.drain(..) {
            self.shape_of[tet as usize] = NONE;
        }
        self.shapes.clear();
        let partly_held = of.cells.partly_held();
        for &node in touched.nodes() {
            let Some(cell) = of.cells.of_node(node) else {
                continue;
            };
            self.row.clear();
            if touched.is_made_anew(node) {
                self.add_all(of, node)?;
            } else {
                self.keep(of, cell, touched);
                self.add_split(of, node, touched)?;
            }
            if partly_held {
                self.row.clear_held(cell, &of.cells.pinned);
            }
            let Row {
                columns,
                blocks,
                order,
            } = &mut self.row;
            order.clear();
            order.extend(0..columns.len() as u32);
            order.sort_unstable_by_key(|place| columns[*place as usize]);
            let sorted = order.iter().map(|place| *place as usize);
            let sorted = sorted.map(|place| (columns[place], &blocks[place][..]));
            self.rows.push(cell, &[of.masses[node as usize]; 3], sorted);
        }
        Ok(())
    }

    /// Adds all contributions of the tetrahedra at a node.
    fn add_all(&mut self, of: &Source<'_>, node: u32) -> Result<(), FemError> {
        for tet in of.tets_at(node) {
            let Shape {
                volume,
                lame,
                gradients,
            } = *self.shape(of, tet)?;
            let nodes = of.body.tets()[tet as usize];
            let Some(own) = nodes.iter().position(|other| *other == node) else {
                continue;
            };
            let mut rows = [0.0; 36];
            tetra::stiffness_rows(volume, lame, &gradients[own], &gradients, &mut rows);
            for (vertex, other) in nodes.into_iter().enumerate() {
                if let Some(column) = of.cells.of_node(other) {
                    let block = self.row.block(column);
                    for (axis, row) in block.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                        let added = &rows[12 * axis + 3 * vertex..];
                        row.iter_mut()
                            .zip(added)
                            .for_each(|(sum, entry)| *sum += entry);
                    }
                }
            }
        }
        Ok(())
    }

    /// Copies the blocks of a cell's row that a split does not change.
    fn keep(&mut self, of: &Source<'_>, cell: u32, touched: &Touched) {
        for (column, block) in of.stiffness.row_blocks(cell as usize) {
            if !touched.is_split(of.cells.nodes[column])
                && let Ok(block) = block.try_into()
            {
                self.row.columns.push(column as u32);
                self.row.blocks.push(block);
            }
        }
    }

    /// Adds the coupling of a node to the nodes that were split.
    fn add_split(&mut self, of: &Source<'_>, node: u32, touched: &Touched) -> Result<(), FemError> {
        for tet in of.tets_at(node) {
            let nodes = of.body.tets()[tet as usize];
            if !nodes.iter().any(|other| touched.is_split(*other)) {
                continue;
            }
            let Shape {
                volume,
                lame,
                gradients,
            } = *self.shape(of, tet)?;
            let Some(own) = nodes.iter().position(|other| *other == node) else {
                continue;
            };
            for (vertex, other) in nodes.into_iter().enumerate() {
                let column = of.cells.of_node(other);
                if let Some(column) = column.filter(|_| touched.is_split(other)) {
                    let mut added = [0.0; 9];
                    let of_vertex = &gradients[vertex..=vertex];
                    tetra::stiffness_rows(volume, lame, &gradients[own], of_vertex, &mut added);
                    let block = self.row.block(column);
                    block
                        .iter_mut()
                        .zip(added)
                        .for_each(|(sum, entry)| *sum += entry);
                }
            }
        }
        Ok(())
    }

    fn shape(&mut self, of: &Source<'_>, tet: u32) -> Result<&Shape, FemError> {
        let place = &mut self.shape_of[tet as usize];
        if *place == NONE {
            let number = tet as usize;
            let vertices = tetra::vertices(&of.mesh.points, of.mesh.tets[number]);
            let material = &of.materials[of.region_of[number] as usize];
            let lame = material.lame_of_plain(number);
            let (Some((volume, gradients)), Some(lame)) =
                (tetra::volume_and_gradients(&vertices), lame)
            else {
                return Err(flat(of.mesh, number, 0.0));
            };
            *place = self.shapes.len() as u32;
            self.tets.push(tet);
            self.shapes.push(Shape {
                volume,
                lame,
                gradients,
            });
        }
        Ok(&self.shapes[*place as usize])
    }
}

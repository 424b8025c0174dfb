//! Pieces of a grid that are joined to a mesh.

use super::cells::Cells;
use super::labels;
use crate::mesh::{CellBlock, CellData, Mesh, PointData};
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

/// A named array of numbers at the points or in the cells of a piece.
pub(crate) struct Field {
    pub(crate) name: String,
    /// Numbers for each point or cell, at least 1.
    pub(crate) components: usize,
    /// True if the file stores integers.
    pub(crate) is_integer: bool,
    pub(crate) values: Vec<f64>,
}

/// A grid whose pieces are added one after another.
#[derive(Default)]
pub(crate) struct GridBuilder {
    points: Vec<[f64; 3]>,
    blocks: Vec<CellBlock>,
    point_fields: Vec<Field>,
    cell_fields: Vec<Field>,
    /// Names of fields that some pieces lack.
    dropped: Vec<String>,
}

impl GridBuilder {
    /// Adds a piece. The length of its fields fits its points and cells.
    pub(crate) fn add(
        &mut self,
        points: Vec<[f64; 3]>,
        cells: &Cells,
        point_fields: Vec<Field>,
        cell_fields: Vec<Field>,
    ) -> Result<(), Fault> {
        let (before, cells_before) = (self.points.len(), self.cell_count());
        cells.add_to(&mut self.blocks, points.len(), before)?;
        match before {
            0 => self.points = points,
            _ => self.points.extend(points),
        }
        let points = (before, self.points.len());
        add_fields(
            &mut self.point_fields,
            point_fields,
            points,
            &mut self.dropped,
        );
        let cells = (cells_before, self.cell_count());
        add_fields(&mut self.cell_fields, cell_fields, cells, &mut self.dropped);
        Ok(())
    }

    fn cell_count(&self) -> usize {
        self.blocks.iter().map(CellBlock::len).sum()
    }

    /// The mesh: points and cells numbered from 1, and groups from the arrays that contain groups.
    pub(crate) fn finish(mut self, remarks: &mut Remarks) -> Mesh {
        self.dropped.sort_unstable();
        self.dropped.dedup();
        for name in &self.dropped {
            remarks.general(format!(
                "data \"{name}\": left out, since not all pieces of the grid have them"
            ));
        }
        let mut mesh = Mesh {
            points: self.points,
            cells: self.blocks,
            ..Mesh::default()
        };
        mesh.number_from_one();
        for field in self.point_fields {
            mesh.point_data.push(PointData {
                values: checked(field.values, &field.name, field.is_integer, remarks),
                name: field.name,
                step: 0,
                time: 0.0,
                components: field.components,
            });
        }
        for field in self.cell_fields {
            let values = checked(field.values, &field.name, field.is_integer, remarks);
            let mut rest = values.as_slice();
            let blocks = mesh.cells.iter().map(|block| {
                let (own, after) = rest
                    .split_at_checked(block.len() * field.components)
                    .unwrap_or_default();
                rest = after;
                own.to_vec()
            });
            mesh.cell_data.push(CellData {
                blocks: blocks.collect(),
                name: field.name,
                step: 0,
                time: 0.0,
                components: field.components,
            });
        }
        labels::take(&mut mesh);
        mesh
    }
}

/// Adds the fields of a piece to those of the pieces before it, which had `before` points or cells of `after`. Fields
/// that are missing in some pieces are left out and named in `dropped`, as in VTK: if they were filled up, a few bytes
/// could need any amount of memory.
fn add_fields(
    known: &mut Vec<Field>,
    mut added: Vec<Field>,
    (before, after): (usize, usize),
    dropped: &mut Vec<String>,
) {
    if before == 0 {
        *known = added;
        return;
    }
    if before == after {
        return;
    }
    known.retain_mut(|field| {
        let same =
            |other: &Field| (&other.name, other.components) == (&field.name, field.components);
        let place = added.iter().position(same);
        match place {
            Some(place) => field.values.extend(added.remove(place).values),
            None => dropped.push(field.name.clone()),
        }
        place.is_some()
    });
    dropped.extend(added.into_iter().map(|field| field.name));
}

/// Largest number up to which all whole numbers are exact in f64.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// The values, with infinite ones replaced by NaN, which means no value.
fn checked(mut values: Vec<f64>, name: &str, is_integer: bool, remarks: &mut Remarks) -> Vec<f64> {
    if is_integer && values.iter().any(|value| value.abs() > EXACT) {
        remarks.general(format!(
            "data \"{name}\": whole numbers beyond 2^53, which are rounded"
        ));
    }
    let mut infinite = 0;
    for value in values.iter_mut().filter(|value| value.is_infinite()) {
        *value = f64::NAN;
        infinite += 1;
    }
    if infinite > 0 {
        remarks.general(format!(
            "data \"{name}\": infinite numbers, taken as no value: {infinite}"
        ));
    }
    values
}

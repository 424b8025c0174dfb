//! Writes a mesh with its data fields.

use std::io::Write;

use super::error::WriteVtuError;
use super::grid::{Array, Grid, Values};
use super::out::VtuEncoding;
use super::write::write_vtu_grid;
use crate::mesh::{CellBlock, Mesh};

/// Writes a mesh with its data fields as .vtu.
///
/// Arrays keep the names of their fields; of several fields of one name, all but the first get their
/// time step appended. Cells have their first group as `gmsh:physical`, their entity as `gmsh:geometrical` and their
/// tag as `gmsh:element_tag`; points have `gmsh:node_tag`. Values at the nodes of elements are not written.
///
/// # Errors
///
/// If VTK has no cells of a type in the mesh, the mesh contradicts itself, or the destination fails. `wedge18` and
/// `pyramid14` are refused, because the mesh has their nodes in gmsh's order.
pub fn write_vtu(
    mesh: &Mesh,
    encoding: VtuEncoding,
    to: &mut impl Write,
) -> Result<(), WriteVtuError> {
    let point_names = distinct_names(mesh.point_data.iter().map(|data| (&data.name, data.step)));
    let cell_names = distinct_names(mesh.cell_data.iter().map(|data| (&data.name, data.step)));
    let mut point_data = Vec::new();
    if !mesh.node_tags.is_empty() {
        let tags = mesh.node_tags.iter().map(|&tag| tag as i64);
        point_data.push(Array::of_integers(
            "gmsh:node_tag",
            tags.collect::<Vec<_>>(),
        ));
    }
    for (data, name) in mesh.point_data.iter().zip(&point_names) {
        point_data.push(Array {
            name,
            components: data.components,
            values: Values::F64(data.values.as_slice().into()),
        });
    }
    let of_cells = |value: &dyn Fn(&CellBlock, usize) -> i64| -> Vec<i64> {
        let blocks = mesh.cells.iter();
        blocks
            .flat_map(|block| (0..block.len()).map(move |cell| value(block, cell)))
            .collect()
    };
    let mut cell_data = vec![
        Array::of_integers(
            "gmsh:physical",
            of_cells(&|block, cell| i64::from(block.physical.first_of(cell))),
        ),
        Array::of_integers(
            "gmsh:geometrical",
            of_cells(&|block, cell| block.geometrical.get(cell).copied().unwrap_or(0).into()),
        ),
    ];
    if mesh
        .cells
        .iter()
        .all(|block| block.element_tags.len() == block.len())
    {
        let tags = mesh.cells.iter().flat_map(|block| &block.element_tags);
        let tags: Vec<i64> = tags.map(|&tag| tag as i64).collect();
        cell_data.push(Array::of_integers("gmsh:element_tag", tags));
    }
    for (data, name) in mesh.cell_data.iter().zip(&cell_names) {
        cell_data.push(Array {
            name,
            components: data.components,
            values: Values::F64(data.blocks.concat().into()),
        });
    }
    let cells = mesh.cells.iter();
    let grid = Grid {
        points: &mesh.points,
        cells: cells
            .map(|block| (block.kind, block.connectivity.as_slice()))
            .collect(),
        point_data,
        cell_data,
    };
    write_vtu_grid(&grid, encoding, to)
}

/// The names, with the time step appended where a name has been used before.
fn distinct_names<'n>(fields: impl Iterator<Item = (&'n String, i32)>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (name, step) in fields {
        let mut distinct = name.clone();
        if names.contains(name) {
            distinct = format!("{name} {step}");
        }
        while names.contains(&distinct) {
            distinct.push('\'');
        }
        names.push(distinct);
    }
    names
}

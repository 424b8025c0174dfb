//! Writes a mesh with its data fields.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;

use super::error::WriteVtuError;
use super::grid::{Array, Grid, Values};
use super::out::VtuEncoding;
use super::write::write_vtu_grid;
use crate::mesh::{CellBlock, Mesh};

/// Writes a mesh with its data fields as .vtu.
///
/// Arrays keep the names of their fields; of several fields of one name, all but the first get their time step
/// appended. Cells have their first group as `gmsh:physical`, their entity as `gmsh:geometrical` and their tag as
/// `gmsh:element_tag`; points have `gmsh:node_tag`. Each named group is a separate array, `group NAME`, 1 in its cells
/// and 0 elsewhere, so that names stay and groups may overlap; if groups of several dimensions share a name, they share
/// the array. Values at the nodes of elements are not written.
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
    let groups = named_groups(mesh);
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
    for (name, is_member) in &groups {
        cell_data.push(Array::of_integers(name, is_member.as_slice()));
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

/// The name of the array of each named group, and 1 for each of its cells, 0 for the others.
fn named_groups(mesh: &Mesh) -> Vec<(String, Vec<i64>)> {
    let cells: usize = mesh.cells.iter().map(CellBlock::len).sum();
    let names: BTreeSet<&str> = mesh.physical_names.values().map(String::as_str).collect();
    let mut groups: Vec<(String, Vec<i64>)> = names
        .iter()
        .map(|name| (format!("group {name}"), vec![0; cells]))
        .collect();
    let index_of: BTreeMap<(u8, i32), usize> = mesh
        .physical_names
        .iter()
        .filter_map(|(&key, name)| Some((key, names.iter().position(|other| other == name)?)))
        .collect();
    let mut cell = 0;
    for block in &mesh.cells {
        for tags in (0..block.len()).map(|index| block.physical.of(index)) {
            for tag in tags {
                if let Some(&group) = index_of.get(&(block.kind.dim(), tag.saturating_abs())) {
                    groups[group].1[cell] = 1;
                }
            }
            cell += 1;
        }
    }
    groups
}

/// The names, with the time step appended if a name has been used before.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structured::{Split, cube};
    use crate::tet_mesh::GroupMembers;

    #[test]
    fn groups_that_overlap_are_arrays_of_their_own() {
        let mut cube = cube(1, 0.1, Split::Kuhn).expect("valid");
        cube.add_group("half", GroupMembers::Tets(vec![1, 4, 5]))
            .expect("it is new");
        let mut mesh = cube.to_mesh();
        // Another dimension may have a group of the same name, and the sign of a tag does not matter.
        mesh.physical_names.insert((2, 3), "half".to_owned());
        let groups: BTreeMap<String, Vec<i64>> = named_groups(&mesh).into_iter().collect();
        let names: Vec<&str> = groups.keys().map(String::as_str).collect();
        let expected = ["group bottom", "group half", "group sides", "group tissue"];
        assert_eq!(names, expected);
        let count = |name: &str| groups[name].iter().sum::<i64>();
        assert_eq!(expected.map(count), [2, 2 + 3, 8, 6]);
        assert!(groups.values().all(|array| array.len() == 12 + 6));
        // The tetrahedra of both groups are in a block of their own.
        let in_both = (0..18).filter(|&i| groups["group half"][i] + groups["group tissue"][i] == 2);
        assert_eq!(in_both.count(), 3);
    }
}

//! Arrays with tags and groups of cells: those that [`write_vtu`](crate::vtu::write_vtu) writes; meshio writes the
//! first two as well.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use crate::mesh::{CellBlock, CellData, Mesh};
use crate::physical_tags::PhysicalTags;

const PHYSICAL: &str = "gmsh:physical";
const GEOMETRICAL: &str = "gmsh:geometrical";
const ELEMENT_TAG: &str = "gmsh:element_tag";
const NODE_TAG: &str = "gmsh:node_tag";
/// Beginning of the name of an array that is 1 in the cells of a group and 0 elsewhere.
const GROUP: &str = "group ";

/// Turns such arrays into tags and groups instead of data.
pub(super) fn take(mesh: &mut Mesh) {
    take_node_tags(mesh);
    take_element_tags(mesh);
    if let Some(entities) = take_integers(mesh, GEOMETRICAL, |_| true) {
        for (block, entities) in mesh.cells.iter_mut().zip(entities) {
            block.geometrical = entities;
        }
    }
    let first = take_integers(mesh, PHYSICAL, |_| true);
    let named = take_named(mesh);
    if first.is_none() && named.is_empty() {
        return;
    }
    let no_group = |block: &CellBlock| vec![0; block.len()];
    let first = first.unwrap_or_else(|| mesh.cells.iter().map(no_group).collect());
    give_groups(mesh, &first, &named);
}

fn take_node_tags(mesh: &mut Mesh) {
    let is_tag = |x: &f64| x.fract() == 0.0 && (1.0..9e15).contains(x);
    let found = mesh.point_data.iter().position(|data| {
        let values = &data.values;
        let distinct = || values.iter().map(|x| x.to_bits()).collect::<HashSet<_>>();
        data.name == NODE_TAG
            && data.components == 1
            && values.iter().all(is_tag)
            && distinct().len() == values.len()
    });
    if let Some(found) = found {
        let data = mesh.point_data.remove(found);
        mesh.node_tags = data.values.into_iter().map(|x| x as u64).collect();
    }
}

fn take_element_tags(mesh: &mut Mesh) {
    let tags = take_integers(mesh, ELEMENT_TAG, |tag| tag >= 1);
    for (block, tags) in mesh.cells.iter_mut().zip(tags.into_iter().flatten()) {
        block.element_tags = tags
            .into_iter()
            .filter_map(|tag| u64::try_from(tag).ok())
            .collect();
    }
}

/// Removes and returns the cell data with a name: one whole number of 32 bits that fits for each cell.
fn take_integers(mesh: &mut Mesh, name: &str, fits: impl Fn(i32) -> bool) -> Option<Vec<Vec<i32>>> {
    let as_integer = |x: &f64| {
        let is_integer = x.fract() == 0.0 && x.abs() <= f64::from(i32::MAX);
        Some(*x as i32).filter(|integer| is_integer && fits(*integer))
    };
    let data = mesh.cell_data.iter().enumerate();
    let (place, integers) = data
        .filter(|(_, data)| data.name == name && data.components == 1)
        .find_map(|(place, data)| {
            let blocks = data.blocks.iter();
            let integers: Option<Vec<Vec<i32>>> = blocks
                .map(|block| block.iter().map(as_integer).collect())
                .collect();
            Some((place, integers?))
        })?;
    mesh.cell_data.remove(place);
    Some(integers)
}

/// A group: its name, and a flag for each cell of each block, true if the group contains it.
struct Named {
    name: String,
    members: Vec<Vec<bool>>,
}

fn take_named(mesh: &mut Mesh) -> Vec<Named> {
    let mut named = Vec::new();
    mesh.cell_data.retain(|data| {
        let group = group_of(data);
        let is_group = group.is_some();
        named.extend(group);
        !is_group
    });
    named
}

fn group_of(data: &CellData) -> Option<Named> {
    let name = data.name.strip_prefix(GROUP)?;
    let mut values = data.blocks.iter().flatten();
    let is_flag = data.components == 1 && values.all(|x| *x == 0.0 || *x == 1.0);
    (is_flag && !name.is_empty()).then(|| Named {
        name: name.to_owned(),
        members: data
            .blocks
            .iter()
            .map(|block| block.iter().map(|x| *x == 1.0).collect())
            .collect(),
    })
}

/// Cells that have a first tag, and those among them that are in each named group.
#[derive(Default)]
struct Overlap {
    cells: usize,
    in_group: Vec<usize>,
}

/// Gives cells their first tag, and those of the named groups that they are in.
fn give_groups(mesh: &mut Mesh, first: &[Vec<i32>], named: &[Named]) {
    let mut tags = Vec::new();
    for dim in 0..=3 {
        let blocks = mesh.cells.iter().zip(first).enumerate();
        let of_dim = blocks.filter(|(_, (block, _))| block.kind.dim() == dim);
        let mut overlaps: BTreeMap<i32, Overlap> = BTreeMap::new();
        let mut sizes = vec![0; named.len()];
        for (number, (_, first)) in of_dim {
            for (cell, tag) in first.iter().enumerate() {
                let overlap = overlaps.entry(tag.saturating_abs()).or_default();
                overlap.cells += 1;
                overlap.in_group.resize(named.len(), 0);
                for (group, (size, count)) in named
                    .iter()
                    .zip(sizes.iter_mut().zip(&mut overlap.in_group))
                {
                    if has(group, number, cell) {
                        *size += 1;
                        *count += 1;
                    }
                }
            }
        }
        overlaps.remove(&0);
        let of_groups = tags_of_groups(&overlaps, &sizes);
        for (group, tag) in named.iter().zip(&of_groups) {
            if let Some(tag) = tag {
                mesh.physical_names.insert((dim, *tag), group.name.clone());
            }
        }
        tags.push(of_groups);
    }
    for (number, (block, first)) in mesh.cells.iter_mut().zip(first).enumerate() {
        let of_groups = tags.get(usize::from(block.kind.dim()));
        let of_groups = of_groups.map(Vec::as_slice).unwrap_or_default();
        block.physical = PhysicalTags::new();
        let mut own = Vec::new();
        for (cell, &first) in first.iter().enumerate() {
            own.clear();
            own.push(first);
            let groups = named.iter().zip(of_groups);
            let groups = groups.filter(|(group, _)| has(group, number, cell));
            let others = groups.filter_map(|(_, tag)| *tag);
            own.extend(others.filter(|tag| *tag != first.saturating_abs()));
            block.physical.push(&own);
        }
    }
}

fn has(group: &Named, block: usize, cell: usize) -> bool {
    let members = group.members.get(block);
    members
        .and_then(|members| members.get(cell))
        .copied()
        .unwrap_or(false)
}

/// The tag of each named group, `None` for one without cells: the first tag that exactly its cells have, otherwise a
/// tag that only some of its cells have, otherwise a free one.
fn tags_of_groups(overlaps: &BTreeMap<i32, Overlap>, sizes: &[usize]) -> Vec<Option<i32>> {
    let mut tags: Vec<Option<i32>> = vec![None; sizes.len()];
    let mut free: BTreeSet<i32> = overlaps.keys().copied().collect();
    for all_of_it in [true, false] {
        for (group, (tag, &size)) in tags.iter_mut().zip(sizes).enumerate() {
            let fits = |candidate: &&i32| {
                overlaps.get(*candidate).is_some_and(|overlap| {
                    overlap.in_group.get(group) == Some(&overlap.cells)
                        && (!all_of_it || overlap.cells == size)
                })
            };
            if tag.is_none() && size > 0 {
                *tag = free.iter().find(fits).copied();
                tag.map(|tag| free.remove(&tag));
            }
        }
    }
    let mut next = (1..).filter(|tag| !overlaps.contains_key(tag));
    for (tag, &size) in tags.iter_mut().zip(sizes) {
        if tag.is_none() && size > 0 {
            *tag = next.next();
        }
    }
    tags
}

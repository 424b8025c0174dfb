//! Gathers the members of the physical groups for a simulation's mesh.

use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

use super::group::{Group, GroupMembers};
use crate::mesh::Mesh;

/// Marks a node that no tetrahedron uses.
pub(super) const DROPPED: u32 = u32::MAX;

/// The groups of a mesh: `tet_tags` are the physical tags of each tetrahedron, `new_index` is for each point its index among
/// the nodes that are kept, or [`DROPPED`].
pub(super) fn collected_groups(
    mesh: &Mesh,
    tet_tags: &[Vec<i32>],
    new_index: &[u32],
    notes: &mut Vec<String>,
) -> Vec<Group> {
    let mut collector = Collector::with_groups_of(mesh, notes);
    for block in mesh.cells.iter().filter(|block| block.kind.dim() < 3) {
        for (cell, row) in block.cells().enumerate() {
            for &tag in block.physical.of(cell) {
                collector.add_cell(block.kind.dim(), tag.saturating_abs(), row, new_index);
            }
        }
    }
    for (tet, tags) in (0u32..).zip(tet_tags) {
        for &tag in tags {
            collector.add_tet(tag, tet);
        }
    }
    collector.into_groups(notes)
}

/// The name given to a group that has none.
pub(super) fn unnamed(dim: u8, tag: i32) -> String {
    format!("{dim}:{tag}")
}

struct Collector {
    collected: Vec<Collected>,
    /// Index into `collected` by dimension and tag.
    place: HashMap<(u8, i32), usize>,
}

struct Collected {
    group: Group,
    /// The nodes of each member so far, padded to three with its first node and in ascending order.
    node_sets: HashSet<[u32; 3]>,
    on_dropped_nodes: usize,
    repeated: usize,
}

impl Collector {
    fn with_groups_of(mesh: &Mesh, notes: &mut Vec<String>) -> Collector {
        let mut collected: Vec<Collected> = Vec::new();
        let mut place = HashMap::new();
        let mut place_of_name: HashMap<(u8, String), usize> = HashMap::new();
        for (dim, tag) in mesh.physical_groups() {
            let name = match mesh.physical_names.get(&(dim, tag)) {
                Some(name) if !name.is_empty() => name.clone(),
                _ => unnamed(dim, tag),
            };
            let index = *place_of_name
                .entry((dim, name.clone()))
                .or_insert(collected.len());
            place.insert((dim, tag), index);
            match collected.get(index) {
                Some(same) => notes.push(format!(
                    "groups {} and {tag} of dimension {dim} are both named \"{name}\" and were joined",
                    same.group.tag
                )),
                None => collected.push(Collected::new(name, dim, tag)),
            }
        }
        Collector { collected, place }
    }

    fn find(&mut self, dim: u8, tag: i32) -> Option<&mut Collected> {
        self.place
            .get(&(dim, tag))
            .and_then(|&index| self.collected.get_mut(index))
    }

    fn add_tet(&mut self, tag: i32, tet: u32) {
        if let Some(Collected {
            group:
                Group {
                    members: GroupMembers::Tets(tets),
                    ..
                },
            ..
        }) = self.find(3, tag)
            && tets.last() != Some(&tet)
        {
            tets.push(tet);
        }
    }

    fn add_cell(&mut self, dim: u8, tag: i32, row: &[u32], new_index: &[u32]) {
        let Some(collected) = self.find(dim, tag) else {
            return;
        };
        let mut nodes = [0; 3];
        for (node, old) in nodes.iter_mut().zip(row) {
            *node = new_index[*old as usize];
        }
        // Fill up with a node of the cell, so that the set is that of the cell.
        let filler = nodes[0];
        nodes[row.len()..].fill(filler);
        collected.add(nodes);
    }

    fn into_groups(self, notes: &mut Vec<String>) -> Vec<Group> {
        let mut collected = self.collected;
        collected.sort_by_key(|c| (Reverse(c.group.dim), c.group.tag));
        for Collected {
            group,
            on_dropped_nodes,
            repeated,
            ..
        } in &collected
        {
            let Group { name, dim, tag, .. } = group;
            let label = format!("group \"{name}\" (dimension {dim}, tag {tag})");
            if *on_dropped_nodes > 0 {
                notes.push(format!(
                    "cells of {label} that use nodes in no tetrahedron, dropped: {on_dropped_nodes}"
                ));
            }
            if *repeated > 0 {
                notes.push(format!(
                    "cells of {label} that repeat another, merged with it: {repeated}"
                ));
            }
            if group.members.is_empty() {
                notes.push(format!("{label} has no cells"));
            }
        }
        collected.into_iter().map(|c| c.group).collect()
    }
}

impl Collected {
    fn new(name: String, dim: u8, tag: i32) -> Collected {
        let members = match dim {
            0 => GroupMembers::Nodes(Vec::new()),
            1 => GroupMembers::Lines(Vec::new()),
            2 => GroupMembers::Triangles(Vec::new()),
            _ => GroupMembers::Tets(Vec::new()),
        };
        Collected {
            group: Group {
                name,
                dim,
                tag,
                members,
            },
            node_sets: HashSet::new(),
            on_dropped_nodes: 0,
            repeated: 0,
        }
    }

    fn add(&mut self, nodes: [u32; 3]) {
        if nodes.contains(&DROPPED) {
            self.on_dropped_nodes += 1;
            return;
        }
        let mut node_set = nodes;
        node_set.sort_unstable();
        if !self.node_sets.insert(node_set) {
            self.repeated += 1;
            return;
        }
        let [a, b, _] = nodes;
        match &mut self.group.members {
            GroupMembers::Nodes(members) => members.push(a),
            GroupMembers::Lines(members) => members.push([a, b]),
            GroupMembers::Triangles(members) => members.push(nodes),
            GroupMembers::Tets(_) => {}
        }
    }
}

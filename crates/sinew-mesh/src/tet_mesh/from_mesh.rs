//! Conversion of a mesh as in a file to the mesh of a simulation.

use std::collections::{BTreeMap, HashSet};

use super::TetMesh;
use super::collect_groups::{DROPPED, collected_groups};
use super::error::TetMeshError;
use crate::cell_type::CellType;
use crate::duplicates::duplicate_cells;
use crate::mesh::{CellBlock, Mesh};

impl Mesh {
    /// The tetrahedra of this mesh, the nodes they use and the physical groups.
    ///
    /// * Tetrahedra with the same four nodes become one that is in the groups of all of them: gmsh writes version 2.2 with a
    ///   copy for each group. The same applies to the triangles, lines and nodes within one group.
    /// * Nodes in no tetrahedron are dropped, and with them the triangles, lines and vertices that use one.
    /// * Nodes at the same place stay separate: cuts and contact surfaces have them.
    /// * A group without a name is called `"dim:tag"`. Groups of one dimension with the same name become one.
    /// * Flat and inverted tetrahedra are kept as they are.
    /// * Cell data with a value in some tetrahedron are kept, merged over the parts of a partitioned file, and so are
    ///   data at nodes.
    ///
    /// [`TetMesh::notes`] lists the changes made.
    ///
    /// # Errors
    ///
    /// If there are no 4-node tetrahedra, there are other volume cells, or a group has other cells than
    /// vertices, 2-node lines, 3-node triangles and 4-node tetrahedra.
    pub fn to_tet_mesh(&self) -> Result<TetMesh, TetMeshError> {
        refuse_unsupported_cells(self, |block| block.kind.dim() == 3)?;
        refuse_nodes_out_of_range(self)?;
        let mut notes = Vec::new();
        let tets = merged_tets(self, &mut notes)?;
        if tets.nodes.is_empty() {
            return Err(TetMeshError::NoTetrahedra {
                found: cell_counts(self),
                is_surface: self
                    .cells
                    .iter()
                    .any(|block| block.kind.dim() == 2 && !block.is_empty()),
            });
        }
        refuse_unsupported_cells(self, is_in_a_group)?;
        let new_index = index_of_used_nodes(self, &tets.nodes, &mut notes);
        let kept = |point: usize| new_index[point] != DROPPED;
        let groups = collected_groups(self, &tets.groups, &new_index, &mut notes);
        Ok(TetMesh {
            points: (0..self.points.len())
                .filter(|&p| kept(p))
                .map(|p| self.points[p])
                .collect(),
            node_tags: (0u32..)
                .take(self.points.len())
                .filter(|&p| kept(p as usize))
                .map(|p| self.node_tag(p))
                .collect(),
            tets: tets
                .nodes
                .iter()
                .map(|tet| tet.map(|node| new_index[node as usize]))
                .collect(),
            tet_tags: tets.tags,
            data: self.data_in_tets(&tets.copies),
            node_data: self.data_at_nodes(kept),
            groups,
            notes,
        })
    }
}

fn element_tag(block: &CellBlock, cell: usize) -> u64 {
    block
        .element_tags
        .get(cell)
        .copied()
        .unwrap_or(cell as u64 + 1)
}

fn cell_counts(mesh: &Mesh) -> String {
    let mut counts: BTreeMap<CellType, usize> = BTreeMap::new();
    for block in mesh.cells.iter().filter(|block| !block.is_empty()) {
        *counts.entry(block.kind).or_default() += block.len();
    }
    if counts.is_empty() {
        return "no cells".to_owned();
    }
    let listed: Vec<String> = counts
        .iter()
        .map(|(kind, count)| format!("{count} {kind}"))
        .collect();
    listed.join(", ")
}

/// Refuses blocks of other kinds than this crate simulates, among those for which `matters` is true.
fn refuse_unsupported_cells(
    mesh: &Mesh,
    matters: impl Fn(&CellBlock) -> bool,
) -> Result<(), TetMeshError> {
    use CellType::{Line, Tetra, Triangle, Vertex};
    let supported = [Vertex, Line, Triangle, Tetra];
    let refused = mesh
        .cells
        .iter()
        .find(|block| !supported.contains(&block.kind) && !block.is_empty() && matters(block));
    match refused {
        None => Ok(()),
        Some(block) => {
            let same_kind = mesh.cells.iter().filter(|other| other.kind == block.kind);
            Err(TetMeshError::UnsupportedCells {
                kind: block.kind,
                count: same_kind.map(CellBlock::len).sum(),
                element_tag: element_tag(block, 0),
            })
        }
    }
}

fn is_in_a_group(block: &CellBlock) -> bool {
    (0..block.len()).any(|cell| !block.physical.of(cell).is_empty())
}

fn refuse_nodes_out_of_range(mesh: &Mesh) -> Result<(), TetMeshError> {
    let nodes = mesh.points.len();
    for block in &mesh.cells {
        for (cell, row) in block.cells().enumerate() {
            if let Some(&node) = row.iter().find(|&&node| node as usize >= nodes) {
                return Err(TetMeshError::NodeOutOfRange {
                    kind: block.kind,
                    element_tag: element_tag(block, cell),
                    node,
                    nodes,
                });
            }
        }
    }
    Ok(())
}

/// The tetrahedra of all blocks, copies merged.
struct MergedTets {
    nodes: Vec<[u32; 4]>,
    tags: Vec<u64>,
    /// Physical tags (absolute, ascending) of each tetrahedron.
    groups: Vec<Vec<i32>>,
    /// Pairs (first, copy) of indices among the tetrahedra of all blocks.
    copies: Vec<(usize, usize)>,
}

fn merged_tets(mesh: &Mesh, notes: &mut Vec<String>) -> Result<MergedTets, TetMeshError> {
    let mut connectivity = Vec::new();
    let mut tags = Vec::new();
    let mut groups: Vec<Vec<i32>> = Vec::new();
    for block in mesh
        .cells
        .iter()
        .filter(|block| block.kind == CellType::Tetra)
    {
        connectivity.extend_from_slice(&block.connectivity);
        for cell in 0..block.len() {
            tags.push(element_tag(block, cell));
            groups.push(absolute_tags(block, cell));
        }
    }
    let count = tags.len();
    if u32::try_from(count).is_err() {
        return Err(TetMeshError::TooManyTetrahedra { count });
    }

    let copies = duplicate_cells(connectivity.chunks_exact(4));
    for &(first, copy) in &copies {
        let copied = std::mem::take(&mut groups[copy]);
        groups[first].extend(copied);
        groups[first].sort_unstable();
        groups[first].dedup();
    }
    if let Some(&(first, copy)) = copies.first() {
        notes.push(format!(
            "tetrahedra that repeat the nodes of another and were merged with it, keeping the groups of both: {} (first: \
             tag {} repeats tag {}); gmsh writes such copies into version 2.2 files for elements in several groups",
            copies.len(),
            tags[copy],
            tags[first],
        ));
    }
    let is_copy: HashSet<usize> = copies.iter().map(|&(_, copy)| copy).collect();
    let kept = |cell: &usize| !is_copy.contains(cell);
    Ok(MergedTets {
        nodes: connectivity
            .chunks_exact(4)
            .enumerate()
            .filter(|(cell, _)| kept(cell))
            .map(|(_, row)| [row[0], row[1], row[2], row[3]])
            .collect(),
        tags: (0..count).filter(kept).map(|cell| tags[cell]).collect(),
        groups: (0..count)
            .filter(kept)
            .map(|cell| std::mem::take(&mut groups[cell]))
            .collect(),
        copies,
    })
}

fn absolute_tags(block: &CellBlock, cell: usize) -> Vec<i32> {
    let mut tags: Vec<i32> = block
        .physical
        .of(cell)
        .iter()
        .map(|tag| tag.saturating_abs())
        .collect();
    tags.sort_unstable();
    tags.dedup();
    tags
}

/// For each point its index among the points that tetrahedra use, or [`DROPPED`].
fn index_of_used_nodes(mesh: &Mesh, tets: &[[u32; 4]], notes: &mut Vec<String>) -> Vec<u32> {
    let mut new_index = vec![DROPPED; mesh.points.len()];
    for &node in tets.iter().flatten() {
        new_index[node as usize] = 0;
    }
    let mut used = 0;
    let mut first_orphan = None;
    for (point, index) in (0u32..).zip(&mut new_index) {
        if *index == DROPPED {
            first_orphan = first_orphan.or(Some(point));
        } else {
            *index = used;
            used += 1;
        }
    }
    if let Some(orphan) = first_orphan {
        notes.push(format!(
            "nodes in no tetrahedron, dropped because they would have no mass: {} (first: tag {})",
            mesh.points.len() - used as usize,
            mesh.node_tag(orphan),
        ));
    }
    new_index
}

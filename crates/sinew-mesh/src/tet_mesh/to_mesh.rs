//! Turns a simulation's mesh into one that can be written to a file.

use std::collections::{BTreeMap, HashMap};

use super::collect_data::in_blocks;
use super::collect_groups::unnamed;
use super::{Group, GroupMembers, TetMesh};
use crate::cell_type::CellType;
use crate::mesh::{CellBlock, Entity, Mesh, PointData};
use crate::physical_tags::PhysicalTags;

impl TetMesh {
    /// This mesh as cell blocks, ready to be written to a file.
    ///
    /// There is one block, and one geometrical entity, for each combination of groups that occurs; within a block the
    /// order is kept. Data are cell data and point data. Reading the written file back gives this mesh again, except that cells move when the
    /// groups are not stored one after another.
    #[must_use]
    pub fn to_mesh(&self) -> Mesh {
        let mut cells: Vec<CellBlock> = Vec::new();
        cells.extend(self.blocks_of_lower_dim(0, CellType::Vertex));
        cells.extend(self.blocks_of_lower_dim(1, CellType::Line));
        cells.extend(self.blocks_of_lower_dim(2, CellType::Triangle));
        let lower: Vec<usize> = cells.iter().map(CellBlock::len).collect();
        let (blocks, tets_of_blocks) = self.tet_blocks();
        cells.extend(blocks);
        number_the_rest(&mut cells, lower.len());
        let data = self.data.iter();
        let cell_data = data.map(|data| in_blocks(data, &lower, &tets_of_blocks));

        let point_data = self.node_data.iter().map(|data| PointData {
            name: data.name.clone(),
            step: data.step,
            time: 0.0,
            components: data.components,
            values: data.values.clone(),
        });

        let on_first_volume = Entity { dim: 3, tag: 1 };
        let names = self
            .groups
            .iter()
            .filter(|group| group.name != unnamed(group.dim, group.tag));
        Mesh {
            points: self.points.clone(),
            node_tags: self.node_tags.clone(),
            node_entities: vec![on_first_volume; self.points.len()],
            cells,
            physical_names: names.map(|g| ((g.dim, g.tag), g.name.clone())).collect(),
            cell_data: cell_data.collect(),
            point_data: point_data.collect(),
            ..Mesh::default()
        }
    }

    fn groups_of_dim(&self, dim: u8) -> impl Iterator<Item = &Group> {
        self.groups.iter().filter(move |group| group.dim == dim)
    }

    fn blocks_of_lower_dim(&self, dim: u8, kind: CellType) -> Vec<CellBlock> {
        // A cell that is in several groups is written once; its winding is that of the first group.
        let mut index_of: HashMap<Vec<u32>, usize> = HashMap::new();
        let mut rows: Vec<(Vec<u32>, Vec<i32>)> = Vec::new();
        for group in self.groups_of_dim(dim) {
            for row in rows_of(&group.members) {
                let mut node_set = row.clone();
                node_set.sort_unstable();
                let index = *index_of.entry(node_set).or_insert_with(|| {
                    rows.push((row, Vec::new()));
                    rows.len() - 1
                });
                if !rows[index].1.contains(&group.tag) {
                    rows[index].1.push(group.tag);
                }
            }
        }
        let rows = rows.iter().map(|(row, tags)| (row.as_slice(), tags, None));
        let (blocks, _) = blocks_by_groups(kind, rows);
        blocks
    }

    /// The blocks of tetrahedra, and the tetrahedra of each block.
    fn tet_blocks(&self) -> (Vec<CellBlock>, Vec<Vec<usize>>) {
        let mut tags_of = vec![Vec::new(); self.tets.len()];
        for group in self.groups_of_dim(3) {
            if let GroupMembers::Tets(tets) = &group.members {
                for &tet in tets {
                    tags_of[tet as usize].push(group.tag);
                }
            }
        }
        let tets = self.tets.iter().zip(&tags_of).zip(&self.tet_tags);
        let rows = tets.map(|((tet, tags), &tet_tag)| (tet.as_slice(), tags, Some(tet_tag)));
        blocks_by_groups(CellType::Tetra, rows)
    }
}

fn rows_of(members: &GroupMembers) -> Vec<Vec<u32>> {
    match members {
        GroupMembers::Tets(_) => Vec::new(),
        GroupMembers::Triangles(triangles) => triangles.iter().map(|row| row.to_vec()).collect(),
        GroupMembers::Lines(lines) => lines.iter().map(|row| row.to_vec()).collect(),
        GroupMembers::Nodes(nodes) => nodes.iter().map(|&node| vec![node]).collect(),
    }
}

/// One block for each list of groups, in the order in which the lists first occur, and the indices of its cells among
/// all.
fn blocks_by_groups<'a>(
    kind: CellType,
    rows: impl Iterator<Item = (&'a [u32], &'a Vec<i32>, Option<u64>)>,
) -> (Vec<CellBlock>, Vec<Vec<usize>>) {
    let mut blocks: Vec<CellBlock> = Vec::new();
    let mut places: Vec<Vec<usize>> = Vec::new();
    let mut block_of: BTreeMap<&[i32], usize> = BTreeMap::new();
    let mut groups_of_block: Vec<&[i32]> = Vec::new();
    for (place, (nodes, groups, element_tag)) in rows.enumerate() {
        let index = *block_of.entry(groups).or_insert_with(|| {
            blocks.push(CellBlock::new(kind, Vec::new()));
            places.push(Vec::new());
            groups_of_block.push(groups);
            blocks.len() - 1
        });
        places[index].push(place);
        blocks[index].connectivity.extend_from_slice(nodes);
        blocks[index].element_tags.extend(element_tag);
    }
    for ((entity, block), groups) in (1..).zip(&mut blocks).zip(groups_of_block) {
        block.geometrical = vec![entity; block.len()];
        block.physical = PhysicalTags::uniform(groups, block.len());
    }
    (blocks, places)
}

/// Gives the cells of lower dimension tags that no tetrahedron has, or new tags to all cells if such tags would
/// overflow.
fn number_the_rest(cells: &mut [CellBlock], first_tet_block: usize) {
    let (lower, tets) = cells.split_at_mut(first_tet_block);
    let greatest = tets
        .iter()
        .flat_map(|block| &block.element_tags)
        .max()
        .copied()
        .unwrap_or(0);
    let needed: usize = lower.iter().map(CellBlock::len).sum();
    let mut next = greatest.wrapping_add(1);
    if greatest.checked_add(needed as u64).is_none() {
        next = 1;
        for block in tets {
            block.element_tags = tags_from(&mut next, block.len());
        }
    }
    for block in lower {
        block.element_tags = tags_from(&mut next, block.len());
    }
}

fn tags_from(next: &mut u64, count: usize) -> Vec<u64> {
    let first = *next;
    *next += count as u64;
    (first..*next).collect()
}

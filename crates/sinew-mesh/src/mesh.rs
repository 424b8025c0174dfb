//! A mesh as in a file: all cell types, tags, groups and data, in meshio's arrangement.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::cell_type::CellType;
use crate::duplicates::duplicate_cells;
use crate::physical_tags::PhysicalTags;
use crate::warning::Warning;

/// Everything read from a mesh file.
///
/// The arrangement is that of meshio's `Mesh`: points in file order, cells in blocks of one type with 0-based, VTK-ordered
/// connectivity. Node and element tags, every physical group of a cell and a name table keyed by dimension *and* tag, which
/// meshio drops, are kept as well.
///
/// To build a mesh in a program, start from [`Mesh::default`] and fill in the fields.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// Coordinates of the nodes in file order, in the file's length unit. Nodes that no cell uses are kept.
    pub points: Vec<[f64; 3]>,
    /// The tag of each point in the file: at least 1, in any order, with gaps. Empty means `1..=points.len()`.
    pub node_tags: Vec<u64>,
    /// The geometrical entity on which each point lies (meshio's `gmsh:dim_tags`). Empty if the file has none (1, 2.2).
    pub node_entities: Vec<Entity>,
    /// The cells. Version 4: one block per element block of the file. Versions 1 and 2: one per run of equal types.
    pub cells: Vec<CellBlock>,
    /// The names of physical groups, keyed by dimension (0..=3) and tag (positive). A named group may have no cells.
    pub physical_names: BTreeMap<(u8, i32), String>,
    /// Values at points (`$NodeData`).
    pub point_data: Vec<PointData>,
    /// Values in cells (`$ElementData`).
    pub cell_data: Vec<CellData>,
    /// Values at the nodes of each cell (`$ElementNodeData`).
    pub cell_node_data: Vec<CellNodeData>,
    /// Pairs of corresponding nodes (`$Periodic`).
    pub periodic: Vec<PeriodicLink>,
    /// The sections of the file that were skipped, in file order.
    pub skipped_sections: Vec<String>,
    /// Remarks of the reader about contents that it accepted but that the user should know.
    pub warnings: Vec<Warning>,
}

/// A geometrical entity of the model from which a mesh was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Entity {
    /// 0 point, 1 curve, 2 surface, 3 volume.
    pub dim: u8,
    /// Number of the entity, unique among those of its dimension.
    pub tag: i32,
}

/// Cells of one type.
#[derive(Debug, Clone, PartialEq)]
pub struct CellBlock {
    /// The type of every cell in the block.
    pub kind: CellType,
    /// Indices into [`Mesh::points`], in VTK node order, `kind.node_count()` for each cell in turn.
    pub connectivity: Vec<u32>,
    /// The tag of each cell in the file. Empty if the cells have none.
    pub element_tags: Vec<u64>,
    /// The physical groups of each cell. Empty if no cell has any.
    pub physical: PhysicalTags,
    /// The geometrical entity of each cell, of dimension `kind.dim()`; 0 for none. Empty if no cell has one.
    pub geometrical: Vec<i32>,
}

impl CellBlock {
    /// A block of cells with neither tags nor groups.
    #[must_use]
    pub fn new(kind: CellType, connectivity: Vec<u32>) -> CellBlock {
        CellBlock {
            kind,
            connectivity,
            element_tags: Vec::new(),
            physical: PhysicalTags::new(),
            geometrical: Vec::new(),
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.connectivity.len() / self.kind.node_count()
    }

    /// True if the block has no cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Keeps the cells for which `keep` is true.
    pub(crate) fn keep(&mut self, keep: &[bool]) {
        let nodes = self.kind.node_count();
        let is_kept = |cell: usize| keep.get(cell).copied().unwrap_or(false);
        let mut entry = 0;
        self.connectivity.retain(|_| {
            entry += 1;
            is_kept((entry - 1) / nodes)
        });
        retain(&mut self.element_tags, keep);
        retain(&mut self.geometrical, keep);
        self.physical.retain(keep);
    }

    /// The nodes of each cell in turn.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = &[u32]> + Clone {
        self.connectivity.chunks_exact(self.kind.node_count())
    }
}

/// Position of a cell in a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CellIndex {
    /// Index into [`Mesh::cells`].
    pub block: usize,
    /// Index within the block.
    pub cell: usize,
}

/// Cells of one type that have the same nodes as an earlier one: pairs (first cell, later cell).
pub(crate) struct Duplicates {
    pub(crate) kind: CellType,
    pub(crate) pairs: Vec<(CellIndex, CellIndex)>,
}

/// Keeps the entries for which `keep` is true.
fn retain<T>(list: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    list.retain(|_| keep.next().copied().unwrap_or(false));
}

/// Values at points, from one `$NodeData` section.
#[derive(Debug, Clone, PartialEq)]
pub struct PointData {
    /// Name of the field.
    pub name: String,
    /// Number of the time step.
    pub step: i32,
    /// Time, in the file's unit.
    pub time: f64,
    /// Values per point.
    pub components: usize,
    /// `components` values for each point in turn; NaN if the file gives none.
    pub values: Vec<f64>,
}

/// Values in cells, from one `$ElementData` section.
#[derive(Debug, Clone, PartialEq)]
pub struct CellData {
    /// Name of the field.
    pub name: String,
    /// Number of the time step.
    pub step: i32,
    /// Time, in the file's unit.
    pub time: f64,
    /// Values per cell.
    pub components: usize,
    /// For each block of [`Mesh::cells`]: `components` values for each cell in turn; NaN if the file gives none.
    pub blocks: Vec<Vec<f64>>,
}

/// Values at the nodes of each cell, from one `$ElementNodeData` section.
#[derive(Debug, Clone, PartialEq)]
pub struct CellNodeData {
    /// Name of the field.
    pub name: String,
    /// Number of the time step.
    pub step: i32,
    /// Time, in the file's unit.
    pub time: f64,
    /// Values per node of a cell.
    pub components: usize,
    /// For each block of [`Mesh::cells`]: `components` values for each node (VTK order) of each cell in turn; NaN if
    /// the file gives none.
    pub blocks: Vec<Vec<f64>>,
}

/// Nodes of one entity that correspond to nodes of another.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicLink {
    /// Dimension of both entities.
    pub dim: u8,
    /// Tag of the dependent entity.
    pub entity: i32,
    /// Tag of the original entity.
    pub master: i32,
    /// The 4 x 4 transformation, in row-major order, that takes the master onto the dependent entity; empty if the file
    /// has none.
    pub affine: Vec<f64>,
    /// Pairs of node tags: dependent, master.
    pub node_tags: Vec<[u64; 2]>,
}

/// The cells of one named physical group, as in meshio's `cell_sets`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellSet {
    /// Name of the group.
    pub name: String,
    /// For each block of [`Mesh::cells`]: the indices, within the block, of the cells in the group.
    pub blocks: Vec<Vec<u32>>,
}

impl Mesh {
    /// The tag of a point: its tag in the file, or its index plus one if the mesh has no tags.
    #[must_use]
    pub fn node_tag(&self, point: u32) -> u64 {
        let ordinal = u64::from(point) + 1;
        self.node_tags
            .get(point as usize)
            .copied()
            .unwrap_or(ordinal)
    }

    /// Gives points and cells tags from 1 on, in their order, and cells no groups.
    pub(crate) fn number_from_one(&mut self) {
        self.node_tags = (1..).take(self.points.len()).collect();
        let mut next_tag = 1;
        for block in &mut self.cells {
            let end = next_tag + block.len() as u64;
            block.element_tags = (next_tag..end).collect();
            next_tag = end;
            block.physical = PhysicalTags::uniform(&[], block.len());
        }
    }

    /// The corners of all tetrahedra of any order, block by block.
    pub(crate) fn corners_of_tets(&self) -> Vec<[u32; 4]> {
        let blocks = self.cells.iter();
        let tets = blocks.filter(|block| block.kind.is_tetrahedron());
        let rows = tets.flat_map(CellBlock::cells);
        rows.map(|row| [row[0], row[1], row[2], row[3]]).collect()
    }

    /// The tag of a cell: its tag in the file, or its index within the mesh plus one if its block has no tags.
    #[must_use]
    pub fn element_tag(&self, cell: CellIndex) -> u64 {
        let tag = self
            .cells
            .get(cell.block)
            .and_then(|block| block.element_tags.get(cell.cell));
        tag.copied().unwrap_or_else(|| {
            let before: usize = self.cells.iter().take(cell.block).map(CellBlock::len).sum();
            (before + cell.cell) as u64 + 1
        })
    }

    /// The cells of one dimension that have the same nodes as an earlier cell of their type, type by type.
    pub(crate) fn duplicate_cells(&self, dim: u8) -> Vec<Duplicates> {
        let kinds: BTreeSet<CellType> = self.cells.iter().map(|block| block.kind).collect();
        let kinds = kinds.into_iter().filter(|kind| kind.dim() == dim);
        let found = kinds.map(|kind| {
            let blocks = || self.cells.iter().filter(|block| block.kind == kind);
            let pairs = duplicate_cells(blocks().flat_map(CellBlock::cells));
            // Index of each block of the kind, and how many cells the kind has before it.
            let mut starts: Vec<(usize, usize)> = Vec::new();
            let mut cells = 0;
            for (number, block) in self.cells.iter().enumerate() {
                if block.kind == kind && !block.is_empty() {
                    starts.push((number, cells));
                    cells += block.len();
                }
            }
            let index = |cell: usize| {
                let after = starts.partition_point(|&(_, start)| start <= cell);
                let (block, start) = starts[after - 1];
                CellIndex {
                    block,
                    cell: cell - start,
                }
            };
            Duplicates {
                kind,
                pairs: pairs
                    .into_iter()
                    .map(|(a, b)| (index(a), index(b)))
                    .collect(),
            }
        });
        found.filter(|found| !found.pairs.is_empty()).collect()
    }

    /// Dimension and tag of every physical group, named or not, in ascending order.
    #[must_use]
    pub fn physical_groups(&self) -> Vec<(u8, i32)> {
        let mut groups: BTreeSet<(u8, i32)> = self.physical_names.keys().copied().collect();
        for block in &self.cells {
            for &tag in block.physical.lists().flatten() {
                groups.insert((block.kind.dim(), tag.saturating_abs()));
            }
        }
        groups.into_iter().collect()
    }

    /// meshio's `field_data`: name, tag and dimension of each named group.
    ///
    /// Two groups of different dimension may share a name; unlike in meshio, both are listed.
    #[must_use]
    pub fn field_data(&self) -> Vec<(&str, i32, u8)> {
        self.physical_names
            .iter()
            .map(|(&(dim, tag), name)| (name.as_str(), tag, dim))
            .collect()
    }

    /// meshio's `cell_sets`: the cells of each named group, in the order of [`Mesh::physical_names`].
    ///
    /// A cell in several groups is in several sets. The sign of a tag does not matter.
    #[must_use]
    pub fn cell_sets(&self) -> Vec<CellSet> {
        let mut sets: Vec<CellSet> = self
            .physical_names
            .values()
            .map(|name| CellSet {
                name: name.clone(),
                blocks: vec![Vec::new(); self.cells.len()],
            })
            .collect();
        let index: HashMap<(u8, i32), usize> =
            self.physical_names.keys().copied().zip(0..).collect();
        for (number, block) in self.cells.iter().enumerate() {
            for (cell, i) in (0u32..).zip(0..block.len()) {
                for tag in block.physical.of(i) {
                    let Some(&set) = index.get(&(block.kind.dim(), tag.saturating_abs())) else {
                        continue;
                    };
                    let members = &mut sets[set].blocks[number];
                    if members.last() != Some(&cell) {
                        members.push(cell);
                    }
                }
            }
        }
        sets
    }
}

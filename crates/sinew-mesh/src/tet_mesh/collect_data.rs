//! Data of cells as data of tetrahedra, and back; data of points as data of nodes.

use std::collections::HashSet;

use super::{NodeData, TetData};
use crate::cell_type::CellType;
use crate::mesh::{CellData, Mesh};

impl Mesh {
    /// The values of this mesh's cell data in its tetrahedra, without those that are `copies`: pairs (first, copy) of
    /// indices among all tetrahedra. The first gives the value, or a copy if the first has none.
    ///
    /// Files of several partitions write a view in parts, which are put together again. Data without a value in any
    /// tetrahedron are left out.
    pub(super) fn data_in_tets(&self, copies: &[(usize, usize)]) -> Vec<TetData> {
        let is_copy: HashSet<usize> = copies.iter().map(|&(_, copy)| copy).collect();
        let mut all: Vec<TetData> = Vec::new();
        for data in &self.cell_data {
            let own = in_tets(self, data, copies, &is_copy);
            if own.has_any() && !all.iter_mut().any(|known| known.complete_with(&own)) {
                all.push(own);
            }
        }
        all
    }
}

impl Mesh {
    /// The values of this mesh's point data at the points that are kept. Data without a value at any of them are left out.
    pub(super) fn data_at_nodes(&self, is_kept: impl Fn(usize) -> bool) -> Vec<NodeData> {
        let at_nodes = self.point_data.iter().map(|data| {
            let rows = data.values.chunks_exact(data.components.max(1)).enumerate();
            let kept = rows.filter(|(point, _)| is_kept(*point));
            NodeData {
                name: data.name.clone(),
                step: data.step,
                components: data.components,
                values: kept.flat_map(|(_, row)| row).copied().collect(),
            }
        });
        let has_any = |data: &NodeData| data.values.iter().any(|value| !value.is_nan());
        at_nodes.filter(has_any).collect()
    }
}

fn in_tets(
    mesh: &Mesh,
    data: &CellData,
    copies: &[(usize, usize)],
    is_copy: &HashSet<usize>,
) -> TetData {
    let width = data.components.max(1);
    let blocks = mesh.cells.iter().zip(&data.blocks);
    let of_tets = blocks.filter(|(block, _)| block.kind == CellType::Tetra);
    let mut values: Vec<f64> = of_tets.flat_map(|(_, values)| values).copied().collect();
    for &(first, copy) in copies {
        for component in 0..width {
            let own = values.get(first * width + component);
            let copied = values.get(copy * width + component).copied();
            if let (Some(own), Some(copied)) = (own, copied)
                && own.is_nan()
            {
                values[first * width + component] = copied;
            }
        }
    }
    if !is_copy.is_empty() {
        let rows = values.chunks_exact(width).enumerate();
        let kept = rows.filter(|(tet, _)| !is_copy.contains(tet));
        values = kept.flat_map(|(_, row)| row).copied().collect();
    }
    TetData {
        name: data.name.clone(),
        step: data.step,
        components: width,
        values,
    }
}

/// Data of tetrahedra as data of blocks of cells; the last blocks contain the tetrahedra, in these orders.
pub(super) fn in_blocks(data: &TetData, counts: &[usize], tets: &[Vec<usize>]) -> CellData {
    let lower = counts
        .iter()
        .map(|count| vec![f64::NAN; count * data.components]);
    let rows: Vec<&[f64]> = data.rows().collect();
    let of_tets = tets.iter().map(|tets| {
        let rows = tets.iter().filter_map(|tet| rows.get(*tet).copied());
        rows.flatten().copied().collect()
    });
    CellData {
        name: data.name.clone(),
        step: data.step,
        time: 0.0,
        components: data.components,
        blocks: lower.chain(of_tets).collect(),
    }
}

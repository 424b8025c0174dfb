//! Values in tetrahedra.

use std::collections::{BTreeMap, HashSet};

use super::TetMesh;
use crate::cell_type::CellType;
use crate::mesh::{CellData, Mesh};

/// Values in tetrahedra, by one view of the file (`$ElementData`).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TetData {
    /// Name of the view.
    pub name: String,
    /// Number of the time step.
    pub step: i32,
    /// Values per tetrahedron.
    pub components: usize,
    /// `components` values for each tetrahedron in turn; NaN where the file gives none.
    pub values: Vec<f64>,
}

/// No data, or more than one, have the name that was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TetDataError {
    /// No data have the name.
    #[error("no data of tetrahedra are named \"{name}\"; {}", listed(known))]
    Unknown {
        /// The name that was asked for.
        name: String,
        /// Name and number of components of all data.
        known: Vec<(String, usize)>,
    },
    /// Several have it.
    #[error(
        "{} data of tetrahedra are named \"{name}\" (time steps {}): keep one of them, or give each a name of its own",
        steps.len(), in_words(steps)
    )]
    Several {
        /// The name that was asked for.
        name: String,
        /// The time step of each.
        steps: Vec<i32>,
    },
}

impl TetData {
    /// The values of each tetrahedron in turn.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> + Clone {
        self.values.chunks_exact(self.components.max(1))
    }

    /// Whether some tetrahedron has values.
    fn has_any(&self) -> bool {
        self.values.iter().any(|value| !value.is_nan())
    }

    /// Takes the values of data of the same name, step and width where it has none itself; what both have is refused.
    fn complete_with(&mut self, other: &TetData) -> bool {
        let names = (&self.name, self.step, self.components);
        let is_part = names == (&other.name, other.step, other.components);
        let has_both = |(own, other): (&f64, &f64)| !own.is_nan() && !other.is_nan();
        if !is_part || self.values.iter().zip(&other.values).any(has_both) {
            return false;
        }
        for (own, other) in self.values.iter_mut().zip(&other.values) {
            if own.is_nan() {
                *own = *other;
            }
        }
        true
    }

    /// The same with the eight parts of each tetrahedron in its place.
    pub(super) fn refined(&self) -> TetData {
        let parts = self.rows().flat_map(|row| [row; 8]).flatten();
        TetData {
            values: parts.copied().collect(),
            name: self.name.clone(),
            ..*self
        }
    }
}

impl TetMesh {
    /// The data with this name.
    ///
    /// # Errors
    ///
    /// If there are none, and the error lists the names; or if there are several, such as time steps.
    pub fn data(&self, name: &str) -> Result<&TetData, TetDataError> {
        let found: Vec<&TetData> = self.data.iter().filter(|data| data.name == name).collect();
        match found[..] {
            [data] => Ok(data),
            [] => {
                let known = self.data.iter();
                Err(TetDataError::Unknown {
                    name: name.to_owned(),
                    known: known
                        .map(|data| (data.name.clone(), data.components))
                        .collect(),
                })
            }
            _ => Err(TetDataError::Several {
                name: name.to_owned(),
                steps: found.iter().map(|data| data.step).collect(),
            }),
        }
    }
}

impl Mesh {
    /// The values of this mesh's cell data in its tetrahedra, without those that are `copies`: pairs (first, copy) of places among all
    /// tetrahedra. The first gives the value, and a copy where the first has none.
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

/// Data of tetrahedra as data of blocks of cells, of which the last hold the tetrahedra, in these orders.
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

fn listed(known: &[(String, usize)]) -> String {
    if known.is_empty() {
        return "the mesh has none".to_owned();
    }
    // By name, so that time steps of one view stand once.
    let known: BTreeMap<&String, usize> =
        known.iter().map(|(name, width)| (name, *width)).collect();
    let names = known.iter().map(|(name, width)| match width {
        1 => format!("\"{name}\" (a number)"),
        _ => format!("\"{name}\" ({width} numbers)"),
    });
    format!("there are {}", names.collect::<Vec<_>>().join(", "))
}

fn in_words(steps: &[i32]) -> String {
    let steps: Vec<String> = steps.iter().map(i32::to_string).collect();
    steps.join(", ")
}

//! Groups made from data that are labels.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use crate::mesh::{CellBlock, CellIndex, Mesh};
use crate::physical_tags::PhysicalTags;

/// Largest number of different values of labels.
const MOST: usize = 4096;

/// A group that was made from data.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelGroup {
    /// Its name.
    pub name: String,
    /// Dimension of its cells.
    pub dim: u8,
    /// Number of its cells.
    pub cells: usize,
}

/// Data from which no groups can be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LabelError {
    /// No data of cells have the name.
    #[error("no data of cells are named \"{name}\"; {}", listed(known))]
    Unknown {
        /// The requested name.
        name: String,
        /// The existing names.
        known: Vec<String>,
    },
    /// Several data have the name.
    #[error(
        "{count} data of cells are named \"{name}\"; keep one of them, or give each a name of its own"
    )]
    Several {
        /// The requested name.
        name: String,
        /// Their number.
        count: usize,
    },
    /// The data have several numbers for each cell.
    #[error(
        "the data \"{name}\" have {components} numbers for each cell; labels are one whole number each"
    )]
    NotScalar {
        /// Name of the data.
        name: String,
        /// Numbers for each cell.
        components: usize,
    },
    /// A value is not a whole number.
    #[error(
        "the data \"{name}\" are no labels: {value} in the cell with tag {element_tag} is not a whole number below 2^53; a scene takes \
         such data by where = {{ data = {{ name = \"{name}\", between = [..] }} }}"
    )]
    NotWhole {
        /// Name of the data.
        name: String,
        /// The value.
        value: f64,
        /// Tag of the cell.
        element_tag: u64,
    },
    /// There are more different values than labels may have.
    #[error("the data \"{name}\" are no labels: they have more than {MOST} different values")]
    TooMany {
        /// Name of the data.
        name: String,
    },
    /// No cell has a value.
    #[error("the data \"{name}\" have no values")]
    Empty {
        /// Name of the data.
        name: String,
    },
    /// The mesh has a group of the name already.
    #[error(
        "the mesh has a group \"{group}\" of dimension {dim} already, so that none can be made of the data"
    )]
    Taken {
        /// Name of the group.
        group: String,
        /// Its dimension.
        dim: u8,
    },
}

impl Mesh {
    /// Adds a group for each value of data that have one whole number for each cell: the cells with the value 2 of
    /// `labels` become the group `labels_2`, with a separate group for each dimension. Existing groups of the cells and
    /// the data stay.
    ///
    /// Cells without a value get no group. The tag of a group is its value, if that is positive and free.
    ///
    /// # Errors
    ///
    /// If there are no such data, the values are not whole numbers or have more than 4096 different values, or a group
    /// already has the name.
    ///
    /// ```
    /// use sinew_mesh::structured::{Split, cube};
    /// use sinew_mesh::TetData;
    ///
    /// let mut cube = cube(1, 0.1, Split::Kuhn)?;
    /// let values = vec![1.0, 1.0, 1.0, 2.0, 2.0, 2.0];
    /// cube.data = vec![TetData { name: "labels".into(), step: 0, components: 1, values }];
    /// let mut mesh = cube.to_mesh();
    /// let groups = mesh.groups_from_data("labels")?;
    /// assert_eq!(groups[1].name, "labels_2");
    /// assert_eq!(mesh.to_tet_mesh()?.group("labels_2")?.members.len(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn groups_from_data(&mut self, name: &str) -> Result<Vec<LabelGroup>, LabelError> {
        let labels = self.labels(name)?;
        self.add_groups_of_labels(&labels, name, |label| format!("{name}_{label}"))
    }

    /// Adds a group for each label that cells of a dimension have, under the name that it is given. `data` names the labels in errors.
    pub(crate) fn add_groups_of_labels(
        &mut self,
        labels: &[Vec<Option<i64>>],
        data: &str,
        name: impl Fn(i64) -> String,
    ) -> Result<Vec<LabelGroup>, LabelError> {
        let mut cells: BTreeMap<(u8, i64), usize> = BTreeMap::new();
        for (block, labels) in self.cells.iter().zip(labels) {
            for label in labels.iter().flatten() {
                *cells.entry((block.kind.dim(), *label)).or_default() += 1;
            }
        }
        let values: BTreeSet<i64> = cells.keys().map(|(_, label)| *label).collect();
        match values.len() {
            0 => {
                return Err(LabelError::Empty {
                    name: data.to_owned(),
                });
            }
            count if count > MOST => {
                return Err(LabelError::TooMany {
                    name: data.to_owned(),
                });
            }
            _ => {}
        }
        let mut taken: HashSet<(u8, i32)> = self.physical_groups().into_iter().collect();
        let mut tags: BTreeMap<(u8, i64), i32> = BTreeMap::new();
        let mut groups = Vec::new();
        for (&(dim, label), &count) in &cells {
            let group = name(label);
            let mut names = self.physical_names.iter();
            if names.any(|(key, known)| key.0 == dim && *known == group) {
                return Err(LabelError::Taken { group, dim });
            }
            tags.insert((dim, label), free_tag(dim, label, &mut taken));
            groups.push(LabelGroup {
                name: group,
                dim,
                cells: count,
            });
        }
        let named = tags.iter().zip(&groups);
        self.physical_names
            .extend(named.map(|(((dim, _), tag), group)| ((*dim, *tag), group.name.clone())));
        for (block, labels) in self.cells.iter_mut().zip(labels) {
            add_tags(block, labels, &tags);
        }
        Ok(groups)
    }

    /// The label of each cell of each block.
    fn labels(&self, name: &str) -> Result<Vec<Vec<Option<i64>>>, LabelError> {
        let named = |data: &&crate::CellData| data.name == name;
        let found: Vec<_> = self.cell_data.iter().filter(named).collect();
        let name = name.to_owned();
        let data = match found[..] {
            [data] => data,
            [] => {
                let known: BTreeSet<&String> =
                    self.cell_data.iter().map(|data| &data.name).collect();
                let known = known.into_iter().cloned().collect();
                return Err(LabelError::Unknown { name, known });
            }
            _ => {
                let count = found.len();
                return Err(LabelError::Several { name, count });
            }
        };
        if data.components != 1 {
            let components = data.components;
            return Err(LabelError::NotScalar { name, components });
        }
        let mut labels = Vec::new();
        for (block, values) in data.blocks.iter().enumerate() {
            let mut of_block = Vec::with_capacity(values.len());
            for (cell, &value) in values.iter().enumerate() {
                // Beyond 2^53 not all whole numbers are numbers of f64.
                if !value.is_nan() && (value.fract() != 0.0 || value.abs() > (1u64 << 53) as f64) {
                    let element_tag = self.element_tag(CellIndex { block, cell });
                    return Err(LabelError::NotWhole {
                        name,
                        value,
                        element_tag,
                    });
                }
                of_block.push((!value.is_nan()).then_some(value as i64));
            }
            labels.push(of_block);
        }
        Ok(labels)
    }
}

/// The label itself if it can be a tag, otherwise a free tag.
fn free_tag(dim: u8, label: i64, taken: &mut HashSet<(u8, i32)>) -> i32 {
    let own = i32::try_from(label).ok().filter(|tag| *tag > 0);
    let candidates = own.into_iter().chain(1..i32::MAX);
    let free = candidates
        .into_iter()
        .find(|tag| !taken.contains(&(dim, *tag)));
    let tag = free.unwrap_or(i32::MAX);
    taken.insert((dim, tag));
    tag
}

fn add_tags(block: &mut CellBlock, labels: &[Option<i64>], tags: &BTreeMap<(u8, i64), i32>) {
    let dim = block.kind.dim();
    let mut physical = PhysicalTags::new();
    let mut own = Vec::new();
    for (cell, label) in labels.iter().enumerate() {
        own.clear();
        own.extend_from_slice(block.physical.of(cell));
        own.extend(label.and_then(|label| tags.get(&(dim, label))));
        physical.push(&own);
    }
    block.physical = physical;
}

fn listed(known: &[String]) -> String {
    if known.is_empty() {
        return "the mesh has none".to_owned();
    }
    let names: Vec<String> = known.iter().map(|name| format!("\"{name}\"")).collect();
    format!("there are {}", names.join(", "))
}

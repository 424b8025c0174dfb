//! Finding data by name.

use std::collections::BTreeMap;

use super::{TetData, TetMesh};

/// No data, or several, have the requested name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TetDataError {
    /// No data have the name.
    #[error("no data of tetrahedra are named \"{name}\"; {}", listed(known))]
    Unknown {
        /// The requested name.
        name: String,
        /// Name and number of components of all data.
        known: Vec<(String, usize)>,
    },
    /// Several data have the name.
    #[error(
        "{} data of tetrahedra are named \"{name}\" (time steps {}): keep one of them, or give each a name of its own",
        steps.len(), in_words(steps)
    )]
    Several {
        /// The requested name.
        name: String,
        /// The time step of each.
        steps: Vec<i32>,
    },
}

impl TetMesh {
    /// The data with this name.
    ///
    /// # Errors
    ///
    /// If absent, and the error lists the names; or if there are several, such as time steps.
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

fn listed(known: &[(String, usize)]) -> String {
    if known.is_empty() {
        return "the mesh has none".to_owned();
    }
    // By name, so that time steps of one view occur once.
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

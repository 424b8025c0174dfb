//! Selections without members.

use super::data_values::{DataValues, WithData};

/// A selection without members.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SelectionError {
    /// Nothing meets the conditions.
    #[error(
        "no {wanted} is {selection}; the body reaches from ({}, {}, {}) to ({}, {}, {}) m",
        low[0], low[1], low[2], high[0], high[1], high[2]
    )]
    Nothing {
        /// The kind of member: node, boundary triangle or tetrahedron.
        wanted: &'static str,
        /// Description of the selection.
        selection: String,
        /// Least coordinates of the body (m).
        low: [f64; 3],
        /// Greatest coordinates of the body (m).
        high: [f64; 3],
    },
    /// Nodes meet the conditions, but no cell has only such nodes.
    #[error("no {wanted} has only nodes {selection}; of these there are {nodes}")]
    NoCell {
        /// The kind of cell: boundary triangle or tetrahedron.
        wanted: &'static str,
        /// Description of the selection.
        selection: String,
        /// Number of nodes that are selected.
        nodes: usize,
    },
    /// A node tag that the mesh does not have, or that no tetrahedron uses.
    #[error("no tetrahedron has a node with tag {tag}")]
    UnknownTag {
        /// The tag.
        tag: u64,
    },
    /// No data have the name.
    #[error(
        "no data at nodes or of tetrahedra are named \"{name}\"; {}",
        listed(known)
    )]
    UnknownData {
        /// The requested name.
        name: String,
        /// The existing names.
        known: Vec<String>,
    },
    /// Several data have the name.
    #[error(
        "{} data are named \"{name}\" (time steps {steps:?}): keep one of them, or give each a name of its own", steps.len()
    )]
    SeveralData {
        /// The requested name.
        name: String,
        /// The time step of each.
        steps: Vec<i32>,
    },
    /// The data have several numbers for each node or tetrahedron.
    #[error(
        "the data \"{name}\" have {components} numbers for each holder; a condition is on one number each"
    )]
    NotOneNumber {
        /// Name of the data.
        name: String,
        /// Numbers for each node or tetrahedron.
        components: usize,
    },
    /// No value of the data is one of the requested values.
    #[error("no {holder} is {}; of the values {known}", WithData(name, values))]
    NoValue {
        /// Holder of the values: node or tetrahedron.
        holder: &'static str,
        /// Name of the data.
        name: String,
        /// The values that were requested.
        values: DataValues,
        /// Description of the values that exist.
        known: String,
    },
}

fn listed(known: &[String]) -> String {
    if known.is_empty() {
        return "the mesh has none".to_owned();
    }
    let names: Vec<String> = known.iter().map(|name| format!("\"{name}\"")).collect();
    format!("there are {}", names.join(", "))
}

//! The content of all sections of a file, before tags become indices.

use super::data::RawData;
use super::elements::ElementSection;
use super::entities::Entities;
use super::nodes::RawNodes;
use super::physical_names::{NamesWithoutDim, PhysicalNames};
use crate::mesh::PeriodicLink;

/// The decoded contents of a file, still under the tags of the file.
#[derive(Default)]
pub(super) struct Contents {
    pub(super) physical_names: PhysicalNames,
    pub(super) names_without_dim: NamesWithoutDim,
    /// The entities; `None` if the file has no such section.
    pub(super) entities: Option<Entities>,
    /// The entities of a partitioned mesh, if it is one.
    pub(super) parts: Option<Entities>,
    pub(super) nodes: RawNodes,
    pub(super) has_nodes: bool,
    pub(super) elements: Vec<ElementSection>,
    pub(super) periodic: Vec<PeriodicLink>,
    pub(super) data: Vec<RawData>,
    pub(super) skipped: Vec<String>,
    /// Offset of the file's end.
    pub(super) length: usize,
    pub(super) tables: Tables,
}

/// The names that a version gives to the sections of nodes and of elements, for messages.
#[derive(Clone, Copy)]
pub(super) struct Tables {
    pub(super) nodes: &'static str,
    pub(super) elements: &'static str,
}

impl Default for Tables {
    fn default() -> Tables {
        Tables {
            nodes: "$Nodes",
            elements: "$Elements",
        }
    }
}

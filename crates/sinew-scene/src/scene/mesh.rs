//! `[mesh]`: the source of the body's shape.

use std::path::PathBuf;

use sinew_mesh::structured::Split;

use crate::decode::Table;
use crate::decode::value::{above_zero, count_up_to, text};
use crate::error::SceneError;

/// The source of the body's shape.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshSource {
    /// A mesh file: its path as written, relative to the scene's folder.
    File(PathBuf),
    /// A structured cube with one corner at the origin and the groups `tissue`, `sides`, `top` and
    /// `bottom`.
    Cube {
        /// Hexahedra along each edge.
        cells: usize,
        /// Length of an edge (m).
        edge: f64,
        /// The way in which hexahedra are cut into tetrahedra.
        split: Split,
    },
}

/// Beyond this many cells along an edge a cube has more than 6 million tetrahedra, and its matrix
/// more than a gigabyte.
const MOST_CELLS: usize = 100;

const SPLITS: [(&str, Split); 2] = [("kuhn", Split::Kuhn), ("mirrored", Split::Mirrored)];

pub(super) const KEYS: &[&str] = &["file", "cube"];

impl MeshSource {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        table.exactly_one(KEYS)?;
        if let Some(cube) = table.table("cube", &["cells", "edge", "split"])? {
            return Ok(Self::Cube {
                cells: cube.required(
                    "cells",
                    &format!("a whole number from 1 to {MOST_CELLS}"),
                    count_up_to(MOST_CELLS),
                )?,
                edge: cube.required("edge", "a finite length above 0 m", above_zero)?,
                split: cube
                    .optional_choice("split", &SPLITS)?
                    .unwrap_or(Split::Kuhn),
            });
        }
        let file = table.required("file", "the path of a mesh, seen from the scene", text)?;
        Ok(Self::File(file.into()))
    }
}

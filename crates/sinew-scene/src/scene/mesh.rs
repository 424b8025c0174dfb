//! `[mesh]`: the source of the body's shape, its size and its orientation.

use std::path::PathBuf;

use sinew_mesh::structured::Split;
use toml::de::DeValue;

use crate::decode::Table;
use crate::decode::value::{Misfit, above_zero, count_up_to, finite, list, text, vector};
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
    /// A structured box with one corner at the origin and the groups of a cube.
    Block {
        /// Hexahedra along x, y and z.
        cells: [usize; 3],
        /// Lengths along x, y and z (m, before a scale).
        size: [f64; 3],
        /// The way in which hexahedra are cut into tetrahedra.
        split: Split,
    },
}

/// Changes on the way from the source to the body, made in this order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshChanges {
    /// Whether cells of second and higher order are taken by their corners.
    pub linear: bool,
    /// Factor of all coordinates.
    pub scale: Option<f64>,
    /// A turn about an axis through the origin.
    pub rotation: Option<Rotation>,
}

/// A turn about an axis through the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    /// The axis, of any length but 0.
    pub axis: [f64; 3],
    /// The angle (degrees), counter-clockwise as seen from the axis's tip.
    pub degrees: f64,
}

/// Beyond this many cells along an edge a cube has more than 6 million tetrahedra, and its matrix
/// more than a gigabyte.
const MOST_CELLS: usize = 100;

/// The number of cells of the largest cube, and of the largest block.
const MOST_CELLS_IN_ALL: usize = MOST_CELLS * MOST_CELLS * MOST_CELLS;

const SPLITS: [(&str, Split); 2] = [("kuhn", Split::Kuhn), ("mirrored", Split::Mirrored)];

const SOURCES: &[&str] = &["file", "cube", "block"];

pub(super) const KEYS: &[&str] = &["file", "cube", "block", "scale", "rotate", "order"];

impl MeshSource {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        table.exactly_one(SOURCES)?;
        if let Some(cube) = table.table("cube", &["cells", "edge", "split"])? {
            return Ok(Self::Cube {
                cells: cube.required(
                    "cells",
                    &format!("a whole number from 1 to {MOST_CELLS}"),
                    count_up_to(MOST_CELLS),
                )?,
                edge: cube.required("edge", "a finite length above 0 m", above_zero)?,
                split: split(&cube)?,
            });
        }
        if let Some(block) = table.table("block", &["cells", "size", "split"])? {
            return Ok(Self::Block {
                cells: block.required(
                    "cells",
                    &format!(
                        "three whole numbers above 0 with a product of at most {MOST_CELLS_IN_ALL}"
                    ),
                    three_counts,
                )?,
                size: block.required("size", "three finite lengths above 0 m", three_lengths)?,
                split: split(&block)?,
            });
        }
        let file = table.required("file", "the path of a mesh, seen from the scene", text)?;
        Ok(Self::File(file.into()))
    }
}

impl MeshChanges {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        if !table.has("file") {
            table.refuse(&["order"], "goes with `file`: cubes and blocks are linear")?;
        }
        let linear = table.optional_choice("order", &[("linear", true)])?;
        let scale = table.optional(
            "scale",
            "a finite factor above 0, e.g. 0.001 for a mesh in millimetres",
            above_zero,
        )?;
        let rotation = match table.table("rotate", &["axis", "degrees"])? {
            None => None,
            Some(rotate) => Some(Rotation {
                axis: rotate.required("axis", "[x, y, z], all finite, not all 0", direction)?,
                degrees: rotate.required("degrees", "a finite angle in degrees", finite)?,
            }),
        };
        Ok(Self {
            linear: linear.unwrap_or(false),
            scale,
            rotation,
        })
    }
}

fn split(table: &Table<'_>) -> Result<Split, SceneError> {
    let split = table.optional_choice("split", &SPLITS)?;
    Ok(split.unwrap_or(Split::Kuhn))
}

fn three_counts(value: &DeValue<'_>) -> Result<[usize; 3], Misfit> {
    let counts = list(value, |count| count_up_to(MOST_CELLS_IN_ALL)(count))?;
    let [x, y, z] = <[usize; 3]>::try_from(counts).map_err(|_| Misfit::Value)?;
    let product = x.checked_mul(y).and_then(|xy| xy.checked_mul(z));
    match product {
        Some(product) if product <= MOST_CELLS_IN_ALL => Ok([x, y, z]),
        _ => Err(Misfit::Value),
    }
}

fn three_lengths(value: &DeValue<'_>) -> Result<[f64; 3], Misfit> {
    let lengths = list(value, above_zero)?;
    <[f64; 3]>::try_from(lengths).map_err(|_| Misfit::Value)
}

fn direction(value: &DeValue<'_>) -> Result<[f64; 3], Misfit> {
    match vector(value)? {
        [0.0, 0.0, 0.0] => Err(Misfit::Value),
        direction => Ok(direction),
    }
}

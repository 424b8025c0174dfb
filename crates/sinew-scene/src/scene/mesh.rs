//! `[mesh]`: the source of the body's shape, its size and its orientation.

use std::path::PathBuf;

use sinew_mesh::structured::Split;

use crate::decode::{
    Condition, Count, Inner, Key, Needs, Number, Optional, Or, Table, TableDescription, Text,
    Vector, Words,
};
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

/// Changes between the source and the body, made in this order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshChanges {
    /// True if cells of second and higher order are reduced to their corners.
    pub linear: bool,
    /// Factor of all coordinates.
    pub scale: Option<f64>,
    /// A rotation about an axis through the origin.
    pub rotation: Option<Rotation>,
}

/// A rotation about an axis through the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    /// The axis, of any length but 0.
    pub axis: [f64; 3],
    /// The angle (degrees), counter-clockwise as seen from the axis's tip.
    pub degrees: f64,
}

/// Largest number of cells along an edge: beyond it a cube has more than 6 million tetrahedra, and its matrix more than
/// a gigabyte.
const MOST_CELLS: usize = 100;

/// The number of cells of the largest cube, and of the largest block.
const MOST_CELLS_IN_ALL: usize = MOST_CELLS * MOST_CELLS * MOST_CELLS;

pub(super) const MESH: TableDescription = TableDescription {
    name: "mesh",
    meaning: "The shape of the body: a mesh of tetrahedra from a file, or a cube or a block made here. What a scene \
              says besides is in the metres and axes of the body, after `scale` and `rotate`. \
              Parts that share no node, and surfaces of one part, are kept apart by nothing: a run warns where one is in another.",
    keys: &[&FILE, &CUBE, &BLOCK, &SCALE, &ROTATE, &ORDER],
    needs: Needs::OneOf(&[FILE.name, CUBE.name, BLOCK.name]),
    examples: &[
        "[mesh]\ncube = { cells = 10, edge = 0.2 }\n",
        "[mesh]\nblock = { cells = [24, 4, 4], size = [0.3, 0.05, 0.05] }\n",
        "[mesh]\nfile = \"liver.msh\"\nscale = 0.001\nrotate = { axis = [0, 0, 1], degrees = 90 }\norder = \"linear\"\n",
    ],
};

pub(super) const FILE: Key<Text> = Key::required(
    "file",
    "Mesh file, its path relative to the scene's folder: .msh of gmsh, .vtu and .vtk of VTK, .mesh of Medit, .inp of Abaqus. What each gives as \
     groups and data stands in `sinew mesh info`.",
    Text::any("the path of a mesh, seen from the scene"),
);

const CUBE: Key<Inner> = Key::required(
    "cube",
    "A cube with one corner at the origin and the groups `tissue`, `sides`, `top` and `bottom`.",
    Inner::one("a table such as { cells = 10, edge = 0.2 }", &CUBES),
);

const BLOCK: Key<Inner> = Key::required(
    "block",
    "A block with one corner at the origin and the groups of a cube.",
    Inner::one(
        "a table such as { cells = [24, 4, 4], size = [0.3, 0.05, 0.05] }",
        &BLOCKS,
    ),
);

const SCALE: Key<Number, Optional> = Key::optional(
    "scale",
    "Factor of all coordinates, for meshes that are not in metres.",
    Number::above_zero("a finite factor above 0, e.g. 0.001 for a mesh in millimetres"),
    "coordinates are in metres",
);

const ROTATE: Key<Inner, Optional> = Key::optional(
    "rotate",
    "A turn of the mesh about an axis through the origin.",
    Inner::one(
        "a table such as { axis = [0, 0, 1], degrees = 90 }",
        &ROTATIONS,
    ),
    "no turn",
);

const ORDER: Key<Words<bool>, Optional> = Key::optional(
    "order",
    "Takes cells of second and higher order by their corners; what that changes of the shape is said.",
    Words(&[("linear", true)]),
    "such cells are refused",
)
.only(&[Condition::with(
    FILE.name,
    "goes with `file`: cubes and blocks are linear",
)]);

const CUBES: TableDescription = TableDescription {
    name: "cube",
    meaning: "A cube of equal cells, each cut into tetrahedra.",
    keys: &[&CELLS, &EDGE, &SPLIT],
    needs: Needs::Any,
    examples: &["{ cells = 10, edge = 0.2, split = \"kuhn\" }"],
};

const CELLS: Key<Count> = Key::required(
    "cells",
    "Cells along each edge. A cube of n cells has 6 n^3 tetrahedra.",
    Count {
        least: 1,
        most: MOST_CELLS,
    },
);

const EDGE: Key<Number> = Key::required(
    "edge",
    "Length of an edge.",
    Number::above_zero("a finite length above 0 m"),
)
.unit("m");

const SPLIT: Key<Words<Split>, Or<Split>> = Key::or(
    "split",
    "How cells are cut. `\"mirrored\"`: their diagonals point in turn, so that no direction is preferred over its mirror image; with an even number of cells \
     a body is its own. `\"kuhn\"`: all point one way. Plain tetrahedra, three to four of them across a beam, then bend it sideways too, by 7 to 11 % of its deflection at \
     Poisson's ratio .3 and by a third at .49, and lock the more; with `element = \"fbar-edge\"` by 1 to 2 %, and deflection and torsion come nearer to theory than on mirrored cells \
     (`element` has figures). So it is for such elements, for comparisons with the grids of other programs, and for measuring locking, which mirrored cells hide.",
    Words(&[("mirrored", Split::Mirrored), ("kuhn", Split::Kuhn)]),
    Split::Mirrored,
);

const BLOCKS: TableDescription = TableDescription {
    name: "block",
    meaning: "A block of equal cells, each cut into tetrahedra.",
    keys: &[&CELLS_OF_BLOCK, &SIZE, &SPLIT],
    needs: Needs::Any,
    examples: &["{ cells = [24, 4, 4], size = [0.3, 0.05, 0.05], split = \"mirrored\" }"],
};

const CELLS_OF_BLOCK: Key<Vector<Count, usize>> = Key::required(
    "cells",
    "Cells along x, y and z.",
    Vector {
        expected: "three whole numbers above 0 with a product of at most 1000000",
        of: Count {
            least: 1,
            most: MOST_CELLS_IN_ALL,
        },
        fits: are_not_too_many,
    },
);

const SIZE: Key<Vector> = Key::required(
    "size",
    "Lengths along x, y and z.",
    Vector {
        expected: "three finite lengths above 0 m",
        of: Number::above_zero("a finite length above 0 m"),
        ..Vector::finite("three lengths")
    },
)
.unit("m");

const ROTATIONS: TableDescription = TableDescription {
    name: "rotate",
    meaning: "A turn about an axis through the origin, after the scale.",
    keys: &[&AXIS, &DEGREES],
    needs: Needs::Any,
    examples: &["{ axis = [0, 0, 1], degrees = 90 }"],
};

const AXIS: Key<Vector> = Key::required(
    "axis",
    "Direction of the axis, of any length.",
    Vector {
        expected: "[x, y, z], all finite, not all 0",
        fits: |axis| *axis != [0.0; 3],
        ..Vector::finite("[x, y, z]")
    },
);

const DEGREES: Key<Number> = Key::required(
    "degrees",
    "Angle, counter-clockwise as seen from the tip of the axis.",
    Number::finite("a finite angle in degrees"),
)
.unit("degrees");

impl MeshSource {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        Ok(match table.exactly_one()? {
            key if key == CUBE.name => {
                let cube = table.table(&CUBE)?;
                Self::Cube {
                    cells: cube.read(&CELLS)?,
                    edge: cube.read(&EDGE)?,
                    split: cube.read(&SPLIT)?,
                }
            }
            key if key == BLOCK.name => {
                let block = table.table(&BLOCK)?;
                Self::Block {
                    cells: block.read(&CELLS_OF_BLOCK)?,
                    size: block.read(&SIZE)?,
                    split: block.read(&SPLIT)?,
                }
            }
            _ => Self::File(table.read(&FILE)?.into()),
        })
    }
}

impl MeshChanges {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        table.check_conditions()?;
        let linear = table.read(&ORDER)?;
        let scale = table.read(&SCALE)?;
        let rotation = match table.table(&ROTATE)? {
            None => None,
            Some(rotate) => Some(Rotation {
                axis: rotate.read(&AXIS)?,
                degrees: rotate.read(&DEGREES)?,
            }),
        };
        Ok(Self {
            linear: linear.unwrap_or(false),
            scale,
            rotation,
        })
    }
}

fn are_not_too_many([x, y, z]: &[usize; 3]) -> bool {
    let product = x.checked_mul(*y).and_then(|xy| xy.checked_mul(*z));
    product.is_some_and(|product| product <= MOST_CELLS_IN_ALL)
}

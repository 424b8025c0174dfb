//! The triangles that a tool may meet in a pass.

use super::tool::{Corner, Tool, TouchedTriangle};
use super::tool_step::Way;
use crate::vector::Vector;

/// The corners of all triangles: cells by their indices, then fixed corners.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// The three corners of each triangle.
    pub(super) of: Vec<[u32; 3]>,
    /// The positions (m) of fixed corners, each once.
    held: Vec<Vector>,
}

impl Corners {
    /// The corners of triangles between `cells` cells.
    pub(super) fn of(triangles: &[TouchedTriangle], cells: usize) -> Self {
        let mut known = std::collections::HashMap::new();
        let mut held = Vec::new();
        let mut number = |corner: Corner| match corner {
            Corner::Cell(place) => place,
            Corner::Held(at) => *known.entry(at.map(f64::to_bits)).or_insert_with(|| {
                held.push(at);
                (cells + held.len() - 1) as u32
            }),
        };
        let of = triangles.iter();
        let of = of.map(|triangle| triangle.corners.map(&mut number));
        Self {
            of: of.collect(),
            held,
        }
    }
}

/// The sides of each tool's box on which the paths of corners stay: a triangle whose three paths are all on one side does
/// not meet the box. So almost all triangles are passed over by a comparison of three numbers.
#[derive(Debug, Default)]
pub(super) struct Sides {
    /// The path (m) of each corner in the pass.
    pub(super) ways: Vec<Way>,
    cells: usize,
    /// One flag for each triangle: true if the first round of the pass found it to touch a tool later on.
    pub(super) is_left: Vec<bool>,
    /// Six bits for each corner, one for each side of the box, tool after tool.
    sides: Vec<u8>,
}

impl Sides {
    /// Space for the corners of triangles between `cells` cells; none if no tool meets triangles.
    pub(super) fn new(corners: &Corners, cells: usize, tools: &[Tool]) -> Self {
        if tools.iter().all(|tool| tool.triangles.is_empty()) {
            return Self::default();
        }
        let mut ways = vec![([0.0; 3], [0.0; 3]); cells];
        ways.extend(corners.held.iter().map(|at| (*at, *at)));
        Self {
            sides: vec![0; ways.len() * tools.len()],
            is_left: vec![false; corners.of.len()],
            ways,
            cells,
        }
    }

    /// Begins a pass with the paths (m) of all cells.
    pub(super) fn begin(&mut self, way: impl Fn(usize) -> Way) {
        self.is_left.fill(false);
        self.take(0..self.cells, way);
    }

    /// Takes the paths (m) of some cells.
    pub(super) fn take(&mut self, places: impl Iterator<Item = usize>, way: impl Fn(usize) -> Way) {
        for place in places {
            self.ways[place] = way(place);
        }
    }

    /// Number of corners.
    pub(super) fn corners(&self) -> usize {
        self.ways.len()
    }

    /// Compares the paths of some corners with the box (m) of a tool; `None` for a tool without one, which may meet all.
    pub(super) fn look(
        &mut self,
        tool: usize,
        bounds: Option<&[Vector; 2]>,
        places: impl Iterator<Item = usize>,
    ) {
        let first = tool * self.corners();
        for place in places {
            let sides = bounds.map_or(0, |bounds| sides_of(&self.ways[place], bounds));
            self.sides[first + place] = sides;
        }
    }

    /// The sides of all corners for a tool.
    pub(super) fn of_tool(&self, tool: usize) -> &[u8] {
        &self.sides[tool * self.ways.len()..][..self.ways.len()]
    }
}

/// The sides of a box (m) beyond which a path (m) stays, one bit each.
#[inline]
fn sides_of((from, to): &Way, [low, high]: &[Vector; 2]) -> u8 {
    let mut sides = 0;
    for axis in 0..3 {
        sides |= u8::from(from[axis] < low[axis] && to[axis] < low[axis]) << axis;
        sides |= u8::from(from[axis] > high[axis] && to[axis] > high[axis]) << (3 + axis);
    }
    sides
}

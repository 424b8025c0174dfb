//! The tools of a body.

use std::sync::Mutex;

use super::lips::{CutFace, Lips};
use super::record::{Counts, OF_HELD};
use super::room::Room;
use super::sides::Corners;
use super::tool::{Corner, Grasp, Tool, ToolsError, TouchedCell, TouchedTriangle};
use super::tool_body::ToolBody;
use crate::motion::Motion;
use crate::steering::Steering;

/// Largest number of tools of a body.
pub(super) const MOST_TOOLS: usize = 64;

/// Rigid tools that touch the surface of a body.
#[derive(Debug)]
pub struct Tools {
    pub(super) tools: Vec<Tool>,
    pub(super) cells: Vec<TouchedCell>,
    pub(super) triangles: Vec<TouchedTriangle>,
    pub(super) corners: Corners,
    /// The numbers of `cells`, and their positions (m) at rest.
    pub(super) numbers: Vec<u32>,
    pub(super) rest: Vec<[f64; 3]>,
    /// The tools that may touch each cell, one bit each.
    pub(super) tools_at: Vec<u64>,
    /// Numbers of stored items.
    pub(super) counts: Counts,
    /// The tools whose contacts act on each other, one bit each.
    pub(super) linking: u64,
    /// The faces of cuts.
    pub(super) lips: Lips,
    /// One flag per cell: true if it is part of a pair of cut-face nodes.
    pub(super) is_lip: Vec<bool>,
    pub(super) room: Mutex<Room>,
}

impl Tools {
    /// Tools, and the cells that any of them may touch.
    ///
    /// # Errors
    /// [`ToolsError`] for tools, cells or triangles that do not fit together.
    pub fn new(tools: Vec<Tool>, cells: Vec<TouchedCell>) -> Result<Self, ToolsError> {
        Self::with_triangles(tools, cells, Vec::new())
    }

    /// Tools, the cells that any of them may touch, and triangles between these.
    ///
    /// # Errors
    /// [`ToolsError`] for tools, cells or triangles that do not fit together.
    pub fn with_triangles(
        tools: Vec<Tool>,
        cells: Vec<TouchedCell>,
        triangles: Vec<TouchedTriangle>,
    ) -> Result<Self, ToolsError> {
        if tools.len() > MOST_TOOLS {
            return Err(ToolsError::TooMany {
                count: tools.len(),
                most: MOST_TOOLS,
            });
        }
        let mut tools_at = vec![0; cells.len()];
        for (number, tool) in tools.iter().enumerate() {
            let name = || tool.name.clone();
            if tools[..number].iter().any(|other| other.name == tool.name) {
                return Err(ToolsError::SameName { name: name() });
            }
            if !(tool.friction >= 0.0 && tool.friction.is_finite()) {
                let friction = tool.friction;
                return Err(ToolsError::Friction {
                    name: name(),
                    friction,
                });
            }
            if let Some(Grasp { from, to }) = tool.grasp
                && (from >= to || from.is_nan() || to.is_nan())
            {
                return Err(ToolsError::Grasp {
                    name: name(),
                    from,
                    to,
                });
            }
            if let Some(Err(source)) = tool.body.as_ref().map(ToolBody::check) {
                return Err(ToolsError::Body {
                    name: name(),
                    source,
                });
            }
            let is_missing = |corner: &Corner| match corner {
                Corner::Cell(place) => *place as usize >= cells.len(),
                Corner::Held(_) => false,
            };
            for place in &tool.triangles {
                let triangle = triangles.get(*place as usize);
                if triangle.is_none_or(|triangle| triangle.corners.iter().any(is_missing)) {
                    return Err(ToolsError::NoTriangle {
                        name: name(),
                        place: *place,
                        triangles: triangles.len(),
                    });
                }
            }
            for place in &tool.cells {
                let at = tools_at.get_mut(*place as usize);
                *at.ok_or_else(|| ToolsError::NoCell {
                    name: name(),
                    place: *place,
                    cells: cells.len(),
                })? |= 1 << number;
            }
        }
        Ok(Self::sound(
            tools,
            (cells, triangles),
            tools_at,
            Lips::default(),
        ))
    }

    /// These tools, each of which follows its own motion until it is steered.
    #[must_use]
    pub fn steered(&self, steering: &[Steering]) -> Self {
        let mut tools = self.tools.clone();
        for (tool, steering) in tools.iter_mut().zip(steering) {
            tool.motion = Motion::Steered(Box::new(tool.motion.clone()), *steering);
        }
        let surface = (self.cells.clone(), self.triangles.clone());
        let (tools_at, lips) = (self.tools_at.clone(), self.lips.clone());
        Self::sound(tools, surface, tools_at, lips)
    }

    /// Tools that were checked to fit together.
    fn sound(
        tools: Vec<Tool>,
        (cells, triangles): (Vec<TouchedCell>, Vec<TouchedTriangle>),
        tools_at: Vec<u64>,
        lips: Lips,
    ) -> Self {
        let is_body = |tool: &Tool| tool.body.is_some();
        let links = |tool: &Tool| is_body(tool) || !tool.triangles.is_empty();
        let linking = (0..).zip(&tools).filter(|(_, tool)| links(tool));
        let linking = linking.fold(0, |bits, (number, _)| bits | 1 << number);
        let mut is_lip = vec![false; cells.len()];
        for node in lips.pairs.iter().flat_map(|pair| pair.nodes) {
            if let Corner::Cell(place) = node {
                is_lip[place as usize] = true;
            }
        }
        let corners = Corners::of(&triangles, cells.len());
        let has_links = linking != 0 || !lips.pairs.is_empty();
        Self {
            numbers: cells.iter().map(|cell| cell.cell).collect(),
            rest: cells.iter().map(|cell| cell.rest).collect(),
            counts: Counts {
                tools: tools.len(),
                bodies: tools.iter().filter(|tool| is_body(tool)).count(),
                cells: cells.len(),
                rubs: tools.iter().any(|tool| tool.friction > 0.0),
                holds: tools.iter().any(Tool::may_hold),
                pairs: lips.pairs.len(),
            },
            linking,
            room: Mutex::new(Room::of(
                &tools,
                if has_links {
                    [cells.len(), triangles.len()]
                } else {
                    [0; 2]
                },
                &cells,
                (&corners, &lips),
            )),
            tools,
            cells,
            triangles,
            corners,
            tools_at,
            lips,
            is_lip,
        }
    }

    /// These tools on a body with cut faces, which do not pass through each other. Corners are indices among the
    /// touched cells.
    ///
    /// # Errors
    /// [`ToolsError::NoLip`] for a corner beyond these.
    pub fn with_cut_faces(self, faces: Vec<CutFace>) -> Result<Self, ToolsError> {
        let count = self.cells.len();
        let corners = faces.iter().flat_map(|face| face.corners).flatten();
        for corner in corners {
            if let Corner::Cell(place) = corner
                && place as usize >= count
            {
                return Err(ToolsError::NoLip {
                    place,
                    cells: count,
                });
            }
        }
        let lips = Lips::of(faces, |place| self.cells[place as usize].rest);
        let surface = (self.cells, self.triangles);
        Ok(Self::sound(self.tools, surface, self.tools_at, lips))
    }

    /// Number of pairs of nodes that cuts made from one node and that may not pass each other.
    #[must_use]
    pub fn lip_pairs(&self) -> usize {
        self.lips.pairs.len()
    }

    /// The tools.
    #[must_use]
    pub fn tools(&self) -> &[Tool] {
        &self.tools
    }

    /// The cells that any of them may touch.
    #[must_use]
    pub fn touched_cells(&self) -> &[TouchedCell] {
        &self.cells
    }

    /// True if contacts of a tool act on each other within a step, so that they are found by an iteration.
    #[must_use]
    pub fn links(&self, tool: usize) -> bool {
        self.linking >> tool & 1 == 1
    }

    /// Indices of the touched cells that tools grasp after a step, from the contact variables
    /// ([`sinew_core::State::contact`]).
    pub fn held<'s>(&'s self, contact: &'s [f64]) -> impl Iterator<Item = usize> + 's {
        let numbers = contact.get(self.counts.of_held());
        let rows = numbers.unwrap_or_default().as_chunks::<OF_HELD>().0;
        let rows = rows.iter().enumerate();
        rows.filter_map(|(place, held)| (held[0] != 0.0).then_some(place))
    }

    /// Index of a tool among those that are dynamic bodies.
    pub(super) fn body_of(&self, tool: usize) -> Option<usize> {
        let is_body = |tool: &&Tool| tool.body.is_some();
        self.tools[tool].body?;
        Some(self.tools[..tool].iter().filter(is_body).count())
    }
}

//! The tools of a body.

use std::sync::Mutex;

use super::record;
use super::room::Room;
use super::tool::{Grasp, Tool, ToolsError, TouchedCell};

/// Most tools of a body.
const MOST_TOOLS: usize = 64;

/// Rigid tools that touch the surface of a body.
#[derive(Debug)]
pub struct Tools {
    pub(super) tools: Vec<Tool>,
    pub(super) cells: Vec<TouchedCell>,
    /// The numbers of `cells`.
    pub(super) numbers: Vec<u32>,
    /// The same with the positions at rest (m), for the look at all of them.
    pub(super) places: Vec<(u32, [f64; 3])>,
    /// The tools that may touch each cell, one bit each.
    pub(super) tools_at: Vec<u64>,
    /// Whether any tool ever holds.
    pub(super) holds: bool,
    pub(super) room: Mutex<Room>,
}

impl Tools {
    /// Tools, and the cells that any of them may touch.
    ///
    /// # Errors
    /// [`ToolsError`] for what does not fit together.
    pub fn new(tools: Vec<Tool>, cells: Vec<TouchedCell>) -> Result<Self, ToolsError> {
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
            for place in &tool.cells {
                let at = tools_at.get_mut(*place as usize);
                *at.ok_or_else(|| ToolsError::NoCell {
                    name: name(),
                    place: *place,
                    cells: cells.len(),
                })? |= 1 << number;
            }
        }
        Ok(Self {
            numbers: cells.iter().map(|cell| cell.cell).collect(),
            holds: tools.iter().any(|tool| tool.grasp.is_some()),
            places: cells.iter().map(|cell| (cell.cell, cell.rest)).collect(),
            room: Mutex::new(Room::of(&tools, cells.len())),
            tools,
            cells,
            tools_at,
        })
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

    /// Place of the first number of held cells.
    pub(super) fn first_held(&self) -> usize {
        record::numbers(self.tools.len(), self.cells.len(), false)
    }
}

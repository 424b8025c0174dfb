//! Loads, dashpots and matrix rows of fixed components, which M, D, K and the loads of a model leave out.

use std::sync::OnceLock;

use sinew_core::Ramp;

use crate::body::Body;
use crate::border::Border;
use crate::error::Item;
use crate::motion::Motions;
use crate::network::Dashpot;
use crate::parts::Parts;

/// The part of a load that falls on fixed components: `ramp(t)` times `forces`.
#[derive(Clone, Debug)]
pub(crate) struct HeldLoad {
    /// The load, or gravity.
    pub(crate) item: Item,
    pub(crate) ramp: Ramp,
    /// (node, force (N)), nodes increasing; components that move are zero.
    pub(crate) forces: Vec<(u32, [f64; 3])>,
}

impl HeldLoad {
    /// The prescribed motions, by their places, of the components that it falls on.
    pub(crate) fn moved_by(&self, motions: &Motions) -> impl Iterator<Item = usize> {
        self.forces.iter().flat_map(move |(node, force)| {
            let loaded = (0..3).filter(|axis| force[*axis] != 0.0);
            loaded.filter_map(move |axis| motions.part_of(*node, axis))
        })
    }
}

/// Everything that acts on fixed components.
#[derive(Clone, Debug)]
pub(crate) struct Supports {
    pub(crate) loads: Vec<HeldLoad>,
    /// Dashpots with a fixed end.
    dashpots: Vec<Dashpot>,
    /// Summed up at the first request: most runs ask for no reaction.
    border: OnceLock<Border>,
}

impl Supports {
    /// `dashpots` are those of the whole body.
    pub(crate) fn new(body: &Body, loads: Vec<HeldLoad>, dashpots: &[Dashpot]) -> Self {
        let held = |node: &u32| body.cells.held_nodes.binary_search(node).is_ok();
        let at_supports = dashpots
            .iter()
            .filter(|dashpot| dashpot.nodes.iter().any(held));
        Self {
            loads,
            dashpots: at_supports.copied().collect(),
            border: OnceLock::new(),
        }
    }

    /// Forgets the rows of fixed nodes, which have changed.
    pub(crate) fn forget_border(&mut self) {
        self.border = OnceLock::new();
    }

    /// The rows of the nodes `held`.
    pub(crate) fn border(&self, parts: Parts<'_>, held: &[u32]) -> &Border {
        let rows = || Border::new(parts, held, &self.dashpots);
        self.border.get_or_init(rows)
    }
}

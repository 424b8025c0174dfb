//! A watch for bodies that pass through each other.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::State;
use sinew_fem::FieldError;
use sinew_tools::vector::{Vector, add};

use super::names::names;
use super::search::{Lips, OverlapSearch};
use crate::number::{short, vector};
use crate::simulation::BodyModel;

/// Share of an edge by which cut faces with contact between them may overlap without a report: contact acts node by
/// node, and a cut is rough between its nodes.
const LIPS: f64 = 0.5;

/// Two parts of a body, or two surfaces of one part, that overlap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Overlap {
    /// Distance (m) of the deepest point from the surface of the part that contains it.
    pub depth: f64,
    /// Time (s).
    pub t: f64,
    /// The point (m).
    pub at: [f64; 3],
    /// The tag of the node at the point, or next to it if no node is inside.
    pub node: u64,
    /// The parts, by groups of tetrahedra: that of the node, and that which contains the node.
    pub parts: [String; 2],
}

impl fmt::Display for Overlap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, other] = &self.parts;
        let in_what = match one == other {
            true => format!("`{one}` is in itself"),
            false => format!("`{one}` is in `{other}`"),
        };
        write!(
            f,
            "{in_what}, {} m deep at node {}, {} m, at t = {} s: nothing keeps parts or surfaces of a body apart",
            short(self.depth),
            self.node,
            vector(self.at),
            short(self.t)
        )
    }
}

/// A watch for parts and surfaces of a body that pass through each other; it keeps the deepest overlap.
///
/// A check costs some tenths of a microsecond for each triangle of the surface, unless surfaces touch.
pub struct OverlapWatch {
    body: Arc<BodyModel>,
    /// The search; made at the first check.
    search: Option<OverlapSearch>,
    /// Buffers for the current state.
    displacements: Vec<Vector>,
    places: Vec<Vector>,
    deepest: Option<Overlap>,
}

impl fmt::Debug for OverlapWatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OverlapWatch")
            .field("deepest", &self.deepest)
            .finish_non_exhaustive()
    }
}

impl OverlapWatch {
    /// A watch that has not found an overlap yet.
    #[must_use]
    pub fn new(body: &Arc<BodyModel>) -> Self {
        Self {
            body: Arc::clone(body),
            search: None,
            displacements: Vec::new(),
            places: Vec::new(),
            deepest: None,
        }
    }

    /// The deepest overlap so far.
    #[must_use]
    pub fn deepest(&self) -> Option<&Overlap> {
        self.deepest.as_ref()
    }

    /// The deepest overlap so far; consumes the watch.
    #[must_use]
    pub fn into_deepest(self) -> Option<Overlap> {
        self.deepest
    }

    /// Checks a state.
    ///
    /// # Errors
    /// [`FieldError`] for a state of another body.
    pub fn look_at_state(&mut self, state: &State) -> Result<(), FieldError> {
        let mut displacements = std::mem::take(&mut self.displacements);
        displacements.resize(self.body.mesh.points.len(), [0.0; 3]);
        let model = &self.body.model;
        let known = model.displacements_at(state.t(), &state.u, &mut displacements);
        if known.is_ok() {
            self.look(state.t(), &displacements);
        }
        self.displacements = displacements;
        known
    }

    /// Checks displacements (m) of all nodes at a time (s).
    pub fn look(&mut self, t: f64, displacements: &[[f64; 3]]) {
        let body = &*self.body;
        let mesh = &body.mesh;
        let search = self.search.get_or_insert_with(|| {
            let triangles = body.surface_triangles().collect();
            let cut = body.cut.as_ref();
            let origins = cut.map_or_else(Vec::new, |from| from.cut.origins.clone());
            OverlapSearch::new(Arc::clone(mesh), triangles, origins, lips(body))
        });
        self.places.clear();
        let moved = mesh.points.iter().zip(displacements);
        self.places.extend(moved.map(|(rest, by)| add(*rest, *by)));
        let Some(inside) = search.deepest(&self.places) else {
            return;
        };
        let known = self.deepest.as_ref().map_or(0.0, |overlap| overlap.depth);
        if inside.depth > known {
            self.deepest = Some(Overlap {
                depth: inside.depth,
                t,
                at: inside.at,
                node: mesh.node_tags[inside.node as usize],
                parts: names(mesh, search.tets_of(&inside)),
            });
        }
    }
}

/// The cut faces between which contact acts, and the nodes at which tetrahedra were separated because others were
/// removed.
fn lips(body: &BodyModel) -> Option<Lips> {
    let cut = &body.cut.as_ref()?.cut;
    let pairs = body.tools.as_ref().map_or(0, |tools| tools.lip_pairs());
    let are_free = pairs == 0 && !cut.cut_faces().is_empty();
    (!are_free).then(|| Lips {
        is_copied: cut.is_copied(),
        share: LIPS,
    })
}

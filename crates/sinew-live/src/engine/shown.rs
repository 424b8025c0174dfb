//! A body in the form for pages.

use std::sync::Arc;
use std::time::{Duration, Instant};

use sinew_core::LoadTime;
use sinew_mesh::TetMesh;
use sinew_scene::{BodyModel, Cutter};
use sinew_world::World;

use crate::picture::{Colours, Plane, Section, Seen, Surface, twins};
use crate::protocol::{Field, NONE};

/// Divisor of time: colours and energies take at most one part in `SHARE` of the time.
const SHARE: u32 = 5;

/// Divisor of time: checks for overlap take at most one part in `SHARE_OF_OVERLAP` of the time, so they may be rare.
const SHARE_OF_OVERLAP: u32 = 50;

/// A task that is done as often as its share of time allows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    share: u32,
    last: Option<(Instant, Duration)>,
}

impl Default for Budget {
    fn default() -> Self {
        Self::of(SHARE)
    }
}

impl Budget {
    fn of(share: u32) -> Self {
        Self { share, last: None }
    }

    /// Time budget of overlap checks.
    pub(super) fn of_overlap() -> Self {
        Self::of(SHARE_OF_OVERLAP)
    }

    pub(super) fn is_due(&self) -> bool {
        self.last
            .is_none_or(|(end, cost)| end.elapsed() >= self.share * cost)
    }

    pub(super) fn spent_since(&mut self, begun: Instant) {
        let now = Instant::now();
        self.last = Some((now, now - begun));
    }
}

/// Surface and colours of a body between two changes of it.
pub(super) struct Shown {
    mesh: Arc<TetMesh>,
    pub(super) surface: Surface,
    colours: Colours,
    coloured: Budget,
    displacement: Vec<[f64; 3]>,
    pub(super) section: Section,
    /// Number of pieces of the body.
    pub(super) pieces: usize,
}

impl Shown {
    /// A body, with its surface before all cuts.
    pub(super) fn of(session: &World, body: &BodyModel, uncut: &Surface) -> Self {
        let surface = uncut.after_cuts(body);
        Self {
            mesh: Arc::clone(&body.mesh),
            colours: Colours::new(&body.model, &surface),
            surface,
            coloured: Budget::default(),
            displacement: vec![[0.0; 3]; body.mesh.points.len()],
            section: Section::default(),
            pieces: session.cutter().map_or(1, Cutter::pieces),
        }
    }

    /// True if it shows this body.
    pub(super) fn is_of(&self, body: &BodyModel) -> bool {
        Arc::ptr_eq(&self.mesh, &body.mesh)
    }

    /// Updates displacements of all nodes and, if there is time or if the choice of colours changed, colours.
    pub(super) fn paint(
        &mut self,
        session: &World,
        (field, limit): (Field, Option<f64>),
        anew: bool,
    ) {
        let body = session.body().model().body();
        let Some(body) = body.filter(|body| self.is_of(body)) else {
            return;
        };
        let (model, state) = (&body.model, session.state());
        // The lengths are those of the model; motions that follow inputs are not among what a session has.
        let found = model.displacements_at(
            LoadTime::at(state.t()).under(session.inputs()),
            &state.u,
            &mut self.displacement,
        );
        if found.is_ok() && (anew || self.coloured.is_due()) {
            let begun = Instant::now();
            let seen = Seen {
                model,
                surface: &self.surface,
                state,
                displacement: &self.displacement,
                tools: body.tools.as_deref(),
                limit,
            };
            // Fields that a body lacks are not offered.
            let _ = self.colours.take(field, &seen);
            self.coloured.spent_since(begun);
        }
    }

    /// Number of inverted tetrahedra.
    pub(super) fn inverted(&self) -> u32 {
        self.colours.inverted
    }

    /// Positions of the points of the surface (m).
    pub(super) fn places(&self) -> impl Iterator<Item = [f32; 3]> {
        let points = self.surface.nodes.iter().zip(&self.surface.points);
        points.map(|(node, point)| {
            let u = self.displacement[*node as usize];
            std::array::from_fn(|axis| (point[axis] + u[axis]) as f32)
        })
    }

    /// Makes the section by a plane; an empty one without a plane.
    pub(super) fn cut(&mut self, plane: Option<Plane>) {
        let tets = plane.map_or(&[][..], |_| &self.mesh.tets);
        let plane = plane.unwrap_or(Plane { axis: 0, at: 0.0 });
        let (points, moved) = (&self.mesh.points, &self.displacement);
        let place = |node: u32| -> [f64; 3] {
            let (point, u) = (points[node as usize], moved[node as usize]);
            std::array::from_fn(|axis| point[axis] + u[axis])
        };
        self.section.cut(tets, place, &self.colours.at_nodes, plane);
    }

    /// The colours of the points.
    pub(super) fn values(&self) -> &[f32] {
        &self.colours.values
    }
}

/// For each point of a surface the point of another one that is the same corner of the same tetrahedron, or [`NONE`].
pub(super) fn twin_points(
    (own, surface): (&BodyModel, &Surface),
    (other, other_surface): (&BodyModel, &Surface),
) -> Vec<u32> {
    let twin_of = twins(own, other);
    let twins = surface.nodes.iter().map(|node| twin_of[*node as usize]);
    let points = twins.map(|twin| other_surface.point_of(twin));
    points
        .map(|point| point.map_or(NONE, |point| point as u32))
        .collect()
}

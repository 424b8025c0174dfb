//! The surfaces of all panes, which change when a body is cut.

use axum::body::Bytes;

use super::pane::Pane;
use super::shown::twin_points;
use crate::picture::Surface;
use crate::protocol::{NONE, SurfaceShape, topology};

/// The surfaces of all panes in the form for pages. A picture names their epoch.
#[derive(Debug, Default)]
pub(super) struct Topology {
    /// Number of changes, the first surfaces among them.
    pub(super) epoch: u32,
    /// The message.
    pub(super) message: Bytes,
}

impl Topology {
    /// Updates the surfaces of changed bodies; `uncut` is the surface before all cuts. Returns true if there were
    /// any.
    pub(super) fn follow(&mut self, panes: &mut [Pane], uncut: &Surface) -> bool {
        let mut is_new = false;
        for pane in panes.iter_mut() {
            is_new |= pane.see_body(uncut);
        }
        if !is_new {
            return false;
        }
        let seen: Vec<_> = panes.iter().filter_map(Pane::seen_body).collect();
        let twins = (0..seen.len()).map(|own| match (seen.get(own), seen.get(1 - own.min(1))) {
            (Some(own), Some(other)) => twin_points(*own, *other),
            (Some((_, surface)), None) => vec![NONE; surface.points.len()],
            (None, _) => Vec::new(),
        });
        let twins: Vec<Vec<u32>> = twins.collect();
        let surfaces = seen
            .iter()
            .zip(&twins)
            .map(|((_, surface), twins)| SurfaceShape {
                points: &surface.points,
                triangles: &surface.triangles,
                outer: surface.outer,
                twins,
            });
        self.epoch += 1;
        self.message = topology(self.epoch, &surfaces.collect::<Vec<_>>()).into();
        true
    }
}

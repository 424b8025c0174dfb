//! A surface in motion.

use std::sync::Arc;

use crate::Surface;

/// The surface at an instant.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Time (s).
    pub(crate) t: f64,
    pub(crate) surface: Arc<Surface>,
    /// Displacement (m) of each point.
    pub(crate) displacements: Vec<[f32; 3]>,
    /// The value that colours each point; empty without a field.
    pub(crate) values: Vec<f32>,
}

impl Frame {
    /// The surface at the time `t` (s), with the displacement (m) of each of its points and the value that colours it.
    /// Points beyond the end of a list are at rest, and their value is 0.
    #[must_use]
    pub fn new(
        t: f64,
        surface: Arc<Surface>,
        mut displacements: Vec<[f32; 3]>,
        mut values: Vec<f32>,
    ) -> Self {
        let points = surface.rest.len();
        displacements.resize(points, [0.0; 3]);
        if !values.is_empty() {
            values.resize(points, 0.0);
        }
        Self {
            t,
            surface,
            displacements,
            values,
        }
    }

    /// The position (m) of a point.
    pub(crate) fn place(&self, point: usize) -> [f64; 3] {
        let (rest, u) = (self.surface.rest[point], self.displacements[point]);
        [0, 1, 2].map(|axis| rest[axis] + f64::from(u[axis]))
    }

    /// The motion at a share of the time to a later frame of the same surface.
    fn towards(&self, later: &Self, share: f64) -> Self {
        let part = share as f32;
        let mix = |a: f32, b: f32| a + part * (b - a);
        let displacements = self.displacements.iter().zip(&later.displacements);
        let displacements = displacements.map(|(a, b)| [0, 1, 2].map(|axis| mix(a[axis], b[axis])));
        let values = self.values.iter().zip(&later.values);
        Self {
            t: self.t + share * (later.t - self.t),
            surface: Arc::clone(&self.surface),
            displacements: displacements.collect(),
            values: values.map(|(a, b)| mix(*a, *b)).collect(),
        }
    }
}

/// Frames in the order of time.
#[derive(Debug, Clone)]
pub struct Clip {
    pub(crate) frames: Vec<Frame>,
}

impl Clip {
    /// A clip of these frames.
    #[must_use]
    pub fn new(mut frames: Vec<Frame>) -> Self {
        frames.sort_by(|a, b| a.t.total_cmp(&b.t));
        Self { frames }
    }

    /// The clip with displacements that are `factor` times as large, to show small ones.
    #[must_use]
    pub fn magnified(mut self, factor: f64) -> Self {
        for frame in &mut self.frames {
            for u in &mut frame.displacements {
                *u = u.map(|u| (f64::from(u) * factor) as f32);
            }
        }
        self
    }

    /// Times (s) of the first and the last frame; `None` without frames.
    #[must_use]
    pub fn span(&self) -> Option<[f64; 2]> {
        Some([self.frames.first()?.t, self.frames.last()?.t])
    }

    /// The surface at a time (s): on straight lines between frames of the same surface, otherwise that of the frame
    /// before. `None` without frames.
    pub(crate) fn at(&self, t: f64) -> Option<Frame> {
        let after = self.frames.partition_point(|frame| frame.t <= t);
        let before = self.frames.get(after.saturating_sub(1))?;
        let Some(later) = self.frames.get(after) else {
            return Some(before.clone());
        };
        let is_same = Arc::ptr_eq(&before.surface, &later.surface);
        let span = later.t - before.t;
        if !is_same || span <= 0.0 || t <= before.t {
            return Some(before.clone());
        }
        Some(before.towards(later, (t - before.t) / span))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Kind;

    fn surface() -> Arc<Surface> {
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Arc::new(Surface::new(points, &[[0, 1, 2]], &[Kind::Tissue(1)]))
    }

    fn frame(t: f64, surface: &Arc<Surface>, u: f32) -> Frame {
        Frame::new(t, Arc::clone(surface), vec![[u; 3]; 3], vec![10.0 * u; 3])
    }

    fn found(clip: &Clip, t: f64) -> Option<(f32, f32)> {
        let frame = clip.at(t)?;
        Some((frame.displacements[0][0], frame.values[0]))
    }

    #[test]
    fn motion_is_straight_between_frames_and_ends_with_the_last() {
        let surface = surface();
        let clip = Clip::new(vec![frame(2.0, &surface, 3.0), frame(1.0, &surface, 1.0)]);
        assert_eq!(clip.span(), Some([1.0, 2.0]));
        assert_eq!(found(&clip, 1.5), Some((2.0, 20.0)));
        assert_eq!(found(&clip, 0.0), Some((1.0, 10.0)));
        assert_eq!(found(&clip, 9.0), Some((3.0, 30.0)));
        assert_eq!(found(&Clip::new(Vec::new()), 0.0), None);
    }

    #[test]
    fn a_body_that_is_cut_stays_as_it_was_until_it_is_another_one() {
        let clip = Clip::new(vec![
            frame(0.0, &surface(), 1.0),
            frame(1.0, &surface(), 2.0),
        ]);
        assert_eq!(found(&clip, 0.9), Some((1.0, 10.0)));
        assert_eq!(found(&clip, 1.0), Some((2.0, 20.0)));
    }
}

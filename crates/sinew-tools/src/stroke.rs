//! The motion of a part of a tool over a step, and its contacts.

use crate::pose::Pose;
use crate::shape::{Convex, Hull, Part, Touch, Triangle, TriangleTouch};
use crate::vector::{between, length, sub};

/// The largest turn (rad) of a tool in one pass: the chord of a path then deviates from it by at most turn^2/8 of its
/// distance.
const LARGEST_TURN: f64 = 0.1;

/// The longest path of a round tool in one pass, in radii: normals of the first contact still fit the contact at the
/// end.
const LONGEST_WAY: f64 = 0.5;

const MOST_PASSES: f64 = 1000.0;

/// The motion of one part of a tool over a step: a straight line for the tool's origin, with the shortest rotation
/// about it at constant rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    part: Part,
    /// The tool's poses before and after.
    tool: [Pose; 2],
    /// The part's own poses before and after.
    ends: [Pose; 2],
    /// The turn of the tool over the step (rad, in the world).
    turn: [f64; 3],
    passes: u32,
}

impl Stroke {
    /// The motion of a part of a tool that has these poses before and after the step.
    #[must_use]
    pub fn new(part: &Part, before: Pose, after: Pose) -> Self {
        let turn = before.turn_to(&after);
        let mut stroke = Self {
            part: *part,
            tool: [before, after],
            ends: [before.then(&part.pose), after.then(&part.pose)],
            turn,
            passes: 1,
        };
        let turns = length(turn) / LARGEST_TURN;
        let ways = stroke.longest_way() / LONGEST_WAY;
        let passes = turns.max(ways).ceil().clamp(1.0, MOST_PASSES);
        stroke.passes = passes as u32;
        stroke
    }

    /// Number of equal passes in which this stroke should be taken: at most .1 rad each, and at most half a radius for
    /// any point of a round part; from 1 to 1000.
    #[must_use]
    pub fn passes(&self) -> u32 {
        self.passes
    }

    /// The number of straight pieces that approximate the path of a node in the part's own frame: one if the tool
    /// does not turn.
    #[must_use]
    pub fn pieces(&self) -> u32 {
        if self.turns() { self.passes } else { 1 }
    }

    /// The pose of the part in the world at a share of the step.
    #[must_use]
    pub fn pose_at(&self, share: f64) -> Pose {
        let [start, end] = self.ends;
        if share <= 0.0 {
            return start;
        }
        if share >= 1.0 {
            return end;
        }
        let [before, after] = &self.tool;
        let tool = before.on_the_way(after, self.turn, share);
        tool.then(&self.part.pose)
    }

    /// The first contact of a node that moves straight from `from` to `to` (m, in the world) over the step.
    ///
    /// The share is that of the step; point and normal are in the part's own frame, [`Self::pose_at`] takes them to the
    /// world. In that frame the path of the node is divided into straight [`Self::pieces`].
    #[must_use]
    pub fn first_contact(&self, from: [f64; 3], to: [f64; 3]) -> Option<Touch> {
        let pieces = self.pieces();
        let mut start = self.pose_at(0.0).to_own(from);
        for piece in 1..=pieces {
            let (share, node) = if piece == pieces {
                (1.0, to)
            } else {
                let share = f64::from(piece) / f64::from(pieces);
                (share, between(from, to, share))
            };
            let end = self.pose_at(share).to_own(node);
            if let Some(touch) = self.part.convex.first_contact(start, end) {
                let share = (f64::from(piece - 1) + touch.share) / f64::from(pieces);
                return Some(Touch { share, ..touch });
            }
            start = end;
        }
        None
    }

    /// The first contact of a triangle whose corners move straight (m, in the world) over the step; point and normal
    /// are in the part's own frame. `None` for a plane.
    pub(crate) fn first_triangle(&self, from: &Triangle, to: &Triangle) -> Option<TriangleTouch> {
        let hull = Hull::of(&self.part.convex)?;
        let pieces = self.pieces();
        let own = |share: f64, corners: &Triangle| {
            let pose = self.pose_at(share);
            corners.map(|corner| pose.to_own(corner))
        };
        let mut start = own(0.0, from);
        for piece in 1..=pieces {
            let share = f64::from(piece) / f64::from(pieces);
            let corners = match piece == pieces {
                true => *to,
                false => [0, 1, 2].map(|corner| between(from[corner], to[corner], share)),
            };
            let end = own(share, &corners);
            if let Some(touch) = hull.first_contact(&start, &end) {
                let share = (f64::from(piece - 1) + touch.share) / f64::from(pieces);
                return Some(TriangleTouch { share, ..touch });
            }
            start = end;
        }
        None
    }

    /// The contact with a triangle that is in the part (m, in the world) at the end of the step by more than a rounding; point and normal are in the part's own frame.
    pub(crate) fn triangle_at_end(&self, corners: &Triangle) -> Option<TriangleTouch> {
        let pose = self.pose_at(1.0);
        let own = corners.map(|corner| pose.to_own(corner));
        Hull::of(&self.part.convex)?.overlap(&own)
    }

    /// Half the smallest width (m) of the part; infinite for a plane.
    pub(crate) fn half_width(&self) -> f64 {
        self.part.convex.half_width()
    }

    /// The depth (m) in the part up to which triangles that move by `way` (m) in a step are left in it, and pushed
    /// out by the next; infinite for a plane.
    pub(crate) fn left_to_triangles(&self, way: f64) -> f64 {
        let [before, after] = self.tool.map(|pose| pose.position());
        let own = length(sub(after, before)) + self.largest_arc().unwrap_or(0.0);
        let hull = Hull::of(&self.part.convex);
        hull.map_or(f64::INFINITY, |hull| hull.left(way + own))
    }

    /// A box (m, lowest and highest corner) that contains the part during the whole step; none for a plane.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let arc = self.largest_arc()?;
        let [first, last] = self.ends.map(|pose| half_sizes(&self.part.convex, &pose));
        let (first, last) = (first?, last?);
        let [start, end] = self.ends.map(|pose| pose.position());
        let low = [0, 1, 2].map(|axis| (start[axis] - first[axis]).min(end[axis] - last[axis]));
        let high = [0, 1, 2].map(|axis| (start[axis] + first[axis]).max(end[axis] + last[axis]));
        // A point at distance r from the centre of a steady turn by an angle a is never farther than r a^2/8 from where it would
        // be on a straight way.
        let bulge = arc * length(self.turn) / 8.0;
        Some([
            low.map(|value| value - bulge),
            high.map(|value| value + bulge),
        ])
    }

    fn turns(&self) -> bool {
        self.turn != [0.0; 3]
    }

    /// Upper bound of the arc (m) of any point of a bounded part in the rotation about the tool's origin.
    fn largest_arc(&self) -> Option<f64> {
        let reach = self.part.convex.reach()?;
        Some(length(self.turn) * (length(self.part.pose.position()) + reach))
    }

    /// Upper bound of the displacement of any point of a round part, in its smallest radii; 0 for parts with flat
    /// faces.
    fn longest_way(&self) -> f64 {
        let [before, after] = self.tool.map(|pose| pose.position());
        let way = length(sub(after, before));
        let arc = self.largest_arc();
        let radius = self.part.convex.smallest_radius();
        arc.zip(radius)
            .map_or(0.0, |(arc, radius)| (way + arc) / radius)
    }
}

/// Half the sizes (m) of the box along the world's axes about a shape; none for a plane.
fn half_sizes(convex: &Convex, pose: &Pose) -> Option<[f64; 3]> {
    let rotation = pose.rotation();
    match *convex {
        Convex::Sphere { radius } => Some([radius; 3]),
        Convex::Capsule { radius, length } => {
            Some(rotation.map(|[_, _, z]| radius + z.abs() * length / 2.0))
        }
        Convex::Plane => None,
        Convex::Cuboid { size: [a, b, c] } => {
            Some(rotation.map(|[x, y, z]| (x.abs() * a + y.abs() * b + z.abs() * c) / 2.0))
        }
    }
}

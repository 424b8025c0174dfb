//! The step of a tool: its poses, and its contacts.

use super::body_step::BodyStep;
use super::record::{OF_BODY, OF_HELD};
use super::tool::Tool;
use crate::pose::Pose;
use crate::shape::{Touch, Triangle, TriangleTouch};
use crate::stroke::Stroke;
use crate::vector::{Vector, add, between, dot, length, scaled, sub};

/// The path (m) of a cell in a step, a straight line from one position to another.
pub(super) type Way = (Vector, Vector);

/// Largest depth of a node in a part, at the beginning of a step, from which it is pushed out, as a share of the part's
/// half width or of the tissue's size. Contact leaves no node at such a depth if there is space between the surfaces,
/// even in single precision.
const LEFT: f64 = 1e-4;

/// The surface that a node meets, in the frame of a part of a tool.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// A point of it (m), and its normal there.
    pub(super) point: Vector,
    pub(super) normal: Vector,
    /// Depth (m) of the surface in the part: above 0 if tissue that began the step at this depth stays there.
    pub(super) below: f64,
}

/// A tool during a step.
#[derive(Debug)]
pub(super) struct ToolStep {
    before: Pose,
    pub(super) after: Pose,
    /// The poses at the beginning and at the end of a pass.
    start: Pose,
    pub(super) now: Pose,
    /// The pose before the step before, and the length (s) of that step.
    earlier: Option<(Pose, f64)>,
    /// Steps over which contact works: 2 if velocities are staggered, else 1.
    steps_at_work: f64,
    /// The step of a tool that is a dynamic body.
    pub(super) body: Option<BodyStep>,
    pub(super) friction: f64,
    /// True if the tool grasps the tissue that it touches.
    pub(super) holds: bool,
    /// True if the motion begins with this step.
    is_first: bool,
    /// The size (m) of the tissue that it may touch, at rest.
    tissue: f64,
    /// Residual of the iteration for contacts that act on each other.
    pub(super) residual: f64,
    strokes: Vec<(Stroke, Near)>,
}

/// The tool that continues to grasp a cell in a step; `held` names the one that grasped it before.
pub(super) fn holder(steps: &[ToolStep], held: Option<&[f64; OF_HELD]>) -> Option<usize> {
    let tool = (held?[0] as usize).checked_sub(1)?;
    steps.get(tool)?.holds.then_some(tool)
}

/// Region in which nodes can meet a part.
#[derive(Clone, Copy, Debug)]
enum Near {
    /// Ways that meet a box (m).
    Box([Vector; 2]),
    /// Ways that end below a plane: by a point (m) and its normal.
    Below(Vector, Vector),
}

impl Near {
    fn of(stroke: &Stroke) -> Self {
        match stroke.bounds() {
            Some(bounds) => Self::Box(bounds),
            None => {
                let end = stroke.pose_at(1.0);
                Self::Below(end.position(), end.turned([0.0, 0.0, 1.0]))
            }
        }
    }

    fn bounds(&self) -> Option<[Vector; 2]> {
        match self {
            Self::Box(bounds) => Some(*bounds),
            Self::Below(..) => None,
        }
    }

    #[inline]
    fn is_met(&self, (from, to): Way) -> bool {
        match self {
            Self::Box([low, high]) => (0..3).all(|axis| {
                from[axis].min(to[axis]) <= high[axis] && from[axis].max(to[axis]) >= low[axis]
            }),
            Self::Below(point, normal) => dot(*normal, sub(to, *point)) < 0.0,
        }
    }
}

/// True if a path (m) may meet any of some tools, one bit each.
#[inline]
pub(super) fn is_near(steps: &[ToolStep], tools: u64, way: Way) -> bool {
    let mut steps = steps.iter().enumerate();
    steps.any(|(number, step)| {
        tools >> number & 1 == 1 && step.strokes.iter().any(|(_, near)| near.is_met(way))
    })
}

impl ToolStep {
    /// A step that has not begun yet, for tissue of a size (m).
    pub(super) fn of(tool: &Tool, tissue: f64) -> Self {
        Self {
            before: Pose::identity(),
            after: Pose::identity(),
            start: Pose::identity(),
            now: Pose::identity(),
            earlier: None,
            steps_at_work: 1.0,
            body: None,
            friction: tool.friction,
            holds: false,
            is_first: true,
            tissue,
            residual: 0.0,
            strokes: Vec::with_capacity(tool.shape.parts().len()),
        }
    }

    /// Begins a step with the poses of the path before and after it, the pose before the last step with its length
    /// (s), the stored variables of a body, the length (s) of the step, a flag for staggered velocities, and one for
    /// the first step.
    pub(super) fn begin(
        &mut self,
        tool: &Tool,
        path: [Pose; 2],
        earlier: Option<(Pose, f64)>,
        (kept, dt, is_staggered): (Option<&[f64; OF_BODY]>, f64, bool),
        is_first: bool,
    ) {
        self.is_first = is_first;
        self.residual = 0.0;
        self.earlier = earlier;
        self.steps_at_work = if is_staggered { 2.0 } else { 1.0 };
        [self.before, self.after] = path;
        if let (Some(body), Some(kept)) = (&tool.body, kept) {
            let dt_before = earlier.map_or(dt, |(_, last)| last);
            let body = BodyStep::new(body, kept, path, ([dt_before, dt], is_staggered));
            (self.before, self.after) = (body.before(), body.after());
            self.body = Some(body);
        }
        (self.start, self.now) = (self.before, self.after);
        self.stroke(tool);
    }

    /// Updates the pose of a body to that after contact, in a pass that ends at a share of the step.
    pub(super) fn follow(&mut self, tool: &Tool, share: f64) {
        if let Some(body) = &self.body {
            self.after = body.after();
            self.now = body.at(share);
            self.stroke(tool);
        }
    }

    /// Takes the pass between two shares of the step.
    pub(super) fn pass(&mut self, tool: &Tool, [from, to]: [f64; 2]) {
        let turn = self.before.turn_to(&self.after);
        let at = |share: f64| match share {
            0.0 => self.before,
            1.0 => self.after,
            _ => self.before.on_the_way(&self.after, turn, share),
        };
        (self.start, self.now) = match &self.body {
            None => (at(from), at(to)),
            Some(body) if from == 0.0 => (self.before, body.at(to)),
            Some(body) => (self.now, body.at(to)),
        };
        self.stroke(tool);
    }

    /// Upper bound of the displacement (m) of any point of the tool, planes excepted.
    pub(super) fn way(&self, tool: &Tool) -> f64 {
        let way = length(sub(self.after.position(), self.before.position()));
        let turn = length(self.before.turn_to(&self.after));
        way + turn * tool.shape.reach()
    }

    /// The boxes (m) outside of which no path meets its parts; `None` for a plane.
    pub(super) fn bounds(&self) -> impl Iterator<Item = Option<[Vector; 2]>> {
        self.strokes.iter().map(|(_, near)| near.bounds())
    }

    /// The strokes of the parts that a path (m) may meet, by their numbers.
    pub(super) fn near_strokes(&self, way: Way) -> impl Iterator<Item = (usize, &Stroke)> {
        let strokes = self.strokes.iter().enumerate();
        let near = strokes.filter(move |(_, (_, near))| near.is_met(way));
        near.map(|(part, (stroke, _))| (part, stroke))
    }

    /// Makes its strokes from the poses of the pass.
    fn stroke(&mut self, tool: &Tool) {
        let Self { start, now, .. } = *self;
        self.strokes.clear();
        let strokes = tool.shape.parts().iter().map(|part| {
            let stroke = Stroke::new(part, start, now);
            (stroke, Near::of(&stroke))
        });
        self.strokes.extend(strokes);
    }

    /// Contacts of a path (m) with the tool's parts, by their numbers.
    pub(super) fn touches(&self, way: Way) -> impl Iterator<Item = (usize, Surface)> {
        self.near_strokes(way)
            .filter_map(move |(part, stroke)| Some((part, self.touch(stroke, way)?)))
    }

    /// Contact of a path (m) with the part of a stroke.
    pub(super) fn touch(&self, stroke: &Stroke, way: Way) -> Option<Surface> {
        let Touch {
            share,
            point,
            normal,
        } = stroke.first_contact(way.0, way.1)?;
        let most = LEFT * stroke.half_width().min(self.tissue);
        Some(match share {
            0.0 => self.reached(stroke, (0.0, way.0), (point, normal), most),
            _ => Surface {
                point,
                normal,
                below: 0.0,
            },
        })
    }

    /// The constraint plane, given by a point on a part's surface and its normal, for tissue at a position (m) at a
    /// share of the pass; if the tissue was deeper in the part than `most` (m), a parallel plane at that depth. Tissue
    /// that a cut exposes within a tool, or that an iteration left there, gets no deeper: pushing it out within one
    /// step would add energy, more for shorter steps. Only initial overlaps are pushed out.
    fn reached(
        &self,
        stroke: &Stroke,
        (share, place): (f64, Vector),
        (point, normal): (Vector, Vector),
        most: f64,
    ) -> Surface {
        let depth = dot(normal, sub(point, stroke.pose_at(share).to_own(place)));
        let below = if self.is_first || depth <= most {
            0.0
        } else {
            depth
        };
        Surface {
            point: sub(point, scaled(normal, below)),
            normal,
            below,
        }
    }

    /// The largest number of pieces into which paths are divided for one of its parts.
    pub(super) fn pieces(&self) -> f64 {
        let pieces = self.strokes.iter().map(|(stroke, _)| stroke.pieces());
        f64::from(pieces.max().unwrap_or(1))
    }

    /// Contacts of a triangle with the tool's parts as it moves from `from` to `to` (m): number of the part, contact,
    /// and the depth (m) at which the triangle is left in it.
    pub(super) fn triangle_touches(
        &self,
        from: &Triangle,
        to: &Triangle,
    ) -> impl Iterator<Item = (usize, TriangleTouch, f64)> {
        let near = self.near_triangle(from, to);
        near.filter_map(move |(part, stroke)| {
            let touch = stroke.first_triangle(from, to)?;
            // One that is inside out is met where it turns, deep in the part.
            let corners = [0, 1, 2].map(|at| between(from[at], to[at], touch.share));
            let way = longest_way(from, to);
            let (touch, below) = self.reached_by_triangle(stroke, (&corners, way), touch);
            Some((part, touch, below))
        })
    }

    /// Overlaps after the step of a triangle at `corners` (m), which began the pass at `from`, with the tool's parts:
    /// number of the part, contact, and the depth (m) at which the triangle is left in it.
    pub(super) fn triangle_overlaps(
        &self,
        from: &Triangle,
        corners: &Triangle,
    ) -> impl Iterator<Item = (usize, TriangleTouch, f64)> {
        let near = self.near_triangle(corners, corners);
        near.filter_map(move |(part, stroke)| {
            let touch = stroke.triangle_at_end(corners)?;
            let way = longest_way(from, corners);
            let (touch, below) = self.reached_by_triangle(stroke, (from, way), touch);
            Some((part, touch, below))
        })
    }

    /// The same contact, with its depth (m): the depth in the part of the triangle, with its corners at the contact's
    /// share of the pass and a path (m) in it, if that is more than the depth at which the iteration may leave a
    /// triangle that moves that far in a pass; see [`Self::reached`].
    fn reached_by_triangle(
        &self,
        stroke: &Stroke,
        (corners, way): (&Triangle, f64),
        touch: TriangleTouch,
    ) -> (TriangleTouch, f64) {
        let place = corners.iter().zip(touch.weights);
        let place = place.fold([0.0; 3], |sum, (corner, weight)| {
            add(sum, scaled(*corner, weight))
        });
        let most = stroke.left_to_triangles(way);
        let surface = (touch.point, touch.normal);
        let Surface { point, below, .. } =
            self.reached(stroke, (touch.share, place), surface, most);
        (TriangleTouch { point, ..touch }, below)
    }

    /// The strokes whose boxes meet the box of a triangle's path (m), by the numbers of their parts.
    fn near_triangle(
        &self,
        from: &Triangle,
        to: &Triangle,
    ) -> impl Iterator<Item = (usize, &Stroke)> {
        let ([a, b, c], [d, e, f]) = (from, to);
        let low = [0, 1, 2].map(|x| a[x].min(b[x]).min(c[x]).min(d[x]).min(e[x]).min(f[x]));
        let high = [0, 1, 2].map(|x| a[x].max(b[x]).max(c[x]).max(d[x]).max(e[x]).max(f[x]));
        self.near_strokes((low, high))
    }

    /// The velocity (m/s) of the tool at a position (m) after the step, for the work of contact: in staggered steps the
    /// mean of this step's and the last one's, which conserves the energy of the step.
    pub(super) fn velocity(&self, place: Vector, dt: f64) -> Vector {
        if let Some(body) = &self.body {
            return body.working_velocity(sub(place, self.now.position()));
        }
        let own = self.now.to_own(place);
        let middle = self.before.to_world(own);
        let now = scaled(sub(self.after.to_world(own), middle), 1.0 / dt);
        match &self.earlier {
            Some((earlier, last)) => {
                let before = scaled(sub(middle, earlier.to_world(own)), 1.0 / last);
                scaled(add(now, before), 0.5)
            }
            None => now,
        }
    }

    /// Displacement (m) of the tool along which friction does work, in a step of `dt` (s), at a position (m) after the
    /// step and without the displacement of a dynamic body due to contact. In staggered steps the displacement in the
    /// step before is added.
    pub(super) fn swing(&self, place: Vector, dt: f64) -> Vector {
        match &self.body {
            Some(body) => body.swing(sub(place, self.now.position())),
            None => scaled(self.velocity(place, dt), self.steps_at_work * dt),
        }
    }
}

/// The longest path (m) of a corner of a triangle.
fn longest_way(from: &Triangle, to: &Triangle) -> f64 {
    let ways = from
        .iter()
        .zip(to)
        .map(|(from, to)| length(sub(*to, *from)));
    ways.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Motion;
    use crate::shape::{Convex, Shape};

    /// A step of a tool at rest, for tissue of 0.6 m.
    fn step(convex: Convex, is_first: bool) -> ToolStep {
        let tool = Tool {
            name: "tool".into(),
            shape: Shape::of(convex),
            motion: Motion::Held(Pose::identity()),
            friction: 0.0,
            cells: Vec::new(),
            grasp: None,
            body: None,
            triangles: Vec::new(),
        };
        let mut step = ToolStep::of(&tool, 0.6);
        let path = [Pose::identity(); 2];
        step.begin(&tool, path, None, (None, 1e-3, true), is_first);
        step
    }

    /// Distances (m) from the centre of a ball of 10 mm at which it leaves a node, and the centroid of a triangle,
    /// which a step moves from one height above the centre to another.
    fn left_at(is_first: bool, from: f64, to: f64) -> [Option<f64>; 2] {
        let step = step(Convex::Sphere { radius: 0.01 }, is_first);
        let node = step.touches(([0.0, 0.0, from], [0.0, 0.0, to])).next();
        // Tissue above, its surface towards the ball.
        let triangle = |z: f64| [[0.0, 0.3, z], [0.3, -0.3, z], [-0.3, -0.3, z]];
        let (from, to) = (triangle(from), triangle(to));
        let triangle = step.triangle_touches(&from, &to).next();
        [
            node.map(|(_, touch)| length(touch.point)),
            triangle.map(|(_, touch, _)| length(touch.point)),
        ]
    }

    #[test]
    fn what_is_deep_in_a_tool_as_a_step_begins_gets_no_deeper_and_is_pushed_out_in_the_first_one_alone()
     {
        let [surface, deep] = [0.01, 0.006];
        for (is_first, from, expected) in [
            (true, deep, [surface; 2]),
            (false, deep, [deep; 2]),
            (false, surface - 1e-7, [surface; 2]),
            // Rounds leave triangles a tenth deep.
            (false, 0.009, [0.009, surface]),
            (false, 0.012, [surface; 2]),
        ] {
            let found = left_at(is_first, from, 0.004);
            for (found, expected) in found.into_iter().zip(expected) {
                let off = found.unwrap() - expected;
                assert!(off.abs() < 1e-15, "{is_first} {from}: {found:?}");
            }
        }
        assert_eq!(left_at(false, 0.012, 0.011), [None; 2]);
    }

    #[test]
    fn planes_and_thick_boxes_throw_nothing_out_either() {
        let thick = Convex::Cuboid {
            size: [100.0, 100.0, 100.0],
        };
        for (convex, surface) in [(Convex::Plane, 0.0), (thick, 50.0)] {
            for (is_first, depth, left) in [
                (true, 0.012, 0.0),
                (false, 0.012, 0.012),
                (false, 1e-5, 0.0),
            ] {
                let from = [0.0, 0.0, surface - depth];
                let way = (from, [0.0, 0.0, surface - 0.02]);
                let (_, touch) = step(convex, is_first).touches(way).next().unwrap();
                let off = touch.point[2] - (surface - left);
                assert!(off.abs() < 1e-13, "{convex:?} {is_first} {depth}: {off}");
            }
        }
    }
}

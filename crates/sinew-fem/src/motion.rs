//! The prescribed motion of supports.

use sinew_core::{LoadTime, Ramp};
use sinew_mesh::TetMesh;

use crate::cells::supported;
use crate::error::{Cause, FemError, Item};
use crate::number::require_finite;
use crate::{Course, Moving, Problem};

/// Prescribed motions, in the order of [`Problem::moves`], and frozen nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Motions {
    parts: Vec<MovedPart>,
    /// The nodes that are moved, increasing, with the part that moves each component.
    nodes: Vec<(u32, [Option<u32>; 3])>,
    /// Frozen nodes, increasing, with a constant course along each axis. All nodes of their pieces are frozen, so
    /// that they exert no force on nodes that move.
    frozen: Vec<(u32, [Course; 3])>,
}

/// The nodes that share one motion.
#[derive(Clone, Debug)]
pub(crate) struct MovedPart {
    /// Nodes (0-based), increasing.
    pub(crate) nodes: Vec<u32>,
    pub(crate) courses: Vec<Course>,
    /// The rate of each course's ramp.
    rates: Vec<Ramp>,
}

/// Order of the time derivative of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Field {
    /// Displacement (m).
    Displacement,
    /// Velocity (m/s).
    Velocity,
    /// Acceleration (m/s^2).
    Acceleration,
}

/// Number of parts whose motions need no heap memory: a frame that evaluates them allocates nothing.
const FEW: usize = 8;

/// A field of all parts at an instant: of the first few, and of the others.
pub(crate) struct MotionsAt {
    few: [[f64; 3]; FEW],
    others: Vec<[f64; 3]>,
    field: Field,
}

impl MotionsAt {
    fn of(&self, part: u32) -> Option<&[f64; 3]> {
        let (part, Self { few, others, .. }) = (part as usize, self);
        few.get(part).or_else(|| others.get(part - FEW))
    }
}

impl Motions {
    /// Finds the nodes that are moved.
    pub(crate) fn new(mesh: &TetMesh, problem: &Problem) -> Result<Self, FemError> {
        if problem.moves.is_empty() {
            return Ok(Self::default());
        }
        let held = supported(mesh, &problem.fixed)?;
        let mut by = vec![[None; 3]; mesh.points.len()];
        let mut parts = Vec::new();
        for (index, Moving { on, axes, courses }) in (0_u32..).zip(&problem.moves) {
            let item = Item::Move(index as usize);
            let nodes = on.nodes(mesh).map_err(FemError::at(item))?;
            for &node in &nodes {
                let at = node as usize;
                let tag = mesh.node_tags.get(at).copied();
                let tag = tag.unwrap_or(u64::from(node) + 1);
                for axis in (0..3).filter(|axis| axes[*axis]) {
                    if held[at][axis] {
                        return Err(FemError::new(item, Cause::MovedAndHeld { tag, axis }));
                    }
                    if let Some(first) = by[at][axis].replace(index) {
                        let first = first as usize + 1;
                        return Err(FemError::new(item, Cause::MovedTwice { tag, axis, first }));
                    }
                }
            }
            parts.push(MovedPart {
                nodes,
                courses: courses.clone(),
                rates: courses.iter().map(|course| course.ramp.rate()).collect(),
            });
        }
        let nodes = (0..).zip(by).filter(|(_, by)| *by != [None; 3]);
        Ok(Self {
            parts,
            nodes: nodes.collect(),
            frozen: Vec::new(),
        })
    }

    /// The same, with nodes, increasing, frozen at these displacements (m): each piece of the body as a whole, or not
    /// at all.
    pub(crate) fn with_frozen(mut self, frozen: &[(u32, [f64; 3])]) -> Self {
        let held = |(node, displacement): &(u32, [f64; 3])| {
            let along = |axis: usize| Course {
                displacement: std::array::from_fn(
                    |i| if i == axis { displacement[i] } else { 0.0 },
                ),
                ramp: Ramp::Step,
            };
            (*node, [0, 1, 2].map(along))
        };
        self.frozen = frozen.iter().map(held).collect();
        self
    }

    /// True if a node is frozen.
    pub(crate) fn is_frozen(&self, node: u32) -> bool {
        self.frozen(node).is_some()
    }

    /// The courses of a component of a node; none if it is fixed at rest or free.
    pub(crate) fn courses(&self, node: u32, axis: usize) -> &[Course] {
        if let Some(part) = self.part_of(node, axis) {
            return self.parts.get(part).map_or(&[], |part| &part.courses);
        }
        let frozen = self.frozen(node).and_then(|courses| courses.get(axis));
        frozen.map_or(&[], std::slice::from_ref)
    }

    fn frozen(&self, node: u32) -> Option<&[Course; 3]> {
        let place = self.frozen.binary_search_by_key(&node, |(node, _)| *node);
        Some(&self.frozen.get(place.ok()?)?.1)
    }

    /// The nodes that are moved or frozen.
    pub(crate) fn moved(&self) -> impl Iterator<Item = u32> {
        let moved = self.nodes.iter().map(|(node, _)| *node);
        moved.chain(self.frozen.iter().map(|(node, _)| *node))
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    pub(crate) fn parts(&self) -> &[MovedPart] {
        &self.parts
    }

    /// The part that moves a component of a node.
    pub(crate) fn part_of(&self, node: u32, axis: usize) -> Option<usize> {
        let at = self.nodes.binary_search_by_key(&node, |(node, _)| *node);
        let (_, by) = self.nodes.get(at.ok()?)?;
        Some(by[axis]? as usize)
    }

    /// A field of all motions at the time of a step: displacements at the instant, velocities as loads are taken, and
    /// accelerations with the kinks inside the window. Allocates nothing for a few motions.
    pub(crate) fn at(&self, when: LoadTime<'_>, field: Field) -> MotionsAt {
        let mut parts = self.parts.iter().map(|part| part.at(when, field));
        MotionsAt {
            few: std::array::from_fn(|_| parts.next().unwrap_or_default()),
            others: parts.collect(),
            field,
        }
    }

    /// The ramps of all courses.
    pub(crate) fn ramps(&self) -> impl Iterator<Item = &Ramp> {
        let courses = self.parts.iter().flat_map(|part| &part.courses);
        courses.map(|course| &course.ramp)
    }

    /// The field at a node; 0 in components that are not moved.
    pub(crate) fn at_node(&self, at: &MotionsAt, node: u32) -> [f64; 3] {
        if self.nodes.is_empty() && self.frozen.is_empty() {
            return [0.0; 3];
        }
        match self.nodes.binary_search_by_key(&node, |(node, _)| *node) {
            Err(_) => match self.frozen(node) {
                Some(courses) if at.field == Field::Displacement => {
                    std::array::from_fn(|axis| courses[axis].displacement[axis])
                }
                _ => [0.0; 3],
            },
            Ok(found) => std::array::from_fn(|axis| {
                let part = self.nodes[found].1[axis];
                let motion = part.and_then(|part| at.of(part));
                motion.map_or(0.0, |motion| motion[axis])
            }),
        }
    }
}

impl MovedPart {
    fn at(&self, when: LoadTime<'_>, field: Field) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for (Course { displacement, ramp }, rate) in self.courses.iter().zip(&self.rates) {
            let known = ramp.known(when.inputs());
            let factor = match field {
                Field::Displacement => known.place(when),
                Field::Velocity => rate.factor(when),
                Field::Acceleration => known.bend(when),
            };
            for (sum, displacement) in sums.iter_mut().zip(displacement) {
                *sum += displacement * factor;
            }
        }
        sums
    }

    /// The first instant (s) at which the position jumps.
    pub(crate) fn first_jump(&self) -> Option<f64> {
        let moving = self.courses.iter().filter(|course| !course.is_rest());
        let jumps = moving.filter_map(|course| course.ramp.first_jump());
        jumps.reduce(f64::min)
    }

    /// The displacement of each of its nodes at factor 1 of a course.
    pub(crate) fn pattern(&self, course: &Course) -> Vec<(u32, [f64; 3])> {
        let at = |node: &u32| (*node, course.displacement);
        self.nodes.iter().map(at).collect()
    }
}

impl Course {
    /// A displacement from rest (m) at factor 1, and the factor over time.
    #[must_use]
    pub fn new(displacement: [f64; 3], ramp: Ramp) -> Self {
        Self { displacement, ramp }
    }

    /// Motion at constant velocity (m/s) from t = 0 on.
    #[must_use]
    pub fn at_velocity(velocity: [f64; 3]) -> Self {
        Self {
            displacement: velocity,
            ramp: Ramp::Linear,
        }
    }

    /// Straight lines between positions relative to rest (m) at given times (s), constant before the first and after
    /// the last: a course for each axis.
    #[must_use]
    pub fn along(times: &[f64], positions: &[[f64; 3]]) -> Vec<Self> {
        let along = |axis: usize| Self {
            displacement: std::array::from_fn(|i| f64::from(u8::from(i == axis))),
            ramp: Ramp::Table {
                times: times.to_vec(),
                values: positions.iter().map(|position| position[axis]).collect(),
            },
        };
        let moves = |axis: &usize| positions.iter().any(|position| position[*axis] != 0.0);
        (0..3).filter(moves).map(along).collect()
    }

    /// The displacement (m) along an axis (0, 1, 2 for x, y, z) at a time (s); `None` if the course follows an input
    /// that the time does not contain.
    #[must_use]
    pub fn displacement_at<'a>(&self, when: impl Into<LoadTime<'a>>, axis: usize) -> Option<f64> {
        let when = when.into();
        if self.ramp.missing_input(when.inputs()).is_some() {
            return None;
        }
        let along = self.displacement.get(axis).copied().unwrap_or(0.0);
        Some(along * self.ramp.known(when.inputs()).value(when.t()))
    }

    /// True if the course moves nothing.
    pub(crate) fn is_rest(&self) -> bool {
        self.displacement == [0.0; 3]
    }
}

/// Refuses a motion with a number outside its range.
pub(crate) fn check(index: usize, moving: &Moving) -> Result<(), FemError> {
    let item = Item::Move(index);
    for Course { displacement, ramp } in &moving.courses {
        require_finite(item, "displacement", displacement)?;
        ramp.check().map_err(FemError::at(item))?;
        let unnamed = |axis: &usize| !moving.axes[*axis] && displacement[*axis] != 0.0;
        if let Some(axis) = (0..3).find(unnamed) {
            let found = displacement[axis];
            return Err(FemError::new(item, Cause::UnnamedAxis { axis, found }));
        }
    }
    Ok(())
}

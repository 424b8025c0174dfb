//! Contact between cut faces, which do not pass through each other.
//!
//! A cut splits a node into two. As long as their faces still face each other, neither may pass the other along the
//! mean normal of the faces around them: a unilateral constraint between two nodes, whose compliance is the sum of
//! those of the nodes. There is no friction, and opposite forces push the two nodes.

use super::node::{Compliance, HELD};
use super::tool::Corner;
use crate::vector::{Vector, add, cross, dot, length, scaled, sub};

/// Cosine of the angle between a cut face's normal and the mean of both, below which the two no longer face each other.
const FACING: f64 = 0.5;

/// The two faces that a cut made from one face; they coincide at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutFace {
    /// The corners of each: those of the first face counter-clockwise as seen from outside its tissue, those of the
    /// second in the same order.
    pub corners: [[Corner; 3]; 2],
}

/// Two nodes that a cut made from one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pair {
    /// The first and the second node.
    pub(super) nodes: [Corner; 2],
    /// The faces around them, by index, each with a flag: true if the first node belongs to its first face.
    faces: Vec<(u32, bool)>,
    /// Largest offset (m) along the faces at which the two nodes still act on each other: the longest edge of these
    /// faces at rest.
    reach: f64,
}

/// Cut faces, and the pairs of nodes at them.
#[derive(Clone, Debug, Default)]
pub(super) struct Lips {
    faces: Vec<CutFace>,
    pub(super) pairs: Vec<Pair>,
}

/// A pair in contact in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct LipLink {
    /// Its index among the pairs.
    pub(super) pair: u32,
    /// Indices of both nodes among the touched cells; `None` for a fixed one.
    pub(super) nodes: [Option<u32>; 2],
    compliances: [Compliance; 2],
    /// The unit normal, from the first to the second node.
    normal: Vector,
    /// The least distance (m) along the normal that contact allows.
    floor: f64,
    /// The contact-free distance (m) along the normal at the end of the step.
    gap: f64,
    /// Closing of that distance per unit force (m/N).
    response: f64,
    /// The force (N) that pushes them apart.
    pub(super) force: f64,
}

impl Lips {
    /// The pairs of nodes of cut faces, on touched cells with these positions (m) at rest.
    pub(super) fn of(faces: Vec<CutFace>, rest: impl Fn(u32) -> Vector) -> Self {
        let at = |corner: Corner| corner.at(&rest);
        let mut ends = Vec::new();
        for (face, CutFace { corners }) in (0..).zip(&faces) {
            let [first, second] = corners;
            let [a, b, c] = first.map(at);
            let reach = [sub(b, a), sub(c, b), sub(a, c)].map(length);
            let reach = reach.into_iter().fold(0.0, f64::max);
            for (one, other) in first.iter().zip(second) {
                match (*one, *other) {
                    (Corner::Cell(one), Corner::Cell(other)) if one != other => {
                        let key = (one.min(other), Some(one.max(other)));
                        ends.push((key, face, one < other, reach));
                    }
                    (Corner::Cell(one), Corner::Held(_)) => {
                        ends.push(((one, None), face, true, reach));
                    }
                    (Corner::Held(_), Corner::Cell(other)) => {
                        ends.push(((other, None), face, false, reach));
                    }
                    _ => {}
                }
            }
        }
        ends.sort_by_key(|(key, face, ..)| (*key, *face));
        let mut pairs: Vec<Pair> = Vec::new();
        let mut last = None;
        for (key, face, is_first, reach) in ends {
            if last.replace(key) != Some(key) {
                let (one, other) = key;
                // The other rests at the same place, and is held there.
                let other = other.map_or_else(|| Corner::Held(rest(one)), Corner::Cell);
                pairs.push(Pair {
                    nodes: [Corner::Cell(one), other],
                    faces: Vec::new(),
                    reach: 0.0,
                });
            }
            if let Some(pair) = pairs.last_mut() {
                pair.faces.push((face, is_first));
                pair.reach = pair.reach.max(reach);
            }
        }
        Self { faces, pairs }
    }

    /// Number of cut faces.
    pub(super) fn faces(&self) -> usize {
        self.faces.len()
    }

    /// The normals of both sides of each face, times twice its area (m^2), with the corners at these positions (m);
    /// they point outwards from the tissue of the first side.
    pub(super) fn find_normals(
        &self,
        at: impl Fn(Corner) -> Vector,
        normals: &mut Vec<[Vector; 2]>,
    ) {
        normals.clear();
        normals.extend(self.faces.iter().map(|face| {
            face.corners.map(|corners| {
                let [a, b, c] = corners.map(&at);
                cross(sub(b, a), sub(c, a))
            })
        }));
    }

    /// The contact of a pair that closes along the paths (m) of its nodes in spite of contact displacements so far.
    /// `earlier` is the vector (m) from the first to the second node at the beginning of the step before.
    pub(super) fn meet(
        &self,
        pair: u32,
        normals: &[[Vector; 2]],
        (earlier, [from, stood, end]): (Vector, [[Vector; 2]; 3]),
        compliance: impl Fn(u32) -> Compliance,
    ) -> Option<LipLink> {
        let Pair {
            nodes,
            faces,
            reach,
        } = &self.pairs[pair as usize];
        let mut sides = [[0.0; 3]; 2];
        for (face, is_first) in faces {
            let sign = if *is_first { 1.0 } else { -1.0 };
            let [first, second] = normals[*face as usize];
            let (own, others) = if *is_first {
                (first, second)
            } else {
                (second, first)
            };
            sides[0] = add(sides[0], scaled(own, sign));
            sides[1] = add(sides[1], scaled(others, sign));
        }
        let mean = add(sides[0], sides[1]);
        let size = length(mean);
        if size == 0.0 {
            return None;
        }
        let normal = scaled(mean, 1.0 / size);
        let faces_it = |side: Vector| dot(side, normal) > FACING * length(side);
        let apart = sub(from[1], from[0]);
        let before = dot(apart, normal);
        let aside = length(sub(apart, scaled(normal, before)));
        if !sides.into_iter().all(faces_it) || aside > *reach {
            return None;
        }
        // Contact works at the mean of the velocities of two steps, by what closes since the first began: it brings in no energy where it leaves nodes as far apart as they
        // were at either beginning, or at rest. What overlaps already, as its normal has turned, may not overlap more.
        let floor = before.min(dot(earlier, normal)).min(0.0);
        let distance = |of: [Vector; 2]| dot(sub(of[1], of[0]), normal);
        if distance(end) >= floor {
            return None;
        }
        let nodes = nodes.map(Corner::place);
        let compliances = nodes.map(|node| node.map_or_else(Compliance::default, &compliance));
        let response = compliances.map(|of| dot(normal, of.displacement(normal)));
        let largest = compliances.iter().map(Compliance::largest);
        let response = response[0] + response[1];
        (response > HELD * largest.fold(0.0, f64::max)).then(|| LipLink {
            pair,
            nodes,
            compliances,
            normal,
            floor,
            gap: distance(stood),
            response,
            force: 0.0,
        })
    }
}

impl LipLink {
    /// Updates the force of the pair for the given forces of the others, and moves its nodes by the change; returns the
    /// change (m) of their distance.
    pub(super) fn update(&mut self, moved: &mut [Vector]) -> f64 {
        let by = |node: Option<u32>| node.map_or([0.0; 3], |place| moved[place as usize]);
        let pushed = sub(by(self.nodes[1]), by(self.nodes[0]));
        let left = self.gap + dot(pushed, self.normal) - self.floor;
        let force = (self.force - left / self.response).max(0.0);
        let change = force - self.force;
        self.force = force;
        if change != 0.0 {
            for (node, sign) in self.nodes.iter().zip([-1.0, 1.0]) {
                if let Some(place) = node {
                    let compliance = self.compliances[usize::from(sign > 0.0)];
                    let by = compliance.displacement(scaled(self.normal, sign * change));
                    let moved = &mut moved[*place as usize];
                    *moved = add(*moved, by);
                }
            }
        }
        (change * self.response).abs()
    }

    /// Distance (m) by which the force moves the two nodes apart.
    pub(super) fn push(&self) -> f64 {
        self.force * self.response
    }

    /// The nodes that move, with the force (N) on each.
    pub(super) fn forces(&self) -> impl Iterator<Item = (u32, Vector)> + '_ {
        let signed = self.nodes.iter().zip([-1.0, 1.0]);
        signed.filter_map(|(node, sign)| Some(((*node)?, scaled(self.normal, sign * self.force))))
    }
}

//! Tissue that the user pulls without a tool.

use std::sync::Arc;

use sinew_mesh::TetMesh;
use sinew_mesh::vector::{length, sub};
use sinew_scene::BodyModel;
use sinew_world::{CommandError, Trial, World};

use super::course::{Course, Limits};
use super::places::place_of;

/// Simulated time (s) for which a force stays constant.
pub(super) const HELD: f64 = 0.004;

/// Largest number of nodes of a patch.
const MOST_NODES: usize = 16;

/// Radius of a patch over the mean edge of the surface at its middle.
const RADIUS: f64 = 1.5;

/// Share of the stiffness beyond which a spring that knows its length only every few milliseconds is unstable.
const STABLE: f64 = 0.2;

/// Force of a trial over that which strains the tissue by about 1.
const TRIAL: f64 = 1e-3;

/// The time (s) by which a force follows the tissue late; `None` in steps (s) that are as long as a force stays constant,
/// where a trial tells the place at their end.
pub(super) fn late_in(dt: f64) -> Option<f64> {
    (dt < HELD).then_some(HELD)
}

/// A spring from the tissue to the user's hand.
#[derive(Clone, Debug)]
pub(crate) struct Grip {
    /// Number that no earlier grip had.
    number: u64,
    /// The client that grips.
    pub(super) client: u32,
    /// The node in the middle, by its number in the body with its copies, and in the uncut mesh.
    node: u32,
    origin: u32,
    /// Stiffness (N/m).
    stiffness: f64,
    /// The path of the hand.
    course: Course,
}

impl Grip {
    /// A grip at a node of a body, with a number and its client.
    pub(super) fn at((number, client): (u64, u32), body: &BodyModel, node: u32) -> Self {
        Self {
            number,
            client,
            node: body.number_in_body(node),
            origin: origin(body, node),
            stiffness: f64::INFINITY,
            course: Course::at_rest(0.0, [0.0; 6]),
        }
    }

    /// The same, at this place (m) at a time (s).
    pub(super) fn placed_at(mut self, t: f64, [x, y, z]: [f64; 3]) -> Self {
        self.course = Course::at_rest(t, [x, y, z, 0.0, 0.0, 0.0]);
        self
    }

    /// Makes the spring no stiffer than this (N/m).
    pub(super) fn soften(&mut self, most: f64) {
        self.stiffness = self.stiffness.min(most);
    }

    /// Moves the hand to a place (m) from a time (s) on.
    pub(super) fn pull(&mut self, t: f64, [x, y, z]: [f64; 3], limits: Limits) {
        self.course.go(t, [x, y, z, 0.0, 0.0, 0.0], limits);
    }

    pub(super) fn forget_before(&mut self, t: f64) {
        self.course.forget_before(t);
    }

    /// The force (N) that the spring has at the end of a step, at a time (s), if the tissue would be at a place (m) then
    /// without it and moves by a way (m/N) along each axis for each newton: a spring by the backward Euler method, which
    /// is stable with any stiffness.
    pub(super) fn force_at_end(&self, t: f64, free: [f64; 3], compliance: [f64; 3]) -> [f64; 3] {
        let force = self.force(t, free, f64::INFINITY);
        [0, 1, 2].map(|axis| force[axis] / (1.0 + self.stiffness * compliance[axis]))
    }

    /// The force (N) on tissue at a place (m), at a time (s), of a spring that is no stiffer than this (N/m).
    pub(super) fn force(&self, t: f64, place: [f64; 3], most: f64) -> [f64; 3] {
        let (hand, stiffness) = (self.course.at(t), self.stiffness.min(most));
        [0, 1, 2].map(|axis| stiffness * (hand[axis] - place[axis]))
    }
}

/// The nodes of a body that a grip holds.
pub(super) struct Patch {
    number: u64,
    mesh: Arc<TetMesh>,
    /// Nodes with their shares of the force, which add up to 1.
    pub(super) shares: Vec<(u32, f64)>,
    radius: f64,
}

impl Patch {
    /// The patch of a grip on a body; it has no nodes where its middle is fixed, or was removed.
    pub(super) fn of(grip: &Grip, body: &BodyModel) -> Self {
        let (shares, radius) = shares_of(grip, body).unwrap_or_default();
        Self {
            number: grip.number,
            mesh: Arc::clone(&body.mesh),
            shares,
            radius,
        }
    }

    pub(super) fn has_nodes(&self) -> bool {
        !self.shares.is_empty()
    }

    /// True if it is that of a grip on a body.
    pub(super) fn is_of(&self, grip: &Grip, body: &BodyModel) -> bool {
        self.number == grip.number && Arc::ptr_eq(&self.mesh, &body.mesh)
    }

    /// Its mean place (m) with these displacements (m) of the degrees of freedom.
    pub(super) fn place(&self, body: &BodyModel, u: &[f64]) -> [f64; 3] {
        let mut mean = [0.0; 3];
        for (node, share) in &self.shares {
            let place = place_of(body, u, *node);
            for axis in 0..3 {
                mean[axis] += share * place[axis];
            }
        }
        mean
    }

    /// A force (N) on it as forces on its nodes.
    pub(super) fn forces(&self, force: [f64; 3]) -> Vec<(u32, [f64; 3])> {
        let shares = self.shares.iter();
        let forces = shares.map(|(node, share)| (*node, force.map(|force| share * force)));
        forces.collect()
    }

    /// The way (m) along each axis by which each newton moves it within the next step.
    pub(super) fn compliance(
        &self,
        session: &World,
        trial: &mut Trial,
    ) -> Result<[f64; 3], CommandError> {
        let Some(body) = session.body().model().body() else {
            return Ok([0.0; 3]);
        };
        let force = TRIAL * self.modulus(body) * self.radius * self.radius;
        let free = self.place(body, &trial.next(session, &[])?.u);
        let mut compliance = [0.0; 3];
        for axis in 0..3 {
            let mut along = [0.0; 3];
            along[axis] = force;
            let moved = self.place(body, &trial.next(session, &self.forces(along))?.u);
            compliance[axis] = ((moved[axis] - free[axis]) / force).max(0.0);
        }
        Ok(compliance)
    }

    /// The stiffness (N/m) of a spring for it: about that of the tissue under a stamp of its size and, if its force
    /// follows the tissue late, by this time (s), one with which it is stable.
    pub(super) fn stiffness(&self, body: &BodyModel, late: Option<f64>) -> f64 {
        let masses = body.model.node_masses();
        let inverse: f64 = (self.shares.iter())
            .map(|(node, share)| share * share / masses[*node as usize])
            .sum();
        let most = late.map_or(f64::INFINITY, |time| STABLE * 4.0 / (inverse * time * time));
        (2.0 * self.modulus(body) * self.radius).min(most)
    }

    /// The least of Young's moduli (Pa) of the tetrahedra at it.
    fn modulus(&self, body: &BodyModel) -> f64 {
        let is_beside = |(_, nodes): &(usize, &[u32; 4])| {
            self.shares.iter().any(|(node, _)| nodes.contains(node))
        };
        let beside = body.mesh.tets.iter().enumerate().filter(is_beside);
        let moduli = beside.map(|(tet, _)| {
            let region = body.model.region_of()[tet] as usize;
            body.problem.regions[region].law.youngs_modulus()
        });
        moduli.fold(f64::INFINITY, f64::min)
    }
}

/// The nodes around the middle of a grip with their shares, and the radius (m) of the patch; `None` where the middle is
/// fixed, or was removed.
fn shares_of(grip: &Grip, body: &BodyModel) -> Option<(Vec<(u32, f64)>, f64)> {
    let mesh = &body.mesh;
    let nodes = 0..mesh.points.len() as u32;
    let mut same = nodes.filter(|node| origin(body, *node) == grip.origin);
    let first = same.clone().next();
    let middle = same
        .find(|node| body.number_in_body(*node) == grip.node)
        .or(first)?;
    body.model.cell_of_node(middle)?;
    let triangles: Vec<[u32; 3]> = body.surface_triangles().collect();
    let away = |node: u32| {
        length(sub(
            mesh.points[node as usize],
            mesh.points[middle as usize],
        ))
    };
    let beside = triangles
        .iter()
        .filter(|triangle| triangle.contains(&middle))
        .flatten();
    let (sum, count) = beside
        .filter(|node| **node != middle)
        .fold((0.0, 0), |(sum, count), node| {
            (sum + away(*node), count + 1)
        });
    let radius = RADIUS * sum / f64::from(count.max(1));
    // Over the surface, so that it stays on one side of a cut.
    let mut found = vec![middle];
    let mut seen = 0;
    while seen < found.len() {
        let node = found[seen];
        seen += 1;
        for corner in triangles
            .iter()
            .filter(|triangle| triangle.contains(&node))
            .flatten()
        {
            if away(*corner) < radius && !found.contains(corner) {
                found.push(*corner);
            }
        }
    }
    found.retain(|node| body.model.cell_of_node(*node).is_some());
    found.sort_by(|a, b| away(*a).total_cmp(&away(*b)));
    found.truncate(MOST_NODES);
    let weight = |node: u32| 1.0 - 0.9 * (away(node) / radius).powi(2);
    let all: f64 = found.iter().map(|node| weight(*node)).sum();
    let shares: Vec<(u32, f64)> = found
        .iter()
        .map(|node| (*node, weight(*node) / all))
        .collect();
    Some((shares, radius))
}

/// Number of a node of a mesh, or of the node that it is a copy of, in the uncut mesh.
fn origin(body: &BodyModel, node: u32) -> u32 {
    let cut = body.cut.as_ref();
    cut.map_or(node, |from| from.cut.origins[node as usize])
}

//! The error of a mesh and its element, without any error in time.

use sinew_verify::LabError;
use std::collections::HashMap;
use std::path::Path;

use sinew_core::{Integrator, Moment, Run, Verdict, simulate};
use sinew_integrators::Method;
use sinew_integrators::explicit::{CentralDifference, Rk4};
use sinew_measure::Case;
use sinew_measure::reference::ErrorNorm;
use sinew_scene::{Scene, Simulation};

use super::case::FinerMeshes;

/// Steps over the stable step of undamped leapfrog at rest on finer meshes, for the methods of order 4 and 2: errors in
/// time are then far below those in space.
const SHARE: f64 = 1.0 / 3.0;
const SHARE_OF_ORDER_2: f64 = 0.6;

/// A scene's motion without errors of the mesh, at the nodes of its own mesh.
pub(super) struct MeshReference {
    /// The positions of the nodes, in integer units that distinguish them.
    nodes: Vec<[i64; 3]>,
    /// Displacements (m) of all nodes at each instant.
    motion: Vec<Vec<f64>>,
    /// Relative L2 difference from the motion on the finest mesh.
    pub(super) error: f64,
}

impl MeshReference {
    /// The scene with these values on two finer meshes with the element that does not lock, extrapolated to zero cell
    /// size on the assumption that errors fall with the square of the edge.
    pub(super) fn new(
        scene: &Path,
        values: &[String],
        own: &Case,
        finer: FinerMeshes,
    ) -> Result<Self, LabError> {
        let nodes = places(own.simulation())?;
        let motion = |mesh: &str| {
            let mut values = values.to_vec();
            values.extend([mesh, "region.1.element=fbar-edge"].map(str::to_owned));
            let simulation = Scene::load_with(scene, &values)?.build()?;
            follow(&simulation, own.span().samples, &nodes, finer.is_violent)
        };
        let [coarse, fine] = finer.meshes.map(motion);
        let (coarse, fine) = (coarse?, fine?);
        let share = (finer.ratio * finer.ratio - 1.0).recip();
        let pairs = coarse.iter().zip(&fine);
        let motion: Vec<Vec<f64>> = pairs
            .map(|(coarse, fine)| {
                let pairs = coarse.iter().zip(fine);
                pairs.map(|(c, f)| f + share * (f - c)).collect()
            })
            .collect();
        Ok(Self {
            nodes,
            error: ErrorNorm::between(&fine, &motion),
            motion,
        })
    }

    /// The relative L2 error of a case's reference, which has no error in time, over all nodes and instants.
    pub(super) fn error_of(&self, case: &Case) -> Result<f64, LabError> {
        let seen = case.samples().displacements.iter();
        let seen: Result<Vec<_>, _> = seen
            .map(|u| at_nodes(case.simulation(), u, &self.nodes))
            .collect();
        Ok(ErrorNorm::between(&seen?, &self.motion))
    }
}

/// Positions in units of a ten-millionth of a metre.
fn place(point: [f64; 3]) -> [i64; 3] {
    point.map(|x| (1e7 * x).round() as i64)
}

fn places(simulation: &Simulation) -> Result<Vec<[i64; 3]>, LabError> {
    let body = simulation.model().body().ok_or_else(LabError::no_body)?;
    Ok(body.mesh.points.iter().copied().map(place).collect())
}

/// Displacements (m) of nodes at these positions; fixed ones do not move, or move with their support.
fn at_nodes(simulation: &Simulation, u: &[f64], nodes: &[[i64; 3]]) -> Result<Vec<f64>, LabError> {
    let body = simulation.model().body().ok_or_else(LabError::no_body)?;
    let found: HashMap<[i64; 3], u32> = (0..)
        .zip(&body.mesh.points)
        .map(|(node, point)| (place(*point), node))
        .collect();
    let mut out = Vec::with_capacity(3 * nodes.len());
    for at in nodes {
        let node = *found
            .get(at)
            .ok_or_else(|| LabError::new("a finer mesh lacks a node of the scene's mesh"))?;
        match body.model.cell_of_node(node) {
            Some(cell) => out.extend_from_slice(&u[3 * cell as usize..][..3]),
            None => out.extend([0.0; 3]),
        }
    }
    Ok(out)
}

/// The displacements (m) of nodes at the instants of a scene.
fn follow(
    simulation: &Simulation,
    samples: usize,
    nodes: &[[i64; 3]],
    is_violent: bool,
) -> Result<Vec<Vec<f64>>, LabError> {
    let (mut integrator, share): (Box<dyn Integrator>, f64) = match is_violent {
        true => (Rk4.integrator(), SHARE),
        false => (CentralDifference.integrator(), SHARE_OF_ORDER_2),
    };
    let system = simulation.system();
    let interval = simulation.settings().duration / samples as f64;
    let critical = system.spectrum(None);
    let critical = critical.map_or(interval, |spectrum| spectrum.critical_step());
    let parts = (interval / (share * critical)).ceil().max(1.0) as usize;
    let run = Run {
        dt: interval / parts as f64,
        steps: samples * parts,
        divergence_limit: f64::INFINITY,
    };
    let mut state = simulation.initial_state().clone();
    let mut seen = Vec::with_capacity(samples + 1);
    let mut failed = None;
    let mut keep = |moment: &Moment<'_>| {
        if moment.step.is_multiple_of(parts) {
            match at_nodes(simulation, &moment.state.u, nodes) {
                Ok(u) => seen.push(u),
                Err(error) => failed = Some(error),
            }
        }
        Ok(Verdict::Continue)
    };
    simulate(system, &mut *integrator, &mut state, &run, &mut keep)?;
    match failed {
        Some(error) => Err(error),
        None => Ok(seen),
    }
}

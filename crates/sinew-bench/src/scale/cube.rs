//! The peers' cube at any size.

use std::time::Instant;

use sinew_core::CountingAllocator;
use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearSystem, System};
use sinew_measure::{Case, Span};
use sinew_scene::{Scene, SceneSource};

use super::row::ScaleBody;
use sinew_verify::LabError;

/// Approximate simulated time (s): a pressure wave crosses the cube three times.
const DURATION: f64 = 0.1;

/// Instants at which errors are taken.
const SAMPLES: usize = 5;

/// Share of the critical step that the steps of central difference take; they meet all instants.
pub(super) const SHARE: f64 = 0.9;

/// A cube with its reference.
pub(super) struct Cube {
    pub(super) case: Case,
    pub(super) body: ScaleBody,
    /// 2/omega (s) of the fastest motion.
    pub(super) critical_step: f64,
}

/// The name of a cube of `cells` cells a side, by its nodes.
pub(super) fn name(cells: usize) -> String {
    format!("cube {}^3", cells + 1)
}

/// The scene: supports, load and law of `scenes/peers-cube.toml`, with mass damping.
fn scene(cells: usize) -> String {
    format!(
        "title = \"The peers' cube, {cells} cells a side\"\n\
         [mesh]\ncube = {{ cells = {cells}, edge = 0.1, split = \"kuhn\" }}\n\
         [[region]]\ngroup = \"tissue\"\ndensity = 1060.0\nmodel = \"linear\"\n\
         youngs_modulus = 3500.0\npoissons_ratio = 0.45\n\
         [damping]\nmass = 20.0\n\
         [[fixed]]\ngroup = \"sides\"\n\
         [[load]]\ngroup = \"top\"\nforce = [0.0, 0.0, -0.042135]\nramp = {{ kind = \"step\" }}\n\
         [run]\nduration = {DURATION}\nsamples = {SAMPLES}\nintegrator = \"central-difference\"\ndt = 1e-4\n"
    )
}

impl Cube {
    /// Builds the cube and solves its reference.
    pub(super) fn new(cells: usize) -> Result<Self, LabError> {
        let before = CountingAllocator::live_bytes();
        let begun = Instant::now();
        let source = SceneSource::new(format!("{}.toml", name(cells)), scene(cells));
        let simulation = Scene::parse(source)?.build()?;
        let build_wall_s = begun.elapsed().as_secs_f64();
        let bytes = CountingAllocator::live_bytes().saturating_sub(before);
        let (nodes, tets) = match simulation.model().body() {
            Some(body) => (body.mesh.points.len(), body.mesh.tets.len()),
            None => (0, 0),
        };
        let begun = Instant::now();
        let system = simulation.system().as_linear();
        let operators = system.map(LinearSystem::operators);
        let omega = operators.map_or(0.0, |operators| Spectrum::of(operators).omega_max);
        let critical_step = 2.0 / omega;
        let steps = (DURATION / (SAMPLES as f64 * SHARE * critical_step)).round();
        let span = Span {
            duration: SAMPLES as f64 * steps.max(1.0) * SHARE * critical_step,
            samples: SAMPLES,
        };
        let case = Case::with_affordable_reference(name(cells), simulation, span)?;
        let reference_wall_s = begun.elapsed().as_secs_f64();
        let info = case.info();
        let system = case.simulation().system();
        Ok(Self {
            critical_step,
            body: ScaleBody {
                mesh: info.id,
                nodes,
                tets,
                dofs: System::dofs(system),
                simulated_s: span.duration,
                critical_step_s: critical_step,
                build_wall_s,
                bytes_per_tet: (bytes > 0).then(|| bytes as f64 / tets as f64),
                reference: info.reference,
                reference_error: info.reference_error,
                reference_sweeps: case.samples().sweeps,
                reference_sweeps_per_omega_t: case.samples().sweeps as f64
                    / (omega * span.duration),
                reference_wall_s,
            },
            case,
        })
    }
}

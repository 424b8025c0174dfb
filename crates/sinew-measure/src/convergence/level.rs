//! A scene solved on one mesh.

use serde::{Deserialize, Serialize};
use sinew_core::{
    LoadTime, Moment, Outcome, RecordError, Recorder, Run, RunReport, StepReport, Verdict, simulate,
};
use sinew_integrators::equilibrium;
use sinew_scene::Simulation;

use super::error::ConvergeError;
use super::observed::{Eye, Observed, Places};
use super::prediction::{Prediction, TimeCheck};
use super::step::{parts, stable_step};
use crate::reference::follow_affordably;

/// Largest `||K u - F|| / ||F||` that counts as equilibrium.
const BALANCED: f64 = 1e-9;

/// A mesh and the runs on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// Nodes.
    pub nodes: usize,
    /// Tetrahedra.
    pub tets: usize,
    /// Free degrees of freedom.
    pub dofs: usize,
    /// Step (s) of the scene's method: the scene's, or a whole fraction of it if that is not stable on a refined
    /// mesh.
    pub dt: f64,
    /// Steps taken.
    pub steps: usize,
    /// Work of the runs of the scene's method, half steps included.
    pub work: StepReport,
    /// Products that the reference took; 0 without a reference.
    pub reference_sweeps: u64,
    /// Time (s) at which the run in steps of `dt` diverged.
    pub diverged_at: Option<f64>,
}

/// The solutions on one mesh.
pub(super) struct Solved {
    pub(super) level: Level,
    /// Motion by the scene's method in its step; `None` if that diverged.
    pub(super) run: Option<Observed>,
    /// The motion with little or no error in time.
    pub(super) compared: Observed,
    /// The equilibrium in which the run ends.
    pub(super) rest: Option<Observed>,
    pub(super) halving: Halving,
}

/// Ratios of errors in time to the difference of two runs, one with half the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Halving {
    /// Error of the longer steps over the difference.
    pub(super) error: f64,
    /// Error of the solution that is compared between meshes, over that difference.
    pub(super) left: f64,
}

impl Halving {
    /// The ratios for a method of some order; `None` for exact methods.
    fn of(order: Option<u8>) -> Self {
        let Some(order) = order else {
            return Self {
                error: 1.0,
                left: 1.0,
            };
        };
        let left = (f64::from(order).exp2() - 1.0).recip();
        Self {
            error: 1.0 + left,
            left,
        }
    }

    const OF_REFERENCE: Self = Self {
        error: 1.0,
        left: 0.0,
    };
}

/// Relative distance of the end of a run from equilibrium within which it ends at rest.
const AT_REST: f64 = 0.1;

/// Solves a scene on mesh `number`, 0 being the scene's own.
pub(super) fn solve(
    simulation: &Simulation,
    prediction: &Prediction,
    number: usize,
    places: &Places,
    ends_at_rest: bool,
) -> Result<Solved, ConvergeError> {
    let system = simulation.system();
    let body = simulation.model().body();
    let body = body.ok_or(sinew_scene::RefinementError::NoMesh)?;
    let cut = match number {
        // The run as the scene has it, stable or not.
        0 => 1,
        _ => parts(prediction.dt, stable_step(simulation)),
    };
    let (run, report) = observe_run(simulation, prediction, places, (cut, false))?;
    let dt = prediction.dt / cut as f64;
    let mut level = Level {
        nodes: body.mesh.points.len(),
        tets: body.mesh.tets.len(),
        dofs: system.dofs(),
        dt,
        steps: report.steps,
        work: report.work,
        reference_sweeps: 0,
        diverged_at: match report.outcome {
            Outcome::Diverged { t, .. } => Some(t),
            _ => None,
        },
    };
    let run = level.diverged_at.is_none().then_some(run);
    let (compared, halving) = match prediction.time_check {
        TimeCheck::Reference => {
            let times = prediction.instants();
            let track = follow_affordably(system, simulation.initial_state(), &times);
            let track = track.map_err(|source| ConvergeError::Reference {
                level: number + 1,
                source,
            })?;
            level.reference_sweeps = track.sweeps;
            let mut eye = Eye::new(simulation, places)?;
            for (index, (t, u)) in times.iter().zip(&track.displacements).enumerate() {
                let impulses = track.impulses.get(index).map_or(&[][..], Vec::as_slice);
                eye.look(*t, u, impulses)?;
            }
            (eye.seen, Halving::OF_REFERENCE)
        }
        TimeCheck::HalfStep => {
            let (halved, report) = observe_run(simulation, prediction, places, (cut, true))?;
            if matches!(report.outcome, Outcome::Diverged { .. }) {
                return Err(ConvergeError::Diverged {
                    level: number + 1,
                    dt: dt / 2.0,
                });
            }
            if halved.moves()
                && run
                    .as_ref()
                    .is_some_and(|run| run.nodes() == halved.nodes())
            {
                return Err(ConvergeError::SameRun {
                    level: number + 1,
                    dt,
                });
            }
            level.work += report.work;
            let properties = simulation.integrator()?.properties();
            let order = properties.accuracy.order(system.mass_damping() > 0.0);
            (halved, Halving::of(order))
        }
    };
    if !compared.moves() {
        return Err(ConvergeError::NothingMoves);
    }
    let rest = match ends_at_rest {
        true => rest(simulation, places)?,
        false => None,
    };
    let rest = rest.filter(|rest| number > 0 || is_near(&compared, rest, places.nodes()));
    Ok(Solved {
        level,
        run,
        compared,
        rest,
        halving,
    })
}

/// Runs the scene's method with its step divided into parts, or with half of these parts.
fn observe_run(
    simulation: &Simulation,
    prediction: &Prediction,
    places: &Places,
    (cut, is_halved): (usize, bool),
) -> Result<(Observed, RunReport), ConvergeError> {
    let mut integrator = simulation.integrator()?;
    // A method that cuts steps automatically would cut half of one into half as many parts of the same length.
    let cut = match is_halved && !integrator.refine(2) {
        true => 2 * cut,
        false => cut,
    };
    let run = Run {
        dt: prediction.dt / cut as f64,
        steps: prediction.steps * cut,
        ..simulation.run()
    };
    let system = simulation.system();
    integrator.prepare(system, run.dt)?;
    let mut recorder = Instants {
        eye: Eye::new(simulation, places)?,
        every: prediction.stride * cut,
        last: run.steps,
    };
    let mut state = simulation.initial_state().clone();
    let report = simulate(system, &mut *integrator, &mut state, &run, &mut recorder)?;
    Ok((recorder.eye.seen, report))
}

/// Observes the motion at the instants of a comparison.
struct Instants<'a> {
    eye: Eye<'a>,
    every: usize,
    last: usize,
}

impl Recorder for Instants<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        let next = step.max(1).next_multiple_of(self.every).min(self.last);
        (next >= step).then_some(next)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let (t, u) = (moment.state.t(), &moment.state.u);
        let contact = moment.system.contact();
        let impulses = contact.map_or_else(Vec::new, |contact| {
            contact.impulses(moment.state).into_flattened()
        });
        self.eye
            .look(t, u, &impulses)
            .map_err(|source| RecordError {
                t,
                source: Box::new(source),
            })?;
        Ok(Verdict::Continue)
    }
}

/// The equilibrium under the loads at the end of the scene.
fn rest(simulation: &Simulation, places: &Places) -> Result<Option<Observed>, ConvergeError> {
    let system = simulation.system();
    // What tools hold is none of the loads.
    let linear = system.as_linear().filter(|_| system.contact().is_none());
    let Some(linear) = linear else {
        return Ok(None);
    };
    let end = simulation.settings().duration;
    let mut force = vec![0.0; system.dofs()];
    system.external_force(LoadTime::at(end), &[], &mut force);
    let rest = equilibrium(linear.operators(), &force, BALANCED);
    let is_balanced = rest.left <= BALANCED;
    if !is_balanced {
        return Ok(None);
    }
    let mut eye = Eye::new(simulation, places)?;
    eye.look(end, &rest.displacement, &[])?;
    Ok(Some(eye.seen))
}

/// True if a run ends near its equilibrium.
fn is_near(run: &Observed, rest: &Observed, nodes: usize) -> bool {
    let (end, rest) = (run.last(nodes), rest.nodes());
    let size = sinew_core::vectors::norm(rest);
    let difference: Vec<f64> = end.iter().zip(rest).map(|(end, rest)| end - rest).collect();
    size > 0.0 && sinew_core::vectors::norm(&difference) <= AT_REST * size
}

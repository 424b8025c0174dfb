//! A scene with its reference.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::Run;
use sinew_scene::{CuttingError, Scene, SceneError, SceneModel, Simulation};

use crate::cpu_time::thread_cpu_time;
use crate::number;
use crate::reference::{Course, Pace, ReferenceError, ReferenceMethod, Track, follow_by};
use crate::row::CaseInfo;

/// Displacement over the reference's largest at which an oscillator counts as diverged.
const OSCILLATOR_LIMIT: f64 = 1e6;

/// Number of tetrahedra from which on a reference is solved by Faber series: the Taylor series would take minutes of
/// CPU time for a tenth of a second.
const LARGE: usize = 100_000;

/// A scene with its reference solution.
#[derive(Debug)]
pub struct Case {
    id: String,
    simulation: Simulation,
    span: Span,
    course: Course,
    critical_step: Option<f64>,
    reference_cpu_s: f64,
    samples: Arc<Track>,
    /// References at every step, for steps that do not meet the scene's instants.
    every_step: BTreeMap<(u64, usize), Arc<Track>>,
}

/// The part of a scene that is compared, and its instants.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// Simulated time (s), from 0 on.
    pub duration: f64,
    /// The error is taken at t = j duration/samples, j = 0..=samples.
    pub samples: usize,
}

impl Span {
    /// The whole of a scene, at its own instants.
    #[must_use]
    pub fn of(simulation: &Simulation) -> Self {
        let settings = simulation.settings();
        Self {
            duration: settings.duration,
            samples: settings.samples,
        }
    }

    /// Time (s) from one instant to the next.
    #[must_use]
    pub fn interval(self) -> f64 {
        self.duration / self.samples as f64
    }

    fn instants(self) -> Vec<f64> {
        let instant = |j| j as f64 * self.duration / self.samples as f64;
        (0..=self.samples).map(instant).collect()
    }
}

/// Reasons why a scene cannot be a case.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError {
    /// The scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A body that may be cut.
    #[error(
        "{case}: the body is cut while it moves ([cutting]), and no reference follows that: let the strokes end by t = 0, where they cut it before it \
         moves, or remove the table [cutting] to measure the uncut body"
    )]
    Cut {
        /// Id of the case.
        case: String,
    },
    /// A cut before the motion that cannot be made.
    #[error("{case}: {source}")]
    Cutting {
        /// Id of the case.
        case: String,
        /// The error.
        source: Box<CuttingError>,
    },
    /// The reference.
    #[error("{case}: {source}")]
    Reference {
        /// Id of the case.
        case: String,
        /// The error.
        source: ReferenceError,
    },
}

/// The method of a scene's reference: the Taylor series at a pace, unless the body is large or shows no matrices.
pub(crate) fn course(simulation: &Simulation, pace: Pace) -> Course {
    match simulation.model() {
        _ if simulation.system().as_linear().is_none() => Course::Extrapolated,
        _ if simulation.system().contact().is_some() => Course::Extrapolated,
        SceneModel::Body(body) if body.mesh.tets.len() >= LARGE => Course::Faber,
        SceneModel::Body(_) | SceneModel::Oscillator(_) => Course::Taylor(pace),
    }
}

impl Case {
    /// Reads a scene, builds its model and solves its reference. The id is the file's stem.
    ///
    /// # Errors
    /// [`CaseError`].
    pub fn load(path: &Path) -> Result<Self, CaseError> {
        let simulation = Scene::load(path)?.build()?;
        Self::new(Self::id_of(path), simulation)
    }

    /// The id of the case of a scene file.
    #[must_use]
    pub fn id_of(path: &Path) -> String {
        let stem = path.file_stem().unwrap_or(path.as_os_str());
        stem.to_string_lossy().into_owned()
    }

    /// A case from a built scene.
    ///
    /// # Errors
    /// [`CaseError`].
    pub fn new(id: impl Into<String>, simulation: Simulation) -> Result<Self, CaseError> {
        let span = Span::of(&simulation);
        Self::over(id, simulation, span)
    }

    /// A case of a part of a built scene, for scenes whose full reference costs too much.
    ///
    /// # Errors
    /// [`CaseError`].
    pub fn over(
        id: impl Into<String>,
        simulation: Simulation,
        span: Span,
    ) -> Result<Self, CaseError> {
        Self::at_pace(Pace::Short, id, simulation, span)
    }

    /// Like [`Case::over`], with the reference of large bodies for every size, for rows that are compared between
    /// sizes.
    ///
    /// # Errors
    /// [`CaseError`].
    pub fn with_affordable_reference(
        id: impl Into<String>,
        simulation: Simulation,
        span: Span,
    ) -> Result<Self, CaseError> {
        Self::by(Course::Faber, id.into(), simulation, span)
    }

    /// Like [`Case::over`], with a reference at a pace.
    ///
    /// # Errors
    /// [`CaseError`].
    pub(crate) fn at_pace(
        pace: Pace,
        id: impl Into<String>,
        simulation: Simulation,
        span: Span,
    ) -> Result<Self, CaseError> {
        let course = course(&simulation, pace);
        Self::by(course, id.into(), simulation, span)
    }

    fn by(
        course: Course,
        id: String,
        simulation: Simulation,
        span: Span,
    ) -> Result<Self, CaseError> {
        if simulation.is_cut_later() {
            return Err(CaseError::Cut { case: id });
        }
        let simulation = match simulation.cut_beforehand() {
            Ok(simulation) => simulation,
            Err(source) => {
                let source = Box::new(source);
                return Err(CaseError::Cutting { case: id, source });
            }
        };
        let times = span.instants();
        let before = thread_cpu_time();
        let samples = follow_by(
            course,
            simulation.system(),
            simulation.initial_state(),
            &times,
        );
        let samples = samples.map_err(|source| CaseError::Reference {
            case: id.clone(),
            source,
        })?;
        let reference_cpu_s = (thread_cpu_time() - before).as_secs_f64();
        let critical_step = simulation
            .system()
            .spectrum(None)
            .map(|spectrum| spectrum.critical_step())
            .filter(|step| step.is_finite());
        Ok(Self {
            id,
            critical_step,
            reference_cpu_s,
            samples: Arc::new(samples),
            every_step: BTreeMap::new(),
            simulation,
            span,
            course,
        })
    }

    /// Id of the case.
    #[must_use]
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The scene, built.
    #[must_use]
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The part of the scene that is compared.
    #[must_use]
    pub fn span(&self) -> Span {
        self.span
    }

    /// The whole of the scene.
    #[must_use]
    pub fn whole(&self) -> Span {
        Span::of(&self.simulation)
    }

    /// True if all of the scene is compared.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.span.duration >= self.whole().duration
    }

    /// 2/omega_max (s) at rest, if there is any vibration.
    #[must_use]
    pub fn critical_step(&self) -> Option<f64> {
        self.critical_step
    }

    /// CPU time (s) that the reference took, its check included.
    #[must_use]
    pub fn reference_cpu_s(&self) -> f64 {
        self.reference_cpu_s
    }

    /// The reference at the case's instants.
    #[must_use]
    pub fn samples(&self) -> &Arc<Track> {
        &self.samples
    }

    /// The run that covers the case's duration in steps of `dt` (s).
    #[must_use]
    pub fn run(&self, dt: f64) -> Run {
        let run = Run::covering(self.span.duration, dt);
        let limit = self.simulation.divergence_limit();
        run.with_divergence_limit(limit.unwrap_or(OSCILLATOR_LIMIT * self.samples.max_u))
    }

    /// The reference for a run in steps of `dt` (s): the one at the case's instants and the number of steps between
    /// them if dt meets them all, otherwise the reference after every step.
    ///
    /// # Errors
    /// Same as [`Case::reference_at_every_step`].
    pub fn reference_for(&mut self, dt: f64) -> Result<(Arc<Track>, usize), ReferenceError> {
        let per_instant = self.span.interval() / dt;
        let whole = per_instant.round();
        if whole >= 1.0 && (per_instant - whole).abs() < 1e-9 * whole {
            return Ok((Arc::clone(&self.samples), whole as usize));
        }
        Ok((self.reference_at_every_step(dt)?, 1))
    }

    /// The reference after every step of `dt` (s). It is stored, because several methods use the same step.
    ///
    /// # Errors
    /// [`ReferenceError`] when it fails its check.
    pub fn reference_at_every_step(&mut self, dt: f64) -> Result<Arc<Track>, ReferenceError> {
        let steps = self.run(dt).steps;
        let key = (dt.to_bits(), steps);
        if let Some(track) = self.every_step.get(&key) {
            return Ok(Arc::clone(track));
        }
        let times: Vec<f64> = (0..=steps).map(|step| step as f64 * dt).collect();
        let simulation = &self.simulation;
        let track = follow_by(
            self.course,
            simulation.system(),
            simulation.initial_state(),
            &times,
        )?;
        let track = Arc::new(track);
        self.every_step.insert(key, Arc::clone(&track));
        Ok(track)
    }

    /// Description of the case.
    #[must_use]
    pub fn info(&self) -> CaseInfo {
        let track = &self.samples;
        let kind = match self.simulation.model() {
            SceneModel::Body(_) => "body",
            SceneModel::Oscillator(_) => "oscillator",
        };
        CaseInfo {
            id: self.id.clone(),
            title: self.simulation.scene().title().to_owned(),
            remarks: Vec::new(),
            dofs: self.simulation.system().dofs(),
            duration_s: self.span.duration,
            reference: match track.method {
                ReferenceMethod::Taylor => format!(
                    "Taylor series of the {kind}'s motion in time, to rounding; checked against the same with other steps ({} sweeps in all)",
                    track.sweeps
                ),
                ReferenceMethod::Faber => format!(
                    "Faber series of the {kind}'s motion in long steps; checked by its Taylor series over a fifth of the time ({} sweeps in all)",
                    track.sweeps
                ),
                ReferenceMethod::Extrapolated { method, by_rule } => format!(
                    "`{method}` in steps halved until the last halving changed the motion by {}, extrapolated to steps of no length; \
                     checked against another method, extrapolated as well ({} sweeps in all)",
                    number::short(by_rule),
                    track.sweeps
                ),
            },
            reference_error: track.error,
            max_u_m: track.max_u,
            late_amplitude_m: track.late_amplitude,
            critical_step_s: self.critical_step,
            stable_steps_s: BTreeMap::new(),
        }
    }
}

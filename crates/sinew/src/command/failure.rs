//! Failures of commands: one message each, with the line of the scene if there is one.

use std::env::var_os;
use std::io::{self, IsTerminal, stderr};
use std::path::{Path, PathBuf};

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use sinew_core::{OptionError, SimulateError};
use sinew_film::FilmError;
use sinew_measure::advice::AdviceError;
use sinew_measure::convergence::ConvergeError;
use sinew_mesh::vtu::WriteVtuError;
use sinew_mesh::{CellType, LabelError, MeshFileError, RefineError, TetMeshError, WriteMshError};
use sinew_record::{CompareError, Ended, LawCurvesError, MeasuredError, RecordRunError};
use sinew_scene::output::{OutputError, complain};
use sinew_scene::{CuttingError, RefusedLoad, SceneError, Simulation, Warning};
#[cfg(feature = "live")]
use sinew_world::JournalError;
use sinew_world::{AdvanceError, LogError, ReplayError, ReportError, WorldError, WorldStepError};

use super::mp4::Mp4Error;

/// Exit code for input that cannot be used.
const REFUSED: u8 = 2;

/// Exit code for findings, and for failures after the input was accepted.
const FAILED: u8 = 1;

/// Exit code after an interruption, that of shells for Ctrl-C.
const INTERRUPTED: u8 = 130;

/// Reasons why a command did not succeed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// A scene that cannot be used.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A key of the scene that the command line sets twice.
    #[error("`{first}` and `{second}` both set {key}; take one of them out")]
    SetTwice {
        /// The key.
        key: String,
        /// The first option with its value.
        first: String,
        /// The second.
        second: String,
    },
    /// A scene where a mesh is wanted.
    #[error("{}: `sinew new` makes a scene for a mesh, and this is a scene; name a .msh file, or `sinew run {}`", path.display(), path.display())]
    SceneForMesh {
        /// The scene file.
        path: PathBuf,
    },
    /// A log of a session that cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A log of a session that cannot be kept.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A session that cannot be repeated.
    #[error("{}: {source}", log.display())]
    Replay {
        /// Its log.
        log: PathBuf,
        /// The reason.
        source: Box<ReplayError>,
    },
    /// A body that cannot be cut.
    #[error(transparent)]
    Cutting(#[from] CuttingError),
    /// A scene that cannot be set in motion.
    #[error(transparent)]
    World(WorldError),
    /// A load that the scene's integrator refuses.
    #[error(transparent)]
    Load(#[from] RefusedLoad),
    /// An option that the scene's integrator refuses.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// Warnings that the command refuses.
    #[error("{count} {}, which --strict makes {}", plural(*count, "warning"), if *count == 1 { "an error" } else { "errors" })]
    Warnings {
        /// Number of warnings.
        count: usize,
    },
    /// A scene for which there is no advice.
    #[error("{}: {source}", scene.display())]
    Advice {
        /// The scene file.
        scene: PathBuf,
        /// The reason.
        source: AdviceError,
    },
    /// A scene whose error in space cannot be estimated.
    #[error("{}: {source}", scene.display())]
    Converge {
        /// The scene file.
        scene: PathBuf,
        /// The reason.
        source: ConvergeError,
    },
    /// An estimate that takes long.
    #[error(
        "predicted to take {seconds:.0} s, more than {limit} s; --yes begins it, and fewer --levels or a coarser mesh take less"
    )]
    LongConverge {
        /// Predicted time (s).
        seconds: f64,
        /// Time (s) up to which no confirmation is needed.
        limit: f64,
    },
    /// A scene that needs more memory than there is.
    #[error(
        "the scene needs about {needed} MB and this computer has {available} MB left; a coarser mesh takes less"
    )]
    Memory {
        /// Predicted memory (MB).
        needed: u64,
        /// Memory that is left (MB).
        available: u64,
    },
    /// A mesh file that cannot be read.
    #[error(transparent)]
    Mesh(#[from] MeshFileError),
    /// A mesh that is not a body of tetrahedra.
    #[error("{}: {source}", mesh.display())]
    Tetrahedra {
        /// The mesh file.
        mesh: PathBuf,
        /// The reason.
        source: TetMeshError,
    },
    /// An existing file with other content.
    #[error("{} exists and has other content; it was not changed: name another file, or overwrite it with --force", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A ready scene that does not exist.
    #[error("no ready scene is named \"{name}\"; there are {}", known.join(", "))]
    NotReady {
        /// The name given.
        name: String,
        /// The names of all.
        known: Vec<&'static str>,
    },
    /// A name that does not identify a mesh format.
    #[error("{}: expected a name that ends in .msh or .vtu", path.display())]
    MeshFormat {
        /// The path.
        path: PathBuf,
    },
    /// Data of which no groups can be made.
    #[error("{}: {source}", path.display())]
    Labels {
        /// The mesh file.
        path: PathBuf,
        /// The reason.
        source: LabelError,
    },
    /// A mesh that cannot be refined.
    #[error("{}: {source}", path.display())]
    Refine {
        /// The mesh file.
        path: PathBuf,
        /// The reason.
        source: RefineError,
    },
    /// A mesh that a .msh file cannot represent.
    #[error("cannot write {}: {source}", path.display())]
    WriteMsh {
        /// The path.
        path: PathBuf,
        /// The reason.
        source: WriteMshError,
    },
    /// A mesh that a .vtu file cannot represent.
    #[error("cannot write {}: {source}", path.display())]
    WriteVtu {
        /// The path.
        path: PathBuf,
        /// The reason.
        source: WriteVtuError,
    },
    /// A report and a mesh with standard output as their common destination.
    #[error("--json and --out {} both go to standard output; name a file with --out", out.display())]
    SharedOutput {
        /// The destination of the mesh.
        out: PathBuf,
    },
    /// An output that is refused or fails.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A check that found defects and has reported them.
    #[error("the check found defects")]
    Findings,
    /// A run that ended with an error.
    #[error(transparent)]
    Run(#[from] SimulateError),
    /// Reactions that cannot be found.
    #[error("no reactions: {0}")]
    Reactions(#[from] ReportError),
    /// A run that diverged.
    #[error("the run diverged at t = {t:.6} s, first at {place}{remedy}")]
    Diverged {
        /// Time (s).
        t: f64,
        /// The degree of freedom, as the system describes it.
        place: String,
        /// Known reasons and remedies, as the rest of the message.
        remedy: String,
    },
    /// A run that ended because a law refused a state, or a step found no equilibrium.
    #[error("the run ended at t = {t:.6} s: {reason}")]
    Refused {
        /// Time (s).
        t: f64,
        /// The element and the reason.
        reason: String,
    },
    /// A run that the user ended early.
    #[error("interrupted at t = {t:.6} s{remedy}")]
    Interrupted {
        /// Time (s).
        t: f64,
        /// Way to continue the run, as the rest of the message; empty if absent.
        remedy: String,
    },
    /// Results that differ by more than was allowed.
    #[error("the results differ by {largest:.3e}, more than {tolerance:e}")]
    Differ {
        /// The largest relative difference.
        largest: f64,
        /// The largest that was allowed.
        tolerance: f64,
    },
    /// Results that cannot be compared.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// A run of which no picture can be made, or a request that no picture can fulfil.
    #[error("{}: {source}", run.display())]
    Film {
        /// The folder or the scene.
        run: PathBuf,
        /// The reason.
        source: FilmError,
    },
    /// An output that is neither a picture nor a film.
    #[error("--out {}: expected a name that ends in .png for a picture or a film that browsers play, in .mp4 for one by ffmpeg, or a folder for pictures", path.display())]
    FilmFormat {
        /// The path.
        path: PathBuf,
    },
    /// One instant where many pictures are wanted.
    #[error("--at {t} is one picture, and {} is for many: name a file that ends in .png", path.display())]
    OnePicture {
        /// The instant (s).
        t: f64,
        /// The path.
        path: PathBuf,
    },
    /// A film that ffmpeg does not make.
    #[error(transparent)]
    Mp4(#[from] Mp4Error),
    /// Laws without curves.
    #[error(transparent)]
    LawCurves(LawCurvesError),
    /// Measured points that cannot be used.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// An axis of another number of components.
    #[error("{option}: expected three numbers such as 0,0,1, found {found}")]
    Axis {
        /// The option.
        option: &'static str,
        /// Their number.
        found: usize,
    },
    /// Stretches that are no range.
    #[error("--stretch: expected a stretch and a larger one, such as 0.8 1.5, found {found:?}")]
    Stretch {
        /// The numbers given.
        found: Vec<f64>,
    },
    /// A scene whose natural modes cannot be found.
    #[cfg(feature = "implicit")]
    #[error(transparent)]
    Modes(#[from] sinew_record::ModesError),
    /// An option that needs a scene, and none.
    #[cfg(feature = "live")]
    #[error(
        "{option} is for a scene of yours, and the start page opens ready ones: name a scene file, as in `sinew live SCENE {option} ...`"
    )]
    NoScene {
        /// The option.
        option: &'static str,
    },
    /// A page that cannot be served.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Live(sinew_live::LiveError),
    /// No folder for the results of a scene that is compared.
    #[error("no temporary folder for the results: {0}; TMPDIR names another place for it")]
    TemporaryFolder(io::Error),
    /// Results of which a part could not be compared.
    #[error(
        "{count} parts of the results could not be compared, so that a tolerance says nothing of them"
    )]
    NotCompared {
        /// Number of sentences about omissions.
        count: usize,
    },
    /// A run that leaves no result in its folder.
    #[error(transparent)]
    Record(#[from] RecordRunError),
    /// Signals that cannot be listened to.
    #[error("cannot listen to signals: {0}")]
    Signals(io::Error),
    /// Advice from which numbers are missing.
    #[error("missing from the advice: {}", gaps.join("; "))]
    Gaps {
        /// A sentence about each.
        gaps: Vec<String>,
    },
    /// Help or the version could not be printed.
    #[error("writing standard output failed: {0}")]
    Print(io::Error),
}

#[cfg(feature = "live")]
impl From<sinew_live::LiveError> for Failure {
    fn from(error: sinew_live::LiveError) -> Self {
        match error {
            // With its excerpt.
            sinew_live::LiveError::Scene(error) => Self::Scene(error),
            error => Self::Live(error),
        }
    }
}

impl From<LawCurvesError> for Failure {
    fn from(error: LawCurvesError) -> Self {
        match error {
            // With its excerpt.
            LawCurvesError::Scene(error) => Self::Scene(error),
            error => Self::LawCurves(error),
        }
    }
}

impl From<WorldError> for Failure {
    fn from(error: WorldError) -> Self {
        match error {
            WorldError::Scene(error) => Self::Scene(error),
            WorldError::Cutting(error) => Self::Cutting(error),
            other => Self::World(other),
        }
    }
}

impl Failure {
    /// The failure of a world whose time is `t` (s).
    pub(crate) fn of_advance(error: AdvanceError, t: f64) -> Self {
        match error {
            AdvanceError::Step(WorldStepError::Step(error)) => Self::Run(error.into()),
            AdvanceError::Record(error) => Self::Run(error.into()),
            AdvanceError::Step(error) => Self::Refused {
                t,
                reason: error.to_string(),
            },
        }
    }

    /// An error if a run was not completed; `remedy` is added after an interruption.
    pub(crate) fn of_end(
        ended: Ended,
        simulation: &Simulation,
        remedy: impl FnOnce() -> String,
    ) -> Result<(), Self> {
        match ended {
            Ended::Finished => Ok(()),
            Ended::Diverged { t, place } => Err(Self::Diverged {
                t,
                place,
                remedy: simulation.after_divergence(),
            }),
            Ended::Refused { t, reason } => Err(Self::Refused { t, reason }),
            Ended::Interrupted { t } => Err(Self::Interrupted {
                t,
                remedy: remedy(),
            }),
        }
    }

    /// An error if there are warnings.
    pub(crate) fn of_warnings(warnings: &[Warning]) -> Result<(), Self> {
        match warnings.len() {
            0 => Ok(()),
            count => Err(Self::Warnings { count }),
        }
    }

    fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(_)
            | Self::SetTwice { .. }
            | Self::SceneForMesh { .. }
            | Self::Load(_)
            | Self::Cutting(_)
            | Self::World(_)
            | Self::Option(_)
            | Self::Warnings { .. }
            | Self::Advice { .. }
            | Self::LongConverge { .. }
            | Self::Memory { .. }
            | Self::Mesh(_)
            | Self::Tetrahedra { .. }
            | Self::Exists { .. }
            | Self::NotReady { .. }
            | Self::MeshFormat { .. }
            | Self::Labels { .. }
            | Self::Refine { .. }
            | Self::WriteMsh { .. }
            | Self::WriteVtu { .. }
            | Self::Log(_)
            | Self::Replay { .. }
            | Self::LawCurves(_)
            | Self::Measured(_)
            | Self::Axis { .. }
            | Self::Stretch { .. }
            | Self::SharedOutput { .. } => REFUSED,
            Self::Output(error) | Self::Record(RecordRunError::Output(error))
                if error.is_refusal() =>
            {
                REFUSED
            }
            Self::Record(
                RecordRunError::Scene(_)
                | RecordRunError::Option(_)
                | RecordRunError::Checkpoint { .. }
                | RecordRunError::Unusable { .. }
                | RecordRunError::OtherInput { .. }
                | RecordRunError::Resumable { .. }
                | RecordRunError::TooMuch { .. }
                | RecordRunError::Altered { .. }
                | RecordRunError::Replay { .. }
                | RecordRunError::NoInput { .. },
            ) => REFUSED,
            #[cfg(feature = "implicit")]
            Self::Modes(_) => FAILED,
            #[cfg(feature = "live")]
            Self::Journal(_) | Self::NoScene { .. } => REFUSED,
            #[cfg(feature = "live")]
            Self::Live(error) if error.is_refusal() => REFUSED,
            #[cfg(feature = "live")]
            Self::Live(_) => FAILED,
            Self::Compare(_) => REFUSED,
            Self::FilmFormat { .. } | Self::OnePicture { .. } => REFUSED,
            Self::Film { source, .. } => match source {
                FilmError::Png(_) | FilmError::Stopped => FAILED,
                _ => REFUSED,
            },
            Self::Mp4(Mp4Error::Missing(_)) => REFUSED,
            Self::Mp4(_) => FAILED,
            Self::Converge { source, .. } => match source {
                ConvergeError::Refinement(_)
                | ConvergeError::Options(_)
                | ConvergeError::Setup(_)
                | ConvergeError::Cut
                | ConvergeError::NothingMoves => REFUSED,
                _ => FAILED,
            },
            Self::Interrupted { .. } => INTERRUPTED,
            Self::Output(_)
            | Self::Differ { .. }
            | Self::NotCompared { .. }
            | Self::Record(_)
            | Self::Signals(_)
            | Self::TemporaryFolder(_)
            | Self::Findings
            | Self::Run(_)
            | Self::Reactions(_)
            | Self::Diverged { .. }
            | Self::Refused { .. }
            | Self::Gaps { .. }
            | Self::Print(_) => FAILED,
        }
    }

    /// Writes the message to standard error and returns the exit code.
    pub(crate) fn report(&self) -> u8 {
        // Findings were reported as they were found.
        if !matches!(self, Self::Findings) {
            complain(&format!("error: {self}"));
        }
        if let Self::Mesh(error) = self
            && let Some(advice) = error.advice()
        {
            complain(&format!("help: {advice}"));
        }
        if let Self::Tetrahedra { mesh, source } = self
            && let Some(advice) = way_to_tetrahedra(mesh, source)
        {
            complain(&format!("help: {advice}"));
        }
        if let Self::Scene(error) = self
            && let Some(report) = excerpt(error)
        {
            complain(&report);
        }
        self.exit_code()
    }
}

/// Advice on the conversion of a mesh to one of tetrahedra with four nodes.
fn way_to_tetrahedra(mesh: &Path, error: &TetMeshError) -> Option<String> {
    match error {
        TetMeshError::UnsupportedCells { kind, .. } if kind.linear() == CellType::Tetra => {
            let mesh = mesh.display();
            Some(format!(
                "`sinew mesh convert {mesh} OUTPUT --order linear` takes cells by their corners; in a scene, `order = \"linear\"` \
                 in [mesh] does"
            ))
        }
        error => error.advice(mesh),
    }
}

fn plural(count: usize, what: &str) -> String {
    match count {
        1 => what.to_owned(),
        _ => format!("{what}s"),
    }
}

/// Bytes of a mark beyond which an excerpt would fill the terminal.
const LONGEST_MARK: usize = 400;

/// The text at fault, marked, and the hint.
fn excerpt(error: &SceneError) -> Option<String> {
    let span = error.span().filter(|span| span.len() <= LONGEST_MARK)?;
    // The line above says what is wrong.
    let path = error.path().display().to_string();
    let mark = AnnotationKind::Primary.span(span);
    let snippet = Snippet::source(error.source_text())
        .path(path)
        .annotation(mark);
    let mut excerpt = Group::with_level(Level::ERROR).element(snippet);
    if let Some(help) = error.help().filter(|help| !help.is_empty()) {
        excerpt = excerpt.element(Level::HELP.message(help));
    }
    let is_plain = !stderr().is_terminal() || var_os("NO_COLOR").is_some_and(|set| !set.is_empty());
    let renderer = if is_plain {
        Renderer::plain()
    } else {
        Renderer::styled()
    };
    Some(renderer.render(&[excerpt]))
}

//! The kinds of mistakes in a scene.

use super::no_step::NoStableStep;
use super::override_error::OverrideError;
use super::words::{did_you_mean, quoted, quoted_or_none, shortened};
use crate::formula::FormulaError;

/// Largest number of steps of a run: larger whole numbers cannot be distinguished.
pub(crate) const MOST_STEPS: f64 = 1.0 / f64::EPSILON;

/// A mistake in a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The scene file cannot be read.
    #[error("cannot read the scene: {0}")]
    Unreadable(std::io::Error),
    /// The text is not TOML.
    #[error("not TOML: {message}")]
    Syntax {
        /// The message of the TOML parser.
        message: String,
    },
    /// Values of a program that TOML cannot express.
    #[error("these values make no scene: {reason}")]
    Values {
        /// The reason.
        reason: String,
    },
    /// A value of the command line that cannot be set.
    #[error(transparent)]
    Override(#[from] OverrideError),
    /// A key that is unknown in its table.
    #[error("unknown key `{}`{}", shortened(key), did_you_mean(*nearest))]
    UnknownKey {
        /// The key given.
        key: String,
        /// The most similar key of the table, if one is similar.
        nearest: Option<&'static str>,
        /// The keys of the table.
        known: Vec<&'static str>,
    },
    /// A required key that is missing.
    #[error("`{key}` is missing: expected {expected}")]
    Missing {
        /// The key.
        key: &'static str,
        /// The values that fit.
        expected: String,
    },
    /// A value of the right type that does not fit.
    #[error("{key} = {found}: expected {expected}")]
    Value {
        /// The key.
        key: String,
        /// The value as written.
        found: String,
        /// The values that fit.
        expected: String,
    },
    /// A value of the wrong type.
    #[error("{key} = {found}: expected {expected}, found {kind}")]
    Type {
        /// The key.
        key: String,
        /// The value as written.
        found: String,
        /// The values that fit.
        expected: String,
        /// The type of the value.
        kind: &'static str,
    },
    /// A text that is not a formula.
    #[error("{key}: \"{}\": {error}", shortened(text))]
    Formula {
        /// The key.
        key: String,
        /// The text.
        text: String,
        /// The position in it, and the expected text.
        error: FormulaError,
    },
    /// None or several of a set of keys of which exactly one must be given.
    #[error("expected exactly one of {}, found {}", quoted(of), if found.is_empty() { "none".into() } else { quoted(found) })]
    NotExactlyOne {
        /// The keys of which one must be given.
        of: &'static [&'static str],
        /// The keys that are given.
        found: Vec<&'static str>,
    },
    /// A key that is not allowed together with the others.
    #[error("`{key}` {reason}")]
    Misplaced {
        /// The key.
        key: &'static str,
        /// The reason, as the end of a sentence that begins with the key.
        reason: String,
    },
    /// A name that is in use.
    #[error("{key} = \"{name}\" is taken by {by}")]
    Taken {
        /// The key of the name.
        key: &'static str,
        /// The name.
        name: String,
        /// The table that uses it.
        by: String,
    },
    /// A number that a law does not allow.
    #[error(transparent)]
    Parameter(#[from] sinew_fem::hyperelastic::ParameterError),
    /// A load that does not exist.
    #[error(
        "no load is named \"{name}\"; the named loads are {}",
        quoted_or_none(known)
    )]
    UnknownLoad {
        /// The name given.
        name: String,
        /// The names of the loads.
        known: Vec<String>,
    },
    /// A formula whose value is not finite somewhere on the body.
    #[error("a formula gives {value} at ({}, {}, {}) m: expected a finite number everywhere on the part", place[0], place[1], place[2])]
    NotFinite {
        /// Its value there.
        value: f64,
        /// The position (m).
        place: [f64; 3],
    },
    /// A ramp with a parameter outside its range.
    #[error(transparent)]
    Ramp(#[from] sinew_core::RampError),
    /// An integrator that does not exist, or an option it refuses.
    #[error(transparent)]
    Integrator(#[from] sinew_core::OptionError),
    /// A mesh file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] sinew_mesh::MeshFileError),
    /// A table over time that cannot be used.
    #[error(transparent)]
    MotionTable(#[from] super::MotionTableError),
    /// A tool that does not fit the body, or whose description is not valid.
    #[error(transparent)]
    Tool(#[from] super::ToolFault),
    /// A body that cannot be cut.
    #[error(transparent)]
    Cutting(#[from] sinew_fem::CutModelError),
    /// A mesh that is not a body of tetrahedra.
    #[error(transparent)]
    Tetrahedra(#[from] sinew_mesh::TetMeshError),
    /// A cube or a block that cannot be generated.
    #[error(transparent)]
    Cube(#[from] sinew_mesh::structured::StructuredError),
    /// A scale with which coordinates overflow.
    #[error("scale = {scale:?}: expected a factor that leaves all coordinates finite")]
    Scale {
        /// The factor.
        scale: f64,
    },
    /// A group of `[[initial]]` that the mesh does not have.
    #[error(transparent)]
    Group(#[from] sinew_mesh::FindGroupError),
    /// A part chosen by position that has no members.
    #[error(transparent)]
    Selection(#[from] sinew_mesh::SelectionError),
    /// A part chosen by position whose name is that of a group of the mesh file.
    #[error(transparent)]
    SelectedGroup(#[from] sinew_mesh::AddGroupError),
    /// A region for the rest of the body although the other regions cover all of it.
    #[error("the other regions have all {tets} tetrahedra and leave none")]
    NothingLeft {
        /// Tetrahedra of the mesh.
        tets: usize,
    },
    /// A body that cannot be modelled.
    #[error("{}", .0.cause())]
    Model(sinew_fem::FemError),
    /// A material for which there are no curves.
    #[error(transparent)]
    Homogeneous(#[from] sinew_fem::homogeneous::HomogeneousError),
    /// An oscillator that cannot be built.
    #[error(transparent)]
    Oscillator(#[from] sinew_core::OperatorError),
    /// dt = "auto", but no step can be found.
    #[error("dt = \"auto\" finds no step: {0}")]
    NoStableStep(#[from] NoStableStep),
    /// A method that cannot be set up for the scene.
    #[error(transparent)]
    SetUp(sinew_core::SetupError),
    /// A step longer than the duration of a run.
    #[error("dt = {dt} s is longer than the duration, {duration} s: expected a step within it")]
    LongStep {
        /// The step (s).
        dt: f64,
        /// The duration (s).
        duration: f64,
    },
    /// dt = "auto" on a linear body that is cut, whose elements give no bound of the step.
    #[error(
        "dt = \"auto\" finds no step that is stable after cuts, since an element of the body averages strain over tetrahedra that they separate: \
         expected a step with a margin, or element = \"p1\""
    )]
    NoStepOverCuts,
    /// More steps than can be distinguished.
    #[error(
        "dt = {dt:e} s: a duration of {duration:e} s takes {:.3e} steps, more than can be counted ({MOST_STEPS:.0e}); \
         expected a longer step or a shorter duration", duration / dt
    )]
    TooManySteps {
        /// The step (s).
        dt: f64,
        /// The duration (s).
        duration: f64,
    },
    /// A state at t = 0 in which a law with memory is not defined.
    #[error("the body cannot begin so: {0}")]
    InitialState(sinew_core::EvaluationError),
    /// A static state that cannot be solved for.
    #[cfg(feature = "implicit")]
    #[error("no static state: {0}")]
    Static(#[from] sinew_integrators::StaticError),
    /// A static state in a program that was built without the feature `implicit`.
    #[error(
        "this program cannot solve for a static state: it was built without the feature `implicit`"
    )]
    StaticNotBuilt,
}

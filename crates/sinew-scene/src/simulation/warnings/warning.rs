//! A warning as a value.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::number::short;

/// A warning about a scene that runs but may not be what the user intends. It prints as one line.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Warning {
    /// Its kind.
    pub kind: WarningKind,
    /// The fact, with its numbers.
    pub what: String,
    /// The remedy; empty if there is none.
    pub mend: String,
    /// The numbers of the fact, under names that end in their units, for programs.
    pub numbers: Vec<(&'static str, f64)>,
}

impl Warning {
    pub(super) fn new(kind: WarningKind, what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self {
            kind,
            what: what.into(),
            mend: mend.into(),
            numbers: Vec::new(),
        }
    }

    /// The warning of a run that is predicted to take long: wall time (s) and number of steps.
    #[must_use]
    pub fn long_run(seconds: f64, steps: usize, dt: f64) -> Self {
        let what = format!(
            "the run is predicted to take {} by this computer's clock: {steps} steps of {} s",
            time(seconds),
            short(dt)
        );
        let mend = "`sinew plan --tolerance` finds the cheapest method and step, `sinew resume` continues a run in a folder \
                    that was ended";
        let numbers = [("run_s", seconds), ("steps", steps as f64), ("dt_s", dt)];
        Self::new(WarningKind::LongRun, what, mend).with(&numbers)
    }

    pub(super) fn with(mut self, numbers: &[(&'static str, f64)]) -> Self {
        self.numbers.extend_from_slice(numbers);
        self
    }
}

/// A time (s) in the largest unit of which it is more than two.
fn time(seconds: f64) -> String {
    let units = [("days", 86400.0), ("h", 3600.0), ("min", 60.0)];
    let unit = units.into_iter().find(|(_, unit)| seconds > 2.0 * unit);
    let (name, unit) = unit.unwrap_or(("s", 1.0));
    format!("{} {name}", short((10.0 * seconds / unit).round() / 10.0))
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)?;
        match self.mend.is_empty() {
            true => Ok(()),
            false => write!(f, "; {}", self.mend),
        }
    }
}

/// Kinds of warnings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WarningKind {
    /// A remark of the reader of the mesh file.
    MeshFile,
    /// Parts of the body that touch without being joined.
    TouchingParts,
    /// Faces of elements that lie on others without being the same.
    MismatchedFaces,
    /// Blocks of elements that are joined by single nodes or edges only.
    Hinge,
    /// Elements that overlap.
    TangledMesh,
    /// A body larger than any organ.
    LargeBody,
    /// A body lighter or heavier than any tissue of its size.
    OddDensity,
    /// Groups of the mesh file that the scene does not use.
    UnusedGroups,
    /// A region without elements.
    EmptyRegion,
    /// A part of the body without supports.
    FreePart,
    /// A material in which plain linear tetrahedra are too stiff.
    Locking,
    /// A law that fails in motions that tissue undergoes.
    WeakLaw,
    /// An initial displacement of fixed components, which do not move.
    HeldInitial,
    /// A prescribed position that jumps.
    MotionJumps,
    /// A load on components that are moved.
    LoadOnMoved,
    /// A body on which nothing acts.
    NothingActs,
    /// A body that may be cut although nothing cuts it.
    NothingCuts,
    /// A load beyond the strength of any tissue of this stiffness.
    LargeLoad,
    /// A tool that contains nodes at t = 0.
    ToolInside,
    /// A tool that passes through nodes with which it has no contact.
    UnmetNodes,
    /// A tool that is thin compared with the triangles of the surface.
    SmallTool,
    /// A tool that moves by more than the body's size in a step.
    FastTool,
    /// A load or motion that changes before or after the run only.
    OutsideRun,
    /// A step beyond the stable one, or one whose stability is unknown.
    UnstableStep,
    /// A network that only its clamp keeps bounded.
    ClampedNetwork,
    /// A load that the integrator will refuse.
    RefusedLoad,
    /// A load that begins and ends within a step.
    UnresolvedLoad,
    /// A step longer than the duration.
    LongStep,
    /// Steps that do not end at the duration.
    UnevenSteps,
    /// A run that is predicted to take more than a minute.
    LongRun,
    /// A probe farther from the body than an element.
    FarProbe,
    /// A scene without probes.
    NoProbe,
}

/// Serializes as its id.
impl Serialize for WarningKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

impl WarningKind {
    /// Its name for programs.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::MeshFile => "mesh-file",
            Self::TouchingParts => "touching-parts",
            Self::MismatchedFaces => "mismatched-faces",
            Self::Hinge => "hinge",
            Self::TangledMesh => "tangled-mesh",
            Self::LargeBody => "large-body",
            Self::OddDensity => "odd-density",
            Self::UnusedGroups => "unused-groups",
            Self::EmptyRegion => "empty-region",
            Self::FreePart => "free-part",
            Self::Locking => "locking",
            Self::WeakLaw => "weak-law",
            Self::HeldInitial => "held-initial",
            Self::MotionJumps => "motion-jumps",
            Self::LoadOnMoved => "load-on-moved",
            Self::NothingActs => "nothing-acts",
            Self::NothingCuts => "nothing-cuts",
            Self::LargeLoad => "large-load",
            Self::ToolInside => "tool-inside",
            Self::UnmetNodes => "unmet-nodes",
            Self::SmallTool => "small-tool",
            Self::FastTool => "fast-tool",
            Self::OutsideRun => "outside-run",
            Self::UnstableStep => "unstable-step",
            Self::ClampedNetwork => "clamped-network",
            Self::RefusedLoad => "refused-load",
            Self::UnresolvedLoad => "unresolved-load",
            Self::LongStep => "long-step",
            Self::UnevenSteps => "uneven-steps",
            Self::LongRun => "long-run",
            Self::FarProbe => "far-probe",
            Self::NoProbe => "no-probe",
        }
    }
}

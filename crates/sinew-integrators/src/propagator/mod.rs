//! `propagator`: the exact motion over a step, as a polynomial in the network.

mod chebyshev;
mod cut;
mod first_step;
mod krylov;
mod load_fit;
mod peaks;
mod quadrature;
mod recurrence;
mod resolution;
mod series;
mod sweeps;
mod two_step;

use chebyshev::Chebyshev;
use krylov::Krylov;
use load_fit::LoadFit;
use resolution::{HIGHEST_DEGREE, ID, LOOSE, Resolution};
use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Fact, LoadOverStep, Needs, OptionError, OptionValue,
    Options, OtherDamping, Properties, Revision, SetupError, StepReport, System,
};

use two_step::TwoStep;

use crate::scheme::linear;
use crate::{Method, OptionDefault, OptionHelp, OptionKind, OptionLabel, Scheme, SetUp};

/// The exact motion of a linear system over a step, by sweeps of the network only.
///
/// By Chebyshev polynomials for proportional damping and any ramp, or in a Krylov space for any damping and loads that
/// are constant or linear over a step; in both cases kinks and jumps of loads must fall on ends of steps. The degree is
/// chosen from the step to meet a tolerance, and each step is checked. [`PropagatorKind`] defines the error that the
/// tolerance bounds.
///
/// No undamped motion grows, for any tolerance, step and number of steps. The errors of Chebyshev's and Krylov's forms
/// reduce the energy instead: a large tolerance removes up to about twice the error of a step in each step. The
/// two-step form neither removes nor adds energy.
#[derive(Debug)]
pub struct Propagator {
    kind: PropagatorKind,
    fit: Fit,
    resolution: Resolution,
    made: Option<Made>,
}

/// Series, with the system and step for which they were computed.
#[derive(Debug)]
struct Made {
    matrices: Revision,
    /// The loads, if the series depend on them.
    loads: Option<Revision>,
    /// Step (s).
    dt: f64,
    series: Series,
}

/// Kinds of polynomials, with the error that their tolerance bounds.
///
/// Rounding, up to `4e-15 (omega_max dt)^2`, is additional.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PropagatorKind {
    /// Chebyshev's, on the interval of the eigenvalues: proportional damping, any ramp.
    ///
    /// The tolerance bounds the error of a step under constant loads, relative to the distance from equilibrium before
    /// it, both in the energy norm, in any state: the fact `step_error`. No step moves the state farther from
    /// equilibrium. A body without supports keeps its velocity; its travelled distance and the effect of loads on it
    /// are too small by the fact `relaxation`, which is below the tolerance.
    #[default]
    Chebyshev,
    /// Chebyshev's for the step from two displacements to the next, in half the sweeps: mass damping,
    /// loads that jump on steps and are constant between. The velocity is the mean over a step.
    ///
    /// Half the error of `sin(omega dt/2)` of any mode, omega its angular frequency, stays below the
    /// tolerance; the fact `sine_error` is that error. An undamped mode's phase is then off by up to about
    /// twice `sine_error/cos(omega dt/2)` a step and by at most 2 sqrt(2 `sine_error`), a displacement
    /// found from two exact ones by 8 `sine_error` of the distance from equilibrium. Amplitudes neither
    /// grow nor fall.
    TwoStep,
    /// Polynomials that fit the current state best: any damping, loads constant or linear over a step.
    ///
    /// The tolerance bounds an estimate of the error of a step, relative to the step's change of
    /// `(omega_max u, v)` in the norm of the mass. Under constant loads, energy less the work of the loads
    /// does not rise over a step.
    Krylov,
}

impl PropagatorKind {
    /// Condition that loads must meet over each step.
    fn needed_of_loads(self) -> LoadOverStep {
        match self {
            Self::Chebyshev => LoadOverStep::Smooth,
            Self::TwoStep => LoadOverStep::Constant,
            Self::Krylov => LoadOverStep::Linear,
        }
    }
}

/// Modes to which the polynomial of the two-step form is fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fit {
    /// All modes alike: the tolerance bounds the error of every mode, see [`PropagatorKind::TwoStep`].
    #[default]
    Uniform,
    /// The modes that the loads excite, weighted by their excitation: fewer sweeps.
    ///
    /// The tolerance bounds an estimate of the error of a run from rest under these loads, applied suddenly and kept:
    /// its mean square over eight periods of the loads' mean frequency (Rayleigh's quotient of the static
    /// displacement), over that of the displacement, in the norm of the masses. This is no bound for a single step.
    /// Initial motions, forces from outside and pulses of few steps excite faster modes, and their error may be larger.
    /// No mode grows in any case: the form is stable for the whole spectrum and any excitation.
    ///
    /// The fact `estimated_error` is the estimate; `amplitude` is the largest amplitude of any mode that starts with
    /// a velocity, over that of the exact motion, at most 2.
    Load,
}

/// The series that all steps have in common.
#[derive(Debug)]
enum Series {
    LoadFit(Box<LoadFit>),
    TwoStep(Box<TwoStep>),
    Chebyshev(Box<Chebyshev>),
}

impl Propagator {
    /// The method with the smallest degrees that meet `tolerance`, which bounds the error of [`PropagatorKind`].
    #[must_use]
    pub fn with_tolerance(kind: PropagatorKind, tolerance: f64) -> Self {
        Self::new(
            kind,
            Resolution {
                tolerance,
                degree: None,
            },
        )
    }

    fn new(kind: PropagatorKind, resolution: Resolution) -> Self {
        Self {
            kind,
            fit: Fit::Uniform,
            resolution,
            made: None,
        }
    }
}

const TOLERANCE: &str = "tolerance";
const DEGREE: &str = "degree";
const KIND: &str = "kind";
const FIT: &str = "fit";

fn of_kind(kind: &str) -> Options {
    Options::new().with(KIND, OptionValue::Text(kind.into()))
}

/// The two-step form with this fit.
fn of_fit(fit: &str) -> Options {
    of_kind("two-step").with(FIT, OptionValue::Text(fit.into()))
}

/// Estimated error below which the weights would be dominated by rounding.
const LEAST_ESTIMATE: f64 = 1e-6;

const KIND_OPTION: OptionHelp = OptionHelp {
    key: KIND,
    help: "form of the polynomial: \"chebyshev\" (proportional damping, any ramp), \"two-step\" (half the sweeps; mass damping, loads constant over each step) or \"krylov\" (any damping)",
    expected: "\"chebyshev\", \"two-step\" or \"krylov\"",
    kind: OptionKind::Words(&["chebyshev", "two-step", "krylov"]),
    default: OptionDefault::Value("\"chebyshev\""),
    example: "kind = \"krylov\"",
    shown_default: None,
};

const FIT_OPTION: OptionHelp = OptionHelp {
    key: FIT,
    help: "with kind = \"two-step\", what the polynomial is fitted to: \"uniform\" (every mode alike, with a bound of each mode's error) or \"load\" (the modes that the loads excite, in their measure: fewer sweeps, with an estimate for these loads instead of a bound). Either is stable for every motion",
    expected: "\"uniform\" or \"load\"",
    kind: OptionKind::Words(&["uniform", "load"]),
    default: OptionDefault::InWords("\"uniform\""),
    example: "kind = \"two-step\"\nfit = \"load\"",
    shown_default: None,
};

const TOLERANCE_OPTION: OptionHelp = OptionHelp {
    key: TOLERANCE,
    help: "largest error of a step in the energy norm, relative to the distance from equilibrium (\"chebyshev\"); two fifths of the largest error of any mode's sin(omega dt/2), so of the phase, not of the step (\"two-step\"); estimated error of a run from rest under these loads, suddenly applied and kept, over eight periods of their mean frequency (fit = \"load\"), which forces from outside, initial motions and short pulses may pass; estimated error of a step relative to its change (\"krylov\")",
    expected: "a number above 0 and below 1",
    kind: OptionKind::PART,
    default: OptionDefault::InWords("1e-10; 1e-2 with fit = \"load\" or a degree"),
    example: "tolerance = 1e-6",
    shown_default: None,
};

const DEGREE_OPTION: OptionHelp = OptionHelp {
    key: DEGREE,
    help: "degree of the polynomial. A step takes a sweep and two more per degree, with fit = \"load\" one per degree",
    expected: "a whole number from 1 to 500",
    kind: OptionKind::Count(HIGHEST_DEGREE as u32),
    default: OptionDefault::InWords("the smallest that meets the tolerance"),
    example: "degree = 20",
    shown_default: None,
};

impl Method for Propagator {
    const SUMMARY: &'static str = "the exact motion over a step as a polynomial: sweeps only";
    const OPTIONS: &'static [OptionHelp] =
        &[KIND_OPTION, FIT_OPTION, TOLERANCE_OPTION, DEGREE_OPTION];

    const LABELS: &'static [(&'static str, OptionLabel)] = &[(KIND, OptionLabel::Value)];

    fn variants() -> Vec<Options> {
        vec![
            of_kind("two-step"),
            of_kind("two-step").with_number(TOLERANCE, 1e-3),
            of_fit("load"),
            of_kind("krylov"),
        ]
    }

    /// Options for an error of a run. Errors of steps add up; a tenth of the error leaves a margin for that and costs
    /// few degrees. The tolerance of the two-step form is for frequencies: the phase error grows.
    ///
    /// A fit to the loads estimates the error of a run; half of it leaves a margin for effects outside the estimate.
    fn options_for_error(error: f64) -> Vec<Options> {
        let fitted = (0.5 * error > LEAST_ESTIMATE)
            .then(|| of_fit("load").with_number(TOLERANCE, 0.5 * error));
        let options = vec![
            Options::new(),
            Options::new().with_number(TOLERANCE, 0.1 * error),
            of_kind("two-step").with_number(TOLERANCE, 0.01 * error),
            of_kind("krylov").with_number(TOLERANCE, 0.1 * error),
        ];
        options.into_iter().chain(fitted).collect()
    }

    const PROGRAMS: bool = true;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let kind = KIND_OPTION.read(options, ID, |value| match value.word()? {
            "chebyshev" => Some(PropagatorKind::Chebyshev),
            "two-step" => Some(PropagatorKind::TwoStep),
            "krylov" => Some(PropagatorKind::Krylov),
            _ => None,
        })?;
        let fit = FIT_OPTION.read(options, ID, |value| match value.word()? {
            "uniform" => Some(Fit::Uniform),
            "load" => Some(Fit::Load),
            _ => None,
        })?;
        let kind = kind.unwrap_or_default();
        if kind != PropagatorKind::TwoStep {
            options.read(
                ID,
                FIT,
                "nothing without kind = \"two-step\"",
                |_| None::<()>,
            )?;
        }
        let fit = fit.unwrap_or_default();
        let degree = DEGREE_OPTION.read(options, ID, |value| value.count(HIGHEST_DEGREE as u32))?;
        let default = match (degree, fit) {
            (None, Fit::Uniform) => 1e-10,
            _ => LOOSE,
        };
        let tolerance = match fit {
            Fit::Uniform => TOLERANCE_OPTION.number(options, ID)?,
            Fit::Load => {
                let expected = "a number above 1e-6 and below 1 for fit = \"load\"";
                let fits = |tolerance: &f64| *tolerance > LEAST_ESTIMATE && *tolerance < 1.0;
                options.read(ID, TOLERANCE, expected, |value| value.number().filter(fits))?
            }
        };
        let resolution = Resolution {
            tolerance: tolerance.unwrap_or(default),
            degree: degree.map(|degree| degree as usize),
        };
        Ok(Self {
            fit,
            ..Self::new(kind, resolution)
        })
    }
}

impl Scheme for Propagator {
    const ID: &'static str = ID;

    type ByHand = Krylov;

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Exact,
            needs: Needs::Matrices,
            changing_loads: ChangingLoads::Exact(self.kind.needed_of_loads()),
            refuses_long_steps: true,
            // Conserved but for the part that is left out, by which it falls or, in two-step form,
            // oscillates.
            energy: EnergyBehaviour::Bounded,
            other_damping: OtherDamping {
                stiffness: (self.kind != PropagatorKind::TwoStep).then_some(Accuracy::Exact),
                dashpots: (self.kind == PropagatorKind::Krylov).then_some(Accuracy::Exact),
            },
        }
    }

    fn asked_error(&self) -> Option<f64> {
        Some(self.resolution.tolerance)
    }

    fn load_remedy(&self) -> &'static str {
        match self.kind {
            PropagatorKind::Chebyshev => "choose a dt that meets that instant",
            PropagatorKind::TwoStep => {
                "choose a dt that meets the instants at which loads jump, or kind = \"chebyshev\""
            }
            PropagatorKind::Krylov => {
                "choose a dt that meets that instant, or kind = \"chebyshev\" for curved ramps"
            }
        }
    }

    fn depends_on_loads(&self) -> bool {
        self.kind == PropagatorKind::Chebyshev || self.fit == Fit::Load
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        _before: Option<Krylov>,
    ) -> Result<SetUp<Krylov>, SetupError> {
        let (operators, resolution) = (linear(system, ID)?.operators(), self.resolution);
        let loads = (self.fit == Fit::Load).then(|| operators.loads_revision());
        let matrices = operators.revision();
        let of = (matrices, loads, dt);
        let made = self.made.take();
        let known = made.filter(|made| (made.matrices, made.loads, made.dt) == of);
        let series = match (known, self.kind) {
            (Some(made), _) => made.series,
            (None, PropagatorKind::Chebyshev) => {
                Series::Chebyshev(Box::new(Chebyshev::new(operators, dt, resolution)?))
            }
            (None, PropagatorKind::TwoStep) if self.fit == Fit::Load => {
                Series::LoadFit(Box::new(LoadFit::new(operators, dt, resolution)?))
            }
            (None, PropagatorKind::TwoStep) => {
                Series::TwoStep(Box::new(TwoStep::new(operators, dt, resolution)?))
            }
            (None, PropagatorKind::Krylov) => {
                let steps = Krylov::set_up(operators, dt, resolution)?;
                return Ok(SetUp::by_hand(steps, StepReport::default()));
            }
        };
        let program = match &series {
            Series::Chebyshev(series) => {
                series.program(operators.loads().iter().map(|load| &load.ramp))
            }
            Series::TwoStep(series) => series.program(),
            Series::LoadFit(series) => series.program(),
        };
        self.made = Some(Made {
            matrices,
            loads,
            dt,
            series,
        });
        Ok(program.into())
    }

    fn facts(&self) -> Vec<Fact> {
        match self.made.as_ref().map(|made| &made.series) {
            Some(Series::Chebyshev(series)) => series.facts(),
            Some(Series::TwoStep(series)) => series.facts(),
            Some(Series::LoadFit(series)) => series.facts(),
            None => Vec::new(),
        }
    }
}

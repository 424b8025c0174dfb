//! `propagator`: the exact motion over a step, as a polynomial in the network.

mod chebyshev;
mod cut;
mod first_step;
mod krylov;
mod quadrature;
mod resolution;
mod series;
mod sweeps;
mod two_step;

use chebyshev::Chebyshev;
use krylov::Krylov;
use resolution::{HIGHEST_DEGREE, ID, LOOSE, Resolution};
use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Fact, LoadOverStep, Needs, OptionError, OptionValue,
    Options, OtherDamping, Properties, Revision, SetupError, StepReport, System,
};

use two_step::TwoStep;

use crate::scheme::linear;
use crate::{Method, OptionHelp, OptionLabel, Scheme, SetUp};

/// The exact motion of a linear system over a step, by sweeps of the network only.
///
/// By Chebyshev polynomials for proportional damping and any ramp, or in a Krylov space for any
/// damping and loads that are constant or linear over a step; either way kinks and jumps of loads
/// must fall on steps. The degree is chosen from the step to meet a tolerance, and each step is
/// checked. [`PropagatorKind`] defines the error that the tolerance bounds.
///
/// No undamped motion grows, for any tolerance, step and number of steps. Chebyshev's and
/// Krylov's forms err towards less energy instead: a loose tolerance takes energy out, up to about twice
/// the error of a step each time. The two-step form neither takes nor gives.
#[derive(Debug)]
pub struct Propagator {
    kind: PropagatorKind,
    resolution: Resolution,
    /// Series for these matrices and this step.
    made: Option<((Revision, f64), Series)>,
}

/// Kinds of polynomials, with the error that their tolerance bounds.
///
/// Rounding, up to `4e-15 (omega_max dt)^2`, comes on top.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PropagatorKind {
    /// Chebyshev's, on the interval of the eigenvalues: proportional damping, any ramp.
    ///
    /// The tolerance bounds the error of a step under constant loads, relative to the distance from
    /// equilibrium before it, both in the energy norm, in any state: the fact `step_error`. No step
    /// takes the state farther from equilibrium. A body that is not held keeps its velocity; its distance
    /// travelled and the effect of loads on it fall short by the fact `relaxation`, which is below the tolerance.
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

/// The series that all steps have in common.
#[derive(Debug)]
enum Series {
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

    /// The method with this degree; refused where it leaves out more than `tolerance`.
    #[must_use]
    pub fn with_degree(kind: PropagatorKind, degree: usize, tolerance: f64) -> Self {
        Self::new(
            kind,
            Resolution {
                tolerance,
                degree: Some(degree),
            },
        )
    }

    fn new(kind: PropagatorKind, resolution: Resolution) -> Self {
        Self {
            kind,
            resolution,
            made: None,
        }
    }
}

const TOLERANCE: &str = "tolerance";
const DEGREE: &str = "degree";
const KIND: &str = "kind";

fn of_kind(kind: &str) -> Options {
    Options::new().with(KIND, OptionValue::Text(kind.into()))
}

impl Method for Propagator {
    const SUMMARY: &'static str = "the exact motion over a step as a polynomial: sweeps only";
    const OPTIONS: &'static [OptionHelp] = &[
        OptionHelp {
            key: KIND,
            help: "\"chebyshev\" (default; proportional damping, any ramp), \"two-step\" (half the sweeps; mass damping, loads constant over each step) or \"krylov\" (any damping)",
            shown_default: None,
        },
        OptionHelp {
            key: TOLERANCE,
            help: "largest error of a step in the energy norm, relative to the distance from equilibrium (\"chebyshev\"); two fifths of the largest error of any mode's sin(omega dt/2), so of the phase, not of the step (\"two-step\"); estimated error of a step relative to its change (\"krylov\"); default 1e-10",
            shown_default: None,
        },
        OptionHelp {
            key: DEGREE,
            help: "degree of the polynomial; default: the smallest that meets the tolerance",
            shown_default: None,
        },
    ];

    const LABELS: &'static [(&'static str, OptionLabel)] = &[(KIND, OptionLabel::Value)];

    fn variants() -> Vec<Options> {
        vec![
            of_kind("two-step"),
            of_kind("two-step").with_number(TOLERANCE, 1e-3),
            of_kind("krylov"),
        ]
    }

    /// Options for an error of a run. Errors of steps add up; a tenth of the error leaves room for that and
    /// costs few degrees. The two-step form's tolerance is one of frequencies: the phase error grows.
    fn options_for_error(error: f64) -> Vec<Options> {
        vec![
            Options::new(),
            Options::new().with_number(TOLERANCE, 0.1 * error),
            of_kind("two-step").with_number(TOLERANCE, 0.01 * error),
            of_kind("krylov").with_number(TOLERANCE, 0.1 * error),
        ]
    }

    const PROGRAMS: bool = true;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let kinds = "\"chebyshev\", \"two-step\" or \"krylov\"";
        let kind = options.read(ID, KIND, kinds, |value| match value.word()? {
            "chebyshev" => Some(PropagatorKind::Chebyshev),
            "two-step" => Some(PropagatorKind::TwoStep),
            "krylov" => Some(PropagatorKind::Krylov),
            _ => None,
        })?;
        let expected = "a number above 0 and below 1";
        let share = |x: f64| x > 0.0 && x < 1.0;
        let expected_degree = "a whole number from 1 to 500";
        let degree = options.read(ID, DEGREE, expected_degree, |value| {
            value.count(HIGHEST_DEGREE as u32)
        })?;
        let default = if degree.is_some() { LOOSE } else { 1e-10 };
        let resolution = Resolution {
            tolerance: options.number(ID, TOLERANCE, default, expected, share)?,
            degree: degree.map(|degree| degree as usize),
        };
        Ok(Self::new(kind.unwrap_or_default(), resolution))
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
        self.kind == PropagatorKind::Chebyshev
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        _before: Option<Krylov>,
    ) -> Result<SetUp<Krylov>, SetupError> {
        let (operators, resolution) = (linear(system, ID)?.operators(), self.resolution);
        let of = (operators.revision(), dt);
        let known = self.made.take().filter(|(known, _)| *known == of);
        let series = match (known, self.kind) {
            (Some((_, series)), _) => series,
            (None, PropagatorKind::Chebyshev) => {
                Series::Chebyshev(Box::new(Chebyshev::new(operators, dt, resolution)?))
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
        };
        self.made = Some((of, series));
        Ok(program.into())
    }

    fn facts(&self) -> Vec<Fact> {
        match &self.made {
            Some((_, Series::Chebyshev(series))) => series.facts(),
            Some((_, Series::TwoStep(series))) => series.facts(),
            None => Vec::new(),
        }
    }
}

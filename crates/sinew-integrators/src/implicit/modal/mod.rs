//! `modal`: superposition of the most important modes.

mod basis;
mod candidate;
mod carried;
mod columns;
mod failure;
mod inverse;
mod lanczos_basis;
mod motion;
mod ritz;
mod search;
mod small;

use sinew_core::vectors::dot;
use sinew_core::{
    Accuracy, ChangingLoads, Clock, EnergyBehaviour, Fact, LinearOperators, LoadOverStep, Needs,
    OptionError, OptionValue, Options, OtherDamping, Properties, Ramp, Revision, SetupError, State,
    Step, StepError, StepReport, Stepped, System,
};

pub use self::basis::Vectors;
use self::basis::{Basis, Choice};
use self::carried::{Carried, by_mass};
use self::columns::{add, lift_two, project_two};
use self::failure::Failure;
use self::motion::{Mode, Piece, Response};
use crate::exponential::Exponential;
use crate::load_case::LoadCase;
use crate::scheme::linear;
use crate::{Frame, Method, OptionDefault, OptionHelp, OptionKind, Scheme, SetUp, StepByHand};

/// Modal superposition (Clough and Penzien, Dynamics of Structures, chapter 12): with the modes phi of
/// `K phi = omega^2 M phi`, `phi' M phi = 1`, each `q = phi' M u` is a separate oscillator,
/// `q'' + (alpha + beta omega^2) q' + omega^2 q = phi' F(t)`, whose motion under the ramps of the loads is computed
/// exactly at any step; steps are divided at the ramps' breakpoints.
///
/// # Modes
/// The modes come from the Lanczos method on `K^-1 M`, or on `(K + s^2 M)^-1 M` if the body floats, in a basis that
/// starts from the static response to the loads, so that modes that no load excites are never included. Modes at the
/// fast end of the basis have not converged; each stands for a group of modes and represents the loads better than any
/// single mode. For systems of up to 256 degrees of freedom all modes are taken.
///
/// * `tolerance = x`: the basis grows until the response to suddenly applied loads, in the norm of the masses and over
///   eight periods of the slowest mode, changes by less than the tolerance from one basis to the next, which is larger
///   by a third. Then the modes of the smallest static response |phi' F|/omega^2 are left out as far as the tolerance
///   allows. Both shares together are [`Frame::estimated_error`], which is kept below four fifths of the tolerance. If
///   that needs a basis of more than half of the degrees of freedom, set-up fails. The estimate does not include
///   damping. It holds for loads that are applied suddenly and stay: pulses shorter than the slowest periods and loads
///   that are switched excite fast modes more, and the lost share may be several times larger.
/// * `modes = N`: rigid motions and the most excited modes of a basis of 2 N, or of `basis = P`.
///   Without loads, the slowest modes, all converged.
///
/// # Ritz vectors
/// With `vectors = "ritz"`, load-dependent Ritz vectors (Wilson, Yuan and Dickens, Earthquake Eng. Struct. Dyn.
/// 10, 1982) replace modes: the most excited vectors of a basis of twice as many, which takes a factor and one solution
/// for each vector, and one vector for the rest of the static response to each ramp's loads, prescribed motions
/// included. So the static part of a response is exact with any number of vectors: static correction by augmentation
/// (Dickens, Nakagawa and Wittbrodt, Computers & Structures 62, 1997). There are at least as many vectors as different
/// ramps. With `tolerance` the method takes the fewest vectors that the tolerance allows.
///
/// [`Frame::estimated_error`], which a plan reports before the run, is the error of the response to suddenly applied
/// loads, with damping: the error of the vectors relative to their basis, and the change due to the last quarter of the
/// basis.
///
/// # States
/// Modes are a property of the system alone, so that a run can be continued from any of its states. A state that lies
/// outside them is refused, because loads and states excite different modes. The measure is the displacement outside
/// the modes together with the displacement that the velocity outside them would cause, relative to the whole; the
/// allowed share is the tolerance, or a tenth for `modes = N`. A part within that share is dropped.
///
/// # Supports in motion
/// The body's response to slow motion of supports is complete: the part missing in the modes is added. So, with any
/// number of modes, a body that moves with its support at constant velocity exerts no force on it, and a slowly shaken
/// body the force of its whole inertia.
///
/// # Work
/// A step projects displacement and velocity to the modes and lifts them back: `sweeps` counts
/// its 8 n m operations in products with K, rounded up. Set-up reports factorisations and solves;
/// its dense work, which can be much more, is not counted.
#[derive(Clone, Copy, Debug)]
pub struct Modal {
    choice: Choice,
    vectors: Vectors,
    /// Number of Ritz vectors and their estimated error.
    stated: Option<(usize, f64)>,
}

/// The modes of a system, and the motion of each over a step.
#[derive(Debug)]
pub struct ModalSteps {
    choice: Choice,
    /// Identity of the matrices and loads of the modes.
    basis_of: (Revision, Revision),
    basis: Basis,
    carried: Carried,
    cases: Vec<LoadCase>,
    breakpoints: Vec<f64>,
    modes: Vec<Mode>,
    linear: Vec<Response>,
    /// Responses for each load case, empty if its ramp is never sinusoidal.
    harmonic: Vec<Vec<Response>>,
    pieces: Vec<Piece>,
    exponential: Exponential,
    q: Vec<f64>,
    p: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    sweeps: u64,
}

/// Share of a state that may lie outside a fixed number of modes.
const LOST_BY_CHOICE: f64 = 0.1;

/// Share of a state that counts as rounding.
const ROUNDING: f64 = 1e-6;

impl Modal {
    /// The method with as many modes as the tolerance needs; see the type.
    #[must_use]
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self::of(Choice::Tolerance(tolerance))
    }

    /// The method with a fixed number of modes; see the type.
    #[must_use]
    pub fn with_modes(count: usize) -> Self {
        Self::of(Choice::Modes { count, basis: None })
    }

    /// The method with these vectors.
    #[must_use]
    pub fn with_vectors(self, vectors: Vectors) -> Self {
        Self { vectors, ..self }
    }

    fn of(choice: Choice) -> Self {
        Self {
            choice,
            vectors: Vectors::Eigen,
            stated: None,
        }
    }
}

impl Frame<Modal> {
    /// Angular frequencies (rad/s) of the chosen modes, in increasing order, 0 for rigid motions; empty before set-up.
    #[must_use]
    pub fn frequencies(&self) -> &[f64] {
        self.by_hand().map_or(&[], |steps| &steps.basis.frequencies)
    }

    /// The shape (kg^-1/2) of a mode, its modal mass being 1.
    #[must_use]
    pub fn shape(&self, mode: usize) -> Option<&[f64]> {
        let steps = self.by_hand()?;
        let n = steps.u.len();
        steps.basis.shapes.get(mode * n..(mode + 1) * n)
    }

    /// The estimated share of the response to the loads that is lost, if the user gave a tolerance and there are loads
    /// for the estimate.
    #[must_use]
    pub fn estimated_error(&self) -> Option<f64> {
        self.by_hand()?.basis.estimate
    }
}

impl ModalSteps {
    /// Finds the modes.
    fn new(
        operators: &LinearOperators,
        choice: Choice,
        vectors: Vectors,
    ) -> Result<Self, SetupError> {
        let integrator = Modal::ID;
        let cases = LoadCase::of(operators);
        let basis = Basis::build(operators, &cases, choice, vectors);
        let basis = basis.map_err(|failure| match failure {
            Failure::Factorization(error) => error.at_set_up(integrator),
            Failure::NoLoads => SetupError::Lacks {
                integrator,
                needs: "loads to take vectors from for vectors = \"ritz\"",
            },
            Failure::TooFew { needed } => SetupError::Unresolved {
                integrator,
                reason: format!(
                    "these loads need {needed} vectors at least for vectors = \"ritz\": one for each ramp, \
                     and the rigid motions of a body that floats; ask for more `modes`"
                ),
            },
            Failure::TooMany {
                basis,
                dofs,
                estimate,
            } => SetupError::Unresolved {
                integrator,
                reason: format!(
                    "the tolerance needs more than {basis} modes of {dofs} (estimated error \
                         there {:.2} %); ask for a larger `tolerance` or for `modes`, or use \
                         `central-difference`",
                    100.0 * estimate
                ),
            },
        })?;
        let carried = Carried::of(operators, &basis);
        let damping = operators.damping();
        let modes = basis.frequencies.iter().map(|omega| Mode {
            omega: *omega,
            damping: damping.mass + damping.stiffness * omega * omega,
        });
        let modes: Vec<Mode> = modes.collect();
        let ramps = cases.iter().map(|case| &case.ramp);
        let mut breakpoints: Vec<f64> = ramps.flat_map(Ramp::breakpoints).collect();
        breakpoints.sort_by(f64::total_cmp);
        let (n, m) = (operators.dofs(), modes.len());
        let stiffness = operators.stiffness();
        let sweep = 2 * stiffness.pattern().blocks() * stiffness.layers().count().pow(2);
        Ok(Self {
            choice,
            basis_of: (operators.revision(), operators.loads_revision()),
            basis,
            carried,
            breakpoints,
            linear: Vec::new(),
            harmonic: Vec::new(),
            pieces: vec![Piece::default(); cases.len()],
            exponential: Exponential::with_capacity(4),
            q: vec![0.0; m],
            p: vec![0.0; m],
            u: vec![0.0; n],
            v: vec![0.0; n],
            sweeps: (8 * n * m).div_ceil(sweep.max(1)) as u64,
            cases,
            modes,
        })
    }

    /// The exact responses within a step.
    fn take_responses(&mut self, dt: f64) {
        let (modes, room) = (&self.modes, &mut self.exponential);
        let linear = modes
            .iter()
            .map(|mode| Response::to_linear(*mode, dt, room));
        self.linear = linear.collect();
        let harmonic = self.cases.iter().map(|case| {
            let rate = case.ramp.angular_frequency();
            let responses = rate.map(|rate| {
                let of = |mode: &Mode| Response::to_harmonic(*mode, dt, rate, room);
                modes.iter().map(of).collect()
            });
            responses.unwrap_or_default()
        });
        self.harmonic = harmonic.collect();
    }

    /// Projects the state to q and p, and checks that they may replace it.
    fn project(&mut self, system: &dyn System, state: &State) -> Result<StepReport, StepError> {
        let mass = system.mass();
        let whole = [by_mass(mass, &state.u), by_mass(mass, &state.v)];
        self.u.copy_from_slice(&state.u);
        self.v.copy_from_slice(&state.v);
        self.carried.add(-1.0, state.t(), &mut self.u, &mut self.v);
        let rest = [by_mass(mass, &self.u), by_mass(mass, &self.v)];
        for (x, mass) in self
            .u
            .iter_mut()
            .zip(mass)
            .chain(self.v.iter_mut().zip(mass))
        {
            *x *= mass;
        }
        project_two(
            &self.basis.shapes,
            (&self.u, &self.v),
            (&mut self.q, &mut self.p),
        );
        let outside = |of: usize, parts: &[f64]| rest[of] - dot(parts, parts) > 1e-11 * whole[of];
        if self.basis.complete || !(outside(0, &self.q) || outside(1, &self.p)) {
            return Ok(StepReport::default());
        }
        let allowed = match self.choice {
            Choice::Modes { .. } => LOST_BY_CHOICE,
            Choice::Tolerance(tolerance) => tolerance.max(ROUNDING),
        };
        let lost = self.lost(system, state, whole[0]);
        if lost <= allowed {
            return Ok(StepReport {
                solves: 1,
                ..StepReport::default()
            });
        }
        Err(StepError::Inaccurate {
            integrator: Modal::ID,
            t: state.t(),
            reason: format!(
                "{:.3} % of the state lies outside the {} modes, which are those of the loads; {:.3} % may be dropped; take more `modes`, or use `central-difference`",
                100.0 * lost,
                self.modes.len(),
                100.0 * allowed
            ),
        })
    }

    /// The share of the motion that lies outside the modes: with x and y the displacement and velocity outside,
    /// `x' M x + y' M K^-1 M y` over the same of the whole state, as a square root.
    fn lost(&mut self, system: &dyn System, state: &State, whole_u: f64) -> f64 {
        let Some(inverse) = &mut self.basis.inverse else {
            return 0.0;
        };
        for (work, (from, parts)) in [
            (&mut self.u, (&state.u, &self.q)),
            (&mut self.v, (&state.v, &self.p)),
        ] {
            work.copy_from_slice(from);
            add(&self.basis.shapes, parts, -1.0, work);
            // Supports may have jumped, or their speeds.
            self.carried.remove(system.mass(), work);
            for (value, mass) in work.iter_mut().zip(system.mass()) {
                *value *= mass.sqrt();
            }
            inverse.mask(work);
        }
        let outside_u = dot(&self.u, &self.u);
        let outside_v = inverse.form(&self.v, &mut self.u);
        let elastic = self.modes.iter().find(|mode| mode.omega > 0.0);
        let slowest = elastic.map_or(1.0, |mode| mode.omega);
        let moving = self.modes.iter().zip(&self.p);
        let inside_v: f64 = moving
            .map(|(mode, p)| (p / mode.omega.max(slowest)).powi(2))
            .sum();
        ((outside_u + outside_v) / (whole_u + inside_v + outside_v)).sqrt()
    }

    /// Moves q and p by `h` (s) from time `start` (s), with no breakpoint in between.
    fn move_modes(&mut self, start: f64, h: f64, whole_step: bool) {
        for (piece, case) in self.pieces.iter_mut().zip(&self.cases) {
            *piece = Piece::of(&case.ramp, start, h);
        }
        for (i, mode) in self.modes.iter().enumerate() {
            let linear = match whole_step {
                true => self.linear[i],
                false => Response::to_linear(*mode, h, &mut self.exponential),
            };
            let [mut q, mut p] = linear.free(self.q[i], self.p[i]);
            for (case, piece) in self.pieces.iter().enumerate() {
                let force = self.basis.forces[case][i];
                let mut push = |response: Response, sizes: [f64; 2]| {
                    let [dq, dp] = response.forced(sizes.map(|size| force * size));
                    (q, p) = (q + dq, p + dp);
                };
                push(linear, piece.linear);
                let rate = self.cases[case].ramp.angular_frequency();
                if let (Some(sizes), Some(rate)) = (piece.harmonic, rate) {
                    let response = match whole_step {
                        true => self.harmonic[case][i],
                        false => Response::to_harmonic(*mode, h, rate, &mut self.exponential),
                    };
                    push(response, sizes);
                }
            }
            (self.q[i], self.p[i]) = (q, p);
        }
    }
}

impl Default for Modal {
    fn default() -> Self {
        Self::with_tolerance(1e-2)
    }
}

/// Ritz vectors of the loads.
fn ritz() -> Options {
    Options::new().with("vectors", OptionValue::Text("ritz".into()))
}

const TOLERANCE: OptionHelp = OptionHelp {
    key: "tolerance",
    help: "share of the response to suddenly applied, constant loads that may be lost. Short pulses and loads that switch excite faster modes and may lose several times as much",
    expected: "a number above 0 and below 1",
    kind: OptionKind::PART,
    default: OptionDefault::Value("0.01"),
    example: "tolerance = 0.001",
    shown_default: None,
};

/// More modes than any body needs.
const MOST_MODES: u32 = 1_000_000_000;

const MODES: OptionHelp = OptionHelp {
    key: "modes",
    help: "number of modes, instead of a tolerance",
    expected: "a whole number above 0",
    kind: OptionKind::Count(MOST_MODES),
    default: OptionDefault::InWords("as many as the tolerance asks for"),
    example: "modes = 20",
    shown_default: None,
};

const VECTORS: OptionHelp = OptionHelp {
    key: "vectors",
    help: "\"eigen\": modes, the most excited ones; \"ritz\": vectors made from the loads by a factor and two solutions for each, where the static response is exact, and the estimated error is said before the run",
    expected: "\"eigen\" or \"ritz\"",
    kind: OptionKind::Words(&["eigen", "ritz"]),
    default: OptionDefault::Value("\"eigen\""),
    example: "vectors = \"ritz\"",
    shown_default: None,
};

const BASIS: OptionHelp = OptionHelp {
    key: "basis",
    help: "with `modes`: size of the Lanczos basis they are taken from",
    expected: "a whole number not below `modes`",
    kind: OptionKind::Count(MOST_MODES),
    default: OptionDefault::InWords("twice as many as modes"),
    example: "modes = 20\nbasis = 60",
    shown_default: None,
};

impl Method for Modal {
    const SUMMARY: &'static str =
        "superposition of the modes that the loads excite, exact in time; long set-up";
    const OPTIONS: &'static [OptionHelp] = &[TOLERANCE, MODES, VECTORS, BASIS];

    const FACTORISES: bool = true;

    fn variants() -> Vec<Options> {
        vec![ritz()]
    }

    /// Options for an error, which is the share of the response that the method leaves out.
    fn options_for_error(error: f64) -> Vec<Options> {
        vec![
            Options::new().with_number("tolerance", error),
            ritz().with_number("tolerance", error),
        ]
    }

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let refuse = |key, expected| options.read(Self::ID, key, expected, |_| None::<()>);
        let count = |option: OptionHelp, least: u32| {
            let fits = |count: &u32| *count >= least;
            let count = |value: &OptionValue| value.count(MOST_MODES).filter(fits);
            option.read(options, Self::ID, count)
        };
        let vectors = VECTORS.read(options, Self::ID, |value| match value.word()? {
            "eigen" => Some(Vectors::Eigen),
            "ritz" => Some(Vectors::Ritz),
            _ => None,
        })?;
        let vectors = vectors.unwrap_or_default();
        if let Some(modes) = count(MODES, 1)? {
            refuse(TOLERANCE.key, "nothing beside `modes`")?;
            let basis = count(BASIS, modes)?;
            if vectors == Vectors::Ritz {
                refuse(
                    BASIS.key,
                    "nothing with vectors = \"ritz\", which are all of their basis",
                )?;
            }
            let choice = Choice::Modes {
                count: modes as usize,
                basis: basis.map(|basis| basis as usize),
            };
            return Ok(Self::of(choice).with_vectors(vectors));
        }
        refuse(BASIS.key, "nothing without `modes`")?;
        let tolerance = TOLERANCE.number(options, Self::ID)?.unwrap_or(1e-2);
        Ok(Self::with_tolerance(tolerance).with_vectors(vectors))
    }
}

impl Scheme for Modal {
    const ID: &'static str = "modal";

    type ByHand = ModalSteps;

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Exact,
            needs: Needs::Matrices,
            changing_loads: ChangingLoads::Exact(LoadOverStep::Any),
            refuses_long_steps: false,
            energy: EnergyBehaviour::Conserved,
            other_damping: OtherDamping {
                stiffness: Some(Accuracy::Exact),
                dashpots: None,
            },
        }
    }

    fn refuses_contact(&self) -> bool {
        true
    }

    fn depends_on_loads(&self) -> bool {
        true
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        before: Option<ModalSteps>,
    ) -> Result<SetUp<ModalSteps>, SetupError> {
        let integrator = Self::ID;
        let operators = linear(system, integrator)?.operators();
        if operators.damping().extra.is_some() {
            let needs = "proportional damping (D = alpha M + beta K, no dashpots)";
            return Err(SetupError::Lacks { integrator, needs });
        }
        let basis_of = (operators.revision(), operators.loads_revision());
        let known = before.filter(|steps| steps.basis_of == basis_of);
        let (mut steps, work) = match known {
            Some(steps) => (steps, StepReport::default()),
            None => {
                let steps = ModalSteps::new(operators, self.choice, self.vectors)?;
                let work = StepReport {
                    solves: steps.basis.solves,
                    factorizations: steps.basis.factorizations,
                    ..StepReport::default()
                };
                (steps, work)
            }
        };
        steps.take_responses(dt);
        let ritz = self.vectors == Vectors::Ritz;
        let estimate = steps.basis.estimate.filter(|_| ritz);
        self.stated = estimate.map(|estimate| (steps.modes.len(), estimate));
        Ok(SetUp::by_hand(steps, work))
    }

    fn remarks(&self) -> Vec<String> {
        let stated = self.stated.map(|(vectors, estimate)| {
            format!(
                "`modal`: {vectors} Ritz vectors of the loads are estimated to lose {:.2} % of the response to suddenly applied loads",
                100.0 * estimate
            )
        });
        stated.into_iter().collect()
    }
}

impl StepByHand for ModalSteps {
    fn without_program(&self) -> &'static str {
        "each mode reaches over all cells, and a sweep only over neighbours"
    }

    fn facts(&self) -> Vec<Fact> {
        let fact = |name, value| Fact { name, value };
        let mut facts = vec![fact("modes", self.modes.len() as f64)];
        facts.extend(self.basis.estimate.map(|share| fact("left_out", share)));
        facts
    }

    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError> {
        let known = self.cases.iter().all(|case| !case.ramp.is_input());
        if !known || step.inputs.forces().next().is_some() {
            return Err(StepError::Setup(SetupError::Lacks {
                integrator: Modal::ID,
                needs: "loads that are known before the run, to choose its modes; it does not support inputs",
            }));
        }
        let (system, dt) = (step.system, step.dt);
        let mut work = self.project(system, state)?;
        let t = state.t();
        let (next, mut start) = (t + dt, t);
        let margin = Clock::ROUNDING * t.abs().max(next.abs());
        let first = self.breakpoints.partition_point(|t| *t <= start + margin);
        for at in first..self.breakpoints.len() {
            let end = self.breakpoints[at];
            if end >= next - margin {
                break;
            }
            // Two ramps may bend at the same time.
            if end > start {
                self.move_modes(start, end - start, false);
                start = end;
            }
        }
        let whole_step = start == t;
        let rest = if whole_step { dt } else { next - start };
        self.move_modes(start, rest, whole_step);
        lift_two(
            &self.basis.shapes,
            (&self.q, &self.p),
            (&mut state.u, &mut state.v),
        );
        self.carried.add(1.0, next, &mut state.u, &mut state.v);
        work.sweeps += self.sweeps;
        Ok(Stepped::at_same_time(work))
    }
}

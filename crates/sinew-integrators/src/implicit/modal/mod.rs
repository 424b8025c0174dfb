//! `modal`: superposition of the modes that matter.

mod basis;
mod columns;
mod inverse;
mod krylov;
mod motion;
mod search;
mod small;

use sinew_core::{
    Accuracy, ChangingLoads, Clock, EnergyBehaviour, Fact, Integrator, LinearOperators,
    LinearSystem, LoadOverStep, Needs, OptionError, Options, OtherDamping, Prepared, Properties,
    Ramp, Revision, SetupError, StableStep, State, StepError, StepReport, System,
};

use self::basis::{Basis, Choice, Failure, LoadCase};
use self::columns::{add, dot, lift_two, project_two};
use self::motion::{Mode, Piece, Response, harmonic_rate};
use crate::evaluate::begin;
use crate::{Method, OptionHelp};

/// Modal superposition (Clough and Penzien, Dynamics of Structures, chapter 12): with the modes phi
/// of `K phi = omega^2 M phi`, `phi' M phi = 1`, each `q = phi' M u` is an oscillator of its own,
/// `q'' + (alpha + beta omega^2) q' + omega^2 q = phi' F(t)`, whose motion under the ramps of the
/// loads is taken exactly at any step; steps are cut at the ramps' breakpoints.
///
/// # Modes
/// They come from the Lanczos method on `K^-1 M`, or on `(K + s^2 M)^-1 M` where the body floats, in
/// a basis that starts from the static response to the loads, so that what loads do not excite never
/// enters. Modes at the fast end of the basis have not converged; each stands for a bundle of modes,
/// which represents the loads better than any one of them. Systems of up to 256 degrees of freedom
/// have all their modes taken.
///
/// * `tolerance = x`: the basis grows until the response to suddenly applied loads, in the norm of
///   the masses and over eight periods of the slowest mode, changes by less than the tolerance from
///   one basis to the next larger by a third. Then the modes of the smallest static response
///   |phi' F|/omega^2 are left out as far as the tolerance allows. Both shares together are
///   [`Modal::estimated_error`], which is kept below four fifths of the tolerance. Where that takes a basis of more than half of the degrees of
///   freedom, set-up fails. Damping is left out of the estimate. It holds for loads that are applied
///   suddenly and stay: pulses shorter than the slowest periods and loads that switch excite fast
///   modes more, and may lose several times the share.
/// * `modes = N`: rigid motions and the most excited modes of a basis of 2 N, or of `basis = P`.
///   Without loads, the slowest modes, all converged.
///
/// # States
/// Modes are a property of the system alone, so that a run can be continued from any of its states.
/// A state that lies outside them is refused, because loads and states excite different modes: what
/// counts is the displacement outside the modes together with that which the velocity outside them
/// would lead to, against the whole; the allowed share is the tolerance, or a tenth for `modes = N`.
/// What is within the share is dropped.
///
/// # Work
/// A step projects displacement and velocity to the modes and lifts them back: `sweeps` counts
/// its 8 n m operations in products with K, rounded up. Set-up reports factorisations and solves;
/// its dense work, which can be much more, is not counted.
#[derive(Debug)]
pub struct Modal {
    choice: Choice,
    prepared: Prepared,
    basis_of: Option<Revision>,
    basis: Basis,
    cases: Vec<LoadCase>,
    breakpoints: Vec<f64>,
    modes: Vec<Mode>,
    linear: Vec<Response>,
    /// For each load case, empty where its ramp is never sinusoidal.
    harmonic: Vec<Vec<Response>>,
    pieces: Vec<Piece>,
    q: Vec<f64>,
    p: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    sweeps: u64,
}

/// Share of a state that may lie outside a fixed number of modes.
const LOST_BY_CHOICE: f64 = 0.1;

/// Share of a state that is taken for rounding.
const ROUNDING: f64 = 1e-6;

impl Modal {
    /// As many modes as the tolerance needs; see the type.
    #[must_use]
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self::with(Choice::Tolerance(tolerance))
    }

    /// A fixed number of modes; see the type.
    #[must_use]
    pub fn with_modes(count: usize) -> Self {
        Self::with(Choice::Modes { count, basis: None })
    }

    fn with(choice: Choice) -> Self {
        Self {
            choice,
            prepared: Prepared::default(),
            basis_of: None,
            basis: Basis::default(),
            cases: Vec::new(),
            breakpoints: Vec::new(),
            modes: Vec::new(),
            linear: Vec::new(),
            harmonic: Vec::new(),
            pieces: Vec::new(),
            q: Vec::new(),
            p: Vec::new(),
            u: Vec::new(),
            v: Vec::new(),
            sweeps: 0,
        }
    }

    /// Angular frequencies (rad/s) of the modes taken, in increasing order, 0 for rigid motions;
    /// empty before set-up.
    #[must_use]
    pub fn frequencies(&self) -> &[f64] {
        &self.basis.frequencies
    }

    /// The shape (kg^-1/2) of a mode, its modal mass being 1.
    #[must_use]
    pub fn shape(&self, mode: usize) -> Option<&[f64]> {
        let n = self.u.len();
        self.basis.shapes.get(mode * n..(mode + 1) * n)
    }

    /// The share of the response to the loads that is estimated to be lost, where a tolerance was
    /// asked for and there are loads to estimate it from.
    #[must_use]
    pub fn estimated_error(&self) -> Option<f64> {
        self.basis.estimate
    }

    fn take_basis(&mut self, operators: &LinearOperators) -> Result<StepReport, SetupError> {
        let integrator = Self::ID;
        self.basis_of = None;
        self.cases = LoadCase::of(operators);
        self.basis =
            Basis::build(operators, &self.cases, self.choice).map_err(|failure| match failure {
                Failure::Factorization(reason) => SetupError::Factorization { integrator, reason },
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
        let damping = operators.damping();
        let modes = self.basis.frequencies.iter().map(|omega| Mode {
            omega: *omega,
            damping: damping.mass + damping.stiffness * omega * omega,
        });
        self.modes = modes.collect();
        let ramps = self.cases.iter().map(|case| &case.ramp);
        self.breakpoints = ramps.flat_map(Ramp::breakpoints).collect();
        self.breakpoints.sort_by(f64::total_cmp);
        let (n, m) = (operators.dofs(), self.modes.len());
        for (buffer, length) in [
            (&mut self.u, n),
            (&mut self.v, n),
            (&mut self.q, m),
            (&mut self.p, m),
        ] {
            buffer.clear();
            buffer.resize(length, 0.0);
        }
        self.pieces = vec![Piece::default(); self.cases.len()];
        let stiffness = operators.stiffness();
        let sweep = 2 * stiffness.pattern().blocks() * stiffness.layers().count().pow(2);
        self.sweeps = (8 * n * m).div_ceil(sweep.max(1)) as u64;
        Ok(StepReport {
            solves: self.basis.solves,
            factorizations: self.basis.factorizations,
            ..StepReport::default()
        })
    }

    /// The exact responses within a step.
    fn take_responses(&mut self, dt: f64) {
        let modes = &self.modes;
        let linear = modes.iter().map(|mode| Response::to_linear(*mode, dt));
        self.linear = linear.collect();
        let harmonic = self.cases.iter().map(|case| {
            let rate = harmonic_rate(&case.ramp);
            let responses = rate.map(|rate| {
                let of = |mode: &Mode| Response::to_harmonic(*mode, dt, rate);
                modes.iter().map(of).collect()
            });
            responses.unwrap_or_default()
        });
        self.harmonic = harmonic.collect();
    }

    /// q and p from the state, and whether it may be replaced by them.
    fn project(&mut self, system: &dyn System, state: &State) -> Result<StepReport, StepError> {
        let moving = state.u.iter().zip(&state.v).zip(system.mass());
        for ((u, v), ((from_u, from_v), mass)) in self.u.iter_mut().zip(&mut self.v).zip(moving) {
            (*u, *v) = (mass * from_u, mass * from_v);
        }
        let (whole_u, whole_v) = (dot(&self.u, &state.u), dot(&self.v, &state.v));
        project_two(
            &self.basis.shapes,
            (&self.u, &self.v),
            (&mut self.q, &mut self.p),
        );
        let outside = |whole: f64, parts: &[f64]| whole - dot(parts, parts) > 1e-11 * whole;
        if self.basis.complete || !(outside(whole_u, &self.q) || outside(whole_v, &self.p)) {
            return Ok(StepReport::default());
        }
        let allowed = match self.choice {
            Choice::Modes { .. } => LOST_BY_CHOICE,
            Choice::Tolerance(tolerance) => tolerance.max(ROUNDING),
        };
        let lost = self.lost(system, state, whole_u);
        if lost <= allowed {
            return Ok(StepReport {
                solves: 1,
                ..StepReport::default()
            });
        }
        Err(StepError::Inaccurate {
            integrator: Self::ID,
            t: state.t(),
            reason: format!(
                "{:.3} % of the state lies outside the {} modes, which are those of the loads; {:.3} % may be dropped; take more `modes`, or use `central-difference`",
                100.0 * lost,
                self.modes.len(),
                100.0 * allowed
            ),
        })
    }

    /// The share of the motion that lies outside the modes: with x and y the displacement and
    /// velocity outside, `x' M x + y' M K^-1 M y` over the same of the whole state, under a root.
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

    /// Moves q and p by `h` (s) from time `start` (s), no breakpoint lying between.
    fn advance(&mut self, start: f64, h: f64, whole_step: bool) {
        for (piece, case) in self.pieces.iter_mut().zip(&self.cases) {
            *piece = Piece::of(&case.ramp, start, h);
        }
        for (i, mode) in self.modes.iter().enumerate() {
            let linear = match whole_step {
                true => self.linear[i],
                false => Response::to_linear(*mode, h),
            };
            let [mut q, mut p] = linear.free(self.q[i], self.p[i]);
            for (case, piece) in self.pieces.iter().enumerate() {
                let force = self.basis.forces[case][i];
                let mut push = |response: Response, sizes: [f64; 2]| {
                    let [dq, dp] = response.forced(sizes.map(|size| force * size));
                    (q, p) = (q + dq, p + dp);
                };
                push(linear, piece.linear);
                let rate = harmonic_rate(&self.cases[case].ramp);
                if let (Some(sizes), Some(rate)) = (piece.harmonic, rate) {
                    let response = match whole_step {
                        true => self.harmonic[case][i],
                        false => Response::to_harmonic(*mode, h, rate),
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

impl Method for Modal {
    const ID: &'static str = "modal";
    const SUMMARY: &'static str =
        "superposition of the modes that the loads excite, exact in time; long set-up";
    const OPTIONS: &'static [OptionHelp] = &[
        OptionHelp {
            key: "tolerance",
            help: "share of the response to suddenly applied, constant loads that may be lost, above 0 and below 1; default 0.01. Short pulses and loads that switch excite faster modes and may lose several times as much",
            shown_default: None,
        },
        OptionHelp {
            key: "modes",
            help: "a whole number instead of a tolerance: that many modes",
            shown_default: None,
        },
        OptionHelp {
            key: "basis",
            help: "with `modes`: size of the Lanczos basis they are taken from; default twice as many",
            shown_default: None,
        },
    ];

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let refuse = |key: &str, expected| match options.get(key) {
            None => Ok(()),
            Some(found) => Err(OptionError::Value {
                integrator: Self::ID.into(),
                key: key.into(),
                found: found.clone(),
                expected,
            }),
        };
        let count = |key, least: f64, expected| {
            let fits = |value: f64| value >= least && value.fract() == 0.0 && value <= 1e9;
            let value = options.number(Self::ID, key, least, expected, fits)?;
            Ok(options.get(key).map(|_| value as usize))
        };
        if let Some(modes) = count("modes", 1.0, "a whole number above 0")? {
            refuse("tolerance", "nothing beside `modes`")?;
            let basis = count("basis", modes as f64, "a whole number not below `modes`")?;
            return Ok(Self::with(Choice::Modes {
                count: modes,
                basis,
            }));
        }
        refuse("basis", "nothing without `modes`")?;
        let expected = "a number above 0 and below 1";
        let fits = |x| x > 0.0 && x < 1.0;
        let tolerance = options.number(Self::ID, "tolerance", 1e-2, expected, fits)?;
        Ok(Self::with_tolerance(tolerance))
    }
}

impl Integrator for Modal {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Exact,
            needs: Needs::Matrices,
            changing_loads: ChangingLoads::Exact(LoadOverStep::Any),
            energy: EnergyBehaviour::Conserved,
            other_damping: OtherDamping {
                stiffness: Some(Accuracy::Exact),
                dashpots: None,
            },
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if self.prepared.is_for(system, dt) {
            return Ok(StepReport::default());
        }
        let integrator = Self::ID;
        let lacks = |needs| SetupError::Lacks { integrator, needs };
        let operators = system
            .as_linear()
            .map(LinearSystem::operators)
            .ok_or(lacks(Needs::Matrices.describe()))?;
        let mut checked = Prepared::default();
        checked.check(integrator, system, dt)?;
        if operators.damping().extra.is_some() {
            return Err(lacks(
                "proportional damping (D = alpha M + beta K, no dashpots)",
            ));
        }
        self.prepared = Prepared::default();
        let mut work = StepReport::default();
        if self.basis_of != Some(operators.revision()) {
            work = self.take_basis(operators)?;
            self.basis_of = Some(operators.revision());
        }
        self.take_responses(dt);
        self.prepared = checked;
        Ok(work)
    }

    fn stable_step(&self, _system: &dyn System) -> Result<StableStep, SetupError> {
        Ok(StableStep::Any)
    }

    fn facts(&self) -> Vec<Fact> {
        let fact = |name, value| Fact { name, value };
        let mut facts = vec![fact("modes", self.modes.len() as f64)];
        facts.extend(self.basis.estimate.map(|share| fact("left_out", share)));
        facts
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = begin(self, system, state, dt)?;
        work += self.project(system, state)?;
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
                self.advance(start, end - start, false);
                start = end;
            }
        }
        let whole_step = start == t;
        let rest = if whole_step { dt } else { next - start };
        self.advance(start, rest, whole_step);
        lift_two(
            &self.basis.shapes,
            (&self.q, &self.p),
            (&mut state.u, &mut state.v),
        );
        state.advance(dt);
        work.sweeps += self.sweeps;
        system.accept(state);
        Ok(work)
    }
}

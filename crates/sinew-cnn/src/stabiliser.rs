//! The matrix P that replaces M, and its inverse by sweeps of the network.

use std::sync::Arc;

use sinew_core::spectrum::largest_eigenvalue_of_pencil;
use sinew_core::vectors::{dot, weighted_dot};
use sinew_core::{Batch, FreePart, Inputs, LinearModel, LinearOperators, State, VelocityTime};

use crate::blocks::CellBlocks;
use crate::gauss_seidel::GaussSeidel;
use crate::majorant::{Blend, DampingShare, GammaRule, Majorant};
use crate::program::{Forces, Product, Program, Quotient, Register, Sweep, Update};
use crate::rigid::{Deflation, Projection};
use crate::slowest::SlowestMode;
use crate::{Machine, ReferenceMachine};

/// Ways in which P is built from a [`Majorant`] P1 and its A. All start from zero: truncated iterations that start from
/// the last step's result are not a fixed P, and diverge.
///
/// One iteration cannot include the whole damping, because this would add `gamma blockdiag` of the damping to the
/// inertia: it includes [`DampingShare::AsStiffness`]. More iterations include [`DampingShare::Whole`], so that damping
/// is centred in time.
///
/// If M' suffices ([`Majorant::mass_suffices`]), every kind is the Neumann series about M' with as many products:
/// `P = A (I - (I - M'^-1 A)^p)^-1`. With `X = M'^-1 dt/2 D' < I` each mode of X has
/// `P = M' (1 + X)/(1 - (-X)^p) >= M'`, and differs from A by X^p, while lagging damping differs by X; iterations about
/// blocks would change the slowest modes by more than that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Inner {
    /// P = P1: one block per cell, no sweep besides the step's own.
    #[default]
    Block,
    /// Block Jacobi iterations; the first needs no sweep.
    Jacobi {
        /// Iterations, at least 1.
        sweeps: u32,
    },
    /// Chebyshev iterations; the first needs no sweep.
    Chebyshev {
        /// Iterations, at least 1.
        sweeps: u32,
    },
    /// Symmetric block Gauss-Seidel iterations, in the order of the nodes: in steps far beyond the
    /// critical one the motion depends on how nodes are numbered.
    GaussSeidel {
        /// Iterations, at least 1.
        sweeps: u32,
    },
}

impl Inner {
    /// The share of the damping that is in A.
    #[must_use]
    pub fn damping_share(self) -> DampingShare {
        match self {
            Self::Block | Self::Jacobi { sweeps: 1 } | Self::Chebyshev { sweeps: 1 } => {
                DampingShare::AsStiffness
            }
            Self::Jacobi { .. } | Self::Chebyshev { .. } | Self::GaussSeidel { .. } => {
                DampingShare::Whole
            }
        }
    }

    /// True if P is one block for each cell.
    #[must_use]
    pub fn is_single(self) -> bool {
        matches!(self, Self::Block | Self::Jacobi { sweeps: 1 })
    }

    /// Sweeps of the network that one solution takes.
    #[must_use]
    pub fn sweeps(self) -> u64 {
        match self {
            Self::Block => 0,
            Self::Jacobi { sweeps } | Self::Chebyshev { sweeps } => {
                u64::from(sweeps).saturating_sub(1)
            }
            // Each goes once forward over the lower half and once back over the upper, and all but
            // the first need the residual.
            Self::GaussSeidel { sweeps } => (2 * u64::from(sweeps)).saturating_sub(1),
        }
    }
}

/// A symmetric positive definite P above A, or above M' if M' suffices, and its inverse.
///
/// With `P > dt/2 D + dt^2/4 K` the leapfrog step `P (v+ - v-) = dt (F - K u - D v-)`, `u += dt v+` never gains energy,
/// at any step (see [`Stabiliser::certificate`]).
///
/// For parts that may move as rigid bodies, P equals M' on these motions, which cause no strain
/// ([`Stabiliser::sparing`]): so an unsupported body falls, flies and turns as it would at any step.
#[derive(Clone, Debug)]
pub struct Stabiliser {
    majorant: Majorant,
    inner: Inner,
    spared: Spared,
    parts: Vec<FreePart>,
    dt: f64,
}

/// The slowest elastic motion of a body, with and without the added mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slowing {
    /// Its period (s).
    pub period: f64,
    /// Its period in the current steps, as a multiple of [`Slowing::period`].
    pub factor: f64,
}

/// The slowest elastic motion, which does not depend on the step.
struct Slowest(Option<SlowestMode>);

/// Rigid motions for which P equals M'.
#[derive(Clone, Debug)]
enum Spared {
    None,
    /// Rigid motions deflated from the blocks.
    Blocks(Arc<Deflation>),
    /// Rigid motions projected out of an iteration.
    Iteration(Arc<Projection>),
}

/// Energy of W in a motion, as a share of its energy in the blocks, below which it is rigid to rounding.
const RIGID: f64 = 1e-10;

/// Iterations of a solution.
enum Iteration {
    /// No sweep beyond the first.
    Single,
    /// `P_p = A (I - (I - P1^-1 A)^p)^-1`, above A for every p if P1 is above A.
    Jacobi(u64),
    /// Chebyshev iteration (Saad, Iterative Methods for Sparse Linear Systems, algorithm 12.1) on
    /// [floor, 1], which contains the spectrum of `P1^-1 A`. The residual polynomial is at most
    /// `eps = 1/T_p((1 + a)/(1 - a))`; dividing by 1 + eps keeps P above A.
    Chebyshev(u64),
}

impl Stabiliser {
    /// The stabiliser for these matrices and a step of `dt` (s).
    #[must_use]
    pub fn new(
        operators: &LinearOperators,
        dt: f64,
        rule: GammaRule,
        blend: Blend,
        inner: Inner,
    ) -> Self {
        Self {
            majorant: Majorant::new(operators, dt, rule, blend, inner.damping_share()),
            inner,
            spared: Spared::None,
            parts: Vec::new(),
            dt,
        }
    }

    /// The same stabiliser with P = M' on the rigid motions of these parts that W does not resist. P stays above A:
    /// with the blocks by [`Deflation`], with an iteration by [`Projection`].
    #[must_use]
    pub fn sparing(mut self, parts: Vec<FreePart>) -> Self {
        if self.majorant.adds_nothing() || self.majorant.mass_suffices() {
            self.parts = parts;
            return self;
        }
        self.parts = self.without_resistance(parts);
        if self.parts.is_empty() {
            return self;
        }
        let (majorant, parts) = (&self.majorant, self.parts.clone());
        let inertia = |dof| majorant.inertia(dof);
        let spared = if self.inner.is_single() {
            let mut deflation = Deflation::new(parts);
            let added = (1.0, majorant.added().entries());
            deflation.weigh(None, added, (1.0, majorant.inverse().entries()), inertia);
            Spared::Blocks(Arc::new(deflation))
        } else {
            Spared::Iteration(Arc::new(Projection::new(parts, inertia)))
        };
        Self { spared, ..self }
    }

    /// The parts with only the motions that W resists to rounding; springs that resist turns exclude rotations, for
    /// instance.
    fn without_resistance(&self, mut parts: Vec<FreePart>) -> Vec<FreePart> {
        let n = self.majorant.dofs();
        let (mut x, mut product, mut bound) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let most = parts.iter().map(|part| part.twists.len()).max();
        let mut is_free: Vec<Vec<bool>> = vec![Vec::new(); parts.len()];
        for motion in 0..most.unwrap_or(0) {
            x.fill(0.0);
            for part in &parts {
                let Some(twist) = part.twists.get(motion) else {
                    continue;
                };
                let places = part.cells.iter().zip(&part.rest).zip(&part.moves);
                for ((cell, rest), moves) in places {
                    let at = twist.at([0, 1, 2].map(|axis| rest[axis] - part.centre[axis]));
                    for axis in (0..3).filter(|axis| moves[*axis]) {
                        x[3 * *cell as usize + axis] = at[axis];
                    }
                }
            }
            self.majorant.multiply_added(&x, &mut product);
            self.majorant.added().multiply(&x, &mut bound);
            for (part, is_free) in parts.iter().zip(&mut is_free) {
                if motion < part.twists.len() {
                    let along = |values: &[f64]| {
                        let dofs = part.cells.iter().flat_map(|cell| {
                            let first = 3 * *cell as usize;
                            first..first + 3
                        });
                        dofs.map(|dof| x[dof] * values[dof]).sum::<f64>()
                    };
                    is_free.push(along(&product) <= RIGID * along(&bound));
                }
            }
        }
        for (part, is_free) in parts.iter_mut().zip(&is_free) {
            let mut of_motion = is_free.iter();
            part.twists.retain(|_| of_motion.next() == Some(&true));
        }
        parts.retain(|part| !part.twists.is_empty());
        parts
    }

    /// The slowest elastic motion and the factor by which steps slow it down, due to its inertia in P instead of M;
    /// `None` if nothing is added or there is no strain. The first call takes some hundred sweeps.
    #[must_use]
    pub fn slowing(&self) -> Option<Slowing> {
        let majorant = &self.majorant;
        if majorant.adds_nothing() {
            return None;
        }
        let operators = majorant.operators();
        let slowest =
            operators.derived(|operators| Slowest(SlowestMode::of(operators, &self.parts)));
        let SlowestMode {
            shape,
            omega_squared,
        } = slowest.0.as_ref()?;
        let mass = operators.mass();
        let own = weighted_dot(mass, shape, shape);
        let share = if self.inner.is_single() {
            let mut with_added = vec![0.0; shape.len()];
            majorant.added().multiply(shape, &mut with_added);
            let inertia = shape.iter().enumerate();
            let inertia = inertia
                .map(|(dof, x)| majorant.inertia(dof) * x * x)
                .sum::<f64>();
            let deflated = self
                .deflation()
                .map(|deflation| deflation.taken_out(shape, shape));
            own / (inertia + dot(shape, &with_added) - deflated.unwrap_or(0.0))
        } else {
            // By the inverse alone: (M x)' P^-1 M x.
            let force: Vec<f64> = mass.iter().zip(shape).map(|(mass, x)| mass * x).collect();
            let mut moved = force.clone();
            self.solve(&force, &mut moved);
            dot(&force, &moved) / own
        };
        let half = 0.5 * self.dt;
        let omega = omega_squared.sqrt();
        let found = (half * omega * share.sqrt()).min(1.0).asin() / half;
        Some(Slowing {
            period: std::f64::consts::TAU / omega,
            factor: omega / found,
        })
    }

    /// True if P equals M' on rigid motions, so that P needs sums over all cells of a part.
    #[must_use]
    pub fn spares(&self) -> bool {
        !matches!(self.spared, Spared::None)
    }

    /// True if P consists of one block for each cell, apart from rigid motions on which it equals M': a force on a cell
    /// then moves only that cell, or its part as a rigid body.
    #[must_use]
    pub fn is_of_blocks(&self) -> bool {
        self.inner.is_single()
    }

    /// The rigid motions that its blocks omit, if P consists of blocks alone.
    #[must_use]
    pub fn deflation(&self) -> Option<&Arc<Deflation>> {
        match &self.spared {
            Spared::Blocks(deflation) => Some(deflation),
            Spared::None | Spared::Iteration(_) => None,
        }
    }

    /// The block majorant from which it is built.
    #[must_use]
    pub fn majorant(&self) -> &Majorant {
        &self.majorant
    }

    /// Sweeps after which each cell knows `P^-1 r`, r being rho of the sweep `right_side`; `None` if no program can
    /// express it, because it processes one cell after the other, or needs sums over all cells.
    pub fn sweeps(&self, program: &mut Program, right_side: Sweep) -> Option<Solution> {
        if self.spares() {
            return None;
        }
        self.sweeps_of_iteration(program, right_side)
    }

    /// The same for P without regard to rigid motions.
    fn sweeps_of_iteration(&self, program: &mut Program, right_side: Sweep) -> Option<Solution> {
        let iteration = match self.inner {
            _ if self.majorant.mass_suffices() => Iteration::Jacobi(self.inner.sweeps() + 1),
            Inner::Block => Iteration::Single,
            Inner::Jacobi { sweeps } => Iteration::Jacobi(sweeps.into()),
            Inner::Chebyshev { sweeps } => Iteration::Chebyshev(sweeps.into()),
            Inner::GaussSeidel { .. } => return None,
        };
        program.blocks = Some(Arc::clone(self.majorant.inverse()));
        Some(match iteration {
            Iteration::Single | Iteration::Jacobi(1) => Solution::single(right_side),
            Iteration::Jacobi(count) => {
                let [r, x] = ["r", "x"].map(|name| program.named(name));
                let mut sweeps = first_of_many(right_side, r);
                sweeps.push(of_register(r).then(x.becomes_q()));
                sweeps.extend((2..count).map(|_| self.residual(r, x).then(x.plus_q(1.0))));
                sweeps.push(self.residual(r, x));
                Solution {
                    sweeps,
                    terms: vec![(x, 1.0)],
                    of_q: 1.0,
                }
            }
            Iteration::Chebyshev(count) => {
                let a = self.majorant.floor();
                let (centre, radius) = ((1.0 + a) / 2.0, (1.0 - a) / 2.0);
                if radius <= f64::EPSILON {
                    return Some(Solution::single(right_side));
                }
                let [r, x, direction] = ["r", "x", "d"].map(|name| program.named(name));
                let sigma = centre / radius;
                let mut rho = 1.0 / sigma;
                let mut sweeps = first_of_many(right_side, r);
                sweeps.push(of_register(r));
                // The next direction and the next x, which a sweep that follows needs.
                let mut turn = direction.becomes([]).and_q(1.0 / centre);
                let mut moved = x.becomes([(direction, 1.0)]);
                let mut terms = Vec::new();
                for _ in 1..count {
                    extend_last(&mut sweeps, [turn, moved]);
                    let next = 1.0 / (2.0 * sigma - rho);
                    let kept = next * rho;
                    sweeps.push(self.residual(r, x));
                    turn = direction
                        .becomes([(direction, kept)])
                        .and_q(2.0 * next / radius);
                    moved = x.plus(1.0, direction);
                    terms = vec![(x, 1.0), (direction, kept)];
                    rho = next;
                }
                let epsilon = 1.0 / (count as f64 * sigma.acosh()).cosh();
                let of_q = turn.of_q;
                Solution {
                    sweeps,
                    terms,
                    of_q,
                }
                .scaled(1.0 / (1.0 + epsilon))
            }
        })
    }

    /// `q = P1^-1 (r - A x)`.
    fn residual(&self, r: Register, x: Register) -> Sweep {
        let (of_mass, of_stiffness, of_dashpots) = self.majorant.weights_of_target();
        let product = |factor| Product { factor, source: x };
        let mut sweep = of_register(r).with_own(x, 0.0, -of_mass);
        sweep.forces = Forces::Products {
            stiffness: Some(product(of_stiffness)),
            dashpots: of_dashpots.map(product),
        };
        sweep
    }

    /// The largest eigenvalue of `P^-1 (dt/2 D + dt^2/4 K)`. Below 1 it proves that no motion of
    /// this system gains energy at this step: with u the mean of two displacements,
    /// `E = v'(P - dt/2 D - dt^2/4 K) v/2 + u' K u/2` falls by `dt v' D v` in each step.
    #[must_use]
    pub fn certificate(&self) -> f64 {
        let mut inverse = self.solver();
        largest_eigenvalue_of_pencil(
            self.majorant.dofs(),
            |x, out| self.majorant.multiply_required(x, out),
            |x, out| inverse.solve(x, out),
        )
    }

    /// `P^-1` with its own scratch space.
    #[must_use]
    pub fn solver(&self) -> Inverse {
        Inverse::new(self)
    }

    /// `out = P^-1 r`, with new scratch space on each call.
    pub fn solve(&self, r: &[f64], out: &mut [f64]) {
        self.solver().solve(r, out);
    }

    /// The iteration in the order of the cells, if this is the inner iteration.
    fn gauss_seidel(&self) -> Option<GaussSeidel> {
        match self.inner {
            Inner::GaussSeidel { sweeps } if !self.majorant.mass_suffices() => {
                Some(GaussSeidel::new(&self.majorant, sweeps))
            }
            _ => None,
        }
    }
}

/// `P^-1 r` as a sum of registers after some sweeps.
pub struct Solution {
    sweeps: Vec<Sweep>,
    terms: Vec<(Register, f64)>,
    /// Weight of the last sweep's q.
    of_q: f64,
}

impl Solution {
    fn single(right_side: Sweep) -> Self {
        Self {
            sweeps: vec![right_side.over(Quotient::Blocks)],
            terms: Vec::new(),
            of_q: 1.0,
        }
    }

    /// True if the solution is one division by the blocks.
    #[must_use]
    pub fn is_single(&self) -> bool {
        self.sweeps.len() == 1 && self.terms.is_empty()
    }

    fn scaled(mut self, by: f64) -> Self {
        self.terms.iter_mut().for_each(|(_, weight)| *weight *= by);
        self.of_q *= by;
        self
    }

    /// An update that adds the solution times `weight` to the terms it has; its target is none of the
    /// registers with the solution.
    #[must_use]
    pub fn added_to(&self, update: Update, weight: f64) -> Update {
        let terms = self.terms.iter();
        let sum = terms.fold(update, |sum, (register, of)| {
            sum.and(weight * of, *register)
        });
        sum.and_q(weight * self.of_q)
    }

    /// The sweeps, the last of them with these updates.
    #[must_use]
    pub fn then<const N: usize>(mut self, updates: [Update; N]) -> Vec<Sweep> {
        extend_last(&mut self.sweeps, updates);
        self.sweeps
    }
}

fn extend_last<const N: usize>(sweeps: &mut [Sweep], updates: [Update; N]) {
    if let Some(last) = sweeps.last_mut() {
        last.updates.extend(updates);
    }
}

/// The sweep that stores its rho in `r`.
fn first_of_many(right_side: Sweep, r: Register) -> Vec<Sweep> {
    vec![right_side.over(Quotient::Plain).then(r.becomes_q())]
}

/// `q = P1^-1 r`.
fn of_register(r: Register) -> Sweep {
    Sweep::local().with_own(r, 1.0, 0.0).over(Quotient::Blocks)
}

/// `P^-1` as an operator, with its scratch space.
pub struct Inverse {
    solver: Solver,
    spared: Spared,
    /// Right-hand side of an iteration.
    right: Vec<f64>,
}

enum Solver {
    Blocks(Arc<CellBlocks>),
    Program(Box<(ReferenceMachine, LinearModel, State)>),
    GaussSeidel(Box<GaussSeidel>),
}

impl Inverse {
    fn new(stabiliser: &Stabiliser) -> Self {
        let spared = stabiliser.spared.clone();
        let right = match &spared {
            Spared::Iteration(_) => vec![0.0; stabiliser.majorant.dofs()],
            Spared::None | Spared::Blocks(_) => Vec::new(),
        };
        let solver = match (&spared, stabiliser.gauss_seidel()) {
            (Spared::Blocks(_), _) => Solver::Blocks(Arc::clone(stabiliser.majorant.inverse())),
            (_, Some(gauss_seidel)) => Solver::GaussSeidel(Box::new(gauss_seidel)),
            (_, None) => Solver::of_program(stabiliser),
        };
        Self {
            solver,
            spared,
            right,
        }
    }

    /// `out = P^-1 r`.
    pub fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        match &self.spared {
            Spared::None => self.solver.solve(r, out),
            Spared::Blocks(deflation) => {
                self.solver.solve(r, out);
                deflation.correct(r, out);
            }
            Spared::Iteration(projection) => {
                self.right.copy_from_slice(r);
                projection.take_out(&mut self.right);
                self.solver.solve(&self.right, out);
                projection.put_back(r, out);
            }
        }
    }
}

impl Solver {
    fn of_program(stabiliser: &Stabiliser) -> Self {
        let mut program = Program::new(VelocityTime::Same);
        let right_side = Sweep::local().with_own(Register::U, 1.0, 0.0);
        if let Some(solution) = stabiliser.sweeps_of_iteration(&mut program, right_side) {
            let out = solution.added_to(Register::V.becomes([]), 1.0);
            program.step = solution.then([out]);
        }
        let system = LinearModel::new(stabiliser.majorant.operators().clone());
        let mut machine = ReferenceMachine::default();
        machine.load(Arc::new(program), &system);
        let state = State::at_rest(stabiliser.majorant.dofs());
        Self::Program(Box::new((machine, system, state)))
    }

    fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        match self {
            Self::Blocks(inverse) => inverse.multiply(r, out),
            Self::GaussSeidel(gauss_seidel) => gauss_seidel.solve(r, out),
            Self::Program(parts) => {
                let (machine, system, state) = parts.as_mut();
                state.u.copy_from_slice(r);
                let mut batch = Batch::new(system, Inputs::none(), 1.0, 1);
                match machine.run(&mut batch, state) {
                    Ok(()) => out.copy_from_slice(&state.v),
                    // Matrices refuse nothing; what is not solved is no number.
                    Err(_) => out.fill(f64::NAN),
                }
            }
        }
    }
}

//! The matrix P that takes the place of M, and its inverse by sweeps of the network.

use std::sync::Arc;

use sinew_core::spectrum::largest_eigenvalue_of_pencil;
use sinew_core::{Batch, Inputs, LinearModel, LinearOperators, State, VelocityTime};

use crate::gauss_seidel::GaussSeidel;
use crate::majorant::{Blend, DampingShare, GammaRule, Majorant};
use crate::program::{Forces, Product, Program, Quotient, Register, Sweep, Update};
use crate::{Machine, ReferenceMachine};

/// Ways in which P is built from a [`Majorant`] P1 and its A. All start cold: truncated iterations that
/// start from the last step's result are not a fixed P, and blow up.
///
/// One iteration leaves no room for the whole damping, which would add `gamma blockdiag` of it to the
/// inertia: it takes [`DampingShare::AsStiffness`]. More iterations take [`DampingShare::Whole`], so
/// that damping is centred in time.
///
/// Where M' suffices ([`Majorant::mass_suffices`]) every kind is the Neumann series about M' with as
/// many products: `P = A (I - (I - M'^-1 A)^p)^-1`. With `X = M'^-1 dt/2 D' < I` each mode of X has
/// `P = M' (1 + X)/(1 - (-X)^p) >= M'`, and is off from A by X^p where lagging damping is off by X;
/// iterations about blocks would move the slowest modes by more than that.
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

/// A symmetric positive definite P, above A or above M' where M' suffices, and its inverse.
///
/// With `P > dt/2 D + dt^2/4 K` the leapfrog step `P (v+ - v-) = dt (F - K u - D v-)`, `u += dt v+`
/// never gains energy, at any step (see [`Stabiliser::certificate`]).
#[derive(Clone, Debug)]
pub struct Stabiliser {
    majorant: Majorant,
    inner: Inner,
}

/// Iterations by which a solution begins and goes on.
enum Iteration {
    /// No sweep beyond the first.
    Single,
    /// `P_p = A (I - (I - P1^-1 A)^p)^-1`, above A for every p where P1 is above A.
    Jacobi(u64),
    /// Chebyshev iteration (Saad, Iterative Methods for Sparse Linear Systems, algorithm 12.1) on
    /// [floor, 1], which holds the spectrum of `P1^-1 A`. The residual polynomial is at most
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
        }
    }

    /// The block majorant behind it.
    #[must_use]
    pub fn majorant(&self) -> &Majorant {
        &self.majorant
    }

    /// Sweeps after which each cell knows `P^-1 r`, r being rho of the sweep `right_side`; `None` where
    /// no program can express it, since cells would have to go one after the other.
    pub fn sweeps(&self, program: &mut Program, right_side: Sweep) -> Option<Solution> {
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
        let mut solver = Solver::new(self);
        largest_eigenvalue_of_pencil(
            self.majorant.dofs(),
            |x, out| self.majorant.multiply_required(x, out),
            |x, out| solver.solve(x, out),
        )
    }

    /// `out = P^-1 r`, with room of its own on each call.
    pub fn solve(&self, r: &[f64], out: &mut [f64]) {
        Solver::new(self).solve(r, out);
    }

    /// The iteration in the order of the cells, where that is the inner one.
    #[must_use]
    pub fn gauss_seidel(&self) -> Option<GaussSeidel> {
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

    /// Whether it is one division by the blocks.
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
    /// registers that hold the solution.
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

/// The sweep that keeps its rho in `r`.
fn first_of_many(right_side: Sweep, r: Register) -> Vec<Sweep> {
    vec![right_side.over(Quotient::Plain).then(r.becomes_q())]
}

/// `q = P1^-1 r`.
fn of_register(r: Register) -> Sweep {
    Sweep::local().with_own(r, 1.0, 0.0).over(Quotient::Blocks)
}

/// `P^-1` by itself.
enum Solver {
    Program(Box<(ReferenceMachine, LinearModel, State)>),
    GaussSeidel(GaussSeidel),
}

impl Solver {
    fn new(stabiliser: &Stabiliser) -> Self {
        if let Some(gauss_seidel) = stabiliser.gauss_seidel() {
            return Self::GaussSeidel(gauss_seidel);
        }
        let mut program = Program::new(VelocityTime::Same);
        let right_side = Sweep::local().with_own(Register::U, 1.0, 0.0);
        if let Some(solution) = stabiliser.sweeps(&mut program, right_side) {
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
            Self::GaussSeidel(gauss_seidel) => gauss_seidel.solve(r, out),
            Self::Program(parts) => {
                let (machine, system, state) = parts.as_mut();
                state.u.copy_from_slice(r);
                let mut batch = Batch::new(system, Inputs::none(), 1.0, 1);
                // Matrices refuse nothing.
                if machine.run(&mut batch, state).is_ok() {
                    out.copy_from_slice(&state.v);
                }
            }
        }
    }
}

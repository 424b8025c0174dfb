//! Steps of explicit methods as programs of a cellular network.

mod build;
mod display;
mod formula;
mod guarded;
mod number;
mod physics;
mod stretch;
mod sweep;
mod traffic;
mod work;

use std::sync::Arc;

use sinew_core::{Acceleration, DampedAt, Inertia, VelocityTime};

pub use physics::Physics;
pub use sweep::{
    Clamp, Forces, LoadAt, Loads, OwnTerm, Product, Quotient, Register, Sweep, Term, Update,
    Weight, When,
};
pub use traffic::Traffic;

use crate::blocks::CellBlocks;

/// A step of an explicit method for a cellular network with a stored program (Roska and
/// Chua, IEEE Trans. Circuits Syst. II 40, 1993): sweeps over all cells, after each of which every
/// cell combines its own registers.
///
/// A cell has a few registers, each one value per layer. A sweep is the only place where a cell
/// reads its neighbours; see [`Sweep`]. A program is a plain value: it can be printed, compared and
/// tested without a mesh. A [`crate::Machine`] runs it.
///
/// ```
/// use sinew_cnn::{LoadAt, Physics, Program, Register};
/// use sinew_core::VelocityTime;
///
/// // Symplectic Euler with a step of 1 ms: v += dt M^-1 (F - K u - D v), u += dt v.
/// let (u, v, dt) = (Register::U, Register::V, 1e-3);
/// let mut program = Program::new(VelocityTime::Same);
/// let physics = Physics::undamped();
/// let force = program.net_force(&physics, u, v, LoadAt::StartOf);
/// program.step.push(force.then(v.plus_q(dt)).then(u.plus(dt, v)));
/// assert_eq!(program.products_a_step(), 1);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    names: Vec<&'static str>,
    /// Registers computed from those of the state when a state is loaded.
    pub entry: Vec<Update>,
    /// The first step, from a velocity at the displacement's time; empty if it equals all others.
    pub start: Vec<Sweep>,
    /// A step.
    pub step: Vec<Sweep>,
    /// Time of V after a step.
    pub velocity: VelocityTime,
    /// Times at which damping uses velocities after a step.
    pub damped: DampedAt,
    /// Kind of acceleration in A after the last step of a batch.
    pub acceleration: Acceleration,
    /// P^-1, one block for each cell, of sweeps with [`Quotient::Blocks`].
    pub blocks: Option<Arc<CellBlocks>>,
    /// The matrix P of a step that is `P (v+ - v-) = dt F`, `u+ = u + dt v+`; `None` for other steps, which support no
    /// contact.
    pub inertia: Option<CellInertia>,
    /// Limits (m/s) of [`Clamp::Vector`], one for each cell.
    pub limits: Option<Arc<[f64]>>,
    /// Number of times that a step is executed for one step of the caller.
    pub repeats: u32,
    /// Moments of loads, from which load-dependent weights are computed.
    pub moments: Option<Arc<Moments>>,
    sources: Vec<Source>,
}

/// A register with `u + beta v`, so that one product serves K and stiffness damping.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Source {
    register: Register,
    u: Register,
    v: Register,
    beta: f64,
}

/// The matrix P that a step divides forces by, with one block for each cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellInertia {
    /// The lumped mass times this factor.
    Mass(f64),
    /// The inverse of [`Program::blocks`].
    Blocks,
}

/// Linear functionals of the change of a load's factor r over a step: number i is `sum over j of
/// weights[i][j] (r(t + times[j]) - r(t))`.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    /// Times since the beginning of the step (s).
    pub times: Vec<f64>,
    /// Weights of each functional, as many as times.
    pub weights: Vec<Vec<f64>>,
}

impl Program {
    /// The names of the registers, in the order of their numbers.
    #[must_use]
    pub fn registers(&self) -> &[&'static str] {
        &self.names
    }

    /// This program executed `times` as often for one step of the caller.
    #[must_use]
    pub fn repeated(self, times: u32) -> Self {
        Self {
            repeats: self.repeats.saturating_mul(times),
            ..self
        }
    }

    /// The matrix P of a step, as contact needs it.
    #[must_use]
    pub fn inertia(&self) -> Option<Inertia<'_>> {
        match self.inertia? {
            CellInertia::Mass(factor) => Some(Inertia::Mass(factor)),
            CellInertia::Blocks => {
                let blocks = self.blocks.as_ref()?;
                Some(Inertia::InverseBlocks(blocks.entries()))
            }
        }
    }

    /// The size (m/s) at which a component of the velocity moves the displacement at most; infinite if nothing
    /// saturates.
    #[must_use]
    pub fn saturation(&self) -> f64 {
        let updates = self.step.iter().flat_map(|sweep| &sweep.updates);
        let limits = updates.filter_map(|update| match update.clamp {
            Some(Clamp::Component(limit)) => Some(limit),
            Some(Clamp::Vector { .. }) | None => None,
        });
        limits.fold(f64::INFINITY, f64::min)
    }

    /// The time (s) by which a change of velocity is divided to give the acceleration that a step of `dt` (s) stores;
    /// `starts` in a first step from a velocity at the displacement's time.
    #[must_use]
    pub fn kick(&self, dt: f64, starts: bool) -> Option<f64> {
        let halves = starts && self.velocity != VelocityTime::Same;
        let time = if halves { dt / 2.0 } else { dt };
        (self.acceleration == Acceleration::Kick).then_some(time)
    }

    /// Name of a register.
    #[must_use]
    pub fn name(&self, register: Register) -> &'static str {
        self.names.get(register.index()).copied().unwrap_or("?")
    }
}

//! The limits of `saturation = "auto"`: the largest speed of a cell by the energy in the body.
//!
//! *Exact motion.* The motion of a linear system is the sum of the free motion from its start and of the motion from
//! rest under each load. In the norm `|v|_M = sqrt(v'Mv)` the first is at most `sqrt(2 E_start)`, since damping removes
//! energy, and the others together at most `sqrt(2 W)` (`load_work.rs`). No cell can have more than the whole energy:
//! `|v_i| <= (sqrt(2 W) + sqrt(2 E_start))/sqrt(m_i)`, m_i being the cell's mass. That holds for every body, and does
//! not depend on the axes' directions.
//!
//! *Computed motion.* A method's velocities may be larger; [`room`] gives the factor.

use sinew_core::{SetupError, Start, State, System};

use super::load_work::{LoadStrength, load_strengths};

/// The smallest factor of a computed velocity over the bound of the exact velocity.
pub(super) const LEAST_ROOM: f64 = 10.0;

/// The factor by which a method's velocities may exceed the bound of exact motion at a step that is this share
/// of its stable one and this many times `1/alpha`, alpha being the rate of mass damping.
///
/// Within its stable step a method has its own discrete energy. That of leapfrog is
/// `v'(M - dt/2 D - dt^2/4 K)v + w'Kw`, w being the mean of two displacements about the current equilibrium and D the
/// damping that lags. It decreases while loads are constant, and a change of a load adds no more to its square root
/// than to that of the exact energy. At a share r of the stable step the matrix is at least `(1 - r) M`, so that
/// velocities are too large by at most `1/sqrt(1 - r)`. Symplectic Euler has the same recurrence; modified leapfrog has
/// it with a smaller K and `(1 - r)/4 M`; `cnn-stabilised` has at least `.0199 M` at any step. Powers of forward Euler
/// and `rk4` grow at first in a mode that is critically damped, by up to `1/(e (1 - r))`; `rk4`, which evaluates a load
/// at three instants of a step, amplifies a change less than five times as much. So the factor is `1/(1 - r)`, and at
/// least ten. At the stable step itself there is no bound: a leapfrog's fastest mode grows in proportion to the number
/// of steps.
///
/// A staggered method whose first half step does not resolve the mass damping, `alpha dt > 1`, starts with a
/// velocity that is too large by a polynomial in `alpha dt`, of degree 2 in modified leapfrog.
pub(super) fn room(share: f64, damping: f64) -> f64 {
    let beside_the_stable_step = 1.0 / (1.0 - share).max(f64::EPSILON);
    LEAST_ROOM
        .max(beside_the_stable_step)
        .max(damping * damping)
}

/// Bounds of the velocities in a system.
#[derive(Debug)]
pub(super) struct Bound {
    /// Square root of the mass of each cell (kg^1/2).
    root_mass: Vec<f64>,
    /// Size of each cell (m); empty if the system has none.
    size: Vec<f64>,
    loads: Vec<LoadStrength>,
}

impl Bound {
    pub(super) fn new(integrator: &'static str, system: &dyn System) -> Result<Self, SetupError> {
        let linear = system.as_linear().ok_or(SetupError::Lacks {
            integrator,
            needs: "the matrices of a linear system for saturation = \"auto\", whose limits hold for motion about rest (give a number \
                    instead)",
        })?;
        let operators = linear.operators();
        let loads = load_strengths(operators);
        if loads.iter().any(|load| !load.at(0.0).is_finite()) {
            return Err(SetupError::Lacks {
                integrator,
                needs: "a body with enough supports for saturation = \"auto\" (give a number instead)",
            });
        }
        let layers = system.layers().count();
        let components = operators.mass().chunks_exact(layers);
        let lightest = |cell: &[f64]| cell.iter().copied().fold(f64::INFINITY, f64::min);
        let scales = system.scales();
        Ok(Self {
            root_mass: components.map(|cell| lightest(cell).sqrt()).collect(),
            size: scales.map_or_else(Vec::new, |scales| scales.cell_size.to_vec()),
            loads,
        })
    }

    /// Writes the limit of each cell (m/s) for motion computed in steps of `dt` (s), the factor `room` times the bound
    /// by energy; returns the largest limit over the cell's size (1/s), 0 if the system has no sizes.
    pub(super) fn limits(&self, start: Option<Start>, dt: f64, room: f64, out: &mut [f64]) -> f64 {
        let start_strength = start.map_or(0.0, |start| (2.0 * start.energy).sqrt());
        let load_strength: f64 = self.loads.iter().map(|load| load.at(dt)).sum();
        let strength = room * (load_strength + start_strength);
        for (limit, root_mass) in out.iter_mut().zip(&self.root_mass) {
            *limit = strength / root_mass;
        }
        let rates = out.iter().zip(&self.size).map(|(limit, size)| limit / size);
        rates.fold(0.0, f64::max)
    }
}

/// Start of a motion from this state; `None` if the system shows no matrices.
pub(super) fn start(system: &dyn System, state: &State) -> Option<Start> {
    let operators = system.as_linear()?.operators();
    let energy = operators.energy(&state.u, &state.v).total();
    Some(Start {
        system: system.revision(),
        energy: energy.max(0.0),
    })
}

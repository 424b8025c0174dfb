//! The recurrence of two-step propagators as a program.

use sinew_cnn::{LoadAt, Loads, Program, Register, Sweep, When};
use sinew_core::{Acceleration, LinearOperators, SetupError, VelocityTime};

use super::first_step::FirstStep;
use super::resolution::ID;
use super::sweeps::ChebyshevVectors;

/// `v+ = e^(-2 eta) v- + G r/dt`, `r = M^-1 (F - K u)`, `u+ = u + dt v+`, for any polynomial G.
#[derive(Clone, Debug)]
pub(super) struct Recurrence {
    /// e^(-2 eta).
    pub(super) decay: f64,
    pub(super) first_step: FirstStep,
    /// Series of the effect of a jump of the load, for half the jump; empty without damping.
    pub(super) of_jump: Vec<f64>,
    /// Lambda (1/s^2), not below any eigenvalue of M^-1 K.
    pub(super) interval: f64,
    /// Step (s).
    pub(super) dt: f64,
    /// Time of the velocity after a step.
    pub(super) velocity: VelocityTime,
}

/// Registers of the sweeps that compute G r.
pub(super) struct KickRegisters<const N: usize> {
    pub(super) r: Register,
    /// The register that contains G r, up to a factor, after them.
    pub(super) sum: Register,
    /// The requested registers.
    pub(super) own: [Register; N],
    pub(super) vectors: ChebyshevVectors,
}

/// alpha (1/s) of a system that two-step forms support.
pub(super) fn mass_damping(operators: &LinearOperators) -> Result<f64, SetupError> {
    let damping = operators.damping();
    if damping.extra.is_some() || damping.stiffness != 0.0 {
        return Err(SetupError::Lacks {
            integrator: ID,
            needs: "mass damping at most for kind = \"two-step\"; \"chebyshev\" takes \
                    proportional damping, \"krylov\" any",
        });
    }
    Ok(damping.mass)
}

/// The sweep that computes r.
pub(super) fn net_force(at: LoadAt, r: Register) -> Sweep {
    Sweep::of_stiffness(1.0, Register::U, Loads::at(at)).then(r.becomes_q())
}

impl Recurrence {
    /// Time of the velocity for the largest angular frequency omega (rad/s) and a step of `dt` (s).
    pub(super) fn velocity_time(omega: f64, dt: f64) -> VelocityTime {
        match omega * dt <= 2.0 {
            true => VelocityTime::MiddleOfStep,
            false => VelocityTime::MeanOverStep,
        }
    }

    /// The step as a program, with registers of these names for the sweeps `kick`, after which `of_sum` times
    /// the register `sum` is G r.
    pub(super) fn program<const N: usize>(
        &self,
        of_sum: f64,
        names: [&'static str; N],
        kick: impl FnOnce(&mut Program, &KickRegisters<N>) -> Vec<Sweep>,
    ) -> Program {
        let dt = self.dt;
        let (u, v, a) = (Register::U, Register::V, Register::A);
        let mut program = Program::new(self.velocity);
        program.acceleration = Acceleration::Kick;
        let [r, sum] = ["r", "sum"].map(|name| program.register(name));
        let own = names.map(|name| program.register(name));
        let room = ["c", "d"].map(|name| program.register(name));
        let interval = self.interval;
        let registers = KickRegisters {
            r,
            sum,
            own,
            vectors: ChebyshevVectors { interval, room },
        };
        let vectors = &registers.vectors;

        let FirstStep {
            of_velocity,
            of_force,
        } = &self.first_step;
        let first = sum.becomes([(v, of_velocity[0]), (r, of_force[0])]);
        program.start.push(net_force(LoadAt::From, r).then(first));
        for (start, series) in [(v, of_velocity), (r, of_force)] {
            let add = |k: usize, x| vec![sum.plus(series[k], x)];
            let sweeps = vectors.sweeps(start, series.len(), When::Always, add);
            program.start.extend(sweeps);
        }
        // The acceleration that leads from v to the mean velocity of the step.
        let kicked = a.becomes([(sum, 2.0 / (dt * dt)), (v, -2.0 / dt)]);
        let last = Sweep::local().then(kicked.in_last_step());
        let last = last.then(v.becomes([(sum, 1.0 / dt)]));
        program.start.push(last.then(u.plus(dt, v)));

        let mut sweeps = kick(&mut program, &registers);
        if let Some(last) = sweeps.last_mut() {
            last.updates.push(a.becomes([(v, 1.0)]).in_last_step());
            let kick = v.becomes([(v, self.decay), (sum, of_sum / dt)]);
            last.updates.push(kick);
        }
        if let Some(first) = self.of_jump.first() {
            let add = |k: usize, x| vec![v.plus(self.of_jump[k] / dt, x)];
            let jump = Sweep::of_stiffness(0.0, u, Loads::HalfJump).without_neighbours();
            let jump = jump.when(When::LoadsJump).then(r.becomes_q());
            sweeps.push(jump.then(v.plus(first / dt, r)));
            let terms = self.of_jump.len();
            sweeps.extend(vectors.sweeps(r, terms, When::LoadsJump, add));
        }
        let taken = a.becomes([(a, -1.0 / dt), (v, 1.0 / dt)]);
        let last = Sweep::local().then(taken.in_last_step());
        sweeps.push(last.then(u.plus(dt, v)));
        program.step = sweeps;
        program
    }
}

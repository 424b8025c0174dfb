//! A guard's clamp as a part of a program.

use std::sync::Arc;

use sinew_core::{Acceleration, VelocityTime};

use super::{Clamp, Program, Register, Sweep};

impl Program {
    /// This program with each cell's velocity clamped to its limit (m/s) after a step of `dt` (s), and its
    /// displacement since the beginning of the step to limit times `dt`. Nothing changes while no
    /// limit is reached.
    #[must_use]
    pub fn guarded(&self, limits: Arc<[f64]>, dt: f64) -> Self {
        let mut guarded = self.clone();
        let before = guarded.register("u0");
        let unclamped = guarded.register("v0");
        let keeps = guarded.acceleration == Acceleration::Kick;
        let first = match guarded.velocity {
            VelocityTime::MiddleOfStep | VelocityTime::MeanOverStep => dt / 2.0,
            VelocityTime::Same => dt,
        };
        for (sweeps, time) in [(&mut guarded.start, first), (&mut guarded.step, dt)] {
            clamp(sweeps, dt, before, keeps.then_some((unclamped, time)));
        }
        guarded.limits = Some(limits);
        guarded
    }
}

/// Adds the clamp to the sweeps of a step. `kept` is a register for the velocity before the clamp, and the time between
/// the step's two velocities (s), if an acceleration is kept.
fn clamp(sweeps: &mut [Sweep], dt: f64, before: Register, kept: Option<(Register, f64)>) {
    let (u, v, a) = (Register::U, Register::V, Register::A);
    let moves = |sweep: &&mut Sweep| sweep.updates.iter().any(|update| update.target == u);
    if let Some(first) = sweeps.iter_mut().find(moves) {
        first.updates.insert(0, before.becomes([(u, 1.0)]));
    }
    let Some(last) = sweeps.last_mut() else {
        return;
    };
    // What follows from u and v follows from their clamped values.
    let follows = |update: &super::Update| {
        ![u, v, a, before].contains(&update.target)
            && update
                .terms
                .iter()
                .all(|term| [u, v].contains(&term.register))
            && update.of_q == 0.0
            && update.clamp.is_none()
    };
    let tail = last
        .updates
        .iter()
        .rev()
        .take_while(|update| follows(update));
    let tail = last.updates.split_off(last.updates.len() - tail.count());
    if let Some((unclamped, _)) = kept {
        last.updates
            .push(unclamped.becomes([(v, 1.0)]).in_last_step());
    }
    let vector = |from, factor| Some(Clamp::Vector { from, factor });
    last.updates
        .push(v.becomes([(v, 1.0)]).clamped(vector(None, 1.0)));
    last.updates
        .push(u.becomes([(u, 1.0)]).clamped(vector(Some(before), dt)));
    if let Some((unclamped, time)) = kept {
        // What the clamp took from the velocity it takes from the acceleration that produced it. The difference comes
        // first, so that 0 stays 0.
        let taken = unclamped.becomes([(v, 1.0), (unclamped, -1.0)]);
        last.updates.push(taken.in_last_step());
        last.updates
            .push(a.plus(1.0 / time, unclamped).in_last_step());
    }
    last.updates.extend(tail);
}

//! Detection of growth of the energy beyond the work of loads and supports.

use sinew_core::vectors::{dot, weighted_dot};
use sinew_core::{ElasticLaw, LoadTime, State, Step, StepReport, Trial};

/// Growth over the whole energy that the start, loads and supports transferred, above which it is reported.
const TOLD: f64 = 0.05;

/// Sums up the energy that a motion may have: its initial energy, and the work of loads and supports. Damping, which
/// removes energy, is left out, so that growth is found late with much damping. The sum restarts with each motion: the
/// only effect on results is a remark.
pub(super) struct EnergyWatch {
    integrator: &'static str,
    /// Displacement (m) at the beginning of the last step, and the mean load (N) over that step with that displacement.
    before: Vec<f64>,
    load: Vec<f64>,
    /// Load (N) at the beginning of the step.
    start_load: Vec<f64>,
    buffer: Vec<f64>,
    /// Time at which the last step ends (s).
    expected: Option<f64>,
    start: f64,
    work: f64,
    /// Sum of the sizes of all work (J).
    turnover: f64,
    /// Elastic energy (J) at the beginning of the step.
    elastic: f64,
    worst: Option<Growth>,
}

/// Energy beyond what a motion may have.
#[derive(Clone, Copy, Debug)]
struct Growth {
    t: f64,
    energy: f64,
    allowed: f64,
    share: f64,
}

impl EnergyWatch {
    pub(super) fn new(integrator: &'static str, dofs: usize) -> Self {
        let zeros = || vec![0.0; dofs];
        Self {
            integrator,
            before: zeros(),
            load: zeros(),
            start_load: zeros(),
            buffer: zeros(),
            expected: None,
            start: 0.0,
            work: 0.0,
            turnover: 0.0,
            elastic: 0.0,
            worst: None,
        }
    }

    /// Checks the state before a step; returns its elastic energy (J) and forces (N), if they were computed.
    pub(super) fn look(
        &mut self,
        step: &Step<'_>,
        state: &State,
        law: &dyn ElasticLaw,
        force: &mut [f64],
        report: &mut StepReport,
    ) -> Option<f64> {
        if !state.internal.is_empty() {
            // What memory stores and what it dissipates are not distinguished.
            return None;
        }
        let t = state.t();
        let ends = LoadTime::at_both_ends(t, step.dt, 0.5).map(|when| when.under(step.inputs));
        let trial = Trial::of(state, ends[0]);
        report.sweeps += 1;
        let Ok(deformed) = law.elastic_force(&trial, force) else {
            self.expected = None;
            return None;
        };
        self.elastic = deformed.energy;
        step.system
            .external_force(ends[0], &state.u, &mut self.start_load);
        let kinetic = 0.5 * weighted_dot(step.system.mass(), &state.v, &state.v);
        let energy = kinetic + deformed.energy;
        if self.expected == Some(t) {
            if law.loads_follow() {
                // What they have changed by with the surface.
                step.system
                    .external_force(ends[0], &self.before, &mut self.buffer);
                let values = self.start_load.iter().zip(&self.buffer);
                for (load, (now, then)) in self.load.iter_mut().zip(values) {
                    *load += 0.5 * (now - then);
                }
            }
            for (before, u) in self.before.iter_mut().zip(&state.u) {
                *before = u - *before;
            }
            self.take_up(dot(&self.load, &self.before));
            self.judge(t, energy);
        } else {
            (self.start, self.work, self.turnover) = (energy, 0.0, energy.abs());
        }
        step.system
            .external_force(ends[1], &state.u, &mut self.buffer);
        for ((load, start), end) in self.load.iter_mut().zip(&self.start_load).zip(&self.buffer) {
            *load = 0.5 * (start + end);
        }
        self.before.copy_from_slice(&state.u);
        let mut end = state.clock;
        end.advance(step.dt);
        self.expected = Some(end.time());
        Some(deformed.energy)
    }

    /// Adds the work of supports that move in the step, from the elastic energy (J) of the displacement before the step
    /// with the supports after it.
    pub(super) fn supports(&mut self, elastic: f64) {
        self.take_up(elastic - self.elastic);
    }

    /// Restarts with the next step, after one in which the work of supports is not known.
    pub(super) fn restart(&mut self) {
        self.expected = None;
    }

    fn take_up(&mut self, work: f64) {
        self.work += work;
        self.turnover += work.abs();
    }

    fn judge(&mut self, t: f64, energy: f64) {
        let allowed = self.start + self.work;
        let share = (energy - allowed) / self.turnover;
        if share > self.worst.map_or(TOLD, |worst| worst.share) {
            self.worst = Some(Growth {
                t,
                energy,
                allowed,
                share,
            });
        }
    }

    /// Description of the growth of the energy, if there was any.
    pub(super) fn remark(&self) -> Option<String> {
        self.worst.map(|worst| {
            format!(
                "the energy grew by itself: {:.3e} J at t = {:.6} s, where start, loads and supports account for {:.3e} J; \
                 `{}` does not keep the energy of nonlinear laws in long steps; `generalized-alpha` with rho_inf = 0.8 or \
                 less, `cnn-energy` and shorter steps do better",
                worst.energy, worst.t, worst.allowed, self.integrator
            )
        })
    }
}

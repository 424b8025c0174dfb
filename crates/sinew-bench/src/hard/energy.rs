//! The energy of a run, step by step, in the form that its method conserves.

use sinew_core::vectors::{dot, larger};
use sinew_core::{LinearOperators, LoadTime, Moment, RecordError, Recorder, State, Verdict};
use sinew_integrators::ConservedEnergy;

/// Follows energy and work through a run. It must receive every step.
///
/// For leapfrog methods `E+ = E- + dt w'(F - D w)`, w being the mean of two velocities (multiply
/// the step by w; the products with K telescope): the energy never exceeds the first one and the
/// work of the loads. P itself is not needed: `P v` is the sum of the forces so far.
#[derive(Debug)]
pub(crate) struct Ledger<'a> {
    operators: &'a LinearOperators,
    form: ConservedEnergy,
    before: Option<State>,
    /// P v.
    momentum: Vec<f64>,
    work: f64,
    start: f64,
    first: f64,
    /// The energies found so far.
    pub(crate) found: Energies,
}

/// Energies of a run (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Energies {
    /// Largest relative change of the energy since the first step.
    pub(crate) change: f64,
    /// Relative change of the energy from the first to the last step.
    pub(crate) drift: f64,
    /// Largest excess of the energy over that at the start and the work since, as a share of the
    /// largest energy that was allowed so far.
    pub(crate) excess: f64,
    largest_allowed: f64,
}

impl<'a> Ledger<'a> {
    /// A ledger of a method that conserves this energy.
    pub(crate) fn new(operators: &'a LinearOperators, form: ConservedEnergy) -> Self {
        Self {
            operators,
            form,
            before: None,
            momentum: Vec::new(),
            work: 0.0,
            start: 0.0,
            first: 0.0,
            found: Energies::default(),
        }
    }

    fn external_force(&self, when: LoadTime) -> Vec<f64> {
        let mut force = vec![0.0; self.operators.dofs()];
        self.operators.external_force(when, &mut force);
        force
    }

    /// `x' K x`.
    fn stretching(&self, x: &[f64]) -> f64 {
        let mut force = vec![0.0; x.len()];
        self.operators.stiffness().multiply(x, &mut force);
        dot(x, &force)
    }

    fn add(&mut self, before: &State, state: &State) {
        let (t, dt) = (before.t(), length_of_step(before, state));
        let energy = if self.form == ConservedEnergy::Physical {
            let moved = state.u.iter().zip(&before.u);
            let [start, end] =
                LoadTime::at_both_ends(t, dt, 0.5).map(|when| self.external_force(when));
            let loads = start.iter().zip(&end);
            let work = moved
                .zip(loads)
                .map(|((u, before), (start, end))| 0.5 * (start + end) * (u - before));
            self.work += work.sum::<f64>();
            self.operators.energy(&state.u, &state.v).total()
        } else {
            self.leapfrog(before, state)
        };
        let first_step = t == 0.0;
        if first_step {
            self.first = energy;
        }
        let found = &mut self.found;
        found.drift = energy / self.first - 1.0;
        found.change = larger(found.change, found.drift.abs());
        let allowed = self.start + self.work;
        found.largest_allowed = found.largest_allowed.max(allowed);
        if energy > allowed || energy.is_nan() {
            let excess = (energy - allowed) / found.largest_allowed;
            found.excess = larger(found.excess, excess);
        }
    }

    /// The energy of the step between two displacements, and the work up to its middle.
    fn leapfrog(&mut self, before: &State, state: &State) -> f64 {
        let (t, dt) = (before.t(), length_of_step(before, state));
        let n = state.u.len();
        let start = t == 0.0;
        let load = self.external_force(LoadTime::around(t, if start { 0.0 } else { dt }, dt));
        let mut force = load.clone();
        let mut damping = vec![0.0; n];
        self.operators
            .stiffness()
            .subtract_product(&before.u, &mut force);
        self.operators.subtract_damping(&before.v, &mut damping);
        // The first velocity is reached within half a step, which for the stabilised form knows
        // only the damping that lags.
        let share = if start { 0.5 * dt } else { dt };
        if start {
            self.momentum = before
                .v
                .iter()
                .zip(self.operators.mass())
                .map(|(v, m)| m * v)
                .collect();
        }
        let mass_damping = self.operators.damping().mass;
        let lagging = match self.form {
            ConservedEnergy::Stabilised { lagging } => lagging,
            ConservedEnergy::CentralDifference | ConservedEnergy::Physical => 0.0,
        };
        for i in 0..n {
            let damping = if start {
                let of_mass = mass_damping * self.operators.mass()[i] * before.v[i];
                lagging * (damping[i] + of_mass)
            } else {
                damping[i]
            };
            self.momentum[i] += share * (force[i] + damping);
        }
        let velocities = state.v.iter().zip(&before.v);
        let moved = velocities.map(|(v, before)| 0.5 * share * (v + before));
        self.work += moved.zip(&load).map(|(d, f)| d * f).sum::<f64>();

        if self.form == ConservedEnergy::CentralDifference {
            let factor = 1.0 + 0.5 * dt * self.operators.damping().mass;
            let mass = self.operators.mass().iter();
            self.momentum = state
                .v
                .iter()
                .zip(mass)
                .map(|(v, m)| factor * m * v)
                .collect();
        }
        let mut lost = vec![0.0; n];
        self.operators.subtract_damping(&state.v, &mut lost);
        let mean: Vec<f64> = state
            .u
            .iter()
            .zip(&before.u)
            .map(|(a, b)| 0.5 * (a + b))
            .collect();
        let kinetic = dot(&state.v, &self.momentum) + 0.5 * dt * dot(&state.v, &lost)
            - 0.25 * dt * dt * self.stretching(&state.v);
        0.5 * (kinetic + self.stretching(&mean))
    }
}

impl Recorder for Ledger<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        Some(step)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let state = moment.state;
        match self.before.take() {
            None => {
                self.start = self.operators.energy(&state.u, &state.v).total();
                self.found.largest_allowed = self.start;
                self.before = Some(state.clone());
            }
            Some(mut before) => {
                self.add(&before, state);
                before.clone_from(state);
                self.before = Some(before);
            }
        }
        Ok(Verdict::Continue)
    }
}

/// The time (s) between two states. The difference of their times has the rounding error of the later one, which
/// affects the energy far beyond the critical step.
fn length_of_step(before: &State, state: &State) -> f64 {
    let difference = state.t() - before.t();
    let same = |dt: &f64| (dt / difference - 1.0).abs() <= 1e-6;
    state.clock.last_step().filter(same).unwrap_or(difference)
}

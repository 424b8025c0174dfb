//! Energy and shape of a body that follows a force law, step by step.

use sinew_core::vectors::{dot, weighted_dot};
use sinew_core::{ElasticLaw, LoadTime, Moment, Trial};
use sinew_scene::Simulation;

/// Watches the energy of a motion and its smallest element.
///
/// The work of loads is computed with the mean of both ends of a step, as in the energy balance of a run. Damping,
/// which removes energy, is not included, so that a rise under damping is found late.
pub(crate) struct DeformationWatch<'a> {
    law: &'a dyn ElasticLaw,
    /// True if all energy comes from the start and from loads: no support moves.
    knows_energy: bool,
    smallest_volume_ratio: f64,
    /// Work (J) of contact on the body, until the last step.
    work_of_contact: f64,
    /// Displacement (m) and load (N) at the last step, none before the first.
    last: Option<(f64, Vec<f64>)>,
    /// Energy of the start and work of loads and tools since (J).
    allowed: f64,
    largest_allowed: f64,
    rise: f64,
    v: Vec<f64>,
    force: Vec<f64>,
}

impl<'a> DeformationWatch<'a> {
    /// A watch, for bodies that follow a force law with an energy.
    pub(crate) fn of(simulation: &'a Simulation) -> Option<Self> {
        let system = simulation.system();
        if system.as_linear().is_some() {
            return None;
        }
        let body = simulation.model().body()?;
        let zeros = || vec![0.0; system.dofs()];
        Some(Self {
            law: system.as_elastic()?,
            knows_energy: body.problem.moves.is_empty(),
            work_of_contact: 0.0,
            smallest_volume_ratio: f64::INFINITY,
            last: None,
            allowed: 0.0,
            largest_allowed: 0.0,
            rise: 0.0,
            v: zeros(),
            force: zeros(),
        })
    }

    /// Checks the state after a step. States that the law refuses are ignored: the run ends there automatically.
    pub(crate) fn look(&mut self, moment: &Moment<'_>) {
        let state = moment.state;
        let trial = Trial::of(state, LoadTime::at(state.t()));
        let Ok(deformed) = self.law.elastic_force(&trial, &mut self.force) else {
            return;
        };
        self.smallest_volume_ratio = self
            .smallest_volume_ratio
            .min(deformed.smallest_volume_ratio);
        if !self.knows_energy || moment.velocity(&mut self.v).is_err() {
            return;
        }
        let energy = deformed.energy + 0.5 * weighted_dot(moment.system.mass(), &self.v, &self.v);
        match &mut self.last {
            None => {
                self.allowed = energy;
                self.last = Some((state.t(), state.u.clone()));
            }
            Some((t, u)) => {
                let ends = LoadTime::at_both_ends(*t, state.t() - *t, 0.5);
                for (end, at) in ends.into_iter().zip([&u[..], &state.u]) {
                    moment.system.external_force(end, at, &mut self.force);
                    self.allowed += 0.5 * (dot(&self.force, &state.u) - dot(&self.force, u));
                }
                let contact = moment.system.contact();
                let work = contact.map_or(0.0, |contact| contact.work(state));
                self.allowed += work - std::mem::replace(&mut self.work_of_contact, work);
                *t = state.t();
                u.copy_from_slice(&state.u);
            }
        }
        self.largest_allowed = self.largest_allowed.max(self.allowed.abs());
        self.rise = self.rise.max(energy - self.allowed);
    }

    /// The smallest ratio of an element's volume to that at rest so far.
    pub(crate) fn smallest_volume_ratio(&self) -> f64 {
        self.smallest_volume_ratio
    }

    /// Largest excess so far of the energy over the supplied energy (that of the start and the work of loads), as a
    /// share of its maximum; `None` if moving supports supply energy too.
    pub(crate) fn energy_rise(&self) -> Option<f64> {
        (self.knows_energy && self.largest_allowed > 0.0).then(|| self.rise / self.largest_allowed)
    }
}

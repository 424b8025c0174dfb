//! Stable steps that are followed by the fastest wave.

use sinew_core::{Damping, ElasticLaw, LoadTime, StepCut, System, Trial};

/// Share of the stable step up to which parts stay as they are; of those that are longer more are made, so that they are within the margin.
pub(super) const KEPT: f64 = 0.95;

/// A stable step with the fastest wave that goes with it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    /// The stable step (s).
    pub(super) limit: f64,
    /// The square (1/s^2) of the fastest wave; 0 where none tells.
    pub(super) wave: f64,
}

impl Known {
    /// By the last look.
    pub(super) fn of(cut: &StepCut) -> Self {
        Self {
            limit: cut.stable_step,
            wave: cut.wave,
        }
    }

    /// The stable step (s) with another wave; that of slower ones does not count as longer. It is taken to fall with the power 3/4 of the square, in place of the
    /// root: motions that are no plane waves may become faster than these.
    pub(super) fn limit_at(self, wave: f64) -> f64 {
        self.limit / (wave / self.wave).max(1.0).powf(0.75)
    }

    /// True if parts of this length (s) are surely stable with this wave.
    pub(super) fn allows(self, wave: f64, part: f64) -> bool {
        // Comparisons that are false for what is not a number.
        wave > 0.0 && self.wave > 0.0 && part <= KEPT * self.limit_at(wave)
    }
}

/// The law of a system whose fastest wave tells about stable steps: without damping that goes by the stiffness, and without loads that follow the surface.
pub(super) fn followed(system: &dyn System) -> Option<&dyn ElasticLaw> {
    let law = system.as_elastic()?;
    let Damping {
        stiffness, extra, ..
    } = law.damping();
    (*stiffness == 0.0 && extra.is_none() && !law.loads_follow()).then_some(law)
}

pub(super) fn wave_at_rest(system: &dyn System) -> f64 {
    let rest = vec![0.0; system.dofs()];
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u: &rest,
        v: &rest,
        internal: &[],
    };
    let wave = followed(system).map(|law| law.fastest_wave(&trial));
    wave.and_then(Result::ok).flatten().unwrap_or(0.0)
}

//! Stable steps that are updated by means of the fastest wave.

use sinew_core::{Damping, ElasticLaw, LoadTime, StepCut, System, Trial};

/// Share of the stable step up to which substeps stay unchanged; longer ones are divided into more, so that they are
/// within the margin.
pub(super) const KEPT: f64 = 0.95;

/// A stable step with the corresponding fastest wave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    /// The stable step (s).
    pub(super) limit: f64,
    /// The square (1/s^2) of the fastest wave; 0 if unknown.
    pub(super) wave: f64,
}

impl Known {
    /// The values of the last check.
    pub(super) fn of(cut: &StepCut) -> Self {
        Self {
            limit: cut.stable_step,
            wave: cut.wave,
        }
    }

    /// The stable step (s) for another fastest wave; slower waves do not count as a longer step. The step is assumed to
    /// fall with the power 3/4 of the square instead of its root: motions that are no plane waves may become faster
    /// than plane waves.
    pub(super) fn limit_at(self, wave: f64) -> f64 {
        self.limit / (wave / self.wave).max(1.0).powf(0.75)
    }

    /// True if substeps of this length (s) are surely stable with this wave.
    pub(super) fn allows(self, wave: f64, part: f64) -> bool {
        // Comparisons that are false for what is not a number.
        wave > 0.0 && self.wave > 0.0 && part <= KEPT * self.limit_at(wave)
    }
}

/// Returns the law of a system whose fastest wave determines stable steps: without damping that depends on the
/// stiffness, and without loads that follow the surface.
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

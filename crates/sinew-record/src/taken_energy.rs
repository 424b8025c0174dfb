//! Energy that a method dissipates numerically.

use serde::{Deserialize, Serialize};
use sinew_scene::SceneBody;

use crate::balance::Energies;
use crate::fast_loads::unseen;
use crate::made_energy::{THERMAL, keeper};

/// Share of the supplied energy above which it is reported.
const MUCH: f64 = 0.1;

/// The largest dissipated energy (J), and the largest supplied energy, over all checks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Taken {
    taken: f64,
    pub(crate) given: f64,
    /// The longest time (s) between two checks.
    #[serde(default)]
    pub(crate) span: f64,
}

impl Taken {
    /// Records a row.
    pub(crate) fn see(&mut self, row: &Energies) {
        self.taken = self.taken.max(row.taken.unwrap_or(0.0));
        self.given = self.given.max(row.given);
        self.span = self.span.max(row.span);
    }

    /// A warning if the method dissipated a large part of the energy, with a method that conserves it. `methods` names
    /// the methods of the steps.
    pub(crate) fn in_words(
        self,
        body: &SceneBody,
        methods: &str,
        saturates: bool,
    ) -> Option<String> {
        let Self { taken, given, span } = self;
        let clamp = if saturates {
            ", whose velocities were saturated,"
        } else {
            ""
        };
        (taken > MUCH * given && taken > THERMAL).then(|| {
            let told = format!(
                "{methods}{clamp} took {taken:.3e} J of the {given:.3e} J that were put in, {:.0} %: the method, not the tissue, damps this part of the motion; \
                 {} keeps it",
                100.0 * taken / given,
                keeper(body, saturates)
            );
            unseen(body, span).unwrap_or(told)
        })
    }
}

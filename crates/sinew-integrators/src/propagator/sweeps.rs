//! Chebyshev series as sweeps of a network.

use sinew_cnn::{Loads, Register, Sweep, Update, When};

/// `T_k(B) x` with `B = (2/Lambda) M^-1 K - 1`, one k after the other: by `T_k+1 = 2 B T_k - T_k-1` and
/// `T_1 = B T_0`.
pub(super) struct ChebyshevVectors {
    /// Lambda (1/s^2), not below any eigenvalue of M^-1 K.
    pub(super) interval: f64,
    /// Registers of the vectors of odd and even k.
    pub(super) room: [Register; 2],
}

impl ChebyshevVectors {
    /// The sweeps for k = 1 up to, but not at, `terms`. x is stored in `start`; `each(k, vector)` gives the updates
    /// that use a vector.
    pub(super) fn sweeps<'a>(
        &'a self,
        start: Register,
        terms: usize,
        when: When,
        each: impl Fn(usize, Register) -> Vec<Update> + 'a,
    ) -> impl Iterator<Item = Sweep> + 'a {
        let [odd, even] = self.room;
        (1..terms).map(move |k| {
            let (current, next) = match k {
                1 => (start, odd),
                _ if k % 2 == 0 => (odd, even),
                _ => (even, odd),
            };
            let turn = match k {
                1 => next.becomes([(start, -1.0)]).and_q(1.0),
                2 => next.becomes([(start, -1.0), (current, -2.0)]).and_q(2.0),
                _ => next.becomes([(next, -1.0), (current, -2.0)]).and_q(2.0),
            };
            let sweep = Sweep::of_stiffness(-2.0 / self.interval, current, Loads::None);
            let mut sweep = sweep.when(when).then(turn);
            sweep.updates.extend(each(k, next));
            sweep
        })
    }
}

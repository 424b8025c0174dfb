//! Step formulas.

/// A step formula with its weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// The implicit Euler method: order 1, with numerical damping.
    ImplicitEuler,
    /// The trapezoidal rule (Newmark's method with beta = 1/4 and gamma = 1/2): order 2.
    #[default]
    Trapezoidal,
}

impl Kind {
    /// Weights of M and D, as quadratic forms of the displacement over a step of `dt` (s), in the step's potential.
    pub(super) fn weights(self, dt: f64) -> [f64; 2] {
        match self {
            Self::ImplicitEuler => [1.0 / dt / dt, 1.0 / dt],
            Self::Trapezoidal => [4.0 / dt / dt, 2.0 / dt],
        }
    }

    /// The velocity (m/s) after a degree of freedom with the velocity `v` moved by `y` (m) in `dt` (s).
    pub(super) fn velocity(self, v: f64, y: f64, dt: f64) -> f64 {
        match self {
            Self::ImplicitEuler => y / dt,
            Self::Trapezoidal => 2.0 * y / dt - v,
        }
    }
}

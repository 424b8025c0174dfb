//! The quadratic terms of a step's potential, which are the same for all laws.

use sinew_core::vectors::add_scaled;

/// `m/2 y'M y + d/2 y'D y - b'y`, y being the displacement over the step: the potential of a step without `W`.
pub(super) struct Quadratic<'a> {
    /// M (kg).
    pub(super) masses: &'a [f64],
    /// m (1/s^2).
    pub(super) mass_weight: f64,
    /// d (1/s).
    pub(super) damping_weight: f64,
    /// b (N).
    pub(super) pull: &'a [f64],
}

impl Quadratic<'_> {
    /// The gradient (N) of the potential at a displacement y (m), from D y (N) if there is damping, and the law's force
    /// (N) there.
    pub(super) fn write_slope(
        &self,
        (moved, damped): (&[f64], Option<&[f64]>),
        force: &[f64],
        out: &mut [f64],
    ) {
        let values = moved.iter().zip(self.masses).zip(self.pull);
        let values = values.zip(force).zip(&mut *out);
        for ((((moved, mass), pull), force), slope) in values {
            *slope = self.mass_weight * mass * moved - pull + force;
        }
        if let Some(damped) = damped {
            add_scaled(self.damping_weight, damped, out);
        }
    }
}

//! The first step of the two-step form.

use sinew_core::closed_form::Mode;

use super::series::{evaluate, interpolate, nodes};

/// Series of `s(M^-1 K)` and `g(M^-1 K)` in `u+ = u + s v + g r`, `r = M^-1 (F - K u)`, with the recurrence's
/// polynomial S instead of `sin(w dt/2)/(w/2)` and a polynomial C instead of `cos(w dt/2)`: `s = e^-eta S C` and
/// `lambda g = 1 - e^-eta (1 - w^2 S^2/2 + alpha/2 S C)`, with `w^2 = lambda - alpha^2/4`.
///
/// A first step with the exact s would not fit: at a zero of S that is not a zero of the sine, the recurrence hardly
/// changes the phase of a mode that this step moves, and its amplitude becomes large. With S in s that cannot happen.
#[derive(Clone, Debug)]
pub(super) struct FirstStep {
    pub(super) of_velocity: Vec<f64>,
    pub(super) of_force: Vec<f64>,
}

impl FirstStep {
    /// The first step for the series S on 0..`interval` (1/s^2), the damping alpha (1/s), a step of `dt` (s) and
    /// e^-eta.
    pub(super) fn new(half_sine: &[f64], interval: f64, alpha: f64, dt: f64, decay: f64) -> Self {
        // The series of a cosine falls a degree later than that of a sine over its argument.
        let cosine = half_cosine(half_sine.len() + 1, interval, alpha, dt);
        let s_at_zero = evaluate(half_sine, 0.0, interval);
        // With this value at 0 lambda divides what it must, since e^-eta fits S(0).
        let shift = (alpha * s_at_zero / 4.0).hypot(1.0) - evaluate(&cosine, 0.0, interval);
        let count = 2 * half_sine.len();
        let at_nodes: Vec<(f64, f64)> = nodes(count, interval)
            .into_iter()
            .map(|lambda| {
                let s = evaluate(half_sine, lambda, interval);
                let product = s * (evaluate(&cosine, lambda, interval) + shift);
                let squared = lambda - alpha * alpha / 4.0;
                let kept = 1.0 - squared * s * s / 2.0 + alpha / 2.0 * product;
                (decay * product, (1.0 - decay * kept) / lambda)
            })
            .collect();
        let series = |count: usize, pick: fn(&(f64, f64)) -> f64| {
            let values: Vec<f64> = at_nodes.iter().map(pick).collect();
            let mut coefficients = vec![0.0; count];
            interpolate(&values, &mut coefficients);
            coefficients
        };
        Self {
            of_velocity: series(count, |(of_velocity, _)| *of_velocity),
            of_force: series(count - 1, |(_, of_force)| *of_force),
        }
    }
}

/// The first coefficients of the series of `cos(w dt/2)`.
fn half_cosine(count: usize, interval: f64, alpha: f64, dt: f64) -> Vec<f64> {
    let fine = 2 * count + 48;
    let values: Vec<f64> = nodes(fine, interval)
        .into_iter()
        .map(|lambda| {
            let mode = Mode {
                lambda: lambda - alpha * alpha / 4.0,
                damping: 0.0,
            };
            mode.impulse(dt / 2.0).1
        })
        .collect();
    let mut coefficients = vec![0.0; count];
    interpolate(&values, &mut coefficients);
    coefficients
}

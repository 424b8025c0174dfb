//! The first mode of a bar that is stretched and released.

use sinew_core::Integrator;
use sinew_integrators::Frame;
use sinew_integrators::implicit::Modal;
use sinew_measure::{Case, MethodChoice};

use super::{at, trajectory};
use crate::hard::mark::Asked;
use crate::hard::methods::{block, chebyshev};
use crate::report::percent;
use crate::results::Mark;
use sinew_verify::LabError;

/// Frequency and amplitude of the first mode as relative distances from those of the modal solution: for the method
/// nearest to both.
pub(crate) fn check(
    frequency: Asked,
    amplitude: Asked,
    case: &Case,
    dt: f64,
) -> Result<[Mark; 2], LabError> {
    let system = case.simulation().system();
    let start = case.simulation().initial_state();
    let mut modal = Frame::new(Modal::with_modes(1));
    modal.prepare(system, dt)?;
    let omega = *modal
        .frequencies()
        .first()
        .ok_or_else(|| LabError::new("no mode was found"))?;
    let shape = modal
        .shape(0)
        .ok_or_else(|| LabError::new("no mode was found"))?;
    let share = |u: &[f64]| -> f64 {
        let terms = u.iter().zip(shape).zip(system.mass());
        terms.map(|((u, phi), mass)| phi * mass * u).sum()
    };
    let q0 = share(&start.u);

    let mut found = Vec::new();
    for method in [
        MethodChoice::new("central-difference"),
        block(),
        chebyshev(8),
        MethodChoice::new("newmark"),
    ] {
        let path = trajectory(system, start, &method, dt, case.run(dt).steps)?;
        let mut q = vec![q0];
        q.extend(path.iter().map(|u| share(u)));
        let (measured_omega, measured_amplitude) = oscillation(&q, dt);
        let off = |measured: f64, exact: f64| match (measured / exact - 1.0).abs() {
            off if off.is_nan() => f64::INFINITY,
            off => off,
        };
        found.push((
            at(&method.label(), dt),
            off(measured_omega, omega),
            off(measured_amplitude, q0.abs()),
        ));
    }
    let nearest = found
        .iter()
        .min_by(|a, b| a.1.max(a.2).total_cmp(&b.1.max(b.2)));
    let (by, off_omega, off_amplitude) =
        nearest.ok_or_else(|| LabError::new("no method or no step was given"))?;
    let shown = |figure: f64| format!("{} %", percent(figure));
    let others: Vec<String> = found
        .iter()
        .filter(|(other, ..)| other != by)
        .map(|(label, f, a)| format!("{label}: {}, {}", shown(*f), shown(*a)))
        .collect();
    let note = format!("frequency, amplitude of others: {}", others.join("; "));
    Ok([
        frequency.measured(*off_omega, shown, by).noting(&note),
        amplitude.measured(*off_amplitude, shown, by).noting(&note),
    ])
}

/// Angular frequency (rad/s) and amplitude of a sampled oscillation about 0, by least squares:
/// `q(n+1) + q(n-1) = 2 cos(omega dt) q(n)` first, then `q(n) = a cos(omega n dt) + b sin(omega n dt)`.
/// NaN if the samples grow or fall.
fn oscillation(q: &[f64], dt: f64) -> (f64, f64) {
    let (mut across, mut square) = (0.0, 0.0);
    for three in q.windows(3) {
        across += (three[0] + three[2]) * three[1];
        square += three[1] * three[1];
    }
    let omega = (0.5 * across / square).acos() / dt;
    let (mut cc, mut ss, mut cs, mut qc, mut qs) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (n, q) in q.iter().enumerate() {
        let (s, c) = (omega * n as f64 * dt).sin_cos();
        cc += c * c;
        ss += s * s;
        cs += c * s;
        qc += q * c;
        qs += q * s;
    }
    let determinant = cc * ss - cs * cs;
    let a = (qc * ss - qs * cs) / determinant;
    let b = (qs * cc - qc * cs) / determinant;
    (omega, a.hypot(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_oscillation_is_found() {
        let (omega, dt) = (28.5_f64, 0.005);
        let q: Vec<f64> = (0..200)
            .map(|n| 0.3 * (omega * f64::from(n) * dt + 0.7).cos())
            .collect();
        let (found, amplitude) = oscillation(&q, dt);
        assert!((found / omega - 1.0).abs() < 1e-12);
        assert!((amplitude - 0.3).abs() < 1e-12);
    }

    #[test]
    fn what_grows_is_no_oscillation() {
        let q: Vec<f64> = (0..50).map(|n| 1.3_f64.powi(n)).collect();
        assert!(oscillation(&q, 0.01).0.is_nan());
    }
}

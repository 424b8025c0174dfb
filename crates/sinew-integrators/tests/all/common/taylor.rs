//! Motion by the Taylor series in time, from nothing but M, K, alpha and constant loads.

use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearSystem, LoadTime};

/// Terms of the series: with `omega_max h <= 2` the next one is below 2^28/28! = 1e-21 of the motion.
const TERMS: u32 = 28;

/// Displacements at `count` further instants, `interval` (s) apart, of a body that starts at rest
/// under constant loads, damped in proportion to its mass only.
///
/// With `u_k = h^k/k! d^k u/dt^k` the equation of motion gives
/// `u_(k+2) = (h^2 M^-1 (F_k - K u_k) - alpha h (k + 1) u_(k+1)) / ((k + 1)(k + 2))`, where F_0 = F and
/// F_k = 0 beyond.
pub(crate) fn from_rest(system: &dyn LinearSystem, interval: f64, count: usize) -> Vec<Vec<f64>> {
    let operators = system.operators();
    let damping = operators.damping();
    assert!(damping.stiffness == 0.0 && damping.extra.is_none());
    let n = operators.dofs();
    let mut load = vec![0.0; n];
    operators.external_force(LoadTime::at(0.0), &mut load);
    // The critical step is 2/omega_max.
    let parts = (interval / Spectrum::of(operators).critical_step()).ceil();
    let h = interval / parts;
    let (mut u, mut v) = (vec![0.0; n], vec![0.0; n]);
    let mut instants = vec![u.clone()];
    for _ in 0..count {
        for _ in 0..parts as usize {
            let (mut now, mut next) = (u.clone(), v.iter().map(|v| h * v).collect::<Vec<_>>());
            let mut rate = next.clone();
            u.iter_mut().zip(&next).for_each(|(u, next)| *u += next);
            for k in 0..TERMS {
                let mut force = if k == 0 { load.clone() } else { vec![0.0; n] };
                operators.stiffness().subtract_product(&now, &mut force);
                let (below, above) = (f64::from(k + 1), f64::from(k + 2));
                for i in 0..n {
                    let pulled = h * h * force[i] / operators.mass()[i];
                    let slowed = damping.mass * h * below * next[i];
                    now[i] = (pulled - slowed) / (below * above);
                    u[i] += now[i];
                    // h v gathers k u_k.
                    rate[i] += above * now[i];
                }
                std::mem::swap(&mut now, &mut next);
            }
            v = rate.iter().map(|rate| rate / h).collect();
        }
        instants.push(u.clone());
    }
    instants
}

//! The two-step form with a polynomial fitted to the loads.

mod amplitude;
mod barrier;
mod constrained;
mod dense;
mod excitation;
mod start;

use sinew_cnn::{LoadAt, Program, When};
use sinew_core::spectrum::Spectrum;
use sinew_core::{Fact, LinearOperators, SetupError};

use self::constrained::Fit;
use self::excitation::Excitation;
use self::start::{Fitted, Start};
use super::chebyshev::LARGEST_EIGENVALUE_MARGIN;
use super::recurrence::{KickRegisters, Recurrence, mass_damping, net_force};
use super::resolution::{ID, Resolution};

/// Highest degree of G; a fit of a higher one takes long, and shorter steps need no more sweeps.
const HIGHEST_DEGREE: usize = 64;

/// Smallest phase change (rad) of the fastest mode in a step for which the interval is chosen.
const LEAST_TURN: f64 = 1e-3;

/// Distances from the double roots of the recurrence; the first that limits amplitudes is taken.
const ROOMS: [f64; 3] = [1e-9, 1e-3, 0.1];

/// Largest accepted amplitude of a mode, over that of the exact motion.
const WIDEST: f64 = 2.0;

/// The two-step form with its own polynomial G, `v+ = e^(-2 eta) v- + G(M^-1 K) M^-1 (F - K u)/dt`, of the smallest
/// error of a run under these loads.
///
/// The form is stable if `0 <= lambda G <= (1 + e^-eta)^2`, which holds, with some margin, for all lambda from 0 to the
/// largest; within these bounds G is fitted to `lambda G = 1 + e^(-2 eta) - 2 e^-eta cos(w dt)` by weighted least
/// squares. The weights are those of the loads' measure over the spectrum.
#[derive(Clone, Debug)]
pub(super) struct LoadFit {
    /// Series of G (s^2).
    g: Vec<f64>,
    recurrence: Recurrence,
    estimate: f64,
    amplitude: f64,
    products: usize,
}

impl LoadFit {
    /// Chooses the degree and fits the polynomial.
    pub(super) fn new(
        operators: &LinearOperators,
        dt: f64,
        resolution: Resolution,
    ) -> Result<Self, SetupError> {
        let alpha = mass_damping(operators)?;
        let omega = Spectrum::of(operators).omega_max;
        let interval = omega.powi(2) * (1.0 + LARGEST_EIGENVALUE_MARGIN);
        let interval = interval.max((LEAST_TURN / dt).powi(2));
        let Some(excitation) = Excitation::of(operators, interval, dt) else {
            return Err(SetupError::Lacks {
                integrator: ID,
                needs: "loads to fit to for fit = \"load\"; fit = \"uniform\" takes any motion",
            });
        };
        let fit = Fit {
            excitation: &excitation,
            interval,
            dt,
            top: (1.0 + (-alpha * dt / 2.0).exp()).powi(2),
        };
        let of = |degree: usize| {
            let mut fitted = Self::of_degree(&fit, degree, alpha, ROOMS[0]);
            for room in &ROOMS[1..] {
                if fitted.2.amplitude <= WIDEST {
                    break;
                }
                fitted = Self::of_degree(&fit, degree, alpha, *room);
            }
            fitted
        };
        let (estimate, g, start) = choose(resolution, dt, of)?;
        Ok(Self {
            estimate,
            amplitude: start.amplitude,
            products: excitation.products,
            recurrence: Recurrence {
                decay: (-alpha * dt).exp(),
                first_step: start.first_step,
                of_jump: start.of_jump,
                interval,
                dt,
                velocity: Recurrence::velocity_time(omega, dt),
            },
            g: g.into_iter().map(|g| g * dt * dt).collect(),
        })
    }

    fn of_degree(fit: &Fit<'_>, degree: usize, alpha: f64, room: f64) -> (f64, Vec<f64>, Start) {
        let g = fit.best(degree, room);
        let fitted = Fitted {
            g: &g,
            interval: fit.interval,
            alpha,
            dt: fit.dt,
            modes: &fit.excitation.modes,
        };
        let start = fitted.start();
        (fit.estimate(&g).hypot(start.error), g, start)
    }

    /// The step as a program.
    pub(super) fn program(&self) -> Program {
        self.recurrence.program(1.0, [], |_, with| {
            let KickRegisters {
                r, sum, vectors, ..
            } = with;
            let add = |k: usize, x| match k {
                0 => vec![sum.becomes([(x, self.g[0])])],
                _ => vec![sum.plus(self.g[k], x)],
            };
            let mut sweeps = vec![net_force(LoadAt::Around, *r)];
            sweeps[0].updates.extend(add(0, *r));
            sweeps.extend(vectors.sweeps(*r, self.g.len(), When::Always, add));
            sweeps
        })
    }

    pub(super) fn facts(&self) -> Vec<Fact> {
        let fact = |name, value| Fact { name, value };
        vec![
            fact("degree", (self.g.len() - 1) as f64),
            fact("estimated_error", self.estimate),
            fact("amplitude", self.amplitude),
            fact("products_for_the_fit", self.products as f64),
        ]
    }
}

/// A fit with its estimated error.
type Found = (f64, Vec<f64>, Start);

/// The fit of the given degree, or of the smallest, that meets the tolerance and limits amplitudes.
fn choose(
    resolution: Resolution,
    dt: f64,
    of: impl Fn(usize) -> Found,
) -> Result<Found, SetupError> {
    let meets = |(estimate, _, start): &Found| {
        *estimate <= resolution.tolerance && start.amplitude <= WIDEST
    };
    let unresolved = |degree: usize, (estimate, _, start): &Found, advice: &str| {
        Err(SetupError::Unresolved {
            integrator: ID,
            reason: format!(
                "with degree {degree} the estimated error of a run in steps of {dt} s is {estimate:.1e}, and the largest amplitude of any motion {:.2} times the exact one (at most {WIDEST} is taken); {advice}",
                start.amplitude
            ),
        })
    };
    if let Some(degree) = resolution.degree {
        let found = of(degree.min(HIGHEST_DEGREE));
        if meets(&found) {
            return Ok(found);
        }
        return unresolved(degree, &found, "take a higher degree or leave it out");
    }
    // The least degree that is known to be enough, after one that is known not to be.
    let (mut too_low, mut degree) = (0, 1);
    let mut enough = loop {
        let found = of(degree);
        if meets(&found) {
            break found;
        }
        if degree == HIGHEST_DEGREE {
            let advice = "take a shorter step or fit = \"uniform\"";
            return unresolved(degree, &found, advice);
        }
        too_low = degree;
        degree = (2 * degree).min(HIGHEST_DEGREE);
    };
    while degree - too_low > 1 {
        let middle = too_low.midpoint(degree);
        let found = of(middle);
        if meets(&found) {
            (degree, enough) = (middle, found);
        } else {
            too_low = middle;
        }
    }
    Ok(enough)
}

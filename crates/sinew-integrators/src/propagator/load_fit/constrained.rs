//! Weighted least squares for the polynomial of a two-step form that stays stable.

use std::f64::consts::PI;

use super::barrier::{Barrier, Bounds, Deviations, Row};
use super::excitation::Excitation;
use crate::propagator::peaks::{POINTS_PER_DEGREE, largest_value, least_value, tops};
use crate::propagator::series::evaluate;

/// Points per coefficient at which the fit is kept within its bounds.
const GUARDS_PER_TERM: usize = 8;

/// Squared weight of the whole spectrum relative to that of the loads: it determines the polynomial at eigenvalues that
/// loads do not excite.
const BACKGROUND: f64 = 1e-8;

/// Factor between the barriers of two stages.
const NARROWER: f64 = 0.2;

/// Duality gap over the squared error at which the fit ends.
const GAP: f64 = 1e-3;

/// Number of stages after which the fit ends in any case.
const MOST_STAGES: usize = 45;

/// Newton steps in a stage.
const NEWTON_STEPS: usize = 3;

/// Deviation for which the weights of the first stage are computed, and its growth from stage to stage.
const FIRST_DEVIATION: f64 = 1e-3;
const DEVIATION_GROWTH: f64 = 1.6;

/// Smallest deviation for which weights are computed.
const LEAST_DEVIATION: f64 = 1e-9;

/// Number of fits after which mixing enforces the bounds.
const EXCHANGES: usize = 3;

/// Points per coefficient at which turning points are sought.
const LOOKS_PER_TERM: usize = 2 * POINTS_PER_DEGREE;

/// The dimensionless form of G on x = lambda/Lambda from 0 to 1: `G = dt^2 sum_k g_k T_k(2x - 1)`.
pub(super) struct Fit<'a> {
    pub(super) excitation: &'a Excitation,
    /// Lambda (1/s^2).
    pub(super) interval: f64,
    pub(super) dt: f64,
    /// Largest value of lambda G: (1 + e^-eta)^2.
    pub(super) top: f64,
}

/// x at an angle: 1 at 0, 0 at pi.
fn x_of(angle: f64) -> f64 {
    0.5 + 0.5 * angle.cos()
}

impl Fit<'_> {
    /// lambda dt^2 at the upper end.
    fn reach(&self) -> f64 {
        self.interval * self.dt * self.dt
    }

    fn value(&self, g: &[f64], lambda: f64) -> f64 {
        self.reach() * lambda / self.interval * evaluate(g, lambda, self.interval)
    }

    /// The estimated error of a run.
    pub(super) fn estimate(&self, g: &[f64]) -> f64 {
        let at_zero = self.excitation.exact_at_zero() / (self.dt * self.dt);
        let off = evaluate(g, 0.0, self.interval) / at_zero - 1.0;
        self.excitation
            .estimate(|lambda| self.value(g, lambda), off)
    }

    /// The polynomial of the smallest estimated error with `room lambda/Lambda <= lambda G <= top - room` for the whole
    /// spectrum, `room` being a margin.
    pub(super) fn best(&self, degree: usize, room: f64) -> Vec<f64> {
        let asked = Bounds {
            least: room / self.reach(),
            most: self.top - room,
        };
        let points = GUARDS_PER_TERM * (degree + 1) + 16;
        let at = |point: usize| x_of(PI * point as f64 / points as f64);
        let mut guards: Vec<f64> = (0..=points).map(at).collect();
        let mut g = self.within_guards(degree, &guards, asked);
        // What lies between guards may pass the bounds: the turning points become guards (Remez's exchange).
        for _ in 0..EXCHANGES {
            let found = self.bounds(&g);
            if found.least >= asked.least && found.most <= asked.most {
                return g;
            }
            guards.extend(self.turning_points(&g));
            g = self.within_guards(degree, &guards, asked);
        }
        self.drawn_in(g, asked)
    }

    /// The smallest value of `G/dt^2` and the largest of `lambda G` on the interval.
    pub(super) fn bounds(&self, g: &[f64]) -> Bounds {
        let points = LOOKS_PER_TERM * g.len();
        let value = |angle: f64| self.value(g, self.interval * x_of(angle));
        Bounds {
            least: least_value(|angle| self.shape(g, angle), points),
            most: largest_value(|angle| value(angle).abs(), points),
        }
    }

    fn shape(&self, g: &[f64], angle: f64) -> f64 {
        evaluate(g, self.interval * x_of(angle), self.interval)
    }

    /// The points x at which lambda G has local maxima and G local minima.
    fn turning_points(&self, g: &[f64]) -> Vec<f64> {
        let points = LOOKS_PER_TERM * g.len();
        let above = |angle: f64| self.value(g, self.interval * x_of(angle));
        let below = |angle: f64| -self.shape(g, angle);
        let mut angles = tops(above, points);
        angles.extend(tops(below, points));
        angles.into_iter().map(x_of).collect()
    }

    /// Mixes in as much of a constant G in the middle of the bounds as the bounds require.
    fn drawn_in(&self, mut g: Vec<f64>, asked: Bounds) -> Vec<f64> {
        let found = self.bounds(&g);
        let middle = self.middle();
        let below = (asked.least - found.least) / (middle - found.least);
        let above = (found.most - asked.most) / (found.most - 0.5 * self.top);
        let share = below.max(above).clamp(0.0, 1.0);
        g.iter_mut().for_each(|g| *g *= 1.0 - share);
        g[0] += share * middle;
        g
    }

    /// A constant `G/dt^2` for which the final value of lambda G is half of its largest allowed value.
    fn middle(&self) -> f64 {
        self.top / (2.0 * self.reach())
    }

    /// The best polynomial that is within bounds at the guards, by a barrier method (Nocedal and Wright, Numerical
    /// Optimization, section 19.6). The error's weights are recomputed in each stage: once the phase of a mode is lost,
    /// a larger deviation of it does not count more.
    fn within_guards(&self, degree: usize, guards: &[f64], bounds: Bounds) -> Vec<f64> {
        let count = degree + 1;
        let guards: Vec<Row> = guards.iter().map(|x| Row::at(*x, count)).collect();
        let barrier = Barrier {
            guards: &guards,
            bounds,
            reach: self.reach(),
        };
        let mut deviations = self.deviations(count, &guards);
        let mut g = vec![0.0; count];
        g[0] = self.middle();
        let mut clip = FIRST_DEVIATION;
        let mut best = (f64::INFINITY, g.clone());
        self.weigh(&mut deviations, &g, clip);
        let terms = 2.0 * guards.len() as f64;
        let mut weight = deviations.sum(&g) / terms;
        for _ in 0..MOST_STAGES {
            for _ in 0..NEWTON_STEPS {
                if !barrier.newton_step(&deviations, weight, &mut g) {
                    break;
                }
            }
            let error = self.estimate(&g);
            if error <= best.0 {
                best = (error, g.clone());
            }
            if clip >= 1.0 && terms * weight <= GAP * deviations.sum(&g) {
                break;
            }
            weight *= NARROWER;
            clip *= DEVIATION_GROWTH;
            self.weigh(&mut deviations, &g, clip);
        }
        best.1
    }

    /// The deviations of modes, of a body that drifts and of the whole spectrum, without weights.
    fn deviations(&self, count: usize, guards: &[Row]) -> Deviations {
        let (excitation, reach) = (self.excitation, self.reach());
        let of = |x: f64| excitation.exact(x * self.interval) / (reach * x);
        let modes = excitation.modes.iter().map(|mode| {
            let x = mode.lambda / self.interval;
            (Row::at(x, count), of(x), 0.0)
        });
        let everywhere = guards.iter().filter(|guard| guard.x > 0.0).map(|guard| {
            let weight = BACKGROUND / guards.len() as f64 * (reach * guard.x).powi(2);
            (Row::at(guard.x, count), of(guard.x), weight)
        });
        let at_zero = excitation.exact_at_zero() / (self.dt * self.dt);
        let drift = if excitation.drifts { 1.0 } else { BACKGROUND };
        let drift = (Row::at(0.0, count), at_zero, drift / at_zero.powi(2));
        Deviations {
            rows: modes.chain(everywhere).chain([drift]).collect(),
        }
    }

    /// Weighs the modes for deviations of lambda G, clipped to `clip`.
    fn weigh(&self, deviations: &mut Deviations, g: &[f64], clip: f64) {
        let rows = deviations.rows.iter_mut().zip(&self.excitation.modes);
        for ((row, target, weight), mode) in rows {
            let scale = self.reach() * row.x;
            let exact = scale * *target;
            let off = scale * (row.value(g) - *target);
            let mut off = off.abs().clamp(LEAST_DEVIATION, clip).copysign(off);
            if !(0.0..=self.top).contains(&(exact + off)) {
                off = -off;
            }
            let error = self.excitation.error(mode.lambda, exact + off);
            *weight = mode.share * error / off.powi(2) * scale.powi(2);
        }
    }
}

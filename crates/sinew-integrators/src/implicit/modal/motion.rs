//! The exact motion of one mode under loads that are constant, linear or sinusoidal in time.

use std::f64::consts::{PI, TAU};

use sinew_core::Ramp;

use crate::exponential::Exponential;

/// A mode: q'' + damping q' + omega^2 q = force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mode {
    /// Undamped angular frequency (rad/s), 0 for a rigid motion.
    pub(super) omega: f64,
    /// alpha + beta omega^2 (1/s).
    pub(super) damping: f64,
}

/// Values of q and q' after a time h: a vector (q, q') for each of q = 1, q' = 1 and two forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Response {
    displacement: [f64; 2],
    velocity: [f64; 2],
    forces: [[f64; 2]; 2],
}

impl Response {
    /// The response under the forces 1 and tau/h.
    pub(super) fn to_linear(mode: Mode, h: f64, room: &mut Exponential) -> Self {
        Self::of(mode, h, room, [[0.0, 1.0], [0.0, 0.0]])
    }

    /// The response under the forces cos(rate tau) and -sin(rate tau).
    pub(super) fn to_harmonic(mode: Mode, h: f64, rate: f64, room: &mut Exponential) -> Self {
        Self::of(mode, h, room, [[0.0, -rate * h], [rate * h, 0.0]])
    }

    /// The force is the first component of a system z' = `generator` z/h that starts from a unit
    /// vector. Force and mode together are one linear system, whose exponential holds for any
    /// frequency and damping, at resonance and at rest (Van Loan, IEEE Trans. Automatic Control
    /// 23, 1978).
    fn of(
        Mode { omega, damping }: Mode,
        h: f64,
        room: &mut Exponential,
        generator: [[f64; 2]; 2],
    ) -> Self {
        // Displacements are scaled to the size of velocities.
        let scale = omega.max(1.0 / h);
        let [first, second] = generator;
        let matrix = [
            [0.0, scale * h, 0.0, 0.0],
            [-omega * omega * h / scale, -damping * h, 1.0, 0.0],
            [0.0, 0.0, first[0], first[1]],
            [0.0, 0.0, second[0], second[1]],
        ];
        let (e, _) = room.of(4, |i, j| matrix[i][j]).as_chunks::<4>();
        Self {
            displacement: [e[0][0], scale * e[1][0]],
            velocity: [e[0][1] / scale, e[1][1]],
            forces: [2, 3].map(|force| [h * e[0][force] / scale, h * e[1][force]]),
        }
    }

    /// Free part of (q, q') at the end of the time.
    pub(super) fn free(&self, q: f64, p: f64) -> [f64; 2] {
        std::array::from_fn(|i| self.displacement[i] * q + self.velocity[i] * p)
    }

    /// Part of (q, q') due to the two forces.
    pub(super) fn forced(&self, sizes: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| self.forces[0][i] * sizes[0] + self.forces[1][i] * sizes[1])
    }
}

/// A ramp within an interval of time without breakpoints inside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Piece {
    /// Value at the start, and the amount added linearly until the end.
    pub(super) linear: [f64; 2],
    /// Factors of cos(rate tau) and -sin(rate tau).
    pub(super) harmonic: Option<[f64; 2]>,
}

impl Piece {
    /// The piece of a ramp from `start` (s), `h` (s) long. The formula of its middle is used
    /// throughout, so that rounding of the ends does not matter.
    pub(super) fn of(ramp: &Ramp, start: f64, h: f64) -> Self {
        let middle = start + 0.5 * h;
        match ramp {
            Ramp::Sin2 { rise } if (0.0..*rise).contains(&middle) => {
                // (1 - cos(rate t))/2
                let (sin, cos) = (PI / rise * start).sin_cos();
                Self {
                    linear: [0.5, 0.0],
                    harmonic: Some([-0.5 * cos, -0.5 * sin]),
                }
            }
            Ramp::Rate(of) if matches!(**of, Ramp::Sin2 { rise } if (0.0..rise).contains(&middle)) =>
            {
                // rate/2 sin(rate t)
                let rate = of.angular_frequency().unwrap_or(0.0);
                let (sin, cos) = (rate * start).sin_cos();
                Self {
                    linear: [0.0; 2],
                    harmonic: Some([0.5 * rate * sin, -0.5 * rate * cos]),
                }
            }
            Ramp::Sine { frequency, phase } if middle >= 0.0 => {
                let (sin, cos) = (TAU * frequency * start + phase).sin_cos();
                Self {
                    linear: [0.0; 2],
                    harmonic: Some([sin, -cos]),
                }
            }
            Ramp::Rate(of) if matches!(**of, Ramp::Sine { .. }) && middle >= 0.0 => {
                let rate = of.angular_frequency().unwrap_or(0.0);
                let Self { linear, harmonic } = Self::of(of, start, h);
                // The derivative of c cos(rate tau) - s sin(rate tau).
                let harmonic = harmonic.map(|[c, s]| [-rate * s, rate * c]);
                Self { linear, harmonic }
            }
            _ => {
                let mut derivatives = [0.0; 2];
                ramp.derivatives_after(middle, &mut derivatives);
                let rise = match ramp {
                    Ramp::Table { .. } | Ramp::Linear => derivatives[1] * h,
                    _ => 0.0,
                };
                Self {
                    linear: [derivatives[0] - 0.5 * rise, rise],
                    harmonic: None,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use sinew_core::closed_form::DampedOscillator;

    use super::*;

    fn room() -> Exponential {
        Exponential::with_capacity(4)
    }

    fn close(found: [f64; 2], expected: [f64; 2], omega: f64) {
        let size = expected[0].abs() * omega + expected[1].abs() + 1e-12;
        let off = (found[0] - expected[0]).abs() * omega + (found[1] - expected[1]).abs();
        assert!(off < 1e-11 * size, "{found:?} {expected:?}");
    }

    #[test]
    fn constant_loads_give_the_closed_form() {
        for omega in [0.3, 10.0, 900.0] {
            for damping in [0.0, 0.2 * omega, 1.999 * omega, 2.0 * omega, 5.0 * omega] {
                for h in [1e-4, 1e-2, 0.5] {
                    let response = Response::to_linear(Mode { omega, damping }, h, &mut room());
                    let free = response.free(0.3, -2.0);
                    let forced = response.forced([7.0, 0.0]);
                    let exact = DampedOscillator {
                        omega,
                        damping,
                        load: 7.0,
                        displacement: 0.3,
                        velocity: -2.0,
                    };
                    let (q, p) = exact.at(h);
                    if q.is_finite() && 0.5 * damping * h < 300.0 {
                        close([free[0] + forced[0], free[1] + forced[1]], [q, p], omega);
                    }
                }
            }
        }
    }

    #[test]
    fn a_rigid_motion_is_a_parabola_and_a_rising_load_a_cubic() {
        let rigid = Mode {
            omega: 0.0,
            damping: 0.0,
        };
        let h = 0.2;
        let response = Response::to_linear(rigid, h, &mut room());
        close(response.free(1.0, 3.0), [1.6, 3.0], 1.0);
        close(response.forced([2.0, 0.0]), [h * h, 2.0 * h], 1.0);
        close(response.forced([0.0, 6.0]), [h * h, 3.0 * h], 1.0);
    }

    #[test]
    fn resonance_grows_as_the_textbooks_say() {
        // q'' + w^2 q = cos(w t) from rest: q = t sin(w t)/(2 w).
        let (w, h) = (30.0_f64, 0.21);
        let mode = Mode {
            omega: w,
            damping: 0.0,
        };
        let found = Response::to_harmonic(mode, h, w, &mut room()).forced([1.0, 0.0]);
        let (sin, cos) = (w * h).sin_cos();
        close(found, [h * sin / (2.0 * w), (sin / w + h * cos) / 2.0], w);
    }

    #[test]
    fn pieces_give_the_ramps_values() {
        let ramps = [
            Ramp::Step,
            Ramp::Sin2 { rise: 0.4 },
            Ramp::Pulse { from: 0.1, to: 0.3 },
            Ramp::Table {
                times: vec![0.1, 0.2, 0.5],
                values: vec![1.0, 3.0, -1.0],
            },
            Ramp::Sine {
                frequency: 3.1,
                phase: 0.6,
            },
            Ramp::Sine {
                frequency: 3.1,
                phase: 0.6,
            }
            .rate(),
        ];
        for ramp in ramps {
            for (start, h) in [(0.1, 0.1), (0.2, 0.1), (0.3, 0.1), (0.6, 0.1)] {
                let piece = Piece::of(&ramp, start, h);
                let tau = 0.77 * h;
                let mut value = piece.linear[0] + 0.77 * piece.linear[1];
                if let (Some([c, s]), Some(rate)) = (piece.harmonic, ramp.angular_frequency()) {
                    value += c * (rate * tau).cos() - s * (rate * tau).sin();
                }
                let expected = ramp.value(start + tau);
                let size = ramp.angular_frequency().unwrap_or(1.0).max(1.0);
                let off = (value - expected).abs();
                assert!(off < 1e-14 * size, "{ramp:?} from {start}");
            }
        }
    }
}

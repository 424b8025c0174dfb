//! Motion by dense matrix exponentials.

use nalgebra::{DMatrix, DVector};
use sinew_core::spectrum::critical_step;
use sinew_core::{LinearModel, LinearSystem, Ramp, State};

use sinew_testkit::dense::{dense, dense_damping};

/// In an interval without kinks a ramp is `c x`, x following its own linear law: x = (1, p, q) with p' = a p + b q, q'
/// = e p + g q, and in addition p' = h.
struct Piece {
    /// c.
    value: [f64; 3],
    /// x at the start of the interval.
    start: [f64; 3],
    /// x' = rates x.
    rates: [[f64; 3]; 3],
}

/// The pieces of a ramp from `t` on.
fn piece(ramp: &Ramp, t: f64) -> Piece {
    let constant = |value| Piece {
        value: [value, 0.0, 0.0],
        start: [1.0, 0.0, 0.0],
        rates: [[0.0; 3]; 3],
    };
    match ramp {
        Ramp::Step => constant(1.0),
        Ramp::Pulse { from, to } => {
            let inside = *from < t + 1e-6 && t + 1e-6 < *to;
            constant(f64::from(u8::from(inside)))
        }
        Ramp::Sin2 { rise } if t + 1e-6 < *rise => {
            // (1 - cos(rate t))/2, with p the cosine and q the sine.
            let rate = std::f64::consts::PI / rise;
            Piece {
                value: [0.5, -0.5, 0.0],
                start: [1.0, (rate * t).cos(), (rate * t).sin()],
                rates: [[0.0; 3], [0.0, 0.0, -rate], [0.0, rate, 0.0]],
            }
        }
        Ramp::Sin2 { .. } => constant(1.0),
        Ramp::Table { times, values } => {
            let next = times.iter().position(|time| *time > t + 1e-6);
            match next {
                Some(0) => constant(values[0]),
                None => constant(values[values.len() - 1]),
                Some(next) => {
                    let length = times[next] - times[next - 1];
                    let slope = (values[next] - values[next - 1]) / length;
                    Piece {
                        value: [values[next - 1], slope, 0.0],
                        start: [1.0, t - times[next - 1], 0.0],
                        rates: [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]],
                    }
                }
            }
        }
        other => unreachable!("no test has {other:?}"),
    }
}

/// The states after `steps` steps, each by one exponential of `(omega u, v)` and of the laws of the loads, x' = rates
/// x.
pub(crate) fn exponentials(
    system: &LinearModel,
    start: &State,
    dt: f64,
    steps: usize,
) -> Vec<State> {
    let operators = system.operators();
    let n = operators.dofs();
    let omega = 2.0 / critical_step(operators);
    let mass = operators.mass();
    let (k, d) = (dense(operators.stiffness()), dense_damping(operators));
    let loads = operators.loads();
    let size = 2 * n + 3 * loads.len();
    let mut network = DMatrix::zeros(size, size);
    for i in 0..n {
        network[(i, n + i)] = omega;
        for j in 0..n {
            network[(n + i, j)] = -k[i][j] / mass[i] / omega;
            network[(n + i, n + j)] = -d[i][j] / mass[i];
        }
    }
    let mut x = DVector::zeros(size);
    for i in 0..n {
        x[i] = omega * start.u[i];
        x[n + i] = start.v[i];
    }
    let mut states = Vec::new();
    for step in 0..steps {
        let t = step as f64 * dt;
        for (number, load) in loads.iter().enumerate() {
            let at = 2 * n + 3 * number;
            let piece = piece(&load.ramp, t);
            for i in 0..3 {
                x[at + i] = piece.start[i];
                for j in 0..3 {
                    network[(at + i, at + j)] = piece.rates[i][j];
                }
                for row in n..2 * n {
                    network[(row, at + i)] = 0.0;
                }
                for (dof, force) in &load.entries {
                    let dof = *dof as usize;
                    network[(n + dof, at + i)] += piece.value[i] * force / mass[dof];
                }
            }
        }
        x = (&network * dt).exp() * x;
        states.push(State::new(
            (0..n).map(|i| x[i] / omega).collect(),
            (0..n).map(|i| x[n + i]).collect(),
        ));
    }
    states
}

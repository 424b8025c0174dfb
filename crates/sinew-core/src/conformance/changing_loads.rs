//! Laws on loads that change and on the time at which they do.

use std::f64::consts::{PI, TAU};

use super::boxed::Boxed;
use super::problems::{
    FORCE, MASS, OMEGA_MAX, SPRING, chain, chain_under, exact, gentle_step, is_never_stable,
};
use crate::closed_form::DampedOscillator;
use crate::{
    ChangingLoads, Clock, Inputs, Integrator, LinearModel, LinearOperators, Load, LoadOverStep,
    Ramp, SetupError, State, StepError, System,
};

const DAMPING: f64 = 2.0;

/// Steps that a run takes if loads may be refused.
enum Taken {
    /// All steps.
    All,
    /// The steps up to a load that the method refuses.
    Refused,
}

fn advance(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    state: &mut State,
    steps: usize,
    dt: f64,
) -> Taken {
    for _ in 0..steps {
        match integrator.step(system, state, dt) {
            Ok(_) => {}
            Err(StepError::Inaccurate { .. }) => return Taken::Refused,
            Err(error) => unreachable!("`{}` refused a sound step: {error}", integrator.id()),
        }
    }
    Taken::All
}

/// Displacements (m) at time `t` (s) of the chain from rest, as the sum of its two modes: `response(omega)` is the
/// response of a mode to the load on the first mass divided by sqrt 2 and the mass.
fn from_modes(response: impl Fn(f64) -> f64) -> [f64; 2] {
    let (slow, fast) = (response((SPRING / MASS).sqrt()), response(OMEGA_MAX));
    [0.5 * (slow + fast), 0.5 * (slow - fast)]
}

/// The motion after a load of FORCE has acted from t = 0 on for `t` (s); at rest before.
fn after_step(damping: f64, t: f64) -> [f64; 2] {
    if t <= 0.0 {
        return [0.0; 2];
    }
    exact(damping, &State::at_rest(2), t)
}

/// The motion under a load that rises linearly by FORCE a second from t = 0 on: the integral of
/// `after_step` over time.
fn after_slope(damping: f64, t: f64) -> [f64; 2] {
    if t <= 0.0 {
        return [0.0; 2];
    }
    // q'' + c q' + w^2 q = g t has the particular solution g (t - c/w^2)/w^2.
    from_modes(|omega| {
        let g = FORCE / MASS;
        let w2 = omega * omega;
        let particular = |t: f64| g * (t - damping / w2) / w2;
        let free = DampedOscillator {
            omega,
            damping,
            load: 0.0,
            displacement: -particular(0.0),
            velocity: -g / w2,
        };
        particular(t) + free.at(t).0
    })
}

/// The motion under FORCE (1 - cos(rate t))/2 from rest.
fn after_sine(damping: f64, rate: f64, t: f64) -> [f64; 2] {
    from_modes(|omega| after_sine_of_mode(omega, damping, rate, t).0)
}

/// The motion under the time derivative of the load of `after_sine`: the derivative of its motion.
fn after_rate_of_sine(damping: f64, rate: f64, t: f64) -> [f64; 2] {
    from_modes(|omega| after_sine_of_mode(omega, damping, rate, t).1)
}

/// q and q' of a mode.
fn after_sine_of_mode(omega: f64, damping: f64, rate: f64, t: f64) -> (f64, f64) {
    let g = FORCE / MASS / 2.0;
    let (w2, c) = (omega * omega, damping);
    // q'' + c q' + w^2 q = -g cos(r t): q = a cos(r t) + b sin(r t).
    let (p, s) = (w2 - rate * rate, c * rate);
    let (a, b) = (-g * p / (p * p + s * s), -g * s / (p * p + s * s));
    let free = DampedOscillator {
        omega,
        damping,
        load: g,
        displacement: -a,
        velocity: -b * rate,
    };
    let (sin, cos) = (rate * t).sin_cos();
    let (q, p) = free.at(t);
    (a * cos + b * sin + q, rate * (b * cos - a * sin) + p)
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// A ramp and the motion of the chain that it causes, from rest.
struct Motion {
    ramp: Ramp,
    exact: Box<dyn Fn(f64) -> [f64; 2]>,
    smooth: bool,
}

fn pulse(from: f64, to: f64, damping: f64) -> Motion {
    Motion {
        ramp: Ramp::Pulse { from, to },
        exact: Box::new(move |t| {
            difference(after_step(damping, t - from), after_step(damping, t - to))
        }),
        smooth: false,
    }
}

/// A triangle of height 1.
fn triangle(from: f64, to: f64, damping: f64) -> Motion {
    let (middle, slope) = (0.5 * (from + to), 2.0 / (to - from));
    Motion {
        ramp: Ramp::Table {
            times: vec![from, middle, to],
            values: vec![0.0, 1.0, 0.0],
        },
        exact: Box::new(move |t| {
            let after = |t: f64| after_slope(damping, t);
            let (rise, top, end) = (after(t - from), after(t - middle), after(t - to));
            std::array::from_fn(|i| slope * (rise[i] - 2.0 * top[i] + end[i]))
        }),
        smooth: false,
    }
}

fn sine(rise: f64, damping: f64) -> Motion {
    Motion {
        ramp: Ramp::Sin2 { rise },
        exact: Box::new(move |t| after_sine(damping, PI / rise, t)),
        smooth: true,
    }
}

/// A rise from 0 to 1 that ends abruptly.
fn dropped(from: f64, to: f64, damping: f64) -> Motion {
    let slope = 1.0 / (to - from);
    Motion {
        ramp: Ramp::Table {
            times: vec![from, to, to],
            values: vec![0.0, 1.0, 0.0],
        },
        exact: Box::new(move |t| {
            let after = |t: f64| after_slope(damping, t);
            let (rise, top, end) = (after(t - from), after(t - to), after_step(damping, t - to));
            std::array::from_fn(|i| slope * (rise[i] - top[i]) - end[i])
        }),
        smooth: false,
    }
}

/// A sine that begins at t = 0 with any phase.
fn sinusoid(frequency: f64, phase: f64, damping: f64) -> Motion {
    let rate = TAU * frequency;
    Motion {
        ramp: Ramp::Sine { frequency, phase },
        exact: Box::new(move |t| {
            from_modes(|omega| {
                // q'' + c q' + w^2 q = g sin(r t + phase): q = a cos(r t + phase) + b sin(r t + phase).
                let (g, p, s) = (FORCE / MASS, omega * omega - rate * rate, damping * rate);
                let (a, b) = (-g * s / (p * p + s * s), g * p / (p * p + s * s));
                let at = |turned: f64| a * turned.cos() + b * turned.sin();
                let free = DampedOscillator {
                    omega,
                    damping,
                    load: 0.0,
                    displacement: -at(phase),
                    velocity: -rate * (b * phase.cos() - a * phase.sin()),
                };
                at(rate * t + phase) + free.at(t).0
            })
        }),
        smooth: true,
    }
}

/// The rate of a triangle of height 1, which jumps: the pull of a moving support by dashpots.
fn rate_of_triangle(from: f64, to: f64, damping: f64) -> Motion {
    let of = triangle(from, to, damping).ramp;
    let (middle, slope) = (0.5 * (from + to), 2.0 / (to - from));
    Motion {
        ramp: of.rate(),
        exact: Box::new(move |t| {
            let after = |t: f64| after_step(damping, t);
            let (rise, top, end) = (after(t - from), after(t - middle), after(t - to));
            std::array::from_fn(|i| slope * (rise[i] - 2.0 * top[i] + end[i]))
        }),
        smooth: false,
    }
}

/// The rate of a rise: half a period of a sine.
fn rate_of_sine(rise: f64, damping: f64, smooth: bool) -> Motion {
    Motion {
        ramp: Ramp::Sin2 { rise }.rate(),
        exact: Box::new(move |t| {
            // Past the rise, the same once more: two half periods of opposite sign cancel.
            let after = |t: f64| after_rate_of_sine(damping, PI / rise, t.max(0.0));
            let (first, second) = (after(t), after(t - rise));
            std::array::from_fn(|i| first[i] + if t > rise { second[i] } else { 0.0 })
        }),
        smooth,
    }
}

/// The error decreases as declared or faster while loads change smoothly, jump on steps, jump between steps or have
/// kinks between steps. An exact method is exact for all loads that it does not refuse.
pub fn order_with_changing_loads_is_as_declared(make: &dyn Fn() -> Boxed) {
    let declared = make().properties().changing_loads;
    for damping in [DAMPING, 0.0] {
        let quiet = chain(damping, 0.0, [MASS; 2]);
        if is_never_stable(&*make(), &quiet) {
            continue;
        }
        let duration = 0.4;
        let gentle = gentle_step(&*make(), &quiet).min(duration / 20.0);
        let coarse = (duration / gentle).ceil() as usize;
        let interval = duration / coarse as f64;
        let on = |n: f64| n * interval;
        // A third of a step from the next one: so it is after four times as many steps, too.
        let between = |n: f64| (n + 1.0 / 3.0) * interval;
        let motions = [
            sine(duration, damping),
            pulse(on(4.0), on(11.0), damping),
            pulse(between(4.0), between(11.0), damping),
            triangle(on(3.0), on(13.0), damping),
            triangle(between(3.0), between(12.0), damping),
            dropped(on(3.0), on(13.0), damping),
            dropped(between(3.0), between(12.0), damping),
            sinusoid(0.8 / duration, 0.0, damping),
            sinusoid(1.3 / duration, 2.1, damping),
            rate_of_sine(duration, damping, true),
            rate_of_sine(on(9.0), damping, false),
            rate_of_sine(between(9.0), damping, false),
            rate_of_triangle(on(3.0), on(13.0), damping),
            rate_of_triangle(between(3.0), between(12.0), damping),
            Motion {
                ramp: Ramp::Linear,
                exact: Box::new(move |t| after_slope(damping, t)),
                smooth: true,
            },
        ];
        for Motion {
            ramp,
            exact,
            smooth,
        } in motions
        {
            let system = chain_under(ramp.clone(), damping, FORCE, [MASS; 2]);
            let error = |refinement: usize| {
                let dt = interval / refinement as f64;
                let (mut integrator, mut state) = (make(), State::at_rest(2));
                let (mut sum, mut size) = (0.0, 0.0);
                for step in 1..=coarse {
                    if let Taken::Refused =
                        advance(&mut *integrator, &system, &mut state, refinement, dt)
                    {
                        return None;
                    }
                    for (u, expected) in state.u.iter().zip(exact(step as f64 * interval)) {
                        sum += (u - expected).powi(2);
                        size += expected * expected;
                    }
                }
                Some(f64::sqrt(sum / size))
            };
            let what = format!("{ramp:?}, c = {damping}, declared {declared:?}");
            match declared {
                ChangingLoads::Exact(needed) => {
                    let Some(error) = error(1) else {
                        let refused = needed.first_broken(&ramp, 0.0, interval, duration);
                        assert!(refused.is_some(), "{what}: refused");
                        continue;
                    };
                    assert!(error <= 1e-9, "{what}: error {error:.1e}");
                    let refused = needed.first_broken(&ramp, 0.0, interval, duration);
                    assert_eq!(refused, None, "{what}: taken, though it is not such");
                }
                ChangingLoads::Order {
                    smooth: of_smooth,
                    broken,
                } => {
                    let order = f64::from(if smooth { of_smooth } else { broken });
                    let errors = [8, 32].map(error);
                    let [Some(larger), Some(smaller)] = errors else {
                        unreachable!("{what}: refused");
                    };
                    let observed = (larger / smaller).log2() / 2.0;
                    assert!(
                        observed >= order - 0.1,
                        "{what}: observed {observed:.3}, errors {errors:?}"
                    );
                    // From rest, symplectic methods of order 1 do better, and under a line others too.
                    if matches!(ramp, Ramp::Sin2 { .. }) && of_smooth > 1 {
                        assert!(observed <= order + 0.1, "{what}: observed {observed:.3}");
                    }
                }
            }
        }
    }
}

/// A mass on a spring of 1e-9 N/m, too soft to matter within seconds, also for methods that are never stable.
fn almost_free(ramp: Ramp) -> LinearModel {
    let load = Load {
        ramp,
        entries: vec![(0, FORCE)],
    };
    let build = LinearOperators::oscillator(MASS, 1e-9, 0.0);
    match build.and_then(|operators| operators.with_loads(vec![load])) {
        Ok(operators) => LinearModel::new(operators),
        Err(error) => unreachable!("the mass is sound: {error}"),
    }
}

/// An unsupported mass gets the velocity that follows from the impulse of a load, for any duration of the load and any
/// position between two steps. A method that cannot apply the load refuses it.
pub fn the_impulse_of_a_load_arrives_wherever_it_falls(make: &dyn Fn() -> Boxed) {
    let dt = 0.005;
    let (short, long) = (0.12 * dt, 3.4 * dt);
    for share in [0.0, 0.01, 0.3, 0.62, 0.94, 1.0] {
        for width in [1e-6 * dt, short, dt, long] {
            let from = (7.0 + share) * dt;
            let to = from + width;
            let triangle = |from: f64, to: f64| Ramp::Table {
                times: vec![from, 0.5 * (from + to), to],
                values: vec![0.0, 2.0, 0.0],
            };
            let dropped = Ramp::Table {
                times: vec![from, to, to],
                values: vec![0.0, 2.0, 0.0],
            };
            // One comes with the start of the run.
            for ramp in [
                Ramp::Pulse { from, to },
                dropped,
                triangle(from, to),
                triangle(0.0, width),
            ] {
                let needed = make().properties().changing_loads.needed();
                let system = almost_free(ramp.clone());
                let (mut integrator, mut state) = (make(), State::at_rest(1));
                let taken = advance(&mut *integrator, &system, &mut state, 60, dt);
                let what = format!("{ramp:?} in steps of {dt} s");
                if let Taken::Refused = taken {
                    let broken = needed.first_broken(&ramp, 0.0, dt, 60.0 * dt);
                    assert!(needed != LoadOverStep::Any && broken.is_some(), "{what}");
                    continue;
                }
                let mut velocity = [0.0];
                assert!(
                    state
                        .velocity_at_t(&system, Inputs::none(), &mut velocity)
                        .is_ok()
                );
                let expected = FORCE * width / MASS;
                let off = (velocity[0] / expected - 1.0).abs();
                assert!(off < 1e-6, "{what}: {} for {expected}", velocity[0]);
            }
        }
    }
}

/// After a million steps the time is a million times the step.
pub fn time_does_not_drift_over_a_million_steps(make: &dyn Fn() -> Boxed) {
    let system = almost_free(Ramp::Step);
    let dt = 1e-3;
    let mut state = State::at_rest(1);
    let mut integrator = make();
    for _ in 0..1000 {
        if integrator.step(&system, &mut state, dt).is_err() {
            unreachable!("`{}` refused a sound step", integrator.id());
        }
    }
    // The rest by the clock alone, which is all that knows the time. A step may be cut into parts.
    let part = state.clock.last_step().unwrap_or(dt);
    let parts = (dt / part).round();
    assert_eq!(part, dt / parts, "the steps have another length");
    let mut clock = Clock::at(0.0);
    (0..1000 * parts as usize).for_each(|_| clock.advance(part));
    assert_eq!(state.clock, clock);
    (0..999_000 * parts as usize).for_each(|_| clock.advance(part));
    if part == dt {
        assert_eq!(clock.time(), 1e6 * dt);
    } else {
        // The part itself is rounded.
        assert!((clock.time() / (1e6 * dt) - 1.0).abs() <= Clock::ROUNDING);
    }
}

/// A load has the same effect after a million steps as after a few hundred: a jump that coincides with a step does so
/// at any time, and a checkpoint or a change of dt in between changes nothing.
pub fn loads_act_alike_at_any_time(make: &dyn Fn() -> Boxed) {
    let dt = 1e-3;
    let shifted = |late: f64| -> Vec<(Ramp, LinearModel)> {
        let table = Ramp::Table {
            times: [0.0, 0.004, 0.006, 0.013].map(|t| late + t).to_vec(),
            values: vec![0.0, 1.0, 1.0, 0.0],
        };
        let pulse = Ramp::Pulse {
            from: late,
            to: late + 0.002,
        };
        let ramps = [pulse, table];
        let with = |ramp: &Ramp| chain_under(ramp.clone(), 40.0, FORCE, [MASS; 2]);
        ramps
            .iter()
            .map(|ramp| (ramp.clone(), with(ramp)))
            .collect()
    };
    // Whole numbers of steps whose times are rounded: 13.6 s and 0.6 s.
    let (early, late) = (shifted(0.6), shifted(13.6));
    let mut refused_by_set_up = make();
    if matches!(
        refused_by_set_up.prepare(&early[0].1, dt),
        Err(SetupError::Unresolved { .. })
    ) {
        return;
    }
    for ((ramp, early), (_, late)) in early.iter().zip(&late) {
        let motion = |system: &LinearModel, start: f64, before: usize, change: bool| {
            let (mut integrator, mut state) = (make(), State::at_rest(2));
            state.clock = Clock::at(start);
            let mut taken = advance(&mut *integrator, system, &mut state, before / 2, dt);
            if change {
                // Two half steps for one, then a fresh integrator from a clone.
                taken = advance(&mut *integrator, system, &mut state, 20, dt / 2.0);
                integrator = make();
                state = state.clone();
            }
            let rest = before - before / 2 - if change { 10 } else { 0 };
            for steps in [rest, 30] {
                if let Taken::All = taken {
                    taken = advance(&mut *integrator, system, &mut state, steps, dt);
                }
            }
            matches!(taken, Taken::All).then_some(state)
        };
        let Some(expected) = motion(early, 0.0, 600, false) else {
            continue; // refused, wherever it falls
        };
        let size = expected.u.iter().fold(0.0, |max: f64, u| max.max(u.abs()));
        assert!(size > 0.0, "{ramp:?}: nothing moved");
        for (steps, start, change) in [(13_600, 0.0, false), (600, 13.0, false), (600, 13.0, true)]
        {
            let Some(found) = motion(late, start, steps, change) else {
                unreachable!("{ramp:?} later is refused, {steps} steps from {start} s");
            };
            for (u, expected) in found.u.iter().zip(&expected.u) {
                assert!(
                    (u - expected).abs() <= 1e-9 * size,
                    "{ramp:?} later, {steps} steps from {start} s: {u} for {expected}"
                );
            }
        }
    }
}

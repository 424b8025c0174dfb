//! Laws on inputs from outside.

use super::boxed::Boxed;
use super::problems::{Dampers, FORCE, MASS, chain, exact, give, loaded_chain};
use super::running::singly;
use crate::{
    Between, Channel, Inputs, Integrator, LinearModel, Load, Ramp, SetupError, State, StepError,
    System,
};

/// The period (s) of a display's frames.
const FRAME: f64 = 0.016;
const FRAMES: usize = 40;

/// Damping of the chain (1/s).
const DAMPING: f64 = 2.0;

/// Result of a run under inputs.
enum Taken {
    /// (t (s), u (m), velocity at t (m/s)) after each frame.
    All(Vec<(f64, Vec<f64>, Vec<f64>)>),
    /// The error by which the inputs were refused.
    Refused(StepError),
}

/// Takes FRAMES frames of `steps` steps each from rest; `give` receives the number of a frame and the time at which it
/// begins and ends (s) before it is taken.
fn frames(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    inputs: &mut Inputs,
    steps: usize,
    mut give: impl FnMut(&mut Inputs, usize, [f64; 2]),
) -> Taken {
    let mut state = State::at_rest(system.dofs());
    let mut taken = Vec::new();
    let dt = FRAME / steps as f64;
    for frame in 0..FRAMES {
        give(inputs, frame, [state.t(), (frame + 1) as f64 * FRAME]);
        for _ in 0..steps {
            if let Err(error) = integrator.step_under(system, inputs, &mut state, dt) {
                let message = error.to_string();
                assert!(
                    message.contains(integrator.id()),
                    "refused without its name: {message}"
                );
                return Taken::Refused(error);
            }
        }
        let mut velocity = vec![0.0; state.u.len()];
        if let Err(error) = state.velocity_at_t(system, inputs, &mut velocity) {
            unreachable!("a linear system refuses nothing: {error}");
        }
        taken.push((state.t(), state.u.clone(), velocity));
    }
    Taken::All(taken)
}

fn known(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    inputs: &mut Inputs,
    steps: usize,
) -> Taken {
    frames(integrator, system, inputs, steps, |_, _, _| {})
}

/// True for the error of a method that cannot take such inputs.
fn is_lacking(error: &StepError) -> bool {
    matches!(error, StepError::Setup(SetupError::Lacks { .. }))
}

/// Checks that inputs given during the run give the motion of the same inputs known beforehand, to
/// rounding, or are refused by name. Inputs refused beforehand must be refused during the run too.
fn same(what: &str, live: &Taken, beforehand: &Taken) {
    let (live, beforehand) = match (live, beforehand) {
        (Taken::All(live), Taken::All(beforehand)) => (live, beforehand),
        (Taken::Refused(error), Taken::All(_)) => {
            assert!(is_lacking(error), "{what}: {error}");
            return;
        }
        (Taken::Refused(live), Taken::Refused(_)) => {
            let is_of_loads = matches!(live, StepError::Inaccurate { .. });
            assert!(is_of_loads || is_lacking(live), "{what}: {live}");
            return;
        }
        (Taken::All(_), Taken::Refused(error)) => {
            unreachable!("{what}: taken as it happens, refused beforehand: {error}")
        }
    };
    let (mut way, mut speed) = (0.0_f64, 0.0_f64);
    for ((t, u, v), (time, known_u, known_v)) in live.iter().zip(beforehand) {
        assert_eq!(t, time);
        let largest = |all: &[f64]| all.iter().fold(0.0, |max: f64, x| max.max(x.abs()));
        (way, speed) = (way.max(largest(known_u)), speed.max(largest(known_v)));
        let pairs = u.iter().zip(known_u).map(|pair| (pair, way));
        for ((found, expected), size) in
            pairs.chain(v.iter().zip(known_v).map(|pair| (pair, speed)))
        {
            let off = (found - expected).abs();
            assert!(
                off <= 1e-12 * size,
                "{what}: {found} for {expected} known beforehand, at {t} s"
            );
        }
    }
    assert!(way > 0.0, "{what}: nothing moved");
}

/// Reproducible random numbers between -1 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        // xorshift64: Marsaglia, J. Stat. Softw. 8(14), 2003.
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A pair for each frame.
    fn frames() -> Vec<[f64; 2]> {
        let mut random = Self(0x9E37_79B9_7F4A_7C15);
        (0..FRAMES)
            .map(|_| [FORCE * random.next(), FORCE * random.next()])
            .collect()
    }
}

fn under(loads: Vec<Load>) -> LinearModel {
    let damping = Dampers {
        mass: DAMPING,
        ..Dampers::NONE
    };
    loaded_chain(damping, [MASS; 2], loads)
}

/// The instant at which a frame begins (s), and that after the last.
fn instants() -> Vec<f64> {
    (0..=FRAMES).map(|frame| frame as f64 * FRAME).collect()
}

/// A force given through [`Inputs`] moves the body like the same force among the system's own loads, or is refused by
/// name; a force on a degree of freedom that does not exist is refused.
pub fn a_force_from_outside_is_felt(make: &dyn Fn() -> Boxed) {
    let free = chain(DAMPING, 0.0, [MASS; 2]);
    let mut inputs = Inputs::new();
    give(&mut inputs, 0.0, &[(0, FORCE)]);
    let (dt, steps) = (1e-4, 2000);
    let mut state = State::at_rest(2);
    let mut integrator = make();
    for _ in 0..steps {
        if let Err(error) = integrator.step_under(&free, &inputs, &mut state, dt) {
            assert!(is_lacking(&error), "{error}");
            assert!(error.to_string().contains(integrator.id()), "{error}");
            return;
        }
    }
    let expected = exact(DAMPING, &State::at_rest(2), state.t());
    let size = expected.iter().fold(0.0, |max: f64, u| max.max(u.abs()));
    for (u, expected) in state.u.iter().zip(expected) {
        assert!((u - expected).abs() < 0.05 * size, "{u} for {expected}");
    }
    give(&mut inputs, state.t(), &[(2, FORCE)]);
    let refused = integrator.step_under(&free, &inputs, &mut state, dt);
    assert!(
        matches!(
            refused,
            Err(StepError::Setup(SetupError::ForceOutOfRange { .. }))
        ),
        "{refused:?}"
    );
}

/// Forces given frame by frame act like the same forces known beforehand, as pulses and as one function of time for
/// each degree of freedom; the replay of their record gives the same bits.
pub fn forces_as_they_happen_do_what_known_ones_do(make: &dyn Fn() -> Boxed) {
    let given = Random::frames();
    let entries = |[a, b]: [f64; 2]| [(0, a), (1, b)];
    let free = under(Vec::new());
    let instants = instants();
    let pulses = given
        .iter()
        .zip(instants.windows(2))
        .map(|(pair, times)| Load {
            ramp: Ramp::Pulse {
                from: times[0],
                to: times[1],
            },
            entries: entries(*pair).to_vec(),
        });
    let pulses = under(pulses.collect());
    let courses = [0, 1].map(|dof| Load {
        ramp: Ramp::Hold {
            times: instants[..FRAMES].to_vec(),
            values: given.iter().map(|pair| pair[dof]).collect(),
        },
        entries: vec![(dof as u32, 1.0)],
    });
    let courses = under(courses.to_vec());
    for steps in [1, 4] {
        let mut record = Inputs::new();
        let live = frames(
            &mut *make(),
            &free,
            &mut record,
            steps,
            |inputs, frame, [t, _]| {
                give(inputs, t, &entries(given[frame]));
            },
        );
        for (what, system) in [("pulses", &pulses), ("courses", &courses)] {
            let beforehand = known(&mut *make(), system, &mut Inputs::new(), steps);
            same(
                &format!("{what}, {steps} steps a frame"),
                &live,
                &beforehand,
            );
        }
        let again = known(&mut *make(), &free, &mut record, steps);
        if let (Taken::All(live), Taken::All(again)) = (&live, &again) {
            for (live, again) in live.iter().zip(again) {
                assert_eq!(
                    live, again,
                    "the record played again, {steps} steps a frame"
                );
            }
        } else {
            let refused = matches!(live, Taken::Refused(_)) && matches!(again, Taken::Refused(_));
            assert!(refused, "the record or the live forces are refused alone");
        }
    }
}

/// Loads that follow an input channel act like the same loads known beforehand, and the replay of their record gives
/// the same bits: constant values, values joined by lines, and the rate of such lines. A load that follows a channel
/// which the inputs do not have is refused by name.
pub fn channels_as_they_happen_do_what_known_loads_do(make: &dyn Fn() -> Boxed) {
    let given = Random::frames();
    let instants = instants();
    let (holds, lines) = (Channel(0), Channel(1));
    let follow = |ramps: [Ramp; 2]| {
        let [first, second] = ramps;
        let load = |ramp, dof| Load {
            ramp,
            entries: vec![(dof, 1.0)],
        };
        under(vec![load(first, 0), load(second, 1)])
    };
    let channels = || {
        let mut inputs = Inputs::new();
        assert_eq!(inputs.add_channel(Between::Hold), holds);
        assert_eq!(inputs.add_channel(Between::Line), lines);
        inputs
    };
    let hold = Ramp::Hold {
        times: instants[..FRAMES].to_vec(),
        values: given.iter().map(|pair| pair[0]).collect(),
    };
    let points = [0.0].into_iter().chain(given.iter().map(|pair| pair[1]));
    let line = Ramp::Table {
        times: instants.clone(),
        values: points.collect(),
    };
    let none = Ramp::Pulse { from: 1e3, to: 2e3 };
    for (what, followed, beforehand) in [
        (
            "values that hold",
            [Ramp::Input(holds), none.clone()],
            [hold, none.clone()],
        ),
        (
            "lines",
            [none.clone(), Ramp::Input(lines)],
            [none.clone(), line.clone()],
        ),
        (
            "lines, and the rate of values that hold, which is 0",
            [Ramp::InputRate(holds), Ramp::Input(lines)],
            [none.clone(), line.clone()],
        ),
        (
            "the rate of lines",
            [none.clone(), Ramp::InputRate(lines)],
            [none, Ramp::Rate(Box::new(line))],
        ),
    ] {
        let (followed, beforehand) = (follow(followed), follow(beforehand));
        for steps in [1, 4] {
            let what = format!("{what}, {steps} steps a frame");
            let mut record = channels();
            let live = frames(
                &mut *make(),
                &followed,
                &mut record,
                steps,
                |inputs, frame, [start, end]| {
                    // A line needs its end before the step there is taken.
                    let [force, place] = given[frame];
                    for (channel, t, value) in [(holds, start, force), (lines, end, place)] {
                        if let Err(error) = inputs.set(channel, t, value) {
                            unreachable!("times rise: {error}");
                        }
                    }
                },
            );
            let known_loads = known(&mut *make(), &beforehand, &mut Inputs::new(), steps);
            same(&what, &live, &known_loads);
            if let Taken::All(live) = live {
                let Taken::All(again) = known(&mut *make(), &followed, &mut record, steps) else {
                    unreachable!("{what}: the record is refused, what it records was not");
                };
                assert_eq!(live, again, "{what}: the record played again");
            }
        }
        let mut integrator = make();
        let refused = integrator.step(&followed, &mut State::at_rest(2), FRAME);
        assert!(
            matches!(&refused, Err(StepError::Setup(error)) if error.to_string().contains(integrator.id())),
            "{what}: no input, {refused:?}"
        );
    }
}

/// A recorded run continued from a checkpoint, with its forces replaced from there on, is the run
/// under the replaced forces.
pub fn forces_can_be_given_anew_from_a_checkpoint(make: &dyn Fn() -> Boxed) {
    let system = under(Vec::new());
    let given = Random::frames();
    let entries = |[a, b]: [f64; 2]| [(0, a), (1, b)];
    let mut inputs = Inputs::new();
    for (frame, pair) in given.iter().enumerate() {
        give(&mut inputs, frame as f64 * FRAME, &entries(*pair));
    }
    let mut probe = State::at_rest(2);
    if make()
        .step_under(&system, &inputs, &mut probe, FRAME)
        .is_err()
    {
        return; // as `a_force_from_outside_is_felt` has it
    }
    let start = State::at_rest(2);
    let (states, _) = singly(&mut *make(), &system, &inputs, &start, FRAME, 20);
    // Back to frame 10, with other forces from there on.
    let checkpoint = &states[10];
    for (frame, pair) in given.iter().enumerate().skip(10) {
        give(
            &mut inputs,
            frame as f64 * FRAME,
            &entries(pair.map(|force| -force)),
        );
    }
    let (again, _) = singly(&mut *make(), &system, &inputs, checkpoint, FRAME, 10);
    let mut whole = Inputs::new();
    for (frame, pair) in given.iter().enumerate() {
        let sign = if frame < 10 { 1.0 } else { -1.0 };
        give(
            &mut whole,
            frame as f64 * FRAME,
            &entries(pair.map(|force| sign * force)),
        );
    }
    let (expected, _) = singly(&mut *make(), &system, &whole, &start, FRAME, 20);
    assert_eq!(inputs, whole, "the record");
    assert_eq!(again[10], expected[20]);
}

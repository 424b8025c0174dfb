//! Device and simulation in a thread each, by the clock.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::coupling::{Coupling, CouplingError};
use crate::device::Device;
use crate::exchange::{Publisher, Reader, exchange};
use crate::force_loop::ForceLoop;
use crate::hand::Hand;
use crate::jitter::Jitter;
use crate::published::{DeviceMotion, Published, Simulated};

/// Time before a tick during which the thread waits without sleep: a sleeping thread is often woken with such a delay.
const AWAKE: Duration = Duration::from_micros(150);

/// A run that could not begin, or ended early.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RealTimeError<E> {
    /// A coupling that the device cannot render.
    #[error(transparent)]
    Coupling(#[from] CouplingError),
    /// A step that could not be taken.
    #[error("the simulation came to an end: {0}")]
    Step(E),
}

/// Report on a run.
#[derive(Clone, Debug)]
pub struct LoopReport {
    /// Delays (s) of ticks relative to their due times.
    pub jitter: Jitter,
    /// Durations (s) of the loop's work in a tick, from reading the device to the force.
    pub work: Jitter,
    /// Number of steps that were published.
    pub steps: u64,
    /// Number of steps that took longer than their own length.
    pub late_steps: u64,
    /// The largest number of ticks by which a step was late.
    pub most_late: u32,
}

/// Runs a device in this thread and a simulation in another one, until `each`, which is called after each tick, breaks.
///
/// Neither waits for the other. A simulation that is slower than real time loses time: the loop continues with the last
/// data, and returns no more energy than it received. At the end, for any reason, the force on the device is set to
/// zero; a panic of `each`, of the simulation or of the device continues after that.
///
/// # Errors
/// [`RealTimeError`] for a coupling that the device cannot render, and a step that cannot be taken.
pub fn run<S>(
    mut simulation: S,
    coupling: Coupling,
    device: &mut impl Device,
    mut each: impl FnMut(&ForceLoop) -> ControlFlow<()>,
) -> Result<LoopReport, RealTimeError<S::Error>>
where
    S: Simulated + Send,
    S::Error: Send,
{
    let (limits, position) = (device.limits(), device.position());
    let first = Published::free_at(position);
    let mut forces = ForceLoop::new(coupling, limits, &first)?;
    let mut hand = Hand::new(limits.tick);
    let (publisher, mut published) = exchange(&first);
    let (mut motion, motions) = exchange(&DeviceMotion::at(position));
    let is_over = AtomicBool::new(false);
    let mut report = LoopReport {
        jitter: Jitter::default(),
        work: Jitter::default(),
        steps: 0,
        late_steps: 0,
        most_late: 0,
    };
    let tick = Duration::from_secs_f64(limits.tick);
    let stepped = thread::scope(|scope| {
        let stepping = scope.spawn(|| {
            let over = Over(&is_over);
            step_until(over, &mut simulation, motions, publisher)
        });
        let over = Over(&is_over);
        let device = Held(device);
        let mut due = Instant::now();
        while !over.is_set() {
            due += tick;
            wait_until(due);
            let begun = Instant::now();
            report.jitter.count((begun - due).as_secs_f64());
            let position = device.0.position();
            hand.see(position, device.0.rotation_vector());
            motion.publish(hand.motion());
            if let Some(published) = published.newer() {
                forces.take(published);
            }
            let force = forces.tick(position);
            report.work.count(begun.elapsed().as_secs_f64());
            device.0.render(force);
            report.most_late = report.most_late.max(forces.late());
            if each(&forces).is_break() {
                break;
            }
            // Ticks that were missed altogether are not made up for.
            due = due.max(begun - tick);
        }
        drop(over);
        drop(device);
        stepping.join()
    });
    match stepped {
        Ok(Ok([steps, late])) => {
            (report.steps, report.late_steps) = (steps, late);
            Ok(report)
        }
        Ok(Err(error)) => Err(RealTimeError::Step(error)),
        Err(panic) => resume_unwind(panic),
    }
}

/// A device whose force is set to zero at the end, even after a panic.
struct Held<'a, D: Device>(&'a mut D);

impl<D: Device> Drop for Held<'_, D> {
    fn drop(&mut self) {
        if thread::panicking() {
            // A device that panics once more would end the process, before the first reason is reported.
            let _ = catch_unwind(AssertUnwindSafe(|| self.0.render([0.0; 3])));
        } else {
            self.0.render([0.0; 3]);
        }
    }
}

/// Signals to the other thread that this one has ended, also by a panic.
struct Over<'a>(&'a AtomicBool);

impl Over<'_> {
    fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Takes steps until the run ends; returns their number, and that of the late ones.
fn step_until<S: Simulated>(
    over: Over<'_>,
    simulation: &mut S,
    mut motions: Reader<DeviceMotion>,
    mut publisher: Publisher<Published>,
) -> Result<[u64; 2], S::Error> {
    let dt = Duration::from_secs_f64(simulation.dt());
    let mut due = Instant::now();
    let [mut steps, mut late] = [0; 2];
    while !over.is_set() {
        let published = simulation.step(motions.latest())?;
        due += dt;
        steps += 1;
        let now = Instant::now();
        if now > due {
            late += 1;
            due = now;
        } else {
            thread::sleep(due - now);
        }
        publisher.publish(published);
    }
    Ok([steps, late])
}

fn wait_until(due: Instant) {
    loop {
        let left = due.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return;
        }
        if left > AWAKE {
            thread::sleep(left - AWAKE);
        } else {
            std::hint::spin_loop();
        }
    }
}

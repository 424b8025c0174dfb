//! Device and simulation in two threads, by the clock.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test ends where something fails")]

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::sleep;
use std::time::Duration;

use sinew_haptics::real_time::{self, RealTimeError};
use sinew_haptics::{
    Coupling, Device, DeviceLimits, DeviceMotion, Published, RigidWall, Simulated, SoftwareDevice,
};

fn pressing() -> SoftwareDevice {
    SoftwareDevice::in_a_hand(|t| [0.0, 0.0, 0.003 + 0.009 * (TAU * 1.5 * t).cos()])
}

/// Ends a run after a number of ticks.
fn after(ticks: usize) -> impl FnMut(&sinew_haptics::ForceLoop) -> ControlFlow<()> {
    let mut left = ticks;
    move |_| {
        left -= 1;
        if left == 0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

#[test]
fn a_hand_feels_a_wall_and_gets_no_energy_however_busy_the_computer_is() {
    let mut device = pressing();
    let coupling = Coupling::of(600.0, &device.limits());
    let wall = RigidWall::new(coupling, 0.05, 0.01, device.true_position());
    let mut peak = 0.0_f64;
    let mut ends = after(1500);
    let report = real_time::run(wall, coupling, &mut device, |forces| {
        peak = peak.max(forces.force()[2]);
        ends(forces)
    })
    .unwrap();
    assert_eq!(report.jitter.all(), 1500);
    assert!(report.steps > 10, "{report:?}");
    assert!(device.most_energy_taken_out() <= 1e-6);
    assert!(peak > 0.1, "{peak}");
}

/// A simulation that ends, or is too slow.
struct Bad {
    steps: u64,
    ends_after: u64,
    takes: Duration,
}

impl Simulated for Bad {
    type Error = String;

    fn dt(&self) -> f64 {
        0.002
    }

    fn step(&mut self, device: &DeviceMotion) -> Result<Published, String> {
        sleep(self.takes);
        self.steps += 1;
        if self.steps > self.ends_after {
            return Err("no more".to_owned());
        }
        Ok(Published {
            dt: self.dt(),
            ..Published::free_at(device.position)
        })
    }
}

#[test]
fn a_simulation_that_fails_ends_the_run_by_its_name() {
    let mut device = pressing();
    let coupling = Coupling::of(600.0, &device.limits());
    let bad = Bad {
        steps: 0,
        ends_after: 3,
        takes: Duration::ZERO,
    };
    let ended = real_time::run(bad, coupling, &mut device, |_| ControlFlow::Continue(()));
    assert!(
        matches!(&ended, Err(RealTimeError::Step(said)) if said == "no more"),
        "{ended:?}"
    );
}

#[test]
fn steps_that_take_too_long_are_counted_and_hold_up_nobody() {
    let mut device = pressing();
    let coupling = Coupling::of(600.0, &device.limits());
    let slow = Bad {
        steps: 0,
        ends_after: u64::MAX,
        takes: Duration::from_millis(20),
    };
    let report = real_time::run(slow, coupling, &mut device, after(200)).unwrap();
    assert_eq!(report.late_steps, report.steps);
    assert!(report.steps < 30, "{report:?}");
    assert!(report.most_late >= 10, "{report:?}");
}

#[test]
fn a_coupling_that_is_too_stiff_does_not_begin() {
    let mut device = pressing();
    let coupling = Coupling {
        stiffness: 20_000.0,
        damping: 0.0,
    };
    let wall = RigidWall::new(coupling, 0.05, 0.01, device.true_position());
    let refused = real_time::run(wall, coupling, &mut device, |_| ControlFlow::Continue(()));
    let refused: RealTimeError<Infallible> = refused.unwrap_err();
    assert!(refused.to_string().contains("below 10000 N/m"), "{refused}");
}

/// A device in a wall, which keeps the last force and panics on request.
struct Fragile {
    held: [f64; 3],
    renders: usize,
    panics_at: usize,
}

impl Device for Fragile {
    fn limits(&self) -> DeviceLimits {
        pressing().limits()
    }

    fn position(&mut self) -> [f64; 3] {
        [0.0, 0.0, -0.002]
    }

    fn render(&mut self, force: [f64; 3]) {
        self.held = force;
        self.renders += 1;
        assert!(self.renders < self.panics_at, "the device is gone");
    }
}

#[test]
fn no_force_is_left_on_the_device_where_a_panic_ends_the_run() {
    for (panics_at, expected) in [
        (usize::MAX, "the caller is gone"),
        (60, "the device is gone"),
    ] {
        let mut device = Fragile {
            held: [0.0; 3],
            renders: 0,
            panics_at,
        };
        let coupling = Coupling::of(600.0, &device.limits());
        let wall = RigidWall::new(coupling, 0.05, 0.01, [0.0, 0.0, 0.003]);
        let mut ticks = 0;
        let ended = catch_unwind(AssertUnwindSafe(|| {
            real_time::run(wall, coupling, &mut device, |forces| {
                ticks += 1;
                let presses = ticks > 50 && forces.force() != [0.0; 3];
                assert!(!presses || panics_at < usize::MAX, "the caller is gone");
                match ticks < 5000 {
                    true => ControlFlow::Continue(()),
                    false => ControlFlow::Break(()),
                }
            })
        }));
        let panic = ended.unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&expected));
        assert!(ticks > 50, "{ticks}");
        assert_eq!(device.held, [0.0; 3], "{expected}");
    }
}

//! Device and simulation in two threads, by the clock.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test ends where something fails")]

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::thread::sleep;
use std::time::Duration;

use sinew_haptics::{
    Coupling, Device, DeviceMotion, Published, RealTimeError, RigidWall, Simulated, SoftwareDevice,
    real_time,
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

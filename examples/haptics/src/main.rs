//! A user's hand that presses a cube of tissue and feels it, by the clock: 1 kHz for the device, 100 Hz for the
//! simulation.
//!
//! [`SoftwareDevice`] replaces a device: a handle of 100 g in a hand that moves up and down. For a real one,
//! implement [`Device`] with its position and its force; all else stays as it is here:
//!
//! 1. The tool of the scene is a body of its own on a virtual coupling, whose other end the device moves.
//! 2. [`ToolSimulation`] steps the [`World`], and finds how stiff the tissue at the tool is.
//! 3. [`real_time::run`] runs both in a thread each, and reports the regularity of the ticks.
//!
//! ```sh
//! cargo run --release
//! ```

use std::error::Error;
use std::f64::consts::TAU;
use std::ops::ControlFlow;

use sinew_haptics::{Coupling, Device, SoftwareDevice, ToolSimulation, real_time};
use sinew_scene::{Scene, SceneSource};
use sinew_world::World;

/// Edge of the cube and radius of the ball (m).
const EDGE: f64 = 0.06;
const RADIUS: f64 = 0.012;
/// Step of the simulation (s).
const STEP: f64 = 0.01;
/// Length of the run (ticks of 1 ms).
const TICKS: usize = 3000;

fn main() -> Result<(), Box<dyn Error>> {
    let top = EDGE + RADIUS;
    let mut device = SoftwareDevice::in_a_hand(move |t| {
        let z = top + 0.002 + 0.01 * (TAU * 0.7 * t).cos();
        [0.5 * EDGE, 0.5 * EDGE, z]
    });
    let coupling = Coupling::of(400.0, &device.limits());
    let world = tissue(coupling, device.position())?;
    let simulation = ToolSimulation::new(world, "ball")?;

    let (mut tick, mut peak) = (0, 0.0_f64);
    println!("  t [s]   tool [mm above the tissue]   force [N]");
    let report = real_time::run(simulation, coupling, &mut device, |forces| {
        tick += 1;
        let force = forces.force()[2];
        peak = peak.max(force);
        if tick % 200 == 0 {
            let height = 1e3 * (forces.tool()[2] - top);
            println!("{:7.3} {height:28.2} {force:11.3}", 1e-3 * tick as f64);
        }
        match tick < TICKS {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    })?;

    let micros = |seconds: f64| 1e6 * seconds;
    println!(
        "{} ticks: late by {:.0} us (median), {:.0} us (99 in 100), {:.0} us (at most); the loop takes {:.0} us (99 in 100)",
        report.jitter.all(),
        micros(report.jitter.quantile(0.5)),
        micros(report.jitter.quantile(0.99)),
        micros(report.jitter.longest()),
        micros(report.work.quantile(0.99)),
    );
    println!("{} steps, {} of them late", report.steps, report.late_steps);
    println!(
        "most energy that the hand got out: {:.1e} J",
        device.most_energy_taken_out()
    );
    if device.most_energy_taken_out() > 1e-6 || peak < 0.05 {
        return Err("the hand should have felt tissue, and no more".into());
    }
    Ok(())
}

/// A cube that is held at the bottom, under a ball of 50 g on a coupling.
fn tissue(coupling: Coupling, start: [f64; 3]) -> Result<World, Box<dyn Error>> {
    let mass = 0.05;
    let inertia = [0.4 * mass * RADIUS * RADIUS; 3];
    let text = format!(
        r#"
[mesh]
cube = {{ cells = 6, edge = {EDGE} }}
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[damping]
mass = 20.0
[[fixed]]
group = "bottom"
[[tool]]
name = "ball"
shape = {{ sphere = {{ radius = {RADIUS} }} }}
start = {start:?}
hold = true
body = {{ mass = {mass}, inertia = {inertia:?}, coupling = {}, rotational_coupling = 0.5, damping = 0.8 }}
[run]
duration = 10.0
integrator = "cnn-stabilised"
dt = {STEP}
"#,
        coupling.stiffness
    );
    Ok(World::new(Scene::parse(SceneSource::new(
        "tissue.toml",
        text,
    ))?)?)
}

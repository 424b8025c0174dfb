//! Forces that a device with force feedback receives from a simulation.

use std::f64::consts::TAU;

use sinew_haptics::{
    Coupling, Device, DeviceMotion, Lockstep, Published, RigidWall, Simulated, SoftwareDevice,
    ToolSimulation,
};
use sinew_scene::{Scene, SceneSource};
use sinew_world::World;

use crate::bodies::{DENSITY, YOUNGS_MODULUS};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "haptics",
    title: "Devices with force feedback",
    says: "A handle of 100 g in a hand of 500 N/m and 5 N s/m, measured in steps of 25 um, goes in and out of a rigid wall, or of a cube of tissue (6 cm, 6 cells, \
           3.5 kPa) under a ball, for a minute of simulated time. Forces are held for 1 ms each; their exact work on the handle tells what energy it has got out.",
    checks,
    quoted: &[],
};

/// Energy (J) that a device may gain.
const MOST: f64 = 1e-6;

/// Edge of the cube (m).
const EDGE: f64 = 0.06;

/// Mass (kg) of the tool.
const MASS: f64 = 0.05;

const PASSIVE: &str = "no path takes energy out of what is passive";

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for hertz in [100.0, 250.0, 1000.0] {
        for stiffness in [200.0, 400.0, 1000.0] {
            for is_rigid in [true, false] {
                let what = if is_rigid { "rigid wall" } else { "tissue" };
                let figures = [
                    ("most energy taken out (J)", Asked::at_most(MOST)),
                    (
                        "largest change of force in a tick over the largest force",
                        Asked::at_most(0.05),
                    ),
                    (
                        "largest force (N)",
                        Asked::at_least(if is_rigid { 1.0 } else { 0.1 }),
                    ),
                ];
                let check = Check::several(
                    format!("{what} at {hertz} Hz, coupling of {stiffness} N/m"),
                    figures,
                    Source::ClosedForm(PASSIVE),
                    move |_| {
                        let felt = felt(is_rigid, hertz, stiffness, 60)?;
                        Ok(vec![felt.taken_out, felt.jump / felt.peak, felt.peak])
                    },
                );
                checks.push(check.long(!is_rigid && hertz > 500.0));
            }
        }
    }
    for hertz in [100.0, 250.0] {
        checks.push(Check::one(
            format!("tissue at {hertz} Hz, coupling of 400 N/m"),
            "forces behind those of 1000 Hz (steps)",
            Asked::at_most(1.0),
            Source::Independent(
                "the same hand on tissue that is simulated at the rate of the device",
            ),
            move |_| lag(hertz),
        ));
    }
    for (name, law) in [("linear", "linear"), ("neo-Hookean", "neo-hookean")] {
        checks.push(Check::one(
            format!("ball of 40 mm, 6 mm deep in a cube of {name} tissue"),
            "local stiffness over the slope of the settled force",
            Asked::value(1.0, 0.01),
            Source::Independent("difference of forces at rest, .1 mm above and below"),
            move |_| stiffness_over_slope(law),
        ));
    }
    checks
}

/// A cube of a law under a ball of this radius (m) that begins at a position (m), as a body on a coupling if one is
/// given.
fn cube(
    model: &str,
    (radius, start): (f64, [f64; 3]),
    coupling: Option<Coupling>,
    (method, dt): (&str, f64),
) -> Result<ToolSimulation, LabError> {
    let inertia = [0.4 * MASS * radius * radius; 3];
    let body = coupling.map(|coupling| {
        let stiffness = coupling.stiffness;
        format!(
            "body = {{ mass = {MASS}, inertia = {inertia:?}, coupling = {stiffness}, rotational_coupling = 0.5, damping = 0.8 }}\n"
        )
    });
    let text = format!(
        "[mesh]\ncube = {{ cells = 6, edge = {EDGE}, split = \"kuhn\" }}\n[[region]]\ndensity = {DENSITY:?}\nmodel = \"{model}\"\n\
         youngs_modulus = {YOUNGS_MODULUS}\npoissons_ratio = 0.3\n[damping]\nmass = 20.0\n[[fixed]]\ngroup = \"bottom\"\n\
         [[tool]]\nname = \"ball\"\nshape = {{ sphere = {{ radius = {radius} }} }}\nstart = {start:?}\nhold = true\n{}\
         [run]\nduration = 100.0\nintegrator = \"{method}\"\ndt = {dt}\n",
        body.unwrap_or_default()
    );
    let scene = Scene::parse(SceneSource::new("cube.toml", text))?;
    Ok(ToolSimulation::new(World::new(scene)?, "ball")?)
}

/// Forces on the user's hand.
#[derive(Default)]
struct Felt {
    taken_out: f64,
    peak: f64,
    jump: f64,
    /// Forces (N) upwards at each tick.
    forces: Vec<f64>,
}

/// A user's hand that presses, releases and moves sideways for some seconds.
fn felt(is_rigid: bool, hertz: f64, stiffness: f64, seconds: u32) -> Result<Felt, LabError> {
    let radius = 0.012;
    let (height, depth) = if is_rigid {
        (0.0, 0.012)
    } else {
        (EDGE + radius, 0.008)
    };
    let mut device = SoftwareDevice::in_a_hand(move |t| {
        [
            0.5 * EDGE + 0.004 * (TAU * 0.37 * t).sin(),
            0.5 * EDGE + 0.003 * (TAU * 0.23 * t).sin(),
            height + depth * (0.25 + 1.25 * (TAU * 0.6 * t).cos()),
        ]
    });
    let coupling = Coupling::of(stiffness, &device.limits());
    if is_rigid {
        let wall = RigidWall::new(coupling, MASS, 1.0 / hertz, device.true_position());
        return in_lockstep(wall, coupling, &mut device, seconds);
    }
    let id = if hertz > 500.0 {
        "symplectic-euler"
    } else {
        "cnn-stabilised"
    };
    let cube = cube(
        "linear",
        (radius, device.position()),
        Some(coupling),
        (id, 1.0 / hertz),
    )?;
    in_lockstep(cube, coupling, &mut device, seconds)
}

fn in_lockstep<S: Simulated>(
    simulation: S,
    coupling: Coupling,
    device: &mut SoftwareDevice,
    seconds: u32,
) -> Result<Felt, LabError>
where
    LabError: From<S::Error>,
{
    let mut lockstep = Lockstep::new(simulation, coupling, device)?;
    let (mut felt, mut last) = (Felt::default(), [0.0; 3]);
    for _ in 0..1000 * seconds {
        lockstep.tick(device)?;
        let force = lockstep.forces().force();
        let size = |force: [f64; 3]| force.iter().map(|value| value * value).sum::<f64>().sqrt();
        felt.peak = felt.peak.max(size(force));
        let change = [0, 1, 2].map(|axis| force[axis] - last[axis]);
        felt.jump = felt.jump.max(size(change));
        felt.forces.push(force[2]);
        last = force;
    }
    felt.taken_out = device.most_energy_taken_out();
    Ok(felt)
}

/// The delay, in steps, for which forces are nearest to those of a simulation at 1000 Hz.
fn lag(hertz: f64) -> Result<f64, LabError> {
    let (ticks, skipped) = (1000.0 / hertz, 1000);
    let [fast, slow] = [1000.0, hertz].map(|hertz| felt(false, hertz, 400.0, 5));
    let (fast, slow) = (fast?.forces, slow?.forces);
    let apart = |lag: usize| -> f64 {
        let both = fast[skipped..].iter().zip(&slow[skipped + lag..]);
        let squares = both.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        squares / (slow.len() - skipped - lag) as f64
    };
    let lags = 0..4 * ticks as usize;
    let best = lags.min_by(|a, b| apart(*a).total_cmp(&apart(*b)));
    Ok(best.unwrap_or_default() as f64 / ticks)
}

fn stiffness_over_slope(law: &str) -> Result<f64, LabError> {
    let (radius, dt) = (0.04, 2e-3);
    let mut from = -1e-3;
    let start = [0.5 * EDGE, 0.5 * EDGE, EDGE + radius - from];
    let mut cube = cube(law, (radius, start), None, ("symplectic-euler", dt))?;
    let mut pressed = |depth: f64| -> Result<Published, LabError> {
        let steps = 1000;
        let mut at = |step: u32, iterations: usize| {
            cube.set_iterations(iterations);
            let share = (f64::from(step) * dt / 0.5).min(1.0);
            let way = from + share * (depth - from);
            let place = [0.5 * EDGE, 0.5 * EDGE, EDGE + radius - way];
            cube.step(&DeviceMotion::at(place))
        };
        for step in 1..steps {
            at(step, 0)?;
        }
        let published = at(steps, 200)?;
        from = depth;
        Ok(published)
    };
    let (deep, by) = (0.006, 1e-4);
    let above = pressed(deep - by)?.force[2];
    let stiffness = pressed(deep)?.stiffness[2][2];
    let below = pressed(deep + by)?.force[2];
    Ok(stiffness / ((below - above) / (2.0 * by)))
}

//! A hand that presses a cube of tissue and feels it, in real time: 1 kHz for the device, 100 Hz for the simulation.
//!
//! [`SoftwareDevice`] replaces a device: a handle of 100 g in a hand that moves up and down. To use a real device,
//! implement [`Device`] with its position and its force; the rest of this program stays the same:
//!
//! 1. The tool is a body of its own on a virtual coupling ([`ToolBody`]), whose other end is steered ([`Steering`]) by
//!    the device.
//! 2. [`ToolSimulation`] takes the steps, and computes the stiffness of the tissue at the tool.
//! 3. [`real_time::run`] runs both in a thread each, and reports the jitter of the ticks.
//!
//! ```sh
//! cargo run --release
//! ```

use std::error::Error;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use sinew_core::{Inputs, Options};
use sinew_fem::{Element, Fixed, FromMesh, Law, Model, Problem, Rayleigh, Region, Tissue};
use sinew_haptics::{Body, Coupling, Device, SoftwareDevice, ToolSimulation, real_time};
use sinew_integrators::build;
use sinew_mesh::structured::{Split, block};
use sinew_tools::{Convex, Motion, Pose, Shape, Steering, Tool, ToolBody, Tools, TouchedCell};

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
    let body = tissue(coupling, device.position())?;
    let method = build("cnn-stabilised", &Options::new())?;
    let simulation = ToolSimulation::new(body, method, STEP);

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
fn tissue(coupling: Coupling, start: [f64; 3]) -> Result<Body, Box<dyn Error>> {
    let mesh = block([6; 3], [EDGE; 3], Split::Kuhn)?;
    let problem = Problem {
        regions: vec![Region {
            group: None,
            density: 1060.0, // kg/m3
            law: Law::Linear {
                youngs_modulus: 3500.0, // Pa
                poissons_ratio: 0.3,
            },
            element: Element::P1,
            tissue: Tissue::default(),
            from_mesh: FromMesh::default(),
        }],
        damping: Rayleigh {
            mass: 20.0,
            stiffness: 0.0,
        },
        fixed: vec![Fixed {
            on: "bottom".into(),
            axes: [true; 3],
        }],
        ..Problem::default()
    };
    let model = Model::build(&mesh, &problem)?;
    let held = model.pinned().as_chunks::<3>().0;
    let cells = (0..).zip(model.nodes()).zip(held);
    let cells = cells.map(|((cell, node), held)| TouchedCell {
        cell,
        rest: mesh.points[*node as usize],
        free: held.map(|held| !held),
    });
    let cells: Vec<TouchedCell> = cells.collect();

    let mut inputs = Inputs::new();
    let steering = Steering::new(&mut inputs);
    let at_start = Motion::Held(Pose::new(start, [0.0; 3]));
    let mass = 0.05;
    let ball = Tool {
        name: "ball".to_owned(),
        shape: Shape::of(Convex::sphere(RADIUS)?),
        motion: Motion::Steered(Box::new(at_start), steering),
        friction: 0.0,
        cells: (0..cells.len() as u32).collect(),
        triangles: Vec::new(),
        grasp: None,
        body: Some(ToolBody {
            mass,
            inertia: [0.4 * mass * RADIUS * RADIUS; 3],
            coupling: coupling.stiffness,
            rotational_coupling: 0.5,
            damping: 0.8,
        }),
    };
    let tools = Arc::new(Tools::new(vec![ball], cells)?);
    Ok(Body {
        system: Arc::new(model.with_contact(tools.clone())),
        tools,
        tool: 0,
        steering,
        inputs,
    })
}

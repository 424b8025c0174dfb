//! A soft block stepped by frames of 16 ms under a force that is known only as it happens.
//!
//! Every frame of a simulator does four things:
//!
//! 1. A force is computed from where the body is now. Here a probe is held above the block, presses into
//!    it, stays and lets go; while it is deeper than the surface, a spring pulls the touched node after it.
//! 2. [`Inputs::set_forces`] gives this force from now on, until the next one is given. Loads with a factor
//!    or a support that moves would be set in the same place, by [`Inputs::set`] on a channel.
//! 3. [`Integrator::step_under`](sinew_core::Integrator::step_under) takes the state to the next frame.
//!    `substeps = "auto"` cuts the frame into steps that are stable.
//! 4. The state is read: positions to draw, stress to colour, the reaction of the support, and whether
//!    the motion is still finite.
//!
//! [`Inputs`] keeps what it was given: a session of many minutes calls [`Inputs::forget_before`] now and then, so
//! that the record stops growing. At its end the example plays the record again and finds the same
//! bits, and the reaction of the support while the probe stayed still balances its force.
//!
//! ```sh
//! cargo run --release
//! ```

use std::error::Error;
use std::time::{Duration, Instant};

use sinew_core::{Inputs, LoadTime, Options, State, System, worst_beyond};
use sinew_fem::{Fixed, Law, Model, NodalForces, On, Problem, Rayleigh, Region, stress::von_mises};
use sinew_integrators::{Stepper, build};
use sinew_mesh::structured::{Split, block};

const FRAME: f64 = 0.016;
const FRAMES: usize = 250;
/// The frame after which the motion under the resting probe has died out.
const SETTLED: usize = 150;
const RELEASE: usize = 160;
const SIZE: [f64; 3] = [0.1, 0.1, 0.05];

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = block([10, 10, 5], SIZE, Split::Mirrored)?;
    let nodes = (0..).zip(&mesh.points);
    let floor = nodes.filter_map(|(node, [_, _, z])| (*z == 0.0).then_some(node));
    let floor: Vec<u32> = floor.collect();
    let (touched, _) = mesh.nearest_node([SIZE[0] / 2.0, SIZE[1] / 2.0, SIZE[2]]);

    let law = Law::linear(10e3, 0.4); // Young's modulus (Pa), Poisson's ratio
    let problem = Problem::of([Region::new(law, 1060.0)]) // kg/m3
        .with_damping(Rayleigh::new(40.0, 0.0))
        .with_fixed(Fixed::at(On::Nodes(floor.clone())));
    let model = Model::build(&mesh, &problem)?;
    let mut method = central_difference()?;
    let mut state = State::at_rest(model.dofs());
    let mut inputs = Inputs::new();

    // What a frame writes is made before it: but for the record, the loop allocates nothing.
    let mut pull = NodalForces::default();
    let mut positions = vec![[0.0; 3]; mesh.points.len()];
    let mut velocity = vec![0.0; model.dofs()];
    let mut stress = vec![[0.0; 6]; mesh.tets.len()];
    model.positions(state.t(), &state.u, &mut positions)?;
    // Set-up, and the rows of the support, which the first reaction sums up: not within a frame.
    method.prepare(&model, FRAME)?;
    model.reaction_of_nodes(state.t(), &state.u, &velocity, &floor)?;

    let mut imbalance = f64::NAN;
    let mut costs = Vec::with_capacity(FRAMES);
    println!("frame   depth [mm]   hand [N]   support [N]   largest stress [Pa]");
    for frame in 0..FRAMES {
        let before = Instant::now();
        let force = hand(frame, positions[touched as usize]);
        model.forces_into(&[(touched, force)], &mut pull)?;
        inputs.set_forces(state.t(), &pull.entries)?;
        method.step_under(&model, &inputs, &mut state, FRAME)?;
        if let Some(dof) = worst_beyond(&state.u, SIZE[2]) {
            let (cell, t) = (model.cell_name(dof), state.t());
            return Err(format!("diverged at {cell}, t = {t} s").into());
        }
        // A bare time is refused where supports or their loads follow channels of the inputs.
        let now = LoadTime::at(state.t()).under(&inputs);
        model.positions(now, &state.u, &mut positions)?;
        model.stress(now, &state.u, &mut stress)?;
        let largest = stress.iter().map(von_mises).fold(0.0, f64::max);
        // Central difference keeps the velocity half a step back; damping wants that of now.
        state.velocity_at_t(&model, &inputs, &mut velocity)?;
        let support = model.reaction_of_nodes(now, &state.u, &velocity, &floor)?;
        costs.push(before.elapsed());

        if frame == SETTLED {
            let sum = (0..3).map(|axis| (support[axis] + force[axis]).powi(2));
            imbalance = sum.sum::<f64>().sqrt() / norm(force);
        }
        if frame % 10 == 0 {
            let depth = 1e3 * (SIZE[2] - positions[touched as usize][2]);
            let (hand, support) = (force[2], support[2]);
            println!("{frame:5} {depth:12.3} {hand:10.4} {support:13.4} {largest:21.1}");
        }
    }

    let replayed = replay(&model, &inputs)?;
    costs.sort();
    let micros = |cost: Duration| 1e6 * cost.as_secs_f64();
    let (median, largest) = (micros(costs[FRAMES / 2]), micros(costs[FRAMES - 1]));
    println!("a frame: {median:.0} us (median), at most {largest:.0} us");
    println!("support and resting hand differ by {imbalance:.1e} of the force");
    let same = replayed == state;
    println!("the record played again ends in the same bits: {same}");
    if !same || imbalance.is_nan() || imbalance > 1e-3 {
        return Err("the frames do not add up".into());
    }
    Ok(())
}

fn central_difference() -> Result<Box<dyn Stepper>, Box<dyn Error>> {
    let options = Options::new().with_text("substeps", "auto");
    Ok(build("central-difference", &options)?)
}

/// The force (N) of the probe on the touched node, which is at `position` (m).
fn hand(frame: usize, position: [f64; 3]) -> [f64; 3] {
    const STIFFNESS: f64 = 40.0; // N/m
    if frame >= RELEASE {
        return [0.0; 3];
    }
    let reached = (frame as f64 / 40.0).min(1.0);
    let tip = [
        SIZE[0] / 2.0 + 0.004 * reached,
        SIZE[1] / 2.0,
        SIZE[2] + 0.002 - 0.015 * reached,
    ];
    match tip[2] < position[2] {
        true => std::array::from_fn(|axis| STIFFNESS * (tip[axis] - position[axis])),
        false => [0.0; 3],
    }
}

/// The state after all frames under forces that are known from the beginning.
fn replay(model: &Model, inputs: &Inputs) -> Result<State, Box<dyn Error>> {
    let (mut method, mut state) = (central_difference()?, State::at_rest(model.dofs()));
    for _ in 0..FRAMES {
        method.step_under(model, inputs, &mut state, FRAME)?;
    }
    Ok(state)
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

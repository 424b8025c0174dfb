//! Tools on a block of tissue, compared with the laws of motion.

use std::f64::consts::PI;

use sinew_core::{Contact, OptionValue, Options, System};
use sinew_fem::{Element, Problem, Rayleigh};
use sinew_integrators::Frame;
use sinew_integrators::cnn::CnnStabilised;
use sinew_mesh::structured::{Split, block};
use sinew_tools::{Convex, Motion, Pose, Tool};

use crate::bodies::{YOUNGS_MODULUS, body, held};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::pressed::{Pressed, energy_sweeps, method, through, tool};
use crate::staggered_energy::staggered_energy;
use crate::subject::Subject;

use super::free_tools;

pub(super) const SUBJECT: Subject = Subject {
    id: "contact",
    title: "Tools on a block of tissue",
    says: "Nodes that meet a tool are kept outside of it by forces in closed form, in the metric of the step: no stiffness is added, so that the \
           stable step stays what it was, and the energy of the step never rises by more than the work of the tool.",
    checks,
    quoted: &[],
};

/// Edge of the cube (m).
const EDGE: f64 = 0.1;

/// Gravity (m/s^2).
const GRAVITY: f64 = 9.81;

/// The method whose steps have a separate inertia, which its energy includes.
const NETWORK: &str = "cnn-stabilised";

/// The rotation of a plate that faces down.
const DOWN: [f64; 3] = [PI, 0.0, 0.0];

fn checks() -> Vec<Check> {
    let mut checks = vec![
        Check::several(
            "plate on a bar, nu 0",
            [
                ("force over E A d/L, less 1", Asked::at_most(1e-10)),
                ("force across over E A d/L", Asked::at_most(1e-10)),
                (
                    "torque about the tool's origin over that of E A d/L, less 1",
                    Asked::at_most(1e-9),
                ),
                ("nodes in contact", Asked::value(9.0, 0.0)),
            ],
            Source::ClosedForm("E A d/L"),
            |_| plate_on_a_bar(),
        ),
        Check::several(
            "plate on a bar, nu 0, cnn-energy with 60 sweeps",
            [
                ("force over E A d/L, less 1", Asked::at_most(1e-7)),
                ("force across over E A d/L", Asked::at_most(1e-7)),
            ],
            Source::ClosedForm("E A d/L"),
            |_| Ok(plate_by(energy_sweeps(60), Some(5e-3))?[..2].to_vec()),
        ),
        Check::several(
            "ball at rest that has rubbed, cnn-energy beside central difference",
            [
                (
                    "force along the ball's way down, over that, less 1",
                    Asked::at_most(1e-3),
                ),
                ("force of friction, over that, less 1", Asked::at_most(0.05)),
            ],
            Source::ClosedForm("equilibrium does not depend on the step"),
            |_| rubbed_by_sweeps(),
        ),
        Check::several(
            "ball at rest, by other methods and steps",
            [
                (
                    "largest difference of forces from central difference's, of it",
                    Asked::at_most(1e-6),
                ),
                ("force of central difference (N)", Asked::at_least(0.01)),
            ],
            Source::ClosedForm("equilibrium does not depend on the step"),
            |_| settled_forces(),
        ),
        Check::several(
            "free cube on a plate, 1 m/s",
            [
                (
                    "change of momentum over the impulse, less 1",
                    Asked::at_most(1e-12),
                ),
                (
                    "impulse over the momentum before: it bounces",
                    Asked::at_least(1.2),
                ),
                (
                    "kinetic energy after the bounce over that before",
                    Asked::at_most(1.0),
                ),
            ],
            Source::ClosedForm("m dv = sum of lambda dt"),
            |_| bounce(),
        ),
    ];
    checks.extend(free_tools::checks());
    for share in [0.05, 0.5, 0.95] {
        checks.push(Check::one(
            format!("plate pressed 10 mm, central difference at {share} stable steps"),
            "largest rise of E - W in a step over the largest E",
            Asked::at_most(1e-12),
            Source::ClosedForm("E+ - E- <= W: multiply the step by the mean of both velocities"),
            move |_| rise_under("central-difference", Convex::Plane, (DOWN, 0.0), share),
        ));
    }
    for share in [0.55, 11.0, 55.0, 275.0] {
        let law =
            "E+ - E- <= W for P above dt^2/4 K: multiply the step by the mean of both velocities";
        checks.push(Check::one(
            format!("plate pressed 10 mm, cnn-stabilised at {share} stable steps"),
            "largest rise of E - W in a step over the largest E",
            Asked::at_most(1e-12),
            Source::ClosedForm(law),
            move |_| rise_under(NETWORK, Convex::Plane, (DOWN, 0.0), share),
        ));
    }
    checks.push(Check::one(
        "ball pressed 10 mm, cnn-stabilised at 11 stable steps",
        "largest rise of E - W in a step over the largest E",
        Asked::at_most((0.02 * 0.1 / 0.012_f64).powi(2)),
        Source::ClosedForm("the turn of the normal within a step, (dt v/R)^2"),
        |_| rise_under(NETWORK, Convex::sphere(0.012)?, ([0.0; 3], 0.012), 11.0),
    ));
    for (angle, slides) in [(15.0, false), (16.0, false), (18.0, true), (25.0, true)] {
        let check = if slides {
            Check::one(
                format!("block on an incline of {angle} degrees, mu .3"),
                "acceleration over g (sin - mu cos)",
                Asked::value(1.0, 0.01),
                Source::ClosedForm("Coulomb"),
                move |_| Ok(on_an_incline(angle)? / expected_acceleration(angle)),
            )
        } else {
            Check::one(
                format!("block on an incline of {angle} degrees, mu .3"),
                "speed (m/s), below the angle of friction of 16.70 degrees",
                Asked::at_most(if angle < 16.0 { 1e-5 } else { 1e-4 }),
                Source::ClosedForm("Coulomb"),
                move |_| Ok(on_an_incline(angle)?.abs()),
            )
        };
        checks.push(check);
    }
    for sweeps in [2, 4, 8, 16] {
        checks.push(Check::one(
            format!("block that slides at .5 m/s for .1 s, mu .3, cnn-energy with {sweeps} sweeps"),
            "speed over v - mu g t",
            Asked::value(1.0, 0.03),
            Source::ClosedForm("Coulomb"),
            move |_| slowed(sweeps),
        ));
    }
    for share in [1.1, 2.3, 4.5, 9.0] {
        for (id, options) in [
            (NETWORK, Options::new()),
            energy_sweeps(4),
            energy_sweeps(16),
        ] {
            let sweeps = match options.get("sweeps") {
                Some(OptionValue::Number(sweeps)) => format!(" with {sweeps} sweeps"),
                _ => String::new(),
            };
            checks.push(Check::several(
                format!("slab drawn over a floor, mu .1, {id}{sweeps} at {share} stable steps"),
                [
                    ("acceleration over that of a point", Asked::value(1.0, 0.05)),
                    (
                        "mean force on the floor over its weight",
                        Asked::value(1.0, 0.1),
                    ),
                ],
                Source::ClosedForm("Newton's second law of the slab as a whole"),
                move |_| drawn(id, &options, share),
            ));
        }
    }
    for speed in [1.0, 5.0, 20.0, 50.0] {
        checks.push(Check::one(
            format!("ball of 5 mm through a slab of one cell at {speed} m/s, steps of 5 ms"),
            "deepest node in the ball after any step (m)",
            Asked::at_most(1e-12),
            Source::ClosedForm("a node is kept in a half-space that touches the ball"),
            move |_| depth_in_a_fast_ball(speed),
        ));
    }
    checks.push(Check::several(
        "ball with friction on a cube, central difference",
        [
            (
                "difference of displacements with 1, 2 and 8 threads (m)",
                Asked::at_most(0.0),
            ),
            (
                "difference in a world that is turned, of the largest displacement",
                Asked::at_most(1e-10),
            ),
        ],
        Source::ClosedForm("contact is solved node by node, in any order and any axes"),
        |_| Ok(vec![threads()?, turned_world()?]),
    ));
    checks
}

/// A block of 10 cells, fixed at the bottom.
fn cube(nu: f64, damping: f64) -> Problem {
    Problem {
        damping: Rayleigh::new(damping, 0.0),
        fixed: vec![held("bottom", [true; 3])],
        ..body(YOUNGS_MODULUS, nu, Element::P1)
    }
}

fn under(
    (cells, size): ([usize; 3], [f64; 3]),
    problem: &Problem,
    tool: Tool,
) -> Result<Pressed, LabError> {
    let mesh = block(cells, size, Split::Kuhn)?;
    Pressed::new(&mesh, problem, tool, |_| true)
}

fn plate_on_a_bar() -> Result<Vec<f64>, LabError> {
    plate_by(("symplectic-euler", Options::new()), None)
}

/// Figures of a plate on a bar with a method, in steps of `dt` (s) or half the stable one.
fn plate_by((id, options): (&str, Options), dt: Option<f64>) -> Result<Vec<f64>, LabError> {
    let (length, width, depth) = (0.1, 0.02, 0.002);
    let down = [(0.0, [0.0, 0.0, length]), (0.1, [0.0, 0.0, length - depth])];
    let plate = tool(Convex::Plane, through(&down, DOWN)?, 0.0);
    let bar = ([2, 2, 8], [width, width, length]);
    let mut pressed = under(bar, &cube(0.0, 60.0), plate)?;
    let (dt, duration) = match dt {
        Some(dt) => (dt, 1.5),
        None => (0.5 * pressed.stable_step()?, 1.3),
    };
    let mut integrator = method(id, &options)?;
    pressed.run(&mut *integrator, dt, (duration / dt) as usize)?;
    let expected = YOUNGS_MODULUS * width * width * depth / length;
    let report = pressed.tools.report(&pressed.state, 0);
    let [x, y, z] = report.force;
    // The tool's origin is above a corner of the bar.
    let lever = width / 2.0 * expected;
    let [about_x, about_y] = [report.torque[0] / lever, -report.torque[1] / lever];
    Ok(vec![
        (z / expected - 1.0).abs(),
        x.abs().max(y.abs()) / expected,
        (about_x - 1.0).abs().max((about_y - 1.0).abs()),
        report.contacts as f64,
    ])
}

fn settled_forces() -> Result<Vec<f64>, LabError> {
    let down = [
        (0.0, [0.05, 0.05, EDGE + 0.0125]),
        (0.2, [0.05, 0.05, EDGE + 0.002]),
    ];
    let settled = |id: &str, dt: f64| -> Result<f64, LabError> {
        let ball = tool(Convex::sphere(0.012)?, through(&down, [0.0; 3])?, 0.0);
        let mut pressed = under(([10; 3], [EDGE; 3]), &cube(0.45, 30.0), ball)?;
        let mut integrator = method(id, &Options::new())?;
        pressed.run(&mut *integrator, dt, (6.0 / dt) as usize)?;
        Ok(pressed.force()[2])
    };
    let expected = settled("central-difference", 1e-3)?;
    let mut worst: f64 = 0.0;
    for (id, dt) in [
        ("central-difference", 5e-4),
        ("symplectic-euler", 1e-3),
        ("cnn-symplectic", 7e-4),
        (NETWORK, 5e-4),
        (NETWORK, 1e-3),
        (NETWORK, 5e-3),
    ] {
        let force = settled(id, dt)?;
        worst = worst.max((force / expected - 1.0).abs());
    }
    Ok(vec![worst, expected])
}

/// Differences, with sweeps, of the forces after a ball was pressed into a cube and moved sideways from those of
/// central difference, over the latter.
fn rubbed_by_sweeps() -> Result<Vec<f64>, LabError> {
    let down = [
        (0.0, [0.03, 0.03, 0.0725]),
        (0.2, [0.03, 0.03, 0.067]),
        (0.4, [0.032, 0.03, 0.067]),
    ];
    let settled = |(id, options): (&str, Options), dt: f64| {
        let ball = tool(Convex::sphere(0.012)?, through(&down, [0.0; 3])?, 0.3);
        let mut pressed = under(([5; 3], [0.06; 3]), &cube(0.45, 40.0), ball)?;
        pressed.run(&mut *method(id, &options)?, dt, (1.6 / dt) as usize)?;
        Ok::<[f64; 3], LabError>(pressed.force())
    };
    let expected = settled(("central-difference", Options::new()), 0.5e-3)?;
    let found = settled(energy_sweeps(30), 2e-3)?;
    Ok([2, 0]
        .map(|axis| (found[axis] / expected[axis] - 1.0).abs())
        .into())
}

/// A free slab on a floor with friction, under an acceleration (m/s^2).
fn slab(nu: f64, gravity: [f64; 3], friction: f64) -> Result<Pressed, LabError> {
    let floor = tool(Convex::Plane, Motion::Held(Pose::identity()), friction);
    let problem = Problem {
        gravity: Some(gravity),
        ..body(YOUNGS_MODULUS, nu, Element::P1)
    };
    under(([3, 3, 1], [0.06, 0.06, 0.02]), &problem, floor)
}

fn slowed(sweeps: u32) -> Result<f64, LabError> {
    let (friction, start, dt, steps) = (0.3, 0.5, 0.5e-3, 200);
    let mut pressed = slab(0.0, [0.0, 0.0, -GRAVITY], friction)?;
    pressed
        .state
        .v
        .iter_mut()
        .step_by(3)
        .for_each(|v| *v = start);
    let (id, options) = energy_sweeps(sweeps);
    pressed.run(&mut *method(id, &options)?, dt, steps)?;
    Ok(pressed.mean_velocity(0).0 / (start - friction * GRAVITY * dt * steps as f64))
}

/// Mean acceleration of a slab that is pulled sideways, over that of a point mass, and its mean force on the floor over
/// its weight.
fn drawn(id: &str, options: &Options, share: f64) -> Result<Vec<f64>, LabError> {
    let (friction, pull, weight) = (0.1, 1.5, 6.0);
    let mut pressed = slab(0.3, [pull, 0.0, -weight], friction)?;
    let dt = share * pressed.stable_step()?;
    let steps = (0.4 / dt).round() as usize;
    pressed.run(&mut *method(id, options)?, dt, steps)?;
    // The network's first step has half of the force.
    let halves = if id == NETWORK { 0.5 } else { 0.0 };
    let time = dt * (steps as f64 - halves);
    let (speed, mass) = pressed.mean_velocity(0);
    let [_, _, impulse] = pressed.tools.report(&pressed.state, 0).impulse;
    Ok(vec![
        speed / time / (pull - friction * weight),
        -impulse / time / (mass * weight),
    ])
}

/// Three ratios for a cube that falls on a plate: error of the change of momentum relative to the impulse, impulse over
/// the momentum before, and kinetic energy after over that before.
fn bounce() -> Result<Vec<f64>, LabError> {
    let below = Pose::new([0.0, 0.0, -0.003], [0.0; 3]);
    let plate = tool(Convex::Plane, Motion::Held(below), 0.0);
    let free = body(YOUNGS_MODULUS, 0.3, Element::P1);
    let mut pressed = under(([4; 3], [EDGE; 3]), &free, plate)?;
    let dt = 0.5 * pressed.stable_step()?;
    let falling = pressed.state.v.iter_mut().skip(2).step_by(3);
    falling.for_each(|v| *v = -1.0);
    let sums = |pressed: &Pressed| {
        let all = pressed.state.v.iter().zip(pressed.model.mass());
        let momentum: f64 = all.clone().skip(2).step_by(3).map(|(v, m)| m * v).sum();
        let kinetic: f64 = all.map(|(v, m)| 0.5 * m * v * v).sum();
        (momentum, kinetic)
    };
    let (momentum, kinetic) = sums(&pressed);
    let mut integrator = method("symplectic-euler", &Options::new())?;
    let mut impulse = 0.0;
    for _ in 0..(0.5 / dt) as usize {
        pressed.run(&mut *integrator, dt, 1)?;
        impulse -= dt * pressed.force()[2];
    }
    let (after, left) = sums(&pressed);
    Ok(vec![
        ((after - momentum) / impulse - 1.0).abs(),
        -impulse / momentum,
        left / kinetic,
    ])
}

/// The largest rise in a step of the method's discrete energy less the work of a tool, over the largest energy: the
/// tool is pressed 10 mm into the cube, kept there and withdrawn, within tenths of a second or a few steps.
fn rise_under(
    id: &str,
    convex: Convex,
    (rotation, above): ([f64; 3], f64),
    share: f64,
) -> Result<f64, LabError> {
    let body = || ([10; 3], [EDGE; 3]);
    let far = tool(
        Convex::Plane,
        Motion::Held(Pose::new([0.0, 0.0, -1.0], [0.0; 3])),
        0.0,
    );
    let dt = share * under(body(), &cube(0.45, 0.0), far)?.stable_step()?;
    let stretch = (4.0 * dt).max(0.1);
    let at = |z: f64| [0.05, 0.05, EDGE + above + z];
    let rows = [
        (0.0, at(1e-4)),
        (stretch, at(-0.01)),
        (3.0 * stretch, at(-0.01)),
        (4.0 * stretch, at(0.001)),
    ];
    let tool = tool(convex, through(&rows, rotation)?, 0.0);
    let mut pressed = under(body(), &cube(0.45, 0.0), tool)?;
    let mut network = Frame::new(CnnStabilised::default());
    let mut other = match id {
        NETWORK => None,
        id => Some(method(id, &Options::new())?),
    };
    let (mut last, mut largest, mut rise): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
    for _ in 0..(6.0 * stretch / dt) as usize {
        match &mut other {
            Some(other) => pressed.run(&mut **other, dt, 1)?,
            None => pressed.run(&mut network, dt, 1)?,
        }
        let blocks = network.scheme().stabiliser();
        let blocks = blocks.map(|stabiliser| stabiliser.majorant().inverse().entries());
        let energy = staggered_energy(&pressed.model, &pressed.state, blocks, dt);
        let left = energy - pressed.tools.work(&pressed.state);
        rise = rise.max(last.map_or(0.0, |last| left - last));
        last = Some(left);
        largest = largest.max(energy);
    }
    Ok(rise / largest)
}

fn expected_acceleration(angle: f64) -> f64 {
    let (sin, cos) = angle.to_radians().sin_cos();
    GRAVITY * (sin - 0.3 * cos)
}

/// The acceleration (m/s^2) of a block that slides, or the speed (m/s) of one that should rest.
fn on_an_incline(angle: f64) -> Result<f64, LabError> {
    let (sin, cos) = angle.to_radians().sin_cos();
    let problem = Problem {
        damping: Rayleigh::new(0.0, 2e-3),
        gravity: Some([GRAVITY * sin, 0.0, -GRAVITY * cos]),
        ..body(YOUNGS_MODULUS, 0.0, Element::P1)
    };
    let plane = tool(Convex::Plane, Motion::Held(Pose::identity()), 0.3);
    let mut pressed = under(([2; 3], [0.02; 3]), &problem, plane)?;
    let mut integrator = method("symplectic-euler", &Options::new())?;
    let speed = |pressed: &Pressed| pressed.mean_velocity(0).0;
    let dt = 2e-4;
    // It settles on its support first.
    pressed.run(&mut *integrator, dt, 3000)?;
    let before = speed(&pressed);
    pressed.run(&mut *integrator, dt, 2000)?;
    let after = speed(&pressed);
    Ok(if angle < 16.7 {
        after
    } else {
        (after - before) / (2000.0 * dt)
    })
}

/// Depth (m) of the deepest node of a slab of one cell in a ball that passes through the slab: the largest after any
/// step.
fn depth_in_a_fast_ball(speed: f64) -> Result<f64, LabError> {
    let ball = Convex::sphere(0.005)?;
    let start = Pose::new([0.0413, 0.0529, 0.02], [0.0; 3]);
    let velocity = [0.0, 0.0, -speed];
    let motion = Motion::Steady { start, velocity };
    let problem = Problem {
        fixed: vec![held("sides", [true; 3])],
        ..body(YOUNGS_MODULUS, 0.3, Element::P1)
    };
    let slab = ([10, 10, 1], [EDGE, EDGE, 0.01]);
    let mut pressed = under(slab, &problem, tool(ball, motion, 0.0))?;
    let mut integrator = method("cnn-stabilised", &Options::new())?;
    let mut deepest: f64 = 0.0;
    let steps = (0.1 / (speed * 5e-3)).ceil() as usize;
    let mut touched = false;
    for _ in 0..steps.max(4) {
        pressed.run(&mut *integrator, 5e-3, 1)?;
        deepest = deepest.max(-pressed.gap());
        touched |= pressed.force()[2] > 0.0;
    }
    if touched {
        Ok(deepest)
    } else {
        Err(LabError::no_body())
    }
}

/// A cube under a ball with friction, after .1 s, with this number of threads, the whole scene rotated by a rotation
/// vector about the origin.
fn rubbed(threads: f64, turn: [f64; 3]) -> Result<Vec<f64>, LabError> {
    let pose = Pose::new([0.0; 3], turn);
    let mut mesh = block([8; 3], [0.06; 3], Split::Kuhn)?;
    for point in &mut mesh.points {
        *point = pose.to_world(*point);
    }
    let rows = [
        (0.0, pose.to_world([0.03, 0.03, 0.0805])),
        (0.1, pose.to_world([0.028, 0.031, 0.073])),
    ];
    let ball = tool(Convex::sphere(0.02)?, through(&rows, turn)?, 0.3);
    let mut pressed = Pressed::new(&mesh, &cube(0.3, 5.0), ball, |_| true)?;
    let options = Options::new()
        .with("machine", OptionValue::Text("general".into()))
        .with("threads", OptionValue::Number(threads));
    let mut integrator = method("central-difference", &options)?;
    pressed.run(&mut *integrator, 0.5e-3, 200)?;
    Ok(pressed.state.u)
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest, value| largest.max(value.abs()))
}

fn threads() -> Result<f64, LabError> {
    let one = rubbed(1.0, [0.0; 3])?;
    let mut off: f64 = 0.0;
    for threads in [2.0, 8.0] {
        let many = rubbed(threads, [0.0; 3])?;
        off = off.max(largest(many.iter().zip(&one).map(|(a, b)| a - b)));
    }
    Ok(off)
}

fn turned_world() -> Result<f64, LabError> {
    let turn = [0.3, -0.7, 0.4];
    let pose = Pose::new([0.0; 3], turn);
    let (plain, turned) = (rubbed(1.0, [0.0; 3])?, rubbed(1.0, turn)?);
    let pairs = plain
        .as_chunks::<3>()
        .0
        .iter()
        .zip(turned.as_chunks::<3>().0);
    let differences = pairs.flat_map(|(plain, turned)| {
        let expected = pose.turned(*plain);
        [0, 1, 2].map(|axis| expected[axis] - turned[axis])
    });
    Ok(largest(differences) / largest(plain.iter().copied()))
}

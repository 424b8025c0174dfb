//! Tools that are separate bodies, and tips that are finer than the surface.

use std::f64::consts::PI;

use sinew_core::{Inputs, Options, System};
use sinew_fem::{Element, Problem, Rayleigh};
use sinew_mesh::structured::{Split, block};
use sinew_tools::{Convex, Motion, Pose, Row, Table, Tool, ToolBody};

use crate::bodies::{YOUNGS_MODULUS, body, held};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::pressed::{Pressed, method, through, tool};
use crate::staggered_energy::staggered_energy;

/// Edge of the cube (m).
const EDGE: f64 = 0.06;

const BODY: ToolBody = ToolBody {
    mass: 0.05,
    inertia: [2e-6; 3],
    coupling: 400.0,
    rotational_coupling: 0.5,
    damping: 0.8,
};

pub(super) fn checks() -> Vec<Check> {
    let mut checks = vec![
        Check::one(
            "tool of 50 g on 400 N/m, whose path stops, steps of .2 and .1 ms",
            "order of the difference from the damped oscillation",
            Asked::value(2.0, 0.1),
            Source::ClosedForm("v/w e^(-z q t) sin(w t), q^2 = k/m, w^2 = q^2 (1 - z^2)"),
            |_| Ok((off_swing(2e-4)? / off_swing(1e-4)?).log2()),
        ),
        Check::several(
            "tool of 50 g on 400 N/m and .5 N m, whose path stops, steps of .1 and .05 ms, cnn-stabilised",
            [
                ("order of the difference along", Asked::value(2.0, 0.1)),
                ("order of the difference about", Asked::value(2.0, 0.1)),
                (
                    "largest difference along, over the swing",
                    Asked::at_most(1e-5),
                ),
            ],
            SWING,
            |_| orders("cnn-stabilised", &Options::new()),
        ),
        Check::several(
            "tool of 50 g on 400 N/m and .5 N m, whose path stops, steps of .1 and .05 ms, cnn-energy",
            [
                ("order of the difference along", Asked::value(1.0, 0.1)),
                ("order of the difference about", Asked::value(1.0, 0.1)),
                (
                    "largest difference along, over the swing",
                    Asked::at_most(0.1),
                ),
            ],
            SWING,
            |_| orders("cnn-energy", &Options::new().with_text("kind", "ie")),
        ),
        Check::several(
            "tool of 50 g rubs a free cube that it flies into",
            [
                (
                    "change of the momentum of both along any axis, of that before",
                    Asked::at_most(1e-13),
                ),
                (
                    "residual of contacts that act on each other",
                    Asked::at_most(1e-12),
                ),
                ("contacts, added up over the steps", Asked::at_least(101.0)),
                (
                    "speed of the tool in the end over that before",
                    Asked::at_most(0.84),
                ),
                ("work of the hand (J)", Asked::value(0.0, 0.0)),
            ],
            Source::ClosedForm("m1 v1 + m2 v2 stays"),
            |_| rubbing_collision(),
        ),
        Check::several(
            "tool of 50 g on 400 N/m and .5 N m presses a ball askew, at rest",
            [
                (
                    "k x beside the force on the tool, any axis (N)",
                    Asked::at_most(1e-9),
                ),
                (
                    "k a beside the torque on the tool, any axis (N m)",
                    Asked::at_most(1e-9),
                ),
                (
                    "force over that on a tool that is led to the same pose, less 1",
                    Asked::at_most(1e-6),
                ),
            ],
            Source::ClosedForm("k x = F"),
            |_| askew_at_rest(),
        ),
        Check::one(
            "ball of .1 mg on 400 N/m that rubs, central difference",
            "largest rise of E of body, tool and coupling, less the work of the hand, over the largest E",
            Asked::at_most(3e-4),
            Source::ClosedForm("E+ - E- <= W of the hand, but for (dt v/R)^2"),
            |_| light_rise(),
        ),
        Check::one(
            "tool of 50 g flies into a free cube",
            "change of the momentum of both, of that before",
            Asked::at_most(1e-12),
            Source::ClosedForm("m1 v1 + m2 v2 stays"),
            |_| collision(),
        ),
        Check::one(
            "tool of 50 g on 400 N/m presses a ball, at rest",
            "k x over the force on the tool, less 1",
            Asked::at_most(1e-8),
            Source::ClosedForm("k x = F"),
            |_| at_rest(),
        ),
    ];
    // Places of some .1 m are rounded by 1e-17 m, which 1e6 N/m make a force of 1e-11 N, at work over .1 mm a step.
    for (coupling, limit) in [(400.0, 1e-12), (1e6, 1e-11)] {
        checks.push(Check::one(
            format!("plate of 50 g on {coupling} N/m pressed 10 mm, central difference"),
            "largest rise of E of body, tool and coupling, less the work of the hand, over the largest E",
            Asked::at_most(limit),
            Source::ClosedForm("E+ - E- <= W of the hand"),
            move |_| rise(coupling),
        ));
    }
    for (share, coupling) in [(0.05, 400.0), (0.5, 400.0), (0.95, 400.0), (0.95, 1e6)] {
        checks.push(Check::one(
            format!("plate of 50 g on {coupling} N/m pressed 10 mm, central difference at {share} stable steps, nu 0"),
            "largest rise of E of body, tool and coupling, less the work of the hand, over the largest E",
            Asked::at_most(if coupling > 400.0 { 1e-11 } else { 1e-12 }),
            Source::ClosedForm("E+ - E- <= W of the hand"),
            move |_| {
                let pressed = under(4, &body_of(0.0), plate(coupling)?)?;
                let dt = share * pressed.stable_step()?;
                largest_rise_in_steps(pressed, "central-difference", dt, 0.3)
            },
        ));
    }
    for (id, share, limit) in [
        ("cnn-energy", 2.0, 1e-6),
        ("central-difference", 0.5, 3e-4),
        ("central-difference", 0.95, 3e-4),
    ] {
        let figures = [
            (
                "with friction: largest rise above the lowest, over the largest E",
                Asked::at_most(limit),
            ),
            (
                "without: the same",
                Asked::at_most(if id == "cnn-energy" { 1e-12 } else { limit }),
            ),
            (
                "smallest of the largest energies (J)",
                Asked::at_least(1e-4),
            ),
        ];
        let law = "E+ - E- <= W of the hand, but for (dt v/R)^2 where normals turn";
        checks.push(Check::several(
            format!("balls of 50 g, 1 g and .1 mg on 400 N/m, {id} at {share} stable steps"),
            figures,
            Source::ClosedForm(law),
            move |_| light_tools(id, share),
        ));
    }
    for speed in [1.0, 5.0, 20.0] {
        checks.push(Check::several(
            format!("tip of a tenth of an edge into a block at {speed} m/s, steps of 1 ms"),
            [
                (
                    "solid angle of the surface as seen from the tip, over 4 pi",
                    Asked::at_most(1e-9),
                ),
                ("the same with nodes alone, less 1", Asked::value(0.0, 1e-9)),
            ],
            Source::ClosedForm(
                "the winding number of a closed surface about a point that does not pass it",
            ),
            move |_| Ok(vec![shot(speed, true)?, shot(speed, false)? - 1.0]),
        ));
    }
    checks.push(Check::one(
        "tip of 1.5 mm pressed 3 mm, edges of 6 mm against 3 mm",
        "force on the coarse mesh over that on the fine one",
        Asked::value(1.5, 0.5),
        Source::ClosedForm("a tip below an edge feels the mesh: a figure, no law"),
        |_| coarse_over_fine(),
    ));
    checks
}

/// The damped oscillation of a tool after its path has stopped.
const SWING: Source = Source::ClosedForm("v/w e^(-z q t) sin(w t), q^2 = k/m, w^2 = q^2 (1 - z^2)");

fn cube(damping: f64) -> Problem {
    Problem {
        damping: Rayleigh {
            mass: damping,
            stiffness: 0.0,
        },
        ..body_of(0.3)
    }
}

/// An undamped block on its bottom.
fn body_of(nu: f64) -> Problem {
    Problem {
        fixed: vec![held("bottom", [true; 3])],
        ..body(YOUNGS_MODULUS, nu, Element::P1)
    }
}

fn under(cells: usize, problem: &Problem, tool: Tool) -> Result<Pressed, LabError> {
    let mesh = block([cells; 3], [EDGE; 3], Split::Kuhn)?;
    Pressed::new(&mesh, problem, tool, |_| true)
}

fn ball(motion: Motion, body: ToolBody) -> Result<Tool, LabError> {
    Ok(Tool {
        body: Some(body),
        ..tool(Convex::sphere(0.012)?, motion, 0.0)
    })
}

fn pose(pressed: &Pressed) -> Pose {
    pressed.tools.pose(&pressed.state, Inputs::none(), 0)
}

fn place(pressed: &Pressed) -> [f64; 3] {
    pose(pressed).position()
}

/// The largest difference (m) of an oscillation from its closed form, after the path has stopped.
fn off_swing(dt: f64) -> Result<f64, LabError> {
    let (stop, speed, damping) = (0.05, 0.06, 0.1);
    let rows = [(0.0, [0.0, 0.0, 1.0]), (stop, [speed * stop, 0.0, 1.0])];
    let tool = ball(through(&rows, [0.0; 3])?, ToolBody { damping, ..BODY })?;
    let mut pressed = under(1, &cube(0.0), tool)?;
    let mut integrator = method("cnn-stabilised", &Options::new())?;
    let before = (stop / dt).round() as usize;
    pressed.run(&mut *integrator, dt, before)?;
    let rate = (BODY.coupling / BODY.mass).sqrt();
    let swings = rate * (1.0 - damping * damping).sqrt();
    let mut worst: f64 = 0.0;
    for n in 1..=before {
        pressed.run(&mut *integrator, dt, 1)?;
        let t = dt * n as f64;
        let expected = speed / swings * (-damping * rate * t).exp() * (swings * t).sin();
        worst = worst.max((place(&pressed)[0] - speed * stop - expected).abs());
    }
    Ok(worst)
}

/// Orders, along and about an axis, of the differences of an oscillation from its closed form, and the largest
/// difference along the axis over the size of the oscillation.
fn orders(id: &str, options: &Options) -> Result<Vec<f64>, LabError> {
    let [coarse, fine] = [1e-4, 5e-5].map(|dt| off_both(id, options, dt));
    let (coarse, fine) = (coarse?, fine?);
    Ok(vec![
        (coarse[0] / fine[0]).log2(),
        (coarse[1] / fine[1]).log2(),
        fine[0],
    ])
}

/// The largest difference of an oscillation along x, and of one about y, from its closed form, over its size.
fn off_both(id: &str, options: &Options, dt: f64) -> Result<[f64; 2], LabError> {
    let (stop, end, damping) = (0.05, 0.1, 0.1);
    let (speed, spin) = (0.06, 0.4);
    let way = [(0.0, [0.0, 0.0, 1.0]), (stop, [speed * stop, 0.0, 1.0])];
    let turn = [(0.0, [0.0; 3]), (stop, [0.0, spin * stop, 0.0])].map(|(t, rotation_vector)| Row {
        t,
        position: [0.0, 0.0, 1.0],
        rotation_vector,
    });
    let turn = Motion::Table(Table::new(turn.to_vec())?);
    let swung = |motion: Motion, rate: f64, start: f64, of: fn(&Pose) -> f64| {
        let mut pressed = under(1, &cube(0.0), ball(motion, ToolBody { damping, ..BODY })?)?;
        let mut integrator = method(id, options)?;
        pressed.run(&mut *integrator, dt, (stop / dt).round() as usize)?;
        let swings = rate * (1.0 - damping * damping).sqrt();
        let mut worst: f64 = 0.0;
        for n in 1..=((end - stop) / dt).round() as usize {
            pressed.run(&mut *integrator, dt, 1)?;
            let t = dt * n as f64;
            let expected = start / swings * (-damping * rate * t).exp() * (swings * t).sin();
            let offset = of(&pose(&pressed)) - start * stop;
            worst = worst.max((offset - expected).abs());
        }
        Ok::<f64, LabError>(worst / (start / swings))
    };
    let rates = [
        BODY.coupling / BODY.mass,
        BODY.rotational_coupling / BODY.inertia[1],
    ];
    let [along, about] = rates.map(f64::sqrt);
    Ok([
        swung(through(&way, [0.0; 3])?, along, speed, |pose| {
            pose.position()[0]
        })?,
        swung(turn, about, spin, |pose| pose.rotation_vector()[1])?,
    ])
}

fn light_rise() -> Result<f64, LabError> {
    let rows = [
        (0.0, [0.025, 0.03, EDGE + 0.0121]),
        (0.05, [0.027, 0.03, EDGE + 0.007]),
        (0.3, [0.035, 0.03, EDGE + 0.007]),
    ];
    let light = ToolBody {
        mass: 1e-7,
        inertia: [6e-12; 3],
        rotational_coupling: 0.05,
        ..BODY
    };
    let mut tool = ball(through(&rows, [0.0; 3])?, light)?;
    tool.friction = 0.4;
    largest_rise(under(5, &cube(0.0), tool)?, 0.4)
}

fn collision() -> Result<f64, LabError> {
    let free = body(YOUNGS_MODULUS, 0.3, Element::P1);
    let velocity = [0.02, 0.0, -0.6];
    let start = Pose::new([0.033, 0.028, EDGE + 0.015], [0.0; 3]);
    let loose = ToolBody {
        coupling: 0.0,
        rotational_coupling: 0.0,
        ..BODY
    };
    let tool = ball(Motion::Steady { start, velocity }, loose)?;
    let mut pressed = under(5, &free, tool)?;
    let dt = 0.5 * pressed.stable_step()?;
    let mut integrator = method("central-difference", &Options::new())?;
    let before = BODY.mass * velocity[2];
    let mut worst: f64 = 0.0;
    for _ in 0..(0.1 / dt) as usize {
        pressed.run(&mut *integrator, dt, 1)?;
        let all = pressed.state.v.iter().zip(pressed.model.mass());
        let tissue: f64 = all.skip(2).step_by(3).map(|(v, m)| m * v).sum();
        let tool = pressed.tools.report(&pressed.state, 0).body;
        let tool = tool.map_or(before, |body| BODY.mass * body.velocity[2]);
        worst = worst.max(((tissue + tool) / before - 1.0).abs());
    }
    Ok(worst)
}

fn rubbing_collision() -> Result<Vec<f64>, LabError> {
    let free = body(YOUNGS_MODULUS, 0.3, Element::P1);
    let velocity = [0.02, 0.0, -0.6];
    let start = Pose::new([0.033, 0.028, EDGE + 0.015], [0.0; 3]);
    let loose = ToolBody {
        coupling: 0.0,
        rotational_coupling: 0.0,
        ..BODY
    };
    let mut tool = ball(Motion::Steady { start, velocity }, loose)?;
    tool.friction = 0.3;
    let mut pressed = under(5, &free, tool)?;
    let dt = 0.5 * pressed.stable_step()?;
    let mut integrator = method("central-difference", &Options::new())?;
    let (mut off, mut touched) = (0.0_f64, 0.0);
    let of_tool = |pressed: &Pressed| pressed.tools.report(&pressed.state, 0).body;
    for _ in 0..(0.1 / dt) as usize {
        pressed.run(&mut *integrator, dt, 1)?;
        touched += pressed.tools.report(&pressed.state, 0).contacts as f64;
        let now = of_tool(&pressed).map_or(velocity, |body| body.velocity);
        for axis in 0..3 {
            let (mean, mass) = pressed.mean_velocity(axis);
            let change = mean * mass + BODY.mass * (now[axis] - velocity[axis]);
            off = off.max(change.abs() / (BODY.mass * velocity[2].abs()));
        }
    }
    let end = of_tool(&pressed).ok_or_else(LabError::no_body)?;
    let residual = pressed.tools.report(&pressed.state, 0).largest_residual;
    Ok(vec![
        off,
        residual,
        touched,
        end.velocity[2] / velocity[2],
        end.hand_work,
    ])
}

/// The largest differences of spring and force, of spring and torque, and of the force from that on a tool steered to
/// the same pose.
fn askew_at_rest() -> Result<Vec<f64>, LabError> {
    let [start, end] = [[0.03, 0.03, EDGE + 0.0125], [0.031, 0.029, EDGE + 0.007]];
    let settled = |tool: Tool| {
        let mut pressed = under(5, &cube(40.0), tool)?;
        let mut integrator = method("central-difference", &Options::new())?;
        pressed.run(&mut *integrator, 1e-3, 2500)?;
        Ok::<Pressed, LabError>(pressed)
    };
    let way = through(&[(0.0, start), (0.2, end)], [0.0; 3])?;
    let pressed = settled(ball(way, BODY)?)?;
    let (there, report) = (pose(&pressed), pressed.tools.report(&pressed.state, 0));
    let (place, turn) = (there.position(), there.rotation_vector());
    let off = (0..3).fold(0.0, |off: f64, axis| {
        let pulled = BODY.coupling * (place[axis] - end[axis]);
        off.max((pulled - report.force[axis]).abs())
    });
    let twisted = (0..3).fold(0.0, |off: f64, axis| {
        let turned = BODY.rotational_coupling * turn[axis];
        off.max((turned - report.torque[axis]).abs())
    });
    let [x, y, _] = there.position();
    let rows = [
        (0.0, [x, y, EDGE + 0.0125], [0.0; 3]),
        (0.2, there.position(), there.rotation_vector()),
    ];
    let rows = rows.map(|(t, position, rotation_vector)| Row {
        t,
        position,
        rotation_vector,
    });
    let led = Motion::Table(Table::new(rows.to_vec())?);
    let led = settled(tool(Convex::sphere(0.012)?, led, 0.0))?;
    Ok(vec![
        off,
        twisted,
        (report.force[2] / led.force()[2] - 1.0).abs(),
    ])
}

fn at_rest() -> Result<f64, LabError> {
    let end = [0.031, 0.029, EDGE + 0.007];
    let rows = [(0.0, [0.03, 0.03, EDGE + 0.0125]), (0.2, end)];
    let tool = ball(through(&rows, [0.0; 3])?, BODY)?;
    let mut pressed = under(5, &cube(40.0), tool)?;
    let mut integrator = method("central-difference", &Options::new())?;
    pressed.run(&mut *integrator, 1e-3, 2500)?;
    let pulled = BODY.coupling * (place(&pressed)[2] - end[2]);
    Ok((pulled / pressed.force()[2] - 1.0).abs())
}

fn rise(coupling: f64) -> Result<f64, LabError> {
    largest_rise(under(5, &cube(0.0), plate(coupling)?)?, 0.3)
}

/// A plate of 50 g that is pressed 10 mm down and lifted; it cannot rotate, so that its normal is constant.
fn plate(coupling: f64) -> Result<Tool, LabError> {
    let at = |z: f64| [0.03, 0.03, EDGE + z];
    let rows = [
        (0.0, at(1e-4)),
        (0.05, at(-0.01)),
        (0.1, at(-0.01)),
        (0.15, at(1e-4)),
    ];
    let stiff = ToolBody {
        inertia: [1e3; 3],
        damping: 0.0,
        coupling,
        ..BODY
    };
    Ok(Tool {
        body: Some(stiff),
        ..tool(Convex::Plane, through(&rows, [PI, 0.0, 0.0])?, 0.0)
    })
}

/// The largest rise of the energy above its earlier minimum, over the largest energy, of balls of several masses and
/// dampings in a second: with friction and without; and the smallest of the largest energies (J).
fn light_tools(id: &str, share: f64) -> Result<Vec<f64>, LabError> {
    let rows = [
        (0.0, [0.025, 0.03, EDGE + 0.0121]),
        (0.05, [0.027, 0.03, EDGE + 0.007]),
        (0.3, [0.035, 0.03, EDGE + 0.007]),
        (10.0, [0.035, 0.03, EDGE + 0.007]),
    ];
    let (mut worst, mut least) = ([0.0_f64; 2], f64::INFINITY);
    for mass in [0.05, 1e-3, 1e-7] {
        for (damping, friction) in [(0.0, 0.4), (0.8, 0.4), (0.0, 0.0)] {
            let body = ToolBody {
                mass,
                inertia: [0.4 * mass * 0.012 * 0.012; 3],
                rotational_coupling: 0.05,
                damping,
                ..BODY
            };
            let mut tool = ball(through(&rows, [0.0; 3])?, body)?;
            tool.friction = friction;
            let pressed = under(5, &cube(0.0), tool)?;
            let dt = share * pressed.stable_step()?;
            let (rise, largest) = rise_above_lowest(pressed, id, dt, 1.0)?;
            let figure = &mut worst[usize::from(friction == 0.0)];
            *figure = figure.max(rise / largest);
            least = least.min(largest);
        }
    }
    Ok([worst.as_slice(), &[least]].concat())
}

/// [`largest_rise_in_steps`] by central difference in nine tenths of the stable step.
fn largest_rise(pressed: Pressed, duration: f64) -> Result<f64, LabError> {
    let dt = 0.9 * pressed.stable_step()?;
    largest_rise_in_steps(pressed, "central-difference", dt, duration)
}

/// The largest rise in a step of the energy of body, tool and coupling, less the work of the hand, over the largest
/// energy, in a time (s).
fn largest_rise_in_steps(
    pressed: Pressed,
    id: &str,
    dt: f64,
    duration: f64,
) -> Result<f64, LabError> {
    let (mut last, mut largest, mut rise): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
    follow(pressed, id, dt, duration, |energy, left| {
        rise = rise.max(last.map_or(0.0, |last| left - last));
        last = Some(left);
        largest = largest.max(energy);
    })?;
    Ok(rise / largest)
}

/// The same above the earlier minimum of the energy, and the largest energy (J).
fn rise_above_lowest(
    pressed: Pressed,
    id: &str,
    dt: f64,
    duration: f64,
) -> Result<(f64, f64), LabError> {
    let (mut lowest, mut largest, mut rise): (f64, f64, f64) = (f64::INFINITY, 0.0, 0.0);
    follow(pressed, id, dt, duration, |energy, left| {
        lowest = lowest.min(left);
        rise = rise.max(left - lowest);
        largest = largest.max(energy);
    })?;
    Ok((rise, largest))
}

/// Reports the energy of body, tool and coupling after each step, and the rest of it without the work of the hand (J).
fn follow(
    mut pressed: Pressed,
    id: &str,
    dt: f64,
    duration: f64,
    mut see: impl FnMut(f64, f64),
) -> Result<(), LabError> {
    let is_energy = id == "cnn-energy";
    let options = match is_energy {
        true => Options::new().with_text("kind", "ie"),
        false => Options::new(),
    };
    let mut integrator = method(id, &options)?;
    for _ in 0..(duration / dt) as usize {
        pressed.run(&mut *integrator, dt, 1)?;
        let tool = pressed.tools.report(&pressed.state, 0).body;
        let tool = tool.ok_or_else(LabError::no_body)?;
        let of_body = match is_energy {
            true => pressed.energy()?,
            false => staggered_energy(&pressed.model, &pressed.state, None, dt),
        };
        let energy = of_body + tool.energy;
        see(energy, energy - tool.hand_work);
    }
    Ok(())
}

/// The solid angle of the surface of a block, over 4 pi, as seen from a tip with the size of a tenth of an edge that is
/// shot at it: 0 outside, 1 inside.
fn shot(speed: f64, meets_triangles: bool) -> Result<f64, LabError> {
    let edge = EDGE / 6.0;
    let free = body(YOUNGS_MODULUS, 0.3, Element::P1);
    let start = Pose::new([0.0327, 0.0269, EDGE + edge], [0.0; 3]);
    let velocity = [0.0, 0.0, -speed];
    let tip = tool(
        Convex::sphere(0.1 * edge)?,
        Motion::Steady { start, velocity },
        0.0,
    );
    let mesh = block([6; 3], [EDGE; 3], Split::Kuhn)?;
    let mut pressed = match meets_triangles {
        true => Pressed::with_triangles(&mesh, &free, tip)?,
        false => Pressed::new(&mesh, &free, tip, |_| true)?,
    };
    let mut integrator = method("cnn-stabilised", &Options::new())?;
    let steps = (3.0 * edge / (speed * 1e-3)).ceil() as usize;
    pressed.run(&mut *integrator, 1e-3, steps)?;
    let at = place(&pressed);
    let corner = |node: u32| -> [f64; 3] {
        let first = pressed
            .model
            .cell_of_node(node)
            .map_or(0, |cell| 3 * cell as usize);
        let rest = mesh.points[node as usize];
        std::array::from_fn(|axis| rest[axis] + pressed.state.u[first + axis] - at[axis])
    };
    let surface = mesh.boundary(None).into_iter();
    let sum: f64 = surface.map(|nodes| solid_angle(nodes.map(corner))).sum();
    Ok((sum / (4.0 * PI)).abs())
}

/// The solid angle of a triangle as seen from the origin (Van Oosterom and Strackee 1983).
fn solid_angle([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = [
        b[1] * c[2] - b[2] * c[1],
        b[2] * c[0] - b[0] * c[2],
        b[0] * c[1] - b[1] * c[0],
    ];
    let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * dot(a, cross).atan2(below)
}

/// The force of a tip at rest on a coarse mesh over that on a fine one.
fn coarse_over_fine() -> Result<f64, LabError> {
    let force = |cells: usize| -> Result<f64, LabError> {
        let at = |z: f64| [0.0317, 0.0289, EDGE + z];
        let rows = [(0.0, at(0.0016)), (0.1, at(-0.0015))];
        let tip = tool(Convex::sphere(0.0015)?, through(&rows, [0.0; 3])?, 0.0);
        let mesh = block([cells; 3], [EDGE; 3], Split::Kuhn)?;
        let mut pressed = Pressed::with_triangles(&mesh, &cube(40.0), tip)?;
        let mut integrator = method("cnn-stabilised", &Options::new())?;
        pressed.run(&mut *integrator, 1e-3, 1500)?;
        Ok(pressed.force()[2])
    };
    Ok(force(10)? / force(20)?)
}

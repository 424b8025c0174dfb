//! Tips that are smaller than the surface triangles.

use crate::common::pressed;

use std::f64::consts::PI;

use pressed::{Block, Pressed, staggered_energy, through, tool};
use sinew_core::{Contact, Inputs, State};
use sinew_mesh::structured::{Split, block};
use sinew_tools::{Convex, Motion, Pose, Tool, ToolBody};

/// The size (m) of a cell of the surface.
const EDGE: f64 = 0.01;

fn gap(pressed: &Pressed, state: &State, tool: usize) -> f64 {
    let pose = pressed.tools.pose(state, Inputs::none(), tool);
    pressed.tools.deepest(&state.u, &pose, tool).unwrap().gap
}

/// Positions between nodes, from a simple sequence that fills the square.
fn places() -> impl Iterator<Item = [f64; 2]> {
    (1..=12).map(|n: i32| {
        [0.754_877_666, 0.569_840_291]
            .map(|step| 0.025 + 2.0 * EDGE * (f64::from(n) * step).fract())
    })
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

/// The largest force (N) on a tip that is shot through a free block, and true if its axis ever was inside the surface:
/// a point that does not pass through a closed surface keeps its winding number, for any folding of the surface.
fn shot(
    (shape, rotation): (Convex, [f64; 3]),
    (speed, dt): (f64, f64),
    meets_triangles: bool,
    [x, y]: [f64; 2],
) -> (f64, bool) {
    let mut body = Block::of([7.0 * EDGE, 7.0 * EDGE, 4.0 * EDGE], [7, 7, 4]);
    body.is_held = false;
    let start = Pose::new([x, y, 5.0 * EDGE], rotation);
    let velocity = [0.0, 0.0, -speed];
    let needle = tool(shape, Motion::Steady { start, velocity });
    let pressed = match meets_triangles {
        true => body.with_triangles(vec![needle]),
        false => body.with(vec![needle]),
    };
    let mesh = block(body.cells, body.size, Split::Kuhn).unwrap();
    let (rest, surface) = (&mesh.points, mesh.boundary(None));
    let axis: &[f64] = match shape {
        Convex::Sphere { .. } => &[0.0],
        _ => &[-0.49 * EDGE, 0.0, 0.49 * EDGE],
    };
    let mut state = pressed.at_rest();
    let (mut force, mut is_inside) = (0.0_f64, false);
    // It begins 10 mm above the block, and goes 20 mm deep: farther, and what is pushed comes out at the back.
    let steps = (3.0 * EDGE / (speed * dt)).ceil() as usize;
    for _ in 0..steps {
        pressed.run(&mut state, "cnn-stabilised", dt, 1);
        force = force.max(pressed.force(&state)[2]);
        let places: Vec<[f64; 3]> = (0..rest.len() as u32)
            .map(|node| {
                let first = 3 * pressed.model.cell_of_node(node).unwrap() as usize;
                [0, 1, 2].map(|axis| rest[node as usize][axis] + state.u[first + axis])
            })
            .collect();
        let pose = pressed.tools.pose(&state, Inputs::none(), 0);
        is_inside |= axis.iter().any(|own| {
            let at = pose.to_world([0.0, 0.0, *own]);
            let turns = surface.iter().map(|nodes| {
                solid_angle(nodes.map(|node| {
                    let place = places[node as usize];
                    [0, 1, 2].map(|axis| place[axis] - at[axis])
                }))
            });
            turns.sum::<f64>().abs() > 2.0 * PI
        });
    }
    (force, is_inside)
}

#[test]
fn no_needle_passes_between_nodes_at_any_speed_and_one_that_meets_nodes_alone_does() {
    let shapes = [
        (Convex::sphere(0.1 * EDGE).unwrap(), [0.0; 3]),
        (Convex::capsule(0.1 * EDGE, EDGE).unwrap(), [0.3, 0.2, 0.0]),
        (
            Convex::cuboid([0.2 * EDGE, 0.3 * EDGE, EDGE]).unwrap(),
            [0.1, 0.3, 0.2],
        ),
    ];
    for (speed, dt) in [(1.0, 1e-3), (5.0, 1e-3), (20.0, 1e-3), (20.0, 1e-4)] {
        for (number, shape) in shapes.into_iter().enumerate() {
            let mut passes = 0;
            for place in places().skip(number).step_by(3) {
                let (force, is_inside) = shot(shape, (speed, dt), true, place);
                assert!(force > 0.0, "{shape:?} {speed} {place:?}");
                assert!(!is_inside, "{shape:?} {speed} {place:?}");
                let (force, is_inside) = shot(shape, (speed, dt), false, place);
                passes += usize::from(force == 0.0 || is_inside);
            }
            assert!(passes >= 3, "{shape:?} {speed}: {passes} of 4 pass");
        }
    }
}

#[test]
fn a_tip_within_a_triangle_presses_its_corners_by_their_weights() {
    let cube = Block::of([0.04; 3], [4; 3]).with_mass_damping(40.0);
    // Two thirds of the way to one corner: (.02, .01), (.03, .01), (.03, .02) lie around it.
    let place = [0.0275, 0.0115];
    let down = [
        (0.0, [place[0], place[1], 0.0412]),
        (0.1, [place[0], place[1], 0.039]),
    ];
    let tip = tool(Convex::sphere(0.001).unwrap(), through(&down, [0.0; 3]));
    let pressed = cube.with_triangles(vec![tip]);
    let mut state = pressed.at_rest();
    // The first touch, before the triangle leans.
    let mut forces = Vec::new();
    while forces.is_empty() {
        pressed.run(&mut state, "symplectic-euler", 1e-4, 1);
        let all = pressed
            .tools
            .forces(&state)
            .zip(pressed.tools.touched_cells());
        forces = all
            .filter(|(force, _)| *force != [0.0; 3])
            .map(|(force, cell)| (force, cell.rest))
            .collect();
    }
    assert_eq!(forces.len(), 3);
    let total = pressed.force(&state)[2];
    let sum: f64 = forces.iter().map(|(force, _)| -force[2]).sum();
    assert!((sum / total - 1.0).abs() < 1e-14);
    for axis in 0..2 {
        let lever = |(force, rest): &([f64; 3], [f64; 3])| -force[2] / total * rest[axis];
        let centre: f64 = forces.iter().map(lever).sum();
        assert!((centre - place[axis]).abs() < 1e-9, "{centre} {place:?}");
    }
    // At rest the path is the same force for any step.
    pressed.run(&mut state, "symplectic-euler", 1e-3, 2000);
    let fine = pressed.force(&state)[2];
    assert!(gap(&pressed, &state, 0) > -1e-10);
    let mut state = pressed.at_rest();
    pressed.run(&mut state, "cnn-stabilised", 3e-3, 2000);
    let coarse = pressed.force(&state)[2];
    assert!(
        fine > 1e-3 && (coarse / fine - 1.0).abs() < 1e-6,
        "{coarse} {fine}"
    );
}

/// A tip that is a dynamic body on a coupling, and next to it a tip on a prescribed path, which share nodes.
#[test]
fn energy_rises_by_no_more_than_normals_turn_and_bodies_meet_triangles_too() {
    let cube = Block::of([0.04; 3], [4; 3]);
    let rows = |x: f64| {
        let at = |z: f64| [x, 0.017, z];
        [
            (0.0, at(0.0411)),
            (0.05, at(0.034)),
            (0.1, at(0.034)),
            (0.15, at(0.0411)),
        ]
    };
    let tip = |name: &str, x: f64| Tool {
        name: name.to_owned(),
        ..tool(Convex::sphere(0.001).unwrap(), through(&rows(x), [0.0; 3]))
    };
    let body = ToolBody {
        mass: 0.01,
        inertia: [1e-7; 3],
        coupling: 100.0,
        rotational_coupling: 1e-2,
        damping: 0.0,
    };
    let free = Tool {
        body: Some(body),
        ..tip("free", 0.023)
    };
    for (tools, share) in [
        (vec![tip("led", 0.017)], 0.5),
        (vec![tip("led", 0.017)], 0.1),
        (vec![tip("led", 0.017), free], 0.1),
    ] {
        let pressed = cube.with_triangles(tools);
        let dt = share * pressed.stable_step();
        let mut state = pressed.at_rest();
        let (mut last, mut largest, mut rise): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
        let mut met = vec![false; pressed.tools.tools().len()];
        for _ in 0..(0.3 / dt) as usize {
            let before = state.clone();
            pressed.run(&mut state, "central-difference", dt, 1);
            let energy = staggered_energy(&pressed.model, &before, &state, dt);
            largest = largest.max(energy);
            let left = energy - pressed.tools.work(&state);
            for (tool, met) in met.iter_mut().enumerate() {
                let report = pressed.tools.report(&state, tool);
                assert!(report.residual < 0.01, "{report:?}");
                *met |= report.contacts > 0;
            }
            rise = rise.max(last.map_or(0.0, |last| left - last));
            last = Some(left);
        }
        assert!(met.iter().all(|met| *met), "{met:?}");
        // Both were drawn back out, and the tissue is where it was, below them.
        for tool in 0..met.len() {
            let gap = gap(&pressed, &state, tool);
            assert!(gap > -1e-10, "{tool}: {gap}");
        }
        // The speed is that of the table, 7.1 mm in .05 s.
        let turn = dt * 0.142 / 0.001;
        assert!(largest > 1e-4, "{largest}");
        assert!(rise < 1.2 * turn * turn * largest, "{rise} of {largest}");
        assert!(share > 0.1 || rise < 1e-5 * largest, "{rise} of {largest}");
    }
}

//! Contact of cut faces: they carry weight, push each other by opposite forces and add no energy, and invalid faces are
//! refused.

use crate::common::pressed;

use std::collections::BTreeMap;
use std::sync::Arc;

use pressed::{Block, Pressed, staggered_energy, through, tool};
use sinew_core::{OptionValue, Options, State, System};
use sinew_fem::Model;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block};
use sinew_tools::{
    Convex, Corner, CutFace, Motion, Pose, Tool, Tools, ToolsError, TouchedCell, TouchedTriangle,
};

/// A block that is cut through at half its height, and the pairs of nodes of its cut faces: the cell below and the one
/// above.
struct Cut {
    pressed: Pressed,
    lips: Vec<[u32; 2]>,
}

impl Cut {
    fn of(shape: &Block, tools: Vec<Tool>) -> Self {
        let mut mesh = block(shape.cells, shape.size, Split::Kuhn).unwrap();
        let half = 0.5 * shape.size[2];
        let (doubles, faces) = split(&mut mesh, half);
        let model = Model::build(&mesh, &shape.problem()).unwrap();
        let cell_of = |node: u32| model.cell_of_node(node).unwrap();
        let pinned = model.pinned().as_chunks::<3>().0;
        let cells: Vec<TouchedCell> = (0..)
            .zip(model.nodes())
            .zip(pinned)
            .map(|((cell, node), held)| TouchedCell {
                cell,
                rest: mesh.points[*node as usize],
                free: held.map(|held| !held),
            })
            .collect();
        let tools = tools.into_iter().map(|tool| Tool {
            cells: (0..cells.len() as u32).collect(),
            ..tool
        });
        let tools = Tools::new(tools.collect(), cells).unwrap();
        let faces = faces.into_iter().map(|sides| CutFace {
            corners: sides.map(|side| side.map(|node| Corner::Cell(cell_of(node)))),
        });
        let tools = Arc::new(tools.with_cut_faces(faces.collect()).unwrap());
        let lips = doubles.into_iter().map(|pair| pair.map(cell_of)).collect();
        let model = model.with_contact(tools.clone());
        Self {
            pressed: Pressed { model, tools },
            lips,
        }
    }

    /// Largest depth (m) of the upper node of any pair below the lower one.
    fn overlap(&self, state: &State) -> f64 {
        let height = |cell: u32| state.u[3 * cell as usize + 2];
        let pairs = self.lips.iter();
        let overlaps = pairs.map(|[below, above]| height(*below) - height(*above));
        overlaps.fold(0.0, f64::max)
    }

    /// One flag per cell: true if it is above the cut.
    fn is_above(&self) -> Vec<bool> {
        let rests = self.pressed.tools.touched_cells().iter();
        let mut above: Vec<bool> = rests.map(|cell| cell.rest[2] > 0.5 * HEIGHT).collect();
        for [_, lip] in &self.lips {
            above[*lip as usize] = true;
        }
        above
    }
}

/// The height (m) of all blocks here.
const HEIGHT: f64 = 0.04;

/// Splits a mesh at a height (m): returns the nodes there with their copies for the tetrahedra above, and the faces of
/// both sides.
fn split(mesh: &mut TetMesh, height: f64) -> (Vec<[u32; 2]>, Vec<[[u32; 3]; 2]>) {
    let is_at = |mesh: &TetMesh, node: u32| (mesh.points[node as usize][2] - height).abs() < 1e-9;
    let mut double: BTreeMap<u32, u32> = BTreeMap::new();
    for node in 0..mesh.points.len() as u32 {
        if is_at(mesh, node) {
            let tag = mesh.node_tags.iter().max().unwrap() + 1;
            double.insert(node, mesh.points.len() as u32);
            mesh.points.push(mesh.points[node as usize]);
            mesh.node_tags.push(tag);
        }
    }
    let mut faces = Vec::new();
    for place in 0..mesh.tets.len() {
        let nodes = mesh.tets[place];
        let middle = nodes.map(|node| mesh.points[node as usize][2]);
        let is_above = middle.iter().sum::<f64>() / 4.0 > height;
        if is_above {
            mesh.tets[place] = nodes.map(|node| *double.get(&node).unwrap_or(&node));
        }
        let cut: Vec<u32> = nodes
            .into_iter()
            .filter(|node| is_at(mesh, *node))
            .collect();
        if let ([a, b, c], false) = (&cut[..], is_above) {
            let [p, q, r] = [a, b, c].map(|node| mesh.points[*node as usize]);
            let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            // Counter-clockwise as seen from above, outside of the tissue below.
            let first = if area > 0.0 {
                [*a, *b, *c]
            } else {
                [*a, *c, *b]
            };
            faces.push([first, first.map(|node| double[&node])]);
        }
    }
    (
        double
            .into_iter()
            .map(|(below, above)| [below, above])
            .collect(),
        faces,
    )
}

#[test]
fn the_upper_half_of_a_block_rests_on_its_lips_by_its_weight() {
    let damping = 60.0;
    let mut shape = Block::of([0.02, 0.02, HEIGHT], [2, 2, 4]).with_mass_damping(damping);
    shape.gravity = Some([0.0, 0.0, -9.81]);
    let cut = Cut::of(&shape, Vec::new());
    assert_eq!(cut.pressed.tools.lip_pairs(), 9);
    let mut state = cut.pressed.at_rest();
    cut.pressed.run(&mut state, "symplectic-euler", 5e-4, 6000);
    let above = cut.is_above();
    let masses = cut.pressed.model.mass().as_chunks::<3>().0;
    let speeds = state.v.as_chunks::<3>().0;
    let of_above = masses.iter().zip(speeds).zip(&above);
    let of_above = of_above.filter(|(_, is_above)| **is_above);
    // Nothing rubs, so that it slides down the slope of its sagging lips, slowly, as damping lets it.
    let weight: f64 = of_above
        .map(|((mass, v), _)| mass[2] * (9.81 + damping * v[2]))
        .sum();
    let forces: Vec<[f64; 3]> = cut.pressed.tools.forces(&state).collect();
    let carried = |side: bool| -> f64 {
        let of_side = forces.iter().zip(&above);
        let of_side = of_side.filter(|(_, is_above)| **is_above == side);
        of_side.map(|(force, _)| force[2]).sum()
    };
    assert!(weight > 0.05);
    let (up, down) = (carried(true), carried(false));
    assert!((up / weight - 1.0).abs() < 1e-6, "{up} {weight}");
    assert!((up + down).abs() < 1e-12 * weight, "{up} {down}");
    assert!(cut.pressed.tools.lips_report(&state).contacts > 0);
    // Heights of nodes that were one: by the slope they differ by less than a hundredth of an edge.
    assert!(cut.overlap(&state) < 1e-4, "{}", cut.overlap(&state));
}

/// Without friction and damping the upper half slides as far as a point mass.
#[test]
fn the_upper_half_slides_on_its_lips_by_its_own_weight_alone() {
    let mut shape = Block::of([0.04, 0.04, HEIGHT], [2, 2, 4]);
    shape.gravity = Some([0.8, 0.0, -1.0]);
    let cut = Cut::of(&shape, Vec::new());
    let above = cut.is_above();
    let kind = Options::new().with("kind", OptionValue::Text("ie".into()));
    let limit = cut.pressed.stable_step();
    let runs = [
        ("cnn-energy", &kind, 0.1e-3),
        ("cnn-energy", &kind, 1e-3),
        ("cnn-energy", &kind, 4.5 * limit),
        ("cnn-stabilised", &Options::new(), 2.3 * limit),
        ("cnn-stabilised", &Options::new(), 4.5 * limit),
    ];
    for (id, options, dt) in runs {
        let mut state = cut.pressed.at_rest();
        let steps = (0.1_f64 / dt).round() as usize;
        cut.pressed
            .run_with(&mut state, (id, options.clone()), dt, steps);
        let masses = cut.pressed.model.mass().as_chunks::<3>().0;
        let speeds = state.v.as_chunks::<3>().0;
        let moving = masses.iter().zip(speeds).zip(&above);
        let moving = moving.filter(|(_, is_above)| **is_above);
        let [momentum, mass] = moving.fold([0.0; 2], |[p, m], ((mass, v), _)| {
            [p + mass[0] * v[0], m + mass[0]]
        });
        // The network's first step has half of the force.
        let halves = if id == "cnn-stabilised" { 0.5 } else { 0.0 };
        let found = momentum / mass / (0.8 * dt * (steps as f64 - halves));
        assert!((found - 1.0).abs() < 0.03, "{id}, {dt} s: {found}");
    }
}

#[test]
fn halves_that_meet_keep_their_momentum_and_make_no_energy() {
    let mut shape = Block::of([0.02, 0.02, HEIGHT], [2, 2, 4]);
    (shape.is_held, shape.nu) = (false, 0.3);
    let cut = Cut::of(&shape, Vec::new());
    let mut state = cut.pressed.at_rest();
    // They drift together.
    for (cell, is_above) in cut.is_above().into_iter().enumerate() {
        state.v[3 * cell + 2] = if is_above { -0.1 } else { 0.2 };
    }
    let (speed, _) = cut.pressed.mean_velocity(&state, 2);
    let dt = 0.5 * cut.pressed.stable_step();
    let (mut last, mut largest, mut contacts) = (None, 0.0_f64, 0);
    for _ in 0..(0.05 / dt) as usize {
        let before = state.clone();
        cut.pressed.run(&mut state, "central-difference", dt, 1);
        let energy = staggered_energy(&cut.pressed.model, &before, &state, dt);
        largest = largest.max(energy);
        let rise = energy - last.replace(energy).unwrap_or(energy);
        assert!(
            rise < 1e-9 * largest,
            "{rise} of {largest} at {} s",
            state.t()
        );
        contacts += cut.pressed.tools.lips_report(&state).contacts;
    }
    assert!(contacts > 9, "{contacts}");
    let (now, _) = cut.pressed.mean_velocity(&state, 2);
    assert!((now / speed - 1.0).abs() < 1e-12, "{now} {speed}");
    let apart = cut
        .lips
        .iter()
        .map(|[below, above]| state.u[3 * *above as usize + 2] - state.u[3 * *below as usize + 2]);
    assert!(apart.fold(f64::INFINITY, f64::min) > 0.0, "they part again");
}

/// A ball with friction on the upper half, which slides on the cut faces.
fn pressed_by_a_ball() -> Cut {
    let shape = Block::of([0.04, 0.04, HEIGHT], [4; 3]).with_mass_damping(2.0);
    let rows = [(0.0, [0.02, 0.02, 0.0502]), (0.1, [0.023, 0.02, 0.044])];
    let mut ball = tool(Convex::sphere(0.01).unwrap(), through(&rows, [0.0; 3]));
    ball.friction = 0.2;
    Cut::of(&shape, vec![ball])
}

#[test]
fn a_motion_with_lips_goes_on_from_bytes_with_the_same_bits() {
    let cut = pressed_by_a_ball();
    for (id, dt) in [("central-difference", 5e-4), ("cnn-stabilised", 3e-3)] {
        let mut whole = cut.pressed.at_rest();
        cut.pressed.run(&mut whole, id, dt, 60);
        let mut part = cut.pressed.at_rest();
        cut.pressed.run(&mut part, id, dt, 50);
        assert!(cut.pressed.tools.lips_report(&part).contacts > 0, "{id}");
        let bytes = part.to_bytes(&cut.pressed.model).unwrap();
        let mut part = State::from_bytes(&bytes, &cut.pressed.model).unwrap();
        cut.pressed.run(&mut part, id, dt, 10);
        assert!(whole == part, "{id}");
        let report = cut.pressed.tools.lips_report(&whole);
        assert!(
            report.contacts > 0 && report.largest_residual < 0.01,
            "{report:?}"
        );
    }
}

#[test]
fn what_is_beyond_the_surface_and_more_tools_than_there_may_be_are_refused() {
    let cells: Vec<TouchedCell> = (0..3)
        .map(|cell| TouchedCell {
            cell,
            rest: [f64::from(cell), 0.0, 0.0],
            free: [true; 3],
        })
        .collect();
    let ball = |number: usize| Tool {
        name: format!("ball {number}"),
        ..tool(
            Convex::sphere(0.01).unwrap(),
            Motion::Held(Pose::identity()),
        )
    };
    let refused = |tool: Tool, triangles: Vec<TouchedTriangle>| {
        let refused = Tools::with_triangles(vec![tool], cells.clone(), triangles);
        let refused = refused.err().unwrap();
        assert_eq!(refused.tool(), Some("ball 0"));
        refused.to_string()
    };
    let on_cells = |places: &[u32]| Tool {
        cells: places.to_vec(),
        ..ball(0)
    };
    assert_eq!(
        refused(on_cells(&[2, 3]), Vec::new()),
        "\"ball 0\" may touch cell 3 of 3: expected a place below their number"
    );
    let on_triangle = |place: u32| Tool {
        triangles: vec![place],
        ..ball(0)
    };
    let triangle = |last: u32| TouchedTriangle {
        corners: [Corner::Cell(0), Corner::Held([0.0; 3]), Corner::Cell(last)],
    };
    for (place, last) in [(1, 2), (0, 3)] {
        assert_eq!(
            refused(on_triangle(place), vec![triangle(last)]),
            format!(
                "\"ball 0\" may touch triangle {place} of 1: expected a place below their number, and corners below that of cells"
            )
        );
    }
    let sound = Tools::with_triangles(vec![on_triangle(0)], cells.clone(), vec![triangle(2)]);
    let face = |place: u32| CutFace {
        corners: [[0, 1, 2], [0, 1, place]].map(|side: [u32; 3]| side.map(Corner::Cell)),
    };
    let refused = sound.unwrap().with_cut_faces(vec![face(2), face(3)]);
    let refused = refused.err().unwrap();
    assert_eq!(refused, ToolsError::NoLip { place: 3, cells: 3 });
    assert_eq!(refused.tool(), None);
    assert_eq!(
        refused.to_string(),
        "a cut face has cell 3 of 3: expected a place below their number"
    );
    assert!(Tools::new((0..64).map(ball).collect(), cells.clone()).is_ok());
    let refused = Tools::new((0..65).map(ball).collect(), cells)
        .err()
        .unwrap();
    assert_eq!(
        refused,
        ToolsError::TooMany {
            count: 65,
            most: 64
        }
    );
    assert_eq!(refused.to_string(), "65 tools: expected at most 64");
}

//! A block of tissue under a tool in the hand of a device.

use std::sync::Arc;

use sinew_core::{Inputs, Options, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Element, Fixed, FromMesh, Law, Model, Problem, Rayleigh, Region, Tissue};
use sinew_haptics::{Body, ToolSimulation};
use sinew_mesh::structured::{Split, block};
use sinew_tools::{Convex, Motion, Pose, Shape, Steering, Tool, Tools, TouchedCell};

/// Young's modulus (Pa).
const E: f64 = 3500.0;
/// Edge of the block (m).
pub(crate) const EDGE: f64 = 0.06;

/// A linear block.
pub(crate) fn linear() -> Law {
    Law::Linear {
        youngs_modulus: E,
        poissons_ratio: 0.3,
    }
}

/// A block that stiffens when pressed.
pub(crate) fn neo_hookean() -> Law {
    Law::Hyperelastic {
        id: "neo-hookean",
        parameters: Parameters::new(E, 0.3),
    }
}

/// The block under a tool of this shape, turned by a rotation vector (rad).
pub(crate) fn under(shape: Convex, rotation_vector: [f64; 3], law: Law) -> Body {
    let mesh = block([6; 3], [EDGE; 3], Split::Kuhn).unwrap();
    let problem = Problem {
        regions: vec![Region {
            group: None,
            density: 1060.0,
            law,
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
    let model = Model::build(&mesh, &problem).unwrap();
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
    let place = [0.5 * EDGE, 0.5 * EDGE, EDGE + 0.022];
    let above = Motion::Held(Pose::new(place, rotation_vector));
    let tool = Tool {
        name: "tool".to_owned(),
        shape: Shape::of(shape),
        motion: Motion::Steered(Box::new(above), steering),
        body: None,
        friction: 0.0,
        cells: (0..cells.len() as u32).collect(),
        triangles: Vec::new(),
        grasp: None,
    };
    let tools = Arc::new(Tools::new(vec![tool], cells).unwrap());
    let system: Arc<dyn System> = Arc::new(model.with_contact(tools.clone()));
    Body {
        system,
        tools,
        tool: 0,
        steering,
        inputs,
    }
}

/// The block in steps of `dt` (s) by a method.
pub(crate) fn simulation(body: Body, method: &str, dt: f64) -> ToolSimulation {
    let integrator = sinew_integrators::build(method, &Options::new()).unwrap();
    ToolSimulation::new(body, integrator, dt)
}

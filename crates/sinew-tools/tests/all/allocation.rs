//! Contact allocates nothing in a step.

use crate::common::pressed;

use pressed::{Block, Pressed, through, tool};
use sinew_core::{Batch, CountingAllocator, Inputs, OptionValue, Options};
use sinew_tools::{Convex, Grasp, Tool, ToolBody};

fn ball(x: f64) -> Tool {
    let down = [(0.0, [x, 0.03, 0.0801]), (0.1, [x, 0.03, 0.07])];
    let grasp = Grasp {
        from: 0.05,
        to: 1.0,
    };
    Tool {
        name: format!("ball at {x}"),
        friction: 0.3,
        grasp: Some(grasp),
        ..tool(Convex::sphere(0.02).unwrap(), through(&down, [0.0; 3]))
    }
}

#[test]
fn steps_with_contacts_allocate_nothing() {
    allocate_nothing(vec![ball(0.03)]);
}

#[test]
fn steps_with_contacts_of_bodies_allocate_nothing() {
    let body = ToolBody {
        mass: 0.1,
        inertia: [1e-5; 3],
        coupling: 1e3,
        rotational_coupling: 1.0,
        damping: 1.0,
    };
    let left = Tool {
        body: Some(body),
        ..ball(0.02)
    };
    allocate_nothing(vec![left, ball(0.04)]);
}

#[test]
fn steps_with_contacts_of_thin_tips_allocate_nothing() {
    let rows = [(0.0, [0.028, 0.031, 0.0611]), (0.1, [0.028, 0.031, 0.053])];
    let tip = tool(Convex::sphere(0.001).unwrap(), through(&rows, [0.0; 3]));
    let cube = Block::of([0.06; 3], [8; 3]).with_mass_damping(5.0);
    under_allocates_nothing(&cube.with_triangles(vec![tip]), 0);
}

fn allocate_nothing(tools: Vec<Tool>) {
    let cube = Block::of([0.06; 3], [8; 3]).with_mass_damping(5.0);
    under_allocates_nothing(&cube.with(tools), 3);
}

fn under_allocates_nothing(pressed: &Pressed, contacts: usize) {
    for machine in ["reference", "general"] {
        let options = Options::new().with("machine", OptionValue::Text(machine.into()));
        let mut integrator = sinew_integrators::build("central-difference", &options).unwrap();
        let mut state = pressed.at_rest();
        let mut take = |steps| {
            let mut batch = Batch::new(&pressed.model, Inputs::none(), 1e-3, steps);
            CountingAllocator::count(|| {
                batch.take(&mut *integrator, &mut state).unwrap();
            })
        };
        assert!(take(20) > 0, "set-up does");
        take(1);
        let (few, many) = (take(1), take(98));
        assert_eq!(
            few, many,
            "{machine}: what a batch needs, and nothing for each step"
        );
        assert!(pressed.tools.report(&state, 0).contacts > contacts);
    }
}

//! Time that contact adds to a step.
//!
//! `cargo bench -p sinew-tools --bench meeting` takes steps of central difference on structured cubes without a tool,
//! with one that is far away and with a ball that presses, in turn, and prints the least time of a step (us) on one
//! thread and the time that contact adds to it. A number after `--` is the time for each figure (ms).

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark ends in a panic and prints"
)]

use std::sync::Arc;
use std::time::{Duration, Instant};

use sinew_core::{Batch, Inputs, Integrator, Options, State, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Fixed, Law, Model, Problem, Region};
use sinew_mesh::structured::{Split, cube};
use sinew_tools::{Convex, Motion, Row, Shape, Table, Tool, Tools, TouchedCell};

const EDGE: f64 = 0.1;

/// Steps of a lap.
const STEPS: usize = 50;

fn main() {
    let mut numbers = std::env::args().filter_map(|argument| argument.parse::<u64>().ok());
    let time = Duration::from_millis(numbers.next().unwrap_or(1000));
    println!("us a step: without a tool | one far away | one that presses, its contacts");
    for cells in [10, 20] {
        for (name, law) in laws() {
            let bodies = [None, Some(0.5), Some(EDGE + 0.012)];
            let mut laps: Vec<Lap> = bodies
                .map(|height| Lap::new(cells, law.clone(), height))
                .into();
            let start = Instant::now();
            while start.elapsed() < time {
                laps.iter_mut().for_each(Lap::make);
            }
            let plain = laps[0].micros();
            println!(
                "  {:5} nodes, {name:<12} {plain:8.2} | {:8.2} ({:+.1} %) | {:8.2} ({:+.1} %), {}",
                (cells + 1_usize).pow(3),
                laps[1].micros(),
                100.0 * (laps[1].micros() / plain - 1.0),
                laps[2].micros(),
                100.0 * (laps[2].micros() / plain - 1.0),
                laps[2].contacts,
            );
        }
    }
}

fn laws() -> [(&'static str, Law); 2] {
    let linear = Law::linear(3500.0, 0.45);
    let large = Law::hyperelastic("neo-hookean", Parameters::new(3500.0, 0.45));
    [("linear", linear), ("neo-hookean", large)]
}

struct Lap {
    model: Model,
    integrator: Box<dyn Integrator>,
    state: State,
    dt: f64,
    least: Duration,
    contacts: usize,
    tools: Option<Arc<Tools>>,
}

impl Lap {
    /// A cube, and a ball of 12 mm whose centre is at this height above its bottom.
    fn new(cells: usize, law: Law, height: Option<f64>) -> Self {
        let mesh = cube(cells, EDGE, Split::Kuhn).expect("the mesh is small enough");
        let problem = Problem::of([Region::new(law, 1060.0)]).with_fixed(Fixed::at("bottom"));
        let mut model = Model::build(&mesh, &problem).expect("it can be built");
        let is_outside = |point: &[f64; 3]| point.iter().any(|x| *x < 1e-9 || *x > EDGE - 1e-9);
        let cells = (0..).zip(model.nodes());
        let cells = cells.map(|(cell, node)| TouchedCell {
            cell,
            rest: mesh.points[*node as usize],
            free: [true; 3],
        });
        let cells: Vec<TouchedCell> = cells.filter(|cell| is_outside(&cell.rest)).collect();
        let tools = height.map(|height| {
            let rows = [(0.0, 0.0), (0.2, 0.008)].map(|(t, depth)| Row {
                t,
                position: [0.05, 0.05, height - depth],
                rotation_vector: [0.0; 3],
            });
            let ball = Tool {
                name: "ball".into(),
                shape: Shape::of(Convex::sphere(0.012).expect("it is round")),
                motion: Motion::Table(Table::new(rows.to_vec()).expect("times rise")),
                friction: 0.2,
                cells: (0..cells.len() as u32).collect(),
                grasp: None,
                body: None,
                triangles: Vec::new(),
            };
            Arc::new(Tools::new(vec![ball], cells).expect("they fit"))
        });
        if let Some(tools) = &tools {
            model = model.with_contact(tools.clone());
        }
        let integrator = sinew_integrators::build("central-difference", &Options::new());
        Self {
            state: State::at_rest(model.dofs()),
            model,
            integrator: integrator.expect("it exists"),
            dt: 2e-4,
            least: Duration::MAX,
            contacts: 0,
            tools,
        }
    }

    fn make(&mut self) {
        let mut batch = Batch::new(&self.model, Inputs::none(), self.dt, STEPS);
        let before = Instant::now();
        let taken = batch.take(&mut *self.integrator, &mut self.state);
        self.least = self.least.min(before.elapsed());
        taken.expect("the steps are stable");
        if let Some(tools) = &self.tools {
            self.contacts = tools.report(&self.state, 0).contacts;
        }
    }

    fn micros(&self) -> f64 {
        self.least.as_secs_f64() * 1e6 / STEPS as f64
    }
}

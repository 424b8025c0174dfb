//! Blocks of tissue under tools.

use std::sync::Arc;

use sinew_core::{Options, Run, StableStep, State, System, simulate};
use sinew_fem::{Element, Fixed, FromMesh, Law, Model, Problem, Rayleigh, Region, Tissue};
use sinew_mesh::structured::{Split, block};
use sinew_tools::{Convex, Motion, Row, Shape, Table, Tool, Tools, TouchedCell};

/// Young's modulus (Pa).
pub(crate) const E: f64 = 3500.0;
/// Density (kg/m^3).
const DENSITY: f64 = 1060.0;

/// A block of linear tissue whose nodes tools may touch.
pub(crate) struct Pressed {
    pub(crate) model: Model,
    pub(crate) tools: Arc<Tools>,
}

#[derive(Clone, Copy)]
pub(crate) struct Block {
    pub(crate) size: [f64; 3],
    pub(crate) cells: [usize; 3],
    pub(crate) nu: f64,
    pub(crate) damping: Rayleigh,
    pub(crate) is_held: bool,
    pub(crate) gravity: Option<[f64; 3]>,
}

impl Block {
    pub(crate) fn of(size: [f64; 3], cells: [usize; 3]) -> Self {
        Self {
            size,
            cells,
            nu: 0.0,
            damping: Rayleigh::default(),
            is_held: true,
            gravity: None,
        }
    }

    pub(crate) fn with_mass_damping(mut self, mass: f64) -> Self {
        self.damping.mass = mass;
        self
    }

    pub(crate) fn problem(&self) -> Problem {
        let bottom = Fixed {
            on: "bottom".into(),
            axes: [true; 3],
        };
        Problem {
            regions: vec![Region {
                group: None,
                density: DENSITY,
                law: Law::Linear {
                    youngs_modulus: E,
                    poissons_ratio: self.nu,
                },
                element: Element::P1,
                tissue: Tissue::default(),
                from_mesh: FromMesh::default(),
            }],
            damping: self.damping,
            fixed: if self.is_held {
                vec![bottom]
            } else {
                Vec::new()
            },
            gravity: self.gravity,
            ..Problem::default()
        }
    }

    /// The block with tools that may touch all of its nodes that move.
    pub(crate) fn with(&self, tools: Vec<Tool>) -> Pressed {
        let mesh = block(self.cells, self.size, Split::Kuhn).unwrap();
        let model = Model::build(&mesh, &self.problem()).unwrap();
        let pinned = model.pinned().as_chunks::<3>().0;
        let cells = (0..).zip(model.nodes()).zip(pinned);
        let cells = cells.map(|((cell, node), held)| TouchedCell {
            cell,
            rest: mesh.points[*node as usize],
            free: held.map(|held| !held),
        });
        let cells: Vec<TouchedCell> = cells.collect();
        let all: Vec<u32> = (0..cells.len() as u32).collect();
        let tools = tools.into_iter().map(|tool| Tool {
            cells: all.clone(),
            ..tool
        });
        let tools = Arc::new(Tools::new(tools.collect(), cells).unwrap());
        Pressed {
            model: model.with_contact(tools.clone()),
            tools,
        }
    }
}

impl Pressed {
    pub(crate) fn at_rest(&self) -> State {
        State::at_rest(self.model.dofs())
    }

    pub(crate) fn run(&self, state: &mut State, method: &str, dt: f64, steps: usize) {
        self.run_with(state, (method, Options::new()), dt, steps);
    }

    pub(crate) fn run_with(
        &self,
        state: &mut State,
        method: (&str, Options),
        dt: f64,
        steps: usize,
    ) {
        let mut integrator = sinew_integrators::build(method.0, &method.1).unwrap();
        let run = Run {
            dt,
            steps,
            divergence_limit: f64::INFINITY,
        };
        simulate(&self.model, &mut *integrator, state, &run, &mut ()).unwrap();
    }

    pub(crate) fn stable_step(&self) -> f64 {
        let integrator = sinew_integrators::build("central-difference", &Options::new()).unwrap();
        match integrator.stable_step(&self.model).unwrap() {
            StableStep::UpTo(step) => step,
            other => panic!("{other:?}"),
        }
    }

    pub(crate) fn force(&self, state: &State) -> [f64; 3] {
        self.tools.report(state, 0).force
    }

    /// The mean velocity (m/s) along an axis, by mass, and the mass (kg).
    pub(crate) fn mean_velocity(&self, state: &State, axis: usize) -> (f64, f64) {
        let all = state.v.iter().zip(self.model.mass());
        let along = all.skip(axis).step_by(3);
        let (momentum, mass) = along.fold((0.0, 0.0), |(p, m), (v, of)| (p + v * of, m + of));
        (momentum / mass, mass)
    }
}

pub(crate) fn tool(convex: Convex, motion: Motion) -> Tool {
    Tool {
        name: "probe".to_owned(),
        shape: Shape::of(convex),
        motion,
        friction: 0.0,
        cells: Vec::new(),
        grasp: None,
    }
}

/// Straight lines between positions (m) at times (s).
pub(crate) fn through(rows: &[(f64, [f64; 3])], rotation_vector: [f64; 3]) -> Motion {
    let rows = rows.iter().map(|(t, position)| Row {
        t: *t,
        position: *position,
        rotation_vector,
    });
    Motion::Table(Table::new(rows.collect()).unwrap())
}

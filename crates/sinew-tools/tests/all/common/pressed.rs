//! Blocks of tissue under tools.

use std::sync::Arc;

use sinew_core::{
    LinearSystem, LoadTime, Options, Run, StableStep, State, System, Trial, simulate, vectors,
};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Course, Element, Fixed, Law, Model, Moving, Problem, Rayleigh, Region};
use sinew_mesh::structured::{Split, block};
use sinew_tools::{
    Convex, Corner, Motion, Row, Shape, Table, Tool, Tools, TouchedCell, TouchedTriangle,
};

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
    /// The velocity (m/s) of its support.
    pub(crate) carried_at: [f64; 3],
    /// A law of large deformation instead of the linear one.
    pub(crate) law: Option<&'static str>,
    pub(crate) element: Element,
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
            carried_at: [0.0; 3],
            law: None,
            element: Element::P1,
        }
    }

    pub(crate) fn with_mass_damping(mut self, mass: f64) -> Self {
        self.damping.mass = mass;
        self
    }

    pub(crate) fn problem(&self) -> Problem {
        let is_carried = self.carried_at != [0.0; 3];
        let bottom = Fixed::at("bottom");
        let moving = Moving::new("bottom", [Course::at_velocity(self.carried_at)]);
        Problem {
            regions: vec![
                Region::new(
                    match self.law {
                        None => Law::linear(E, self.nu),
                        Some(id) => Law::hyperelastic(id, Parameters::new(E, self.nu)),
                    },
                    DENSITY,
                )
                .with_element(self.element),
            ],
            damping: self.damping,
            fixed: match self.is_held && !is_carried {
                true => vec![bottom],
                false => Vec::new(),
            },
            moves: match is_carried {
                true => vec![moving],
                false => Vec::new(),
            },
            gravity: self.gravity,
            ..Problem::default()
        }
    }

    /// The block with tools that may touch all of its moving nodes.
    pub(crate) fn with(&self, tools: Vec<Tool>) -> Pressed {
        self.touched_by(tools, false)
    }

    /// The block with tools that also have contact with the triangles of its surface.
    pub(crate) fn with_triangles(&self, tools: Vec<Tool>) -> Pressed {
        self.touched_by(tools, true)
    }

    fn touched_by(&self, tools: Vec<Tool>, meet_triangles: bool) -> Pressed {
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
        let corner = |node: u32| match model.cell_of_node(node) {
            Some(cell) => Corner::Cell(cell),
            None => Corner::Held(mesh.points[node as usize]),
        };
        let triangles = match meet_triangles {
            true => mesh.boundary(None),
            false => Vec::new(),
        };
        let triangles: Vec<TouchedTriangle> = triangles
            .into_iter()
            .map(|nodes| TouchedTriangle {
                corners: nodes.map(corner),
            })
            .collect();
        let tools = tools.into_iter().map(|tool| Tool {
            cells: all.clone(),
            triangles: (0..triangles.len() as u32).collect(),
            ..tool
        });
        let tools = Tools::with_triangles(tools.collect(), cells, triangles.clone());
        let tools = Arc::new(tools.unwrap());
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
        body: None,
        triangles: Vec::new(),
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

/// Kinetic and elastic energy (J) of a state whose velocity holds at its time.
pub(crate) fn energy(pressed: &Pressed, state: &State) -> f64 {
    let masses = state.v.iter().zip(pressed.model.mass());
    let kinetic: f64 = masses.map(|(v, m)| 0.5 * m * v * v).sum();
    let mut force = vec![0.0; state.u.len()];
    let system: &dyn System = &pressed.model;
    let law = system.as_elastic().unwrap();
    let trial = Trial::of(state, LoadTime::at(state.t()));
    kinetic + law.elastic_force(&trial, &mut force).unwrap().energy
}

/// `(v' (M - dt^2/4 K) v + u' K u)/2` of central difference's step, u being the mean of both displacements.
pub(crate) fn staggered_energy(model: &Model, before: &State, after: &State, dt: f64) -> f64 {
    let matrix = model.operators().stiffness();
    let quadratic = |x: &[f64]| {
        let mut out = vec![0.0; x.len()];
        matrix.multiply(x, &mut out);
        vectors::dot(x, &out)
    };
    let both = before.u.iter().zip(&after.u);
    let mean: Vec<f64> = both.map(|(a, b)| 0.5 * (a + b)).collect();
    let moving = after.v.iter().zip(model.mass());
    let kinetic: f64 = moving.map(|(v, m)| m * v * v).sum();
    0.5 * (kinetic - dt * dt / 4.0 * quadratic(&after.v) + quadratic(&mean))
}

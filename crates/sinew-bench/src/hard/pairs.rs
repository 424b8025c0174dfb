//! Copies of a scene in another frame or in other units.

use sinew_core::{LinearModel, State, System};
use sinew_fem::{LoadKind, Model, Problem};
use sinew_mesh::TetMesh;
use sinew_scene::{BodyModel, Simulation};

use sinew_verify::LabError;

/// A system and the state from which it starts.
pub(crate) struct Twin {
    pub(crate) system: Box<dyn System>,
    pub(crate) start: State,
}

/// The mesh and the problem of a scene's body.
pub(crate) fn body(simulation: &Simulation) -> Option<(&BodyModel, &Problem)> {
    let built = simulation.model().body()?;
    Some((built, &built.problem))
}

/// A rotation by 90 degrees about a coordinate axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuarterTurn(
    /// 0, 1, 2 for x, y, z.
    pub(crate) usize,
);

impl QuarterTurn {
    pub(crate) fn of(self, vector: [f64; 3]) -> [f64; 3] {
        let (a, b) = ((self.0 + 1) % 3, (self.0 + 2) % 3);
        let mut turned = vector;
        turned[a] = -vector[b];
        turned[b] = vector[a];
        turned
    }

    /// Rotates every node's vector.
    pub(crate) fn of_field(self, field: &[f64]) -> Vec<f64> {
        let vectors = field.as_chunks::<3>().0.iter();
        vectors.flat_map(|vector| self.of(*vector)).collect()
    }

    fn of_axes(self, held: [bool; 3]) -> [bool; 3] {
        let (a, b) = ((self.0 + 1) % 3, (self.0 + 2) % 3);
        let mut turned = held;
        turned.swap(a, b);
        turned
    }
}

/// A body rotated as a whole: mesh, supports, loads and start.
pub(crate) fn turned(simulation: &Simulation, turn: QuarterTurn) -> Result<Twin, LabError> {
    let (built, problem) = body(simulation)
        .ok_or_else(|| LabError::new("an oscillator has no direction and no mirror image"))?;
    let mut mesh = TetMesh::clone(&built.mesh);
    for point in &mut mesh.points {
        *point = turn.of(*point);
    }
    let mut problem = problem.clone();
    for fixed in &mut problem.fixed {
        fixed.axes = turn.of_axes(fixed.axes);
    }
    for moving in &mut problem.moves {
        moving.axes = turn.of_axes(moving.axes);
        for course in &mut moving.courses {
            course.displacement = turn.of(course.displacement);
        }
    }
    for load in &mut problem.loads {
        load.kind = match load.kind {
            LoadKind::Traction(traction) => LoadKind::Traction(turn.of(traction)),
            LoadKind::Force(force) => LoadKind::Force(turn.of(force)),
            pressure @ (LoadKind::Pressure(_) | LoadKind::FollowingPressure(_)) => pressure,
        };
    }
    problem.gravity = problem.gravity.map(|gravity| turn.of(gravity));
    let start = simulation.initial_state();
    let start = State::new(turn.of_field(&start.u), turn.of_field(&start.v));
    twin(&mesh, &problem, start)
}

/// A body measured in another unit of length, with `per_metre` units in a metre; kilograms and seconds are unchanged.
pub(crate) fn in_units(simulation: &Simulation, per_metre: f64) -> Result<Twin, LabError> {
    let start = simulation.initial_state();
    let scaled = |field: &[f64]| field.iter().map(|x| per_metre * x).collect();
    let start = State::new(scaled(&start.u), scaled(&start.v));
    let Some((built, problem)) = body(simulation) else {
        return oscillator_in_units(simulation.system(), start, per_metre);
    };
    let mut mesh = TetMesh::clone(&built.mesh);
    mesh.points
        .iter_mut()
        .flatten()
        .for_each(|x| *x *= per_metre);
    let mut problem = problem.clone();
    for region in &mut problem.regions {
        region.density /= per_metre.powi(3);
        region.law.scale_stiffness(1.0 / per_metre);
    }
    let times = |vector: [f64; 3], factor: f64| vector.map(|x| factor * x);
    for course in problem
        .moves
        .iter_mut()
        .flat_map(|moving| &mut moving.courses)
    {
        course.displacement = times(course.displacement, per_metre);
    }
    for load in &mut problem.loads {
        load.kind = match load.kind {
            LoadKind::Traction(traction) => LoadKind::Traction(times(traction, 1.0 / per_metre)),
            LoadKind::Pressure(pressure) => LoadKind::Pressure(pressure / per_metre),
            LoadKind::FollowingPressure(pressure) => {
                LoadKind::FollowingPressure(pressure / per_metre)
            }
            LoadKind::Force(force) => LoadKind::Force(times(force, per_metre)),
        };
    }
    problem.gravity = problem.gravity.map(|gravity| times(gravity, per_metre));
    twin(&mesh, &problem, start)
}

/// An oscillator in another unit of length: the units of mass, stiffness and damping contain no length, that of force
/// does.
fn oscillator_in_units(
    system: &dyn System,
    start: State,
    per_metre: f64,
) -> Result<Twin, LabError> {
    let linear = system
        .as_linear()
        .ok_or_else(|| LabError::new("needs the matrices of a linear system"))?;
    let operators = linear.operators().clone();
    let mut loads = operators.loads().to_vec();
    for (_, force) in loads.iter_mut().flat_map(|load| &mut load.entries) {
        *force *= per_metre;
    }
    let operators = operators.with_loads(loads)?;
    let system = Box::new(LinearModel::new(operators));
    Ok(Twin { system, start })
}

fn twin(mesh: &TetMesh, problem: &Problem, start: State) -> Result<Twin, LabError> {
    let model = Model::build(mesh, problem)?;
    let system = Box::new(model);
    Ok(Twin { system, start })
}

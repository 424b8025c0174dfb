//! The reproduction scene of the paper's second example, section 4.2: a cube of edge 0.2 m fixed at its four lateral
//! faces, of uncalibrated springs under mass damping, with 500 Pa on its top from t = 0 on.

use std::sync::OnceLock;

use sinew_core::{
    Damping, Integrator, LinearModel, LinearOperators, LinearSystem, Load, Options, Run, RunReport,
    State, System,
};
use sinew_fem::{Law, LoadKind, LoadSpec, Model, Problem, Rayleigh, SpringRule};
use sinew_mesh::structured::{self, Split};

use super::tissue::{body, held};
use super::{build, watch};

/// The time between two instants at which errors are taken [s].
pub(crate) const INSTANT: f64 = 0.02;
/// Instants after t = 0.
const INSTANTS: usize = 50;

/// Springs after Lloyd, Szekely and Harders, uncalibrated, with these dashpots.
pub(crate) fn springs(damping_ratio: f64) -> Law {
    Law::Springs {
        youngs_modulus: 3500.0,
        rule: SpringRule::Lloyd,
        calibrate: false,
        damping_ratio,
    }
}

/// A cube fixed at its four lateral faces under 500 Pa on its top.
pub(crate) fn scene(cells: usize, edge: f64, law: Law, damping: Rayleigh) -> Model {
    let mesh = structured::cube(cells, edge, Split::Kuhn).unwrap();
    Model::build(&mesh, &problem(law, damping, [0.0, 0.0, -500.0])).unwrap()
}

/// A body fixed at its four lateral faces under a traction on its top (Pa).
pub(crate) fn problem(law: Law, damping: Rayleigh, traction: [f64; 3]) -> Problem {
    Problem {
        damping,
        fixed: vec![held("sides", [true; 3])],
        loads: vec![LoadSpec::new("top", LoadKind::Traction(traction))],
        ..body(law)
    }
}

/// Damping in proportion to the mass.
pub(crate) fn mass_damping(mass: f64) -> Rayleigh {
    Rayleigh::new(mass, 0.0)
}

/// The cube with `cells` grid cells along each edge.
pub(crate) fn cube(cells: usize) -> Model {
    scene(cells, 0.2, springs(0.0), mass_damping(80.0))
}

/// The matrices of a model under other damping and other loads.
pub(crate) fn altered(model: &Model, damping: Damping, loads: Vec<Load>) -> LinearModel {
    let operators = model.operators();
    let stiffness = operators.stiffness().as_ref().clone();
    let mass = operators.mass().to_vec();
    LinearModel::new(LinearOperators::new(mass, stiffness, damping, loads).unwrap())
}

/// The paper's cube of ten cells.
pub(crate) fn paper_cube() -> &'static Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL.get_or_init(|| cube(10))
}

/// Displacements at 51 instants of the first second, and the outcome of the run.
pub(crate) fn run(
    model: &Model,
    integrator: &mut dyn Integrator,
    steps_per_instant: usize,
) -> (Vec<Vec<f64>>, State, RunReport) {
    let run = Run {
        steps: INSTANTS * steps_per_instant,
        ..Run::covering(1.0, INSTANT / steps_per_instant as f64)
    };
    let mut step = 0;
    let mut instants = Vec::new();
    let start = State::at_rest(model.dofs());
    let (state, report) = watch(model, integrator, start, &run, |state| {
        if step % steps_per_instant == 0 {
            instants.push(state.u.clone());
        }
        step += 1;
    });
    (instants, state, report)
}

/// The displacements of the classical Runge-Kutta method, whose error is below 1e-6.
pub(crate) fn reference() -> &'static [Vec<f64>] {
    static REFERENCE: OnceLock<Vec<Vec<f64>>> = OnceLock::new();
    REFERENCE.get_or_init(|| run(paper_cube(), &mut *build("rk4", &Options::new()), 20).0)
}

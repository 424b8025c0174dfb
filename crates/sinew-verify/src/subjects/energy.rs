//! Laws that methods fulfil to rounding.

use sinew_core::spectrum::critical_step;
use sinew_core::vectors::{dot, largest, noise, weighted_dot};
use sinew_core::{LinearModel, LinearSystem, Options, State, System};
use sinew_fem::{Element, Model};
use sinew_mesh::structured::{Split, cube};

use crate::bodies::{YOUNGS_MODULUS, body, equilibrium, held, load, stiffness_times};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::kinds::Kind;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "laws",
    title: "Laws kept to rounding",
    says: "A Kuhn cube of 4 cells a side that stands on its bottom, nu = .45, no damping unless named, from random displacements. Leapfrog keeps \
           v' M v/2 + u_n' K u_n+1/2 between steps, Newmark's method v' M v/2 + u' K u/2, for 1000 steps. The network with nothing \
           saturated takes the steps of forward Euler.",
    checks,
    quoted: &[],
};

const CELLS: usize = 4;
const STEPS: usize = 1000;

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for kind in [Kind::P1, Kind::Edge(0.9)] {
        let leapfrog = Source::ClosedForm(
            "Hairer, Lubich and Wanner, Acta Numer. 12, 2003, for linear systems",
        );
        let case = format!("central-difference, {kind}, .95 of the stable step");
        checks.push(Check::one(
            case,
            "largest relative change of energy",
            Asked::at_most(1e-11),
            leapfrog,
            move |_| energy_change("central-difference", kind, 0.95, true),
        ));
        let newmark = Source::ClosedForm(
            "Hughes, The Finite Element Method, section 9.3: beta = 1/4, gamma = 1/2",
        );
        let case = format!("newmark, {kind}, 10 times the stable step");
        checks.push(Check::one(
            case,
            "largest relative change of energy",
            Asked::at_most(1e-9),
            newmark,
            move |_| energy_change("newmark", kind, 10.0, false),
        ));
    }
    let paper = Source::Literature(
        "Zhang, Zhong, Smith and Gu, Technol. Health Care 25, 2017: identical at a small step",
    );
    checks.push(Check::one(
        "cnn and forward-euler",
        "largest difference of displacements (m)",
        Asked::value(0.0, 0.0),
        paper,
        |_| {
            let model = standing(Kind::P1)?;
            let dt = 0.01 * critical_step(model.operators());
            let run = |id, options| {
                let mut integrator = sinew_integrators::build(id, &options)?;
                let mut state = start(&model);
                for _ in 0..100 {
                    integrator.step(&model, &mut state, dt)?;
                }
                Ok::<_, LabError>(state.u)
            };
            let euler = run("forward-euler", Options::new())?;
            let network = run("cnn", Options::new().with_number("saturation", 1e6))?;
            let difference: Vec<f64> = euler.iter().zip(&network).map(|(a, b)| a - b).collect();
            Ok(largest(&difference))
        },
    ));
    let rest = Source::ClosedForm("K u = F");
    for method in [
        "central-difference",
        "newmark",
        "implicit-euler",
        "cnn-stabilised",
        "generalized-alpha",
    ] {
        checks.push(Check::one(
            format!("{method}, mass damping, after 3 s"),
            "distance from the equilibrium over its size",
            Asked::at_most(1e-8),
            rest,
            move |_| distance_from_rest(method),
        ));
    }
    checks
}

fn standing(kind: Kind) -> Result<Model, LabError> {
    let mut problem = body(YOUNGS_MODULUS, 0.45, kind.element(None));
    problem.fixed = vec![held("bottom", [true; 3])];
    Ok(Model::build(&cube(CELLS, 0.1, Split::Kuhn)?, &problem)?)
}

fn start(model: &Model) -> State {
    let u: Vec<f64> = noise(model.dofs(), 1).iter().map(|x| 1e-4 * x).collect();
    State::new(u, vec![0.0; model.dofs()])
}

/// The largest change of the energy that a method conserves, over its first value.
fn energy_change(
    method: &str,
    kind: Kind,
    of_stable: f64,
    is_staggered: bool,
) -> Result<f64, LabError> {
    let model = standing(kind)?;
    let dt = of_stable * critical_step(model.operators());
    let system = LinearModel::new(model.operators().clone());
    let mut integrator = sinew_integrators::build(method, &Options::new())?;
    let mut state = start(&model);
    let (mut first, mut worst) = (None, 0.0_f64);
    for _ in 0..STEPS {
        let before = state.u.clone();
        integrator.step(&system, &mut state, dt)?;
        let other = if is_staggered { &before } else { &state.u };
        let elastic = dot(other, &stiffness_times(&model, &state.u));
        let energy = 0.5 * (weighted_dot(model.mass(), &state.v, &state.v) + elastic);
        worst = worst.max((energy / *first.get_or_insert(energy) - 1.0).abs());
    }
    Ok(worst)
}

/// The distance from the equilibrium under a load after three seconds with mass damping of 20/s.
fn distance_from_rest(method: &str) -> Result<f64, LabError> {
    let mut problem = body(YOUNGS_MODULUS, 0.45, Element::P1);
    problem.fixed = vec![held("bottom", [true; 3])];
    problem.damping.mass = 20.0;
    problem.loads = vec![load(
        "top",
        sinew_fem::LoadKind::Traction([20.0, 0.0, -100.0]),
    )];
    let model = Model::build(&cube(CELLS, 0.1, Split::Kuhn)?, &problem)?;
    let rest = equilibrium(&model)?;
    let dt = 0.5 * critical_step(model.operators());
    let mut integrator = sinew_integrators::build(method, &Options::new())?;
    let mut state = State::at_rest(model.dofs());
    for _ in 0..(3.0 / dt) as usize {
        integrator.step(&model, &mut state, dt)?;
    }
    let difference: Vec<f64> = state.u.iter().zip(&rest).map(|(a, b)| a - b).collect();
    Ok(largest(&difference) / largest(&rest))
}

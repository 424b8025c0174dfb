//! A run on a hard case: a row with the figures that only hard cases have.

use sinew_core::{Run, State, simulate};
use sinew_integrators::explicit::Substeps;
use sinew_integrators::static_solution;
use sinew_measure::reference::ErrorNorm;
use sinew_measure::{Case, Effort, MethodChoice, Row, finite, measure};

use super::energy::{Energies, Ledger};
use sinew_verify::LabError;

/// Distance from equilibrium (relative) below which a reference counts as being at rest.
const AT_REST: f64 = 1e-3;

/// Measures a method on a case, with its step over the critical one and, if they apply, its
/// distance from equilibrium at the end and the drift of its energy.
///
/// # Errors
/// [`LabError`] when the method cannot run on this case.
pub(crate) fn hard_row(
    case: &mut Case,
    method: &MethodChoice,
    dt: f64,
    effort: Effort,
) -> Result<Row, LabError> {
    let mut row = measure(case, method, dt, effort)?;
    row.step_over_critical = case.critical_step().map(|critical| dt / critical);
    if row.error.is_none() {
        return Ok(row);
    }
    let equilibrium = equilibrium(case);
    let keeps_energy = keeps_energy(case) && method.options.get(Substeps::KEY).is_none();
    if equilibrium.is_none() && !keeps_energy {
        return Ok(row);
    }
    let (state, energies) = run_with_energies(case, method, dt, case.run(dt).steps)?;
    row.static_error = equilibrium.and_then(|rest| finite(relative_distance(&state.u, &rest)));
    if keeps_energy {
        row.energy_drift = finite(energies.drift.abs() * 1000.0 / row.steps as f64);
    }
    Ok(row)
}

/// The last state and the energies of `steps` steps.
pub(crate) fn run_with_energies(
    case: &Case,
    method: &MethodChoice,
    dt: f64,
    steps: usize,
) -> Result<(State, Energies), LabError> {
    let system = case.simulation().system();
    let linear = system
        .as_linear()
        .ok_or_else(|| LabError::new("needs the matrices of a linear system"))?;
    let mut integrator = method.build()?;
    integrator.prepare(system, dt)?;
    let entry = sinew_integrators::entry(&method.integrator);
    let form = entry.map(|entry| (entry.conserved_energy)(&integrator.facts()));
    let mut ledger = Ledger::new(linear.operators(), form.unwrap_or_default());
    let mut state = case.simulation().initial_state().clone();
    let run = Run {
        steps,
        ..case.run(dt)
    };
    simulate(system, &mut *integrator, &mut state, &run, &mut ledger)?;
    Ok((state, ledger.found))
}

/// The displacement (m) at rest under the loads at the end, if the reference comes to rest there.
pub(crate) fn equilibrium(case: &Case) -> Option<Vec<f64>> {
    let linear = case.simulation().system().as_linear()?;
    let mut force = vec![0.0; linear.operators().dofs()];
    let end = case.simulation().settings().duration;
    linear.operators().external_force(end, &mut force);
    if force.iter().all(|force| *force == 0.0) {
        return None;
    }
    let rest = static_solution(linear, &force).ok()?;
    let last = case.samples().displacements.last()?;
    (relative_distance(last, &rest) <= AT_REST).then_some(rest)
}

/// True if the system has no damping and no loads.
fn keeps_energy(case: &Case) -> bool {
    case.simulation()
        .system()
        .as_linear()
        .is_some_and(|linear| {
            let operators = linear.operators();
            let damping = operators.damping();
            damping.mass == 0.0
                && damping.stiffness == 0.0
                && damping.extra.is_none()
                && operators.loads().is_empty()
        })
}

/// `||a - b|| / ||b||`.
pub(crate) fn relative_distance(a: &[f64], b: &[f64]) -> f64 {
    let mut norm = ErrorNorm::default();
    norm.include(a, b);
    norm.relative()
}

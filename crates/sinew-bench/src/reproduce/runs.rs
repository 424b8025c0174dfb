//! The runs for figures and claims, each executed once.

use sinew_core::{Options, Run, State, simulate};

use sinew_core::vectors::largest;
use sinew_measure::Case;
use sinew_measure::reference::ErrorNorm;
use sinew_measure::{Effort, MeasureError, MethodChoice, Row, finite, measure};
use sinew_verify::LabError;

/// The paper's steps (s).
pub(super) const SMALL: f64 = 0.001;
pub(super) const LARGE: [f64; 2] = [0.015, 0.02];
/// The paper's saturation voltages (m/s).
pub(super) const VOLTAGES: [f64; 3] = [4.0, 3.2, 2.0];

/// Displacement over time, and the row of a measured run. The curves show every step, so the error is computed over
/// every step.
#[derive(Clone, Debug)]
pub(super) struct History {
    /// (t (s), u (m)) of the oscillator.
    pub(super) points: Vec<(f64, f64)>,
    pub(super) row: Row,
}

/// A state of the cube.
#[derive(Clone, Debug)]
pub(super) struct Snapshot {
    pub(super) t: f64,
    pub(super) u: Vec<f64>,
    pub(super) inverted: usize,
    pub(super) row: Row,
}

pub(super) struct Runs<'a> {
    pub(super) cube: &'a Case,
    pub(super) reference: Vec<(f64, f64)>,
    /// Forward Euler at the small and the large steps.
    pub(super) euler: [History; 3],
    /// The network at the small and the large steps, for each voltage.
    pub(super) network: [[History; 3]; 3],
    /// Largest |u| (m) of the oscillator over 18..20 s at 20 ms, for each voltage.
    pub(super) limit_cycles: [f64; 3],
    /// The cube after a second at the small step: forward Euler and the network.
    pub(super) cube_small: [Snapshot; 2],
    /// At 20 ms: forward Euler at the first instant at which a displacement exceeds the cube's edge, and the network
    /// after a second.
    pub(super) cube_large: [Snapshot; 2],
    /// Largest |u| (m) of forward Euler after a second at 20 ms, unless it overflows.
    pub(super) euler_after_a_second: f64,
}

impl<'a> Runs<'a> {
    pub(super) fn of(oscillator: &mut Case, cube: &'a mut Case) -> Result<Self, LabError> {
        if oscillator.simulation().system().dofs() != 1 {
            return Err(wrong(
                oscillator,
                "the paper's oscillator, one degree of freedom",
            ));
        }
        if cube.simulation().model().body().is_none() {
            return Err(wrong(cube, "the paper's cube, a body"));
        }
        let mut at_voltage = |index: usize| histories(oscillator, &network(VOLTAGES[index]));
        let network_histories = [at_voltage(0)?, at_voltage(1)?, at_voltage(2)?];
        let mut limit_cycles = [0.0; 3];
        for (amplitude, voltage) in limit_cycles.iter_mut().zip(VOLTAGES) {
            let points = follow(oscillator, &network(voltage), LARGE[1], 20.0)?;
            let late = points.iter().filter(|(t, _)| *t >= 18.0);
            *amplitude = late.fold(0.0, |max: f64, (_, u)| max.max(u.abs()));
        }
        let duration = cube.simulation().settings().duration;
        let edge = cube.simulation().system().extent().unwrap_or(f64::INFINITY);
        let (euler_cube, network_cube) = (euler(), network(VOLTAGES[0]));
        let whole = f64::INFINITY;
        let cube_small = [
            snapshot(cube, &euler_cube, SMALL, whole)?,
            snapshot(cube, &network_cube, SMALL, whole)?,
        ];
        let cube_large = [
            snapshot(cube, &euler_cube, LARGE[1], edge)?,
            snapshot(cube, &network_cube, LARGE[1], whole)?,
        ];
        let end = state_after(cube, &euler_cube, LARGE[1], duration, whole)?;
        Ok(Self {
            reference: reference(oscillator)?,
            euler: histories(oscillator, &euler())?,
            network: network_histories,
            limit_cycles,
            cube_small,
            cube_large,
            euler_after_a_second: largest(&end.u),
            cube,
        })
    }
}

/// The paper's explicit integration.
fn euler() -> MethodChoice {
    MethodChoice::new("forward-euler")
}

fn network(voltage: f64) -> MethodChoice {
    MethodChoice {
        integrator: "cnn".into(),
        options: Options::new().with_number("saturation", voltage),
    }
}

/// A case of the wrong kind.
pub(super) fn wrong(case: &Case, expected: &str) -> LabError {
    LabError::new(format!("{}: expected {expected}", case.id()))
}

fn failed(
    case: &Case,
    method: &MethodChoice,
    dt: f64,
    source: impl Into<MeasureError>,
) -> LabError {
    let (case, method, source) = (case.id(), &method.integrator, source.into());
    LabError::new(format!("{case}: {method} at {dt} s: {source}"))
}

/// The solution for the errors of the oscillator, fine enough for a curve.
fn reference(oscillator: &mut Case) -> Result<Vec<(f64, f64)>, LabError> {
    let track = oscillator
        .reference_at_every_step(SMALL)
        .map_err(|error| failed(oscillator, &euler(), SMALL, error))?;
    let points = track.times.iter().zip(&track.displacements);
    Ok(points.map(|(t, u)| (*t, u[0])).collect())
}

fn histories(case: &mut Case, method: &MethodChoice) -> Result<[History; 3], LabError> {
    let duration = case.simulation().settings().duration;
    let mut history = |dt: f64| {
        let mut row = measure(case, method, dt, Effort::QUICK)
            .map_err(|error| failed(case, method, dt, error))?;
        let points = follow(case, method, dt, duration)?;
        if row.error.is_some() {
            let track = case
                .reference_at_every_step(dt)
                .map_err(|error| failed(case, method, dt, error))?;
            let mut norm = ErrorNorm::default();
            for ((_, u), reference) in points.iter().zip(&track.displacements) {
                norm.include(&[*u], reference);
            }
            row.error = finite(norm.relative());
        }
        Ok::<_, LabError>(History { points, row })
    };
    Ok([history(SMALL)?, history(LARGE[0])?, history(LARGE[1])?])
}

/// (t (s), u (m)) of the first degree of freedom, from the start on, without a divergence limit.
fn follow(
    case: &Case,
    method: &MethodChoice,
    dt: f64,
    duration: f64,
) -> Result<Vec<(f64, f64)>, LabError> {
    let mut points = Vec::new();
    let mut keep = |moment: &sinew_core::Moment<'_>| {
        let state = moment.state;
        points.push((state.t(), state.u[0]));
        Ok(sinew_core::Verdict::Continue)
    };
    run(case, method, &Run::covering(duration, dt), &mut keep)?;
    Ok(points)
}

fn snapshot(
    case: &mut Case,
    method: &MethodChoice,
    dt: f64,
    limit: f64,
) -> Result<Snapshot, LabError> {
    let row = measure(case, method, dt, Effort::QUICK)
        .map_err(|error| failed(case, method, dt, error))?;
    let duration = case.simulation().settings().duration;
    let state = state_after(case, method, dt, duration, limit)?;
    let system = case.simulation().system();
    let inverted = system.inverted_elements(state.t().into(), &state.u);
    Ok(Snapshot {
        t: state.t(),
        u: state.u,
        inverted: inverted.unwrap_or(0),
        row,
    })
}

/// The state after `duration` (s), or the first state in which a displacement exceeds `limit` (m).
fn state_after(
    case: &Case,
    method: &MethodChoice,
    dt: f64,
    duration: f64,
    limit: f64,
) -> Result<State, LabError> {
    let run_settings = Run::covering(duration, dt).with_divergence_limit(limit);
    run(case, method, &run_settings, &mut ())
}

fn run(
    case: &Case,
    method: &MethodChoice,
    settings: &Run,
    recorder: &mut dyn sinew_core::Recorder,
) -> Result<State, LabError> {
    let fail = |error: MeasureError| failed(case, method, settings.dt, error);
    let mut integrator = method.build().map_err(|error| fail(error.into()))?;
    let mut state = case.simulation().initial_state().clone();
    let system = case.simulation().system();
    simulate(system, &mut *integrator, &mut state, settings, recorder)
        .map_err(|error| fail(error.into()))?;
    Ok(state)
}

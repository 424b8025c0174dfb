//! Unphysical growth of energy, if no table of energies is written.

use std::sync::Arc;

use sinew_core::{Contact, Energy, LoadTime, Moment, Ramp, RecordError, State, System, Verdict};
use sinew_scene::Simulation;
use sinew_tools::Tools;
use sinew_world::Recorder;

use crate::made_energy::{THERMAL, has_stored_energy, remedy};

/// Largest number of checks in a run.
const MOST_LOOKS: usize = 16;

/// Steps per check: a check costs about two evaluations of forces.
const STEPS_FOR_A_LOOK: usize = 100;

/// Energy, as a multiple of that of the start and the work of loads, above which a motion counts as wrong.
const FAR_BEYOND: f64 = 2.0;

/// A recorder that checks the energy of a body in large deformation several times in a run, and reports it if it is far
/// beyond the energy of the start plus the work of loads and tools.
///
/// Work of loads is summed by component, as absolute values, and damping is left out: an excess that is reported is
/// real. Scenes with other sources of energy are not checked: work of moved supports, of loads that begin and end
/// between two checks, or energy that memory stored in a deformed start.
#[derive(Debug)]
pub struct EnergyGrowth {
    /// Steps between two checks; `None` if nothing is checked.
    spacing: Option<usize>,
    /// The last step.
    end: usize,
    /// Energy of the start and work so far (J).
    given: f64,
    before: Vec<f64>,
    load: Vec<f64>,
    load_before: Vec<f64>,
    tools: Option<Arc<Tools>>,
    /// Work of tools so far (J).
    work_of_tools: f64,
    remedy: String,
    grown: Option<String>,
}

impl EnergyGrowth {
    /// Checks of a run of this simulation.
    #[must_use]
    pub fn new(simulation: &Simulation) -> Self {
        let end = simulation.run().steps;
        let looks = (end / STEPS_FOR_A_LOOK).clamp(1, MOST_LOOKS);
        let can_tell = simulation.system().as_linear().is_none()
            && simulation.model().body().is_some_and(|body| {
                let grows = |ramp: &Ramp| matches!(ramp, Ramp::Step | Ramp::Sin2 { .. });
                let mut loads = body.problem.loads.iter();
                body.problem.moves.is_empty() && loads.all(|load| grows(&load.ramp))
            })
            && !has_stored_energy(simulation);
        Self {
            spacing: can_tell.then(|| end.div_ceil(looks).max(1)),
            end,
            given: 0.0,
            before: Vec::new(),
            load: Vec::new(),
            load_before: Vec::new(),
            tools: simulation.model().tools().cloned(),
            work_of_tools: 0.0,
            remedy: remedy(simulation.body(), false),
            grown: None,
        }
    }

    /// A sentence about the energy, if it is too large.
    #[must_use]
    pub fn in_words(&self) -> Option<&str> {
        self.grown.as_deref()
    }

    fn look(&mut self, system: &dyn System, state: &State, is_first: bool) {
        let dofs = state.u.len();
        self.load.resize(dofs, 0.0);
        system.external_force(LoadTime::at(state.t()), &state.u, &mut self.load);
        // Without a finite energy, infinity.
        let energy = system.energy(&state.u, &state.v);
        let energy = energy.map_or(f64::INFINITY, Energy::total);
        let tools = self.tools.as_ref();
        let work_of_tools = tools.map_or(0.0, |tools| tools.work(state));
        if is_first {
            self.given = energy;
        } else {
            let moved = state.u.iter().zip(&self.before);
            let loads = self.load.iter().zip(&self.load_before);
            self.given += moved
                .zip(loads)
                .map(|((u, before), (load, load_before))| {
                    (u - before).abs() * load.abs().max(load_before.abs())
                })
                .sum::<f64>();
            self.given += (work_of_tools - self.work_of_tools).abs();
            let is_too_much = !(energy <= FAR_BEYOND * self.given || energy <= THERMAL);
            if self.grown.is_none() && is_too_much {
                let has = if energy.is_finite() {
                    format!("{energy:.3e} J")
                } else {
                    "more energy than numbers can tell".to_owned()
                };
                self.grown = Some(format!(
                    "the motion has {has} at t = {} s, where {} account for {:.3e} J: it is wrong; {}",
                    state.t(),
                    self.tools
                        .as_ref()
                        .map_or("start and loads", |_| "start, loads and tools"),
                    self.given,
                    self.remedy
                ));
            }
        }
        self.work_of_tools = work_of_tools;
        self.before.clone_from(&state.u);
        std::mem::swap(&mut self.load, &mut self.load_before);
    }
}

impl Recorder for EnergyGrowth {}

impl sinew_core::Recorder for EnergyGrowth {
    fn next(&mut self, step: usize) -> Option<usize> {
        let spacing = self.spacing?;
        Some(step.next_multiple_of(spacing).min(self.end.max(step)))
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        if self.spacing.is_some() {
            self.look(moment.system, moment.state, moment.step == 0);
        }
        Ok(Verdict::Continue)
    }
}

//! What the network's integrators share: templates, a sweep and the saturation option.

use sinew_cnn::{Saturation, Templates};
use sinew_core::{
    LoadTime, Needs, OptionError, OptionValue, Options, Prepared, SetupError, State, StepReport,
    System,
};

use crate::OptionHelp;
use crate::explicit::GuardOption;

/// The paper's saturation voltage (m/s).
const PAPER_Q: f64 = 4.0;

pub(super) const SATURATION: OptionHelp = OptionHelp {
    key: "saturation",
    help: "saturation voltage Q [m/s] above 0, \"auto\" for a guard in its place (steps beyond the stable one are cut, speeds limited by the energy there is), or \"off\"; default 4, the paper's",
    shown_default: Some(PAPER_Q),
};

/// The option `saturation`; its "auto" is the guard's.
pub(super) fn saturation(options: &Options, integrator: &str) -> Result<Saturation, OptionError> {
    let refused = |found: &OptionValue| OptionError::Value {
        integrator: integrator.into(),
        key: SATURATION.key.into(),
        found: found.clone(),
        expected: GuardOption::EXPECTED,
    };
    let (voltage, given) = match options.get(SATURATION.key) {
        None => (PAPER_Q, &OptionValue::Number(PAPER_Q)),
        Some(OptionValue::Text(word)) if word == "off" => return Ok(Saturation::OFF),
        Some(given @ OptionValue::Number(voltage)) if voltage.is_finite() => (*voltage, given),
        Some(given) => return Err(refused(given)),
    };
    Saturation::at(voltage).map_err(|_| refused(given))
}

/// Templates of the system at hand and the state's rate of change.
#[derive(Debug, Default)]
pub(super) struct Network {
    prepared: Prepared,
    templates: Option<Templates>,
    /// dx/dt (m/s^2) after a sweep.
    pub(super) rate: Vec<f64>,
}

impl Network {
    pub(super) fn prepare(
        &mut self,
        integrator: &'static str,
        system: &dyn System,
        dt: f64,
    ) -> Result<StepReport, SetupError> {
        if self.prepared.is_for(system, dt) {
            return Ok(StepReport::default());
        }
        let lacks = || Needs::Matrices.lacking(integrator);
        let linear = system.as_linear().ok_or_else(lacks)?;
        let mut checked = Prepared::default();
        checked.check(integrator, system, dt)?;
        // Masses were checked, the only thing templates can refuse.
        self.templates = Some(Templates::new(linear).map_err(|_| lacks())?);
        self.rate.resize(system.dofs(), 0.0);
        self.prepared = checked;
        Ok(StepReport::default())
    }

    /// One sweep over all cells, at the beginning of a step of `dt` (s).
    pub(super) fn sweep(&mut self, state: &State, dt: f64) -> StepReport {
        if let Some(templates) = &self.templates {
            let load = LoadTime::start_of(state.t(), dt);
            templates.sweep(load, &state.u, &state.v, &mut self.rate);
        }
        StepReport::ONE_FORCE
    }
}

//! Tests that each law catches the fault that it is there for.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::boxed::Boxed;
use crate::{
    Batch, EnergyBehaviour, Inputs, Integrator, LoadTime, Needs, Prepared, Properties, SetupError,
    StableStep, State, Step, StepError, StepReport, Stepped, System,
};

/// Faults of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    DropsInputs,
    TakesInputsAStepLate,
    CountsTheRecord,
    HalvesTheFirstStepOfABatch,
    RoundsOtherwiseWithoutMatrices,
    RefusesToGoWithoutMatrices,
    TakesWhatItDeclaresToRefuse,
    KnowsAStableStepWithoutSpectrum,
    StableStepAtRestOnly,
    TrialsAStepAhead,
    ForgetsInternalVariables,
    ChangesInternalVariables,
    AcceptsTwice,
    EvaluatesBesideTheState,
    GoesOnAfterARefusal,
    LimpsAfterARefusal,
    HidesTheElement,
    DropsTheThirdLayer,
    RefusesLongStepsSilently,
    TakesAStaggeredVelocityAsItIs,
}

/// Symplectic Euler.
struct Method {
    fault: Fault,
    a: Vec<f64>,
    other: Vec<f64>,
    limps: bool,
}

fn make(fault: Fault) -> Boxed {
    Box::new(Method {
        fault,
        a: Vec::new(),
        other: Vec::new(),
        limps: false,
    })
}

impl Integrator for Method {
    fn id(&self) -> &'static str {
        "faulty"
    }

    fn properties(&self) -> Properties {
        let needs = match self.fault {
            Fault::TakesWhatItDeclaresToRefuse => Needs::Matrices,
            _ => Needs::Forces,
        };
        Properties::of_order(1, needs, EnergyBehaviour::Bounded)
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        Prepared::check(self.id(), system, dt)?;
        match self.fault {
            Fault::RefusesToGoWithoutMatrices => Needs::Matrices.check(self.id(), system)?,
            Fault::RefusesLongStepsSilently if dt > 1.0 => {
                return Err(SetupError::Unresolved {
                    integrator: self.id(),
                    reason: "too long".into(),
                });
            }
            _ => {}
        }
        self.a.resize(system.dofs(), 0.0);
        self.other.resize(system.dofs(), 0.0);
        Ok(StepReport::default())
    }

    fn stable_step_about(
        &self,
        system: &dyn System,
        state: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        let spectrum = match self.fault {
            Fault::StableStepAtRestOnly => system.spectrum(None),
            _ => system.spectrum(state),
        };
        let Some(spectrum) = spectrum else {
            return Ok(match self.fault {
                Fault::KnowsAStableStepWithoutSpectrum => StableStep::UpTo(0.01),
                _ => StableStep::Unknown,
            });
        };
        if self.fault == Fault::RefusesLongStepsSilently {
            return Ok(StableStep::Any);
        }
        let (w, d) = (
            spectrum.omega_max,
            spectrum.mass_damping + spectrum.damping_max,
        );
        Ok(StableStep::UpTo(4.0 / (d + (d * d + 4.0 * w * w).sqrt())))
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        if self.fault != Fault::TakesAStaggeredVelocityAsItIs {
            batch.synchronise(state)?;
        }
        let mut first = true;
        batch.each(state, |step, state| {
            let halves = self.fault == Fault::HalvesTheFirstStepOfABatch && first;
            first = false;
            if self.fault == Fault::RefusesLongStepsSilently {
                return Ok(Stepped::at_same_time(StepReport::ONE_FORCE)); // never moves
            }
            let parts = if halves || self.limps { 2 } else { 1 };
            for part in 0..parts {
                let dt = step.dt / f64::from(parts);
                self.evaluate(&step, state, f64::from(part) * dt)?;
                for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
                    *v += dt * a;
                    *u += dt * *v;
                }
            }
            match self.fault {
                Fault::AcceptsTwice => {
                    let t = state.t();
                    let accepted = step.system.accept(state, step.inputs, step.dt);
                    accepted.map_err(|source| StepError::Refused { t, source })?;
                }
                Fault::ChangesInternalVariables => {
                    state.internal.iter_mut().for_each(|z| *z += 1.0);
                }
                _ => {}
            }
            Ok(Stepped::at_same_time(StepReport::ONE_FORCE))
        })
    }
}

impl Method {
    fn evaluate(&mut self, step: &Step<'_>, state: &State, since: f64) -> Result<(), StepError> {
        let load = LoadTime::start_of(state.t(), step.dt);
        let mut taken = *step;
        let (mut trial_dt, mut point) = (since, state.clone());
        match self.fault {
            Fault::DropsInputs | Fault::TakesInputsAStepLate => taken.inputs = Inputs::none(),
            Fault::TrialsAStepAhead => trial_dt = step.dt,
            Fault::ForgetsInternalVariables => point.internal.fill(0.0),
            Fault::EvaluatesBesideTheState => point.u.iter_mut().for_each(|u| *u *= 0.99),
            _ => {}
        }
        let point = [&point.u[..], &point.v, &point.internal];
        match taken.net_force(load, trial_dt, point, &mut self.a) {
            Err(_) if self.fault == Fault::GoesOnAfterARefusal => {}
            Err(StepError::Refused { t, mut source }) if self.fault == Fault::HidesTheElement => {
                source.element = 0;
                return Err(StepError::Refused { t, source });
            }
            Err(error) => {
                self.limps = self.fault == Fault::LimpsAfterARefusal;
                return Err(error);
            }
            Ok(()) => {}
        }
        let dark = step.system.as_linear().is_none();
        match self.fault {
            Fault::TakesInputsAStepLate => {
                let late = LoadTime::start_of(state.t() - step.dt, step.dt);
                for (sign, inputs) in [(1.0, step.inputs), (-1.0, Inputs::none())] {
                    let late = late.under(inputs);
                    step.system.external_force(late, &state.u, &mut self.other);
                    for (a, other) in self.a.iter_mut().zip(&self.other) {
                        *a += sign * other;
                    }
                }
            }
            Fault::CountsTheRecord => {
                let known = step.inputs.forces().count() as f64;
                self.a.iter_mut().for_each(|a| *a *= 1.0 + known * 1e-15);
            }
            Fault::RoundsOtherwiseWithoutMatrices if dark => {
                self.a.iter_mut().for_each(|a| *a *= 1.0 + 4e-16);
            }
            Fault::DropsTheThirdLayer if step.system.layers().count() == 3 => {
                self.a.iter_mut().skip(2).step_by(3).for_each(|a| *a = 0.0);
            }
            _ => {}
        }
        for (a, mass) in self.a.iter_mut().zip(step.system.mass()) {
            *a /= mass;
        }
        Ok(())
    }
}

crate::conformance!(the_sound_method, || make(Fault::None));

type Law = fn(&dyn Fn() -> Boxed);

fn catches(law: Law, fault: Fault) -> bool {
    law(&|| make(Fault::None));
    catch_unwind(AssertUnwindSafe(|| law(&|| make(fault)))).is_err()
}

#[test]
fn each_law_catches_its_faults() {
    use super::*;
    let laws: [(Law, &[Fault]); 15] = [
        (a_force_from_outside_is_felt, &[Fault::DropsInputs]),
        (
            forces_as_they_happen_do_what_known_ones_do,
            &[
                Fault::DropsInputs,
                Fault::TakesInputsAStepLate,
                Fault::CountsTheRecord,
            ],
        ),
        (
            channels_as_they_happen_do_what_known_loads_do,
            &[Fault::DropsInputs, Fault::TakesInputsAStepLate],
        ),
        (
            every_way_of_running_gives_the_same_bits,
            &[Fault::HalvesTheFirstStepOfABatch],
        ),
        (
            forces_are_enough_where_declared,
            &[
                Fault::RoundsOtherwiseWithoutMatrices,
                Fault::RefusesToGoWithoutMatrices,
                Fault::TakesWhatItDeclaresToRefuse,
                Fault::KnowsAStableStepWithoutSpectrum,
            ],
        ),
        (
            a_hardening_spring_swings_as_in_closed_form,
            &[
                Fault::EvaluatesBesideTheState,
                Fault::HalvesTheFirstStepOfABatch,
                Fault::RefusesToGoWithoutMatrices,
                Fault::TakesWhatItDeclaresToRefuse,
            ],
        ),
        (
            a_refusal_ends_the_run_and_keeps_what_was,
            &[
                Fault::GoesOnAfterARefusal,
                Fault::LimpsAfterARefusal,
                Fault::HidesTheElement,
            ],
        ),
        (
            stable_step_follows_the_state,
            &[Fault::StableStepAtRestOnly],
        ),
        (
            a_maxwell_element_relaxes_as_in_closed_form,
            &[
                Fault::ForgetsInternalVariables,
                Fault::ChangesInternalVariables,
                Fault::AcceptsTwice,
            ],
        ),
        (
            each_step_is_accepted_once,
            &[
                Fault::AcceptsTwice,
                Fault::ChangesInternalVariables,
                Fault::TrialsAStepAhead,
                Fault::ForgetsInternalVariables,
            ],
        ),
        (
            observed_order_is_declared_order,
            &[Fault::DropsTheThirdLayer, Fault::EvaluatesBesideTheState],
        ),
        (energy_behaves_as_declared, &[Fault::DropsTheThirdLayer]),
        (
            static_solution_is_the_equilibrium,
            &[Fault::DropsTheThirdLayer],
        ),
        (
            stable_step_is_as_declared,
            &[Fault::RefusesLongStepsSilently],
        ),
        (
            a_staggered_state_is_taken_over_at_one_time,
            &[Fault::TakesAStaggeredVelocityAsItIs],
        ),
    ];
    let mut missed = Vec::new();
    for (number, (law, faults)) in laws.into_iter().enumerate() {
        for fault in faults {
            if !catches(law, *fault) {
                missed.push((number, fault));
            }
        }
    }
    assert!(missed.is_empty(), "(number of the law, fault): {missed:?}");
}

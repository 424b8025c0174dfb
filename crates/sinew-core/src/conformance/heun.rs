//! Heun's method, which grows slowly without damping: the suite distinguishes right declarations of its stable step
//! from wrong ones.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::boxed::Boxed;
use super::stable_step_is_as_declared;
use crate::{
    Batch, EnergyBehaviour, Integrator, LoadTime, Needs, Prepared, Properties, SetupError,
    StableStep, State, Step, StepError, StepReport, Stepped, System,
};

/// The stable step that is declared.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Declared {
    /// The right one: none without damping.
    Right,
    /// The right one times this factor.
    Times(f64),
    /// This share of 2/omega_max.
    OfCritical(f64),
    /// Stable at any step.
    Any,
}

/// Heun's method (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, table II.1.1); or symplectic Euler
/// under its name, which does not grow.
struct Heun {
    declared: Declared,
    is_symplectic: bool,
    a: [Vec<f64>; 2],
    u: Vec<f64>,
    v: Vec<f64>,
}

fn make(declared: Declared, is_symplectic: bool) -> Boxed {
    Box::new(Heun {
        declared,
        is_symplectic,
        a: Default::default(),
        u: Vec::new(),
        v: Vec::new(),
    })
}

/// The longest step (s) at which `|1 + z + z^2/2| <= 1`, with `z = h lambda` and `lambda^2 + d lambda + w^2 = 0`, d > 0.
fn longest(w: f64, d: f64) -> f64 {
    let squared = w * w - 0.25 * d * d;
    let (real, imaginary) = match squared >= 0.0 {
        true => (-0.5 * d, squared.sqrt()),
        false => (-0.5 * d - (-squared).sqrt(), 0.0),
    };
    let grows = |h: f64| {
        let (x, y) = (h * real, h * imaginary);
        let (re, im) = (1.0 + x + 0.5 * (x * x - y * y), y + x * y);
        re * re + im * im > 1.0
    };
    let (mut low, mut high) = (0.0, 3.0 / real.hypot(imaginary));
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        *(if grows(middle) { &mut high } else { &mut low }) = middle;
    }
    low
}

impl Integrator for Heun {
    fn id(&self) -> &'static str {
        "heun"
    }

    fn properties(&self) -> Properties {
        Properties::of_order(2, Needs::Forces, EnergyBehaviour::Grows)
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        Prepared::check(self.id(), system, dt)?;
        let [first, second] = &mut self.a;
        for room in [first, second, &mut self.u, &mut self.v] {
            room.resize(system.dofs(), 0.0);
        }
        Ok(StepReport::default())
    }

    fn stable_step_about(
        &self,
        system: &dyn System,
        state: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        let Some(spectrum) = system.spectrum(state) else {
            return Ok(StableStep::Unknown);
        };
        let d = spectrum.mass_damping + spectrum.damping_max;
        let right = match d > 0.0 {
            true => longest(spectrum.omega_max, d),
            false => 0.0,
        };
        Ok(match self.declared {
            Declared::Right => StableStep::UpTo(right),
            Declared::Times(factor) => StableStep::UpTo(factor * right),
            Declared::OfCritical(share) => StableStep::UpTo(share * spectrum.critical_step()),
            Declared::Any => StableStep::Any,
        })
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        batch.synchronise(state)?;
        batch.each(state, |step, state| {
            self.step(&step, state)?;
            Ok(Stepped::at_same_time(StepReport {
                sweeps: 2,
                force_evaluations: 2,
                ..StepReport::default()
            }))
        })
    }
}

impl Heun {
    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<(), StepError> {
        let (t, dt) = (state.t(), step.dt);
        let Self {
            a: [a, after],
            u,
            v,
            ..
        } = self;
        let mass = step.system.mass();
        let load = LoadTime::within(t, dt, 0.0);
        step.net_force(load, 0.0, [&state.u, &state.v, &state.internal], a)?;
        a.iter_mut().zip(mass).for_each(|(a, mass)| *a /= mass);
        for dof in 0..u.len() {
            u[dof] = state.u[dof] + dt * state.v[dof];
            v[dof] = state.v[dof] + dt * a[dof];
        }
        if self.is_symplectic {
            state.v.copy_from_slice(v);
            for (u, v) in state.u.iter_mut().zip(v) {
                *u += dt * *v;
            }
            return Ok(());
        }
        let load = LoadTime::within(t, dt, 1.0);
        step.net_force(load, dt, [u, v, &state.internal], after)?;
        for dof in 0..u.len() {
            state.u[dof] += 0.5 * dt * (state.v[dof] + v[dof]);
            state.v[dof] += 0.5 * dt * (a[dof] + after[dof] / mass[dof]);
        }
        Ok(())
    }
}

crate::conformance!(a_method_that_grows_slowly, || make(Declared::Right, false));

#[test]
fn growth_is_told_from_its_absence_however_slow() {
    let is_wrong = |declared: Declared, is_symplectic: bool| {
        let law = || stable_step_is_as_declared(&|| make(declared, is_symplectic));
        catch_unwind(AssertUnwindSafe(law)).is_err()
    };
    for declared in [
        Declared::Times(1.2),
        Declared::Times(0.8),
        // Undamped, the square grows by 6e-3 in a step of a fifth of the critical one.
        Declared::OfCritical(0.2),
        Declared::OfCritical(1.0),
        Declared::Any,
    ] {
        assert!(is_wrong(declared, false), "{declared:?}");
    }
    // What is never stable, and does not grow.
    assert!(is_wrong(Declared::Right, true));
}

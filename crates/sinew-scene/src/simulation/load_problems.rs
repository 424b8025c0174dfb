//! Loads that an integrator refuses or cannot follow.

use std::fmt;

use sinew_core::LoadOverStep;

/// A load that the scene's integrator refuses in the scene's steps.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "`{integrator}` takes loads that are {}, and {load} changes at t = {instant} s, in steps of {dt} s; {remedy}",
    needed.describe()
)]
pub struct RefusedLoad {
    /// Integrator id.
    pub integrator: &'static str,
    /// The loads that the integrator takes.
    pub needed: LoadOverStep,
    /// The load in the terms of the scene.
    pub load: String,
    /// The first instant (s) at which the load does not meet the requirement.
    pub instant: f64,
    /// The step (s).
    pub dt: f64,
    /// The remedy.
    pub remedy: LoadRemedy,
}

/// A remedy for a scene whose load was refused.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum LoadRemedy {
    /// The same integrator with this step (s).
    Step(f64),
    /// The propagator's Chebyshev form with the same step.
    Chebyshev,
    /// The propagator's Chebyshev form with this step (s).
    ChebyshevWithStep(f64),
    /// An exact integrator that takes loads that jump anywhere, by its id; `None` if this program has
    /// none.
    Integrator(Option<&'static str>),
}

impl fmt::Display for LoadRemedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(dt) => write!(f, "dt = {dt} s would do"),
            Self::Chebyshev => {
                f.write_str("kind = \"chebyshev\" takes loads that are smooth over each step")
            }
            Self::ChebyshevWithStep(dt) => {
                write!(f, "kind = \"chebyshev\" with dt = {dt} s would do")
            }
            Self::Integrator(None) => f.write_str("no practical step would do"),
            Self::Integrator(Some(id)) => write!(
                f,
                "no practical step would do; `{id}` takes loads that jump anywhere"
            ),
        }
    }
}

/// A load that begins and ends within one step, or oscillates within four: its impulse is right, but its course is
/// not resolved.
#[derive(Debug, Clone, PartialEq)]
pub struct UnresolvedLoad {
    /// The load in the terms of the scene.
    pub load: String,
    /// The instant of the first of two changes (s).
    pub from: f64,
    /// Time between the two changes or quarter of a period (s): a step that resolves the load.
    pub length: f64,
    /// The period (s) of a load that oscillates.
    pub period: Option<f64>,
    /// The step (s).
    pub dt: f64,
}

impl fmt::Display for UnresolvedLoad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            load,
            from,
            length,
            period,
            dt,
        } = self;
        if let Some(period) = period {
            return write!(
                f,
                "{load} swings with a period of {period:.3e} s, of which dt = {dt} s is more than a quarter: its impulse \
                 arrives, but its course is not followed; dt = {length:.3e} s would follow it"
            );
        }
        write!(
            f,
            "{load} changes twice within {length:.3e} s at t = {from} s, less than dt = {dt} s: its impulse \
             arrives, but its course is not followed; dt = {length:.3e} s would follow it"
        )
    }
}

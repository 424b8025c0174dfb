//! The element that a motion has stiffened most, for messages.

use sinew_core::{Inputs, LoadTime, State, StiffestElement, System, Trial};

/// Stiffening above which it explains a failed step.
const TOLD: f64 = 4.0;

/// The stiffest element of a state, if it is several times as stiff as any element at rest: one pressed flat, or one
/// whose law or fibres stiffen.
pub(crate) fn stiffened_element(
    system: &dyn System,
    inputs: &Inputs,
    state: &State,
) -> Option<StiffestElement> {
    let load = LoadTime::at(state.t()).under(inputs);
    let stiffest = system
        .as_elastic()?
        .stiffest_element(&Trial::of(state, load))?;
    // A comparison that is false for NaN too.
    (stiffest.stiffening >= TOLD).then_some(stiffest)
}

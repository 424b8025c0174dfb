//! Methods without support for tools.

use std::sync::Arc;

use sinew_core::{Options, SetupError};
use sinew_fem::{Fixed, Law, Model, Problem, Region};
use sinew_mesh::structured::{Split, block};
use sinew_tools::Tools;

use super::set_up::{at_key, refusal};
use crate::decode::Place;
use crate::error::SceneError;
use crate::scene::RunSettings;

/// A step (s) that is stable on the test cube.
const STEP: f64 = 1e-6;

/// Refuses a method without support for contact, at the key that makes it one: tested on a body of one cube, since this
/// depends only on the method and its options.
pub(super) fn check(settings: &RunSettings, run: &Place) -> Result<(), SceneError> {
    let Some(stand_in) = stand_in() else {
        return Ok(());
    };
    let refusal = |options: &Options| match refusal(settings, options, &stand_in, STEP) {
        Some(refusal @ SetupError::Contact { .. }) => Some(refusal),
        _ => None,
    };
    match refusal(&settings.options) {
        Some(refused) => Err(at_key(run, &settings.options, refusal, refused)),
        None => Ok(()),
    }
}

/// A cube that supports contact but has no tool; never `None`.
fn stand_in() -> Option<Model> {
    let mesh = block([1; 3], [1.0; 3], Split::Kuhn).ok()?;
    let problem = Problem::of([Region::new(Law::linear(1000.0, 0.3), 1000.0)])
        .with_fixed(Fixed::at("bottom"));
    let model = Model::build(&mesh, &problem).ok()?;
    let tools = Tools::new(Vec::new(), Vec::new()).ok()?;
    Some(model.with_contact(Arc::new(tools)))
}

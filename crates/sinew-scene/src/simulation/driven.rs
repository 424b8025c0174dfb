//! Scenes that are steered from outside while they run.

use std::sync::Arc;

use sinew_core::{
    Channel, Inputs, LinearModel, LinearSystem, Load, OperatorError, Ramp, RampError,
};
use sinew_fem::{FemError, Item};
use sinew_tools::{Steering, ToolsError};

use super::model::{BodyModel, SceneModel};
use super::scene_body::SceneBody;
use super::{Simulation, tool};
use crate::keys::GRAVITY;
use crate::scene::Subject;

/// Reasons for which loads cannot be steered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DrivenLoadError {
    /// A load that is already steered.
    #[error(transparent)]
    Ramp(#[from] RampError),
    /// A load that a body refuses.
    #[error(transparent)]
    Body(#[from] FemError),
    /// A force that an oscillator refuses.
    #[error(transparent)]
    Oscillator(#[from] OperatorError),
}

/// The name of the force on an oscillator.
const FORCE: &str = "force";

impl Simulation {
    /// Lets inputs steer its tools, each of which follows the scene until then; returns their channels, in the order of
    /// the tools. Since they may be steered to any position, each has contact with the triangles of the surface if any
    /// of these is larger than the tool.
    ///
    /// # Errors
    /// [`ToolsError`] for tools that do not fit the surface.
    pub fn steer_tools(&mut self, inputs: &mut Inputs) -> Result<Vec<Steering>, ToolsError> {
        let duration = self.settings().duration;
        let own = Arc::make_mut(&mut self.body);
        let (SceneModel::Body(body), Subject::Body(of_scene)) =
            (&mut own.model, own.scene.subject())
        else {
            return Ok(Vec::new());
        };
        let Some(tools) = body.scene_tools() else {
            return Ok(Vec::new());
        };
        let steering: Vec<Steering> = tools
            .tools()
            .iter()
            .map(|_| Steering::new(inputs))
            .collect();
        let steered = tools.steered(&steering);
        *body = Arc::new(tool::led_anew(
            (**body).clone(),
            of_scene,
            &steered,
            duration,
        )?);
        Ok(steering)
    }
}

impl SceneBody {
    /// The names under which its loads can be steered: those of the scene, `load 2` for the second if it has none,
    /// `gravity` if there is one; `force` for that of an oscillator.
    #[must_use]
    pub fn load_names(&self) -> Vec<String> {
        let Subject::Body(body) = self.scene.subject() else {
            let force = self.oscillator_loads().first();
            return force.map(|_| FORCE.to_owned()).into_iter().collect();
        };
        let named = (1..).zip(&body.load_names);
        let named =
            named.map(|(number, name)| name.clone().unwrap_or_else(|| format!("load {number}")));
        let gravity = body.problem.gravity.map(|_| GRAVITY.to_owned());
        named.chain(gravity).collect()
    }

    fn oscillator_loads(&self) -> &[Load] {
        match &self.model {
            SceneModel::Oscillator(model) => model.operators().loads(),
            SceneModel::Body(_) => &[],
        }
    }

    /// Adds a channel of factors for each of [`SceneBody::load_names`], with which [`SceneBody::with_driven_loads`]
    /// steers them.
    ///
    /// # Errors
    /// [`DrivenLoadError::Ramp`] for a load that is already steered.
    pub fn add_load_channels(&self, inputs: &mut Inputs) -> Result<Vec<Channel>, DrivenLoadError> {
        let ramps: Vec<Ramp> = match self.scene.subject() {
            Subject::Body(body) => {
                let loads = body.problem.loads.iter().map(|load| load.ramp.clone());
                loads
                    .chain(body.problem.gravity.map(|_| Ramp::Step))
                    .collect()
            }
            Subject::Oscillator(_) => {
                let force = self.oscillator_loads().iter();
                force.map(|load| load.ramp.clone()).collect()
            }
        };
        let channels = ramps.into_iter().map(|ramp| inputs.add_factor_of(ramp));
        Ok(channels.collect::<Result<_, _>>()?)
    }

    /// The same body, with loads that are multiplied by the factors of these channels, in addition to their own
    /// courses over time. Its matrices are shared; no force changes until a factor is given.
    ///
    /// # Errors
    /// [`DrivenLoadError`] if the system refuses its loads.
    pub fn with_driven_loads(&self, channels: &[Channel]) -> Result<Self, DrivenLoadError> {
        let driven = |place: usize| channels.get(place).map(|channel| Ramp::Input(*channel));
        let model = match &self.model {
            SceneModel::Body(body) => {
                // Behind those of the scene, of which some may be gone.
                let gravity = channels.len().saturating_sub(1);
                // Cuts leave out loads of which all that they act on is gone.
                let place_of = |place: usize| match &body.cut {
                    Some(from) => from.loads.get(place).copied(),
                    None => Some(place),
                };
                let model = body.model.with_ramps(|item| match item {
                    Item::Load(place) => place_of(place).and_then(driven),
                    Item::Gravity => driven(gravity),
                    _ => None,
                })?;
                let body = BodyModel {
                    model,
                    ..(**body).clone()
                };
                SceneModel::Body(Arc::new(body))
            }
            SceneModel::Oscillator(model) => {
                let mut loads = model.operators().loads().to_vec();
                for (place, load) in loads.iter_mut().enumerate() {
                    load.ramp = driven(place).unwrap_or_else(|| load.ramp.clone());
                }
                SceneModel::Oscillator(LinearModel::new(model.operators().with_loads(loads)?))
            }
        };
        Ok(Self {
            model,
            ..self.clone()
        })
    }
}

//! Commands of a user to a running scene.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::ForceInputError;
use sinew_core::{OptionError, Options, StepError};
use sinew_fem::ForceError;
use sinew_scene::{CuttingError, DrivenLoadError};

use crate::scene_identity::SceneKey;

/// A tool of a scene, by its index there. It is valid in all worlds of the scene, and in no others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ToolId {
    pub(crate) scene: SceneKey,
    pub(crate) place: usize,
}

/// A load of a scene, by its index there. It is valid in all worlds of the scene, and in no others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LoadId {
    pub(crate) scene: SceneKey,
    pub(crate) place: usize,
}

impl ToolId {
    /// Its index (0-based) among the tools of the scene.
    #[must_use]
    pub fn index(self) -> usize {
        self.place
    }
}

impl LoadId {
    /// Its index (0-based) among the loads of the scene.
    #[must_use]
    pub fn index(self) -> usize {
        self.place
    }
}

/// A command to a session. It names tools and loads as scenes and logs do; [`World::steer`](crate::World::steer) and
/// [`World::scale_load`](crate::World::scale_load) give the same commands by id. It takes effect with the next step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Command {
    /// The pose of a tool at the end of the next step: it moves there in a straight line within that step, and stays
    /// until another pose is given. Until the first one it follows the scene.
    Pose {
        /// Name of the tool.
        tool: Arc<str>,
        /// Position (m) of its own origin.
        position: [f64; 3],
        /// Its rotation vector (rad).
        rotation_vector: [f64; 3],
    },
    /// A factor of a load, in addition to its own course over time; 1 at the beginning.
    LoadFactor {
        /// Name of the load: that of the scene, `load 2` for the second if it has none, or `gravity`.
        load: Arc<str>,
        /// The factor.
        factor: f64,
    },
    /// Closes the jaws of a tool: nodes that it pushes in a step then move with it until the jaws open. Until the
    /// first of these commands the scene's schedule applies.
    Grasp {
        /// Name of the tool.
        tool: Arc<str>,
    },
    /// Opens the jaws of a tool and releases all nodes in it.
    Release {
        /// Name of the tool.
        tool: Arc<str>,
    },
    /// Forces (N) on nodes (0-based) of the current body, in addition to all loads; they replace those of the last such
    /// command. They stay with their nodes when the body is cut; a part on fixed components is carried by the supports
    /// and is not included in any reaction.
    Forces(Vec<(u32, [f64; 3])>),
    /// Another integrator, which continues from the state.
    Integrator {
        /// Its id.
        id: String,
        /// Its options.
        options: Options,
    },
    /// Another step (s).
    Dt(f64),
    /// The initial state, integrator and step again, with the tools and loads of the scene. The count of steps
    /// continues.
    Reset,
    /// A cut by the sheet that a blade sweeps from one position to another (its two ends, m, before and after), in the
    /// configuration at the beginning of the next step. A cut that does not begin where the last one ended lifts the
    /// blade first. The scene needs `[cutting]`.
    Cut {
        /// The ends before.
        from: [[f64; 3]; 2],
        /// The ends after.
        to: [[f64; 3]; 2],
    },
}

/// Reasons for which a command is refused; the session continues as if it had not been given.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CommandError {
    /// A tool that the scene does not have.
    #[error("no tool is named \"{name}\"; there are {}", quoted(.known))]
    NoTool {
        /// The name.
        name: String,
        /// The names of all tools.
        known: Vec<String>,
    },
    /// A load that the scene does not have.
    #[error("no load is named \"{name}\"; there are {}", quoted(.known))]
    NoLoad {
        /// The name.
        name: String,
        /// The names of all loads.
        known: Vec<String>,
    },
    /// The id of a tool or a load of another scene.
    #[error("this id is that of a tool or a load of another scene: ask this world by the name")]
    ForeignId,
    /// A pose that is not valid.
    #[error(
        "pose of \"{tool}\": {value:?}: expected finite numbers, at most {most:e} m or rad in size"
    )]
    Pose {
        /// The tool.
        tool: Arc<str>,
        /// The number at fault.
        value: f64,
        /// The largest size.
        most: f64,
    },
    /// A force on a node that the body does not have, or one that is not finite.
    #[error(transparent)]
    Force(#[from] ForceError),
    /// Forces on nodes that a step cannot begin with.
    #[error(transparent)]
    ForceInput(#[from] ForceInputError),
    /// Forces on nodes in a scene without a mesh.
    #[error("an oscillator has no nodes: scale its load instead")]
    NoNodes,
    /// A factor that is not finite.
    #[error("factor of \"{load}\": {factor:?}: expected a finite number, at most {most:e} in size")]
    Factor {
        /// The load.
        load: Arc<str>,
        /// The factor.
        factor: f64,
        /// The largest size.
        most: f64,
    },
    /// A step that is not positive and finite, or too short to advance the time of the session.
    #[error("dt = {dt} s: expected a finite step above 0 that advances the time, {t} s")]
    Dt {
        /// The step (s).
        dt: f64,
        /// The time (s).
        t: f64,
    },
    /// Another integrator, or an option, that does not exist.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// Loads that cannot be steered.
    #[error(transparent)]
    Driven(#[from] DrivenLoadError),
    /// A method that cannot take a step from here.
    #[error("no step can be taken with that: {0}")]
    Step(#[from] StepError),
    /// A world that follows its scene.
    #[error("this world follows its scene and takes no commands: build one by `World::new`")]
    Follows,
    /// A session whose last step failed.
    #[error("the last step failed: reset to continue")]
    Failed,
    /// A cut in a scene whose body stays whole.
    #[error("the scene has no table [cutting], so its body cannot be cut: add one")]
    Whole,
    /// A position of a blade that is not valid.
    #[error("cut: {value:?}: expected finite numbers, at most {most:e} m in size")]
    Cut {
        /// The number at fault.
        value: f64,
        /// The largest size.
        most: f64,
    },
    /// A body that cannot be cut.
    #[error(transparent)]
    Cutting(#[from] CuttingError),
}

fn quoted(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    names.join(", ")
}

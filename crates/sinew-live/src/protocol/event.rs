//! Messages to pages in text form.

use serde::Serialize;

use super::command::Field;
use crate::new_tool::ToolKind;

/// An event.
#[derive(Debug, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub(crate) enum Event {
    /// The scenery; first of all events, and after each change of the tools.
    Scenery(Box<Scenery>),
    /// The current settings.
    Settings {
        /// Each pane.
        panes: Vec<PaneFacts>,
        /// True if time is paused.
        paused: bool,
        /// Field shown as colours.
        field: Field,
        /// Factors of the loads, in the order of the scenery.
        factors: Vec<f64>,
        /// True for each tool whose jaws a user closed.
        grasped: Vec<bool>,
        /// True if a trusted run is computed next to the panes.
        trusted: bool,
    },
    /// Capabilities of the integrators on this scene.
    Integrators {
        /// Each of them.
        list: Vec<IntegratorFacts>,
    },
    /// A command that is refused, or a message that is not a command.
    Refused {
        /// The reason.
        reason: String,
    },
    /// A pane that cannot continue.
    Stopped {
        /// The pane.
        pane: usize,
        /// The reason.
        reason: String,
        /// Position (m) of the element that the reason names.
        place: Option<[f64; 3]>,
    },
    /// A return of all panes to a moment before one of them failed.
    WentBack {
        /// The pane that failed.
        pane: usize,
        /// Time (s) by which they went back.
        by: f64,
        /// Simulated time (s) of the moment.
        to: f64,
        /// The reason of the failure.
        reason: String,
        /// Position (m) of the element that the reason names.
        place: Option<[f64; 3]>,
    },
    /// A return of all panes to an earlier moment by a command.
    WentOnFrom {
        /// Simulated time (s) of the moment.
        t: f64,
        /// Time (s) by which they went back.
        back: f64,
    },
    /// Another method in a pane, which cannot take tools.
    OtherMethod {
        /// The pane.
        pane: usize,
        /// The method now.
        integrator: String,
        /// The reason.
        reason: String,
    },
    /// A reset of everything to the beginning.
    Reset,
    /// A trusted run that ended.
    TrustedEnded {
        /// The reason.
        reason: String,
    },
    /// A state that was saved.
    Saved {
        /// The folder.
        folder: String,
        /// The command that repeats the session.
        replay: String,
    },
    /// The start page takes the place of this session.
    Scenes,
}

impl Event {
    pub(crate) fn to_text(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Facts about the scene and the body that a page shows.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Scenery {
    /// The scene's title.
    pub(crate) title: String,
    /// Version of this program.
    pub(crate) version: &'static str,
    /// Nodes of the whole body.
    pub(crate) nodes: usize,
    /// Its tetrahedra.
    pub(crate) tets: usize,
    /// True if the body may be cut.
    pub(crate) cuts: bool,
    /// Fields of this body.
    pub(crate) fields: Vec<Field>,
    /// The largest of Young's moduli (Pa), a scale for stress.
    pub(crate) youngs_modulus: f64,
    /// The tools.
    pub(crate) tools: Vec<ToolFacts>,
    /// The loads that can be scaled.
    pub(crate) loads: Vec<LoadFacts>,
    /// Largest speed (m/s) of steered tools.
    pub(crate) hand_speed: f64,
    /// Material parameters for Hertz's formula, if the body is of one isotropic material.
    pub(crate) hertz: Option<Hertz>,
    /// Advice for the user's first moves, if the scene was chosen on a start page.
    pub(crate) from_start: Option<String>,
}

/// A tool.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ToolFacts {
    /// Its name.
    pub(crate) name: String,
    /// Its parts.
    pub(crate) parts: Vec<PartFacts>,
    /// Position (m) and rotation vector (rad) at the beginning.
    pub(crate) start: [f64; 6],
    /// Its kind, if a page added it.
    pub(crate) added: Option<ToolKind>,
}

/// A part of a tool: its kind, its sizes, its pose in the tool.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PartFacts {
    /// "sphere", "capsule", "plane" or "box".
    pub(crate) kind: &'static str,
    /// Radius (m); radius and length; nothing; three edges.
    pub(crate) sizes: Vec<f64>,
    /// Position (m) in the tool.
    pub(crate) position: [f64; 3],
    /// Rotation vector (rad) in the tool.
    pub(crate) rotation: [f64; 3],
}

/// A load.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct LoadFacts {
    /// Its name.
    pub(crate) name: String,
    /// Description of it.
    pub(crate) what: String,
}

/// Material parameters for Hertz's formula.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Hertz {
    /// Young's modulus (Pa).
    pub(crate) youngs_modulus: f64,
    /// Poisson's ratio.
    pub(crate) poissons_ratio: f64,
}

/// A pane.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PaneFacts {
    /// Its integrator.
    pub(crate) integrator: String,
    /// Its step (s).
    pub(crate) dt: f64,
    /// Stability of its steps, as far as it is known.
    #[serde(flatten)]
    pub(crate) step: StepFacts,
    /// The options of its integrator that can be set.
    pub(crate) options: Vec<OptionFacts>,
    /// Reason why it stopped, if it did.
    pub(crate) stopped: Option<String>,
}

/// Capabilities of an integrator on this scene.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct IntegratorFacts {
    /// Its name.
    pub(crate) name: String,
    /// One line about it.
    pub(crate) summary: String,
    /// Reason why it cannot run here, if so.
    pub(crate) refused: Option<String>,
    /// Stability of its steps, as far as it is known.
    #[serde(flatten)]
    pub(crate) step: StepFacts,
}

/// Stability of steps, as far as it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct StepFacts {
    /// Kind of stability.
    pub(crate) stability: Stability,
    /// The largest stable step (s), if any: 0 if no step is stable.
    pub(crate) stable_step: Option<f64>,
}

/// Kinds of stability, by the set of stable steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Stability {
    /// Unknown.
    #[default]
    Unknown,
    /// Every step is stable.
    Any,
    /// Every step is stable for small motions about rest of a body that is not linear.
    AtRest,
    /// Steps up to the given one are stable.
    UpTo,
    /// Steps up to the given one are stable for small motions about rest of a body that is not linear.
    AtRestUpTo,
    /// Each step has substeps that follow the current stiffness.
    Cut,
}

/// An option of an integrator.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct OptionFacts {
    /// Its key.
    pub(crate) key: &'static str,
    /// Its effect.
    pub(crate) help: &'static str,
    /// The words that it accepts.
    pub(crate) words: Vec<&'static str>,
    /// The numbers that it accepts.
    pub(crate) number: Option<NumberFacts>,
    /// True if it accepts a word and a number together.
    pub(crate) has_both: bool,
    /// The current word.
    pub(crate) word: Option<String>,
    /// The current number.
    pub(crate) value: Option<f64>,
}

/// Range of numbers offered to the user.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct NumberFacts {
    /// The least of them.
    pub(crate) low: f64,
    /// The largest of them.
    pub(crate) high: f64,
    /// True if the numbers are integers.
    pub(crate) is_whole: bool,
    /// True if equal distances on a slider are equal ratios.
    pub(crate) is_logarithmic: bool,
}

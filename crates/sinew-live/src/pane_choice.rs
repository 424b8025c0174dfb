//! Initial settings of a pane.

/// Integrator and step of a pane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PaneChoice {
    /// The integrator; `None` for that of the scene.
    pub integrator: Option<String>,
    /// The step (s); `None` for that of the scene.
    pub dt: Option<f64>,
}

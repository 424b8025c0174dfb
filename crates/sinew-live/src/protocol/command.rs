//! Commands of a page.

use serde::Deserialize;

use crate::new_tool::ToolKind;

/// A command with the page's own number.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub(crate) struct Said {
    /// The number, which increases from command to command; pictures contain the number of the last command included in
    /// them.
    pub(crate) id: u32,
    /// The command.
    #[serde(flatten)]
    pub(crate) order: Order,
}

/// A command.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(tag = "do", rename_all = "snake_case")]
pub(crate) enum Order {
    /// A target pose of a tool.
    Pose {
        /// Number of the tool.
        tool: usize,
        /// Position (m).
        position: [f64; 3],
        /// Rotation vector (rad).
        rotation: [f64; 3],
    },
    /// A grip of the tissue around a point of a pane's surface, with a spring.
    Grip {
        /// The pane, from 0.
        pane: usize,
        /// The point.
        point: usize,
        /// The surfaces that have this point.
        epoch: u32,
    },
    /// A place to which the grip is pulled.
    Pull {
        /// The place (m).
        to: [f64; 3],
    },
    /// The end of the grip.
    LetGo,
    /// Closes or opens the jaws of a tool.
    Grasp {
        /// Number of the tool.
        tool: usize,
        /// True to close them: then they hold what the tool pushes.
        on: bool,
    },
    /// A load of the scene times a factor.
    Load {
        /// Its name.
        load: String,
        /// The factor.
        factor: f64,
    },
    /// A cut by the sheet that a blade sweeps, in the body's configuration at that time.
    Cut {
        /// Both ends (m) of the blade before.
        from: [[f64; 3]; 2],
        /// Both ends (m) after.
        to: [[f64; 3]; 2],
    },
    /// Another shape of a tool of one part, with which everything starts from the beginning.
    Shape {
        /// Number of the tool.
        tool: usize,
        /// The shape.
        shape: Shape,
    },
    /// Another tool, clear of the body, with which everything starts from the beginning.
    AddTool {
        /// Its kind.
        kind: ToolKind,
    },
    /// The end of a tool that was added, with which everything starts from the beginning.
    RemoveTool {
        /// Number of the tool.
        tool: usize,
    },
    /// Closes the blades of scissors.
    Snip {
        /// Number of the tool.
        tool: usize,
    },
    /// Another integrator in a pane.
    Integrator {
        /// The pane, from 0.
        pane: usize,
        /// The name.
        name: String,
    },
    /// Another step in a pane.
    Dt {
        /// The pane, from 0.
        pane: usize,
        /// The step (s).
        dt: f64,
    },
    /// Another option of a pane's integrator: a word, a number, or both.
    Option {
        /// The pane, from 0.
        pane: usize,
        /// The key.
        key: String,
        /// The word.
        word: Option<String>,
        /// The number.
        number: Option<f64>,
    },
    /// Pauses or continues simulated time.
    Pause {
        /// True to pause.
        on: bool,
    },
    /// One step while time is paused.
    Step,
    /// A reset to the beginning.
    Reset,
    /// Another motion from an earlier moment on.
    GoOnFrom {
        /// Simulated time (s): the last moment up to it that is kept is the one.
        t: f64,
    },
    /// One pane or two.
    Panes {
        /// Number of panes.
        count: usize,
    },
    /// Field shown as colours.
    Field {
        /// The field.
        name: Field,
    },
    /// A section across an axis whose values pictures contain, or none.
    Section {
        /// The axis: 0, 1 or 2.
        axis: Option<usize>,
        /// The coordinate (m).
        at: f64,
    },
    /// Starts or ends a trusted run, which gives the error.
    Trusted {
        /// True if there is one.
        on: bool,
    },
    /// A folder with the scene, the state and all commands so far.
    Save,
    /// The end of the session, and the start page in its place.
    Scenes,
}

/// The shape of a tool, the same as in scenes.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Shape {
    /// A sphere.
    Sphere {
        /// Its radius (m).
        radius: f64,
    },
    /// A cylinder with round ends.
    Capsule {
        /// Its radius (m).
        radius: f64,
        /// Length (m) between the centres of its ends.
        length: f64,
    },
    /// A half-space.
    Plane {},
    /// A box.
    Box {
        /// Its edges (m).
        size: [f64; 3],
    },
}

impl Shape {
    /// The value of a tool's key `shape`.
    pub(crate) fn to_toml(self) -> String {
        match self {
            Self::Sphere { radius } => format!("{{ sphere = {{ radius = {radius:?} }} }}"),
            Self::Capsule { radius, length } => {
                format!("{{ capsule = {{ radius = {radius:?}, length = {length:?} }} }}")
            }
            Self::Plane {} => "{ plane = {} }".to_owned(),
            Self::Box { size } => format!("{{ box = {{ size = {size:?} }} }}"),
        }
    }
}

/// Fields that can be shown as colours.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
#[repr(u32)]
pub(crate) enum Field {
    /// The equivalent stress of von Mises (Pa).
    Stress,
    /// The equivalent strain of von Mises (fraction).
    Strain,
    /// The length of the displacement (m).
    Displacement,
    /// Half of stress times strain (J/m3).
    EnergyDensity,
    /// Cells at their limit of velocity (1) and others (0).
    Saturated,
    /// The pressure of tools (Pa).
    Pressure,
    /// The inverse (1/s) of the largest stable step of central difference on single tetrahedra at rest.
    StepLimit,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> Option<Order> {
        serde_json::from_str::<Said>(text)
            .ok()
            .map(|said| said.order)
    }

    #[test]
    fn commands_are_read() {
        let pose = said(r#"{"id":3,"do":"pose","tool":0,"position":[0,0,0.1],"rotation":[0,0,0]}"#);
        assert!(
            matches!(pose, Some(Order::Pose { tool: 0, position, .. }) if position == [0.0, 0.0, 0.1])
        );
        assert_eq!(said(r#"{"id":1,"do":"reset"}"#), Some(Order::Reset));
        assert_eq!(
            said(r#"{"id":1,"do":"dt","pane":1,"dt":0.02}"#),
            Some(Order::Dt { pane: 1, dt: 0.02 })
        );
        assert_eq!(
            said(r#"{"id":1,"do":"option","pane":0,"key":"sweeps","number":8}"#),
            Some(Order::Option {
                pane: 0,
                key: "sweeps".to_owned(),
                word: None,
                number: Some(8.0)
            })
        );
        assert_eq!(
            said(r#"{"id":1,"do":"cut","from":[[0,0,1],[0,0,0]],"to":[[1,0,1],[1,0,0]]}"#),
            Some(Order::Cut {
                from: [[0.0, 0.0, 1.0], [0.0; 3]],
                to: [[1.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
            })
        );
        assert_eq!(
            said(r#"{"id":1,"do":"shape","tool":0,"shape":{"sphere":{"radius":0.01}}}"#),
            Some(Order::Shape {
                tool: 0,
                shape: Shape::Sphere { radius: 0.01 },
            })
        );
        let field = Order::Field {
            name: Field::EnergyDensity,
        };
        assert_eq!(
            said(r#"{"id":1,"do":"field","name":"energy_density"}"#),
            Some(field)
        );
    }

    #[test]
    fn the_page_names_fields_in_the_order_of_their_numbers() {
        let script = include_str!("../../page/src/frames.js");
        let (_, list) = script.split_once("const FIELDS = ").unwrap();
        let (list, _) = list.split_once(';').unwrap();
        let named: Vec<Field> = serde_json::from_str(list).unwrap();
        let numbers: Vec<u32> = named.into_iter().map(|field| field as u32).collect();
        let all: Vec<u32> = (0..=Field::StepLimit as u32).collect();
        assert_eq!(numbers, all);
    }

    #[test]
    fn shapes_are_written_as_scenes_have_them() {
        let shapes = [
            (
                r#"{"sphere":{"radius":1e-7}}"#,
                "{ sphere = { radius = 1e-7 } }",
            ),
            (
                r#"{"capsule":{"radius":0.002,"length":0.1}}"#,
                "{ capsule = { radius = 0.002, length = 0.1 } }",
            ),
            (r#"{"plane":{}}"#, "{ plane = {} }"),
            (
                r#"{"box":{"size":[1,0.02,0.3]}}"#,
                "{ box = { size = [1.0, 0.02, 0.3] } }",
            ),
        ];
        for (json, toml) in shapes {
            let shape: Shape = serde_json::from_str(json).unwrap();
            assert_eq!(shape.to_toml(), toml);
        }
    }

    #[test]
    fn what_is_no_command_is_refused() {
        for text in [
            "",
            "{}",
            "[]",
            "null",
            r#"{"id":-1,"do":"reset"}"#,
            r#"{"id":1,"do":"pose"}"#,
            r#"{"id":1,"do":"fly"}"#,
            r#"{"id":1,"do":"cut","from":[[0,0,1]],"to":[[1,0,1],[1,0,0]]}"#,
            r#"{"do":"reset"}"#,
        ] {
            assert_eq!(said(text), None, "{text}");
        }
    }
}

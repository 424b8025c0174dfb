//! Tools that pages add to a scene.

use serde::{Deserialize, Serialize};

use crate::scene_values::Change;

/// Size of a new tool over the size of the body.
const SIZE: f64 = 0.08;

/// Half of the angle (rad) between the blades of open scissors.
const HALF_OPEN: f64 = 0.26;

/// Length of the blades of scissors in terms of their size.
const BLADES: f64 = 6.0;

/// Smallest size of scissors over the mean edge of the body's surface: a cut between blades is along faces, and needs a
/// few of them.
const EDGES: f64 = 0.6;

/// Share of its length by which a cut of scissors goes beyond their tips, where tissue bulges between them.
const BEYOND: f64 = 0.15;

/// A kind of tool.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ToolKind {
    /// A sphere.
    Ball,
    /// A cylinder with round ends.
    Rod,
    /// A half-space.
    Plate,
    /// Two rods side by side, which grasp.
    Jaws,
    /// An edge that cuts wherever it goes.
    Blade,
    /// Two edges that form a V, which cut what is between them when they close.
    Scissors,
    /// A sphere that removes what gets inside it.
    Burner,
}

impl ToolKind {
    /// The name of its first tool.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Rod => "rod",
            Self::Plate => "plate",
            Self::Jaws => "jaws",
            Self::Blade => "blade",
            Self::Scissors => "scissors",
            Self::Burner => "burner",
        }
    }

    /// Its key and value of a `[[tool]]`, and the distance (m) of its lowest point below its place.
    fn shape(self, size: f64) -> (&'static str, String, f64) {
        let sphere = || format!("{{ sphere = {{ radius = {size:?} }} }}");
        let rod = |radius: f64, length: f64| {
            format!("capsule = {{ radius = {radius:?}, length = {length:?} }}")
        };
        match self {
            Self::Ball | Self::Burner => ("shape", sphere(), size),
            Self::Rod => {
                let (radius, length) = (0.5 * size, 5.0 * size);
                let shape = format!("{{ {} }}", rod(radius, length));
                ("shape", shape, 0.5 * length + radius)
            }
            Self::Plate => ("shape", "{ plane = {} }".to_owned(), 0.0),
            Self::Jaws => {
                let (radius, length) = (0.4 * size, 3.0 * size);
                let jaw = |y: f64| format!("{{ {}, at = [0.0, {y:?}, 0.0] }}", rod(radius, length));
                let jaws = format!("[{}, {}]", jaw(0.8 * size), jaw(-0.8 * size));
                ("shapes", jaws, 0.5 * length + radius)
            }
            Self::Blade => {
                let length = 6.0 * size;
                let shape = format!("{{ blade = {{ length = {length:?} }} }}");
                ("shape", shape, 0.5 * length)
            }
            Self::Scissors => {
                let length = BLADES * size;
                let [hinge, _, _] = scissors(size);
                let blade = |side: f64| {
                    let (sine, cosine) = (side * HALF_OPEN).sin_cos();
                    let at = [0.5 * length * sine, 0.0, hinge[2] - 0.5 * length * cosine];
                    let turned = -side * HALF_OPEN;
                    format!(
                        "{{ blade = {{ length = {length:?} }}, at = {at:?}, rotation = [0.0, {turned:?}, 0.0] }}"
                    )
                };
                let blades = format!("[{}, {}]", blade(1.0), blade(-1.0));
                let low = (1.0 + BEYOND) * length * HALF_OPEN.cos() - hinge[2];
                ("shapes", blades, low)
            }
        }
    }
}

/// The hinge and both tips (m) of scissors in their own frame.
fn scissors(size: f64) -> [[f64; 3]; 3] {
    let length = BLADES * size;
    let (sine, cosine) = HALF_OPEN.sin_cos();
    let hinge = 0.5 * length;
    let tip = |side: f64| [side * length * sine, 0.0, hinge - length * cosine];
    [[0.0, 0.0, hinge], tip(1.0), tip(-1.0)]
}

/// A tool that a page added.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AddedTool {
    pub(crate) kind: ToolKind,
    pub(crate) name: String,
    /// The size (m) with which it was added.
    size: f64,
}

impl AddedTool {
    /// A tool of a kind for a body of this size (m) and mean edge (m) of its surface, with a name that no other tool has.
    pub(crate) fn new<'a>(
        kind: ToolKind,
        (extent, edge): (f64, f64),
        others: impl Iterator<Item = &'a str> + Clone,
    ) -> Self {
        let names = (2_u32..).map(|number| format!("{}-{number}", kind.name()));
        let mut names = std::iter::once(kind.name().to_owned()).chain(names);
        let name = names.find(|name| others.clone().all(|other| other != name));
        let least = match kind {
            ToolKind::Scissors => EDGES * edge,
            _ => 0.0,
        };
        Self {
            kind,
            name: name.unwrap_or_default(),
            size: rounded((SIZE * extent).max(least)),
        }
    }

    /// The tool at a place (m) above a body, with its lowest point at a height (m) and in the middle of `x` and `y`, as
    /// values of the tool with this number (from 1) of a scene, which has a table `[cutting]` of its own or not.
    pub(crate) fn values(
        &self,
        number: usize,
        [x, y, height]: [f64; 3],
        has_cutting: bool,
    ) -> Vec<Change> {
        let (key, shape, low) = self.kind.shape(self.size);
        let start = [x, y, height + low];
        let of_tool = |key: &str, value: String| (format!("tool.{number}.{key}"), Some(value));
        let named = || format!("\"{}\"", self.name);
        let mut values = vec![
            of_tool("name", named()),
            of_tool(key, shape),
            of_tool("start", format!("{start:?}")),
            of_tool("hold", "true".to_owned()),
        ];
        match self.kind {
            ToolKind::Plate => {
                // The inside of a plane is below it.
                let turned = format!("[{:?}, 0.0, 0.0]", std::f64::consts::PI);
                values.push(of_tool("rotation", turned));
                values.push(of_tool("friction", "0.3".to_owned()));
            }
            ToolKind::Ball | ToolKind::Rod => values.push(of_tool("friction", "0.3".to_owned())),
            ToolKind::Jaws => values.push(of_tool("friction", "0.6".to_owned())),
            ToolKind::Blade => values.push(("cutting.tool".to_owned(), Some(named()))),
            ToolKind::Burner => {
                let tool = format!("{{ tool = {} }}", named());
                values.push(("cutting.remove".to_owned(), Some(tool)));
            }
            ToolKind::Scissors if !has_cutting => {
                values.push(("cutting.snap".to_owned(), Some("0.0".to_owned())));
            }
            ToolKind::Scissors => {}
        }
        values
    }

    /// True for a value outside of its `[[tool]]` that leaves the scene with it.
    pub(crate) fn needs(&self, key: &str) -> bool {
        match self.kind {
            ToolKind::Blade => key == "cutting.tool",
            ToolKind::Burner => key == "cutting.remove",
            ToolKind::Scissors => key == "cutting.snap",
            _ => false,
        }
    }

    /// The triangle (m) in the tool's own frame that closing scissors cut: their hinge and the ends of their blades.
    pub(crate) fn bite(&self) -> Option<[[f64; 3]; 3]> {
        let is_scissors = self.kind == ToolKind::Scissors;
        is_scissors.then(|| {
            let [hinge, right, left] = scissors(self.size);
            let beyond = |tip: [f64; 3]| {
                std::array::from_fn(|axis| tip[axis] + BEYOND * (tip[axis] - hinge[axis]))
            };
            [hinge, beyond(right), beyond(left)]
        })
    }
}

/// A length (m) with four digits.
fn rounded(length: f64) -> f64 {
    let text = format!("{length:.3e}");
    text.parse().unwrap_or(length)
}

#[cfg(test)]
mod tests {
    use sinew_scene::{Scene, SceneSource, Subject};

    use super::*;

    const BLOCK: &str = "[mesh]\nblock = { cells = [3, 3, 3], size = [0.1, 0.1, 0.05] }\n[[region]]\ndensity = 1060.0\n\
                         model = \"neo-hookean\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.45\n[[fixed]]\ngroup = \"bottom\"\n\
                         [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = \"auto\"\n";

    const ALL: [ToolKind; 7] = [
        ToolKind::Ball,
        ToolKind::Rod,
        ToolKind::Plate,
        ToolKind::Jaws,
        ToolKind::Blade,
        ToolKind::Scissors,
        ToolKind::Burner,
    ];

    /// A scene builds with each kind just above its body, and not below the place where its lowest point is at the face.
    #[test]
    fn each_kind_stands_clear_of_the_body_by_its_lowest_point() {
        let build = |kind, height| {
            let tool = AddedTool::new(kind, (0.1, 0.02), std::iter::empty());
            let values = tool.values(1, [0.05, 0.05, height], false);
            let values = values
                .iter()
                .map(|(key, value)| format!("{key}={}", value.as_deref().unwrap_or_default()));
            let values: Vec<String> = values.collect();
            let scene = Scene::parse_with(&SceneSource::new("block.toml", BLOCK), &values);
            let scene = scene.unwrap_or_else(|error| panic!("{kind:?}: {error}"));
            let Subject::Body(body) = scene.subject() else {
                panic!("no body");
            };
            assert_eq!(body.tools[0].name, kind.name());
            scene.build().map(drop).map_err(|error| error.to_string())
        };
        for kind in ALL {
            assert_eq!(build(kind, 0.0501), Ok(()), "{kind:?}");
            let cuts = matches!(
                kind,
                ToolKind::Blade | ToolKind::Scissors | ToolKind::Burner
            );
            assert_eq!(build(kind, 0.049).is_err(), !cuts, "{kind:?}");
        }
    }

    #[test]
    fn names_are_not_taken_twice() {
        let others = ["ball", "ball-2"];
        let tool = AddedTool::new(ToolKind::Ball, (0.1, 0.02), others.into_iter());
        assert_eq!(tool.name, "ball-3");
    }

    #[test]
    fn scissors_close_from_blade_to_blade() {
        let tool = AddedTool::new(ToolKind::Scissors, (0.1, 0.02), std::iter::empty());
        let [hinge, right, left] = tool.bite().unwrap();
        let length = |tip: [f64; 3]| (tip[0] - hinge[0]).hypot(tip[2] - hinge[2]);
        assert!((length(right) / (BLADES * tool.size) - 1.0 - BEYOND).abs() < 1e-12);
        assert_eq!(right[0], -left[0]);
        assert_eq!(
            AddedTool::new(ToolKind::Jaws, (0.1, 0.02), std::iter::empty()).bite(),
            None
        );
    }
}

//! The stability maps: their scenes, parameters and steps.

use sinew_measure::{Case, MethodChoice};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, StructuredError, cube};
use sinew_scene::{Scene, SceneSource};
use sinew_verify::LabError;

use super::meshes::{inclusion_cube, sliver_cube};
use super::methods::{block, chebyshev, cnn};
use crate::results::{Missing, StabilityMap};

/// Hexahedra along an edge (m) of the cube: small enough for thousands of runs.
const CELLS: usize = 4;
const EDGE: f64 = 0.1;

/// Longest step (s); all others divide it.
const LONGEST: f64 = 0.04;

/// A parameter of the cube that is varied.
struct Varied {
    id: &'static str,
    title: &'static str,
    parameter: &'static str,
    values: &'static [f64],
    /// The longest step over each step.
    divisors: &'static [u32],
    /// Simulated time over the longest step.
    samples: u32,
    quick: bool,
    /// Regions and damping in TOML.
    body: fn(f64) -> String,
    mesh: fn(f64) -> Result<TetMesh, StructuredError>,
}

const COARSE: &[u32] = &[1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128];
const WIDE: &[u32] = &[1, 2, 4, 8, 16, 32, 64, 128, 256, 512];

const VARIED: [Varied; 5] = [
    Varied {
        id: "poisson",
        title: "Poisson's ratio",
        parameter: "Poisson's ratio",
        values: &[0.0, 0.2, 0.3, 0.4, 0.45, 0.48, 0.49, 0.495, 0.499],
        divisors: COARSE,
        samples: 20,
        quick: false,
        body: |nu| format!("{}\n{}", linear("", 3500.0, nu), damping(20.0)),
        mesh: plain,
    },
    Varied {
        id: "stiffness-ratio",
        title: "Stiffness of a core over that of the rest",
        parameter: "E of the core / E of the rest",
        values: &[1.0, 4.0, 16.0, 64.0, 256.0, 1e3, 4e3, 1e4],
        divisors: WIDE,
        samples: 10,
        quick: false,
        body: |ratio| {
            let outer = linear("group = \"tissue\"", 3500.0, 0.3);
            let core = linear("group = \"inclusion\"", 3500.0 * ratio, 0.3);
            format!("{outer}\n{core}\n{}", damping(20.0))
        },
        mesh: |_| inclusion_cube(CELLS, CELLS / 2, EDGE),
    },
    Varied {
        id: "thinness",
        title: "Thinness of one element (1: none is thin)",
        parameter: "thickness, rest over one",
        values: &[1.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0],
        divisors: COARSE,
        samples: 20,
        quick: false,
        body: |_| format!("{}\n{}", linear("", 3500.0, 0.3), damping(20.0)),
        mesh: |thinness| {
            if thinness > 1.0 {
                sliver_cube(CELLS, EDGE, thinness)
            } else {
                plain(thinness)
            }
        },
    },
    Varied {
        id: "mass-damping",
        title: "Damping in proportion to the mass",
        parameter: "mass damping [1/s]",
        values: &[1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0],
        divisors: COARSE,
        samples: 20,
        quick: true,
        body: |alpha| format!("{}\n{}", springs(0.0), damping(alpha)),
        mesh: plain,
    },
    Varied {
        id: "pair-damping",
        title: "Dashpots in parallel with the springs, by their share of each pair's critical damping",
        parameter: "share of critical damping",
        values: &[0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0],
        divisors: COARSE,
        samples: 20,
        quick: false,
        body: |gamma| springs(gamma),
        mesh: plain,
    },
];

fn plain(_: f64) -> Result<TetMesh, StructuredError> {
    cube(CELLS, EDGE, Split::Kuhn)
}

fn linear(group: &str, youngs_modulus: f64, nu: f64) -> String {
    format!(
        "[[region]]\n{group}\ndensity = 1060.0\nmodel = \"linear\"\n\
         youngs_modulus = {youngs_modulus:e}\npoissons_ratio = {nu}\n"
    )
}

fn springs(gamma: f64) -> String {
    format!(
        "[[region]]\ndensity = 1060.0\nmodel = \"springs\"\nyoungs_modulus = 3500.0\n\
         springs = {{ rule = \"lloyd\", damping_ratio = {gamma} }}\n"
    )
}

fn damping(alpha: f64) -> String {
    format!("[damping]\nmass = {alpha}\n")
}

fn methods() -> [MethodChoice; 6] {
    [
        MethodChoice::new("central-difference"),
        MethodChoice::new("symplectic-euler"),
        MethodChoice::new("newmark"),
        cnn(),
        block(),
        chebyshev(4),
    ]
}

impl Varied {
    fn case(&self, value: f64) -> Result<Case, LabError> {
        let duration = LONGEST * f64::from(self.samples);
        let text = format!(
            "[mesh]\ncube = {{ cells = {CELLS}, edge = {EDGE}, split = \"kuhn\" }}\n{}\n\
             [[fixed]]\ngroup = \"sides\"\n\
             [[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, -100.0]\n\
             [run]\nduration = {duration}\nsamples = {}\nintegrator = \"newmark\"\ndt = {LONGEST}\n",
            (self.body)(value),
            self.samples
        );
        let source = SceneSource::new(format!("map {}", self.id), text);
        let simulation = Scene::parse(source)?.build_on((self.mesh)(value)?)?;
        Ok(Case::new(self.id, simulation)?)
    }

    /// The map for the values at which it exists, and the missing ones.
    fn map(&self, quick: bool) -> (StabilityMap, Vec<Missing>) {
        let every = if quick { 3 } else { 1 };
        let steps = self.divisors.iter().rev().step_by(every);
        let mut map = StabilityMap {
            id: self.id.into(),
            title: self.title.into(),
            parameter: self.parameter.into(),
            steps: steps.map(|divisor| LONGEST / f64::from(*divisor)).collect(),
            ..StabilityMap::default()
        };
        let mut missing = Vec::new();
        let methods = methods();
        for &value in self.values.iter().step_by(every) {
            let mut longer = map.clone();
            let mut add =
                || -> Result<(), LabError> { longer.add(value, &mut self.case(value)?, &methods) };
            match add() {
                Ok(()) => map = longer,
                Err(error) => missing.push(Missing {
                    row: Some(format!("{} = {value}", self.parameter)),
                    ..Missing::scene(format!("map {}", self.id), error)
                }),
            }
        }
        (map, missing)
    }
}

fn wanted(quick: bool) -> impl Iterator<Item = &'static Varied> {
    VARIED.iter().filter(move |varied| varied.quick || !quick)
}

/// The ids of the maps.
pub(crate) fn ids(quick: bool) -> Vec<&'static str> {
    wanted(quick).map(|varied| varied.id).collect()
}

/// The maps, and missing ones with their reason; `begins` is notified of each. A quick run computes one of them,
/// coarser.
pub(crate) fn all(quick: bool, mut begins: impl FnMut(&str)) -> (Vec<StabilityMap>, Vec<Missing>) {
    let (mut maps, mut missing) = (Vec::new(), Vec::new());
    for varied in wanted(quick) {
        begins(varied.title);
        let (map, without) = varied.map(quick);
        if !map.values.is_empty() {
            maps.push(map);
        }
        missing.extend(without);
    }
    (maps, missing)
}

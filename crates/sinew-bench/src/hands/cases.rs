//! The list of scenes with tools, their methods and steps.

use sinew_measure::MethodChoice;

use crate::planned::{FinerMeshes, PlannedCase, energy, yardstick};

/// Steps (s) that divide the time between the scenes' instants.
const STEPS: &[f64] = &[1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4];

/// Cubes of growing size, pressed by the same ball: id, with the cells along an edge, and changed keys of the scene.
const LINEAR: [(&str, &[&str]); 3] = [
    ("press-20", &["mesh.cube.cells=20"]),
    ("press-30", &["mesh.cube.cells=30"]),
    ("press-40", &["mesh.cube.cells=40"]),
];
const NEO_HOOKEAN: [(&str, &[&str]); 3] = [
    (
        "press-soft-10",
        &["mesh.cube.cells=10", "region.1.model=neo-hookean"],
    ),
    (
        "press-soft-20",
        &["mesh.cube.cells=20", "region.1.model=neo-hookean"],
    ),
    (
        "press-soft-30",
        &["mesh.cube.cells=30", "region.1.model=neo-hookean"],
    ),
];

/// Cubes by which the largest one in real time is predicted.
pub(super) struct Sizes {
    pub(super) tissue: &'static str,
    /// The cubes, small ones first.
    pub(super) cases: &'static [&'static str],
    /// The cube that must run in real time.
    pub(super) asked: &'static str,
}

pub(super) const SIZES: [Sizes; 2] = [
    Sizes {
        tissue: "linear tissue",
        cases: &["press", LINEAR[0].0, LINEAR[1].0, LINEAR[2].0],
        asked: LINEAR[1].0,
    },
    Sizes {
        tissue: "neo-hookean tissue",
        cases: &[NEO_HOOKEAN[0].0, NEO_HOOKEAN[1].0, NEO_HOOKEAN[2].0],
        asked: NEO_HOOKEAN[0].0,
    },
];

/// The cases, in the order of the report.
pub(super) fn all(quick: bool) -> Vec<PlannedCase> {
    let case = |id, scene, meshes| PlannedCase {
        id,
        scene,
        values: &[],
        methods: methods(),
        steps: STEPS,
        materials: Vec::new(),
        remarks: &[],
        finer: Some(FinerMeshes {
            meshes,
            ratio: 1.5,
            is_violent: false,
        }),
    };
    let press = case(
        "press",
        "hands/press.toml",
        ["mesh.cube.cells=20", "mesh.cube.cells=30"],
    );
    let slide = case(
        "slide",
        "hands/slide.toml",
        [
            "mesh.block.cells=[24, 16, 12]",
            "mesh.block.cells=[36, 24, 18]",
        ],
    );
    let grasp = case(
        "grasp",
        "hands/grasp.toml",
        [
            "mesh.block.cells=[20, 16, 8]",
            "mesh.block.cells=[30, 24, 12]",
        ],
    );
    let open = case(
        "cut-and-open",
        "hands/open.toml",
        [
            "mesh.block.cells=[24, 16, 12]",
            "mesh.block.cells=[36, 24, 18]",
        ],
    );
    let mut cases = vec![press, slide, grasp, open];
    if quick {
        for case in &mut cases {
            (case.steps, case.finer) = (&STEPS[..1], None);
        }
        return cases;
    }
    cases.extend(
        LINEAR
            .into_iter()
            .chain(NEO_HOOKEAN)
            .map(|(id, values)| PlannedCase {
                id,
                scene: "hands/press.toml",
                values,
                methods: vec![yardstick()],
                steps: &STEPS[..1],
                materials: Vec::new(),
                remarks: &[],
                finer: None,
            }),
    );
    cases
}

/// All methods: those without support for tools are listed with the reason.
fn methods() -> Vec<MethodChoice> {
    let mut methods = vec![yardstick()];
    let all = sinew_integrators::ids().into_iter();
    methods.extend(all.map(|id| MethodChoice::new(id).showing_defaults()));
    methods.extend([4, 16].map(|sweeps| energy("ie", sweeps)));
    methods
}

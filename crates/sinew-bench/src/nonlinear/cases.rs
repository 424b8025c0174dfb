//! The list of large deformations: their scenes, methods and steps.

use sinew_measure::MethodChoice;

use super::materials::Material;
use super::methods;

/// A scene with its runs.
pub(super) struct NonlinearCase {
    /// Id of the case.
    pub(super) id: &'static str,
    /// The scene's file, from the folder of scenes.
    pub(super) scene: &'static str,
    pub(super) methods: Vec<MethodChoice>,
    /// Steps (s), which divide the time between the scene's instants.
    pub(super) steps: &'static [f64],
    /// Laws and elements in the place of the scene's; empty for its own.
    pub(super) materials: Vec<Material>,
    /// Finer meshes by which the error of the scene's own is estimated.
    pub(super) finer: Option<FinerMeshes>,
}

/// Two finer meshes of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct FinerMeshes {
    /// What the scene changes to have them, the coarser one first.
    pub(super) meshes: [&'static str; 2],
    /// Cells along an edge of the finer over those of the coarser.
    pub(super) ratio: f64,
}

const CUBE: FinerMeshes = FinerMeshes {
    meshes: ["mesh.cube.cells=12", "mesh.cube.cells=18"],
    ratio: 1.5,
};

/// The cases, in the order of the report.
pub(super) fn all(quick: bool) -> Vec<NonlinearCase> {
    let case = |id, scene, steps: &'static [f64], finer: Option<FinerMeshes>| NonlinearCase {
        id,
        scene,
        methods: match quick {
            true => methods::few(),
            false => methods::all(),
        },
        steps: match quick {
            true => &steps[..1],
            false => steps,
        },
        materials: Vec::new(),
        finer: finer.filter(|_| !quick),
    };
    let mut cases = vec![
        case(
            "release",
            "nonlinear/release.toml",
            &[5e-3, 1e-2, 2e-3, 1e-3, 5e-4, 2.5e-4],
            Some(CUBE),
        ),
        case(
            "push",
            "nonlinear/push.toml",
            &[1e-2, 5e-3, 2e-3, 1e-3, 5e-4],
            Some(CUBE),
        ),
    ];
    if quick {
        return cases;
    }
    cases.push(case(
        "twist",
        "nonlinear/twist.toml",
        &[1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2.5e-4],
        Some(FinerMeshes {
            meshes: ["mesh.block.cells=[6, 6, 36]", "mesh.block.cells=[9, 9, 54]"],
            ratio: 1.5,
        }),
    ));
    cases
}

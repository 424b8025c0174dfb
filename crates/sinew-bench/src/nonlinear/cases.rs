//! The list of large deformations: their scenes, methods and steps.

use super::methods;
use crate::planned::{FinerMeshes, Material, PlannedCase};

const CUBE: FinerMeshes = FinerMeshes {
    meshes: ["mesh.cube.cells=12", "mesh.cube.cells=18"],
    ratio: 1.5,
    is_violent: true,
};

/// Figures that others publish, listed next to ours.
const OF_SOFA: &[&str] = &[
    "Published for this beam (SofaCUDA_benchmarks.csv in SOFA's SofaCUDA plugin, read at 2a278d89; ten runs of 1000 steps each, f32), in \
     milliseconds a step: corotational tetrahedra 33.6 (i7-10750H) and 32.3 (Ryzen 3800X), on graphics processors 2.80 (RTX 2070) and 3.82 \
     (GTX 1060); fast corotational tetrahedra 23.1 and 28.0, 3.25 and 5.13. They are copied, not measured here, and of other computers.",
    "There a step is backward Euler with a bounded number of conjugate gradient iterations, and no error is given. The rows here have the error \
     of each method against the same body in steps of no length: `cnn-energy` with few sweeps is the nearest to that solver, the implicit \
     methods solve each step to the end.",
];

/// The cases, in the order of the report.
pub(super) fn all(quick: bool) -> Vec<PlannedCase> {
    let case = |id, scene, steps, finer| PlannedCase {
        id,
        scene,
        values: &[],
        methods: methods::all(),
        steps,
        materials: Vec::new(),
        remarks: &[],
        finer: Some(finer),
    };
    let mut cases = vec![
        case(
            "push",
            "nonlinear/push.toml",
            &[1e-2, 5e-3, 2e-3, 1e-3, 5e-4],
            CUBE,
        ),
        case(
            "bonded-block",
            "nonlinear/bonded-block.toml",
            &[1e-2, 5e-3, 2e-3, 1e-3, 2.5e-4],
            FinerMeshes {
                meshes: ["mesh.cube.cells=8", "mesh.cube.cells=12"],
                ratio: 1.5,
                is_violent: false,
            },
        ),
    ];
    if quick {
        for case in &mut cases {
            (case.methods, case.steps, case.finer) = (methods::few(), &case.steps[..1], None);
        }
        return cases;
    }
    cases.extend([
        case(
            "release",
            "nonlinear/release.toml",
            &[5e-3, 1e-2, 2e-3, 1e-3, 5e-4, 2.5e-4],
            CUBE,
        ),
        PlannedCase {
            methods: methods::few(),
            materials: Material::all(),
            ..case(
                "push-laws",
                "nonlinear/push.toml",
                &[1e-2],
                FinerMeshes {
                    is_violent: false,
                    ..CUBE
                },
            )
        },
        case(
            "twist",
            "nonlinear/twist.toml",
            &[1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2.5e-4],
            FinerMeshes {
                meshes: ["mesh.block.cells=[6, 6, 36]", "mesh.block.cells=[9, 9, 54]"],
                ratio: 1.5,
                is_violent: true,
            },
        ),
        case(
            "cantilever",
            "nonlinear/cantilever.toml",
            &[1e-2, 5e-3, 2e-3],
            FinerMeshes {
                meshes: ["mesh.block.cells=[4, 4, 40]", "mesh.block.cells=[6, 6, 60]"],
                ratio: 1.5,
                is_violent: false,
            },
        ),
        PlannedCase {
            methods: methods::of_large_bodies(),
            finer: None,
            ..case("organ-pressed", "ready/organ-pressed.toml", &[2e-2], CUBE)
        },
        PlannedCase {
            methods: methods::of_sofa(),
            remarks: OF_SOFA,
            finer: None,
            ..case("sofa-beam", "nonlinear/sofa-beam.toml", &[4e-2], CUBE)
        },
    ]);
    cases
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use sinew_scene::Scene;

    use super::*;

    /// A slow bench should not find an error in a scene late.
    #[test]
    fn every_scene_is_read_with_every_law_and_finer_mesh() {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        for case in all(false) {
            let mut changes = vec![Vec::new()];
            changes.extend(case.materials.iter().map(|material| material.values()));
            let meshes = case.finer.map(|finer| finer.meshes);
            changes.extend(meshes.iter().flatten().map(|mesh| vec![(*mesh).to_owned()]));
            for values in changes {
                let scene = Scene::load_with(scenes.join(case.scene), &values).unwrap();
                let settings = scene.settings();
                let interval = settings.duration / settings.samples as f64;
                for dt in case.steps {
                    let parts = interval / dt;
                    assert!(
                        (parts - parts.round()).abs() < 1e-9 * parts,
                        "{} {dt}",
                        case.id
                    );
                }
            }
        }
    }
}

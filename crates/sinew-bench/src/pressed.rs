//! A body of the peers' tissue.

use sinew_core::Ramp;
use sinew_fem::{Element, Fixed, FromMesh, Law, LoadKind, LoadSpec, Problem, Region, Tissue};

/// The peers' tissue, undamped, held on one group and pressed on another.
pub(crate) fn problem(held: &str, pressed: &str) -> Problem {
    Problem {
        regions: vec![Region {
            group: None,
            density: 1060.0,
            law: Law::Linear {
                youngs_modulus: 3500.0,
                poissons_ratio: 0.45,
            },
            element: Element::P1,
            tissue: Tissue::default(),
            from_mesh: FromMesh::default(),
        }],
        fixed: vec![Fixed {
            on: held.into(),
            axes: [true; 3],
        }],
        loads: vec![LoadSpec {
            on: pressed.into(),
            kind: LoadKind::Pressure(100.0),
            ramp: Ramp::Step,
        }],
        ..Problem::default()
    }
}

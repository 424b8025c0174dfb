//! Bodies that tests cut.

#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test uses a part; a test"
)]

pub(crate) mod topology;

use sinew_cutting::{CuttableBody, Sheet, TetProperties};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};
use sinew_mesh::vector::{cross, dot, sub};

pub(crate) const DENSITY: f64 = 1060.0;
pub(crate) const YOUNGS_MODULUS: f64 = 3500.0;

/// Linear elastic tissue.
pub(crate) struct Tissue {
    pub(crate) poissons_ratio: f64,
}

impl TetProperties for Tissue {
    fn density(&self, _: usize) -> f64 {
        DENSITY
    }

    fn frequency(&self, _: usize, vertices: &[[f64; 3]; 4]) -> f64 {
        // The root of the sum of all eigenvalues of normal strain: above the largest frequency, by a third at most.
        let nu = self.poissons_ratio;
        let wave = YOUNGS_MODULUS * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let [a, b, c, d] = *vertices;
        let heights = [[a, b, c, d], [b, a, d, c], [c, d, a, b], [d, c, b, a]];
        let gradient = |tet: [[f64; 3]; 4]| {
            let [_, p, q, r] = tet;
            let normal = cross(sub(q, p), sub(r, p));
            dot(normal, normal) / (6.0 * signed_volume(tet)).powi(2)
        };
        (4.0 / DENSITY * wave * heights.map(gradient).iter().sum::<f64>()).sqrt()
    }
}

/// The cube of 11^3 nodes and an edge of 0.1 m.
pub(crate) fn kuhn_cube() -> TetMesh {
    structured::cube(10, 0.1, Split::Kuhn).unwrap()
}

pub(crate) fn body(mesh: &TetMesh, poissons_ratio: f64) -> CuttableBody {
    CuttableBody::new(mesh, Box::new(Tissue { poissons_ratio })).unwrap()
}

fn signed_volume([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    dot(cross(sub(b, a), sub(c, a)), sub(d, a)) / 6.0
}

/// A sheet across a cube of 0.1 m through `centre`, far beyond it on all sides, with this normal.
pub(crate) fn plane(centre: [f64; 3], normal: [f64; 3]) -> Sheet {
    let unit = |a: [f64; 3]| {
        let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
        a.map(|x| x / length)
    };
    let normal = unit(normal);
    let helper = if normal[0].abs() < 0.8 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let e = unit(cross(normal, helper));
    let f = cross(normal, e);
    let corner = |s: f64, t: f64| std::array::from_fn(|i| centre[i] + 0.4 * (s * e[i] + t * f[i]));
    Sheet::swept(
        [corner(-1.0, -1.0), corner(1.0, -1.0)],
        [corner(-1.0, 1.0), corner(1.0, 1.0)],
    )
    .unwrap()
}

/// Signed volume.
pub(crate) fn volume(points: &[[f64; 3]], tet: [u32; 4]) -> f64 {
    signed_volume(tet.map(|node| points[node as usize]))
}

/// Mass of each node.
pub(crate) fn masses(body: &CuttableBody) -> Vec<f64> {
    let mut masses = vec![0.0; body.nodes()];
    for (tet, nodes) in body.tets().iter().enumerate() {
        if !body.is_removed()[tet] {
            for node in nodes {
                masses[*node as usize] += body.mass_of(tet as u32) / 4.0;
            }
        }
    }
    masses
}

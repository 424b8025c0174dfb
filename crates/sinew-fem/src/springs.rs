//! Networks of springs along the edges of tetrahedra.
//!
//! The cited source of the cellular network's matrices (Duan, Huang, Chang et al., IEEE JBHI
//! 20(1), 268-280) could not be obtained; this is a reconstruction from the two stiffness rules of
//! the literature and pairwise dashpots.

use std::sync::Arc;

use nalgebra::{Matrix6, SMatrix, Vector3, Vector6};
use sinew_sparse::{AssemblyError, BlockMatrix, Layers, Pattern};

use crate::SpringRule;
use crate::tetra;
pub use crate::tetra::EDGES;

/// A spring between two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Nodes, the smaller first.
    pub nodes: [u32; 2],
    /// k (N/m).
    pub stiffness: f64,
}

/// The springs of some tetrahedra, one for each edge, in increasing order of their nodes.
///
/// Each tetrahedron adds to its edges: Lloyd et al. 2007 `k = (2 sqrt 2 / 25) E l_eq` with
/// `l_eq = (12 V / sqrt 2)^(1/3)`; van Gelder 1998 `k = E V / l^2`.
#[must_use]
pub fn springs<'a>(
    points: &[[f64; 3]],
    tets: impl Iterator<Item = &'a [u32; 4]>,
    youngs_modulus: f64,
    rule: SpringRule,
) -> Vec<Spring> {
    springs_of(points, tets.map(|tet| (tet, youngs_modulus)), rule)
}

/// [`springs`] of tetrahedra with a Young's modulus (Pa) each.
pub(crate) fn springs_of<'a>(
    points: &[[f64; 3]],
    tets: impl Iterator<Item = (&'a [u32; 4], f64)>,
    rule: SpringRule,
) -> Vec<Spring> {
    let parts = tets.flat_map(|(tet, modulus)| of_tetrahedron(points, tet, modulus, rule));
    summed(parts.collect())
}

/// [`springs_of`], for a million tetrahedra: `graph` has their edges, so that no list of all contributions is made and
/// sorted.
pub(crate) fn springs_on<'a>(
    graph: &Arc<Pattern>,
    points: &[[f64; 3]],
    tets: impl Iterator<Item = (&'a [u32; 4], f64)>,
    rule: SpringRule,
) -> Result<Vec<Spring>, AssemblyError> {
    // The stiffness of each edge, in the row of its lower node.
    let mut sums = BlockMatrix::zeros(Arc::clone(graph), Layers::One);
    for (tet, youngs_modulus) in tets {
        for Spring {
            nodes: [a, b],
            stiffness,
        } in of_tetrahedron(points, tet, youngs_modulus, rule)
        {
            sums.add_block(a, b, &[stiffness])?;
        }
    }
    let edges = || {
        (0..graph.cells()).flat_map(|a| {
            let row = sums.row_blocks(a).filter(move |(b, _)| *b > a);
            let row = row.map(move |(b, stiffness)| ([a as u32, b as u32], stiffness[0]));
            row.filter(|(_, stiffness)| *stiffness != 0.0)
        })
    };
    let mut springs = Vec::with_capacity(edges().count());
    springs.extend(edges().map(|(nodes, stiffness)| Spring { nodes, stiffness }));
    Ok(springs)
}

/// The springs that one tetrahedron adds to its six edges.
fn of_tetrahedron(
    points: &[[f64; 3]],
    tet: &[u32; 4],
    youngs_modulus: f64,
    rule: SpringRule,
) -> [Spring; 6] {
    let vertices = tetra::vertices(points, *tet);
    let volume = tetra::signed_volume(&vertices).abs();
    let stiffness = match rule {
        SpringRule::Lloyd => {
            let equivalent = (12.0 * volume / 2.0_f64.sqrt()).cbrt();
            [2.0 * 2.0_f64.sqrt() / 25.0 * youngs_modulus * equivalent; 6]
        }
        SpringRule::VanGelder => EDGES.map(|[a, b]| {
            let length = Vector3::from(vertices[b]) - Vector3::from(vertices[a]);
            youngs_modulus * volume / length.norm_squared()
        }),
    };
    std::array::from_fn(|edge| {
        let [a, b] = EDGES[edge].map(|vertex| tet[vertex]);
        Spring {
            nodes: [a.min(b), a.max(b)],
            stiffness: stiffness[edge],
        }
    })
}

/// Stiffness matrix (N/m), 12 x 12, row-major and vertex-major, of the springs that one tetrahedron
/// adds to its edges.
#[must_use]
pub(crate) fn stiffness(
    points: &[[f64; 3]],
    tet: &[u32; 4],
    youngs_modulus: f64,
    rule: SpringRule,
) -> [f64; 144] {
    let mut matrix = [0.0; 144];
    let parts = of_tetrahedron(points, tet, youngs_modulus, rule);
    for (spring, [a, b]) in parts.iter().zip(EDGES) {
        let (n, _) = direction(points, spring.nodes);
        for (row, i) in [(a, 1.0), (b, -1.0)] {
            for (column, j) in [(a, 1.0), (b, -1.0)] {
                for at in 0..9 {
                    let entry = 12 * (3 * row + at / 3) + 3 * column + at % 3;
                    matrix[entry] += i * j * spring.stiffness * n[at / 3] * n[at % 3];
                }
            }
        }
    }
    matrix
}

/// The largest frequency (1/s) at which the springs of a tetrahedron with these vertices (m) and this density (kg/m^3) would swing its own mass;
/// `None` if it is flat.
pub(crate) fn largest_frequency(
    vertices: &[[f64; 3]; 4],
    youngs_modulus: f64,
    rule: SpringRule,
    density: f64,
) -> Option<f64> {
    let quarter = density * tetra::signed_volume(vertices) / 4.0;
    let matrix = stiffness(vertices, &[0, 1, 2, 3], youngs_modulus, rule);
    let matrix = SMatrix::<f64, 12, 12>::from_row_slice(&matrix);
    (quarter > 0.0).then(|| (matrix.symmetric_eigenvalues().max() / quarter).sqrt())
}

/// One spring for each edge, in increasing order of their nodes.
pub(crate) fn summed(mut parts: Vec<Spring>) -> Vec<Spring> {
    // A stable sort: contributions add up in the order they come.
    parts.sort_by_key(|spring| spring.nodes);
    let mut springs: Vec<Spring> = Vec::new();
    for part in parts {
        match springs.last_mut() {
            Some(last) if last.nodes == part.nodes => last.stiffness += part.stiffness,
            _ => springs.push(part),
        }
    }
    springs
}

/// Direction (unit) and length (m) of a spring.
#[must_use]
pub(crate) fn direction(points: &[[f64; 3]], nodes: [u32; 2]) -> (Vector3<f64>, f64) {
    let [a, b] = nodes.map(|node| Vector3::from(points[node as usize]));
    let edge = b - a;
    let length = edge.norm();
    (edge / length, length)
}

/// `rate n n'`, row-major, n being the unit direction of an edge.
#[must_use]
pub(crate) fn edge_block(points: &[[f64; 3]], nodes: [u32; 2], rate: f64) -> [f64; 9] {
    let (n, _) = direction(points, nodes);
    std::array::from_fn(|k| rate * n[k / 3] * n[k % 3])
}

/// Moduli of a network of springs as a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetworkModulus {
    /// Young's modulus (Pa) of the isotropic material with the same Voigt average; its Poisson's
    /// ratio is 1/4, as for every network of central springs.
    pub voigt: f64,
    /// Smallest Young's modulus (Pa) over all directions.
    pub softest: f64,
    /// Largest Young's modulus (Pa) over all directions.
    pub stiffest: f64,
}

/// The moduli of the affine tensor `C = (1/V) sum k l^2 n n n n` of springs that fill `volume`
/// (m^3). `softest` is 0 if some strain meets no resistance.
#[must_use]
pub(crate) fn network_modulus(
    points: &[[f64; 3]],
    springs: &[Spring],
    volume: f64,
) -> NetworkModulus {
    let mut tensor = Matrix6::zeros();
    for spring in springs {
        let (n, length) = direction(points, spring.nodes);
        let dyad = mandel(&n);
        tensor += dyad * dyad.transpose() * (spring.stiffness * length * length / volume);
    }
    // C_iijj = 15 mu for lambda = mu, and E = 5/2 mu.
    let voigt = tensor.fixed_view::<3, 3>(0, 0).sum() / 6.0;
    let (mut softest, mut stiffest) = (0.0, f64::INFINITY);
    if let Some(compliance) = tensor.try_inverse() {
        let along = |n: &Vector3<f64>| {
            let dyad = mandel(n);
            dyad.dot(&(compliance * dyad))
        };
        softest = 1.0 / greatest(along);
        stiffest = -1.0 / greatest(|n| -along(n));
    }
    NetworkModulus {
        voigt,
        softest,
        stiffest,
    }
}

/// n n in Mandel's notation.
fn mandel(n: &Vector3<f64>) -> Vector6<f64> {
    let root = 2.0_f64.sqrt();
    Vector6::new(
        n.x * n.x,
        n.y * n.y,
        n.z * n.z,
        root * n.y * n.z,
        root * n.x * n.z,
        root * n.x * n.y,
    )
}

/// The greatest value of a smooth function over all directions: the best of many, improved by ever
/// shorter steps.
fn greatest(value: impl Fn(&Vector3<f64>) -> f64) -> f64 {
    let better = |(best, at): (f64, Vector3<f64>), n: Vector3<f64>| {
        let candidate = value(&n);
        if candidate > best {
            (candidate, n)
        } else {
            (best, at)
        }
    };
    let mut best = sphere_directions().fold((f64::NEG_INFINITY, Vector3::x()), better);
    // The value is flat at its peak: a direction to seven digits gives the value to fourteen.
    let mut step = 0.1;
    while step > 1e-7 {
        let before = best;
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let sides = axes.into_iter().flat_map(|axis| [axis, -axis]);
        best = sides
            .map(|side| (before.1 + side * step).normalize())
            .fold(before, better);
        let improved = best.0 > before.0 + 1e-15 * before.0.abs();
        if !improved {
            step /= 2.0;
        }
    }
    best.0
}

/// Directions at most 8 degrees apart, the axes, face and body diagonals among them.
fn sphere_directions() -> impl Iterator<Item = Vector3<f64>> {
    const N: i32 = 8;
    let side = move || -N..=N;
    side()
        .flat_map(move |i| side().flat_map(move |j| side().map(move |k| (i, j, k))))
        .filter(|(i, j, k)| i.abs().max(j.abs()).max(k.abs()) == N)
        .map(|(i, j, k)| Vector3::new(f64::from(i), f64::from(j), f64::from(k)).normalize())
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, cube};

    use super::*;

    #[test]
    fn springs_on_a_graph_are_the_sorted_sums_to_the_last_bit() {
        let mut mesh = cube(3, 0.1, Split::Mirrored).unwrap();
        // Uneven in every direction, so that the order of a sum matters.
        for (index, coordinate) in mesh.points.as_flattened_mut().iter_mut().enumerate() {
            *coordinate += 0.004 * (index as f64 * 1.7).sin();
        }
        let graph = Arc::new(Pattern::from_elements(mesh.points.len(), &mesh.tets).unwrap());
        // A part of the body, in another order than that of the mesh.
        let part = || mesh.tets.iter().rev().step_by(3);
        let with_modulus = || part().map(|tet| (tet, 3500.0));
        for rule in [SpringRule::Lloyd, SpringRule::VanGelder] {
            let on_graph = springs_on(&graph, &mesh.points, with_modulus(), rule).unwrap();
            assert_eq!(on_graph, springs(&mesh.points, part(), 3500.0, rule));
            assert!(on_graph.len() < (graph.blocks() - graph.cells()) / 2);
        }
    }
}

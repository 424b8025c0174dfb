//! The 4-node tetrahedron with linear displacement (P1).

use nalgebra::{Matrix3, Matrix4x3, Vector3};

/// The vertex pairs of a tetrahedron's six edges.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Lame's constants (lambda, mu) (Pa) of Young's modulus (Pa) and Poisson's ratio.
#[must_use]
pub fn lame(youngs_modulus: f64, poissons_ratio: f64) -> (f64, f64) {
    let mu = youngs_modulus / (2.0 * (1.0 + poissons_ratio));
    let lambda = 2.0 * mu * poissons_ratio / (1.0 - 2.0 * poissons_ratio);
    (lambda, mu)
}

/// The vertices (m) of a tetrahedron, given by its nodes.
pub(crate) fn vertices(points: &[[f64; 3]], [a, b, c, d]: [u32; 4]) -> [[f64; 3]; 4] {
    // Spelled out, since `map` is not inlined where millions of tetrahedra are visited.
    let at = |node: u32| points[node as usize];
    [at(a), at(b), at(c), at(d)]
}

/// Signed volume (m^3); positive when the fourth vertex sees the first three anticlockwise.
#[must_use]
pub fn signed_volume(vertices: &[[f64; 3]; 4]) -> f64 {
    edge_matrix(vertices).determinant() / 6.0
}

/// Matrix whose columns are the edges from the first vertex to the others.
fn edge_matrix(vertices: &[[f64; 3]; 4]) -> Matrix3<f64> {
    let [first, second, third, fourth] = vertices.map(Vector3::from);
    Matrix3::from_columns(&[second - first, third - first, fourth - first])
}

/// Gradients (1/m) of the four shape functions, which are constant: the derivatives of each along
/// x, y and z.
///
/// `None` when the vertices lie in one plane.
#[must_use]
pub fn gradients(vertices: &[[f64; 3]; 4]) -> Option<[[f64; 3]; 4]> {
    gradients_of(edge_matrix(vertices))
        .map(|rows| std::array::from_fn(|vertex| std::array::from_fn(|axis| rows[(vertex, axis)])))
}

/// The gradients, a row for each vertex.
fn gradients_of(edges: Matrix3<f64>) -> Option<Matrix4x3<f64>> {
    let inverse = edges.try_inverse()?;
    let mut gradients = Matrix4x3::zeros();
    for row in 0..3 {
        gradients.set_row(row + 1, &inverse.row(row));
    }
    gradients.set_row(0, &-(inverse.row(0) + inverse.row(1) + inverse.row(2)));
    Some(gradients)
}

/// The gradient of a displacement (m), given at the vertices: row i, column j is `du_i/dx_j`. Not finite where the
/// vertices lie in one plane.
pub(crate) fn displacement_gradient(
    [a, b, c, d]: &[[f64; 3]; 4],
    [u_a, u_b, u_c, u_d]: &[[f64; 3]; 4],
) -> [[f64; 3]; 3] {
    let edge = |to: &[f64; 3], from: &[f64; 3]| [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let cross = |p: [f64; 3], q: [f64; 3]| {
        [
            p[1] * q[2] - p[2] * q[1],
            p[2] * q[0] - p[0] * q[2],
            p[0] * q[1] - p[1] * q[0],
        ]
    };
    let (p, q, r) = (edge(b, a), edge(c, a), edge(d, a));
    // Rows of the inverse of the matrix whose columns are the edges, up to its determinant.
    let (of_p, of_q, of_r) = (cross(q, r), cross(r, p), cross(p, q));
    let inverse = (p[0] * of_p[0] + p[1] * of_p[1] + p[2] * of_p[2]).recip();
    let (u_p, u_q, u_r) = (edge(u_b, u_a), edge(u_c, u_a), edge(u_d, u_a));
    let entry =
        |i: usize, j: usize| inverse * (u_p[i] * of_p[j] + u_q[i] * of_q[j] + u_r[i] * of_r[j]);
    let row = |i: usize| [entry(i, 0), entry(i, 1), entry(i, 2)];
    [row(0), row(1), row(2)]
}

/// Stiffness matrix (N/m), 12 x 12, row-major and node-major, of an isotropic linear elastic
/// tetrahedron (Bathe, Finite Element Procedures, section 5.3, with one constant strain):
/// the 3x3 block of vertices a, b is `V (lambda g_a g_b' + mu g_b g_a' + mu g_a.g_b I)`, g being
/// the gradients of the shape functions.
///
/// `None` when the vertices lie in one plane.
#[must_use]
pub fn stiffness(vertices: &[[f64; 3]; 4], lambda: f64, mu: f64) -> Option<[f64; 144]> {
    let (volume, gradients) = volume_and_gradients(vertices)?;
    let mut matrix = [0.0; 144];
    for (ga, rows) in gradients.iter().zip(matrix.as_chunks_mut::<36>().0) {
        stiffness_rows(volume, [lambda, mu], ga, &gradients, rows);
    }
    Some(matrix)
}

/// Volume (m^3) and gradients (1/m) of the shape functions; `None` when the vertices lie in one plane.
pub(crate) fn volume_and_gradients(vertices: &[[f64; 3]; 4]) -> Option<(f64, [[f64; 3]; 4])> {
    let volume = edge_matrix(vertices).determinant().abs() / 6.0;
    Some((volume, gradients(vertices)?))
}

/// Writes the three rows of a stiffness matrix (N/m) at the node whose shape function has the gradient `ga`, all nodes of a
/// volume (m^3) of constant strain having the `gradients` (1/m).
#[inline(always)]
pub(crate) fn stiffness_rows(
    volume: f64,
    [lambda, mu]: [f64; 2],
    ga: &[f64; 3],
    gradients: &[[f64; 3]],
    rows: &mut [f64],
) {
    let columns = 3 * gradients.len();
    let (lambda_ga, mu_ga) = (ga.map(|g| lambda * g), ga.map(|g| mu * g));
    for (b, gb) in gradients.iter().enumerate() {
        let dot = ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2];
        for i in 0..3 {
            for j in 0..3 {
                let isotropic = if i == j { mu * dot } else { 0.0 };
                rows[columns * i + 3 * b + j] =
                    volume * (lambda_ga[i] * gb[j] + mu_ga[j] * gb[i] + isotropic);
            }
        }
    }
}

/// The largest frequency (1/s) at which an isotropic linear elastic tetrahedron of this density (kg/m^3) would swing its own lumped mass, a quarter at
/// each vertex. No body of such tetrahedra, cut along any of their faces, has a larger one (Irons and Treharne 1971: eigenvalues of a sum of
/// element matrices are bounded by those of the elements).
///
/// In the axes of S, the sum of the gradients' dyads with eigenvalues d, shapes of normal strain and of shear decouple, and the largest
/// eigenvalue is that of `2 mu diag(d) + lambda sqrt(d) sqrt(d)'`: the largest root of a cubic in the invariants of S.
///
/// `None` when the vertices lie in one plane.
#[must_use]
pub fn largest_frequency(
    vertices: &[[f64; 3]; 4],
    [lambda, mu]: [f64; 2],
    density: f64,
) -> Option<f64> {
    let gradients = gradients_of(edge_matrix(vertices))?;
    let sum = gradients.transpose() * gradients;
    let trace = sum.trace();
    let second = (trace * trace - sum.norm_squared()) / 2.0;
    let a = (2.0 * mu + lambda) * trace;
    let b = 4.0 * mu * (mu + lambda) * second;
    let c = 4.0 * mu * mu * (2.0 * mu + 3.0 * lambda) * sum.determinant();
    // All roots are real and none is negative, so Newton's method comes down from their sum without passing the largest.
    let mut root = a;
    for _ in 0..100 {
        let value = ((root - a) * root + b) * root - c;
        let slope = (3.0 * root - 2.0 * a) * root + b;
        let next = root - value / slope;
        if next.is_nan() || next >= root {
            break;
        }
        root = next;
    }
    Some((4.0 / density * root).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKEW: [[f64; 3]; 4] = [
        [0.1, 0.0, 0.2],
        [1.3, 0.2, 0.0],
        [0.0, 0.9, 0.3],
        [0.2, 0.1, 1.1],
    ];

    fn energy(matrix: &[f64; 144], u: &[f64; 12]) -> f64 {
        let product = |i: usize| -> f64 { (0..12).map(|j| matrix[i * 12 + j] * u[j]).sum() };
        0.5 * (0..12).map(|i| u[i] * product(i)).sum::<f64>()
    }

    fn linear_field(gradient: [[f64; 3]; 3]) -> [f64; 12] {
        std::array::from_fn(|dof| {
            let (vertex, i) = (dof / 3, dof % 3);
            (0..3).map(|j| gradient[i][j] * SKEW[vertex][j]).sum()
        })
    }

    #[test]
    fn uniaxial_strain_stores_half_p_wave_modulus_times_strain_squared() {
        let (lambda, mu) = lame(3500.0, 0.45);
        let matrix = stiffness(&SKEW, lambda, mu).unwrap();
        let strain = 0.01;
        let u = linear_field([[strain, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
        let expected = 0.5 * (lambda + 2.0 * mu) * strain * strain * signed_volume(&SKEW);
        assert!((energy(&matrix, &u) / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn simple_shear_stores_half_mu_gamma_squared() {
        let (lambda, mu) = lame(3500.0, 0.3);
        let matrix = stiffness(&SKEW, lambda, mu).unwrap();
        let gamma = 0.02;
        let u = linear_field([[0.0, gamma, 0.0], [0.0; 3], [0.0; 3]]);
        let expected = 0.5 * mu * gamma * gamma * signed_volume(&SKEW);
        assert!((energy(&matrix, &u) / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn shape_functions_are_one_at_their_vertex_and_zero_at_the_others() {
        let gradients = gradients(&SKEW).unwrap();
        for (a, gradient) in gradients.iter().enumerate() {
            for (b, vertex) in SKEW.iter().enumerate() {
                // N_a(x_b) - N_a(x_a) = g_a . (x_b - x_a).
                let difference = |axis: usize| vertex[axis] - SKEW[a][axis];
                let change: f64 = (0..3).map(|axis| gradient[axis] * difference(axis)).sum();
                let expected = if a == b { 0.0 } else { -1.0 };
                assert!((change - expected).abs() < 1e-14);
            }
        }
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(super::gradients(&flat), None);
    }

    #[test]
    fn the_largest_frequency_is_that_of_the_matrix_over_the_lumped_mass() {
        for (poissons_ratio, density) in [(0.0, 1.0), (0.25, 1060.0), (0.49, 900.0)] {
            let (lambda, mu) = lame(3500.0, poissons_ratio);
            let matrix = stiffness(&SKEW, lambda, mu).unwrap();
            let matrix = nalgebra::SMatrix::<f64, 12, 12>::from_row_slice(&matrix);
            let quarter = density * signed_volume(&SKEW) / 4.0;
            let expected = (matrix.symmetric_eigenvalues().max() / quarter).sqrt();
            let found = largest_frequency(&SKEW, [lambda, mu], density).unwrap();
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(largest_frequency(&[[0.0; 3]; 4], [1.0; 2], 1.0), None);
    }

    #[test]
    fn even_permutations_change_nothing_and_flat_ones_have_no_matrix() {
        let (lambda, mu) = lame(1.0, 0.2);
        let matrix = stiffness(&SKEW, lambda, mu).unwrap();
        let order = [1, 2, 0, 3];
        let permuted = stiffness(&order.map(|vertex| SKEW[vertex]), lambda, mu).unwrap();
        for a in 0..12 {
            for b in 0..12 {
                let original = matrix[(order[a / 3] * 3 + a % 3) * 12 + order[b / 3] * 3 + b % 3];
                assert!((permuted[a * 12 + b] - original).abs() < 1e-13);
            }
        }
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(stiffness(&flat, lambda, mu), None);
    }
}

//! Code that the verification tests share: small models, static solutions, and comparison of figures with their
//! references.

use sinew_core::{
    ElasticLaw, ElementStiffness, Elements, LinearSystem, LoadTime, System, TangentKind, Trial,
};
use sinew_fem::{Element, Fixed, Law, LoadKind, LoadSpec, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

/// Density of soft tissue (kg/m^3).
pub(crate) const DENSITY: f64 = 1060.0;

/// Prints a figure with its reference; fails if they differ by more than `tolerance`.
#[track_caller]
pub(crate) fn figure(name: &str, reached: f64, expected: f64, tolerance: f64) {
    println!("{name}: {reached:.6e}, expected {expected} +- {tolerance:e}");
    let difference = (reached - expected).abs();
    assert!(
        difference <= tolerance,
        "{name}: {reached}, expected {expected} +- {tolerance:e}"
    );
}

/// Prints an error; fails if it is above `limit` or NaN.
#[track_caller]
pub(crate) fn at_most(name: &str, error: f64, limit: f64) {
    println!("{name}: {error:.2e}, at most {limit:e}");
    assert!(error <= limit, "{name}: {error:e}, at most {limit:e}");
}

pub(crate) fn linear(youngs_modulus: f64, poissons_ratio: f64) -> Law {
    Law::linear(youngs_modulus, poissons_ratio)
}

/// Undamped springs.
pub(crate) fn springs(youngs_modulus: f64, rule: SpringRule, calibrate: bool) -> Law {
    Law::Springs {
        youngs_modulus,
        rule,
        calibrate,
        damping_ratio: 0.0,
    }
}

/// A free body of one material.
pub(crate) fn body(law: Law) -> Problem {
    Problem::of([Region::new(law, DENSITY)])
}

pub(crate) fn held(group: &str) -> Fixed {
    held_along(group, [true; 3])
}

pub(crate) fn held_along(group: &str, axes: [bool; 3]) -> Fixed {
    Fixed::at(group).along(axes)
}

pub(crate) fn load(group: &str, kind: LoadKind) -> LoadSpec {
    LoadSpec::new(group, kind)
}

pub(crate) fn build(mesh: &TetMesh, problem: &Problem) -> Model {
    Model::build(mesh, problem).unwrap_or_else(|error| panic!("{error}"))
}

/// Adds a group of the nodes at chosen places.
pub(crate) fn add_node_group(mesh: &mut TetMesh, name: &str, belongs: impl Fn([f64; 3]) -> bool) {
    let nodes = (0u32..).zip(&mesh.points);
    let nodes = nodes.filter_map(|(node, point)| belongs(*point).then_some(node));
    let members = GroupMembers::Nodes(nodes.collect());
    mesh.groups.push(Group {
        name: name.into(),
        dim: 0,
        tag: 1,
        members,
    });
}

/// True if a node lies strictly inside the bounding box of a structured mesh.
pub(crate) fn is_inside(mesh: &TetMesh, node: usize) -> bool {
    let (low, high) = mesh.bounding_box();
    let point = mesh.points[node];
    (0..3).all(|axis| low[axis] < point[axis] && point[axis] < high[axis])
}

/// Moves the inner nodes by up to `reach` (m) along each axis, the same way for the same seed.
pub(crate) fn jitter(mesh: &mut TetMesh, reach: f64, mut seed: u64) {
    for node in 0..mesh.points.len() {
        if is_inside(mesh, node) {
            for coordinate in &mut mesh.points[node] {
                // xorshift64: Marsaglia, J. Stat. Softw. 8(14), 2003.
                seed ^= seed << 13;
                seed ^= seed >> 7;
                seed ^= seed << 17;
                *coordinate += reach * (2.0 * (seed >> 11) as f64 / (1_u64 << 53) as f64 - 1.0);
            }
        }
    }
    assert!(mesh.signed_volumes().iter().all(|volume| *volume > 0.0));
}

/// `field` at the node of each cell, three values a cell.
pub(crate) fn on_cells(model: &Model, field: impl Fn(usize) -> [f64; 3]) -> Vec<f64> {
    let nodes = model.nodes().iter();
    nodes.flat_map(|node| field(*node as usize)).collect()
}

/// K u.
pub(crate) fn stiffness_times(model: &Model, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    model.operators().stiffness().multiply(u, &mut force);
    force
}

/// The solution of K u = force, to rounding: conjugate gradients preconditioned by the diagonal (Saad, Iterative
/// Methods for Sparse Linear Systems, algorithm 9.1). Fixed components stay zero.
pub(crate) fn solve(model: &Model, force: &[f64]) -> Vec<f64> {
    let stiffness = model.operators().stiffness();
    let inverse_diagonal: Vec<f64> = (0..model.dofs())
        .map(|dof| stiffness.block(dof / 3, dof / 3).unwrap()[4 * (dof % 3)])
        .map(|entry| if entry == 0.0 { 0.0 } else { entry.recip() })
        .collect();
    let precondition = |residual: &[f64]| -> Vec<f64> {
        let parts = residual.iter().zip(&inverse_diagonal);
        parts
            .map(|(residual, inverse)| residual * inverse)
            .collect()
    };
    let mut u = vec![0.0; model.dofs()];
    let mut residual = force.to_vec();
    let mut direction = precondition(&residual);
    let mut size = dot(&residual, &direction);
    let rounding = size * f64::EPSILON.powi(2);
    for _ in 0..10 * model.dofs() {
        if size <= rounding {
            return u;
        }
        let pull = stiffness_times(model, &direction);
        let step = size / dot(&direction, &pull);
        for (u, direction) in u.iter_mut().zip(&direction) {
            *u += step * direction;
        }
        for (residual, pull) in residual.iter_mut().zip(&pull) {
            *residual -= step * pull;
        }
        let next = precondition(&residual);
        let before = std::mem::replace(&mut size, dot(&residual, &next));
        for (direction, next) in direction.iter_mut().zip(&next) {
            *direction = next + size / before * *direction;
        }
    }
    panic!("no equilibrium found: {size:e} of {rounding:e}");
}

/// The equilibrium under the model's loads at full value.
pub(crate) fn equilibrium(model: &Model) -> Vec<f64> {
    let mut force = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(LoadTime::at(0.0), &mut force);
    solve(model, &force)
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn max_abs(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max, value| value.abs().max(max))
}

/// The largest difference of two vectors over the largest entry of `expected`.
pub(crate) fn relative_difference(reached: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(reached.len(), expected.len());
    let difference: Vec<f64> = reached.iter().zip(expected).map(|(a, b)| a - b).collect();
    max_abs(&difference) / max_abs(expected)
}

/// A cube of 10 cm whose inner and outer nodes are moved irregularly.
pub(crate) fn uneven_cube() -> TetMesh {
    let mut mesh = structured::cube(3, 0.1, Split::Kuhn).unwrap_or_else(|error| panic!("{error}"));
    jitter(&mut mesh, 0.006, 11);
    mesh
}

/// Arbitrary numbers for the degrees of freedom.
pub(crate) fn waves(dofs: usize, seed: f64) -> Vec<f64> {
    (0..dofs).map(|i| (seed * i as f64 + seed).sin()).collect()
}

/// `u + h w`.
pub(crate) fn moved(u: &[f64], h: f64, w: &[f64]) -> Vec<f64> {
    u.iter().zip(w).map(|(u, w)| u + h * w).collect()
}

/// A trial point of a body without history variables, at t = 0.
pub(crate) fn at<'a>(u: &'a [f64], v: &'a [f64]) -> Trial<'a> {
    Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u,
        v,
        internal: &[],
    }
}

/// Elastic energy (J) and force (N) at a displacement.
pub(crate) fn elastic(model: &Model, u: &[f64]) -> (f64, Vec<f64>) {
    let (mut force, v) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    let found = model.elastic_force(&at(u, &v), &mut force);
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    (found.energy, force)
}

/// The tangent at a displacement times a change of it (N).
pub(crate) fn product(model: &Model, kind: TangentKind, u: &[f64], w: &[f64]) -> Vec<f64> {
    let (mut out, v) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    let made = model.tangent_product(&at(u, &v), kind, w, &mut out);
    made.unwrap_or_else(|error| panic!("{error}"));
    out
}

/// An element of each kind.
pub(crate) const ELEMENTS: [Element; 4] = [
    Element::P1,
    Element::Fbar { patch: Some(12) },
    edges(0.9),
    edges(1.0),
];

/// `fbar-edge` with patches of the default size.
pub(crate) const fn edges(edge_share: f64) -> Element {
    Element::FbarEdge {
        edge_share,
        patch: None,
    }
}

/// A displacement (m) of the cells that bends and stretches a body, of this size.
pub(crate) fn bent(mesh: &TetMesh, model: &Model, size: f64) -> Vec<f64> {
    on_cells(model, |node| {
        let [x, y, z] = mesh.points[node];
        [
            size * (0.03 * (25.0 * z).sin() + 0.2 * x + 2.0 * y * z),
            size * (0.02 * (31.0 * x + 8.0 * y).cos() - 0.3 * z),
            size * (0.25 * z + 0.15 * y + 3.0 * x * x),
        ]
    })
}

/// The forces (N) of a displacement, from the stiffness of the parts of a body at rest.
pub(crate) fn by_elements(model: &Model, u: &[f64]) -> Vec<f64> {
    let mut by_elements = vec![0.0; u.len()];
    let mut part = ElementStiffness::default();
    for number in 0..Elements::count(model) {
        model.stiffness(number, &mut part);
        let dofs: Vec<usize> = part
            .cells
            .iter()
            .flat_map(|cell| [0, 1, 2].map(|axis| 3 * *cell as usize + axis))
            .collect();
        for (i, row) in dofs.iter().enumerate() {
            for (j, column) in dofs.iter().enumerate() {
                by_elements[*row] += part.matrix[i * dofs.len() + j] * u[*column];
            }
        }
    }
    by_elements
}

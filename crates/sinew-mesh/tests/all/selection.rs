//! Parts of a mesh chosen by position.

use std::f64::consts::PI;

use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Condition, Selection, SelectionError, TetMesh};

/// A cube of edge 0.4 with 4 cells along each edge, 5 nodes.
fn cube() -> TetMesh {
    structured::cube(4, 0.4, Split::Mirrored).unwrap()
}

fn by(conditions: &[Condition]) -> Selection {
    Selection::new(conditions.to_vec())
}

const INF: f64 = f64::INFINITY;

fn area(mesh: &TetMesh, triangles: &[[u32; 3]]) -> f64 {
    triangles.iter().map(|triangle| mesh.area(*triangle)).sum()
}

#[test]
fn bounds_take_what_lies_on_them_whatever_the_rounding() {
    let cube = cube();
    // 3 * 0.1 is a little above 0.3 in binary.
    let lower = by(&[Condition::below([INF, INF, 0.3])]);
    assert_eq!(lower.nodes(&cube).unwrap().len(), 4 * 25);
    let upper = by(&[Condition::above([-INF, -INF, 0.3])]);
    assert_eq!(upper.nodes(&cube).unwrap().len(), 2 * 25);
    assert_eq!(upper.tets(&cube).unwrap().len(), 6 * 16);
}

#[test]
fn cells_need_all_their_nodes() {
    let cube = cube();
    let half = by(&[Condition::below([INF, INF, 0.25])]);
    // Two whole layers of cells, and the floor with 4 half walls.
    assert_eq!(half.tets(&cube).unwrap().len(), 2 * 16 * 6);
    let triangles = half.triangles(&cube).unwrap();
    assert!((area(&cube, &triangles) - (0.16 + 4.0 * 0.4 * 0.2)).abs() < 1e-12);
}

#[test]
fn several_conditions_must_all_hold() {
    let cube = cube();
    let edge = by(&[
        Condition::below([0.0, INF, INF]),
        Condition::above([-INF, -INF, 0.4]),
    ]);
    assert_eq!(edge.nodes(&cube).unwrap().len(), 5);
    let corner = by(&[
        Condition::Box {
            low: [0.0; 3],
            high: [0.15; 3],
        },
        Condition::Sphere {
            center: [0.1; 3],
            radius: 0.1,
        },
    ]);
    // The corner cube has 8 nodes; (.1, .1, .1) and its three neighbours are in the sphere.
    assert_eq!(corner.nodes(&cube).unwrap().len(), 4);
}

#[test]
fn a_cylinder_ends_at_its_flat_ends_and_takes_what_lies_on_it() {
    let cube = cube();
    let within = |from, to, radius| {
        let axis = [from, to];
        by(&[Condition::Cylinder { axis, radius }])
    };
    let count = |selection: &Selection| selection.nodes(&cube).unwrap().len();
    // Along z: the node on the axis and its four neighbours, on the planes from z = .1 to .3.
    let upright = within([0.2, 0.2, 0.1], [0.2, 0.2, 0.3], 0.1);
    assert_eq!(count(&upright), 3 * 5);
    let turned = within([0.2, 0.2, 0.3], [0.2, 0.2, 0.1], 0.1);
    assert_eq!(count(&turned), 3 * 5);
    // Along a diagonal of a face: on it are nodes at distances of sqrt 2 times .1.
    let across = within([0.1, 0.1, 0.2], [0.3, 0.3, 0.2], 1e-6);
    assert_eq!(count(&across), 3);
    // A disc: ends so close that a plane is left.
    let disc = within([0.2, 0.2, 0.2 - 1e-9], [0.2, 0.2, 0.2 + 1e-9], 0.15);
    assert_eq!(count(&disc), 9);
    assert_eq!(
        upright.to_string(),
        "within 0.1 m of the axis from (0.2, 0.2, 0.1) to (0.2, 0.2, 0.3)"
    );
    let beside = within([0.25, 0.25, 0.0], [0.25, 0.25, 0.4], 0.01);
    assert!(matches!(
        beside.nodes(&cube),
        Err(SelectionError::Nothing { .. })
    ));
    // As many tetrahedra as have all corners inside: none is left of the box by a cylinder that holds it.
    let around = within([0.2, 0.2, -0.1], [0.2, 0.2, 0.5], 0.3);
    assert_eq!(around.tets(&cube).unwrap().len(), cube.tets.len());
}

#[test]
fn a_plane_takes_both_of_its_sides() {
    let cube = cube();
    let near = |normal, within| {
        by(&[Condition::Plane {
            point: [0.2, 0.2, 0.2],
            normal,
            within,
        }])
    };
    assert_eq!(near([0.0, 0.0, 9.0], 0.0).nodes(&cube).unwrap().len(), 25);
    assert_eq!(near([0.0, 0.0, -1.0], 0.1).nodes(&cube).unwrap().len(), 75);
    // i + j + k = 6 with i, j, k from 0 to 4 has 19 solutions.
    assert_eq!(near([1.0, 1.0, 1.0], 1e-6).nodes(&cube).unwrap().len(), 19);
}

#[test]
fn a_face_is_the_boundary_that_looks_that_way() {
    let cube = cube();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut normal = [0.0; 3];
            normal[axis] = 2.0 * side;
            let face = by(&[Condition::facing(normal, 1e-3)]);
            let end = if side < 0.0 { 0.0 } else { 0.4 };
            let nodes = face.nodes(&cube).unwrap();
            assert_eq!(nodes.len(), 25);
            assert!(
                nodes
                    .iter()
                    .all(|n| (cube.points[*n as usize][axis] - end).abs() < 1e-12)
            );
            assert_eq!(face.triangles(&cube).unwrap().len(), 32);
        }
    }
    // A strip one cell wide: the walls' triangles have none of their three nodes on the floor alone.
    let strip = by(&[
        Condition::facing([0.0, 0.0, -1.0], 20.0),
        Condition::below([0.1, INF, INF]),
    ]);
    let triangles = strip.triangles(&cube).unwrap();
    assert!((area(&cube, &triangles) - 0.1 * 0.4).abs() < 1e-12);
}

/// A cube pressed to a sphere: the area of its cap within an angle t of the pole is 2 pi r^2 (1 - cos t).
#[test]
fn the_cap_of_a_sphere_has_the_area_of_the_formula() {
    let mut ball = structured::cube(24, 2.0, Split::Mirrored).unwrap();
    for point in &mut ball.points {
        let centred = point.map(|x| x - 1.0);
        let largest = centred.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let length = centred.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 {
            *point = centred.map(|x| x * largest / length);
        } else {
            *point = [0.0; 3];
        }
    }
    let cap = by(&[Condition::facing([0.0, 0.0, 1.0], 60.0)]);
    let area = area(&ball, &cap.triangles(&ball).unwrap());
    let expected = 2.0 * PI * (1.0 - 0.5);
    assert!((area / expected - 1.0).abs() < 0.03, "{area}, {expected}");
}

#[test]
fn tags_are_those_of_the_file() {
    let mut cube = cube();
    for tag in &mut cube.node_tags {
        *tag = 1000 + 7 * *tag;
    }
    let three = by(&[Condition::Tags(vec![1014, 1007])]);
    assert_eq!(three.nodes(&cube).unwrap(), [0, 1]);
    let unknown = by(&[Condition::Tags(vec![1007, 8])]);
    let error = unknown.nodes(&cube).unwrap_err();
    assert_eq!(error.to_string(), "no tetrahedron has a node with tag 8");
}

#[test]
fn what_hits_nothing_says_how_far_the_body_reaches() {
    let cube = cube();
    let outside = by(&[Condition::above([-INF, -INF, 3.0])]);
    assert_eq!(
        outside.nodes(&cube).unwrap_err().to_string(),
        "no node is at z >= 3 m; the body reaches from (0, 0, 0) to (0.4, 0.4, 0.4) m"
    );
    let middle = by(&[Condition::Sphere {
        center: [0.2; 3],
        radius: 0.01,
    }]);
    assert_eq!(middle.nodes(&cube).unwrap().len(), 1);
    let error = middle.tets(&cube).unwrap_err();
    assert!(
        matches!(error, SelectionError::NoCell { nodes: 1, .. }),
        "{error}"
    );
    assert!(matches!(
        middle.triangles(&cube),
        Err(SelectionError::NoCell { nodes: 1, .. })
    ));
}

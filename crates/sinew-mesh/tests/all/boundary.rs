//! The boundary of a mesh and of its parts.

use std::collections::HashMap;

use sinew_mesh::structured::{Split, block, cube};
use sinew_mesh::{GroupMembers, TetMesh};

/// Half the cross product of two edges: the area times the unit normal.
fn area_vector(mesh: &TetMesh, triangle: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = triangle.map(|node| mesh.points[node as usize]);
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    [
        (u[1] * v[2] - u[2] * v[1]) / 2.0,
        (u[2] * v[0] - u[0] * v[2]) / 2.0,
        (u[0] * v[1] - u[1] * v[0]) / 2.0,
    ]
}

fn area(mesh: &TetMesh, triangles: &[[u32; 3]]) -> f64 {
    let areas = triangles.iter().map(|&triangle| {
        let vector = area_vector(mesh, triangle);
        vector.iter().map(|x| x * x).sum::<f64>().sqrt()
    });
    areas.sum()
}

/// Volume by the divergence theorem: a third of the flux of the position through the triangles.
fn enclosed_volume(mesh: &TetMesh, triangles: &[[u32; 3]]) -> f64 {
    let fluxes = triangles.iter().map(|&triangle| {
        let vector = area_vector(mesh, triangle);
        let corner = mesh.points[triangle[0] as usize];
        (0..3).map(|i| vector[i] * corner[i]).sum::<f64>() / 3.0
    });
    fluxes.sum()
}

/// Checks that a surface is closed and consistently oriented: each edge occurs once in each direction.
fn assert_closed(triangles: &[[u32; 3]]) {
    let mut runs: HashMap<[u32; 2], i32> = HashMap::new();
    for &[a, b, c] in triangles {
        for edge in [[a, b], [b, c], [c, a]] {
            *runs.entry(edge).or_default() += 1;
        }
    }
    for (&[a, b], &count) in &runs {
        assert_eq!((count, runs.get(&[b, a])), (1, Some(&1)), "edge {a} {b}");
    }
}

#[test]
fn the_boundary_of_a_box_is_its_six_faces_outward() {
    let size = [0.3, 0.2, 0.4];
    for split in [Split::Kuhn, Split::Mirrored] {
        let mesh = block([3, 2, 4], size, split).expect("valid");
        let boundary = mesh.boundary(None);
        // Two triangles for each square of the grid.
        assert_eq!(boundary.len(), 2 * 2 * (3 * 2 + 2 * 4 + 4 * 3));
        assert_closed(&boundary);
        let expected = 2.0 * (0.3 * 0.2 + 0.2 * 0.4 + 0.4 * 0.3);
        assert!((area(&mesh, &boundary) - expected).abs() < 1e-12);
        assert!((enclosed_volume(&mesh, &boundary) - 0.3 * 0.2 * 0.4).abs() < 1e-12);
        for triangle in boundary {
            let vector = area_vector(&mesh, triangle);
            let axis = (0..3)
                .find(|&i| vector[i].abs() > 1e-6)
                .expect("it has an area");
            let height = mesh.points[triangle[0] as usize][axis];
            let expected = if vector[axis] > 0.0 { size[axis] } else { 0.0 };
            assert!((height - expected).abs() < 1e-12, "a normal points inward");
        }
    }
}

#[test]
fn inverted_tetrahedra_have_outward_faces_too() {
    let mut mesh = cube(2, 0.1, Split::Kuhn).expect("valid");
    for tet in mesh.tets.iter_mut().step_by(2) {
        tet.swap(0, 1);
    }
    let boundary = mesh.boundary(None);
    assert_closed(&boundary);
    assert!((enclosed_volume(&mesh, &boundary) - 1e-3).abs() < 1e-15);
}

#[test]
fn a_part_is_bounded_by_its_interface_as_well() {
    let mut mesh = block([4, 2, 2], [0.4, 0.2, 0.2], Split::Kuhn).expect("valid");
    let is_left = |tet: &[u32; 4]| tet.iter().all(|&n| mesh.points[n as usize][0] < 0.21);
    let left = (0u32..).zip(&mesh.tets).filter(|(_, tet)| is_left(tet));
    let left: Vec<u32> = left.map(|(tet, _)| tet).collect();
    let group = mesh
        .add_group("left", GroupMembers::Tets(left))
        .expect("new")
        .clone();
    let boundary = mesh.boundary(Some(&group));
    assert_closed(&boundary);
    assert!((area(&mesh, &boundary) - 6.0 * 0.04).abs() < 1e-12);
    assert!((enclosed_volume(&mesh, &boundary) - 0.008).abs() < 1e-12);

    let top = mesh.group("top").expect("it is there");
    assert!(
        mesh.boundary(Some(top)).is_empty(),
        "triangles enclose nothing"
    );
}

#[test]
fn a_cavity_is_bounded_towards_its_inside() {
    let mut mesh = cube(3, 0.3, Split::Mirrored).expect("valid");
    let is_core = |tet: &[u32; 4]| {
        let inside = |x: f64| (0.09..0.21).contains(&x);
        tet.iter()
            .all(|&n| mesh.points[n as usize].iter().all(|&x| inside(x)))
    };
    let kept: Vec<[u32; 4]> = mesh
        .tets
        .iter()
        .copied()
        .filter(|tet| !is_core(tet))
        .collect();
    assert_eq!(
        mesh.tets.len() - kept.len(),
        6,
        "one of 27 cells is the core"
    );
    mesh.tets = kept;
    let boundary = mesh.boundary(None);
    assert_closed(&boundary);
    assert!((area(&mesh, &boundary) - 6.0 * (0.09 + 0.01)).abs() < 1e-12);
    assert!((enclosed_volume(&mesh, &boundary) - 0.026).abs() < 1e-12);
}

#[test]
fn a_collapsed_tetrahedron_has_no_faces() {
    let mut mesh = cube(1, 0.1, Split::Kuhn).expect("valid");
    let before = mesh.boundary(None);
    let [a, b, c, _] = mesh.tets[0];
    mesh.tets.push([a, b, c, a]);
    assert_eq!(mesh.boundary(None), before);
}

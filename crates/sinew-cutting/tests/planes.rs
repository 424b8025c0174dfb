//! Planes at any angle through a structured mesh, with nodes moved onto them.
#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test")]

mod common;

use std::collections::BTreeSet;

use common::{Tissue, body, kuhn_cube, masses, plane, topology, volume};
use sinew_cutting::{CuttableBody, Sheet, TetProperties};

const EDGE: f64 = 0.01;

/// Planes through the cube's middle or so, at angles that no direction of the mesh has.
fn planes() -> impl Iterator<Item = Sheet> {
    (0..17).map(|k| {
        let k = f64::from(k);
        let (angle, tilt) = (std::f64::consts::PI * (k + 0.3) / 17.0, 0.37 * k);
        let normal = [
            angle.cos(),
            angle.sin() * tilt.cos(),
            angle.sin() * tilt.sin(),
        ];
        plane([0.0512, 0.0493, 0.0507], normal)
    })
}

/// Distances of the nodes of the cut faces from the plane, by the edge of the grid: largest and root mean square.
fn roughness(
    body: &CuttableBody,
    faces: &[(u32, u8)],
    sheet: &Sheet,
    positions: &[[f64; 3]],
) -> [f64; 2] {
    let mut nodes = BTreeSet::new();
    for (tet, vertex) in faces {
        let corners = (0..4).filter(|corner| corner != vertex);
        nodes.extend(corners.map(|corner| body.tets()[*tet as usize][corner as usize]));
    }
    let distances = nodes
        .iter()
        .map(|node| sheet.distance(positions[*node as usize]).abs() / EDGE);
    let (largest, squares) = distances.fold((0.0_f64, 0.0), |(largest, sum), distance| {
        (largest.max(distance), sum + distance * distance)
    });
    [largest, (squares / nodes.len() as f64).sqrt()]
}

#[test]
fn cuts_through_at_any_angle_leave_two_pieces_sound_tetrahedra_and_bounded_frequencies() {
    let mesh = kuhn_cube();
    let tissue = Tissue {
        poissons_ratio: 0.45,
    };
    let (mut means, mut areas) = ([0.0; 2], [0.0; 2]);
    for sheet in planes() {
        for (kind, snap) in [0.0, 0.25].into_iter().enumerate() {
            let (mut body, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
            let stroke = body.stroke(&sheet, &mut positions, snap).unwrap().clone();
            assert_eq!(stroke.moved.is_empty(), snap == 0.0);
            assert_eq!(body.pieces().count, 2);
            assert_eq!(topology::euler(&body, &mesh), 2);
            topology::check(&body, &mesh);
            for tet in body.tets() {
                let vertices = tet.map(|node| body.points()[node as usize]);
                assert!(tissue.frequency(0, &vertices) <= 1.25 * body.largest_frequency());
                assert!(volume(body.points(), *tet) > 0.3 * EDGE.powi(3) / 6.0);
            }
            // Inner nodes change no volume, nodes of a face stay in it.
            let mass: f64 = masses(&body).iter().sum();
            assert!((mass / 1.06 - 1.0).abs() < 1e-13);
            let [largest, mean] = roughness(&body, &stroke.faces, &sheet, &positions);
            assert!(largest < 1.0 && mean < 0.55, "{snap}: {largest} {mean}");
            means[kind] += mean / 17.0;
            areas[kind] += stroke.area / 17.0;
            // What was moved lies on the sheet, at rest as well, for nothing has moved yet.
            for moved in &stroke.moved {
                let node = moved.node as usize;
                assert!(sheet.distance(positions[node]).abs() < 1e-9 * EDGE);
                let apart = |axis: usize| (positions[node][axis] - body.points()[node][axis]).abs();
                assert!((0..3).all(|axis| apart(axis) < 1e-12 * EDGE));
            }
        }
    }
    assert!(means[1] < 0.98 * means[0], "{means:?}");
    assert!(areas[1] < 0.99 * areas[0], "{areas:?}");
}

#[test]
fn a_plane_near_a_layer_of_nodes_becomes_smooth() {
    let mesh = kuhn_cube();
    let (mut body, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
    let sheet = plane([0.051, 0.05, 0.05], [1.0, 0.01, 0.02]);
    let stroke = body.stroke(&sheet, &mut positions, 0.25).unwrap().clone();
    assert_eq!((stroke.faces.len(), stroke.copied.len()), (200, 121));
    let [largest, _] = roughness(&body, &stroke.faces, &sheet, &positions);
    assert!(largest < 1e-6, "{largest}");
    let area = 0.01 * (1.0_f64 + 0.01 * 0.01 + 0.02 * 0.02).sqrt();
    assert!((stroke.area / area - 1.0).abs() < 1e-9);
}

#[test]
fn a_cut_through_a_deformed_body_is_that_of_its_shape_at_rest_by_the_bent_sheet() {
    // Sheared by half: a plane now is another plane at rest.
    let mesh = kuhn_cube();
    let sheared = |[x, y, z]: [f64; 3]| [x + 0.5 * z, y, z];
    let sheet = plane([0.077, 0.05, 0.05], [1.0, 0.02, 0.01]);
    let (mut deformed, mut positions) = (
        body(&mesh, 0.45),
        mesh.points.iter().copied().map(sheared).collect::<Vec<_>>(),
    );
    let there = deformed
        .stroke(&sheet, &mut positions, 0.25)
        .unwrap()
        .clone();
    for moved in &there.moved {
        let at_rest = deformed.points()[moved.node as usize];
        let (found, expected) = (positions[moved.node as usize], sheared(at_rest));
        assert!((0..3).all(|axis| (found[axis] - expected[axis]).abs() < 1e-12));
    }
    assert!(there.moved.len() > 20);
    assert_eq!(deformed.pieces().count, 2);
}

#[test]
fn a_cut_in_many_strokes_is_a_cut_in_one_where_no_node_is_moved() {
    let mesh = kuhn_cube();
    let pose = |share: f64| {
        let x = 0.043 + 0.02 * share;
        [
            [x, -0.01, 0.12 - 0.15 * share],
            [x + 0.01, 0.11, 0.12 - 0.15 * share],
        ]
    };
    let (mut one, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
    let sheet = Sheet::swept(pose(0.0), pose(1.0)).unwrap();
    let at_once = one.stroke(&sheet, &mut positions, 0.0).unwrap().faces.len();
    let (mut many, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
    let mut faces = 0;
    for n in 0..50 {
        let share = |n: i32| f64::from(n) / 50.0;
        let sheet = Sheet::swept(pose(share(n)), pose(share(n + 1))).unwrap();
        faces += many
            .stroke(&sheet, &mut positions, 0.0)
            .unwrap()
            .faces
            .len();
    }
    topology::check(&many, &mesh);
    assert_eq!(one.pieces().count, 2);
    assert_eq!(many.pieces().count, 2);
    // Which side a tetrahedron is on may be settled before its neighbours are known.
    assert!(faces.abs_diff(at_once) * 8 < at_once, "{faces} {at_once}");
}

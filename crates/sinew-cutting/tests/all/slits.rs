//! Slits along planes of a structured mesh.
use std::collections::BTreeSet;

use crate::common::{body, kuhn_cube, masses, plane, topology};
use sinew_cutting::{CuttableBody, Sheet};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

/// The blade along y at x = 50 mm, its lower end at this height.
fn blade(z: f64) -> [[f64; 3]; 2] {
    [[0.05, -0.01, z], [0.05, 0.11, z]]
}

/// Cuts down to a height in several strokes of equal depth; returns the cut faces.
fn slit(body: &mut CuttableBody, positions: &mut Vec<[f64; 3]>, to: f64, strokes: u32) -> usize {
    let height = |n: u32| 0.101 + (to - 0.101) * f64::from(n) / f64::from(strokes);
    let faces = (0..strokes).map(|n| {
        let sheet = Sheet::swept(blade(height(n)), blade(height(n + 1))).unwrap();
        body.stroke(&sheet, positions, 0.25).unwrap().faces.len()
    });
    faces.sum()
}

/// Number of faces with a tetrahedron on one side only: the body's surface and both faces of its cuts.
fn open_faces(body: &CuttableBody, mesh: &TetMesh) -> usize {
    body.mesh(mesh).mesh.boundary(None).len()
}

#[test]
fn a_slit_of_seven_rows_has_140_faces_and_77_new_nodes_in_one_stroke_or_in_many() {
    let mesh = kuhn_cube();
    for strokes in [1, 7, 40] {
        let (mut body, mut positions) = (body(&mesh, 0.25), mesh.points.clone());
        assert_eq!(slit(&mut body, &mut positions, 0.0301, strokes), 140);
        assert_eq!(body.nodes() - mesh.points.len(), 77);
        assert_eq!(positions.len(), body.nodes());
        assert_eq!(open_faces(&body, &mesh), 1200 + 2 * 140);
        assert_eq!(body.pieces().count, 1);
        assert_eq!(topology::euler(&body, &mesh), 1);
        topology::check(&body, &mesh);
        let mass: f64 = masses(&body).iter().sum();
        assert!((mass / 1.06 - 1.0).abs() < 1e-13);
    }
}

/// Tissue rises by more than the blade comes down, and vibrates across it, while the blade moves along a layer of
/// nodes.
#[test]
fn tissue_that_comes_towards_the_blade_is_cut_as_tissue_at_rest() {
    let mesh = kuhn_cube();
    for (snap, shiver) in [(0.0, 0.0), (0.0, 1e-9), (0.25, 0.0), (0.25, 2e-5)] {
        let mut body = body(&mesh, 0.25);
        let steps = 60;
        let mut positions = mesh.points.clone();
        let mut before = [0.0; 3];
        let mut faces = 0;
        for n in 0..steps {
            let share = |n: u32| f64::from(n) / f64::from(steps);
            let left = 1.0 - share(n + 1);
            let side = if n % 2 == 0 { shiver } else { -shiver };
            let now = [side * f64::from(u8::from(n + 1 < steps)), 0.0, -0.05 * left];
            for place in &mut positions {
                for axis in 0..3 {
                    place[axis] += now[axis] - before[axis];
                }
            }
            before = now;
            let height = |n: u32| 0.0601 + (0.0301 - 0.0601) * share(n);
            let sheet = Sheet::swept(blade(height(n)), blade(height(n + 1))).unwrap();
            faces += body
                .stroke(&sheet, &mut positions, snap)
                .unwrap()
                .faces
                .len();
        }
        if shiver < 1e-6 {
            assert_eq!((faces, body.nodes() - mesh.points.len()), (140, 77));
        } else {
            // The row at the blade's last place may not be through.
            assert!((120..=140).contains(&faces), "{faces}");
        }
        topology::check(&body, &mesh);
    }
}

#[test]
fn a_cut_through_makes_two_pieces_and_one_inside_a_void() {
    let mesh = kuhn_cube();
    let (mut through, mut positions) = (body(&mesh, 0.25), mesh.points.clone());
    assert_eq!(slit(&mut through, &mut positions, -0.01, 3), 200);
    assert_eq!(through.nodes() - mesh.points.len(), 121);
    let pieces = through.pieces();
    assert_eq!(pieces.count, 2);
    assert_eq!(topology::euler(&through, &mesh), 2);
    for (tet, piece) in pieces.of_tet.iter().enumerate() {
        let x: f64 = mesh.tets[tet]
            .iter()
            .map(|node| mesh.points[*node as usize][0])
            .sum();
        assert_eq!(*piece, Some(u32::from(x > 0.2)));
    }

    let (mut inside, mut positions) = (body(&mesh, 0.25), mesh.points.clone());
    let edge = |z: f64| [[0.05, 0.029, z], [0.05, 0.071, z]];
    let sheet = Sheet::swept(edge(0.029), edge(0.071)).unwrap();
    let stroke = inside.stroke(&sheet, &mut positions, 0.25).unwrap();
    assert_eq!((stroke.faces.len(), stroke.copied.len()), (32, 9));
    // A ball around a void: the sphere within adds 1.
    assert_eq!(topology::euler(&inside, &mesh), 2);
    assert_eq!(inside.pieces().count, 1);
    topology::check(&inside, &mesh);
}

#[test]
fn a_blade_that_turns_half_round_about_a_point_of_its_own_cuts_through() {
    let mesh = kuhn_cube();
    for (steps, before) in [(7, 0.15), (100, 0.15), (100, 0.11)] {
        let (mut body, mut positions) = (body(&mesh, 0.25), mesh.points.clone());
        let blade = |step: u32| {
            let turned = std::f64::consts::PI * f64::from(step) / f64::from(steps);
            let at = |x: f64| [0.05, 0.0483 + x * turned.cos(), 0.0517 + x * turned.sin()];
            [at(-before), at(0.15)]
        };
        let faces = (0..steps).map(|step| {
            let sheet = Sheet::swept(blade(step), blade(step + 1)).unwrap();
            let stroke = body.stroke(&sheet, &mut positions, 0.25).unwrap();
            stroke.faces.len()
        });
        let faces: usize = faces.sum();
        assert_eq!((faces, body.pieces().count), (200, 2), "{steps} {before}");
    }
}

#[test]
fn strokes_in_the_same_place_cut_nothing_more() {
    let mesh = kuhn_cube();
    let (mut body, mut positions) = (body(&mesh, 0.25), mesh.points.clone());
    slit(&mut body, &mut positions, 0.0301, 1);
    let nodes = body.nodes();
    assert_eq!(slit(&mut body, &mut positions, 0.0301, 5), 0);
    body.lift();
    assert_eq!(slit(&mut body, &mut positions, 0.0301, 1), 0);
    assert_eq!(body.nodes(), nodes);
}

#[test]
fn a_slit_in_the_middle_of_the_mirrored_cube_is_its_own_mirror_image() {
    let mesh = structured::cube(10, 0.1, Split::Mirrored).unwrap();
    let (mut body, mut positions) = (body(&mesh, 0.25), mesh.points.clone());
    slit(&mut body, &mut positions, 0.0301, 3);
    let cut = body.mesh(&mesh).mesh;
    let key = |point: [f64; 3]| point.map(|x| (x * 1e6).round() as i64);
    // Outward faces, each from its least corner on: a lip is told from the one that faces it.
    let surface = |mirror: bool| -> BTreeSet<[[i64; 3]; 3]> {
        let place = |node: u32| {
            let [x, y, z] = cut.points[node as usize];
            key([if mirror { 0.1 - x } else { x }, y, z])
        };
        let face = |[a, b, c]: [u32; 3]| {
            let mut face = (if mirror { [a, c, b] } else { [a, b, c] }).map(place);
            let least = (0..3).min_by_key(|corner| face[*corner]).unwrap();
            face.rotate_left(least);
            face
        };
        cut.boundary(None).into_iter().map(face).collect()
    };
    assert_eq!(surface(false).len(), 1200 + 2 * 140);
    assert_eq!(surface(false), surface(true));
    // The copies stand on one side of the slit, and all of them there.
    let copies = mesh.points.len()..cut.points.len();
    for copy in copies {
        let tets = cut.tets.iter().filter(|tet| tet.contains(&(copy as u32)));
        let sides: Vec<f64> = tets
            .map(|tet| {
                tet.iter()
                    .map(|node| cut.points[*node as usize][0] - 0.05)
                    .sum::<f64>()
                    .signum()
            })
            .collect();
        assert!(sides.iter().all(|side| *side == sides[0]));
    }
}

#[test]
fn a_blade_that_enters_in_part_cuts_nothing_until_it_comes_through() {
    let mesh = TetMesh::new(
        vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 1.0, 1.0],
        ],
        vec![[0, 1, 2, 3], [1, 2, 3, 4]],
    )
    .unwrap();
    let edge = |t: f64| [[-1.0 + t, -1.0, 0.3], [-1.0 + t, 3.0, 0.3]];
    let cut = |body: &mut CuttableBody, positions: &mut Vec<[f64; 3]>, from: f64, to: f64| {
        let sheet = Sheet::swept(edge(from), edge(to)).unwrap();
        body.stroke(&sheet, positions, 0.0).unwrap().faces.len()
    };
    // Both are divided; one of them keeps the side of the other until the blade is through.
    let (mut whole, mut positions) = (body(&mesh, 0.0), mesh.points.clone());
    let at_once = cut(&mut whole, &mut positions, 0.0, 4.0);
    let (mut parts, mut positions) = (body(&mesh, 0.0), mesh.points.clone());
    assert_eq!(cut(&mut parts, &mut positions, 0.0, 1.5), 0);
    let rest = cut(&mut parts, &mut positions, 1.5, 4.0);
    assert_eq!(rest, at_once);
    let (mut lifted, mut positions) = (body(&mesh, 0.0), mesh.points.clone());
    assert_eq!(cut(&mut lifted, &mut positions, 0.0, 1.5), 0);
    lifted.lift();
    assert_eq!(cut(&mut lifted, &mut positions, 1.6, 4.0), 0);
}

/// The faces that strokes cut when the blade comes down next to a plane of nodes, and the edge of the blade at that
/// time.
fn cut_beside_a_plane(mesh: &TetMesh) -> Vec<((u32, u32), f64)> {
    let (mut body, mut positions) = (body(mesh, 0.25), mesh.points.clone());
    let whole = crate::common::body(mesh, 0.25);
    let mut cut = Vec::new();
    for n in 0..30 {
        let pose = |n: u32| {
            let z = 0.101 - 0.0031 * f64::from(n);
            [[0.0537, -0.01, z], [0.0537, 0.11, z]]
        };
        let sheet = Sheet::swept(pose(n), pose(n + 1)).unwrap();
        let stroke = body.stroke(&sheet, &mut positions, 0.0).unwrap();
        for (tet, vertex) in &stroke.faces {
            let other = whole.neighbour(*tet, usize::from(*vertex)).unwrap();
            cut.push(((*tet, other), pose(n + 1)[0][2]));
        }
    }
    cut
}

#[test]
fn a_face_is_cut_once_the_blade_is_through_the_tetrahedra_beside_it() {
    let mesh = kuhn_cube();
    let cut = cut_beside_a_plane(&mesh);
    assert!(cut.len() >= 150);
    for ((tet, other), edge) in cut {
        for tet in [tet, other] {
            let vertices = mesh.tets[tet as usize].map(|node| mesh.points[node as usize]);
            for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                let (a, b) = (vertices[a], vertices[b]);
                let share = (0.0537 - a[0]) / (b[0] - a[0]);
                if share > 0.0 && share < 1.0 {
                    assert!(a[2] + share * (b[2] - a[2]) > edge - 1e-12);
                }
            }
        }
    }
}

#[test]
fn a_blade_outside_the_body_changes_nothing() {
    let mesh = kuhn_cube();
    let (mut body, mut positions) = (body(&mesh, 0.25), mesh.points.clone());
    let sheet = plane([0.5, 0.5, 0.5], [1.0, 1.0, 1.0]);
    assert!(
        body.stroke(&sheet, &mut positions, 0.25)
            .unwrap()
            .is_empty()
    );
    assert_eq!(body.nodes(), 1331);
    positions.pop();
    assert_eq!(
        body.stroke(&sheet, &mut positions, 0.25)
            .unwrap_err()
            .to_string(),
        "1330 positions for 1331 nodes"
    );
}

//! Planes at any angle through a structured mesh, with nodes moved onto them.
use std::collections::BTreeSet;

use crate::common::{Tissue, body, kuhn_cube, masses, plane, topology, volume};
use sinew_cutting::{CuttableBody, Sheet, Stroke, TetProperties};
use sinew_mesh::TetMesh;

const EDGE: f64 = 0.01;

/// Planes through or near the cube's middle, at angles different from all directions of the mesh.
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

/// Distances of the nodes of the cut faces from the plane, relative to the edge of the grid: largest and root mean
/// square.
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

/// A linear map of space, by rows.
type Linear = [[f64; 3]; 3];

/// A map that enlarges by a fifth and rotates about two axes.
const TURNED: Linear = [
    [0.96, -0.576, 0.432],
    [0.72, 0.768, -0.576],
    [0.0, 0.72, 0.96],
];

const SHEARED: Linear = [[1.0, 0.0, 0.5], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn mapped(linear: &Linear, place: [f64; 3]) -> [f64; 3] {
    linear.map(|row| (0..3).map(|axis| row[axis] * place[axis]).sum())
}

/// A deformed body, and the body at rest, each cut in one stroke, with the results of the strokes.
struct CutThereAndAtRest {
    there: (CuttableBody, Stroke),
    at_rest: (CuttableBody, Stroke),
    /// Positions of the nodes at rest after moves, and the sheet through them.
    places: Vec<[f64; 3]>,
    sheet: Sheet,
}

impl CutThereAndAtRest {
    /// Cuts a mapped body by a plane, and the body at rest by the plane mapped back. Nodes whose distance from the
    /// plane at rest is within a share `snap` of their edge are moved.
    fn new(mesh: &TetMesh, linear: &Linear, there: &Sheet, snap: f64) -> Self {
        let normal = there.normal();
        let back: [f64; 3] =
            std::array::from_fn(|axis| (0..3).map(|row| linear[row][axis] * normal[row]).sum());
        let squared: f64 = back.iter().map(|x| x * x).sum();
        let foot = back.map(|x| -there.distance([0.0; 3]) * x / squared);
        let at_rest = plane(foot, back);
        // Distances from the plane grow by this from rest on.
        let stretch = squared.sqrt();
        let (mut body_there, mut body_at_rest) = (body(mesh, 0.45), body(mesh, 0.45));
        let points = mesh.points.iter();
        let mut mapped: Vec<_> = points.map(|place| mapped(linear, *place)).collect();
        let stroke_there = body_there.stroke(there, &mut mapped, snap * stretch);
        let stroke_there = stroke_there.unwrap().clone();
        let mut places = mesh.points.clone();
        let stroke_at_rest = body_at_rest.stroke(&at_rest, &mut places, snap);
        let stroke_at_rest = stroke_at_rest.unwrap().clone();
        Self {
            there: (body_there, stroke_there),
            at_rest: (body_at_rest, stroke_at_rest),
            places,
            sheet: at_rest,
        }
    }

    fn assert_same_moves(&self) {
        // Nodes equally far away come in an order that rounding decides.
        let nodes = |stroke: &Stroke| -> BTreeSet<u32> {
            stroke.moved.iter().map(|moved| moved.node).collect()
        };
        assert_eq!(nodes(&self.there.1), nodes(&self.at_rest.1));
        for node in nodes(&self.there.1) {
            let place = |body: &CuttableBody| body.points()[node as usize];
            let (there, at_rest) = (place(&self.there.0), place(&self.at_rest.0));
            assert!((0..3).all(|axis| (there[axis] - at_rest[axis]).abs() < 1e-12));
        }
    }
}

#[test]
fn a_turned_and_enlarged_body_is_cut_as_it_is_at_rest_by_the_plane_turned_back() {
    let mesh = kuhn_cube();
    for (sheet, snap) in planes().flat_map(|sheet| [(sheet, 0.0), (sheet, 0.25)]) {
        let cuts = CutThereAndAtRest::new(&mesh, &TURNED, &sheet, snap);
        let ((there, stroke), (at_rest, expected)) = (&cuts.there, &cuts.at_rest);
        assert!(stroke.faces.len() > 70);
        assert_eq!(stroke.faces, expected.faces);
        assert_eq!(stroke.copied, expected.copied);
        assert_eq!(there.tets(), at_rest.tets());
        cuts.assert_same_moves();
        assert_eq!(stroke.moved.is_empty(), snap == 0.0);
    }
}

/// Checks that a plane has separated a body into two pieces, and that every tetrahedron that it does not divide is in
/// the piece of its side.
fn assert_parted(body: &CuttableBody, sheet: &Sheet, places: &[[f64; 3]]) {
    let pieces = body.pieces();
    assert_eq!(pieces.count, 2);
    let mut of_side = [BTreeSet::new(), BTreeSet::new()];
    for (tet, piece) in body.tets().iter().zip(&pieces.of_tet) {
        let distances = tet.map(|node| sheet.distance(places[node as usize]));
        let least = distances.into_iter().fold(f64::INFINITY, f64::min);
        let most = distances.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if least > -1e-9 * EDGE || most < 1e-9 * EDGE {
            of_side[usize::from(most + least > 0.0)].insert(*piece);
        }
    }
    let [below, above] = of_side;
    assert_eq!((below.len(), above.len()), (1, 1));
    assert_ne!(below, above);
}

/// Tetrahedra that the plane divides may belong to another side than at rest, since smoothness is judged in the current
/// shape.
#[test]
fn a_sheared_body_is_parted_as_at_rest_but_for_tetrahedra_that_the_plane_divides() {
    let mesh = kuhn_cube();
    for (sheet, snap) in planes().flat_map(|sheet| [(sheet, 0.0), (sheet, 0.25)]) {
        let cuts = CutThereAndAtRest::new(&mesh, &SHEARED, &sheet, snap);
        cuts.assert_same_moves();
        assert_eq!(cuts.there.1.moved.len() > 40, snap > 0.0);
        let places = |body: &CuttableBody, stroke: &Stroke| {
            let mut places = cuts.places[..mesh.points.len()].to_vec();
            places.extend(stroke.copied.iter().map(|node| cuts.places[*node as usize]));
            assert_eq!(places.len(), body.nodes());
            places
        };
        for (body, stroke) in [&cuts.there, &cuts.at_rest] {
            topology::check(body, &mesh);
            assert_parted(body, &cuts.sheet, &places(body, stroke));
        }
    }
}

/// The side of a divided tetrahedron may be determined before its neighbours are known.
#[test]
fn a_cut_in_many_strokes_parts_what_one_stroke_parts_and_is_as_large_to_a_sixteenth() {
    let mesh = kuhn_cube();
    for lean in [-0.02, -0.01, 0.0, 0.01, 0.02, 0.03] {
        let pose = |share: f64| {
            let (x, z) = (0.043 + lean * share, 0.12 - 0.15 * share);
            [[x, -0.01, z], [x + 0.01, 0.11, z]]
        };
        let whole = Sheet::swept(pose(0.0), pose(1.0)).unwrap();
        let cut = |strokes: u32| {
            let (mut body, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
            let area = (0..strokes).map(|n| {
                let share = |n: u32| f64::from(n) / f64::from(strokes);
                let sheet = Sheet::swept(pose(share(n)), pose(share(n + 1))).unwrap();
                body.stroke(&sheet, &mut positions, 0.0).unwrap().area
            });
            let area: f64 = area.sum();
            topology::check(&body, &mesh);
            assert_parted(&body, &whole, &positions);
            area
        };
        let at_once = cut(1);
        for strokes in [5, 50, 200] {
            let area = cut(strokes);
            assert!((area / at_once - 1.0).abs() < 1.0 / 16.0, "{lean} {area}");
        }
    }
}

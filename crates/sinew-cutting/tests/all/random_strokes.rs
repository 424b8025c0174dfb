//! Random strokes and removals on random shapes of a body.
use crate::common::{body, masses, topology, volume};
use proptest::prelude::*;
use sinew_cutting::Sheet;
use sinew_mesh::structured::{self, Split};

/// One action on the body.
#[derive(Clone, Debug)]
enum Deed {
    /// A sheet between two poses, and the share of an edge within which nodes are moved onto it.
    Stroke([[[f64; 3]; 2]; 2], f64),
    /// Continued motion of the blade from its last pose to this one.
    GoOn([[f64; 3]; 2], f64),
    Lift,
    /// Removal within a ball.
    Remove([f64; 3], f64),
    /// A deformation of the body.
    Deform([[f64; 3]; 3]),
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    let free = -0.02_f64..0.12;
    // Planes of nodes, and what touches corners and edges, are as likely as anything else.
    let coordinate = prop_oneof![3 => free, 1 => (0..5_i32).prop_map(|n| 0.025 * f64::from(n))];
    [coordinate.clone(), coordinate.clone(), coordinate]
}

fn deed() -> impl Strategy<Value = Deed> {
    let snap = prop_oneof![Just(0.0), Just(0.25), 0.0..0.6_f64];
    let pose = || [point(), point()];
    prop_oneof![
        12 => ([pose(), pose()], snap.clone()).prop_map(|(poses, snap)| Deed::Stroke(poses, snap)),
        12 => (pose(), snap).prop_map(|(pose, snap)| Deed::GoOn(pose, snap)),
        1 => Just(Deed::Lift),
        1 => (point(), 0.0..0.02_f64).prop_map(|(centre, radius)| Deed::Remove(centre, radius)),
        1 => prop::array::uniform3(prop::array::uniform3(-0.4..0.4_f64)).prop_map(Deed::Deform),
    ]
}

proptest! {
    // 10,000 deeds, nine tenths of them strokes.
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_body_stays_sound_under_whatever_is_done_to_it(
        deeds in prop::collection::vec(deed(), 50),
        is_kuhn: bool,
    ) {
        let split = if is_kuhn { Split::Kuhn } else { Split::Mirrored };
        let mesh = structured::cube(4, 0.1, split).unwrap();
        let (mut body, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
        let mut pose = [[0.0; 3], [0.0, 0.1, 0.0]];
        let whole: f64 = masses(&body).iter().sum();
        let mut removed = 0.0;
        for deed in deeds {
            let (before, last) = (body.nodes(), pose);
            let mut cut = |from: [[f64; 3]; 2], to: [[f64; 3]; 2], snap: f64| {
                pose = to;
                if let Some(sheet) = Sheet::swept(from, to) {
                    let stroke = body.stroke(&sheet, &mut positions, snap).unwrap();
                    assert!(stroke.area.is_finite() && stroke.area >= 0.0);
                    let shares = stroke.moved.iter().map(|moved| moved.shares.iter().sum::<f64>());
                    shares.for_each(|sum| assert!((sum - 1.0).abs() < 1e-9));
                    assert!(stroke.copied.iter().all(|node| (*node as usize) < before));
                }
            };
            match deed {
                Deed::Stroke([from, to], snap) => cut(from, to, snap),
                Deed::GoOn(to, snap) => cut(last, to, snap),
                Deed::Lift => drop(body.lift()),
                Deed::Remove(centre, radius) => {
                    let inside = |p: [f64; 3]| (0..3).map(|i| (p[i] - centre[i]).powi(2)).sum::<f64>() < radius * radius;
                    removed += body.remove(inside, &mut positions).unwrap().mass;
                }
                Deed::Deform(gradient) => {
                    let points = body.points().iter();
                    positions = points.map(|p| {
                        std::array::from_fn(|i| p[i] + (0..3).map(|j| gradient[i][j] * p[j]).sum::<f64>())
                    }).collect();
                }
            }
            prop_assert_eq!(positions.len(), body.nodes());
        }
        topology::check(&body, &mesh);
        let left: f64 = masses(&body).iter().sum();
        prop_assert!(((left + removed) / whole - 1.0).abs() < 1e-12, "{left} {removed} {whole}");
        let sound = (0..mesh.tets.len()).filter(|tet| !body.is_removed()[*tet]);
        for tet in sound {
            prop_assert!(volume(body.points(), body.tets()[tet]) > 0.0);
        }
        let pieces = body.pieces();
        prop_assert_eq!(pieces.of_tet.iter().flatten().max().map_or(0, |last| *last as usize + 1), pieces.count);
    }
}

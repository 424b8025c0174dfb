//! The data that a body keeps from sheet to sheet about the nodes near its blade does not change results.

use crate::common::body;
use proptest::prelude::*;
use sinew_mesh::structured::{self, Split};

/// A motion of the blade and of the tissue, in steps.
#[derive(Clone, Debug)]
struct Way {
    pose: [[f64; 3]; 2],
    /// Displacement of both ends in a step (m).
    ends: [[f64; 3]; 2],
    /// Gradient of the displacement of the tissue in a step, and the amplitude of its oscillation (m).
    gradient: [[f64; 3]; 3],
    sway: f64,
    steps: usize,
    snap: f64,
    /// Number of steps after which the blade is lifted, and applied again at the same position.
    lift: usize,
}

fn way() -> impl Strategy<Value = Way> {
    let place = || prop::array::uniform3(-0.03..0.13_f64);
    let slow = || prop::array::uniform3(-0.002..0.002_f64);
    let gradient = prop_oneof![Just(0.0), 0.0..0.002_f64, 0.0..0.2_f64];
    let direction = prop::array::uniform3(prop::array::uniform3(-1.0..1.0_f64));
    (
        [place(), place()],
        [slow(), slow()],
        (gradient, direction),
        prop_oneof![Just(0.0), 0.0..0.002_f64, 0.0..0.05_f64],
        5..60_usize,
        prop_oneof![Just(0.0), Just(0.25)],
        3..60_usize,
    )
        .prop_map(
            |(pose, ends, (size, direction), sway, steps, snap, lift)| Way {
                pose,
                ends,
                gradient: direction.map(|row| row.map(|entry| size * entry)),
                sway,
                steps,
                snap,
                lift,
            },
        )
}

/// Position of a point of the body after this number of steps of a motion.
fn place(way: &Way, place: [f64; 3], step: usize) -> [f64; 3] {
    let phase = 40.0 * place[0] + 30.0 * place[2] + 1.3 * step as f64;
    std::array::from_fn(|axis| {
        let along = (0..3).map(|other| way.gradient[axis][other] * (place[other] - 0.05));
        let share = if step % 40 < 20 {
            step % 20
        } else {
            20 - step % 20
        };
        place[axis] + share as f64 * along.sum::<f64>() + way.sway * (phase + axis as f64).sin()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_body_that_forgets_them_before_each_sheet_is_cut_in_the_same_way(ways in prop::collection::vec(way(), 1..3), is_kuhn: bool) {
        let split = if is_kuhn { Split::Kuhn } else { Split::Mirrored };
        let mesh = structured::cube(5, 0.1, split).unwrap();
        let (mut keeps, mut forgets) = (body(&mesh, 0.45), body(&mesh, 0.45));
        for way in &ways {
            let mut pose = way.pose;
            for step in 0..way.steps {
                let before = pose;
                for (end, by) in pose.iter_mut().zip(way.ends) {
                    *end = std::array::from_fn(|axis| end[axis] + by[axis]);
                }
                let mut positions: Vec<_> = keeps.points().iter().map(|point| place(way, *point, step)).collect();
                let mut others = positions.clone();
                forgets.restore(&forgets.save()).unwrap();
                if step % way.lift == way.lift - 1 {
                    prop_assert_eq!(keeps.lift(), forgets.lift());
                }
                let stroke = keeps.follow([before, pose], &mut positions, way.snap).unwrap();
                let other = forgets.follow([before, pose], &mut others, way.snap).unwrap();
                prop_assert_eq!(&stroke.faces, &other.faces);
                prop_assert_eq!(&stroke.copied, &other.copied);
                prop_assert_eq!(&stroke.moved, &other.moved);
                prop_assert_eq!(positions, others);
                prop_assert!(keeps.save() == forgets.save());
            }
        }
    }
}

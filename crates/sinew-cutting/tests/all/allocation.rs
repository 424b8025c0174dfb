//! Strokes allocate nothing until the spare nodes are used up.

use std::hint::black_box;

use crate::common::{body, kuhn_cube};
use sinew_core::CountingAllocator;
use sinew_cutting::Sheet;

#[test]
fn strokes_allocate_nothing_until_a_tenth_more_nodes_are_used_up() {
    let mesh = kuhn_cube();
    let mut body = body(&mesh, 0.45);
    let mut positions = mesh.points.clone();
    positions.reserve(mesh.points.len() / 10);
    let blade = |n: u32| {
        let depth = 0.11 - 0.003 * f64::from(n);
        [[0.0507, -0.01, depth], [0.0512, 0.11, depth]]
    };
    let asked = CountingAllocator::count(|| {
        for n in 0..26 {
            let sheet = Sheet::swept(blade(n), blade(n + 1)).unwrap();
            body.stroke(&sheet, &mut positions, 0.25).unwrap();
        }
    });
    let copies = body.nodes() - mesh.points.len();
    assert!((55..=133).contains(&copies), "{copies}");
    assert_eq!(asked, 0);
    // In one stroke, too, which touches all tetrahedra about the plane at once.
    let mut whole = crate::common::body(&mesh, 0.45);
    let mut positions = mesh.points.clone();
    positions.reserve(mesh.points.len() / 10 + 16);
    let blade = |depth: f64| [[0.0507, -0.01, depth], [0.0507, 0.11, depth]];
    let sheet = Sheet::swept(blade(0.11), blade(-0.01)).unwrap();
    let asked = CountingAllocator::count(|| {
        whole.stroke(&sheet, &mut positions, 0.25).unwrap();
    });
    let copies = whole.nodes() - mesh.points.len();
    assert!((100..=149).contains(&copies), "{copies}");
    assert_eq!(asked, 0);
    let counted = CountingAllocator::count(|| drop(black_box(vec![0_u8; positions.len()])));
    assert_eq!(counted, 1, "the count counts");
}

//! Models that are updated in place after strokes allocate nothing until the space for new nodes is used up.

use std::sync::Arc;

use crate::common::{body, held, linear, load};
use sinew_core::{CountingAllocator, Inputs, State, System};
use sinew_cutting::Sheet;
use sinew_fem::{CutModel, LoadKind, Problem};
use sinew_mesh::structured::{self, Split};

fn cuttable() -> (CutModel, State) {
    let mesh = Arc::new(structured::cube(10, 0.1, Split::Kuhn).unwrap());
    let problem = Problem {
        fixed: vec![held("bottom")],
        loads: vec![
            load("top", LoadKind::Pressure(100.0)),
            load("sides", LoadKind::Traction([0.0, 1.0, 0.0])),
        ],
        gravity: Some([0.0, 0.0, -9.81]),
        ..body(linear(3500.0, 0.45))
    };
    let cut = CutModel::new(mesh, problem, 0.25).unwrap();
    let mut state = State::at_rest(cut.model().dofs());
    for values in [&mut state.u, &mut state.v] {
        values.reserve(values.len() / 8);
    }
    (cut, state)
}

#[test]
fn strokes_allocate_nothing_until_a_tenth_more_nodes_are_used_up_and_one_layout_makes_room_again() {
    let (mut cut, mut state) = cuttable();
    let blade = |x: f64, n: u32| {
        let depth = 0.11 - 0.003 * f64::from(n);
        [[x + 0.0007, -0.01, depth], [x + 0.0012, 0.11, depth]]
    };
    let mut slit = |x: f64| {
        let (mut copies, layouts) = (0, cut.layouts());
        let asked = CountingAllocator::count(|| {
            for n in 0..26 {
                let sheet = Sheet::swept(blade(x, n), blade(x, n + 1)).unwrap();
                let report = cut.stroke(&sheet, &mut state, Inputs::none()).unwrap();
                copies += report.new_nodes;
            }
            cut.lift();
        });
        (copies, cut.layouts() - layouts, asked)
    };
    let (copies, layouts, asked) = slit(0.05);
    assert!((55..=100).contains(&copies), "{copies}");
    assert_eq!((layouts, asked), (0, 0));
    let (further, layouts, asked) = slit(0.03);
    println!("{further} further nodes, {asked} allocations");
    assert!(copies + further <= 149, "{further}");
    assert_eq!((layouts, asked), (0, 0));
    let (_, layouts, asked) = slit(0.07);
    assert!(layouts == 1 && asked > 0, "{layouts} {asked}");
}

//! After set-up, a step with modes from Lanczos bases allocates nothing, even if it has to compute the share of a state
//! outside them.

use crate::common::cube::cube;
use crate::common::{advance, build, largest, plain};
use sinew_core::CountingAllocator;
use sinew_core::{State, System};

#[test]
fn a_step_allocates_nothing() {
    let model = cube(6);
    assert!(model.dofs() > 400, "enough for a Lanczos basis");
    let mut modal = build("modal", &plain().with_number("tolerance", 0.05));
    let set_up = CountingAllocator::count(|| {
        modal.prepare(&model, 0.01).unwrap();
    });
    assert!(set_up > 0, "set-up does");
    let mut state = State::at_rest(model.dofs());
    advance(&mut *modal, &model, &mut state, 20, 0.01);
    state.u[7] += 0.01 * largest(&state.u);

    let mut solves = 0;
    let steps = CountingAllocator::count(|| {
        solves = modal.step(&model, &mut state, 0.01).unwrap().solves;
        advance(&mut *modal, &model, &mut state, 20, 0.01);
    });
    assert_eq!(steps, 0);
    assert_eq!(solves, 1, "how much is lost");
}

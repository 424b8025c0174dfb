//! Motion over cuts: every method continues, and the energy is kept.

use std::sync::Arc;

use crate::common::{advance, build};
use sinew_core::{Inputs, Options, State, System};
use sinew_cutting::Sheet;
use sinew_fem::{CutModel, Fixed, Law, Model, Problem, Region};
use sinew_mesh::structured::{self, Split};

fn problem() -> Problem {
    Problem::of([Region::new(Law::linear(3500.0, 0.45), 1060.0)]).with_fixed(Fixed::at("bottom"))
}

fn cube(cells: usize) -> CutModel {
    let mesh = structured::cube(cells, 0.1, Split::Kuhn).unwrap();
    CutModel::new(Arc::new(mesh), problem(), 0.0).unwrap()
}

/// Cuts with a blade along y that comes down in the middle to a height.
fn slit(cut: &mut CutModel, state: &mut State, height: f64) -> usize {
    let blade = |z: f64| [[0.05, -0.05, z], [0.05, 0.15, z]];
    let sheet = Sheet::swept(blade(0.2), blade(height)).unwrap();
    cut.stroke(&sheet, state, Inputs::none()).unwrap().new_nodes
}

/// A bend of the whole body, at rest.
fn bent(model: &Model) -> State {
    let bend = |p: &[f64; 3]| [2.0 * p[2] * p[2], 0.0, -0.5 * p[0] * p[2]];
    let field: Vec<[f64; 3]> = model.mesh().points.iter().map(bend).collect();
    let mut state = State::at_rest(model.dofs());
    model.to_dofs(&field, &mut state.u).unwrap();
    state
}

#[test]
fn an_integrator_goes_on_after_a_cut_as_a_fresh_one_to_the_last_bit() {
    // Modal motion would need all modes of this bend.
    for id in sinew_integrators::ids()
        .into_iter()
        .filter(|id| *id != "modal")
    {
        let mut cut = cube(4);
        let mut state = bent(cut.model());
        let dt = 2e-4;
        let mut kept = build(id, &Options::new());
        advance(&mut *kept, cut.model(), &mut state, 5, dt);
        assert!(slit(&mut cut, &mut state, 0.04) > 0, "`{id}`");
        assert_eq!(state.u.len(), cut.model().dofs());
        let mut fresh_state = state.clone();
        let mut fresh = build(id, &Options::new());
        advance(&mut *kept, cut.model(), &mut state, 5, dt);
        advance(&mut *fresh, cut.model(), &mut fresh_state, 5, dt);
        assert_eq!(state, fresh_state, "`{id}`");
        assert!(state.u.iter().all(|u| u.abs() < 1.0), "`{id}`");
    }
}

#[cfg(feature = "implicit")]
#[test]
fn the_mean_acceleration_method_keeps_its_energy_over_a_cut() {
    let mut cut = cube(4);
    let mut state = bent(cut.model());
    let mut method = build("newmark", &Options::new());
    let energy =
        |cut: &CutModel, state: &State| cut.model().energy(&state.u, &state.v).unwrap().total();
    let first = energy(&cut, &state);
    advance(&mut *method, cut.model(), &mut state, 20, 0.005);
    slit(&mut cut, &mut state, 0.04);
    advance(&mut *method, cut.model(), &mut state, 200, 0.005);
    let last = energy(&cut, &state);
    assert!((last / first - 1.0).abs() < 1e-10, "{first} {last}");
}

//! Queries of a body that follows inputs, without these inputs.

use crate::common::{body, build, held, linear};
use sinew_core::{Between, Inputs, LoadTime, Ramp, System};
use sinew_fem::{Course, FieldError, LoadKind, LoadSpec, Model, Moving};
use sinew_mesh::structured::{self, Split};

/// All results of a model for a state at a time: those that depend on the positions of supports, and the forces of
/// supports.
fn answers(model: &Model, when: LoadTime<'_>) -> [Vec<Result<(), FieldError>>; 2] {
    let (u, v) = (vec![0.0; model.dofs()], vec![0.0; model.dofs()]);
    let mut nodal = vec![[0.0; 3]; model.mesh().points.len()];
    let mut tensors = vec![[0.0; 6]; model.mesh().tets.len()];
    let places = vec![
        model.displacements_at(when, &u, &mut nodal),
        model.velocities_at(when, &v, &mut nodal),
        model.positions(when, &u, &mut nodal),
        model.node_displacement(when, &u, 0).map(|_| ()),
        model.strain(when, &u, &mut tensors),
        model.stress(when, &u, &mut tensors),
        model.tet_stress(when, &u, 0).map(|_| ()),
    ];
    let zero = nodal.clone();
    let forces = vec![
        model.reactions(when, &u, &v, &mut nodal),
        model.reaction(when, &u, &v, &"bottom".into()).map(|_| ()),
        model.reaction_of_nodes(when, &u, &v, &[0]).map(|_| ()),
        model.reaction_of_nodes(when, &u, &v, &[0, 1]).map(|_| ()),
        model.moving_reactions(when, [&zero; 3], &mut nodal),
    ];
    [places, forces]
}

#[test]
fn a_time_without_the_inputs_that_a_body_follows_is_refused() {
    let mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    let mut inputs = Inputs::new();
    let clamp = inputs.add_channel(Between::Line);
    let cuff = inputs.add_channel(Between::Hold);
    let mut problem = body(linear(3500.0, 0.3));
    problem.fixed = vec![held("bottom")];
    let press = |on: &str| {
        LoadSpec::new(on, LoadKind::Traction([0.0, 0.0, -10.0])).with_ramp(Ramp::Input(cuff))
    };
    let course = Course::new([0.0, 0.0, 0.01], Ramp::Input(clamp));

    // What moves by a channel on free nodes alone stands in the state.
    problem.loads = vec![press("top")];
    let pressed = build(&mesh, &problem);
    for answer in answers(&pressed, 0.1.into()).concat() {
        assert_eq!(answer, Ok(()));
    }
    // A load that falls on the support is part of its force.
    problem.loads = vec![press("sides")];
    let [places, forces] = answers(&build(&mesh, &problem), 0.1.into());
    assert!(places.iter().all(Result::is_ok), "{places:?}");
    let lacking = |channel: u32| -> Result<(), _> { Err(FieldError::NoInput { channel }) };
    assert!(
        forces.iter().all(|answer| *answer == lacking(1)),
        "{forces:?}"
    );
    // A support that moves is where its channel is.
    problem.loads = Vec::new();
    problem.moves = vec![Moving::new("top", [course.clone()])];
    let moved = build(&mesh, &problem);
    let [places, forces] = answers(&moved, 0.1.into());
    assert!(
        places.iter().all(|answer| *answer == lacking(0)),
        "{places:?}"
    );
    // The force of supports that move in a given way does not depend on it.
    assert!(
        forces[..4].iter().all(|answer| *answer == lacking(0)),
        "{forces:?}"
    );
    assert_eq!(forces[4], Ok(()));
    let rest = vec![0.0; moved.dofs()];
    assert_eq!(moved.inverted_elements(0.1.into(), &rest), None);
    assert_eq!(course.displacement_at(0.1, 2), None);

    inputs.set(clamp, 0.2, 1.0).unwrap();
    let when = LoadTime::at(0.1).under(&inputs);
    for answer in answers(&moved, when).concat() {
        assert_eq!(answer, Ok(()));
    }
    let (top, _) = mesh.nearest_node([0.0, 0.0, 0.1]);
    let at_top = moved.node_displacement(when, &rest, top).unwrap();
    assert_eq!(at_top, [0.0, 0.0, 0.005]);
    assert_eq!(course.displacement_at(when, 2), Some(0.005));
    assert_eq!(moved.inverted_elements(when, &rest), Some(0));
    assert_eq!(
        lacking(0).unwrap_err().to_string(),
        "the body follows input 0, which is not given: ask with `LoadTime::at(t).under(&inputs)`, with the \
         inputs of the step, not with a bare time"
    );
}

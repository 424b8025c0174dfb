//! The state of a body at t = 0.

use sinew_core::{LinearSystem, State, System};
use sinew_fem::Model;

use super::model::BodyModel;
use crate::error::{Fault, SceneError};
use crate::scene::keys::GRAVITY;
use crate::scene::{Body, Initial, Places};

pub(super) fn state(body: &Body, places: &Places, built: &BodyModel) -> Result<State, SceneError> {
    let mut state = State::at_rest(built.model.dofs());
    for (index, initial) in body.initial.iter().enumerate() {
        let place = places.of(&places.initial, index);
        apply(initial, body, built, &mut state).map_err(|fault| {
            let key = match fault {
                Fault::UnknownGroup(_) => place.part_key(),
                _ => "static",
            };
            place.value_fault(key, fault)
        })?;
    }
    Ok(state)
}

fn apply(
    initial: &Initial,
    body: &Body,
    built: &BodyModel,
    state: &mut State,
) -> Result<(), Fault> {
    match initial {
        Initial::Displacement { group, value } => {
            set(&mut state.u, group.as_deref(), built, |_| *value)
        }
        Initial::Velocity { group, value } => {
            set(&mut state.v, group.as_deref(), built, |_| *value)
        }
        Initial::Stretch {
            group,
            strain,
            origin,
        } => set(&mut state.u, group.as_deref(), built, |point| {
            std::array::from_fn(|i| strain[i] * (point[i] - origin[i]))
        }),
        Initial::Static { loads } => {
            state.u = at_rest(&full_loads(loads, body, &built.model), &built.model)?;
            Ok(())
        }
    }
}

/// The displacement (m) of the body at rest under a force (N).
#[cfg(feature = "implicit")]
fn at_rest(force: &[f64], model: &Model) -> Result<Vec<f64>, Fault> {
    Ok(sinew_integrators::static_solution(model, force)?)
}

#[cfg(not(feature = "implicit"))]
fn at_rest(_force: &[f64], _model: &Model) -> Result<Vec<f64>, Fault> {
    Err(Fault::StaticNotBuilt)
}

/// Sets a field at the free components of a group's nodes.
fn set(
    field: &mut [f64],
    group: Option<&str>,
    built: &BodyModel,
    value_at: impl Fn([f64; 3]) -> [f64; 3],
) -> Result<(), Fault> {
    let (nodes, pinned) = (built.model.nodes(), built.model.pinned());
    for cell in built.cells_of(group)?.0 {
        let point = built.mesh.points[nodes[cell as usize] as usize];
        for (axis, value) in value_at(point).into_iter().enumerate() {
            let dof = 3 * cell as usize + axis;
            if !pinned[dof] {
                field[dof] = value;
            }
        }
    }
    Ok(())
}

/// The force (N) of the named loads at their full value.
fn full_loads(names: &[String], body: &Body, model: &Model) -> Vec<f64> {
    let gravity = Some(GRAVITY.to_owned());
    // The model's loads are those of the problem, then gravity.
    let load_names = body.load_names.iter().chain(std::iter::once(&gravity));
    let mut force = vec![0.0; model.dofs()];
    for (load, name) in model.operators().loads().iter().zip(load_names) {
        if name.as_ref().is_some_and(|name| names.contains(name)) {
            for &(dof, value) in &load.entries {
                force[dof as usize] += value;
            }
        }
    }
    force
}

//! The state of a body at t = 0.

use sinew_core::{Inputs, State, System};
use sinew_fem::Model;

use super::model::BodyModel;
use crate::error::{Fault, SceneError};
use crate::formula::Formula;
use crate::keys::GRAVITY;
use crate::scene::{Body, Initial, Places};

pub(super) fn state(body: &Body, places: &Places, built: &BodyModel) -> Result<State, SceneError> {
    let mut state = State::at_rest(built.model.dofs());
    state.internal = vec![0.0; built.model.internal_variables()];
    for (index, initial) in body.initial.iter().enumerate() {
        let place = places.of(&places.initial, index);
        apply(initial, body, built, &mut state).map_err(|fault| {
            let key = match fault {
                Fault::Group(_) => place.part_key(),
                _ => initial.key(),
            };
            place.value_fault(key, fault)
        })?;
    }
    // A displacement that is given comes about at t = 0.
    let accepted = built.model.accept(&mut state, Inputs::none(), 0.0);
    accepted.map_err(|error| {
        let last = body.initial.len().saturating_sub(1);
        places
            .of(&places.initial, last)
            .fault(Fault::InitialState(error))
    })?;
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
            set(&mut state.u, group.as_deref(), built, |place| {
                at(value, place)
            })
        }
        Initial::Velocity { group, value } => set(&mut state.v, group.as_deref(), built, |place| {
            at(value, place)
        }),
        Initial::Stretch {
            group,
            strain,
            origin,
        } => set(&mut state.u, group.as_deref(), built, |point| {
            std::array::from_fn(|i| strain[i] * (point[i] - origin[i]))
        }),
        Initial::Static { loads } => {
            state.u = at_rest(&places_of(loads, body), &built.model)?;
            state.internal.fill(0.0);
            let accepted = built.model.accept(state, Inputs::none(), f64::INFINITY);
            accepted.map_err(Fault::InitialState)
        }
    }
}

fn at(value: &[Formula; 3], place: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| value[axis].at(place))
}

/// The displacement (m) of the body at rest under the loads with these indices.
#[cfg(feature = "implicit")]
fn at_rest(loads: &[usize], model: &Model) -> Result<Vec<f64>, Fault> {
    let load = model.full_loads(loads);
    Ok(sinew_integrators::static_solution_under(model, &load)?)
}

#[cfg(not(feature = "implicit"))]
fn at_rest(_loads: &[usize], _model: &Model) -> Result<Vec<f64>, Fault> {
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
            if !value.is_finite() {
                return Err(Fault::NotFinite {
                    value,
                    place: point,
                });
            }
            if !pinned[dof] {
                field[dof] = value;
            }
        }
    }
    Ok(())
}

/// Indices of the named loads among those of the model.
fn places_of(names: &[String], body: &Body) -> Vec<usize> {
    let gravity = Some(GRAVITY.to_owned());
    // The model's loads are those of the problem, then gravity.
    let load_names = body.load_names.iter().chain(std::iter::once(&gravity));
    let is_named = |name: &&Option<String>| name.as_ref().is_some_and(|name| names.contains(name));
    let named = load_names.enumerate().filter(|(_, name)| is_named(name));
    named.map(|(place, _)| place).collect()
}

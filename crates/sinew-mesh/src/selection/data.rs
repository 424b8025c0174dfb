//! Conditions on the data of a mesh, and the nodes and tetrahedra that meet them.

use std::collections::BTreeSet;

use super::data_values::DataValues;
use super::error::SelectionError;
use crate::TetMesh;

/// Preference for data at nodes or of tetrahedra, if both have the name.
#[derive(Clone, Copy)]
pub(super) enum First {
    Nodes,
    Tets,
}

/// Nodes or tetrahedra that meet a condition.
pub(super) enum Met {
    /// One flag per node: true if it meets the condition.
    Nodes(Vec<bool>),
    /// One flag per tetrahedron: true if it meets the condition.
    Tets(Vec<bool>),
}

/// The nodes or tetrahedra at which data have one of some values.
///
/// # Errors
///
/// If there are no such data, several or some with more than one number for each holder, or no holder has such a value.
pub(super) fn met(
    mesh: &TetMesh,
    (name, values): (&str, &DataValues),
    first: First,
) -> Result<Met, SelectionError> {
    let at_nodes = mesh.node_data.iter();
    let at_nodes = at_nodes.map(|data| (&data.name, data.step, data.components, &data.values));
    let in_tets = mesh.data.iter();
    let in_tets = in_tets.map(|data| (&data.name, data.step, data.components, &data.values));
    let at_nodes: Vec<_> = at_nodes.filter(|(given, ..)| *given == name).collect();
    let in_tets: Vec<_> = in_tets.filter(|(given, ..)| *given == name).collect();
    let of_nodes = match first {
        First::Nodes => !at_nodes.is_empty(),
        First::Tets => in_tets.is_empty(),
    };
    let (found, holder) = match of_nodes {
        true => (at_nodes, "node"),
        false => (in_tets, "tetrahedron"),
    };
    let numbers = match found[..] {
        [(_, _, 1, numbers)] => numbers,
        [(_, _, components, _)] => {
            let name = name.to_owned();
            return Err(SelectionError::NotOneNumber { name, components });
        }
        [] => return Err(unknown(mesh, name)),
        _ => {
            return Err(SelectionError::SeveralData {
                name: name.to_owned(),
                steps: found.iter().map(|(_, step, ..)| *step).collect(),
            });
        }
    };
    let met: Vec<bool> = numbers.iter().map(|number| values.has(*number)).collect();
    if !met.contains(&true) {
        return Err(SelectionError::NoValue {
            holder,
            name: name.to_owned(),
            values: values.clone(),
            known: in_words(numbers),
        });
    }
    Ok(match of_nodes {
        true => Met::Nodes(met),
        false => Met::Tets(met),
    })
}

fn unknown(mesh: &TetMesh, name: &str) -> SelectionError {
    let at_nodes = mesh.node_data.iter().map(|data| data.name.clone());
    let in_tets = mesh.data.iter().map(|data| data.name.clone());
    let known: BTreeSet<String> = at_nodes.chain(in_tets).collect();
    SelectionError::UnknownData {
        name: name.to_owned(),
        known: known.into_iter().collect(),
    }
}

/// The existing values: all if there are few, otherwise the least and the largest.
fn in_words(numbers: &[f64]) -> String {
    const SHOWN: usize = 12;
    let mut different: Vec<f64> = Vec::new();
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    for &number in numbers.iter().filter(|number| !number.is_nan()) {
        (least, greatest) = (least.min(number), greatest.max(number));
        if different.len() <= SHOWN && !different.contains(&number) {
            different.push(number);
        }
    }
    if different.len() > SHOWN {
        return format!("they reach from {least} to {greatest}");
    }
    different.sort_by(f64::total_cmp);
    let listed: Vec<String> = different.iter().map(f64::to_string).collect();
    format!("there are {}", listed.join(", "))
}

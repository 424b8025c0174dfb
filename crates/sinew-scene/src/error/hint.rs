//! Hints for the correction of a fault.

use std::path::Path;

use sinew_core::OptionError;
use sinew_mesh::{CellType, TetMeshError};

use super::fault::Fault;
use super::no_step::NoStableStep;
use super::tool_fault::ToolFault;
use super::words::quoted;
use crate::keys::AT_THE_TOP;
use crate::nearest::nearest;

/// The hint that follows from a fault, if there is one.
pub(super) fn following_from(fault: &Fault) -> Option<String> {
    match fault {
        Fault::UnknownKey { key, known, .. } if stands_on_top(key, known) => Some(format!(
            "write `{key}` at the top of the file, before the first [table]"
        )),
        Fault::UnknownKey { known, .. } => Some(format!("the keys here are {}", quoted(known))),
        Fault::Integrator(OptionError::UnknownIntegrator { id, known }) => {
            suggestion(nearest(id, known.iter().copied()))
        }
        Fault::Integrator(OptionError::Unknown { key, known, .. }) => {
            takers(key).or_else(|| suggestion(nearest(key, known.iter().copied())))
        }
        Fault::Value {
            found, expected, ..
        } if found.starts_with('"') => {
            let word = found.trim_matches('"');
            let others = words_in(expected).filter(|other| *other != word);
            suggestion(nearest(word, others))
        }
        Fault::MeshFile(error) => error.advice(),
        Fault::Tetrahedra(TetMeshError::UnsupportedCells { kind, .. })
            if kind.linear() != *kind && is_supported(kind.linear()) =>
        {
            Some(
                "`order = \"linear\"` in [mesh] takes cells of higher order by their corners"
                    .to_owned(),
            )
        }
        Fault::Tetrahedra(error) => error.advice(Path::new("FILE")),
        Fault::Tool(ToolFault::Inside { .. }) => Some(
            "move it away, or say starts_inside = \"push\": the first step pushes the tissue out"
                .to_owned(),
        ),
        Fault::Tool(ToolFault::Within { .. }) => Some("move it out of the body".to_owned()),
        Fault::NoStableStep(NoStableStep::Refused(_)) => Some(
            "give the motion or the load a ramp that begins at 0, such as kind = \"sin2\""
                .to_owned(),
        ),
        Fault::NoStableStep(NoStableStep::NotFinite) => None,
        Fault::NoStableStep(_) => Some(
            "give dt in s; `sinew plan --tolerance` finds one that is accurate enough".to_owned(),
        ),
        Fault::UnknownLoad { name, known } => {
            suggestion(nearest(name, known.iter().map(String::as_str)))
        }
        _ => None,
    }
}

/// The words in quotation marks of a list of expected values.
fn words_in(expected: &str) -> impl Iterator<Item = &str> {
    expected.split('"').skip(1).step_by(2)
}

/// True if cells of a linear kind are supported.
fn is_supported(linear: CellType) -> bool {
    matches!(
        linear,
        CellType::Line | CellType::Triangle | CellType::Tetra
    )
}

/// True if a key belongs at the top of the file and was found in a table.
fn stands_on_top(key: &str, known: &[&str]) -> bool {
    AT_THE_TOP.contains(&key) && !known.contains(&key)
}

/// A sentence that names the integrators with an option.
fn takers(key: &str) -> Option<String> {
    let entries = sinew_integrators::entries();
    let takes = |entry: &&sinew_integrators::Entry| entry.options.iter().any(|o| o.key == key);
    let takers: Vec<&str> = entries.iter().filter(takes).map(|entry| entry.id).collect();
    (!takers.is_empty()).then(|| format!("`{key}` is an option of {}", quoted(&takers)))
}

fn suggestion(nearest: Option<&str>) -> Option<String> {
    nearest.map(|name| format!("did you mean `{name}`?"))
}

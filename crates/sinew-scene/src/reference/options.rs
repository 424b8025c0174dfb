//! The options of integrators, each once.

use sinew_integrators::{OptionHelp, OptionKind};

use crate::decode::Shape;

/// An option and the integrators that take it.
#[derive(Debug, Clone)]
pub(super) struct SharedOption {
    pub(super) option: OptionHelp,
    pub(super) integrators: Vec<&'static str>,
}

/// All options; those shared by several integrators once, after the others.
pub(super) fn shared() -> Vec<SharedOption> {
    let mut shared: Vec<SharedOption> = Vec::new();
    for entry in sinew_integrators::entries() {
        for option in entry.all_options() {
            match shared.iter_mut().find(|known| known.option == option) {
                Some(known) => known.integrators.push(entry.id),
                None => shared.push(SharedOption {
                    option,
                    integrators: vec![entry.id],
                }),
            }
        }
    }
    shared.sort_by_key(|known| known.integrators.len() > 1);
    shared
}

/// The values that an option takes; its tables have no description and are in `Err`, with the values of each key.
pub(super) fn shape(kind: &OptionKind) -> Result<Shape, Vec<(&'static str, OptionKind)>> {
    Ok(match *kind {
        OptionKind::Number(low, high) => Shape::Number(low, high),
        OptionKind::Count(most) => Shape::Whole(1, most_that_matters(most)),
        OptionKind::Words(words) => Shape::Words(words.to_vec()),
        OptionKind::Either(kinds) => {
            Shape::Either(kinds.iter().map(shape).collect::<Result<_, _>>()?)
        }
        OptionKind::Table(keys) => return Err(keys.to_vec()),
    })
}

/// The largest number, unless it is only the limit of the computer's representation.
fn most_that_matters(most: u32) -> Option<u64> {
    (most != u32::MAX).then_some(u64::from(most))
}

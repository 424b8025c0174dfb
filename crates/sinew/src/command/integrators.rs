//! `sinew integrators`.

use sinew_core::{Accuracy, Options, Properties};

use super::{Failure, say};

pub(crate) fn run() -> Result<(), Failure> {
    for entry in sinew_integrators::entries() {
        say(&format!("{:20} {}", entry.id, entry.summary));
        if let Ok(integrator) = entry.build(&Options::new()) {
            let other = other_damping(integrator.properties());
            say(&format!("{:20}   {other}", ""));
        }
        for option in entry.options.iter().copied().chain(entry.guard.help()) {
            say(&format!("{:20}   {}: {}", "", option.key, option.help));
        }
        if entry.substeps {
            say(&format!(
                "{:20}   substeps: parts each step is cut into, or \"auto\"; default 1",
                ""
            ));
        }
    }
    Ok(())
}

/// Its order with damping that is not proportional to the mass, as a phrase.
fn other_damping(properties: Properties) -> String {
    let words = |accuracy| match accuracy {
        Some(Accuracy::Exact) => "exact".to_owned(),
        Some(accuracy) => accuracy
            .order(true)
            .map_or_else(String::new, |order| format!("order {order}")),
        None => "refused".to_owned(),
    };
    let of = properties.other_damping;
    let (stiffness, dashpots) = (words(of.stiffness), words(of.dashpots));
    if stiffness == dashpots {
        format!("with stiffness damping or dashpots: {stiffness}")
    } else {
        format!("with stiffness damping: {stiffness}; with dashpots: {dashpots}")
    }
}

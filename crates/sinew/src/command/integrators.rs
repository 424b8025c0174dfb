//! `sinew integrators`.

use sinew_core::Options;
use sinew_scene::output::say;

use super::Failure;

pub(crate) fn run() -> Result<(), Failure> {
    for entry in sinew_integrators::entries() {
        say(&format!("{:20} {}", entry.id, entry.summary))?;
        if let Ok(integrator) = entry.build(&Options::new()) {
            let properties = integrator.properties();
            for words in [
                properties.other_damping.describe(),
                properties.changing_loads.describe(),
            ] {
                say(&format!("{:20}   {words}", ""))?;
            }
        }
        for option in entry.options.iter().copied().chain(entry.guard.help()) {
            say(&format!("{:20}   {}: {}", "", option.key, option.help))?;
        }
        if entry.programs {
            for option in sinew_integrators::MACHINE_OPTIONS {
                say(&format!("{:20}   {}: {}", "", option.key, option.help))?;
            }
        }
        if entry.substeps {
            say(&format!(
                "{:20}   substeps: parts each step is cut into, or \"auto\"; default 1",
                ""
            ))?;
        }
    }
    Ok(())
}

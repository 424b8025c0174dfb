//! `sinew integrators`.

use sinew_core::Options;
use sinew_scene::output::say;

use super::Failure;

/// Which one to take, before what each is.
const WHICH: &str = "\
Which one do I take?
  most scenes, an error near 1 %      central-difference with dt = \"auto\": the cheapest of its kind
  stiff tissue, long steps            newmark: stable at any step, one solution with a factor a step
  an error of any number of digits    propagator with kind = \"two-step\": exact in time for linear tissue
  a network, bounded at any step      cnn-stabilised; cnn is the published one, for comparison
  large deformation, any step         cnn-energy: its energy never rises, whatever the tissue
  not sure                            sinew plan SCENE --tolerance 1e-2 measures it on the scene itself
";

pub(crate) fn run() -> Result<(), Failure> {
    say(WHICH)?;
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
        for option in entry.all_options() {
            say(&format!(
                "{:20}   {}: {}; takes {}; default {}",
                "", option.key, option.help, option.expected, option.default
            ))?;
        }
    }
    Ok(())
}

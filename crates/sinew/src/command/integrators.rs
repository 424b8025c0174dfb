//! `sinew integrators`.

use clap::builder::PossibleValuesParser;
use sinew_core::Options;
use sinew_integrators::{Entry, OptionHelp};
use sinew_scene::output::{hanging, say};

use super::Failure;

/// The integrator to describe.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The integrator to describe, with its options; all of them in a line each if none is named
    #[arg(value_parser = PossibleValuesParser::new(sinew_integrators::ids()))]
    name: Option<String>,
}

/// A guide to the choice of an integrator, printed before their descriptions.
const WHICH: &str = "\
Which one do I take?
  most scenes, an error near 1 %      central-difference with dt = \"auto\": the cheapest of its kind
  stiff tissue, long steps            newmark: stable at any step, one solution with a factor a step
  an error of any number of digits    propagator with kind = \"two-step\": exact in time for linear tissue
  a network, bounded at any step      cnn-stabilised; cnn is the published one, for comparison
  large deformation, any step         cnn-energy: its energy never rises, whatever the tissue
  not sure                            sinew plan SCENE --tolerance 1e-2 measures it on the scene itself
";

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let entries = sinew_integrators::entries();
    let named = arguments.name.as_ref();
    if let Some(entry) = entries
        .iter()
        .find(|entry| Some(entry.id) == named.map(String::as_str))
    {
        return describe(entry);
    }
    say(WHICH)?;
    for entry in &entries {
        say(&hanging(&format!("{:20} ", entry.id), entry.summary, 0))?;
    }
    Ok(say(
        "\n`sinew integrators NAME` describes one, with its options",
    )?)
}

/// Prints all about an integrator: its formula, its damping and loads, and its options, its own first.
fn describe(entry: &Entry) -> Result<(), Failure> {
    say(&format!("{}: {}", entry.id, entry.summary))?;
    if let Ok(integrator) = entry.build(&Options::new()) {
        let properties = integrator.properties();
        for words in [
            properties.other_damping.describe(),
            properties.changing_loads.describe(),
        ] {
            say(&hanging("  ", &words, 0))?;
        }
    }
    say("options, keys of [run]:")?;
    for (number, option) in entry.all_options().into_iter().enumerate() {
        if number == entry.options.len() {
            say("the same for many methods, and rarely needed:")?;
        }
        let OptionHelp {
            key,
            help,
            expected,
            default,
            ..
        } = option;
        let words = format!("{help}; takes {expected}; default {default}");
        say(&hanging(&format!("  {key:18} "), &words, 0))?;
    }
    Ok(())
}

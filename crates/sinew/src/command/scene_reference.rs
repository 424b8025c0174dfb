//! `sinew scene-reference`.

use sinew_scene::output::say;

use super::Failure;

/// Output format.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Print a JSON schema for editors instead of Markdown.
    #[arg(long)]
    json_schema: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let text = match arguments.json_schema {
        true => sinew_scene::scene_schema(),
        false => sinew_scene::scene_reference(),
    };
    Ok(say(text.trim_end())?)
}

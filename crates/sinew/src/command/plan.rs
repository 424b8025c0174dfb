//! `sinew plan`.

mod advice;
mod advice_json;

use std::path::PathBuf;

use sinew_measure::advice::{
    DEFAULT_PILOT_SECONDS, Question, QuestionError, advise, check_budget, check_pilot_seconds,
    check_tolerance,
};
use sinew_scene::Scene;
use sinew_scene::output::say;

use super::Failure;

/// A scene, and the error it is to run with.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    scene: PathBuf,
    /// Name the cheapest method and step whose relative error is at most this fraction, such as
    /// 1e-2, from short runs on the scene
    #[arg(long, value_name = "ERROR", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Most CPU seconds per simulated second, set-up apart; 1 is real time
    #[arg(
        long,
        value_name = "CPU_S_PER_S",
        requires = "tolerance",
        value_parser = budget,
        allow_hyphen_values = true
    )]
    budget: Option<f64>,
    /// CPU seconds after which no further pilot run begins
    #[arg(
        long,
        value_name = "S",
        requires = "tolerance",
        default_value_t = DEFAULT_PILOT_SECONDS,
        value_parser = pilot_seconds,
        allow_hyphen_values = true
    )]
    pilot_seconds: f64,
    /// The advice as one JSON object, without the plan; each null in it is explained in `missing`
    #[arg(long, requires = "tolerance")]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let simulation = Scene::load(&arguments.scene)?.build()?;
    if !arguments.json {
        say(simulation.plan().to_string().trim_end())?;
    }
    let Some(tolerance) = arguments.tolerance else {
        return Ok(());
    };
    let question = Question {
        tolerance,
        budget: arguments.budget,
        pilot_seconds: arguments.pilot_seconds,
    };
    let advice = advise(simulation, question);
    let advice = advice
        .map_err(|error| Failure::Input(format!("{}: {error}", arguments.scene.display())))?;
    if !arguments.json {
        say(&format!("\n{}", advice::text(&advice)))?;
        return Ok(());
    }
    let advice = advice_json::as_json(&advice);
    say(&advice.object.to_string())?;
    if advice.gaps.is_empty() {
        return Ok(());
    }
    Err(Failure::Run(format!(
        "missing from the advice: {}",
        advice.gaps.join("; ")
    )))
}

fn tolerance(text: &str) -> Result<f64, QuestionError> {
    number(text, check_tolerance)
}

fn budget(text: &str) -> Result<f64, QuestionError> {
    number(text, check_budget)
}

fn pilot_seconds(text: &str) -> Result<f64, QuestionError> {
    number(text, check_pilot_seconds)
}

/// What is no number is refused like a number that does not fit.
fn number(
    text: &str,
    check: impl Fn(f64) -> Result<(), QuestionError>,
) -> Result<f64, QuestionError> {
    let value = text.parse().unwrap_or(f64::NAN);
    check(value).map(|()| value)
}

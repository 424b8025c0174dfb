//! `sinew plan`.

mod advice;
mod advice_json;
mod plan_json;
mod program;
mod program_json;

use std::path::PathBuf;

use sinew_measure::Cost;
use sinew_measure::advice::{
    DEFAULT_PILOT_SECONDS, Question, QuestionError, advise, check_budget, check_pilot_seconds,
    check_tolerance,
};
use sinew_scene::output::say;

use super::Failure;
use super::scene_with::Values;

/// A scene and the error that its run may have.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    scene: PathBuf,
    /// Advise the cheapest integrator and step with at most this relative error, such as 1e-2, found
    /// by short runs of the scene; where they do not cover the scene, the answer says up to when it
    /// holds
    #[arg(long, value_name = "ERROR", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Largest cost in CPU seconds per simulated second, without set-up; 1 is real time
    #[arg(
        long,
        value_name = "CPU_S_PER_S",
        requires = "tolerance",
        value_parser = budget,
        allow_hyphen_values = true
    )]
    budget: Option<f64>,
    /// CPU seconds after which no further short run begins
    #[arg(
        long,
        value_name = "S",
        requires = "tolerance",
        default_value_t = DEFAULT_PILOT_SECONDS,
        value_parser = pilot_seconds,
        allow_hyphen_values = true
    )]
    pilot_seconds: f64,
    /// Print what each cell computes in a step: the sweeps of the scene's integrator as formulas, with
    /// their coefficients
    #[arg(long, conflicts_with = "tolerance")]
    program: bool,
    /// Print the advice or the program as one JSON object, without the plan, or without these the plan;
    /// in an advice the list `missing` explains each null
    #[arg(long)]
    json: bool,
    /// Make warnings errors
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    values: Values,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let simulation = arguments.values.load(&arguments.scene)?.build()?;
    if !arguments.json {
        say(simulation.plan().to_string().trim_end())?;
    } else if arguments.tolerance.is_none() && !arguments.program {
        say(&plan_json::as_json(&simulation).to_string())?;
    }
    if arguments.strict {
        Failure::of_warnings(&simulation.warnings())?;
    }
    if arguments.program {
        return program::print(&simulation, arguments.json);
    }
    let Some(tolerance) = arguments.tolerance else {
        return Ok(());
    };
    let question = Question {
        tolerance,
        budget: arguments.budget,
        pilot_seconds: arguments.pilot_seconds,
        cost: Cost::CpuTime,
    };
    let advice = advise(simulation, question);
    let advice = advice.map_err(|source| Failure::Advice {
        scene: arguments.scene.clone(),
        source,
    })?;
    if !arguments.json {
        say(&format!("\n{}", advice::text(&advice)))?;
        return Ok(());
    }
    let advice = advice_json::as_json(&advice);
    say(&advice.object.to_string())?;
    if advice.gaps.is_empty() {
        return Ok(());
    }
    Err(Failure::Gaps { gaps: advice.gaps })
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

/// Reads and checks a number. Text that is not a number is refused like a number that does not fit.
fn number(
    text: &str,
    check: impl Fn(f64) -> Result<(), QuestionError>,
) -> Result<f64, QuestionError> {
    let value = text.parse().unwrap_or(f64::NAN);
    check(value).map(|()| value)
}

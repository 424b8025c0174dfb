//! `sinew plan`.

mod advice;
mod advice_json;
mod cost;
mod cost_json;
mod plan_json;
mod program;
mod program_json;

use std::path::PathBuf;

use serde_json::Value;
use sinew_measure::advice::{
    AdviceError, DEFAULT_PILOT_SECONDS, Question, QuestionError, advise, check_budget,
    check_pilot_seconds, check_tolerance,
};
use sinew_scene::output::say;
use sinew_scene::{Plan, PlanSection, Scene, SceneError, Simulation};

use super::Failure;
use super::scene_with::Values;
use super::share_of::share_of;
use cost::Cost;

/// A scene, and the error or the cost that its run may have.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    scene: PathBuf,
    /// Advise the cheapest integrator and step with at most this relative error, such as 1e-2, found by short runs of
    /// the scene; if they do not cover the scene, the answer gives the time up to which it holds
    #[arg(long, value_name = "ERROR", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// Largest cost in CPU seconds per simulated second, without set-up; 1 is real time. Without
    /// --tolerance, advise the smallest error for it
    #[arg(
        long,
        value_name = "CPU_S_PER_S",
        value_parser = budget,
        allow_hyphen_values = true
    )]
    budget: Option<f64>,
    /// CPU seconds after which no further short run begins
    #[arg(
        long,
        value_name = "S",
        default_value_t = DEFAULT_PILOT_SECONDS,
        value_parser = pilot_seconds,
        allow_hyphen_values = true
    )]
    pilot_seconds: f64,
    /// Print what each cell computes in a step: the sweeps of the scene's integrator as formulas, with
    /// their coefficients
    #[arg(long, conflicts_with_all = ["tolerance", "budget"])]
    program: bool,
    /// Print the plan as one JSON object, with --tolerance or --budget the advice, which has the plan in it, or the
    /// program; in an advice the list `missing` explains each null
    #[arg(long)]
    json: bool,
    /// Make warnings errors
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    values: Values,
}

/// A scene with its mesh, built, and its plan.
struct Planned {
    simulation: Simulation,
    plan: Plan,
    cost: Cost,
}

/// Reasons why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// A scene that cannot be built.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene that needs more memory than there is.
    #[error("{0}")]
    Memory(String),
    /// A scene for which there is no advice.
    #[error(transparent)]
    Advice(#[from] AdviceError),
}

/// The plan of a scene as one JSON object, or the answer to a question with the plan in it, as printed by
/// `sinew plan --json`.
///
/// # Errors
/// [`PlanError`].
pub fn plan_json(scene: Scene, question: Option<Question>) -> Result<Value, PlanError> {
    let planned = planned(scene).map_err(|failure| match failure {
        Failure::Scene(error) => PlanError::Scene(error),
        other => PlanError::Memory(other.to_string()),
    })?;
    let object = planned.as_json();
    let Some(question) = question else {
        return Ok(object);
    };
    let advice = advise(planned.simulation, question)?;
    Ok(with_plan(advice_json::as_json(&advice).object, object))
}

fn planned(scene: Scene) -> Result<Planned, Failure> {
    let scene = scene.read_mesh()?;
    let footprint = scene.footprint();
    if let Some(footprint) = &footprint {
        cost::check_memory(footprint)?;
    }
    let simulation = scene.build()?;
    let cost = Cost::of(&simulation, footprint);
    let mut plan = simulation.plan();
    plan.warnings.extend(cost.warning());
    Ok(Planned {
        simulation,
        plan,
        cost,
    })
}

impl Planned {
    fn as_json(&self) -> Value {
        plan_json::as_json(&self.simulation, &self.plan, &self.cost)
    }
}

/// An answer with the plan in it.
fn with_plan(mut answer: Value, plan: Value) -> Value {
    if let Some(object) = answer.as_object_mut() {
        object.insert("plan".to_owned(), plan);
    }
    answer
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut planned = planned(arguments.values.load(&arguments.scene)?)?;
    let advised = arguments.tolerance.is_some() || arguments.budget.is_some();
    if !arguments.json {
        let section = PlanSection::new("cost", planned.cost.lines());
        planned.plan.sections.push(section);
        say(planned.plan.to_string().trim_end())?;
    } else if !advised && !arguments.program {
        say(&planned.as_json().to_string())?;
    }
    if arguments.strict {
        Failure::of_warnings(&planned.plan.warnings)?;
    }
    if arguments.program {
        return program::print(&planned.simulation, arguments.json);
    }
    if !advised {
        return Ok(());
    }
    let question = Question {
        tolerance: arguments.tolerance,
        budget: arguments.budget,
        pilot_seconds: arguments.pilot_seconds,
        cost: sinew_measure::Cost::CpuTime,
    };
    let object = planned.as_json();
    let advice = advise(planned.simulation, question);
    let advice = advice.map_err(|source| Failure::Advice {
        scene: arguments.scene.clone(),
        source,
    })?;
    if !arguments.json {
        say(&format!("\n{}", advice::text(&advice)))?;
        return Ok(());
    }
    let advice = advice_json::as_json(&advice);
    say(&with_plan(advice.object, object).to_string())?;
    if advice.gaps.is_empty() {
        return Ok(());
    }
    Err(Failure::Gaps { gaps: advice.gaps })
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value = share_of(text).ok_or_else(|| not_a_number("1e-2 or 1%"))?;
    checked(value, check_tolerance)
}

fn budget(text: &str) -> Result<f64, String> {
    number(text, check_budget)
}

fn pilot_seconds(text: &str) -> Result<f64, String> {
    number(text, check_pilot_seconds)
}

/// Reads and checks a number.
fn number(text: &str, check: impl Fn(f64) -> Result<(), QuestionError>) -> Result<f64, String> {
    let value = text.parse().map_err(|_| not_a_number("10"))?;
    checked(value, check)
}

fn checked(value: f64, check: impl Fn(f64) -> Result<(), QuestionError>) -> Result<f64, String> {
    check(value)
        .map(|()| value)
        .map_err(|error| error.to_string())
}

fn not_a_number(example: &str) -> String {
    format!("expected a number, such as {example}")
}

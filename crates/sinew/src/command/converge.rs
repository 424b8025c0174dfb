//! `sinew converge`.

mod json;
mod words;

use std::path::PathBuf;

use comfy_table::CellAlignment;
use sinew_measure::convergence::{
    Convergence, LEVELS, Prediction, Quantity, TimeCheck, When, converge, predict,
};
use sinew_measure::number::{milliseconds, percent, short, three};
use sinew_scene::output::{complain, hanging, say};

use super::Failure;
use super::ruled;
use super::run::LONG;
use super::scene_with::Values;
use words::{subject, unit};

/// A scene and the number of meshes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    scene: PathBuf,
    /// The number of meshes: the scene's, and each further one with every tetrahedron of the previous one cut into
    /// eight; from 3 on the order is observed
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = levels)]
    levels: usize,
    /// Begin even if more than 60 s are predicted
    #[arg(long)]
    yes: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    values: Values,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut simulation = arguments.values.load(&arguments.scene)?.build()?;
    if let Some(refused) = simulation.refused_load() {
        return Err(refused.into());
    }
    simulation.end_at_duration();
    let failed = |source| Failure::Converge {
        scene: arguments.scene.clone(),
        source,
    };
    let prediction = predict(&simulation, arguments.levels).map_err(failed)?;
    let about = cost(&prediction);
    match arguments.json {
        true => complain(&about),
        false => say(&about)?,
    }
    if prediction.seconds > LONG && !arguments.yes {
        return Err(Failure::LongConverge {
            seconds: prediction.seconds,
            limit: LONG,
        });
    }
    let found = converge(&simulation, &prediction).map_err(failed)?;
    match arguments.json {
        true => say(&json::object(&prediction, &found).to_string())?,
        false => say(&in_words(&found))?,
    }
    Ok(())
}

/// A description of the predicted cost.
fn cost(prediction: &Prediction) -> String {
    let mut table = ruled::table();
    table.set_header([
        "mesh",
        "nodes",
        "tetrahedra",
        "free dofs",
        "steps",
        "sweeps",
    ]);
    for (number, level) in (1..).zip(&prediction.levels) {
        table.add_row([
            match number {
                1 => "the scene's".to_owned(),
                2 => "refined".to_owned(),
                _ => format!("refined {} times", number - 1),
            },
            level.nodes.to_string(),
            level.tets.to_string(),
            level.dofs.to_string(),
            level.steps.to_string(),
            format!("{:.0}", level.sweeps),
        ]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let bytes = prediction.levels.last().map_or(0, |level| level.bytes);
    let check = match prediction.time_check {
        TimeCheck::Reference => "a reference solution on each mesh",
        TimeCheck::HalfStep => "the same run with half the step on each mesh",
    };
    format!(
        "predicted, with {check} for the errors in time:\n{table}\nabout {} s by this computer's clock, and {} MB for the finest \
         mesh\n",
        three(prediction.seconds),
        three(bytes as f64 / 1e6)
    )
}

fn in_words(found: &Convergence) -> String {
    let mut table = ruled::table();
    table.set_header([
        "quantity",
        "size",
        "in time\n[%]",
        "meshes differ\n[%]",
        "order",
        "in space\n[%]",
        "on the finest\n[%]",
    ]);
    for quantity in &found.quantities {
        let estimate = &quantity.estimate;
        let differences: Vec<String> = estimate
            .differences
            .iter()
            .map(|difference| percent(*difference))
            .collect();
        let or_dash = |error: Option<f64>| error.map_or_else(|| "-".to_owned(), percent);
        table.add_row([
            subject(quantity),
            format!("{} {}", three(quantity.size), unit(&quantity.subject)),
            or_dash(quantity.errors_in_time.first().copied().flatten()),
            differences.join(", "),
            match estimate.observed_order {
                Some(order) => format!("{order:.2}"),
                None => format!("({})", estimate.order),
            },
            or_dash(estimate.error),
            or_dash(estimate.error_of_finest),
        ]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut text = format!(
        "errors of the scene as it is, relative to the size of each quantity over the run:\n{table}\n\
         in space: Richardson's estimate; an order in brackets is assumed\n"
    );
    let first = found.levels.first().map_or(0.0, |level| level.dt);
    for (number, level) in (1..).zip(&found.levels) {
        if level.dt != first {
            text.push_str(&format!(
                "mesh {number} took dt = {} ms, the longest stable fraction of the scene's {}\n",
                milliseconds(level.dt),
                milliseconds(first)
            ));
        }
        if let Some(t) = level.diverged_at {
            text.push_str(&format!(
                "on mesh {number} the run in steps of {} s diverged at t = {} s: its error in time is not known\n",
                short(level.dt),
                short(t)
            ));
        }
    }
    for caveat in &found.caveats {
        text.push_str(&hanging("but: ", &caveat.to_string(), 0));
        text.push('\n');
    }
    text.push_str(&hanging("", &answer(found), 0));
    text
}

/// A sentence about which of the two errors dominates.
fn answer(found: &Convergence) -> String {
    let runs = found.quantities.iter();
    let runs = runs.filter(|quantity| quantity.when == When::Run);
    let worst = |of: &dyn Fn(&Quantity) -> Option<f64>| {
        runs.clone()
            .map(of)
            .try_fold(0.0, |worst: f64, error| Some(worst.max(error?)))
    };
    let space = worst(&|quantity| quantity.estimate.error);
    let time = worst(&|quantity| quantity.errors_in_time.first().copied().flatten());
    match (space, time) {
        (Some(space), Some(time)) if space > 2.0 * time => format!(
            "the mesh decides: up to {} % in space, {} % in time; a shorter step makes nothing better, a finer mesh does",
            percent(space),
            percent(time)
        ),
        (Some(space), Some(time)) if time > 2.0 * space => format!(
            "the step decides: up to {} % in time, {} % in space; a finer mesh makes nothing better, a shorter step does",
            percent(time),
            percent(space)
        ),
        (Some(space), Some(time)) => format!(
            "mesh and step are matched: up to {} % in space, {} % in time",
            percent(space),
            percent(time)
        ),
        _ => "one of the errors is not known: see above".to_owned(),
    }
}

fn levels(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(levels) if LEVELS.contains(&levels) => Ok(levels),
        _ => Err(format!(
            "expected a whole number from {} to {}",
            LEVELS.start(),
            LEVELS.end()
        )),
    }
}

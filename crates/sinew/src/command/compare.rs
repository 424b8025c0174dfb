//! `sinew compare`.

use std::path::PathBuf;

use comfy_table::CellAlignment;
use serde_json::json;
use sinew_record::{Comparison, Difference, compare};
use sinew_scene::output::say;

use super::Failure;
use super::interruption::Interruption;
use super::results::Results;
use super::ruled;
use super::share_of::share_of;

/// Two results and the difference that they may have.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The folder of a run, as `sinew run SCENE --out DIR` leaves it, or a scene file, which is run and leaves nothing
    one: PathBuf,
    /// Another folder or scene file
    other: PathBuf,
    /// The largest allowed relative difference; without it no difference is a finding
    #[arg(long, value_name = "SHARE", value_parser = share)]
    tolerance: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interruption = Interruption::listen().map_err(Failure::Signals)?;
    let one = Results::of(&arguments.one, &interruption)?;
    let other = Results::of(&arguments.other, &interruption)?;
    let comparison = compare(one.folder(), other.folder())?;
    match arguments.json {
        true => say(&as_json(&comparison).to_string())?,
        false => say(&in_words(&comparison))?,
    }
    let largest = comparison.largest_relative();
    match arguments.tolerance {
        Some(tolerance) if largest > tolerance => Err(Failure::Differ { largest, tolerance }),
        Some(_) if !comparison.left_out.is_empty() => Err(Failure::NotCompared {
            count: comparison.left_out.len(),
        }),
        _ => Ok(()),
    }
}

fn in_words(comparison: &Comparison) -> String {
    let mut table = ruled::table();
    table.set_header([
        "of",
        "quantity",
        "largest difference",
        "relative",
        "at t [s]",
        "node",
    ]);
    for Difference {
        of,
        what,
        unit,
        largest,
        relative,
        t,
        node,
    } in &comparison.differences
    {
        table.add_row([
            (*of).to_owned(),
            what.clone(),
            format!("{largest:.3e} {unit}"),
            format!("{relative:.3e}"),
            format!("{t:.6}"),
            node.map_or_else(String::new, |node| (node + 1).to_string()),
        ]);
    }
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut text = table.to_string();
    for line in &comparison.left_out {
        text.push_str(&format!("\nnot compared: {line}"));
    }
    text
}

fn as_json(comparison: &Comparison) -> serde_json::Value {
    let differences = comparison.differences.iter().map(|difference| {
        json!({
            "of": difference.of,
            "quantity": difference.what,
            "unit": difference.unit,
            "largest": difference.largest,
            "relative": difference.relative,
            "t_s": difference.t,
            "node": difference.node.map(|node| node + 1),
        })
    });
    json!({
        "largest_relative": comparison.largest_relative(),
        "differences": differences.collect::<Vec<_>>(),
        "not_compared": comparison.left_out,
    })
}

fn share(text: &str) -> Result<f64, &'static str> {
    match share_of(text) {
        Some(share) if share.is_finite() && share >= 0.0 => Ok(share),
        _ => Err("expected a finite share, 0 or above, such as 1e-6 or 1%"),
    }
}

//! `sinew compare`.

use std::path::{Path, PathBuf};

use comfy_table::CellAlignment;
use serde_json::json;
use sinew_record::{Comparison, Difference, compare};
use sinew_scene::output::say;
use tempfile::TempDir;

use super::Failure;
use super::interruption::Interruption;
use super::ruled;
use super::run::run_for_comparison;
use super::share_of::share_of;

/// Two results and the difference that they may have.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The folder of a run, as `sinew run SCENE --out DIR` leaves it, or a scene file, which is run and leaves nothing
    one: PathBuf,
    /// Another folder or scene file
    other: PathBuf,
    /// The largest relative difference that is no finding; without it none is
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

/// The results of a run.
enum Results {
    /// Results in a folder of the user.
    Kept(PathBuf),
    /// Results in a temporary folder, which is deleted with this value.
    Passing(TempDir),
}

impl Results {
    /// The results in a folder, or those of a run of a scene.
    fn of(path: &Path, interruption: &Interruption) -> Result<Self, Failure> {
        let is_scene = path
            .extension()
            .is_some_and(|extension| extension == "toml");
        if path.is_dir() || !(path.is_file() || is_scene) {
            return Ok(Self::Kept(path.to_owned()));
        }
        let folder = tempfile::Builder::new().prefix("sinew-compare-").tempdir();
        let folder = folder.map_err(Failure::TemporaryFolder)?;
        run_for_comparison(path, folder.path(), interruption.clone())?;
        Ok(Self::Passing(folder))
    }

    fn folder(&self) -> &Path {
        match self {
            Self::Kept(path) => path,
            Self::Passing(folder) => folder.path(),
        }
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

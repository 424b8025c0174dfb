//! `cargo xtask docs`.

use sinew_bench::output::{Destination, OutputError, say};
use sinew_bench::report::{markdown_rows, work_precision};
use sinew_bench::results::BenchResults;
use sinew_measure::Row;

use crate::failure::Failure;
use crate::repository::root;

/// The case that the README shows.
const CASE: &str = "paper-cube";
/// Steps in the README's table (ms).
const STEPS: [f64; 2] = [20.0, 20.0 / 3.0];
/// A stability map of the hard cases that the README shows.
const MAP: &str = "map-poisson.svg";
const BEGIN: &str = "<!-- bench -->\n";
const END: &str = "<!-- end -->";

/// Brings the README's table and pictures up to the last bench and the last hard bench.
pub(crate) fn run() -> Result<(), Failure> {
    let inputs = [
        root().join("target/bench-hard").join(MAP),
        root().join("target/bench/results.json"),
    ];
    let [map, results] = &inputs;
    let map = std::fs::read_to_string(map).map_err(|error| {
        let path = map.display();
        Failure::Input(format!(
            "{path}: {error}; run `cargo xtask bench --hard` first"
        ))
    })?;
    let text = std::fs::read_to_string(results).map_err(|error| {
        let path = results.display();
        Failure::Input(format!("{path}: {error}; run `cargo xtask bench` first"))
    })?;
    let results = BenchResults::from_json(&text).map_err(Failure::input)?;
    let shown = |row: &&Row| STEPS.iter().any(|ms| (row.dt * 1e3 - ms).abs() < 1e-6);
    let table = markdown_rows(results.rows_of(CASE).filter(shown));

    let readme = root().join("README.md");
    let text = std::fs::read_to_string(&readme).map_err(Failure::chore)?;
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some((before, after))
    });
    let Some((before, after)) = parts else {
        return Err(Failure::Chore(
            "README.md has lost the marks round its table".into(),
        ));
    };
    let machine = &results.machine;
    let text = format!(
        "{before}{BEGIN}{}\n\n{} ({} {}), one thread.\n{END}{after}",
        table.trim_end(),
        machine.cpu,
        machine.os,
        machine.arch
    );
    let picture = work_precision(&results, CASE).svg();
    let outputs = [
        (readme, text),
        (
            root().join(format!("docs/work-precision-{CASE}.svg")),
            picture,
        ),
        (root().join("docs").join(MAP), map),
    ];
    // All paths are checked before one is written.
    let outputs = outputs.into_iter().map(|(path, text)| {
        let destination = Destination::new(path, &inputs)?;
        Ok((destination, text))
    });
    let outputs: Vec<(Destination, String)> = outputs.collect::<Result<_, OutputError>>()?;
    for (destination, text) in outputs {
        let path = destination.path().display().to_string();
        let _ = destination.write(text.as_bytes())?;
        say(&path)?;
    }
    Ok(())
}

//! `cargo xtask docs`.

use sinew_bench::nonlinear;
use sinew_bench::report::{markdown_cheapest, work_precision};
use sinew_bench::results::BenchResults;
use sinew_scene::output::{Destination, OutputError, say};

use crate::failure::Failure;
use crate::repository::root;

/// The case whose plot is shown in README and book.
const CASE: &str = "paper-cube";
/// A stability map of the hard cases that the book shows.
const MAP: &str = "map-poisson.svg";
/// The book's picture of a large deformation.
const DEFORMATION: &str = "large-deformation.svg";
/// The chapter with the table.
const CHAPTER: &str = "docs/book/src/bench.md";
const BEGIN: &str = "<!-- bench -->\n";
const END: &str = "<!-- end -->";

/// Updates the table and the pictures of the book's chapter on the bench from the last bench and the last hard bench;
/// the picture of a large deformation is computed.
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
    let table = markdown_cheapest(&results);

    let chapter = root().join(CHAPTER);
    let text = std::fs::read_to_string(&chapter).map_err(Failure::chore)?;
    let machine = &results.machine;
    let machine = format!(
        "{} ({} {}), one thread.",
        machine.cpu, machine.os, machine.arch
    );
    let Some(text) = with_table(&text, &table, &machine) else {
        return Err(Failure::Chore(format!(
            "{CHAPTER} has lost the marks round its table"
        )));
    };
    let picture = work_precision(&results, CASE).svg();
    let outputs = [
        (chapter, text),
        (
            root().join(format!("docs/work-precision-{CASE}.svg")),
            picture,
        ),
        (root().join("docs").join(MAP), map),
        (
            root().join("docs").join(DEFORMATION),
            nonlinear::picture(&root().join("scenes")).map_err(Failure::chore)?,
        ),
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

/// The text with this table and a line on the computer between its marks; `None` without marks.
fn with_table(text: &str, table: &str, machine: &str) -> Option<String> {
    let (before, rest) = text.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    let table = table.trim_end();
    Some(format!("{before}{BEGIN}{table}\n\n{machine}\n{END}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_stands_between_the_marks_changes() {
        let text = format!("before\n{BEGIN}old\nlines\n{END}after {END}");
        let new = with_table(&text, "| new |\n", "a computer");
        let expected = format!("before\n{BEGIN}| new |\n\na computer\n{END}after {END}");
        assert_eq!(new.as_deref(), Some(expected.as_str()));
        let again = with_table(&expected, "| new |", "a computer");
        assert_eq!(again, Some(expected));
        assert_eq!(with_table("no marks", "| new |", ""), None);
    }

    #[test]
    fn the_chapter_has_the_marks() {
        let chapter = std::fs::read_to_string(root().join(CHAPTER)).unwrap();
        assert!(with_table(&chapter, "", "").is_some());
    }
}

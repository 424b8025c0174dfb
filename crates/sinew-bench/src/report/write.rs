//! Files of a bench, each written as a whole or not at all.

use std::path::PathBuf;

use sinew_draw::markup::slugs;
use sinew_scene::output::{OutputError, OutputFolder};

use super::{heat_map, html, strip, work_precision};
use crate::results::{BenchResults, ResultsError};

const RESULTS: &str = "results.json";
const REPORT: &str = "report.html";

/// The files that were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// `results.json`.
    pub results: PathBuf,
    /// `report.html`.
    pub report: PathBuf,
    /// `work-precision-<case>.svg` and `stability-<case>.svg` of every case, `map-<id>.svg` of every
    /// stability map.
    pub plots: Vec<PathBuf>,
}

/// Reasons why results could not be written, or only in part.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The results cannot be written as JSON.
    #[error("cannot write {}: {source}", path.display())]
    Results {
        /// The file for them.
        path: PathBuf,
        /// The reason.
        source: ResultsError,
    },
    /// The folder or a file in it cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// The names of all files that a bench of these cases and stability maps writes.
pub(crate) fn file_names(cases: &[String], maps: &[&str]) -> Vec<String> {
    let cases: Vec<&str> = cases.iter().map(String::as_str).collect();
    let of_cases = slugs(&cases).into_iter().flat_map(of_case);
    let of_maps = slugs(maps).into_iter().map(|name| of_map(&name));
    let fixed = [RESULTS, REPORT].map(str::to_owned);
    fixed.into_iter().chain(of_cases).chain(of_maps).collect()
}

fn of_case(slug: String) -> [String; 2] {
    [
        format!("work-precision-{slug}.svg"),
        format!("stability-{slug}.svg"),
    ]
}

fn of_map(slug: &str) -> String {
    format!("map-{slug}.svg")
}

/// Writes results, page and plots into a folder. Everything is drawn before the first file is written.
///
/// # Errors
/// [`WriteError`] when a file cannot be written. Files written before the one that failed stay.
pub fn write_all(results: &BenchResults, folder: &OutputFolder) -> Result<Written, WriteError> {
    let json = results.to_json().map_err(|source| WriteError::Results {
        path: folder.path().join(RESULTS),
        source,
    })?;
    let page = html(results);
    let plots = plots(results);

    let results = folder.write(RESULTS, json.as_bytes())?;
    let report = folder.write(REPORT, page.as_bytes())?;
    let plots = plots
        .iter()
        .map(|(name, svg)| folder.write(name, svg.as_bytes()));
    Ok(Written {
        results,
        report,
        plots: plots.collect::<Result<_, _>>()?,
    })
}

fn plots(results: &BenchResults) -> Vec<(String, String)> {
    let ids = results.case_ids();
    let named = ids.iter().zip(slugs(&ids));
    let map_ids: Vec<&str> = results.maps.iter().map(|map| map.id.as_str()).collect();
    let maps = results.maps.iter().zip(slugs(&map_ids));
    let maps = maps.map(|(map, name)| (of_map(&name), heat_map(map)));
    named
        .flat_map(|(id, name)| {
            let [precision, stability] = of_case(name);
            [
                (precision, work_precision(results, id).svg()),
                (stability, strip(results, id)),
            ]
        })
        .chain(maps)
        .collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use sinew_measure::{CaseInfo, Row};
    use sinew_verify::Machine;

    fn results() -> BenchResults {
        let mut results = BenchResults::new("r", Machine::default());
        for id in ["a", "A b"] {
            results.cases.push(CaseInfo {
                id: id.into(),
                max_u_m: f64::INFINITY,
                ..CaseInfo::default()
            });
        }
        results.rows.push(Row {
            case: "a".into(),
            integrator: "rk4".into(),
            dt: 0.01,
            steps: 10,
            cpu_s_per_s: f64::NAN,
            error: Some(0.1),
            max_u: Some(0.1),
            late_amplitude: Some(0.1),
            bounded: true,
            ..Row::default()
        });
        results
    }

    #[test]
    fn a_number_that_cannot_be_shown_costs_nothing_but_itself() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputFolder::new(folder.path().join("out"), &[]);
        let written = write_all(&results(), &out).unwrap();
        for path in written.plots.iter().chain([&written.report]) {
            let text = fs::read_to_string(path).unwrap();
            let drawn = text.replace("cpu_s_per_s = NaN", "");
            let drawn = drawn.replace("max_u_m = inf", "").replace("n/a (", "(");
            let wrong = ["NaN", "\"inf", "inf\""];
            for wrong in wrong {
                assert!(!drawn.replace("(NaN)", "").contains(wrong), "{path:?}");
            }
        }
        let page = fs::read_to_string(&written.report).unwrap();
        assert!(page.contains("n/a (NaN)") && page.contains("n/a (inf)"));
        assert!(page.contains("cpu_s_per_s = NaN") && page.contains("max_u_m = inf"));
        assert!(page.contains("it is not a finite number"));
    }

    #[test]
    fn the_files_are_known_beforehand() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputFolder::new(folder.path(), &[]);
        write_all(&results(), &out).unwrap();
        let entries = fs::read_dir(folder.path()).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        let mut known = file_names(&["a".into(), "A b".into()], &[]);
        names.sort();
        known.sort();
        assert_eq!(names, known);
    }
}

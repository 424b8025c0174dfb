//! Files of a bench, each there as a whole or not at all.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use sinew_scene::WholeFile;

use super::{heat_map, html, markup::slugs, strip, work_precision};
use crate::results::{BenchResults, ResultsError};

/// What was written.
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

/// Why nothing, or not everything, was written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The results cannot be JSON.
    #[error("cannot write {}: {source}", path.display())]
    Results {
        /// The file that was to hold them.
        path: PathBuf,
        /// Why.
        source: ResultsError,
    },
    /// The directory cannot be made.
    #[error("cannot make the directory {}: {source}", path.display())]
    Directory {
        /// The directory.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Writes results, page and plots into `dir`, which is made if need be. Everything is drawn before
/// the first file is touched.
///
/// # Errors
/// [`WriteError`] when the results cannot be JSON, or a file cannot be written. Files written before
/// the one that failed stay.
pub fn write_all(results: &BenchResults, dir: &Path) -> Result<Written, WriteError> {
    let written = Written {
        results: dir.join("results.json"),
        report: dir.join("report.html"),
        plots: Vec::new(),
    };
    let json = results.to_json().map_err(|source| WriteError::Results {
        path: written.results.clone(),
        source,
    })?;
    let page = html(results);
    let plots = plots(results);

    fs::create_dir_all(dir).map_err(|source| WriteError::Directory {
        path: dir.to_owned(),
        source,
    })?;
    write_atomically(&written.results, &json)?;
    write_atomically(&written.report, &page)?;
    let mut paths = Vec::with_capacity(plots.len());
    for (name, svg) in plots {
        let path = dir.join(name);
        write_atomically(&path, &svg)?;
        paths.push(path);
    }
    Ok(Written {
        plots: paths,
        ..written
    })
}

fn plots(results: &BenchResults) -> Vec<(String, String)> {
    let ids = results.case_ids();
    let named = ids.iter().zip(slugs(&ids));
    let map_ids: Vec<&str> = results.maps.iter().map(|map| map.id.as_str()).collect();
    let maps = results.maps.iter().zip(slugs(&map_ids));
    let maps = maps.map(|(map, name)| (format!("map-{name}.svg"), heat_map(map)));
    named
        .flat_map(|(id, name)| {
            [
                (
                    format!("work-precision-{name}.svg"),
                    work_precision(results, id).svg(),
                ),
                (format!("stability-{name}.svg"), strip(results, id)),
            ]
        })
        .chain(maps)
        .collect()
}

/// Writes a file as a whole or not at all.
///
/// # Errors
/// [`WriteError::File`]; the old file is then as it was.
pub fn write_atomically(path: &Path, content: &str) -> Result<(), WriteError> {
    WholeFile::write(path, content.as_bytes())
        .map(|_| ())
        .map_err(|source| WriteError::File {
            path: path.to_owned(),
            source,
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Machine;
    use sinew_measure::Row;

    fn names(dir: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(dir)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failure_leaves_nothing_half_written() {
        let dir = tempfile::tempdir().unwrap();
        // A directory cannot be replaced by a file.
        let path = dir.path().join("taken");
        fs::create_dir(&path).unwrap();
        let error = write_atomically(&path, "new").unwrap_err();
        assert!(error.to_string().contains("taken"), "{error}");
        assert_eq!(names(dir.path()), ["taken"]);

        let missing = dir.path().join("missing").join("a.txt");
        assert!(write_atomically(&missing, "new").is_err());
        assert_eq!(names(dir.path()), ["taken"]);
    }

    #[test]
    fn results_that_cannot_be_json_touch_no_file() {
        let dir = tempfile::tempdir().unwrap();
        let mut results = BenchResults::new("r", Machine::default());
        results.rows.push(Row {
            cpu_s_per_s: f64::NAN,
            error: Some(0.1),
            ..Row::default()
        });
        let error = write_all(&results, &dir.path().join("out")).unwrap_err();
        assert!(error.to_string().contains("results.json"), "{error}");
        assert!(names(dir.path()).is_empty());
    }
}

//! Planned cases, measured one after the other.

use std::path::PathBuf;

use sinew_measure::{Effort, mark_pareto, on_one_thread};

use super::case::PlannedCase;
use super::running::Running;
use crate::BenchError;
use crate::bench::scene_files;
use crate::report::file_names;
use crate::results::{BenchResults, Mark, Missing};
use sinew_verify::Progress;

/// Runs of a bench.
pub(crate) struct Plan {
    /// Description of its subject.
    pub(crate) subject: &'static str,
    /// The folder of scenes.
    pub(crate) scenes: PathBuf,
    /// True if times are measured with few repetitions.
    pub(crate) quick: bool,
    pub(crate) cases: Vec<PlannedCase>,
}

impl Plan {
    pub(crate) fn input_files(&self) -> Vec<PathBuf> {
        let scenes = self.cases.iter();
        let scenes: Vec<PathBuf> = scenes.map(|case| self.scenes.join(case.scene)).collect();
        scene_files(&scenes)
    }

    pub(crate) fn output_files(&self) -> Vec<String> {
        let ids = self.cases.iter();
        let ids: Vec<String> = ids.map(|case| case.id.to_owned()).collect();
        file_names(&ids, &[])
    }

    /// Measures every case on one thread, then the marks, which receive the rows and announce their runs.
    ///
    /// # Errors
    /// [`BenchError`] if no scene can be read.
    pub(crate) fn run(
        &self,
        results: BenchResults,
        mut progress: impl FnMut(Progress) + Send,
        marks: impl FnOnce(&BenchResults, &mut dyn FnMut(&str)) -> Vec<Mark> + Send,
    ) -> Result<BenchResults, BenchError> {
        on_one_thread(|| self.run_here(results, &mut progress, marks))?
    }

    fn run_here(
        &self,
        mut results: BenchResults,
        progress: &mut dyn FnMut(Progress),
        marks: impl FnOnce(&BenchResults, &mut dyn FnMut(&str)) -> Vec<Mark>,
    ) -> Result<BenchResults, BenchError> {
        results.subject = Some(self.subject.to_owned());
        let mut errors = Vec::new();
        let runs = |case: &PlannedCase| {
            case.methods.len() * case.steps.len() * case.materials.len().max(1)
        };
        let mut bench = Running {
            done: 0,
            of: self.cases.iter().map(runs).sum(),
            effort: match self.quick {
                true => Effort::QUICK,
                false => Effort::FULL,
            },
            progress,
            results: &mut results,
        };
        for planned in &self.cases {
            let before = bench.results.cases.len();
            let error = bench.case(planned, &self.scenes.join(planned.scene));
            if bench.results.cases.len() == before
                && let Some(error) = error
            {
                let missing = Missing::scene(planned.id, &error);
                bench.results.missing.push(missing);
                errors.push(error);
            }
        }
        let (done, of) = (bench.done, bench.of);
        if results.cases.is_empty() {
            return Err(BenchError::Cases(errors));
        }
        mark_pareto(&mut results.rows);
        results.marks = marks(&results, &mut |what| {
            let what = format!("mark: {what}");
            progress(Progress::Run { done, of, what });
        });
        Ok(results)
    }
}

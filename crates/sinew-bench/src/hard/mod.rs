//! Hard cases: damping, stiffness and meshes at which methods fail, each with a mark to pass.

mod cases;
mod checks;
mod energy;
mod hard_run;
mod maps;
mod mark;
mod marks;
pub mod meshes;
mod methods;
mod pairs;
mod stability_map;

use std::collections::BTreeMap;
use std::path::PathBuf;

use sinew_measure::{Case, Effort, mark_pareto, on_one_thread};

use crate::results::{BenchResults, Machine, Skipped};
use crate::{BenchError, Progress};
use hard_run::hard_row;
pub use mark::{Mark, MarkVerdict};
pub use stability_map::{MapPanel, MapRun, StabilityMap};

/// The bench of hard cases.
#[derive(Clone, Debug, PartialEq)]
pub struct HardBench {
    /// The folder of scenes, which has the hard ones in `hard`.
    pub scenes: PathBuf,
    /// Without the cases that take seconds, with fewer steps and repeats.
    pub quick: bool,
}

impl HardBench {
    /// Measures every case on one thread and gives the marks. A run that diverges is a row like
    /// any other, one that cannot be made is listed with its reason, and a mark that is not passed
    /// stands in the results as such.
    ///
    /// # Errors
    /// [`BenchError`] for a scene that cannot be read.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress) + Send,
    ) -> Result<BenchResults, BenchError> {
        on_one_thread(|| self.run_here(revision, machine, &mut progress))?
    }

    fn run_here(
        &self,
        revision: String,
        machine: Machine,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<BenchResults, BenchError> {
        let mut results = BenchResults::new(revision, machine);
        let mut cases = BTreeMap::new();
        let plan = cases::all();
        let plan: Vec<_> = plan
            .iter()
            .filter(|case| !(self.quick && case.slow))
            .collect();
        let of = plan
            .iter()
            .map(|case| case.methods.len() * case.steps.len())
            .sum();
        let mut done = 0;
        let effort = if self.quick {
            Effort::QUICK
        } else {
            Effort::FULL
        };
        for planned in plan {
            let scene = self.scenes.join(planned.scene);
            progress(Progress::Reference {
                scene: scene.clone(),
            });
            let mut case = Case::load(&scene)?;
            results.cases.push(case.info());
            for method in &planned.methods {
                for &dt in planned.steps {
                    let what = format!("{}: {}", case.id(), checks::at(&method.label(), dt));
                    progress(Progress::Run { done, of, what });
                    done += 1;
                    match hard_row(&mut case, method, dt, effort) {
                        Ok(row) => results.rows.push(row),
                        Err(reason) => results.skipped.push(Skipped {
                            case: case.id().to_owned(),
                            integrator: method.label(),
                            dt,
                            reason,
                        }),
                    }
                }
            }
            cases.insert(case.id().to_owned(), case);
        }
        mark_pareto(&mut results.rows);
        let measured = marks::Measured {
            cases: &cases,
            rows: &results.rows,
            folders: [self.scenes.clone(), self.scenes.join("hard")],
            quick: self.quick,
        };
        let marks = marks::all(&measured, |case| {
            let what = format!("mark: {case}");
            progress(Progress::Run { done, of, what });
        });
        results.marks = marks;
        results.maps = maps::all(self.quick, |title| {
            let what = format!("map: {title}");
            progress(Progress::Run { done, of, what });
        })
        .map_err(BenchError::Map)?;
        Ok(results)
    }
}

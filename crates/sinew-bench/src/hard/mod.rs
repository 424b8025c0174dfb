//! Hard cases: damping, stiffness and meshes for which methods fail, each with a pass mark.

mod cases;
mod checks;
mod energy;
mod hard_run;
mod large;
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

use crate::BenchError;
use crate::bench::{case_ids, scene_files};
use crate::report::file_names;
use crate::results::{BenchResults, Missing, Skipped};
use cases::HardCase;
use hard_run::hard_row;
use sinew_verify::{Machine, Progress};

/// The bench of hard cases.
#[derive(Clone, Debug, PartialEq)]
pub struct HardBench {
    /// The folder of scenes; the hard ones are in its folder `hard`.
    pub scenes: PathBuf,
    /// Leaves out the cases that take seconds, and uses fewer steps and repetitions.
    pub quick: bool,
}

impl HardBench {
    /// Measures every case on one thread and gives the marks. A run that diverges is a row like any other, a run that
    /// is not possible is listed with its reason, and a mark that is not passed is listed in the results as such. Marks
    /// on a scene that cannot be read fail too, and the scene is listed.
    ///
    /// # Errors
    /// [`BenchError`] if no scene can be read.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress) + Send,
    ) -> Result<BenchResults, BenchError> {
        on_one_thread(|| self.run_here(revision, machine, &mut progress))?
    }

    fn plan(&self) -> Vec<HardCase> {
        let mut plan = cases::all();
        plan.retain(|case| !(self.quick && case.slow));
        plan
    }

    fn scenes(&self) -> Vec<PathBuf> {
        let plan = self.plan();
        plan.iter()
            .map(|case| self.scenes.join(case.scene))
            .collect()
    }

    /// The files that the bench reads: no output may be one of them.
    #[must_use]
    pub fn input_files(&self) -> Vec<PathBuf> {
        scene_files(&self.scenes())
    }

    /// The names of the files that [`write_all`](crate::report::write_all) writes for the results.
    #[must_use]
    pub fn output_files(&self) -> Vec<String> {
        file_names(&case_ids(&self.scenes()), &maps::ids(self.quick))
    }

    fn run_here(
        &self,
        revision: String,
        machine: Machine,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<BenchResults, BenchError> {
        let mut results = BenchResults::new(revision, machine);
        let mut cases = BTreeMap::new();
        let mut errors = Vec::new();
        let plan = self.plan();
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
        for planned in &plan {
            let scene = self.scenes.join(planned.scene);
            progress(Progress::Reference {
                scene: scene.clone(),
            });
            let mut case = match Case::load(&scene) {
                Ok(case) => case,
                Err(error) => {
                    done += planned.methods.len() * planned.steps.len();
                    let scene = scene.display().to_string();
                    results.missing.push(Missing::scene(scene, &error));
                    errors.push(error);
                    continue;
                }
            };
            results.cases.push(case.info());
            for method in &planned.methods {
                for &dt in planned.steps {
                    let what = format!("{}: {}", case.id(), checks::at(&method.label(), dt));
                    progress(Progress::Run { done, of, what });
                    done += 1;
                    match hard_row(&mut case, method, dt, effort) {
                        Ok(row) => results.rows.push(row),
                        Err(error) => results.skipped.push(Skipped {
                            case: case.id().to_owned(),
                            integrator: method.label(),
                            dt,
                            reason: error.to_string(),
                        }),
                    }
                }
            }
            cases.insert(case.id().to_owned(), case);
        }
        if cases.is_empty() {
            return Err(BenchError::Cases(errors));
        }
        mark_pareto(&mut results.rows);
        let planned = case_ids(&self.scenes());
        let measured = marks::Measured {
            cases: &cases,
            planned: &planned,
            rows: &results.rows,
            folders: [self.scenes.clone(), self.scenes.join("hard")],
            quick: self.quick,
        };
        let marks = marks::all(&measured, |case| {
            let what = format!("mark: {case}");
            progress(Progress::Run { done, of, what });
        });
        results.marks = marks;
        let (maps, missing) = maps::all(self.quick, |title| {
            let what = format!("map: {title}");
            progress(Progress::Run { done, of, what });
        });
        results.marks.push(marks::of_maps(&maps));
        results.maps = maps;
        results.missing.extend(missing);
        Ok(results)
    }
}

//! All combinations of cases, integrators and steps.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use sinew_core::{Accuracy, OptionError, StableStep};

use sinew_measure::{
    Case, CaseError, Effort, MethodChoice, ThreadError, mark_pareto, measure, on_one_thread,
};

use sinew_scene::Scene;

use crate::report::file_names;
use sinew_verify::{Machine, Progress};

use crate::results::{BenchResults, Missing, Skipped};

/// Scenes, integrators and steps to measure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bench {
    /// Scene files, each of which is measured once.
    pub scenes: Vec<PathBuf>,
    /// Integrator ids; empty for all.
    pub integrators: Vec<String>,
    /// Steps (s); empty for [`default_steps`] of each scene.
    pub steps: Vec<f64>,
    /// True for fewer steps and repeats.
    pub quick: bool,
}

/// Reasons why a bench cannot start.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// An integrator that does not exist.
    #[error(transparent)]
    Integrator(#[from] OptionError),
    /// A step that is not positive and finite.
    #[error("--dt {0}: expected a finite step above 0 s")]
    Step(f64),
    /// No scene could be measured.
    #[error("{}", in_one_line(.0))]
    Cases(Vec<CaseError>),
    /// No thread could be started for the measurement.
    #[error(transparent)]
    Thread(#[from] ThreadError),
}

fn in_one_line(errors: &[CaseError]) -> String {
    let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
    errors.join("; ")
}

/// Steps (s) at which a scene is measured unless others are requested: its own and fractions of
/// it, most of which meet the instants at which errors are taken.
#[must_use]
pub fn default_steps(dt: f64, quick: bool) -> Vec<f64> {
    let divisors: &[f64] = if quick {
        &[1.0, 3.0, 20.0]
    } else {
        &[1.0, 4.0 / 3.0, 2.0, 3.0, 4.0, 5.0, 10.0, 20.0]
    };
    divisors.iter().map(|divisor| dt / divisor).collect()
}

impl Bench {
    /// Measures everything on one thread. A run that diverges is a row like any other; a run that is not possible is
    /// listed with its reason, and so is a scene that cannot be read or has no reference: the others are measured.
    ///
    /// # Errors
    /// [`BenchError`] for mistakes in the request, before anything is measured, and if
    /// no scene can be measured.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress) + Send,
    ) -> Result<BenchResults, BenchError> {
        self.check()?;
        let methods = self.methods()?;
        on_one_thread(|| self.run_here(&methods, revision, machine, &mut progress))?
    }

    fn run_here(
        &self,
        methods: &[String],
        revision: String,
        machine: Machine,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<BenchResults, BenchError> {
        let mut results = BenchResults::new(revision, machine);
        let (mut cases, mut errors) = (Vec::new(), Vec::new());
        for (id, scene) in named_cases(&self.scenes) {
            progress(Progress::Reference {
                scene: scene.to_owned(),
            });
            match load(id, scene) {
                Ok(case) => cases.push(case),
                Err(error) => {
                    let scene = scene.display().to_string();
                    results.missing.push(Missing::scene(scene, &error));
                    errors.push(error);
                }
            }
        }
        if cases.is_empty() && !errors.is_empty() {
            return Err(BenchError::Cases(errors));
        }
        let mut plan: Vec<(usize, MethodChoice, f64)> = Vec::new();
        for (index, case) in cases.iter().enumerate() {
            let steps = self.steps_of(case);
            let mut info = case.info();
            for method in methods.iter().flat_map(|id| variants(case, id)) {
                if let Ok(StableStep::UpTo(limit)) = method.stable_step(case.simulation())
                    && limit.is_finite()
                {
                    info.stable_steps_s.insert(method.label(), limit);
                }
                let mut steps = steps.as_slice();
                if self.steps.is_empty() && is_exact(&method) {
                    steps = &steps[..steps.len().min(STEPS_OF_EXACT_METHODS)];
                }
                let runs = steps.iter().map(|dt| (index, method.clone(), *dt));
                plan.extend(runs);
            }
            results.cases.push(info);
        }
        let effort = if self.quick {
            Effort::QUICK
        } else {
            Effort::FULL
        };
        for (done, (index, method, dt)) in plan.iter().enumerate() {
            let (case, dt) = (&mut cases[*index], *dt);
            progress(Progress::Run {
                done,
                of: plan.len(),
                what: format!("{}: {}, {} ms", case.id(), method.label(), round(dt * 1e3)),
            });
            match measure(case, method, dt, effort) {
                Ok(row) => results.rows.push(row),
                Err(error) => results.skipped.push(Skipped {
                    case: case.id().to_owned(),
                    integrator: method.label(),
                    dt,
                    reason: error.to_string(),
                }),
            }
        }
        mark_pareto(&mut results.rows);
        Ok(results)
    }

    /// Checks for mistakes in the arguments themselves.
    ///
    /// # Errors
    /// [`BenchError::Integrator`] and [`BenchError::Step`].
    pub fn check(&self) -> Result<(), BenchError> {
        self.methods()?;
        match self.steps.iter().find(|dt| !(dt.is_finite() && **dt > 0.0)) {
            Some(&step) => Err(BenchError::Step(step)),
            None => Ok(()),
        }
    }

    /// The files that the bench reads, for scenes that can be read: no output may be one of
    /// them.
    #[must_use]
    pub fn input_files(&self) -> Vec<PathBuf> {
        scene_files(&self.scenes)
    }

    /// The names of the files that [`write_all`](crate::report::write_all) writes for the results.
    #[must_use]
    pub fn output_files(&self) -> Vec<String> {
        file_names(&case_ids(&self.scenes), &[])
    }

    /// The integrators to measure.
    ///
    /// # Errors
    /// [`BenchError::Integrator`] for one that does not exist.
    pub fn methods(&self) -> Result<Vec<String>, BenchError> {
        let known = sinew_integrators::ids();
        if self.integrators.is_empty() {
            return Ok(known.into_iter().map(str::to_owned).collect());
        }
        for id in &self.integrators {
            if !known.contains(&id.as_str()) {
                let id = id.clone();
                return Err(OptionError::UnknownIntegrator { id, known }.into());
            }
        }
        Ok(self.integrators.clone())
    }

    fn steps_of(&self, case: &Case) -> Vec<f64> {
        if self.steps.is_empty() {
            default_steps(case.simulation().dt(), self.quick)
        } else {
            self.steps.clone()
        }
    }
}

/// Scene files and the files they name, as far as the scenes can be read.
#[must_use]
pub fn scene_files(scenes: &[PathBuf]) -> Vec<PathBuf> {
    let files = |scene: &PathBuf| Scene::input_files_of(scene);
    scenes.iter().flat_map(files).collect()
}

/// The ids that the cases of these scenes will have.
pub(crate) fn case_ids(scenes: &[PathBuf]) -> Vec<String> {
    named_cases(scenes).into_iter().map(|(id, _)| id).collect()
}

/// Each scene once, with a unique id: the name of its file, of its folder and its file, or of its file with a number,
/// whichever is not in use.
fn named_cases(scenes: &[PathBuf]) -> Vec<(String, &Path)> {
    let names: Vec<String> = scenes.iter().map(|scene| Case::id_of(scene)).collect();
    let mut seen = BTreeSet::new();
    let mut cases: Vec<(String, &Path)> = Vec::with_capacity(scenes.len());
    for (scene, name) in scenes.iter().zip(&names) {
        if !seen.insert(fs::canonicalize(scene).unwrap_or_else(|_| scene.clone())) {
            continue;
        }
        let is_taken = |id: &String| cases.iter().any(|(taken, _)| taken == id);
        let is_free = |id: &String| !is_taken(id) && !names.contains(id);
        let id = if is_taken(name) {
            let folder = scene.parent().and_then(Path::file_name);
            let in_folder = folder.map(|folder| format!("{}-{name}", folder.to_string_lossy()));
            let mut others = in_folder
                .into_iter()
                .chain((2..).map(|count| format!("{name}-{count}")));
            others.find(is_free).unwrap_or_default()
        } else {
            name.clone()
        };
        cases.push((id, scene));
    }
    cases
}

fn load(id: String, scene: &Path) -> Result<Case, CaseError> {
    Case::new(id, Scene::load(scene)?.build()?)
}

/// A method as it runs on a case, and its variants for other parts of the Pareto front.
fn variants(case: &Case, integrator: &str) -> Vec<MethodChoice> {
    let plain = MethodChoice::on(case, integrator);
    let entry = sinew_integrators::entry(integrator);
    let options = entry.map_or_else(Vec::new, |entry| (entry.variants)());
    let variants = options
        .iter()
        .map(|options| plain.clone().with_options(options));
    let mut variants: Vec<MethodChoice> = variants.collect();
    variants.retain(|variant| *variant != plain);
    variants.insert(0, plain);
    variants
}

/// Number of steps, the longest ones, at which a method that is exact over a step is measured: shorter steps cost more
/// and are not more accurate.
const STEPS_OF_EXACT_METHODS: usize = 4;

/// True if the error of a method does not depend on the step.
fn is_exact(method: &MethodChoice) -> bool {
    sinew_integrators::build(&method.integrator, &method.options)
        .is_ok_and(|integrator| integrator.properties().accuracy == Accuracy::Exact)
}

fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spring(stiffness: f64) -> String {
        format!(
            "[oscillator]\nmass = 0.1\nstiffness = {stiffness}\ndamping = 1.0\nvelocity = -5.0\n\
             [run]\nduration = 0.1\nintegrator = \"rk4\"\ndt = 0.02\n"
        )
    }

    fn write(path: &Path, text: &str) -> PathBuf {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
        path.to_owned()
    }

    #[test]
    fn scenes_of_one_name_are_cases_of_their_own_and_a_scene_named_twice_is_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let bench = Bench {
            scenes: vec![
                write(&path("a/x.toml"), &spring(100.0)),
                write(&path("b/x.toml"), &spring(400.0)),
                path("b/../a/x.toml"),
                write(&path("c/b/x.toml"), &spring(200.0)),
                write(&path("x-2.toml"), &spring(300.0)),
            ],
            integrators: vec!["rk4".to_owned()],
            steps: vec![0.01],
            quick: true,
        };
        let results = bench.run("r".into(), Machine::default(), |_| ()).unwrap();
        let ids = ["x", "b-x", "x-3", "x-2"];
        assert_eq!(results.case_ids(), ids);
        let rows: Vec<&str> = results.rows.iter().map(|row| row.case.as_str()).collect();
        assert_eq!(rows, ids);
        let names = bench.output_files();
        for id in ids {
            let plot = format!("work-precision-{id}.svg");
            assert!(names.contains(&plot), "{plot} in {names:?}");
        }
        assert_eq!(names.len(), 2 + 2 * ids.len());
    }

    #[test]
    fn the_mesh_of_a_scene_with_a_mistake_is_an_input() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for (name, text) in [
            ("key.toml", "[mesh]\nfile = \"body.msh\"\n[run]\ndt = -1\n"),
            ("twice.toml", "[mesh]\nfile = \"body.msh\"\n[mesh]\n"),
            (
                "syntax.toml",
                "[mesh]\nfile = \"body.msh\"\n[run]\ndt = = 1\n",
            ),
        ] {
            let scene = write(&path(name), text);
            assert_eq!(
                scene_files(std::slice::from_ref(&scene)),
                [scene, path("body.msh")]
            );
        }
        let nothing = path("no.toml");
        assert_eq!(scene_files(std::slice::from_ref(&nothing)), [nothing]);
    }
}

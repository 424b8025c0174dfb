//! Large deformations: every method, law and element on scenes where tissue is pressed, twisted and let go.
//!
//! Errors in time are against a reference of the same body in steps of no length; errors of the mesh, against finer meshes, stand apart.

mod cases;
mod equal_error;
mod marks;
mod materials;
mod mesh_error;
mod methods;
mod picture;

use std::path::PathBuf;

use sinew_measure::{
    Case, CaseError, Effort, MeasureError, MethodChoice, Row, RowOutcome, mark_pareto, measure,
    on_one_thread,
};
use sinew_scene::Scene;

pub use self::picture::{PictureError, picture};

use self::cases::NonlinearCase;
use self::mesh_error::MeshReference;
use crate::bench::scene_files;
use crate::report::file_names;
use crate::results::{BenchResults, Machine, Missing, Skipped};
use crate::{BenchError, Progress};

/// The bench of large deformations.
#[derive(Clone, Debug, PartialEq)]
pub struct NonlinearBench {
    /// The folder of scenes, which has most of these in `nonlinear`.
    pub scenes: PathBuf,
    /// Takes few scenes, methods and steps.
    pub quick: bool,
}

/// A body of a case: its law and element where the case has several, and what its scene changes to have them.
struct Body {
    material: Option<String>,
    law: Option<&'static str>,
    values: Vec<String>,
}

impl NonlinearBench {
    /// Measures every case on one thread. A run that is refused or diverges is a row like any other; a method that cannot run on a body at
    /// all is listed with its reason.
    ///
    /// # Errors
    /// [`BenchError`] where no scene can be read.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress) + Send,
    ) -> Result<BenchResults, BenchError> {
        on_one_thread(|| self.run_here(revision, machine, &mut progress))?
    }

    /// The files that the bench reads: no output may be one of them.
    #[must_use]
    pub fn input_files(&self) -> Vec<PathBuf> {
        let scenes = cases::all(self.quick);
        let scenes: Vec<PathBuf> = scenes
            .iter()
            .map(|case| self.scenes.join(case.scene))
            .collect();
        scene_files(&scenes)
    }

    /// The names of the files that [`write_all`](crate::report::write_all) writes of the results.
    #[must_use]
    pub fn output_files(&self) -> Vec<String> {
        let ids = cases::all(self.quick);
        let ids: Vec<String> = ids.iter().map(|case| case.id.to_owned()).collect();
        file_names(&ids, &[])
    }

    fn run_here(
        &self,
        revision: String,
        machine: Machine,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<BenchResults, BenchError> {
        let mut results = BenchResults::new(revision, machine);
        results.subject =
            Some("Large deformation: methods, laws and elements, with their errors".to_owned());
        let mut errors = Vec::new();
        let plan = cases::all(self.quick);
        let runs = |case: &NonlinearCase| {
            case.methods.len() * case.steps.len() * case.materials.len().max(1)
        };
        let mut bench = Running {
            done: 0,
            of: plan.iter().map(runs).sum(),
            effort: match self.quick {
                true => Effort::QUICK,
                false => Effort::FULL,
            },
            progress,
            results: &mut results,
        };
        for planned in &plan {
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
        results.marks = marks::all(&results.rows, self.quick, |case| {
            let what = format!("mark: {case}");
            progress(Progress::Run { done, of, what });
        });
        Ok(results)
    }
}

/// A bench under way.
struct Running<'a> {
    done: usize,
    of: usize,
    effort: Effort,
    progress: &'a mut dyn FnMut(Progress),
    results: &'a mut BenchResults,
}

impl Running<'_> {
    /// Measures a case on each of its bodies. The error of the first body without a reference.
    fn case(&mut self, planned: &NonlinearCase, scene: &std::path::Path) -> Option<CaseError> {
        let mut error = None;
        let mut finest: Option<(Option<&'static str>, MeshReference)> = None;
        for body in bodies(planned) {
            (self.progress)(Progress::Reference {
                scene: scene.to_owned(),
            });
            let case = Scene::load_with(scene, &body.values)
                .and_then(Scene::build)
                .map_err(CaseError::from)
                .and_then(|simulation| Case::new(planned.id, simulation));
            let mut case = match case {
                Ok(case) => case,
                Err(found) => {
                    self.done += planned.methods.len() * planned.steps.len();
                    self.skip(planned.id, body.material.unwrap_or_default(), 0.0, &found);
                    error.get_or_insert(found);
                    continue;
                }
            };
            if let Some(finer) = planned.finer
                && finest.as_ref().is_none_or(|(law, _)| *law != body.law)
            {
                match MeshReference::new(scene, &body.values, &case, finer) {
                    Ok(reference) => finest = Some((body.law, reference)),
                    Err(found) => self.skip(planned.id, "finer meshes".into(), 0.0, &found),
                }
            }
            let finest = finest.as_ref().filter(|(law, _)| *law == body.law);
            let mesh_error = finest.and_then(|(_, finest)| finest.error_of(&case).ok());
            self.info(planned, &case, finest.map(|(_, finest)| finest));
            self.runs(planned, &mut case, &body, mesh_error);
        }
        error
    }

    /// Describes a case by its first body.
    fn info(&mut self, planned: &NonlinearCase, case: &Case, finest: Option<&MeshReference>) {
        if self.results.case(case.id()).is_some() {
            return;
        }
        let mut info = case.info();
        info.remarks = planned
            .remarks
            .iter()
            .map(|remark| (*remark).to_owned())
            .collect();
        if let Some(finest) = finest {
            info.reference.push_str(&format!(
                "; of the mesh: two finer meshes of elements that do not lock, extrapolated, {} % from the finest",
                crate::report::percent(finest.error)
            ));
        }
        self.results.cases.push(info);
    }

    fn runs(
        &mut self,
        planned: &NonlinearCase,
        case: &mut Case,
        body: &Body,
        mesh_error: Option<f64>,
    ) {
        let mut yardstick = None;
        for method in &planned.methods {
            let steps = steps_of(planned, method);
            self.done += planned.steps.len() - steps.len();
            for (number, &dt) in steps.iter().enumerate() {
                (self.progress)(Progress::Run {
                    done: self.done,
                    of: self.of,
                    what: format!(
                        "{}: {}, {} ms",
                        case.id(),
                        method.label(),
                        crate::report::milliseconds(dt)
                    ),
                });
                self.done += 1;
                match measure(case, method, dt, self.effort) {
                    Ok(row) => {
                        let cost = row.cpu_s_per_s;
                        if row.outcome == RowOutcome::Finished && *method == methods::yardstick() {
                            yardstick.get_or_insert(cost);
                        }
                        self.results.rows.push(Row {
                            material: body.material.clone(),
                            mesh_error,
                            cost_ratio: yardstick.map(|yardstick| cost / yardstick),
                            ..row
                        });
                    }
                    // What lies in the method and the body is the same at any step.
                    Err(error @ (MeasureError::Setup(_) | MeasureError::Options(_))) => {
                        self.done += steps.len() - number - 1;
                        self.skip(case.id(), label(method, body), dt, &error);
                        break;
                    }
                    Err(error) => self.skip(case.id(), label(method, body), dt, &error),
                }
            }
        }
    }

    fn skip(&mut self, case: &str, integrator: String, dt: f64, reason: &dyn ToString) {
        self.results.skipped.push(Skipped {
            case: case.to_owned(),
            integrator,
            dt,
            reason: reason.to_string(),
        });
    }
}

/// Steps of methods that factorise a matrix in each iteration: short ones cost minutes, and explicit methods are far beneath them there.
const STEPS_OF_FACTORISING_METHODS: usize = 3;

fn steps_of(planned: &NonlinearCase, method: &MethodChoice) -> &'static [f64] {
    let entry = sinew_integrators::entry(&method.integrator);
    match entry.is_some_and(|entry| entry.factorises) {
        true => &planned.steps[..planned.steps.len().min(STEPS_OF_FACTORISING_METHODS)],
        false => planned.steps,
    }
}

fn label(method: &MethodChoice, body: &Body) -> String {
    match &body.material {
        Some(material) => format!("{}, {material}", method.label()),
        None => method.label(),
    }
}

fn bodies(planned: &NonlinearCase) -> Vec<Body> {
    if planned.materials.is_empty() {
        return vec![Body {
            material: None,
            law: None,
            values: Vec::new(),
        }];
    }
    let materials = planned.materials.iter();
    let bodies = materials.map(|material| Body {
        material: Some(material.words()),
        law: Some(material.law()),
        values: material.values(),
    });
    bodies.collect()
}

//! Measuring planned cases one by one.

use std::path::Path;

use sinew_measure::{
    Case, CaseError, Effort, MeasureError, MethodChoice, Row, RowOutcome, measure,
};
use sinew_scene::Scene;

use super::case::PlannedCase;
use super::mesh_error::MeshReference;
use super::methods::yardstick;
use crate::results::{BenchResults, Skipped};
use sinew_verify::Progress;

/// A body of a case: its law and element, if the case has several, and the changes of its scene for them.
struct Body {
    material: Option<String>,
    law: Option<&'static str>,
    values: Vec<String>,
}

/// A bench in progress.
pub(super) struct Running<'a> {
    pub(super) done: usize,
    pub(super) of: usize,
    pub(super) effort: Effort,
    pub(super) progress: &'a mut dyn FnMut(Progress),
    pub(super) results: &'a mut BenchResults,
}

impl Running<'_> {
    /// Measures a case on each of its bodies. Returns the error of the first body without a reference, if any.
    pub(super) fn case(&mut self, planned: &PlannedCase, scene: &Path) -> Option<CaseError> {
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
            let mesh_error = match finest.map(|(_, finest)| finest.error_of(&case)).transpose() {
                Ok(error) => error,
                Err(found) => {
                    self.skip(planned.id, "error of the mesh".into(), 0.0, &found);
                    None
                }
            };
            self.info(planned, &case, finest.map(|(_, finest)| finest));
            self.runs(planned, &mut case, &body, mesh_error);
        }
        error
    }

    /// Describes a case by its first body.
    fn info(&mut self, planned: &PlannedCase, case: &Case, finest: Option<&MeshReference>) {
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
        planned: &PlannedCase,
        case: &mut Case,
        body: &Body,
        mesh_error: Option<f64>,
    ) {
        let mut compared = None;
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
                        if row.outcome == RowOutcome::Finished && *method == yardstick() {
                            compared.get_or_insert(cost);
                        }
                        self.results.rows.push(Row {
                            material: body.material.clone(),
                            mesh_error,
                            cost_ratio: compared.map(|compared| cost / compared),
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

/// Number of steps for methods that factorise a matrix in each iteration: short steps cost minutes, and explicit
/// methods are far cheaper there.
const STEPS_OF_FACTORISING_METHODS: usize = 3;

fn steps_of(planned: &PlannedCase, method: &MethodChoice) -> &'static [f64] {
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

fn bodies(planned: &PlannedCase) -> Vec<Body> {
    let own_values: Vec<String> = planned
        .values
        .iter()
        .map(|value| (*value).to_owned())
        .collect();
    if planned.materials.is_empty() {
        return vec![Body {
            material: None,
            law: None,
            values: own_values,
        }];
    }
    let materials = planned.materials.iter();
    let bodies = materials.map(|material| Body {
        material: Some(material.words()),
        law: Some(material.law()),
        values: [own_values.clone(), material.values()].concat(),
    });
    bodies.collect()
}

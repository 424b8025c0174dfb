//! All combinations of cases, integrators and steps.

use std::path::PathBuf;

use sinew_core::{Accuracy, OptionError, OptionValue, StableStep};

use sinew_measure::{
    Case, CaseError, Effort, Method, ThreadError, mark_pareto, measure, on_one_thread,
};

use crate::results::{BenchResults, Machine, Skipped};

/// What to measure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bench {
    /// Scene files.
    pub scenes: Vec<PathBuf>,
    /// Integrator ids; empty for all.
    pub integrators: Vec<String>,
    /// Steps (s); empty for [`default_steps`] of each scene.
    pub steps: Vec<f64>,
    /// Fewer steps and repeats.
    pub quick: bool,
}

/// Why a bench could not start.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// An integrator that does not exist.
    #[error(transparent)]
    Integrator(#[from] OptionError),
    /// A step that is no time.
    #[error("--dt {0}: expected a finite step above 0 s")]
    Step(f64),
    /// A scene.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A stability map.
    #[error("stability map: {0}")]
    Map(String),
    /// No thread to measure on.
    #[error(transparent)]
    Thread(#[from] ThreadError),
}

/// How far a bench has come.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// A scene is read and its reference solved.
    Reference {
        /// The scene's file.
        scene: PathBuf,
    },
    /// A run begins.
    Run {
        /// Runs done before.
        done: usize,
        /// Runs in all.
        of: usize,
        /// What runs now.
        what: String,
    },
}

/// Steps (s) at which a scene is measured unless others are asked for: its own and fractions of
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
    /// Measures everything on one thread. A run that diverges is a row like any other; one that
    /// cannot be made is listed with its reason.
    ///
    /// # Errors
    /// [`BenchError`] for mistakes in what was asked for, before anything is measured.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress) + Send,
    ) -> Result<BenchResults, BenchError> {
        let methods = self.methods()?;
        if let Some(&step) = self.steps.iter().find(|dt| !(dt.is_finite() && **dt > 0.0)) {
            return Err(BenchError::Step(step));
        }
        on_one_thread(|| self.run_here(&methods, revision, machine, &mut progress))?
    }

    fn run_here(
        &self,
        methods: &[String],
        revision: String,
        machine: Machine,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<BenchResults, BenchError> {
        let mut cases = Vec::new();
        for scene in &self.scenes {
            progress(Progress::Reference {
                scene: scene.clone(),
            });
            cases.push(Case::load(scene)?);
        }
        let mut results = BenchResults::new(revision, machine);
        let mut plan: Vec<(usize, Method, f64)> = Vec::new();
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
                Err(reason) => results.skipped.push(Skipped {
                    case: case.id().to_owned(),
                    integrator: method.label(),
                    dt,
                    reason,
                }),
            }
        }
        mark_pareto(&mut results.rows);
        Ok(results)
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

/// A method as it runs on a case, and its kinds that lead somewhere else on the front.
fn variants(case: &Case, integrator: &str) -> Vec<Method> {
    let plain = Method::on(case, integrator);
    let text = |text: &str| OptionValue::Text(text.to_owned());
    let with = |key: &str, value: OptionValue| {
        let mut method = plain.clone();
        method.options = method.options.with(key, value);
        method
    };
    let chebyshev = |sweeps: f64| {
        let entries = [
            ("kind".to_owned(), text("chebyshev")),
            ("sweeps".to_owned(), OptionValue::Number(sweeps)),
        ];
        OptionValue::Table(entries.into())
    };
    let mut variants = match integrator {
        "cnn-stabilised" => vec![with("inner", chebyshev(4.0)), with("inner", chebyshev(8.0))],
        "propagator" => {
            let two_step = with("kind", text("two-step"));
            let mut loose = two_step.clone();
            loose.options = loose.options.with_number("tolerance", 1e-3);
            vec![two_step, loose, with("kind", text("krylov"))]
        }
        _ => Vec::new(),
    };
    variants.retain(|variant| *variant != plain);
    variants.insert(0, plain);
    variants
}

/// Longest steps at which a method is measured that is exact over a step: shorter ones cost more
/// and are no better.
const STEPS_OF_EXACT_METHODS: usize = 4;

/// Whether the error of a method does not depend on the step.
fn is_exact(method: &Method) -> bool {
    sinew_integrators::build(&method.integrator, &method.options)
        .is_ok_and(|integrator| integrator.properties().accuracy == Accuracy::Exact)
}

fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

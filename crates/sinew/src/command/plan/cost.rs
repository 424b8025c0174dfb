//! Predicted cost of a scene: memory and time.

use sinew_measure::Forecast;
use sinew_measure::number::{short, three};
use sinew_record::FolderSize;
use sinew_scene::{Footprint, Simulation, Warning};

use crate::command::Failure;
use crate::command::memory_left::memory_left;
use crate::command::run::LONG;

/// Degrees of freedom from which on no matrix is factorised for a plan.
const LARGE_TO_FACTORISE: usize = 60_000;

/// Predicted cost of a scene.
pub(super) struct Cost {
    /// Memory as computed from mesh and supports, for a body.
    pub(super) footprint: Option<Footprint>,
    /// Memory (bytes) of the factor of an implicit method, if there is one.
    pub(super) factor: Option<u64>,
    /// Work and time, or the reason why they are not known.
    pub(super) forecast: Result<Forecast, String>,
    /// Files of a run with `--out`.
    pub(super) folder: FolderSize,
    /// Simulated time (s).
    duration: f64,
    /// True if the work of a step depends on the motion.
    is_law: bool,
}

impl Cost {
    /// Takes a few steps of a scene.
    pub(super) fn of(simulation: &Simulation, footprint: Option<Footprint>) -> Self {
        let settings = simulation.settings();
        let entry = sinew_integrators::entry(&settings.integrator);
        let factorises = entry.is_some_and(|entry| entry.factorises);
        let forecast = match factorises && simulation.system().dofs() > LARGE_TO_FACTORISE {
            true => Err(format!(
                "not predicted: a plan factorises no matrix of more than {LARGE_TO_FACTORISE} degrees of freedom; `sinew run` \
                 says before it begins what it will take"
            )),
            false => simulation
                .integrator()
                .map_err(|error| error.to_string())
                .and_then(|mut integrator| {
                    let forecast = Forecast::of(simulation, &mut *integrator);
                    forecast.map_err(|error| format!("not predicted: {error}"))
                }),
        };
        Self {
            footprint,
            factor: factorises.then(|| factor_of(simulation)).flatten(),
            forecast,
            folder: FolderSize::of(simulation),
            duration: settings.duration,
            is_law: simulation.system().as_linear().is_none(),
        }
    }

    /// Description of the cost.
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        lines.extend(self.footprint.map(|footprint| {
            format!(
                "memory: about {} MB, {} MB of them for matrices{}; estimated from the mesh before the model is built",
                three(footprint.bytes as f64 / 1e6),
                three(footprint.matrix_bytes as f64 / 1e6),
                if self.factor.is_some() { ", the factor apart" } else { "" }
            )
        }));
        lines.extend(self.factor.map(|bytes| {
            let megabytes = three(bytes as f64 / 1e6);
            match (factor_fits(bytes), self.is_law) {
                (true, _) => format!("factor: about {megabytes} MB"),
                (false, true) => format!(
                    "factor: about {megabytes} MB, more than there is: steps do without it, a state at rest is refused; memory in [run] sets another limit"
                ),
                (false, false) => format!(
                    "factor: about {megabytes} MB, more than there is: conjugate gradients take its place; memory in [run] sets another limit"
                ),
            }
        }));
        lines.push(match &self.forecast {
            Ok(forecast) => {
                let solves = match forecast.solves_per_step > 0.0 {
                    true => format!(
                        " and {} solutions with a factor",
                        short(forecast.solves_per_step * forecast.steps as f64)
                    ),
                    false => String::new(),
                };
                format!(
                    "time: {} sweeps{solves} for {} s, {} CPU s per simulated second on one thread; {} s by this computer's clock \
                     in all, with {} s of set-up, as {} took here{}",
                    short(forecast.sweeps()),
                    short(self.duration),
                    three(forecast.cpu_s_per_s()),
                    three(forecast.run_s()),
                    three(forecast.setup_s),
                    match forecast.seen_s() {
                        Some(seen) if self.is_law => format!(
                            "its first {} s",
                            short(seen)
                        ),
                        Some(_) => "its first steps".to_owned(),
                        None => "all of its steps".to_owned(),
                    },
                    match forecast.seen_s() {
                        Some(_) if self.is_law => "; more where tissue gets stiffer later on",
                        _ => "",
                    }
                )
            }
            Err(reason) => format!("time: {reason}"),
        });
        let megabytes = |bytes: usize| three(bytes as f64 / 1e6);
        let FolderSize {
            frames,
            frame_bytes,
            is_compressed,
            table_bytes,
        } = self.folder;
        let fields = match frames {
            0 => String::new(),
            _ => format!(
                "{frames} frames of {} MB, {} MB in all{}, and ",
                megabytes(frame_bytes),
                megabytes(self.folder.field_bytes()),
                if is_compressed {
                    " before compression"
                } else {
                    ""
                }
            ),
        };
        lines.push(format!(
            "files of `run --out`: {fields}tables of about {} MB",
            megabytes(table_bytes)
        ));
        lines
    }

    /// A warning about a run that takes long.
    pub(super) fn warning(&self) -> Option<Warning> {
        let forecast = self.forecast.as_ref().ok()?;
        let seconds = forecast.run_s();
        (seconds > LONG).then(|| Warning::long_run(seconds, forecast.steps, forecast.dt))
    }
}

/// Refuses a scene that exceeds the available memory, before it is built.
pub(super) fn check_memory(footprint: &Footprint) -> Result<(), Failure> {
    match memory_left() {
        Some(available) if footprint.bytes as u64 > available => Err(Failure::Memory {
            needed: footprint.bytes as u64 / 1_000_000,
            available: available / 1_000_000,
        }),
        _ => Ok(()),
    }
}

/// Memory (bytes) of a factor on the pattern of a simulation's matrices.
#[cfg(feature = "implicit")]
fn factor_of(simulation: &Simulation) -> Option<u64> {
    let system = simulation.system();
    let pattern = match system.as_linear() {
        Some(linear) => linear.operators().stiffness().pattern(),
        None => system.as_elastic()?.pattern(),
    };
    sinew_integrators::Factor::bytes_on(pattern, system.layers()).ok()
}

#[cfg(not(feature = "implicit"))]
fn factor_of(_: &Simulation) -> Option<u64> {
    None
}

#[cfg(feature = "implicit")]
fn factor_fits(bytes: u64) -> bool {
    sinew_integrators::Memory::left().holds(bytes)
}

#[cfg(not(feature = "implicit"))]
fn factor_fits(_: u64) -> bool {
    true
}

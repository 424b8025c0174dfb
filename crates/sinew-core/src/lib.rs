//! The seams of sinew: what a solver is given, what it changes and what it says about its work.
//!
//! * [`State`] is a plain value: a clone is a checkpoint.
//! * [`System`] is `M a + f_int(u, v) = f_ext(t)`; a [`LinearSystem`] also shows its matrices.
//! * [`Integrator`] takes a state one step further and counts its work.
//! * [`Recorder`] says when it wants to see a state.
//! * [`simulate()`] runs an integrator; divergence is a result, not a panic.
//!
//! All quantities are SI, all vectors hold free degrees of freedom only, node-major (x y z).
//!
//! ```
//! use sinew_core::{LinearModel, LinearOperators, LoadTime, System, Trial};
//!
//! // One mass of 0.1 kg on a spring of 100 N/m.
//! let operators = LinearOperators::oscillator(0.1, 100.0, 1.0)?;
//! let model = LinearModel::new(operators);
//! let mut force = [0.0];
//! model.net_force(&Trial { load: LoadTime::at(0.0), dt: 0.0, u: &[0.01], v: &[-5.0] }, &mut force)?;
//! assert_eq!(force, [-100.0 * 0.01 - 1.0 * -5.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clock;
pub mod closed_form;
pub mod conformance;
mod elements;
mod gauss;
mod integrator;
mod linear;
mod load_over_step;
mod load_time;
mod options;
mod ramp;
mod recorder;
mod simulate;
pub mod spectrum;
mod state;
mod system;

pub use clock::Clock;
pub use elements::{ElementStiffness, Elements, element_omegas_squared};
pub use gauss::gauss_points;
pub use integrator::{
    Accuracy, ChangingLoads, EnergyBehaviour, Fact, Integrator, Needs, OtherDamping, Prepared,
    Properties, SetupError, StableStep, StepError, StepReport,
};
pub use linear::{Damping, LinearModel, LinearOperators, LinearSystem, Load, OperatorError};
pub use load_over_step::{LoadOverStep, step_that_meets};
pub use load_time::LoadTime;
pub use options::{OptionError, OptionValue, Options};
pub use ramp::{Ramp, RampError};
pub use recorder::{RecordError, Recorder, Recorders, Verdict};
pub use simulate::{Outcome, Run, RunReport, SimulateError, simulate};
pub use sinew_sparse::{BlockMatrix, Layers, Pattern};
pub use state::{Acceleration, Start, State, VelocityTime};
pub use system::{Energy, EvaluationError, Revision, Scales, System, Trial};

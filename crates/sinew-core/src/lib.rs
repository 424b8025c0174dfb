//! Interfaces of sinew: the input of a solver, the state that it changes and the work that it reports.
//!
//! * [`State`] is a plain value: a clone is a checkpoint.
//! * [`System`] is `M a + f_int(u, v) = f_ext(t)`; a [`LinearSystem`] also shows its matrices.
//! * [`Integrator`] takes a state one step further and counts its work.
//! * [`Recorder`] selects the states that it observes.
//! * [`simulate()`] runs an integrator; divergence is a result, not a panic.
//! * The feature `conformance` adds the laws that every integrator keeps, as tests.
//!
//! All quantities are SI, all vectors have free degrees of freedom only, node-major (x y z).
//!
//! ```
//! use sinew_core::LinearOperators;
//!
//! // One mass of 0.1 kg on a spring of 100 N/m.
//! let operators = LinearOperators::oscillator(0.1, 100.0, 1.0)?;
//! let mut force = [0.0];
//! operators.net_force(0.0, &[0.01], &[-5.0], &mut force);
//! assert_eq!(force, [-100.0 * 0.01 - 1.0 * -5.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod batch;
#[cfg(feature = "serde")]
pub mod bytes;
mod channel_record;
mod clock;
pub mod closed_form;
#[cfg(any(test, feature = "conformance"))]
pub mod conformance;
mod contact;
mod cost_clock;
mod counting_allocator;
mod derived;
mod elastic_law;
mod element_bounds;
mod element_forces;
mod elements;
mod energy;
mod evaluation_error;
mod fingerprint;
mod following;
mod force_model;
mod force_record;
mod free_part;
mod gauss;
mod guard;
mod hash;
mod input;
mod integrator;
mod lanczos;
mod linear_model;
mod load;
mod load_over_step;
mod load_time;
mod operators;
mod options;
mod prepared;
mod properties;
mod ramp;
mod recorder;
mod revision;
#[cfg(feature = "serde")]
mod saved_inputs;
#[cfg(feature = "serde")]
mod saved_state;
mod scaling;
mod simulate;
mod spectral_measure;
pub mod spectrum;
mod state;
mod static_load;
mod step_error;
mod step_report;
mod synchronise;
mod system;
mod trial;
mod watch;

pub use batch::{Batch, HostNeeds, Step, Stepped, worst_beyond};
#[cfg(feature = "serde")]
pub use bytes::BytesError;
pub use channel_record::{Between, InputError};
pub use clock::Clock;
pub use contact::{AllShown, Contact, Inertia, Meeting, ShowCells, Shown};
pub use cost_clock::CostClock;
pub use counting_allocator::CountingAllocator;
pub use elastic_law::{Deformed, ElasticLaw, StiffestElement, TangentKind, Velocities};
pub use element_bounds::ElementBounds;
pub use element_forces::{ElementForces, ElementPrecision, ElementSweep, SweepShape, sweep_alone};
pub use elements::{ElementStiffness, Elements, element_omegas_squared};
pub use energy::Energy;
pub use evaluation_error::EvaluationError;
pub use force_model::ForceModel;
pub use force_record::ForceInputError;
pub use free_part::{FreePart, Twist};
pub use gauss::gauss_points;
pub use guard::Guarding;
pub use hash::Hash;
pub use input::Inputs;
pub use integrator::{Fact, Integrator};
pub use linear_model::LinearModel;
pub use load::Load;
pub use load_over_step::{LoadOverStep, step_that_meets};
pub use load_time::LoadTime;
pub use operators::{CutRows, Damping, LinearOperators, OperatorError};
pub use options::{OptionError, OptionValue, Options};
pub use prepared::Prepared;
pub use properties::{
    Accuracy, ChangingLoads, EnergyBehaviour, Needs, OtherDamping, Properties, StableStep,
};
pub use ramp::{Channel, Ramp, RampError};
pub use recorder::{Moment, RecordError, Recorder, Verdict};
pub use revision::Revision;
#[cfg(feature = "serde")]
pub use saved_inputs::{InputBytesError, SavedInputs};
#[cfg(feature = "serde")]
pub use saved_state::{SavedState, StateBytesError};
pub use scaling::Scaling;
pub use simulate::{
    Outcome, RecordedSteps, Run, RunReport, SimulateError, simulate, simulate_under,
};
pub use sinew_sparse::{AssemblyError, BlockMatrix, Layers, Pattern, clamp_vector, vectors};
pub use state::{Acceleration, DampedAt, Start, State, StepCut, VelocityTime};
pub use static_load::StaticLoad;
pub use step_error::{SetupError, StepError};
pub use step_report::StepReport;
pub use synchronise::SynchroniseError;
pub use system::{Equations, ForceLaw, LinearSystem, Scales, System};
pub use trial::Trial;
pub use watch::Watch;

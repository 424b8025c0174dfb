//! Time integrators for soft tissue: explicit, implicit and cellular neural network.
//!
//! ```
//! use sinew_core::{LinearModel, LinearOperators, Options, Run, State, simulate};
//!
//! // The paper's oscillator: m = .1 kg, k = 100 N/m, d = 1 N s/m, v(0) = -5 m/s.
//! let model = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0)?);
//! let mut state = State::new(vec![0.0], vec![-5.0]);
//! let mut integrator = sinew_integrators::build("central-difference", &Options::new())?;
//! simulate(&model, &mut *integrator, &mut state, &Run::covering(1.0, 0.001), &mut ())?;
//! assert_eq!(state.t(), 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cell_factors;
pub mod cnn;
mod contact;
pub mod explicit;
mod explicit_method;
mod exponential;
mod frame;
mod guard_option;
#[cfg(feature = "implicit")]
pub mod implicit;
mod limits;
mod load_case;
mod machine_options;
mod method;
mod numerical_dissipation;
mod option_help;
mod option_kind;
pub mod propagator;
mod registry;
mod rounding;
mod scheme;
mod stepper;
mod stiffening;

pub use explicit_method::Explicit;
pub use frame::Frame;
#[cfg(feature = "implicit")]
pub use implicit::{
    Combination, Factor, FactorError, FactorUse, Matrices, Memory, NewtonError, NewtonSettings,
    Solver, StaticError, static_estimate, static_solution, static_solution_under, symmetric_eigen,
};
pub use machine_options::MACHINE_OPTIONS;
pub use method::{ConservedEnergy, Method};
pub use numerical_dissipation::{NumericalDissipation, StepEnd};
pub use option_help::{OptionDefault, OptionHelp, OptionLabel};
pub use option_kind::OptionKind;
pub use registry::{Entry, build, entries, entry, ids, with_threads};
pub use rounding::LEAST_F32_ROUNDING;
pub use scheme::{Scheme, SetUp, StepByHand, Steps};
pub use sinew_cnn::{Equilibrium, equilibrium};
pub use stepper::Stepper;

//! Machines that run the programs of cellular networks as fast as the hardware allows.
//!
//! A program ([`sinew_cnn::Program`]) states the operations of every cell in a step; the reference machine of
//! `sinew-cnn` defines its meaning. The machines here do the same to rounding: [`FastMachine`] stores the cells in its
//! own order, as structures of arrays, runs each sweep in one pass and uses the best available instructions, in `f64`
//! or `f32`, with the rows of any matrix or, if they repeat on a lattice, with a few templates that are stored once.
//! [`Chosen`] uses the machine that fits a system.
//!
//! Another program can add its own machine by [`register`]; scenes then know it by its id:
//!
//! ```
//! use sinew_cnn::ReferenceMachine;
//! use sinew_machines::{Kind, KnownMachine, PrecisionName, register};
//!
//! let kind = register(KnownMachine {
//!     id: "plain",
//!     meaning: "plain loops, of a program outside",
//!     precisions: &[PrecisionName::F64],
//!     check: |_settings, _system| Ok(()), // an Unfit where it does not run a system
//!     build: |_settings, _system| Box::new(ReferenceMachine::default()),
//! })?;
//! assert_eq!(Kind::of("plain"), Some(kind));
//! # Ok::<(), sinew_machines::RegisterError>(())
//! ```

mod chosen;
mod compiled;
mod crew;
mod fast;
mod forces;
mod kinds;
mod known;
mod layout;
mod registry;
mod settings;
mod touched;
mod unfit;

pub use chosen::Chosen;
pub use fast::FastMachine;
pub use known::KnownMachine;
pub use layout::Layout;
pub use registry::{RegisterError, known_machines, register};
pub use settings::{Kind, PrecisionName, Settings, Threads};
pub use unfit::Unfit;

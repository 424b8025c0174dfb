//! Force feedback: a device at 1 kHz renders tissue that is simulated at 100 Hz, and never receives more energy than
//! it has supplied.
//!
//! A device is connected only to a [`Coupling`], a spring and a damper whose other end is the tool of a simulation.
//! After each step a simulation publishes the position of its tool, the force of the tissue on it, and the stiffness of
//! the tissue there ([`Published`]); from these a [`ForceLoop`] computes the force on the device at each of its ticks.
//! The stiffness is that against slow displacements ([`LocalStiffness`]), so that between two steps the force follows
//! the user's tool pose as the tissue would.
//!
//! [`real_time::run`] runs a device and a simulation in a thread each, by the clock; [`Lockstep`] runs them in one
//! simulated time, for tests. [`ToolSimulation`] is a body with a tool that the device moves; [`SoftwareDevice`]
//! replaces a device and the user's hand, [`RigidWall`] is the hardest case to render.
//!
//! ```
//! use sinew_haptics::{Coupling, Device, Lockstep, RigidWall, SoftwareDevice};
//!
//! // A hand that goes up and down by 8 mm, twice a second, above a wall that is simulated at 100 Hz.
//! let mut device = SoftwareDevice::in_a_hand(|t| [0.0, 0.0, 0.004 + 0.008 * (12.0 * t).cos()]);
//! let coupling = Coupling::of(1000.0, &device.limits());
//! let wall = RigidWall::new(coupling, 0.05, 0.01, device.true_position());
//! let mut lockstep = Lockstep::new(wall, coupling, &mut device)?;
//! let mut peak: f64 = 0.0;
//! for _tick in 0..2000 {
//!     lockstep.tick(&mut device)?;
//!     peak = peak.max(lockstep.forces().force()[2]);
//! }
//! assert!(peak > 1.0);
//! assert!(device.most_energy_taken_out() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod coupling;
mod device;
mod exchange;
mod force_loop;
mod hand;
mod jitter;
mod local_model;
mod lockstep;
mod matrix;
mod published;
pub mod real_time;
mod rigid_wall;
mod software_device;
mod stiffness;
mod tool_simulation;

pub use coupling::{Coupling, CouplingError, DeviceLimits};
pub use device::Device;
pub use force_loop::ForceLoop;
pub use jitter::Jitter;
pub use lockstep::Lockstep;
pub use published::{DeviceMotion, Published, Simulated};
pub use rigid_wall::RigidWall;
pub use software_device::SoftwareDevice;
pub use stiffness::{Carried, Carry, LocalStiffness};
pub use tool_simulation::{ToolSimulation, ToolStepError};

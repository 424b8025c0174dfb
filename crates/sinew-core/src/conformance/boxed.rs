//! Integrators as the laws create them.

use crate::Integrator;

/// A boxed integrator.
pub type Boxed = Box<dyn Integrator>;

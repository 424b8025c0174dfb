//! Integrators as the laws make them.

use crate::Integrator;

/// A boxed integrator.
pub type Boxed = Box<dyn Integrator>;

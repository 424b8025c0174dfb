//! A conformance suite for machines.
//!
//! A machine is compared with programs executed literally (every sweep as its documentation defines it, on full
//! matrices) and with motions that are known exactly. The suite contains its own systems (one layer and three; mass and
//! stiffness damping, dashpots and all of them; loads that jump and loads with kinks; free and partly fixed) and a
//! program with every instruction; it also runs the programs of the methods that it receives.
//!
//! ```
//! use sinew_cnn::conformance::Method;
//! use sinew_cnn::{LoadAt, Physics, Program, ReferenceMachine, Register};
//! use sinew_core::{CountingAllocator, EnergyBehaviour, Needs, Properties, VelocityTime};
//!
//! #[global_allocator]
//! static ALLOCATOR: CountingAllocator = CountingAllocator;
//!
//! fn methods() -> Vec<Method> {
//!     let properties = Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded);
//!     vec![Method::new("symplectic-euler", properties, |system, dt| {
//!         let (u, v) = (Register::U, Register::V);
//!         let mut program = Program::new(VelocityTime::Same);
//!         let force = program.net_force(&Physics::of(system), u, v, LoadAt::StartOf);
//!         program.step.push(force.then(v.plus_q(dt)).then(u.plus(dt, v)));
//!         Some(program.complete())
//!     })]
//! }
//!
//! sinew_cnn::machine_conformance!(reference, methods(), || Box::new(ReferenceMachine::default()));
//! ```

mod bodies;
mod convergence;
mod dense;
mod everything;
mod interpreter;
mod known;
mod laws;
mod refusing;
mod run;
mod systems;
#[cfg(test)]
mod tests;
mod work;

use std::sync::Arc;

use sinew_core::{Properties, System};

pub use bodies::{
    Body, a_refused_body_leaves_the_machine_usable, batches_of_bodies_allocate_nothing,
    batches_of_bodies_change_not_a_bit, bodies_move_as_by_the_reference,
};
pub use convergence::motions_converge_to_the_exact_ones;
pub use laws::{
    batches_allocate_nothing, batches_change_not_a_bit, steps_are_those_of_the_definition,
    steps_of_many_cells_are_those_of_the_definition,
};
pub use refusing::{
    a_machine_without_a_program_refuses, a_refused_trial_leaves_the_machine_usable,
};
pub use work::work_is_counted;

use crate::{Machine, Program};

/// Creates a new machine.
pub type Make = dyn Fn() -> Box<dyn Machine>;

/// Builds a method's program for a system and a step of the caller (s); `None` if the method does not support the
/// system.
pub type ProgramOf = Box<dyn Fn(&dyn System, f64) -> Option<Program> + Send + Sync>;

/// A method whose programs test a machine.
pub struct Method {
    /// Its name, as failures show it.
    pub name: String,
    /// Its complete program.
    pub program: ProgramOf,
    /// Properties that it declares: its orders, and its condition on loads.
    pub properties: Properties,
    /// Length of its steps times the largest angular frequency.
    pub omega_dt: f64,
    /// True if the method bounds velocities, so that it may not converge.
    pub bounds: bool,
    known: Arc<known::Known>,
}

impl std::fmt::Debug for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Method")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl Method {
    /// A method that is run in steps of 0.4 over the largest angular frequency.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        properties: Properties,
        program: impl Fn(&dyn System, f64) -> Option<Program> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            program: Box::new(program),
            properties,
            omega_dt: 0.4,
            bounds: false,
            known: Arc::default(),
        }
    }

    /// Sets the length of its steps times the largest angular frequency.
    #[must_use]
    pub fn in_steps_of(mut self, omega_dt: f64) -> Self {
        self.omega_dt = omega_dt;
        self
    }

    /// Declares that it bounds velocities and need not converge.
    #[must_use]
    pub fn bounded(mut self) -> Self {
        self.bounds = true;
        self
    }
}

/// Generates one test for each law that a machine has to obey, in a module of this name: with the programs of a list of
/// [`Method`]s, for a closure that creates new machines. The test's global allocator has to be
/// [`sinew_core::CountingAllocator`].
#[macro_export]
macro_rules! machine_conformance {
    ($name:ident, $methods:expr, $make:expr) => {
        #[cfg(test)]
        mod $name {
            #[allow(unused_imports, reason = "a list may need nothing from outside")]
            use super::*;
            use $crate::conformance;

            fn make() -> Box<dyn $crate::Machine> {
                let make: fn() -> Box<dyn $crate::Machine> = $make;
                make()
            }

            #[test]
            fn steps_are_those_of_the_definition() {
                conformance::steps_are_those_of_the_definition(&$methods, &make);
            }

            #[test]
            fn steps_of_many_cells_are_those_of_the_definition() {
                conformance::steps_of_many_cells_are_those_of_the_definition(&$methods, &make);
            }

            #[test]
            fn motions_converge_to_the_exact_ones() {
                conformance::motions_converge_to_the_exact_ones(&$methods, &make);
            }

            #[test]
            fn batches_change_not_a_bit() {
                conformance::batches_change_not_a_bit(&$methods, &make);
            }

            #[test]
            fn batches_allocate_nothing() {
                conformance::batches_allocate_nothing(&$methods, &make);
            }

            #[test]
            fn work_is_counted() {
                conformance::work_is_counted(&make);
            }

            #[test]
            fn a_refused_trial_leaves_the_machine_usable() {
                conformance::a_refused_trial_leaves_the_machine_usable(&$methods, &make);
            }

            #[test]
            fn a_machine_without_a_program_refuses() {
                conformance::a_machine_without_a_program_refuses(&make);
            }
        }
    };
}

/// Generates one test for each law that a machine has to obey on bodies whose forces follow from a law, in a module of
/// this name: with the programs of a list of [`Method`]s on a list of [`Body`]s, for a closure that creates new
/// machines, to a relative rounding error. The test's global allocator has to be [`sinew_core::CountingAllocator`].
#[macro_export]
macro_rules! machine_conformance_on_bodies {
    ($name:ident, $methods:expr, $bodies:expr, $make:expr, $rounding:expr) => {
        #[cfg(test)]
        mod $name {
            #[allow(unused_imports, reason = "a list may need nothing from outside")]
            use super::*;
            use $crate::conformance;

            fn make() -> Box<dyn $crate::Machine> {
                let make: fn() -> Box<dyn $crate::Machine> = $make;
                make()
            }

            #[test]
            fn bodies_move_as_by_the_reference() {
                conformance::bodies_move_as_by_the_reference(&$methods, &$bodies, &make, $rounding);
            }

            #[test]
            fn batches_of_bodies_change_not_a_bit() {
                conformance::batches_of_bodies_change_not_a_bit(&$methods, &$bodies, &make);
            }

            #[test]
            fn batches_of_bodies_allocate_nothing() {
                conformance::batches_of_bodies_allocate_nothing(&$methods, &$bodies, &make);
            }

            #[test]
            fn a_refused_body_leaves_the_machine_usable() {
                conformance::a_refused_body_leaves_the_machine_usable(&$methods, &$bodies, &make);
            }
        }
    };
}

//! The laws that every integrator obeys, as a test suite that any crate can run on its own method. The feature
//! `conformance`, which a crate enables among its dev-dependencies, provides the suite.
//!
//! The problems are small and have motions known in closed form or by their Taylor series: chains of masses, a body in
//! space, a hardening spring, a Maxwell element. A method with saturation is tested without saturation.
//!
//! ```
//! use sinew_core::{
//!     Batch, EnergyBehaviour, Integrator, LoadTime, Needs, Prepared, Properties, SetupError,
//!     StableStep, State, StepError, StepReport, Stepped, System,
//! };
//!
//! /// Symplectic Euler.
//! #[derive(Default)]
//! struct Mine {
//!     a: Vec<f64>,
//! }
//!
//! impl Integrator for Mine {
//!     fn id(&self) -> &'static str {
//!         "mine"
//!     }
//!     fn properties(&self) -> Properties {
//!         Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded)
//!     }
//!     fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
//!         Prepared::check(self.id(), system, dt)?;
//!         self.a.resize(system.dofs(), 0.0);
//!         Ok(StepReport::default())
//!     }
//!     fn stable_step_about(
//!         &self,
//!         system: &dyn System,
//!         state: Option<&State>,
//!     ) -> Result<StableStep, SetupError> {
//!         // The root h of 4 - 2 d h - w^2 h^2, damping d being taken with the old velocity.
//!         let limit = system.spectrum(state).map(|spectrum| {
//!             let (w, d) = (spectrum.omega_max, spectrum.mass_damping + spectrum.damping_max);
//!             4.0 / (d + (d * d + 4.0 * w * w).sqrt())
//!         });
//!         Ok(limit.map_or(StableStep::Unknown, StableStep::UpTo))
//!     }
//!     fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
//!         batch.synchronise(state)?;
//!         batch.each(state, |step, state| {
//!             step.acceleration(LoadTime::start_of(state.t(), step.dt), state, &mut self.a)?;
//!             for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
//!                 *v += step.dt * a;
//!                 *u += step.dt * *v;
//!             }
//!             Ok(Stepped::at_same_time(StepReport::ONE_FORCE))
//!         })
//!     }
//! }
//!
//! // A module of tests, one for each law; several option sets make a module each.
//! sinew_core::conformance!(mine, || Box::new(Mine::default()));
//! sinew_core::conformance!(mine_by_options, {
//!     plain: || Box::new(Mine::default()),
//!     with_room: || Box::new(Mine { a: Vec::with_capacity(100) }),
//! });
//!
//! // Each law can be called separately, too.
//! sinew_core::conformance::observed_order_is_declared_order(&|| Box::new(Mine::default()));
//! ```

mod accuracy;
mod boxed;
mod changing_loads;
mod contract;
#[cfg(test)]
mod faults;
mod forces;
mod hardening;
#[cfg(test)]
mod heun;
mod inputs;
mod memory;
mod problems;
mod running;
mod stability;
mod staggered;

pub use accuracy::{
    observed_order_is_declared_order, observed_order_under_other_damping_is_declared_order,
    static_solution_is_the_equilibrium, velocity_can_be_had_at_the_time_of_the_displacement,
};
pub use boxed::Boxed;
pub use changing_loads::{
    loads_act_alike_at_any_time, order_with_changing_loads_is_as_declared,
    the_impulse_of_a_load_arrives_wherever_it_falls, time_does_not_drift_over_a_million_steps,
};
pub use contract::{
    another_system_is_noticed, bad_systems_and_steps_are_refused,
    checkpoint_continues_bit_identically, rest_stays_at_rest,
};
pub use forces::forces_are_enough_where_declared;
pub use hardening::{
    a_hardening_spring_swings_as_in_closed_form, a_refusal_ends_the_run_and_keeps_what_was,
    stable_step_follows_the_state,
};
pub use inputs::{
    a_force_from_outside_is_felt, channels_as_they_happen_do_what_known_loads_do,
    forces_as_they_happen_do_what_known_ones_do, forces_can_be_given_anew_from_a_checkpoint,
};
pub use memory::{a_maxwell_element_relaxes_as_in_closed_form, each_step_is_accepted_once};
pub use running::every_way_of_running_gives_the_same_bits;
pub use stability::{energy_behaves_as_declared, stable_step_is_as_declared};
pub use staggered::a_staggered_state_is_taken_over_at_one_time;

/// Generates a module of tests, one per law, for one integrator; or a module of such modules, one for each of several
/// option sets, in braces.
#[macro_export]
macro_rules! conformance {
    ($name:ident, { $($options:ident: $make:expr),+ $(,)? }) => {
        mod $name {
            #[allow(unused_imports)]
            use super::*;

            $($crate::conformance!($options, $make);)+
        }
    };
    ($name:ident, $make:expr) => {
        mod $name {
            #[allow(unused_imports)]
            use super::*;

            $crate::conformance!(@laws $make;
                rest_stays_at_rest
                observed_order_is_declared_order
                observed_order_under_other_damping_is_declared_order
                order_with_changing_loads_is_as_declared
                the_impulse_of_a_load_arrives_wherever_it_falls
                time_does_not_drift_over_a_million_steps
                loads_act_alike_at_any_time
                a_force_from_outside_is_felt
                forces_as_they_happen_do_what_known_ones_do
                channels_as_they_happen_do_what_known_loads_do
                forces_can_be_given_anew_from_a_checkpoint
                checkpoint_continues_bit_identically
                every_way_of_running_gives_the_same_bits
                energy_behaves_as_declared
                stable_step_is_as_declared
                stable_step_follows_the_state
                bad_systems_and_steps_are_refused
                each_step_is_accepted_once
                velocity_can_be_had_at_the_time_of_the_displacement
                static_solution_is_the_equilibrium
                another_system_is_noticed
                a_staggered_state_is_taken_over_at_one_time
                forces_are_enough_where_declared
                a_hardening_spring_swings_as_in_closed_form
                a_refusal_ends_the_run_and_keeps_what_was
                a_maxwell_element_relaxes_as_in_closed_form
            );
        }
    };
    (@laws $make:expr; $($law:ident)*) => {
        $(
            #[test]
            fn $law() {
                $crate::conformance::$law(&|| $make());
            }
        )*
    };
}

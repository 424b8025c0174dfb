//! Tests that every integrator obeys the laws of the core's conformance suite, under all its options.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sinew_core::{Integrator, OptionValue, Options};

macro_rules! suites {
    ($($(#[$attribute:meta])* $name:ident: $method:ty,)*) => {
        $(
            $(#[$attribute])*
            sinew_core::conformance!($name, || {
                use sinew_integrators::Method;
                let options = <$method>::conformance_options();
                <$method>::from_options(&options).unwrap().integrator()
            });
        )*
    };
}

sinew_integrators::for_each_integrator!(suites);

fn text(word: &str) -> OptionValue {
    OptionValue::Text(word.into())
}

/// An integrator with one option.
fn with(id: &str, key: &str, value: OptionValue) -> Box<dyn Integrator> {
    let options = Options::new().with(key, value);
    sinew_integrators::build(id, &options).unwrap()
}

fn propagator(kind: &str) -> Box<dyn Integrator> {
    let options = Options::new().with("kind", text(kind));
    let options = options.with_number("tolerance", 1e-11);
    sinew_integrators::build("propagator", &options).unwrap()
}

sinew_core::conformance!(propagator_by_kind, {
    krylov: || propagator("krylov"),
    two_step: || propagator("two-step"),
});

/// `cnn-stabilised` with an inner iteration, and another option.
fn stabilised(
    kind: &str,
    sweeps: Option<f64>,
    other: Option<(&str, OptionValue)>,
) -> Box<dyn Integrator> {
    let sweeps = sweeps.map(|sweeps| ("sweeps".to_owned(), OptionValue::Number(sweeps)));
    let entries = [("kind".to_owned(), text(kind))].into_iter().chain(sweeps);
    let mut options = Options::new().with("inner", OptionValue::Table(entries.collect()));
    if let Some((key, value)) = other {
        options.insert(key, value);
    }
    sinew_integrators::build("cnn-stabilised", &options).unwrap()
}

// More than one sweep centres the damping, which is another order.
sinew_core::conformance!(cnn_stabilised_by_inner, {
    jacobi_1: || stabilised("jacobi", Some(1.0), None),
    jacobi_2: || stabilised("jacobi", Some(2.0), None),
    chebyshev_1: || stabilised("chebyshev", Some(1.0), None),
    chebyshev_3: || stabilised("chebyshev", Some(3.0), None),
    gauss_seidel_1: || stabilised("gauss-seidel", Some(1.0), None),
    gauss_seidel_2: || stabilised("gauss-seidel", Some(2.0), None),
    bounded_by_gershgorin: || stabilised("block", None, Some(("gamma", text("gershgorin")))),
    all_added_chebyshev_2: || {
        stabilised("chebyshev", Some(2.0), Some(("s", OptionValue::Number(1.0))))
    },
});

// Under a dashpot the error of this one falls faster than declared, by no whole power.
#[test]
fn blocks_that_hold_all_stiffness_keep_the_laws_of_motion() {
    use sinew_core::conformance as laws;
    let make = || stabilised("block", None, Some(("s", OptionValue::Number(1.0))));
    laws::observed_order_is_declared_order(&make);
    laws::order_with_changing_loads_is_as_declared(&make);
    laws::energy_behaves_as_declared(&make);
    laws::stable_step_is_as_declared(&make);
    laws::static_solution_is_the_equilibrium(&make);
    laws::every_way_of_running_gives_the_same_bits(&make);
    laws::forces_as_they_happen_do_what_known_ones_do(&make);
}

#[cfg(feature = "implicit")]
mod implicit {
    use super::*;

    fn newmark(beta: f64, gamma: f64) -> Box<dyn Integrator> {
        let options = Options::new().with_number("beta", beta);
        let options = options.with_number("gamma", gamma);
        sinew_integrators::build("newmark", &options).unwrap()
    }

    sinew_core::conformance!(newmark_by_parameters, {
        linear_acceleration: || newmark(1.0 / 6.0, 0.5),
        explicit: || newmark(0.0, 0.5),
        stiff: || newmark(0.3, 0.5),
        damped: || newmark(0.3025, 0.6),
        most_damped: || newmark(0.5, 1.0),
        growing: || newmark(0.3, 0.4),
    });

    sinew_core::conformance!(generalized_alpha_by_parameter, {
        conserving: || with("generalized-alpha", "rho_inf", OptionValue::Number(1.0)),
        most_damped: || with("generalized-alpha", "rho_inf", OptionValue::Number(0.0)),
        hilber_hughes_taylor: || with("generalized-alpha", "hht", OptionValue::Number(0.1)),
    });

    sinew_core::conformance!(modal_by_count, {
        all: || with("modal", "modes", OptionValue::Number(9.0)),
    });

    // Patches need elements, which the suite's problems do not have.
    #[test]
    fn patches_need_matrices_and_say_so() {
        sinew_core::conformance::forces_are_enough_where_declared(&|| {
            with("central-difference", "patches", text("auto"))
        });
    }

    #[test]
    fn a_newmark_method_of_any_gamma_passes_on_the_whole_impulse() {
        for (beta, gamma) in [(0.3, 0.0), (1.0, 0.5)] {
            sinew_core::conformance::the_impulse_of_a_load_arrives_wherever_it_falls(&|| {
                newmark(beta, gamma)
            });
        }
    }
}

// Cutting steps leaves every law as it is, and so does a guard that nothing reaches.
macro_rules! wrapped_suites {
    ($($name:ident: $id:literal,)*) => {
        $(
            sinew_core::conformance!($name, {
                substeps_3: || with($id, "substeps", OptionValue::Number(3.0)),
                guarded: || with($id, "saturation", OptionValue::Number(1e300)),
                guarded_substeps: || {
                    let options = Options::new().with_number("saturation", 1e300);
                    let options = options.with_number("substeps", 2.0);
                    sinew_integrators::build($id, &options).unwrap()
                },
            });
        )*
    };
}

wrapped_suites! {
    wrapped_forward_euler: "forward-euler",
    wrapped_symplectic_euler: "symplectic-euler",
    wrapped_central_difference: "central-difference",
    wrapped_rk4: "rk4",
    wrapped_modified_leapfrog: "modified-leapfrog",
}

// Not forward Euler, which without damping has no stable step to cut by.
macro_rules! automatic_suites {
    ($($name:ident: $id:literal,)*) => {
        $(sinew_core::conformance!($name, || with($id, "substeps", text("auto")));)*
    };
}

automatic_suites! {
    cut_symplectic_euler: "symplectic-euler",
    cut_central_difference: "central-difference",
    cut_rk4: "rk4",
    cut_modified_leapfrog: "modified-leapfrog",
}

sinew_core::conformance!(guarded_cnn_stabilised, || {
    with("cnn-stabilised", "saturation", OptionValue::Number(1e300))
});

/// `cnn-energy` by its options.
fn energy(kind: &str, sweeps: f64) -> Box<dyn Integrator> {
    let options = Options::new().with("kind", text(kind));
    let options = options.with_number("sweeps", sweeps);
    sinew_integrators::build("cnn-energy", &options).unwrap()
}

sinew_core::conformance!(cnn_energy_by_options, {
    implicit_euler_2: || energy("ie", 2.0),
    implicit_euler_4: || energy("ie", 4.0),
    trapezoidal_3: || energy("trap", 3.0),
    trapezoidal_12: || energy("trap", 12.0),
});

// Where both masses mirror each other one sweep is exact, and errors under other damping fall faster than declared, by no whole power.
#[test]
fn few_sweeps_keep_the_laws_of_motion() {
    use sinew_core::conformance as laws;
    for (kind, sweeps) in [("ie", 1.0), ("trap", 1.0), ("trap", 2.0)] {
        let make = || energy(kind, sweeps);
        laws::observed_order_is_declared_order(&make);
        laws::order_with_changing_loads_is_as_declared(&make);
        laws::energy_behaves_as_declared(&make);
        laws::stable_step_is_as_declared(&make);
        laws::static_solution_is_the_equilibrium(&make);
        laws::every_way_of_running_gives_the_same_bits(&make);
        laws::a_refusal_ends_the_run_and_keeps_what_was(&make);
        laws::forces_as_they_happen_do_what_known_ones_do(&make);
    }
}

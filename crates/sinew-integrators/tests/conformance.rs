//! Every integrator keeps the laws of the core's conformance suite.

#![cfg(test)]

macro_rules! suites {
    ($($(#[$attribute:meta])* $name:ident: $method:ty,)*) => {
        $(
            $(#[$attribute])*
            sinew_core::conformance!($name, || {
                use sinew_integrators::Method;
                let options = <$method>::conformance_options();
                Box::new(<$method>::from_options(&options).unwrap()) as Box<dyn sinew_core::Integrator>
            });
        )*
    };
}

sinew_integrators::for_each_integrator!(suites);

sinew_core::conformance!(propagator_krylov, || {
    use sinew_integrators::propagator::{Propagator, PropagatorKind};
    let krylov = Propagator::with_tolerance(PropagatorKind::Krylov, 1e-11);
    Box::new(krylov) as Box<dyn sinew_core::Integrator>
});

sinew_core::conformance!(propagator_two_step, || {
    use sinew_integrators::propagator::{Propagator, PropagatorKind};
    let two_step = Propagator::with_tolerance(PropagatorKind::TwoStep, 1e-11);
    Box::new(two_step) as Box<dyn sinew_core::Integrator>
});

// More than one sweep centres the damping, which is another order.
macro_rules! inner_suites {
    ($($name:ident: $inner:expr,)*) => {
        $(
            sinew_core::conformance!($name, || {
                use sinew_cnn::{Blend, GammaRule, Inner};
                let method =
                    sinew_integrators::cnn::CnnStabilised::new($inner, GammaRule::Power, Blend::Auto);
                Box::new(method) as Box<dyn sinew_core::Integrator>
            });
        )*
    };
}

inner_suites! {
    cnn_stabilised_jacobi_2: Inner::Jacobi { sweeps: 2 },
    cnn_stabilised_chebyshev_3: Inner::Chebyshev { sweeps: 3 },
    cnn_stabilised_gauss_seidel_1: Inner::GaussSeidel { sweeps: 1 },
}

#[cfg(feature = "implicit")]
#[test]
fn a_newmark_method_of_any_gamma_passes_on_the_whole_impulse() {
    use sinew_integrators::implicit::Newmark;
    for (beta, gamma) in [
        (0.5, 1.0),
        (0.3025, 0.6),
        (0.3, 0.5),
        (0.3, 0.0),
        (1.0, 0.5),
    ] {
        sinew_core::conformance::the_impulse_of_a_load_arrives_wherever_it_falls(&|| {
            Box::new(Newmark::new(beta, gamma))
        });
    }
}

// A guard that nothing reaches leaves every law as it is.
macro_rules! guarded_suites {
    ($($name:ident: $id:literal,)*) => {
        $(
            sinew_core::conformance!($name, || {
                let options = sinew_core::Options::new().with_number("saturation", 1e300);
                sinew_integrators::build($id, &options).unwrap()
            });
        )*
    };
}

guarded_suites! {
    guarded_forward_euler: "forward-euler",
    guarded_symplectic_euler: "symplectic-euler",
    guarded_central_difference: "central-difference",
    guarded_rk4: "rk4",
    guarded_modified_leapfrog: "modified-leapfrog",
    guarded_cnn_stabilised: "cnn-stabilised",
}

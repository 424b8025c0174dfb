//! Programs as they are printed.

use std::sync::Arc;

use crate::common::{inner, plain};
use sinew_core::{
    BlockMatrix, Damping, LinearModel, LinearOperators, Load, OptionValue, Options, Ramp,
};

const MASS: f64 = 0.1;
const MASS_DAMPING: f64 = 10.0;

/// A mass on a spring and the requested kinds of dashpots, under a load that rises.
fn oscillator(stiffness_damping: f64, dashpot: bool) -> LinearModel {
    let plain = LinearOperators::oscillator(MASS, 100.0, 0.0).unwrap();
    let stiffness = BlockMatrix::clone(plain.stiffness());
    let extra = dashpot.then(|| {
        let mut extra = stiffness.clone();
        extra.scale_rows(&[0.002]);
        Arc::new(extra)
    });
    let damping = Damping {
        mass: MASS_DAMPING,
        stiffness: stiffness_damping,
        extra,
    };
    let load = Load {
        ramp: Ramp::Sin2 { rise: 1.0 },
        entries: vec![(0, 2.0)],
    };
    LinearModel::new(LinearOperators::new(vec![MASS], stiffness, damping, vec![load]).unwrap())
}

fn printed(system: &LinearModel, id: &str, options: &Options, dt: f64, digits: usize) -> String {
    let mut integrator = sinew_integrators::build(id, options).unwrap();
    integrator.prepare(system, dt).unwrap();
    let program = integrator.program().unwrap();
    format!("{program:.digits$}")
}

#[test]
fn every_method_prints_what_it_computes() {
    let undamped_in_k = oscillator(0.0, false);
    let text = |word: &str| OptionValue::Text(word.into());
    let full = plain().with_number("s", 1.0);
    let stabilised = |kind: &str, sweeps| full.clone().with("inner", inner(kind, Some(sweeps)));
    let loose = plain().with_number("tolerance", 1e-3);
    let two_step = loose.clone().with("kind", text("two-step"));
    let cases = [
        ("forward-euler", "forward-euler", plain(), 0.01),
        ("symplectic-euler", "symplectic-euler", plain(), 0.01),
        ("central-difference", "central-difference", plain(), 0.01),
        ("rk4", "rk4", plain(), 0.01),
        ("modified-leapfrog", "modified-leapfrog", plain(), 0.01),
        ("cnn", "cnn", plain(), 0.01),
        ("cnn-symplectic", "cnn-symplectic", plain(), 0.01),
        ("cnn-stabilised", "cnn-stabilised", full.clone(), 0.01),
        (
            "cnn-stabilised-jacobi",
            "cnn-stabilised",
            stabilised("jacobi", 8.0),
            0.1,
        ),
        (
            "cnn-stabilised-chebyshev",
            "cnn-stabilised",
            stabilised("chebyshev", 8.0),
            0.1,
        ),
        ("propagator", "propagator", loose, 0.2),
        ("propagator-two-step", "propagator", two_step, 0.2),
        (
            "substeps",
            "symplectic-euler",
            plain().with_number("substeps", 3.0),
            0.03,
        ),
        (
            "guarded",
            "central-difference",
            plain().with_number("saturation", 2.0),
            0.01,
        ),
    ];
    for (name, id, options, dt) in cases {
        if id == "propagator" && name.ends_with("two-step") {
            // It takes loads that are constant over a step.
            let steady = LinearModel::new(LinearOperators::oscillator(MASS, 100.0, 1.0).unwrap());
            insta::assert_snapshot!(name, printed(&steady, id, &options, dt, 3));
            continue;
        }
        insta::assert_snapshot!(name, printed(&undamped_in_k, id, &options, dt, 3));
    }
    let every_damping = printed(
        &oscillator(0.002, true),
        "central-difference",
        &plain(),
        0.01,
        3,
    );
    insta::assert_snapshot!("central-difference-with-every-damping", every_damping);
}

#[test]
fn methods_without_sweeps_have_no_program() {
    let system = oscillator(0.0, false);
    let krylov = plain().with("kind", OptionValue::Text("krylov".into()));
    let ordered = plain()
        .with_number("s", 1.0)
        .with("inner", inner("gauss-seidel", Some(1.0)));
    let mut cases = vec![("cnn-stabilised", ordered)];
    if cfg!(feature = "implicit") {
        cases.extend(
            ["implicit-euler", "newmark", "generalized-alpha", "modal"].map(|id| (id, plain())),
        );
    }
    let steady = LinearModel::new(LinearOperators::oscillator(MASS, 100.0, 1.0).unwrap());
    for (id, options) in cases {
        let mut integrator = sinew_integrators::build(id, &options).unwrap();
        integrator.prepare(&system, 0.01).unwrap();
        assert!(integrator.program().is_none(), "`{id}`");
    }
    let mut integrator = sinew_integrators::build("propagator", &krylov).unwrap();
    integrator.prepare(&steady, 0.01).unwrap();
    assert!(integrator.program().is_none());
}

/// The coefficient of a term on a printed line: 0 if absent.
fn coefficient(line: &str, term: &str) -> f64 {
    let line = line.replace(" - ", " + -").replace(['(', ')'], "");
    let (_, sum) = line.split_once(['=', '-']).unwrap_or(("", &line));
    let sum = sum
        .trim_start_matches(['=', '-', ' '])
        .trim_start_matches("M^-1 ");
    let terms = sum.split(" + ").filter_map(|part| {
        let factor = part.trim().strip_suffix(term)?;
        Some(match factor.trim() {
            "" => 1.0,
            "-" => -1.0,
            number => number.parse().ok()?,
        })
    });
    terms.sum()
}

/// `(1 + alpha dt/2) v+ = (1 - alpha dt/2) v- + dt M^-1 (F - K u)`, then `u += dt v+` (Belytschko, Liu and
/// Moran, Nonlinear Finite Elements, section 6.2).
#[test]
fn central_difference_prints_the_textbook_coefficients() {
    let dt = 0.01;
    let text = printed(
        &oscillator(0.0, false),
        "central-difference",
        &plain(),
        dt,
        17,
    );
    let step = text.split_once("\nstep\n").unwrap().1;
    let line = |start: &str| {
        let mut lines = step.lines().map(|line| line.trim_start_matches([' ', '1']));
        lines.find(|line| line.starts_with(start)).unwrap()
    };
    let (q, v, u) = (line("q = "), line("v <- "), line("u <- "));
    let (v, u) = (v.replace("<-", "="), u.replace("<-", "="));
    let of_q = coefficient(&v, "q");
    let close = |found: f64, expected: f64| {
        assert!(
            (found - expected).abs() <= 1e-15,
            "{found} {expected}\n{step}"
        );
    };
    let divisor = 1.0 + MASS_DAMPING * dt / 2.0;
    close(of_q * coefficient(q, "Ft"), dt / divisor);
    close(of_q * coefficient(q, "K u"), -dt / divisor);
    let kept = coefficient(&v, "v") + of_q * coefficient(q, "M v");
    close(kept, (1.0 - MASS_DAMPING * dt / 2.0) / divisor);
    close(coefficient(&u, "u"), 1.0);
    close(coefficient(&u, "v"), dt);
}

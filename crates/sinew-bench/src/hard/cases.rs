//! The list of hard cases: their scenes, methods and steps.

use sinew_measure::MethodChoice;

use super::methods::{block, chebyshev, cnn, cut, energy, gauss_seidel, guarded, patched};

/// A scene with its runs.
pub(crate) struct HardCase {
    /// The scene's file, from the folder of scenes.
    pub(crate) scene: &'static str,
    pub(crate) methods: Vec<MethodChoice>,
    /// Steps (s).
    pub(crate) steps: &'static [f64],
    /// True if a quick run leaves the case out, because its reference alone takes seconds.
    pub(crate) slow: bool,
}

/// The methods for cases of the paper's own kind.
fn rivals() -> Vec<MethodChoice> {
    vec![
        cnn(),
        block(),
        chebyshev(4),
        chebyshev(8),
        gauss_seidel(4),
        MethodChoice::new("central-difference"),
        cut("central-difference"),
        cut("modified-leapfrog"),
        MethodChoice::new("newmark"),
        MethodChoice::new("implicit-euler"),
    ]
}

/// The rivals, and the method that treats bad elements separately.
fn rivals_and_patches() -> Vec<MethodChoice> {
    let mut methods = rivals();
    methods.push(patched());
    methods
}

/// The rivals, and methods with a guard.
fn rivals_and_guards() -> Vec<MethodChoice> {
    let mut methods = rivals();
    methods.extend(["central-difference", "cnn", "cnn-symplectic"].map(guarded));
    methods
}

/// Methods for undamped motion, most of which conserve their energy.
fn conservative() -> Vec<MethodChoice> {
    vec![
        block(),
        chebyshev(4),
        chebyshev(8),
        energy(4),
        MethodChoice::new("central-difference"),
        MethodChoice::new("newmark"),
        MethodChoice::new("implicit-euler"),
    ]
}

/// Methods for damping that no explicit step can follow.
fn stiffly_damped() -> Vec<MethodChoice> {
    vec![
        cnn(),
        block(),
        chebyshev(8),
        chebyshev(16),
        chebyshev(32),
        MethodChoice::new("central-difference"),
        cut("central-difference"),
        MethodChoice::new("newmark"),
        MethodChoice::new("implicit-euler"),
    ]
}

/// The hard cases, in the order of the pass marks.
pub(crate) fn all() -> Vec<HardCase> {
    let case = |scene, methods, steps: &'static [f64]| HardCase {
        scene,
        methods,
        steps,
        slow: false,
    };
    let slow = |case: HardCase| HardCase { slow: true, ..case };
    vec![
        case("paper-cube.toml", rivals(), &[0.02]),
        case("hard/undamped.toml", conservative(), &[0.05, 0.25, 2.5]),
        slow(case("hard/critical-damping.toml", rivals(), &[0.02])),
        case(
            "hard/stiffness-damping-0.49.toml",
            stiffly_damped(),
            &[0.02],
        ),
        slow(case(
            "hard/stiffness-damping-0.499.toml",
            stiffly_damped(),
            &[0.02],
        )),
        case("hard/no-sliver.toml", rivals_and_patches(), &[0.005]),
        case("hard/sliver-20.toml", rivals_and_patches(), &[0.005]),
        case("hard/sliver-100.toml", rivals_and_patches(), &[0.005]),
        case("hard/sliver-1000.toml", rivals_and_patches(), &[0.005]),
        slow(case(
            "hard/stiff-inclusion.toml",
            rivals_and_patches(),
            &[0.005, 0.02],
        )),
        case("hard/nearly-free.toml", rivals(), &[0.01, 0.02]),
        case("hard/impulsive-tool.toml", rivals_and_guards(), &[0.02]),
        case("hard/released-bar.toml", conservative(), &[0.005, 0.02]),
        case("hard/long-run.toml", conservative(), &[0.005, 0.01]),
        slow(case("hard/symmetric-load.toml", rivals(), &[0.02])),
    ]
}

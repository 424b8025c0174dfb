//! Mistakes in `[oscillator]`.

use super::refusal;
use super::scenes::OSCILLATOR;

#[test]
fn no_mass() {
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "mass = 0.1", "mass = 0"),
        @"scene.toml:2: [oscillator]: mass = 0: expected a finite mass above 0 kg"
    );
}

#[test]
fn negative_damping() {
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "damping = 1.0", "damping = -1.0"),
        @"scene.toml:4: [oscillator]: damping = -1.0: expected a finite damping, 0 N s/m or above"
    );
}

#[test]
fn no_velocity() {
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "velocity = -5.0\n", ""),
        @"scene.toml:1: [oscillator]: `velocity` is missing: expected a finite velocity in m/s"
    );
}

#[test]
fn infinite_force() {
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "velocity = -5.0", "velocity = -5.0\nforce = inf"),
        @"scene.toml:6: [oscillator]: force = inf: expected a finite force in N"
    );
}

#[test]
fn unknown_key() {
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "stiffness = 100.0", "spring = 100.0"),
        @"
    scene.toml:3: [oscillator]: unknown key `spring`
    help: the keys here are `mass`, `stiffness`, `damping`, `displacement`, `velocity`, `force`
    "
    );
}

#[test]
fn a_load_on_an_oscillator() {
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "[run]", "[[load]]\ngroup = \"top\"\n[run]"),
        @"scene.toml:6: `load` does not go with [oscillator]"
    );
}

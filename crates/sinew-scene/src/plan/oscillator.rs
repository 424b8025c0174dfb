//! Sections about the oscillator: its numbers, its force and its initial state.

use super::section::PlanSection;
use crate::scene::Oscillator;

/// The sections about an oscillator.
pub(super) fn sections(oscillator: &Oscillator) -> Vec<PlanSection> {
    let Oscillator {
        mass,
        stiffness,
        damping,
        displacement,
        velocity,
        force,
    } = oscillator;
    let parts = format!("{mass} kg on {stiffness} N/m and {damping} N s/m: one cell, one layer");
    let mut sections = vec![PlanSection::new("oscillator", vec![parts])];
    if *force != 0.0 {
        sections.push(PlanSection::new(
            "force",
            vec![format!("{force} N from t = 0")],
        ));
    }
    let start = format!("u = {displacement} m, v = {velocity} m/s");
    sections.push(PlanSection::new("initial", vec![start]));
    sections
}

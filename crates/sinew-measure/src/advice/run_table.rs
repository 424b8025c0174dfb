//! A run as a scene writes it.

use crate::case::Span;
use crate::method_choice::MethodChoice;

/// The table `[run]` of a scene that runs a method in steps of `dt` (s), in TOML.
#[must_use]
pub fn run_table(span: Span, method: &MethodChoice, dt: f64) -> String {
    let Span { duration, samples } = span;
    // Debug prints the digits that read back as the same number.
    let mut table = format!(
        "[run]\nduration = {duration:?}\nsamples = {samples}\nintegrator = \"{}\"\ndt = {dt:?}\n",
        method.integrator
    );
    for (key, value) in method.options.iter() {
        table.push_str(&format!("{key} = {value}\n"));
    }
    table
}

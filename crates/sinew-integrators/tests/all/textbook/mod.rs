//! Textbook cases, by many methods.

#[cfg(feature = "implicit")]
mod base_excitation;
mod energy;
mod invariance;
mod late_loads;
#[cfg(feature = "implicit")]
mod moved_parts;
#[cfg(feature = "implicit")]
mod moved_supports;
#[cfg(feature = "implicit")]
mod numerical_dissipation;

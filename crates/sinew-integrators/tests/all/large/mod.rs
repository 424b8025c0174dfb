//! Large deformation.

#[cfg(feature = "implicit")]
mod compressed;
mod following_pressure;
mod large_motion;
#[cfg(feature = "implicit")]
mod moved_to_a_limit;
#[cfg(feature = "implicit")]
mod relaxing_tissue;
#[cfg(feature = "implicit")]
mod stiffness_damping;
#[cfg(feature = "implicit")]
mod without_a_factor;

//! Large deformation.

mod added_laws;
mod bodies_with_axes;
mod closed_forms;
mod damping;
mod fastest_waves;
mod fibrous_bodies;
mod hyperelastic_bodies;
mod relaxing_bodies;

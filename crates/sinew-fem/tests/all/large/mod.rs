//! Large deformation.

mod added_laws;
mod bodies_with_axes;
mod damping;
mod fibrous_bodies;
mod hyperelastic_bodies;
mod relaxing_bodies;

//! Large deformation.

mod damping;
mod fibrous_bodies;
mod hyperelastic_bodies;
mod laws_on_vectors;
mod relaxing_bodies;

//! Large deformation.

mod damping;
mod fibrous_bodies;
mod hyperelastic_bodies;
mod relaxing_bodies;

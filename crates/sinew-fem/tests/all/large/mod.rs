//! Large deformation.

mod added_laws;
mod closed_forms;
mod damping;
mod fibrous_bodies;
mod hyperelastic_bodies;
mod relaxing_bodies;

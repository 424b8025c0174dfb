//! The subjects of the verification, one file each.

mod affine;
mod cantilever;
mod cook;
mod energy;
mod free_cube;
mod held_cube;
mod oscillator;
mod pressure;
mod propagation;
mod springs;
mod wave;

use super::subject::Subject;

/// All subjects, in the order of the page.
pub(super) const SUBJECTS: &[Subject] = &[
    affine::SUBJECT,
    cantilever::SUBJECT,
    cook::SUBJECT,
    held_cube::SUBJECT,
    free_cube::SUBJECT,
    pressure::SUBJECT,
    oscillator::SUBJECT,
    wave::SUBJECT,
    propagation::SUBJECT,
    energy::SUBJECT,
    springs::SUBJECT,
];

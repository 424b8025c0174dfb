//! The subjects of the verification, one file each.

mod affine;
mod axes;
mod bent_beam;
mod bonded_block;
mod cantilever;
mod contact;
mod convergence;
mod cook;
mod cutting;
mod energy;
mod fibres;
mod free_cube;
mod free_tools;
mod full_strokes;
mod hanging_bar;
mod haptics;
mod held_cube;
mod hertz;
mod hyperelastic;
mod incompressible;
mod large_motion;
mod memory;
mod oscillator;
mod pressure;
mod propagation;
mod slits;
mod springs;
mod tissue_laws;
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
    convergence::SUBJECT,
    oscillator::SUBJECT,
    wave::SUBJECT,
    propagation::SUBJECT,
    energy::SUBJECT,
    springs::SUBJECT,
    hyperelastic::SUBJECT,
    fibres::SUBJECT,
    axes::SUBJECT,
    memory::SUBJECT,
    hanging_bar::SUBJECT,
    bonded_block::SUBJECT,
    bent_beam::SUBJECT,
    large_motion::SUBJECT,
    incompressible::SUBJECT,
    tissue_laws::SUBJECT,
    hertz::SUBJECT,
    contact::SUBJECT,
    cutting::SUBJECT,
    slits::SUBJECT,
    haptics::SUBJECT,
];

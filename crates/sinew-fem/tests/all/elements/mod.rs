//! Elements against closed forms.

mod affine_tensor;
mod cube_figures;
mod manufactured_solution;
mod patch_test;
mod rigid_modes;
mod scales;
mod smoothed_elements;
mod strain_and_stress;
mod sums;

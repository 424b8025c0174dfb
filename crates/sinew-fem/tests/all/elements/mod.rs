//! Elements against closed forms.

mod affine_tensor;
mod scales;
mod smoothed_elements;
mod strain_and_stress;
mod sums;

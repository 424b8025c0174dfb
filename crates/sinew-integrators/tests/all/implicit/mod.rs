//! Implicit methods.

mod generalized_alpha;
mod linear;
mod newton;
mod soft_tissue;

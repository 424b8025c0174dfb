//! Soft tissue as a cellular neural network (Zhang, Zhong, Smith and Gu, Technology and Health
//! Care 25, 2017, S337-S344): every mesh node is a cell that knows only its neighbours.
//!
//! `M a + D v + K u = F` becomes `dy/dt = f(x)`, `dx/dt = A y - C x + B F` with the templates
//! `A = -M^-1 K`, `C = M^-1 D`, `B = M^-1`, the state x being the velocity, the output y the
//! displacement, and f a clamp at the saturation voltage Q. With three degrees of freedom a node
//! is one cell of a three-layer network whose layers are coupled: a template entry is a 3x3 block.
//!
//! ```
//! use sinew_cnn::{Saturation, Templates};
//! use sinew_core::{LinearModel, LinearOperators};
//!
//! let model = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0)?);
//! let templates = Templates::new(&model)?;
//! assert_eq!(templates.feedback().block(0, 0), Some(&[-1000.0][..])); // -k/m
//! assert_eq!(templates.damping().block(0, 0), Some(&[10.0][..])); // d/m
//! assert_eq!(templates.control(), [10.0]); // 1/m
//!
//! let saturation = Saturation::at(4.0)?; // m/s
//! assert_eq!(saturation.output(-5.0), -4.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod blocks;
#[cfg(any(test, feature = "conformance"))]
pub mod conformance;
mod equilibrium;
mod gauss_seidel;
mod machine;
mod majorant;
mod power_iteration;
mod program;
mod rigid;
mod saturation;
mod slowest;
mod stabiliser;
mod templates;

pub use blocks::CellBlocks;
pub use equilibrium::{Equilibrium, equilibrium};
pub use machine::{FollowedLoad, Machine, ReferenceMachine, StepTime};
pub use majorant::{Blend, DampingShare, GammaRule, Majorant};
pub use power_iteration::largest_eigenvalue;
pub use program::{
    CellInertia, Clamp, Forces, LoadAt, Loads, Moments, OwnTerm, Physics, Product, Program,
    Quotient, Register, Sweep, Term, Traffic, Update, Weight, When,
};
pub use rigid::{Deflation, Projection, RigidMotions};
pub use saturation::{Saturation, SaturationError};
pub use stabiliser::{Inner, Inverse, Slowing, Solution, Stabiliser};
pub use templates::{TemplateError, Templates};

#[cfg(test)]
#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;

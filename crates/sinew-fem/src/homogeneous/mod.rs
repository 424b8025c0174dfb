//! Homogeneous loads of a material: curves to check a law before a run.
//!
//! | load | deformation, with the pull along the first axis | free |
//! | --- | --- | --- |
//! | uniaxial | a bar whose line along the pull is stretched | all but that line |
//! | equibiaxial | a sheet that is stretched alike along two axes | its thickness |
//! | planar (pure shear) | a wide sheet that is stretched along one axis and held along the other | its thickness |
//! | simple shear | `F = I + g e1 (x) e2` | nothing |
//!
//! Free strains are those at which their stresses vanish, computed from the law with its real compressibility
//! (Holzapfel, Nonlinear Solid Mechanics, 2000, section 6.5; Ogden, Saccomandi and Sgura, Computational Mechanics 34,
//! 2004). The other axes of a bar may turn and shear, so a bar with oblique fibres is sheared when it is pulled: `S = s
//! e1 (x) e1` is the second Piola-Kirchhoff stress of a bar with free sides, whatever its symmetry.
//!
//! ```
//! use sinew_fem::homogeneous::{Axes, Load, Solid};
//! use sinew_fem::{Law, Region};
//!
//! let region = Region::new(Law::linear(3500.0, 0.45), 1060.0); // Pa, kg/m3
//! let solid = Solid::of(&region)?;
//! let curve = solid.curve(Load::Uniaxial, &Axes::along([1.0, 0.0, 0.0])?, [0.9, 1.1], &[]);
//! assert!((curve.at(1.1).expect("a point of the curve") - 350.0).abs() < 1e-9); // Pa
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axes;
mod curve;
mod equilibrium;
mod error;
mod load;
mod solid;
mod stability;

pub use axes::Axes;
pub use curve::{Curve, End, LoadState};
pub use error::HomogeneousError;
pub use load::Load;
pub use solid::Solid;

#[cfg(test)]
mod tests;

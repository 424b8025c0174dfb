//! Laws of large deformation: energies of the deformation gradient, their stresses and tangents.
//!
//! ```
//! use sinew_fem::hyperelastic::{HyperelasticLaw, NeoHookean, Parameters, Tensor};
//!
//! let law = NeoHookean::new(&Parameters::new(3500.0, 0.45))?; // Pa
//! // Held at the sides and pressed to .9 of its height.
//! let at = law.at(Tensor::<f64>::of([[0.0; 3], [0.0; 3], [0.0, 0.0, -0.1]]));
//! let stress = law.stress_with(&at, law.own_bulk(&at));
//! let (lambda, mu) = law.lame();
//! let expected: f64 = mu * (0.9 - 1.0 / 0.9) - 0.1 * lambda;
//! assert!((stress.0[2][2] - expected).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod arruda_boyce;
pub(crate) mod boxed;
#[cfg(any(test, feature = "conformance"))]
pub mod conformance;
pub(crate) mod corotational;
mod decomposition;
mod deformation;
pub mod fibres;
mod first_invariant;
pub(crate) mod fung;
pub(crate) mod gent;
mod isochoric;
pub(crate) mod law;
mod law_at;
pub(crate) mod law_error;
pub(crate) mod mooney_rivlin;
pub(crate) mod neo_hookean;
pub(crate) mod neo_hookean_iso;
pub(crate) mod neo_hookean_log;
pub(crate) mod ogden;
pub(crate) mod parameters;
mod powers;
mod projection;
pub mod prony;
#[cfg(test)]
mod same;
mod samples;
mod second_invariant;
mod semidefinite;
pub(crate) mod stable_neo_hookean;
pub(crate) mod stable_neo_hookean_log;
mod stretches;
pub(crate) mod stvk;
pub(crate) mod tensor;
pub(crate) mod veronda_westmann;
mod viscous;
mod volume;
pub(crate) mod yeoh;

pub use crate::law_registry::{
    Hyperelastic, KEYS_OF_REGIONS, KnownLaw, MakeBoxed, RegisterError, known_law, known_laws,
    register, register_boxed,
};
pub use crate::orthotropic::Orthotropic;
pub use arruda_boyce::ArrudaBoyce;
pub use boxed::{Boxed, PointLaw};
pub use corotational::Corotational;
pub use decomposition::SingularValues;
pub(crate) use decomposition::rotation;
pub use deformation::Deformation;
pub use fung::Fung;
pub use gent::Gent;
pub(crate) use law::SMALLEST_MARGIN;
pub use law::{Bulk, HyperelasticLaw, NodeBlock, Point, SMALLEST_VOLUME_RATIO};
pub(crate) use law_at::{LawAt, OwnAt};
pub use law_error::LawError;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::NeoHookean;
pub use neo_hookean_iso::NeoHookeanIso;
pub use neo_hookean_log::NeoHookeanLog;
pub use ogden::Ogden;
pub use parameters::{
    Column, LawParameter, LawValues, ParameterError, Parameters, Presence, Range,
};
pub(crate) use projection::{Linearised, projects};
pub use projection::{Projection, TangentKind};
pub use samples::sample_deformations;
pub(crate) use semidefinite::semidefinite;
pub use stable_neo_hookean::StableNeoHookean;
pub use stable_neo_hookean_log::StableNeoHookeanLog;
pub use stvk::Stvk;
pub use tensor::Tensor;
pub(crate) use tensor::dot;
pub use veronda_westmann::VerondaWestmann;
pub(crate) use viscous::Viscous;
pub use yeoh::Yeoh;

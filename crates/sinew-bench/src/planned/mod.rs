//! Cases that are planned for each scene, each with its own methods, steps, materials and finer meshes.

mod case;
mod material;
mod mesh_error;
mod methods;
mod plan;
mod running;

pub(crate) use self::case::{FinerMeshes, PlannedCase};
pub(crate) use self::material::Material;
pub(crate) use self::methods::{energy, is_yardstick, with, yardstick};
pub(crate) use self::plan::Plan;

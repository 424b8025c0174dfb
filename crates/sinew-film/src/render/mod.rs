//! Rendering of triangles to pixels.

mod camera;
mod contact;
mod fit;
mod floor;
mod light;
mod model;
mod mottle;
mod paint;
mod raster;
mod resolve;
mod shadow;

pub(crate) use camera::Camera;
pub(crate) use fit::{Room, fitted};
pub(crate) use floor::BACKGROUND;
pub(crate) use model::{Model, Paint, Vertex};
pub(crate) use paint::colour_of;
pub(crate) use resolve::{Stage, draw};

//! Pictures of a body: its surface, with colours.

mod colours;
mod section;
mod surface;
mod twins;

pub(crate) use colours::{Colours, Seen};
pub(crate) use section::{Plane, Section};
pub(crate) use surface::Surface;
pub(crate) use twins::twins;

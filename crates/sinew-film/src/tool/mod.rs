//! Instruments and their motion.

mod instrument;
mod motion;
mod part;
mod solid;
mod strokes;

pub use instrument::Tool;
pub use motion::{PoseAt, poses_of_table};
pub use part::{Part, Shape};
pub use strokes::{back_of, blades_of_strokes};

pub(crate) use part::placed;
pub(crate) use solid::{Solid, solid};

//! Files of pictures and films.

mod animation;
mod colours;
mod single;
mod software;

pub(crate) use animation::Animation;
pub(crate) use colours::Colours;
pub use single::is_own_png;

//! Files of pictures and films.

mod animation;
mod colours;
mod single;

pub(crate) use animation::Animation;
pub(crate) use colours::Colours;
pub use single::is_own_png;

/// What the files say of who wrote them: a keyword of the PNG standard, and the program.
const SOFTWARE: [&str; 2] = ["Software", "sinew film"];

//! Keys that several parts of a scene use.

/// The key of gravity, which is also its name among the loads.
pub(crate) const GRAVITY: &str = "gravity";

/// Keys that must be at the top of the file: further down, TOML assigns them to the table above.
pub(crate) const AT_THE_TOP: [&str; 2] = ["title", GRAVITY];

//! A page in a browser on which the user presses tissue in a running simulation.
//!
//! [`Live`] builds one or two [`sinew_world::World`]s of a scene, serves a page on this computer only, and steps the
//! sessions in real time under the commands of the page. A page gets pictures only as fast as it draws them: it begins
//! with two credits, each picture takes one, and each drawn picture gives one back.
//!
//! [`Start`] serves a page that offers scenes. It and sessions use one [`Door`], the address, one after the other.

mod clients;
mod door;
mod ended;
mod engine;
mod error;
mod hand_speed;
mod inbox;
mod live;
mod new_tool;
mod next_draw;
mod offers;
mod pane_choice;
mod picture;
mod protocol;
mod scene_values;
mod scenery;
mod server;
mod start;
mod tool_facts;

pub use door::Door;
pub use ended::Ended;
pub use error::LiveError;
pub use live::{Live, Settings};
pub use offers::{Offer, Offers, Pace};
pub use pane_choice::PaneChoice;
pub use start::Start;

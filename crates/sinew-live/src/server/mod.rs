//! The server of the page, for this computer only.

mod assets;
mod guard;
mod guests;
mod routes;
mod shared;
mod socket;
mod token;

pub(crate) use guests::{Guests, Standing};
pub(crate) use routes::router;
pub(crate) use shared::Shared;
pub(crate) use token::Token;

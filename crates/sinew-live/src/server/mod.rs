//! The servers of the pages, for this computer only.

mod answers;
mod assets;
mod guard;
mod guests;
mod routes;
mod serving;
mod shared;
mod socket;
mod start_routes;
mod token;

pub(crate) use routes::router;
pub(crate) use serving::{runtime, serve};
pub(crate) use shared::Shared;
pub(crate) use start_routes::start_router;
pub(crate) use token::Token;

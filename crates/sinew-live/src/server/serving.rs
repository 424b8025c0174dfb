//! The time for which a server answers.

use std::future::IntoFuture;
use std::io;
use std::pin::pin;

use axum::Router;
use futures_util::future::{Either, select};
use tokio::net::TcpListener;
use tokio::runtime::{Builder, Runtime};

use super::guests::{Guests, Standing};

/// A runtime with one thread, that of the caller.
pub(crate) fn runtime() -> io::Result<Runtime> {
    Builder::new_current_thread().enable_all().build()
}

/// Answers requests at a listener until `end` is ready.
///
/// # Errors
/// Errors of the listener.
pub(crate) fn serve(
    runtime: &Runtime,
    listener: std::net::TcpListener,
    router: Router,
    end: impl Future<Output = ()>,
) -> io::Result<()> {
    let service = router.into_make_service_with_connect_info::<Standing>();
    runtime.block_on(async {
        let guests = Guests::of(TcpListener::from_std(listener)?);
        let server = pin!(axum::serve(guests, service).into_future());
        match select(server, pin!(end)).await {
            Either::Left((outcome, _)) => outcome,
            Either::Right(_) => Ok(()),
        }
    })
}

//! The start page, which offers scenes.

use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use tokio::runtime::Runtime;

use crate::door::Door;
use crate::error::LiveError;
use crate::offers::{Counter, Offers, Pace};
use crate::server::{Token, runtime, serve, start_router};

/// Time between two checks for a choice or a request to end.
const LOOK: Duration = Duration::from_millis(20);

/// A page that offers scenes until one is chosen. Meanwhile a thread measures their paces one after the other.
pub struct Start {
    runtime: Runtime,
    listener: TcpListener,
    token: Token,
    offers: Arc<Offers>,
}

impl Start {
    /// Prepares a page at this address.
    ///
    /// # Errors
    /// [`LiveError::Serve`] if the system refuses a timer or a connection.
    pub fn open(door: &Door, offers: Arc<Offers>) -> Result<Self, LiveError> {
        Ok(Self {
            runtime: runtime().map_err(LiveError::Serve)?,
            listener: door.listener().map_err(LiveError::Serve)?,
            token: door.token(),
            offers,
        })
    }

    /// Serves the page until a scene is chosen, and returns its number; `None` if `ends` returned true before.
    ///
    /// `measure` gets the number of a scene and a function that returns true when it must stop, which it must ask often.
    /// It returns the pace, or `None` if it found none.
    ///
    /// # Errors
    /// [`LiveError::Serve`] if the system refuses a thread or a connection.
    pub fn run(
        self,
        measure: impl Fn(usize, &dyn Fn() -> bool) -> Option<f64> + Send + 'static,
        ends: impl Fn() -> bool,
    ) -> Result<Option<usize>, LiveError> {
        let counter = Arc::new(Counter::new(Arc::clone(&self.offers)));
        let is_over = Arc::new(AtomicBool::new(false));
        let (offers, is_measured) = (self.offers, Arc::clone(&is_over));
        // Nobody waits for the thread: it ends between two steps, or after it has built a scene.
        thread::Builder::new()
            .name("paces".to_owned())
            .spawn(move || measure_all(&offers, &is_measured, measure))
            .map_err(LiveError::Serve)?;
        let router = start_router(Arc::clone(&counter), self.token);
        let outcome = serve(&self.runtime, self.listener, router, async {
            let mut look = tokio::time::interval(LOOK);
            while !ends() && counter.chosen().is_none() {
                look.tick().await;
            }
            is_over.store(true, Ordering::Relaxed);
            // The page gets its answer.
            tokio::time::sleep(2 * LOOK).await;
        });
        is_over.store(true, Ordering::Relaxed);
        self.runtime.shutdown_background();
        outcome.map_err(LiveError::Serve)?;
        Ok(counter.chosen())
    }
}

/// Measures the paces that are not known yet.
fn measure_all(
    offers: &Offers,
    is_over: &AtomicBool,
    measure: impl Fn(usize, &dyn Fn() -> bool) -> Option<f64>,
) {
    let ends = || is_over.load(Ordering::Relaxed);
    while let Some(index) = offers.unmeasured() {
        if ends() {
            return;
        }
        offers.set_pace(index, Pace::Runs);
        let pace = measure(index, &ends);
        if ends() {
            // The next start page measures it again.
            return;
        }
        offers.set_pace(index, pace.map_or(Pace::Unknown, Pace::Measured));
    }
}

//! Measuring on one thread.

/// The thread to measure on could not be started.
#[derive(Debug, thiserror::Error)]
#[error("the measuring thread could not be started: {0}")]
pub struct ThreadError(#[source] StartError);

#[cfg(feature = "rayon")]
type StartError = rayon::ThreadPoolBuildError;
#[cfg(not(feature = "rayon"))]
type StartError = std::convert::Infallible;

/// Does some work on a pool of one thread. Products may use a thread pool; one thread keeps times
/// and counts comparable.
///
/// # Errors
/// [`ThreadError`] when the thread cannot be started.
pub fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, ThreadError> {
    #[cfg(feature = "rayon")]
    {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.map_err(ThreadError)?;
        Ok(pool.install(work))
    }
    // Without the feature nothing here starts a thread.
    #[cfg(not(feature = "rayon"))]
    Ok(work())
}

//! Measuring on one thread.

/// No thread to measure on.
#[derive(Debug, thiserror::Error)]
#[error("the measuring thread could not be started: {0}")]
pub struct ThreadError(String);

/// Does some work on a pool of one thread. Products may use a thread pool; one thread keeps times
/// and counts comparable.
///
/// # Errors
/// [`ThreadError`] when the thread cannot be started.
pub fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, ThreadError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|error| ThreadError(error.to_string()))?;
    Ok(pool.install(work))
}

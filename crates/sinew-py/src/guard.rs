//! Guards at the border to Python: panics become exceptions, and a process that was forked computes with threads of its own.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::InternalError;

static IS_FORKED: AtomicBool = AtomicBool::new(false);

/// Records that this process is the child of a fork, in which the threads of its parent do not run.
#[pyfunction(name = "_forked")]
pub(crate) fn forked() {
    IS_FORKED.store(true, Ordering::Relaxed);
}

/// Runs a function of the library: a panic becomes an exception.
pub(crate) fn guarded<T: Send>(act: impl FnOnce() -> PyResult<T> + Send) -> PyResult<T> {
    let act = || match IS_FORKED.load(Ordering::Relaxed) {
        false => act(),
        true => match own_threads() {
            Some(threads) => threads.install(act),
            None => act(),
        },
    };
    guarded_here(act)
}

/// Runs a function like [`guarded`], for work that uses no threads.
pub(crate) fn guarded_here<T>(act: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(act)).unwrap_or_else(|panic| Err(internal(&*panic)))
}

/// The exception of a session after a panic.
pub(crate) fn unusable() -> PyErr {
    InternalError::new_err(
        "an internal error left this session unusable: open another one from the scene",
    )
}

fn internal(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let text = text.unwrap_or("no message");
    InternalError::new_err(format!(
        "internal error of sinew_sim {}: {text}; please report it, with the scene and what was called",
        env!("CARGO_PKG_VERSION")
    ))
}

fn own_threads() -> Option<&'static ThreadPool> {
    static OWN: OnceLock<Option<ThreadPool>> = OnceLock::new();
    OWN.get_or_init(|| ThreadPoolBuilder::new().build().ok())
        .as_ref()
}

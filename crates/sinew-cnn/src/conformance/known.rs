//! Stored results of the definition, shared by machines that are compared with the same programs.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use sinew_core::{State, StepReport};

/// Values by key, each computed only once.
#[derive(Debug)]
struct Once<K, V>(Mutex<HashMap<K, Arc<OnceLock<V>>>>);

impl<K, V> Default for Once<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Hash + Eq, V: Clone> Once<K, V> {
    fn get(&self, key: K, compute: impl FnOnce() -> V) -> V {
        let cell = {
            // A map is as sound after a failed test as before it.
            let mut cells = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(cells.entry(key).or_default())
        };
        cell.get_or_init(compute).clone()
    }
}

/// Name of a run of one method, and its number of steps.
type Key = (String, usize);

/// Reference results for the runs of one method.
#[derive(Debug, Default)]
pub(super) struct Known {
    ends: Once<Key, Arc<(State, StepReport)>>,
    growths: Once<Key, f64>,
}

impl Known {
    /// State and work at the end of a run, from its start.
    pub(super) fn end(
        &self,
        name: &str,
        steps: usize,
        compute: impl FnOnce() -> (State, StepReport),
    ) -> Arc<(State, StepReport)> {
        self.ends
            .get((name.to_owned(), steps), || Arc::new(compute()))
    }

    /// Growth of the distance between two motions.
    pub(super) fn growth(&self, name: &str, steps: usize, compute: impl FnOnce() -> f64) -> f64 {
        self.growths.get((name.to_owned(), steps), compute)
    }
}

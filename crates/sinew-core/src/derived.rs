//! Values computed once and shared.

use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

type Shared = Arc<dyn Any + Send + Sync>;

/// One value for each type, computed at the first request.
#[derive(Default)]
pub(crate) struct Derived(Mutex<HashMap<TypeId, Shared>>);

impl Derived {
    /// The value of type `T`.
    pub(crate) fn get<T: Send + Sync + 'static>(&self, compute: impl FnOnce() -> T) -> Arc<T> {
        if let Some(known) = self.known() {
            return known;
        }
        // Computed outside the lock, since it may need other derived values.
        let value = Arc::new(compute());
        let shared: Shared = Arc::<T>::clone(&value);
        let mut values = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        values.insert(TypeId::of::<T>(), shared);
        value
    }

    fn known<T: Send + Sync + 'static>(&self) -> Option<Arc<T>> {
        let values = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(values.get(&TypeId::of::<T>())?).downcast().ok()
    }
}

/// A copy begins empty: it is made to be changed.
impl Clone for Derived {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl std::fmt::Debug for Derived {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Derived")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_type_is_computed_once() {
        let (derived, mut count) = (Derived::default(), 0);
        for _ in 0..3 {
            let value = derived.get(|| {
                count += 1;
                7_u32
            });
            assert_eq!(*value, 7);
        }
        assert_eq!((count, *derived.get(|| 2.5_f64)), (1, 2.5));
    }
}

//! Loads of a model with other factors over time.

use std::sync::Arc;

use sinew_core::{Load, Ramp};

use super::Model;
use crate::error::{FemError, Item};

impl Model {
    /// This model, with shared matrices, but with other factors over time for its loads and gravity: the result of
    /// `ramp` for each; `None` leaves it unchanged. Prescribed motions are unchanged.
    ///
    /// # Errors
    /// [`FemError`] for a ramp with a parameter outside its range.
    pub fn with_ramps(&self, ramp: impl Fn(Item) -> Option<Ramp>) -> Result<Self, FemError> {
        let other = |item: Item, own: &Ramp| match item {
            Item::Load(_) | Item::Gravity => ramp(item).unwrap_or_else(|| own.clone()),
            _ => own.clone(),
        };
        let loads = self.operators.loads().iter().zip(&self.load_items);
        let loads = loads.map(|(load, item)| Load {
            ramp: other(*item, &load.ramp),
            entries: load.entries.clone(),
        });
        let mut model = self.clone();
        model.operators = self
            .operators
            .with_loads(loads.collect())
            .map_err(|error| FemError::new(Item::Mesh, error.into()))?;
        for held in &mut model.supports.loads {
            held.ramp = other(held.item, &held.ramp);
        }
        let following = self.following.iter().map(|pressure| {
            let item = Item::Load(pressure.load);
            ramp(item).map_or_else(|| pressure.clone(), |ramp| pressure.with_ramp(ramp))
        });
        model.following = following.collect::<Arc<[_]>>();
        Ok(model)
    }
}

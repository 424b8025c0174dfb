//! The place of a table and its keys in the text.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use crate::error::{Fault, SceneError};
use crate::source::SceneSource;

/// The name of a table of a scene, and the byte range of the table and its keys in the text.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    scene: Arc<SceneSource>,
    name: String,
    header: Option<Range<usize>>,
    keys: BTreeMap<String, KeyPlace>,
}

#[derive(Debug, Clone)]
pub(super) struct KeyPlace {
    pub(super) key: Range<usize>,
    pub(super) value: Range<usize>,
}

impl Place {
    pub(super) fn new(
        scene: &Arc<SceneSource>,
        name: String,
        header: Option<Range<usize>>,
        keys: BTreeMap<String, KeyPlace>,
    ) -> Self {
        Self {
            scene: Arc::clone(scene),
            name,
            header,
            keys,
        }
    }

    pub(crate) fn scene(&self) -> &Arc<SceneSource> {
        &self.scene
    }

    /// The table as the user wrote it, e.g. `[[load]] 2`.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// An error that points at the whole table.
    pub(crate) fn fault(&self, fault: Fault) -> SceneError {
        self.error(self.header.clone(), fault)
    }

    /// An error that points at a key; at the table if the key is not given.
    pub(crate) fn key_fault(&self, key: &str, fault: Fault) -> SceneError {
        self.error(self.keys.get(key).map(|place| place.key.clone()), fault)
    }

    /// An error that points at a key's value; at the table if the key is not given.
    pub(crate) fn value_fault(&self, key: &str, fault: Fault) -> SceneError {
        self.error(self.keys.get(key).map(|place| place.value.clone()), fault)
    }

    /// The key that names the part of the body of the table.
    pub(crate) fn part_key(&self) -> &'static str {
        match self.keys.contains_key("where") {
            true => "where",
            false => "group",
        }
    }

    /// Line of a key, or of the table if the key is not given; counted from 1.
    pub(crate) fn line(&self, key: &str) -> Option<usize> {
        let span = self
            .keys
            .get(key)
            .map(|place| &place.key)
            .or(self.header.as_ref())?;
        Some(self.scene.position(span.start).0)
    }

    /// An error at these bytes of the scene, or at the table's header.
    pub(crate) fn error(&self, span: Option<Range<usize>>, fault: Fault) -> SceneError {
        let error = SceneError::new(&self.scene, fault).in_table(&self.name);
        match span.or_else(|| self.header.clone()) {
            Some(span) => error.at(span),
            None => error,
        }
    }
}

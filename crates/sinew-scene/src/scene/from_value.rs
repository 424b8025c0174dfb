//! Scenes from values without a text, and scenes as values.

use std::path::Path;
use std::sync::Arc;

use serde::ser::Error as _;
use serde::{Serialize, Serializer};
use serde_json::Value;

use super::Scene;
use crate::error::{Fault, SceneError};
use crate::source::SceneSource;

/// Name of the text that is made from values, in the folder of its paths.
const NAME: &str = "scene";

impl Scene {
    /// Reads a scene from a tree of values, such as a map of a program, with the same descriptions as from a text: maps
    /// are tables, and a list of maps is a list of tables. Relative paths start at `folder`.
    ///
    /// [`Scene::source`] is TOML that is made from the values, so that run folders and logs keep the scene. Errors name
    /// the key, such as `region[1].density`, with tables of a list counted from 1.
    ///
    /// # Errors
    /// [`SceneError`] for the first mistake, and for values that TOML cannot express, such as a map whose keys are not
    /// texts.
    ///
    /// ```
    /// use sinew_scene::Scene;
    ///
    /// let scene = Scene::from_value(
    ///     &serde_json::json!({
    ///         "mesh": { "cube": { "cells": 4, "edge": 0.1 } },
    ///         "region": [{ "density": 1000.0, "model": "linear", "youngs_modulus": 3000.0, "poissons_ratio": 0.4 }],
    ///         "fixed": [{ "group": "bottom" }],
    ///         "run": { "duration": 0.1, "integrator": "central-difference", "dt": "auto" },
    ///     }),
    ///     ".",
    /// )?;
    /// assert_eq!(scene.build()?.system().dofs(), 300);
    /// # Ok::<(), sinew_scene::SceneError>(())
    /// ```
    pub fn from_value(
        value: &impl Serialize,
        folder: impl AsRef<Path>,
    ) -> Result<Self, SceneError> {
        Self::parse(SceneSource::from_value(value, folder)?)
    }
}

impl SceneSource {
    /// A tree of values of a program as the text of a scene. Messages name its keys instead of lines.
    /// [`Scene::from_value`] reads one directly.
    ///
    /// # Errors
    /// [`SceneError`] for values that TOML cannot express.
    pub fn from_value(
        value: &impl Serialize,
        folder: impl AsRef<Path>,
    ) -> Result<Self, SceneError> {
        let path = folder.as_ref().join(NAME);
        let error = match toml::to_string(value) {
            Ok(text) => return Ok(Self::of_values(path, text)),
            Err(error) => error,
        };
        let reason = match null_in(value) {
            Some(path) => {
                format!("`{path}` is null: expected a value; leave the key out if there is none")
            }
            None => error.to_string(),
        };
        let nothing = Arc::new(Self::of_values(path, ""));
        Err(SceneError::new(&nothing, Fault::Values { reason }))
    }
}

/// The path of keys to the first null value, such as `region[1].density`.
fn null_in(value: &impl Serialize) -> Option<String> {
    let tree = serde_json::to_value(value).ok()?;
    null_below(&tree, String::new())
}

fn null_below(value: &Value, path: String) -> Option<String> {
    match value {
        Value::Null => Some(path).filter(|path| !path.is_empty()),
        Value::Array(items) => (1..)
            .zip(items)
            .find_map(|(number, item)| null_below(item, format!("{path}[{number}]"))),
        Value::Object(entries) => entries.iter().find_map(|(key, value)| {
            let dot = if path.is_empty() { "" } else { "." };
            null_below(value, format!("{path}{dot}{key}"))
        }),
        _ => None,
    }
}

/// Serializes as the tree of values of its document, which [`Scene::from_value`] reads.
///
/// ```
/// use sinew_scene::{Scene, SceneSource};
///
/// let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
///             [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";
/// let scene = Scene::parse(SceneSource::new("spring.toml", text))?;
/// let value = serde_json::to_value(&scene)?;
/// assert_eq!(value["run"]["dt"], 0.01);
/// assert_eq!(Scene::from_value(&value, ".")?.subject(), scene.subject());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl Serialize for Scene {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let document = self.source().text().parse::<toml::Table>();
        document.map_err(S::Error::custom)?.serialize(serializer)
    }
}

//! Scenes from values without a text, and as values.

use std::path::Path;

use serde::ser::Error as _;
use serde::{Serialize, Serializer};

use super::Scene;
use crate::error::SceneError;
use crate::source::SceneSource;

impl Scene {
    /// Reads a scene from a tree of values, such as a map of a program, by the same descriptions as from a text: maps are
    /// tables, and a list of maps is a list of tables. Relative paths start at `folder`.
    ///
    /// [`Scene::source`] is TOML that is made of the values, so that run folders and logs keep the scene. Errors name the key,
    /// such as `region[1].density`, with tables of a list counted from 1.
    ///
    /// # Errors
    /// [`SceneError`] for the first mistake, and for values that TOML does not have, such as a map whose keys are no texts.
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

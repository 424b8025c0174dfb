//! Reference of scenes for the user, and schema for editors, both written from the descriptions that the decoder uses.

mod examples;
mod markdown;
mod options;
mod schema;
mod sections;
#[cfg(test)]
mod tests;

use crate::scene::DOCUMENT;

/// Every table and key of a scene with its values, unit, default and an example, as Markdown.
#[must_use]
pub fn scene_reference() -> String {
    markdown::of(&DOCUMENT)
}

/// A JSON schema (draft 7) of scenes, for editors.
#[must_use]
pub fn scene_schema() -> String {
    format!("{:#}\n", schema::of(&DOCUMENT))
}

//! Errors of scenes, with their position in the text.

mod fault;
mod hint;
mod key_path;
mod motion_table;
mod no_step;
mod override_error;
mod tool_fault;
mod words;

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

pub use fault::Fault;
pub(crate) use fault::MOST_STEPS;
pub use motion_table::{MotionTableError, MotionTableFault};
pub use no_step::{NoStableStep, StableStepError};
pub use override_error::OverrideError;
pub use tool_fault::ToolFault;
pub(crate) use words::shortened;

use crate::source::SceneSource;

/// A scene that cannot be read or built.
///
/// Its [`Display`](fmt::Display) is one line: `path.toml:12: [[region]] 1: density = -3: expected
/// ..`. Programs that also show the text at fault find it in [`SceneError::source_text`] at
/// [`SceneError::span`].
#[derive(Debug, thiserror::Error)]
#[error("{}", Line(.0))]
pub struct SceneError(Box<Inner>);

#[derive(Debug)]
struct Inner {
    scene: Arc<SceneSource>,
    span: Option<Range<usize>>,
    table: String,
    fault: Fault,
    help: Option<String>,
}

impl SceneError {
    pub(crate) fn new(scene: &Arc<SceneSource>, fault: Fault) -> Self {
        Self(Box::new(Inner {
            scene: Arc::clone(scene),
            span: None,
            table: String::new(),
            help: hint::following_from(&fault),
            fault,
        }))
    }

    pub(crate) fn at(mut self, span: Range<usize>) -> Self {
        self.0.span = Some(span);
        self
    }

    pub(crate) fn in_table(mut self, table: &str) -> Self {
        table.clone_into(&mut self.0.table);
        self
    }

    pub(crate) fn with_help(mut self, help: impl Into<String>) -> Self {
        self.0.help = Some(help.into());
        self
    }

    /// The mistake.
    #[must_use]
    pub fn fault(&self) -> &Fault {
        &self.0.fault
    }

    /// The table at fault as the user wrote it, e.g. `[[load]] 2`; empty at the top of the file.
    #[must_use]
    pub fn table(&self) -> &str {
        &self.0.table
    }

    /// The path of the scene as the user gave it.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.0.scene.path()
    }

    /// The text of the scene; empty if it could not be read.
    #[must_use]
    pub fn source_text(&self) -> &str {
        self.0.scene.text()
    }

    /// The bytes of the text at fault; `None` if the fault concerns the whole document.
    #[must_use]
    pub fn span(&self) -> Option<Range<usize>> {
        self.0.span.clone()
    }

    /// True if the scene was made from values of a program: the message names a key, since the user has no lines.
    #[must_use]
    pub fn is_of_values(&self) -> bool {
        self.0.scene.is_of_values()
    }

    /// Line of [`SceneError::span`], counted from 1.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        Some(self.position()?.0)
    }

    /// Column of [`SceneError::span`] in characters, counted from 1.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        Some(self.position()?.1)
    }

    fn position(&self) -> Option<(usize, usize)> {
        let span = self.0.span.as_ref()?;
        Some(self.0.scene.position(span.start))
    }

    /// A remedy, if one is known.
    #[must_use]
    pub fn help(&self) -> Option<&str> {
        self.0.help.as_deref()
    }
}

struct Line<'a>(&'a Inner);

impl fmt::Display for Line<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Inner {
            scene,
            span,
            table,
            fault,
            ..
        } = self.0;
        if scene.is_of_values() {
            let path = span.as_ref();
            let path = path.and_then(|span| key_path::key_path(scene.text(), span.start));
            let place = path.as_deref().unwrap_or("the scene");
            return write!(f, "{place}: {}", one_line(&fault.to_string()));
        }
        write!(f, "{}:", scene.path().display())?;
        if let Some(span) = span {
            write!(f, "{}:", scene.position(span.start).0)?;
        }
        if !table.is_empty() {
            write!(f, " {table}:")?;
        }
        write!(f, " {}", one_line(&fault.to_string()))
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

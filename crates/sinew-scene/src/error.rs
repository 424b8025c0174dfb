//! What is wrong with a scene, and where.

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use crate::SceneSource;
use crate::nearest::nearest;
use crate::scene::GRAVITY;

/// A scene that cannot be read or built.
///
/// Its [`Display`](fmt::Display) is one line: `path.toml:12: [[region]] 1: density = -3: expected
/// ..`. Programs that show the scene's text beside it find that in [`SceneError::source_text`] and
/// the bytes at fault in [`SceneError::span`].
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
            help: fault.own_help(),
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

    /// What is wrong.
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

    /// The bytes of the text at fault, where there are any.
    #[must_use]
    pub fn span(&self) -> Option<Range<usize>> {
        self.0.span.clone()
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

    /// A hint at what to do, where there is one.
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

/// What is wrong with a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The scene file cannot be read.
    #[error("cannot read the scene: {0}")]
    Unreadable(std::io::Error),
    /// The text is not TOML.
    #[error("not TOML: {message}")]
    Syntax {
        /// What the TOML parser said.
        message: String,
    },
    /// A key that means nothing there.
    #[error("unknown key `{key}`{}", did_you_mean(*nearest))]
    UnknownKey {
        /// The key given.
        key: String,
        /// The most similar of the keys that mean something, if one is similar.
        nearest: Option<&'static str>,
        /// The keys that mean something.
        known: &'static [&'static str],
    },
    /// A key that must be there is not.
    #[error("`{key}` is missing: expected {expected}")]
    Missing {
        /// The key.
        key: &'static str,
        /// What to give it.
        expected: String,
    },
    /// A value that does not fit.
    #[error("{key} = {found}: expected {expected}")]
    Value {
        /// The key.
        key: String,
        /// The value as written.
        found: String,
        /// What fits.
        expected: String,
    },
    /// A value of the wrong type.
    #[error("{key} = {found}: expected {expected}, found {kind}")]
    Type {
        /// The key.
        key: String,
        /// The value as written.
        found: String,
        /// What fits.
        expected: String,
        /// The type of the value.
        kind: &'static str,
    },
    /// None, or several, of keys of which exactly one must be there.
    #[error("expected exactly one of {}, found {}", quoted(of), if found.is_empty() { "none".into() } else { quoted(found) })]
    NotExactlyOne {
        /// The keys of which one must be there.
        of: &'static [&'static str],
        /// Those that are there.
        found: Vec<&'static str>,
    },
    /// A key that makes no sense beside the others.
    #[error("`{key}` {reason}")]
    Misplaced {
        /// The key.
        key: &'static str,
        /// Why it makes no sense.
        reason: String,
    },
    /// A name that is taken.
    #[error("{key} = \"{name}\" is taken by {by}")]
    Taken {
        /// The key that holds the name.
        key: &'static str,
        /// The name.
        name: String,
        /// Who has it.
        by: String,
    },
    /// A load that does not exist.
    #[error(
        "no load is named \"{name}\"; the named loads are {}",
        quoted_or_none(known)
    )]
    UnknownLoad {
        /// The name given.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// An impossible ramp.
    #[error(transparent)]
    Ramp(#[from] sinew_core::RampError),
    /// An integrator that does not exist, or an option it refuses.
    #[error(transparent)]
    Integrator(#[from] sinew_core::OptionError),
    /// A mesh file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] sinew_mesh::MshFileError),
    /// A mesh that is no body of tetrahedra.
    #[error(transparent)]
    Tetrahedra(#[from] sinew_mesh::TetMeshError),
    /// A cube that cannot be generated.
    #[error(transparent)]
    Cube(#[from] sinew_mesh::structured::StructuredError),
    /// A group of `[[initial]]` that the mesh does not have.
    #[error(transparent)]
    UnknownGroup(#[from] sinew_mesh::UnknownGroup),
    /// A body that cannot be modelled.
    #[error("{}", .0.cause())]
    Model(sinew_fem::FemError),
    /// An oscillator that cannot be built.
    #[error(transparent)]
    Oscillator(#[from] sinew_core::OperatorError),
    /// dt = "auto" where the integrator sets no step.
    #[error("dt = \"auto\" needs an integrator with a largest stable step: {reason}")]
    NoStableStep {
        /// What the integrator says.
        reason: String,
    },
    /// A static state that cannot be solved for.
    #[error("no static state: {0}")]
    Static(#[from] sinew_integrators::StaticError),
}

impl Fault {
    /// The hint that follows from the fault alone.
    fn own_help(&self) -> Option<String> {
        use sinew_core::OptionError;
        match self {
            Self::UnknownKey { key, known, .. } if stands_on_top(key, known) => Some(format!(
                "`{key}` stands at the top of the file, before the first [table]"
            )),
            Self::UnknownKey { known, .. } => Some(format!("the keys here are {}", quoted(known))),
            Self::Integrator(OptionError::UnknownIntegrator { id, known }) => {
                suggestion(nearest(id, known.iter().copied()))
            }
            Self::Integrator(OptionError::Unknown { key, known, .. }) => {
                takers(key).or_else(|| suggestion(nearest(key, known.iter().copied())))
            }
            Self::NoStableStep { .. } => Some(
                "give dt in s; `sinew plan --tolerance` finds one that is accurate enough"
                    .to_owned(),
            ),
            Self::UnknownLoad { name, known } => {
                suggestion(nearest(name, known.iter().map(String::as_str)))
            }
            _ => None,
        }
    }
}

/// Whether a key belongs to the document, where TOML takes it for one of the table above it.
fn stands_on_top(key: &str, known: &[&str]) -> bool {
    ["title", GRAVITY].contains(&key) && !known.contains(&key)
}

/// Which integrators take an option.
fn takers(key: &str) -> Option<String> {
    let entries = sinew_integrators::entries();
    let takes = |entry: &&sinew_integrators::Entry| entry.options.iter().any(|o| o.key == key);
    let takers: Vec<&str> = entries.iter().filter(takes).map(|entry| entry.id).collect();
    (!takers.is_empty()).then(|| format!("`{key}` is an option of {}", quoted(&takers)))
}

fn suggestion(nearest: Option<&str>) -> Option<String> {
    nearest.map(|name| format!("did you mean `{name}`?"))
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

fn quoted(names: &[impl AsRef<str>]) -> String {
    let names: Vec<String> = names
        .iter()
        .map(|name| format!("`{}`", name.as_ref()))
        .collect();
    names.join(", ")
}

fn quoted_or_none(names: &[String]) -> String {
    if names.is_empty() {
        "none".into()
    } else {
        quoted(names)
    }
}

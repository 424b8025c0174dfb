//! Values of a command line that cannot be set in a scene.

/// A reason for which a value cannot be set in a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OverrideError {
    /// A text without a key and a value.
    #[error(
        "`{text}`: expected KEY=VALUE, such as run.dt=0.01 or region.1.youngs_modulus=4000, or ~KEY, which removes a value"
    )]
    Form {
        /// The text.
        text: String,
    },
    /// A scene that is not TOML.
    #[error("the scene is not TOML in line {line}: {message}")]
    Syntax {
        /// The line, from 1 on.
        line: usize,
        /// The message of the TOML parser.
        message: String,
    },
    /// A table that the scene does not have.
    #[error("`{path}`: the scene has no `{missing}`{}", did_you_mean(nearest))]
    Missing {
        /// The whole key.
        path: String,
        /// The missing part.
        missing: String,
        /// The most similar existing name.
        nearest: Option<String>,
    },
    /// A number without a table of this number in a list.
    #[error("`{path}`: the scene has {count} of `{list}`, counted from 1")]
    Number {
        /// The whole key.
        path: String,
        /// The list.
        list: String,
        /// The number of its tables.
        count: usize,
    },
    /// A key that leads into a value, or ends at a table.
    #[error("`{path}`: `{part}` is {found}, expected {expected}")]
    Kind {
        /// The whole key.
        path: String,
        /// The part at fault.
        part: String,
        /// Its kind.
        found: &'static str,
        /// The expected kind.
        expected: &'static str,
    },
}

fn did_you_mean(nearest: &Option<String>) -> String {
    match nearest {
        Some(name) => format!("; did you mean `{name}`?"),
        None => String::new(),
    }
}

//! Breaches of rules, and reasons why a rule cannot be checked.

use std::path::PathBuf;

/// A place where a rule is broken.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Breach {
    #[error("crate `{name}` has no place in xtask/src/rules/rooms.rs")]
    NoRoom { name: String },
    #[error("`{name}` must not depend on `{other}`")]
    Dependency { name: String, other: String },
    #[error("`{name}` is of the product and must not depend on `{other}`")]
    Laboratory { name: String, other: String },
    #[error("`{name}` is of the laboratory and must not be published")]
    PublishedLaboratory { name: String },
    #[error("only `{owner}` may depend on {library}, not `{name}`")]
    PrivateLibrary {
        library: &'static str,
        owner: &'static str,
        name: String,
    },
    #[error("`{name}` pulls in {library}")]
    Heavy {
        name: &'static str,
        library: &'static str,
    },
    #[error("`{name}` pulls in {count} crates, itself included; at most {most} are allowed")]
    ManyCrates {
        name: &'static str,
        count: usize,
        most: usize,
    },
    #[error("the tests of `{name}` need `{other}`, which closes a circle: {way}")]
    DevCycle {
        name: String,
        other: String,
        way: String,
    },
    #[error(
        "these files import each other in a circle:\n    {files}\n  the shortest way round: {shortest}"
    )]
    FileCircle { files: String, shortest: String },
    #[error("{path} uses {module}")]
    Impure { path: String, module: String },
    #[error("{path}: `{signature}` shows {word}, which is private to the crate")]
    ForeignName {
        path: String,
        signature: String,
        word: String,
    },
    #[error("ARCHITECTURE.md names {name}, which does not exist")]
    NoSuchPath { name: String },
    #[error("{path} links to {link}, which does not exist")]
    DeadLink { path: String, link: String },
    #[error("{path}:{line}: a doc comment says \"{words}\"; better: {better}")]
    DocWord {
        path: String,
        line: usize,
        words: &'static str,
        better: &'static str,
    },
}

/// Reasons why the rules cannot be checked.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RuleError {
    #[error("`cargo {command}` failed: {reason}")]
    Cargo { command: String, reason: String },
    #[error("{}: {source}", path.display())]
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{}: {reason}", path.display())]
    NotRust { path: PathBuf, reason: String },
    #[error("{} rules are broken:\n{}", .0.len(), listed(.0))]
    Broken(Vec<Breach>),
}

fn listed(breaches: &[Breach]) -> String {
    let lines = breaches.iter().map(|breach| format!("  {breach}"));
    lines.collect::<Vec<_>>().join("\n")
}

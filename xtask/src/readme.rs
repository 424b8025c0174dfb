//! `cargo xtask readme`: the commands of README.md and of the book, run as they are written there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::program;
use crate::repository::root;

/// Chapters of the book.
const BOOK: &str = "docs/book/src";

/// Commands that take too long, or need something that not every computer has, with the reason. Each is run with
/// `--help` at its end, which reads all previous options and then ends, so that it still fails if an option no longer
/// exists.
const NOT_RUN: [(&str, &str); 21] = [
    ("sinew live", "serves until it is interrupted"),
    (
        "cargo run --release -p sinew -- live ball.toml",
        "serves until it is interrupted",
    ),
    (
        "sinew live scenes/ready/press.toml",
        "serves until it is interrupted",
    ),
    (
        "sinew live scenes/ready/press.toml --record hand",
        "serves until it is interrupted",
    ),
    (
        "sinew run scenes/ready/press.toml --replay hand/session.log --out again",
        "repeats a session that a user has driven",
    ),
    ("cargo test --workspace", "minutes; a step of `ci`"),
    ("cargo xtask bench", "minutes; `ci` has the quick bench"),
    ("cargo xtask bench --all", "as `cargo xtask bench`"),
    (
        "cargo xtask bench --scene organ.toml --integrator newmark --integrator cnn --dt 0.01",
        "writes into the folder of a bench",
    ),
    ("cargo xtask bench --scale", "a quarter of an hour"),
    (
        "cargo xtask bench --kernels",
        "minutes, and its guards want a quiet computer",
    ),
    ("cargo xtask native", "builds everything once more"),
    (
        "cargo xtask bench --hard",
        "minutes; `ci` has the quick hard cases",
    ),
    (
        "cargo xtask bench --nonlinear",
        "a quarter of an hour; `ci` has the quick one",
    ),
    (
        "cargo xtask bench --hands",
        "minutes, and wants a quiet computer",
    ),
    (
        "cargo xtask bench --beside scipy",
        "needs Python and a network",
    ),
    ("cargo xtask bench --beside cholmod", "needs CHOLMOD"),
    (
        "cargo xtask bench --beside mujoco,newton",
        "needs Python and a network",
    ),
    ("cargo xtask verify", "a step of `ci`"),
    ("cargo xtask verify --long", "a step of `ci`"),
    (
        "cargo xtask reproduce",
        "minutes; the tests of sinew-bench have it",
    ),
];

#[derive(Debug, PartialEq)]
enum Block<'a> {
    /// A scene that is saved under the name in its first line, a comment.
    File { name: &'a str, text: &'a str },
    /// Commands, without comments.
    Commands(Vec<&'a str>),
}

/// Runs the commands of README.md and of each chapter of the book, in order, each document in its own folder with the
/// scenes and the meshes of a clone. The folder is within `target`, where cargo finds the workspace, so that nothing is
/// built again.
///
/// # Errors
/// [`Failure::Chore`] for the first command that fails.
pub(crate) fn run() -> Result<(), Failure> {
    let program = program::build()?;
    let mut path = vec![program.parent().unwrap_or(Path::new(".")).to_owned()];
    path.extend(std::env::split_paths(
        &std::env::var_os("PATH").unwrap_or_default(),
    ));
    let path = std::env::join_paths(path).map_err(Failure::chore)?;
    for document in documents().map_err(Failure::chore)? {
        let text = fs::read_to_string(&document).map_err(Failure::chore)?;
        let blocks = blocks(&text);
        if !blocks
            .iter()
            .any(|block| matches!(block, Block::Commands(_)))
        {
            continue;
        }
        let name = document.file_stem().unwrap_or_default();
        say(&format!("# {}", document.display()))?;
        let folder = folder(&root().join("target/readme").join(name)).map_err(Failure::chore)?;
        for block in blocks {
            match block {
                Block::File { name, text } => {
                    fs::write(folder.join(name), text).map_err(Failure::chore)?;
                }
                Block::Commands(commands) => {
                    for command in commands {
                        step(command, &folder, &path)?;
                    }
                }
            }
        }
    }
    Ok(())
}

fn step(command: &str, folder: &Path, path: &std::ffi::OsStr) -> Result<(), Failure> {
    let line = as_run(command);
    say(&format!("$ {line}"))?;
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &line])
        .env("PATH", path)
        .current_dir(folder);
    let output = shell
        .output()
        .map_err(|error| Failure::Input(format!("cannot run sh: {error}")))?;
    match output.status.success() {
        true => Ok(()),
        false => Err(Failure::Chore(format!(
            "{command}: {}: {}",
            output.status,
            String::from_utf8_lossy(&output.stderr)
        ))),
    }
}

/// README.md, then the chapters by name.
fn documents() -> std::io::Result<Vec<PathBuf>> {
    let mut chapters = Vec::new();
    for entry in fs::read_dir(root().join(BOOK))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "md") {
            chapters.push(path);
        }
    }
    chapters.sort();
    chapters.insert(0, root().join("README.md"));
    Ok(chapters)
}

/// A new folder with the scenes and the meshes.
fn folder(path: &Path) -> std::io::Result<PathBuf> {
    if path.exists() {
        fs::remove_dir_all(path)?;
    }
    for part in ["scenes", "meshes"] {
        copy(&root().join(part), &path.join(part))?;
    }
    Ok(path.to_owned())
}

/// The form of a command for running it here.
fn as_run(command: &str) -> String {
    match NOT_RUN.iter().any(|(other, _)| *other == command) {
        true => format!("{command} --help"),
        false => command.to_owned(),
    }
}

/// The scenes to be saved and the commands of a text, in order.
fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((_, after)) = rest.split_once("\n```") {
        let (language, after) = after.split_once('\n').unwrap_or((after, ""));
        let (block, after) = after.split_once("\n```").unwrap_or((after, ""));
        rest = after;
        match language {
            "sh" => {
                let lines = block
                    .lines()
                    .map(|line| line.split(" #").next().unwrap_or(line).trim())
                    .filter(|line| !line.is_empty() && !line.starts_with('#'));
                found.push(Block::Commands(lines.collect()));
            }
            "toml" => {
                let name = block
                    .lines()
                    .next()
                    .and_then(|line| line.strip_prefix("# "));
                if let Some(name) = name.filter(|name| name.ends_with(".toml")) {
                    found.push(Block::File { name, text: block });
                }
            }
            _ => {}
        }
    }
    found
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let to = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &to)?;
        } else {
            fs::copy(entry.path(), to)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use sinew_scene::{Scene, SceneSource};

    use super::*;

    fn texts() -> Vec<String> {
        let documents = documents().unwrap().into_iter();
        documents
            .map(|path| fs::read_to_string(path).unwrap())
            .collect()
    }

    /// All blocks of scenes, whole ones and fragments.
    fn fragments(text: &str) -> Vec<&str> {
        let blocks = text.split("\n```toml\n").skip(1);
        blocks
            .filter_map(|block| Some(block.split_once("\n```")?.0))
            .collect()
    }

    fn commands(text: &str) -> Vec<&str> {
        let lines = blocks(text).into_iter().filter_map(|block| match block {
            Block::Commands(lines) => Some(lines),
            Block::File { .. } => None,
        });
        lines.flatten().collect()
    }

    /// Keys that a fragment of a scene does not contain.
    const REST: &str = r#"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = "bottom"
[run]
duration = 1.0
integrator = "central-difference"
dt = 0.001
[[probe]]
name = "centre"
point = [0.05, 0.05, 0.05]
"#;

    /// A scene with the keys of a fragment, and the others of [`REST`].
    fn completed(fragment: &str) -> String {
        let mut scene: toml::Table = fragment.parse().unwrap();
        let rest: toml::Table = REST.parse().unwrap();
        for (key, value) in rest {
            match (key.as_str(), scene.get_mut(&key)) {
                (_, None) => {
                    scene.insert(key, value);
                }
                ("run", Some(toml::Value::Table(run))) => complete(run, &value),
                ("region", Some(toml::Value::Array(regions))) => {
                    for region in regions {
                        complete(region.as_table_mut().unwrap(), &value[0]);
                    }
                }
                _ => {}
            }
        }
        toml::to_string(&scene).unwrap()
    }

    fn complete(table: &mut toml::Table, rest: &toml::Value) {
        for (key, value) in rest.as_table().unwrap() {
            table.entry(key).or_insert(value.clone());
        }
    }

    #[test]
    fn every_fragment_of_a_scene_in_the_documents_is_read() {
        let texts = texts();
        let fragments: Vec<&str> = texts.iter().flat_map(|text| fragments(text)).collect();
        assert!(fragments.len() > 15);
        for fragment in fragments {
            let source = SceneSource::new("document.toml", completed(fragment));
            if let Err(error) = Scene::parse(source) {
                panic!("{error}\n{fragment}");
            }
        }
        let misspelt = SceneSource::new("document.toml", completed("[mesh]\nblok = {}"));
        assert!(Scene::parse(misspelt).is_err());
    }

    #[test]
    fn every_command_that_is_not_run_is_in_a_document() {
        let texts = texts();
        let commands: Vec<&str> = texts.iter().flat_map(|text| commands(text)).collect();
        for (command, reason) in NOT_RUN {
            assert!(commands.contains(&command), "{command} ({reason})");
        }
        let runs = commands
            .iter()
            .filter(|command| as_run(command) == **command);
        assert!(runs.count() > 30);
    }

    #[test]
    fn scenes_are_saved_and_commands_are_lines_without_comments() {
        let text = "\n```sh\na --b   # c\n\n# d\ne\n```\n\n```text\nf\n```\n\n```toml\n# g.toml\n[run]\n```\n\n```sh\nh\n```\n";
        let expected = [
            Block::Commands(vec!["a --b", "e"]),
            Block::File {
                name: "g.toml",
                text: "# g.toml\n[run]",
            },
            Block::Commands(vec!["h"]),
        ];
        assert_eq!(blocks(text), expected);
    }
}

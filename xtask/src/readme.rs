//! `cargo xtask readme`: runs the commands of README.md as written there.

use std::fs;
use std::path::Path;
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::repository::root;

/// Commands that take too long, or need programs that not every computer has, with the reason. With `--help` behind
/// it, which reads all options before it and then ends, each still fails if an option is gone.
const NOT_RUN: [(&str, &str); 16] = [
    (
        "cargo run --release -p sinew -- live scenes/ready/press.toml",
        "serves until it is interrupted",
    ),
    (
        "cargo run --release -p sinew -- run scene.toml --replay session.log --out again",
        "repeats a session that a hand has driven",
    ),
    (
        "cargo xtask bench --hands",
        "minutes, and wants a quiet computer",
    ),
    ("cargo xtask live-test", "a step of `ci`"),
    ("cargo xtask wheel", "a part of `python-test`"),
    ("cargo xtask python-test", "a step of `ci`"),
    ("cargo xtask bench", "minutes; `ci` has the quick bench"),
    ("cargo xtask verify", "a step of `ci`"),
    ("cargo test --workspace", "minutes; a step of `ci`"),
    (
        "cargo xtask bench --beside scipy",
        "needs Python and a network",
    ),
    ("cargo xtask bench --beside cholmod", "needs CHOLMOD"),
    (
        "cargo xtask reproduce",
        "minutes; the tests of sinew-bench have it",
    ),
    ("cargo xtask bench --scale", "a quarter of an hour"),
    (
        "cargo xtask bench --kernels",
        "minutes, and its guards want a quiet computer",
    ),
    (
        "cargo xtask bench --nonlinear",
        "a quarter of an hour; `ci` has the quick one",
    ),
    (
        "cargo xtask bench --hard",
        "minutes; `ci` has the quick hard cases",
    ),
];

/// Runs the commands of README.md, in order, in a folder that has the scenes and the meshes as a clone has them. It lies within
/// `target`, where cargo finds the workspace, so that nothing is built again.
///
/// # Errors
/// [`Failure::Chore`] for the first command that fails.
pub(crate) fn run() -> Result<(), Failure> {
    let text = fs::read_to_string(root().join("README.md")).map_err(Failure::chore)?;
    let folder = root().join("target/readme");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(Failure::chore)?;
    }
    for part in ["scenes", "meshes"] {
        copy(&root().join(part), &folder.join(part)).map_err(Failure::chore)?;
    }
    for command in commands(&text) {
        let line = as_run(command);
        say(&format!("$ {line}"))?;
        let output = shell(&line, &folder)?;
        if !output.status.success() {
            return Err(Failure::Chore(format!(
                "{command}: {}: {}",
                output.status,
                String::from_utf8_lossy(&output.stderr)
            )));
        }
    }
    Ok(())
}

fn shell(line: &str, folder: &Path) -> Result<std::process::Output, Failure> {
    let mut shell = Command::new("sh");
    shell.args(["-c", line]).current_dir(folder);
    shell
        .output()
        .map_err(|error| Failure::Input(format!("cannot run sh: {error}")))
}

/// The form of a command in which it is run here.
fn as_run(command: &str) -> String {
    match NOT_RUN.iter().any(|(other, _)| *other == command) {
        true => format!("{command} --help"),
        false => command.to_owned(),
    }
}

/// The commands of all blocks of shell commands, without comments.
fn commands(text: &str) -> Vec<&str> {
    blocks(text, "sh")
        .into_iter()
        .flat_map(str::lines)
        .map(|line| line.split(" #").next().unwrap_or(line).trim())
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .collect()
}

/// The blocks of this language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("\n```{language}\n");
    let mut blocks = Vec::new();
    let mut rest = text;
    while let Some((_, after)) = rest.split_once(fence.as_str()) {
        let (block, after) = after.split_once("\n```").unwrap_or((after, ""));
        blocks.push(block);
        rest = after;
    }
    blocks
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

    fn readme() -> String {
        fs::read_to_string(root().join("README.md")).unwrap()
    }

    /// Keys that a fragment of a scene leaves out.
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
    fn every_fragment_of_a_scene_in_the_readme_is_read() {
        let text = readme();
        let fragments = blocks(&text, "toml");
        assert!(fragments.len() > 3);
        for fragment in fragments {
            let source = SceneSource::new("readme.toml", completed(fragment));
            if let Err(error) = Scene::parse(source) {
                panic!("{error}\n{fragment}");
            }
        }
        let misspelt = SceneSource::new("readme.toml", completed("[mesh]\nblok = {}"));
        assert!(Scene::parse(misspelt).is_err());
    }

    #[test]
    fn every_command_that_is_not_run_stands_in_the_readme() {
        let text = readme();
        let commands = commands(&text);
        for (command, reason) in NOT_RUN {
            assert!(commands.contains(&command), "{command} ({reason})");
        }
        let runs = commands
            .iter()
            .filter(|command| as_run(command) == **command);
        assert!(runs.count() > 10);
    }

    #[test]
    fn commands_are_lines_without_comments() {
        let text = "\n```sh\na --b   # c\n\n# d\ne\n```\n\n```text\nf\n```\n\n```sh\ng\n```\n";
        assert_eq!(commands(text), ["a --b", "e", "g"]);
    }
}

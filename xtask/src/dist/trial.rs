//! Test of the archive as a user receives it: unpacked in another place, without the repository.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::programs::{finish, text_of};
use crate::failure::Failure;

const SCENE: &str = "scenes/ready/held-cube.toml";

/// Unpacks the archive in a new temporary folder and runs the commands of its README there.
///
/// # Errors
/// [`Failure::Chore`] if the command fails or does not print the expected text.
pub(super) fn run(archive: &Path, name: &str) -> Result<(), Failure> {
    let folder = std::env::temp_dir().join(format!("sinew-trial-{}", std::process::id()));
    fs::create_dir(&folder).map_err(Failure::chore)?;
    let tried = try_in(&folder, archive, name);
    // What cannot be removed costs space and nothing else.
    let _ = fs::remove_dir_all(&folder);
    tried
}

fn try_in(folder: &Path, archive: &Path, name: &str) -> Result<(), Failure> {
    finish(
        Command::new("tar")
            .arg("-xzf")
            .arg(archive)
            .current_dir(folder),
    )?;
    let place = folder.join(name);
    for file in [
        "README.md",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        super::notices::NAME,
    ] {
        if !place.join(file).is_file() {
            return Err(Failure::Chore(format!("the archive has no {file}")));
        }
    }
    let program = place.join(format!("sinew{EXE_SUFFIX}"));
    let said = |arguments: &[&str]| {
        let mut command = Command::new(&program);
        // Nothing of the developer's surroundings may help.
        command.args(arguments).current_dir(&place).env_clear();
        text_of(&mut command)
    };
    let version = said(&["--version"])?;
    if version.trim() != concat!("sinew ", env!("CARGO_PKG_VERSION")) {
        return Err(Failure::Chore(format!("its version is {version:?}")));
    }
    check_probes(&said(&["run", SCENE])?)?;
    said(&["run", SCENE, "--out", "held-cube"])?;
    let written: PathBuf = place.join("held-cube/report.html");
    match written.is_file() {
        true => Ok(()),
        false => Err(Failure::Chore(format!("there is no {}", written.display()))),
    }
}

/// Checks a table of probes: a heading, then rows of finite numbers.
fn check_probes(table: &str) -> Result<(), Failure> {
    let wrong = |what: &str| Failure::Chore(format!("its probes: {what}"));
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    let mut count = 0;
    for row in rows {
        let mut cells = row.split(',').map(str::parse::<f64>);
        if !cells.all(|cell| cell.is_ok_and(f64::is_finite)) {
            return Err(wrong(row));
        }
        count += 1;
    }
    match count {
        0 | 1 => Err(wrong("no rows")),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_without_rows_or_with_a_row_that_is_not_a_number_is_no_result() {
        assert!(check_probes("t,u\n0,0\n0.1,-1e-3\n").is_ok());
        assert!(check_probes("t,u\n").is_err());
        assert!(check_probes("t,u\n0,0\n0.1,NaN\n").is_err());
    }
}

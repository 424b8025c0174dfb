//! The commands that errors on files of other programs name.

use sinew_scene::output::say;

use super::place::Place;
use crate::failure::Failure;

/// Follows every piece of advice, and checks that its mesh has tetrahedra.
pub(super) fn try_all(place: &Place<'_>) -> Result<(), Failure> {
    let mut tried = Vec::new();
    for extension in sinew_mesh::converted_extensions() {
        let file = format!("formats/{extension}/body.lb8.{extension}");
        let said = place.refusal(&format!("sinew mesh info {file}"))?;
        let command = command(&said, "meshio convert")?;
        place.shell(&command)?;
        let made = file.replace(&format!(".{extension}"), ".msh");
        expect_tetrahedra(place, &made, &command)?;
        tried.push(extension);
    }
    say(&format!(
        "meshio turns into .msh as advised: {}",
        tried.join(", ")
    ))?;
    // meshio's own name for what it writes under .msh.
    let said = place.refusal("sinew mesh info formats/fluent.msh")?;
    let fluent = command(&said, "meshio convert")?.replace("FILE", "formats/fluent");
    place.shell(&fluent)?;
    expect_tetrahedra(place, "formats/fluent.vtu", &fluent)?;
    let said = place.refusal("sinew new bricks.msh")?;
    let split = command(&said, "sinew mesh convert")?;
    place.shell(&split)?;
    expect_tetrahedra(place, "tets.vtu", &split)?;
    Ok(say(
        "a mesh of Fluent and one of hexahedra become tetrahedra as advised",
    )?)
}

/// The command in an error that begins with this text.
fn command(said: &str, begin: &str) -> Result<String, Failure> {
    let quoted = said.split('`').skip(1).step_by(2);
    let mut found = quoted.filter(|quoted| quoted.starts_with(begin));
    let command = found.next().map(str::to_owned);
    command.ok_or_else(|| Failure::Chore(format!("no `{begin}` in: {said}")))
}

fn expect_tetrahedra(place: &Place<'_>, file: &str, command: &str) -> Result<(), Failure> {
    let info = place.shell(&format!("sinew mesh info {file}"))?;
    let cells = info.lines().find(|line| line.starts_with("cells"));
    match cells.is_some_and(|cells| cells.contains(" tetra") && !cells.contains("hexahedron")) {
        true => Ok(()),
        false => Err(Failure::Chore(format!(
            "{command} made no tetrahedra: {info}"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_in_an_error_is_found_by_its_beginning() {
        let said = "error: a `--b c`, and `meshio convert d e` (pip install meshio)";
        assert_eq!(
            command(said, "meshio convert").unwrap(),
            "meshio convert d e"
        );
        assert!(command(said, "sinew").is_err());
    }
}

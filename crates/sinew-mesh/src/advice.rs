//! Advice on files that are not meshes of tetrahedra: commands, and a page with more of them.

use std::path::Path;

/// The page that leads from surfaces, images and hexahedra to a mesh and a scene.
pub(crate) const PAGE: &str = concat!(
    env!("CARGO_PKG_REPOSITORY"),
    "/blob/main/docs/to-a-scene.md"
);

/// Advice on a surface, in a file of any format.
pub(crate) fn on_surface() -> String {
    format!("gmsh fills a surface with tetrahedra and names its parts; {PAGE} has the commands")
}

/// The command of meshio that turns a file into a .msh file.
pub(crate) fn meshio_command(path: &Path) -> String {
    // Version 2.2, because meshio 5.3.5 writes cells of several types into version 4.1 only with entities.
    format!(
        "`meshio convert {} {} --output-format gmsh22`",
        quoted(path),
        quoted(&path.with_extension("msh")),
    )
}

/// A path quoted for a shell.
pub(crate) fn quoted(path: &Path) -> String {
    let path = path.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+=:@%,".contains(c);
    if path.chars().all(is_plain) && !path.starts_with('-') {
        return path;
    }
    let dashed = if path.starts_with('-') { "./" } else { "" };
    format!("'{dashed}{}'", path.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_names_both_files_as_a_shell_takes_them() {
        for (path, files) in [
            ("liver.exo", "liver.exo liver.msh"),
            ("/a/B.XDMF", "/a/B.XDMF /a/B.msh"),
            ("my liver.bdf", "'my liver.bdf' 'my liver.msh'"),
            ("it's.med", r"'it'\''s.med' 'it'\''s.msh'"),
            ("-x.meshb", "'./-x.meshb' './-x.msh'"),
        ] {
            let expected = format!("`meshio convert {files} --output-format gmsh22`");
            assert_eq!(meshio_command(Path::new(path)), expected);
        }
    }
}

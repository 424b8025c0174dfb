//! Mesh formats of other programs, told by the extension of a file's name, and the way from them to .msh.

use std::path::Path;

/// Extensions of formats that meshio 5.3.5 reads, that can hold tetrahedra and that this crate does not read.
const READ_BY_MESHIO: [&str; 27] = [
    "f3grid", "mdpa", "xdmf", "xmf", "cgns", "h5m", "avs", "xml", "e", "exo", "ex2", "hmf", "med",
    "meshb", "bdf", "fem", "nas", "vol", "post", "dato", "su2", "dat", "tec", "ele", "node",
    "ugrid", "wkt",
];

/// Extensions of formats that hold surfaces alone.
const SURFACES: [&str; 4] = ["stl", "off", "ply", "obj"];

/// Advice on how a file of another format becomes a .msh file, if its name tells the format.
pub(super) fn advice(path: &Path) -> Option<String> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    if READ_BY_MESHIO.contains(&extension.as_str()) {
        // Version 2.2, because meshio 5.3.5 writes cells of several types into version 4.1 only with entities.
        return Some(format!(
            "`meshio convert {} {} --output-format gmsh22` (pip install meshio) writes a .msh file",
            quoted(path),
            quoted(&path.with_extension("msh")),
        ));
    }
    SURFACES.contains(&extension.as_str()).then(|| {
        format!(
            "a .{extension} file holds a surface without tetrahedra; a mesh generator such as gmsh, fTetWild or TetGen fills \
             it with them"
        )
    })
}

/// A path as a shell takes it.
fn quoted(path: &Path) -> String {
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
    fn the_command_names_both_files() {
        for (path, files) in [
            ("liver.exo", "liver.exo liver.msh"),
            ("/a/B.XDMF", "/a/B.XDMF /a/B.msh"),
            ("my liver.bdf", "'my liver.bdf' 'my liver.msh'"),
            ("it's.med", r"'it'\''s.med' 'it'\''s.msh'"),
            ("-x.meshb", "'./-x.meshb' './-x.msh'"),
        ] {
            let expected = format!(
                "`meshio convert {files} --output-format gmsh22` (pip install meshio) writes a .msh file"
            );
            assert_eq!(advice(Path::new(path)), Some(expected));
        }
    }

    #[test]
    fn surfaces_need_a_mesh_generator() {
        let said = advice(Path::new("skin.stl")).unwrap_or_default();
        assert!(
            said.starts_with("a .stl file holds a surface without tetrahedra"),
            "{said}"
        );
    }

    #[test]
    fn names_that_tell_nothing_bring_no_advice() {
        for path in ["organ.msh", "organ", "organ.txt", ".med", "liver.vtu"] {
            assert_eq!(advice(Path::new(path)), None, "{path}");
        }
    }
}

//! Mesh formats of other programs, identified by the extension of a file's name, and their conversion to .msh.

use std::path::Path;

use crate::advice::meshio_command;

/// Extensions of formats for tetrahedra that this crate does not read, and that meshio 5.3.5 reads without other
/// packages.
const READ_BY_MESHIO: [&str; 17] = [
    "f3grid", "mdpa", "avs", "xml", "meshb", "bdf", "fem", "nas", "vol", "post", "dato", "su2",
    "dat", "tec", "ele", "node", "ugrid",
];

/// Extensions of such formats that meshio reads with the packages of `meshio[all]`.
const READ_BY_ALL_OF_MESHIO: [&str; 9] = [
    "xdmf", "xmf", "cgns", "h5m", "e", "exo", "ex2", "hmf", "med",
];

/// Extensions of mesh formats that are not read, but for which the error message contains the command of meshio that
/// makes a .msh file.
pub fn converted_extensions() -> impl Iterator<Item = &'static str> {
    READ_BY_MESHIO.into_iter().chain(READ_BY_ALL_OF_MESHIO)
}

/// Advice on the conversion of a file of another format to .msh, if its name identifies the format.
pub(super) fn advice(path: &Path) -> Option<String> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let package = if READ_BY_MESHIO.contains(&extension.as_str()) {
        "meshio"
    } else if READ_BY_ALL_OF_MESHIO.contains(&extension.as_str()) {
        "\"meshio[all]\""
    } else {
        return None;
    };
    let command = meshio_command(path);
    Some(format!(
        "{command} (pip install {package}) writes a .msh file"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_comes_with_the_packages_that_it_needs() {
        for (path, package) in [("liver.bdf", "meshio"), ("LIVER.MED", "\"meshio[all]\"")] {
            let said = advice(Path::new(path)).unwrap_or_default();
            let end =
                format!(" --output-format gmsh22` (pip install {package}) writes a .msh file");
            assert!(
                said.starts_with("`meshio convert") && said.ends_with(&end),
                "{said}"
            );
        }
    }

    #[test]
    fn names_that_tell_nothing_bring_no_advice() {
        for path in [
            "organ.msh",
            "organ",
            "organ.txt",
            ".med",
            "liver.vtu",
            "land.wkt",
        ] {
            assert_eq!(advice(Path::new(path)), None, "{path}");
        }
    }
}

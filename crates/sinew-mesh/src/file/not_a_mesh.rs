//! Files without tetrahedra that are often given instead of a mesh.

use std::fmt;
use std::path::Path;

use crate::advice::{PAGE, on_surface};

/// A kind of file without tetrahedra, with the name of its format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotAMesh {
    /// An image of voxels.
    Image(&'static str),
    /// A surface.
    Surface(&'static str),
}

impl NotAMesh {
    /// The kind of a file, identified by its first bytes, otherwise by its name.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Option<NotAMesh> {
        told_by_bytes(bytes).or_else(|| told_by_name(path))
    }

    /// Advice on the conversion of such a file to a mesh.
    pub(super) fn advice(self) -> String {
        match self {
            NotAMesh::Image(_) => format!(
                "an image of labels becomes a mesh with a tissue for each label by SimpleITK, pyvista and pytetwild; {PAGE} has the \
                 commands"
            ),
            NotAMesh::Surface(_) => on_surface(),
        }
    }
}

impl fmt::Display for NotAMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotAMesh::Image(format) => write!(f, "an image of voxels ({format})"),
            NotAMesh::Surface(format) => write!(f, "a surface ({format})"),
        }
    }
}

fn told_by_bytes(bytes: &[u8]) -> Option<NotAMesh> {
    let at = |offset: usize, text: &[u8]| {
        let rest = bytes.get(offset..);
        rest.is_some_and(|rest| rest.starts_with(text))
    };
    // The second line of a text of STL is its first facet.
    let is_text_of_stl = || {
        let mut lines = bytes.splitn(3, |&byte| byte == b'\n').skip(1);
        let facet = lines.next().unwrap_or_default().trim_ascii_start();
        at(0, b"solid") && facet.starts_with(b"facet")
    };
    if at(344, b"n+1\0") || at(344, b"ni1\0") {
        Some(NotAMesh::Image("NIfTI"))
    } else if at(0, b"NRRD00") {
        Some(NotAMesh::Image("NRRD"))
    } else if at(0, b"ObjectType = Image") {
        Some(NotAMesh::Image("MetaImage"))
    } else if at(128, b"DICM") {
        Some(NotAMesh::Image("DICOM"))
    } else if is_text_of_stl() {
        Some(NotAMesh::Surface("STL"))
    } else {
        None
    }
}

fn told_by_name(path: &Path) -> Option<NotAMesh> {
    let name = path.file_name()?.to_str()?.to_ascii_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    let extension = Path::new(name).extension()?.to_str()?;
    Some(match extension {
        "nii" => NotAMesh::Image("NIfTI"),
        "nrrd" | "nhdr" => NotAMesh::Image("NRRD"),
        "mha" | "mhd" => NotAMesh::Image("MetaImage"),
        "dcm" => NotAMesh::Image("DICOM"),
        "stl" => NotAMesh::Surface("STL"),
        "off" => NotAMesh::Surface("OFF"),
        "ply" => NotAMesh::Surface("PLY"),
        "obj" => NotAMesh::Surface("OBJ"),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_first_bytes_tell_images_and_surfaces() {
        let nifti = [&[0; 344][..], b"n+1\0"].concat();
        let dicom = [&[0; 128][..], b"DICM"].concat();
        let cases: [(&str, &[u8], Option<NotAMesh>); 13] = [
            ("liver.nii.gz", b"\x1f\x8b", Some(NotAMesh::Image("NIfTI"))),
            ("LIVER.NII", b"", Some(NotAMesh::Image("NIfTI"))),
            ("liver.nrrd", b"", Some(NotAMesh::Image("NRRD"))),
            ("liver.mha", b"", Some(NotAMesh::Image("MetaImage"))),
            ("liver", &nifti, Some(NotAMesh::Image("NIfTI"))),
            ("liver.msh", b"NRRD0004\n", Some(NotAMesh::Image("NRRD"))),
            (
                "liver",
                b"ObjectType = Image\n",
                Some(NotAMesh::Image("MetaImage")),
            ),
            ("slice", &dicom, Some(NotAMesh::Image("DICOM"))),
            ("skin.stl", b"\0\0", Some(NotAMesh::Surface("STL"))),
            (
                "skin",
                b"solid skin\r\n  facet normal 0 0 1\n",
                Some(NotAMesh::Surface("STL")),
            ),
            ("liver.msh.gz", b"\x1f\x8b", None),
            ("solid.msh", b"solid ground\n", None),
            ("liver.vtu", b"<?xml", None),
        ];
        for (path, bytes, expected) in cases {
            assert_eq!(NotAMesh::of(Path::new(path), bytes), expected, "{path}");
        }
    }
}

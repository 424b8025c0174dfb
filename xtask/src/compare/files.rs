//! The mesh that is compared, and the files to which it is written.

use sinew_mesh::structured::{Split, StructuredError, cube};
use sinew_mesh::vtu::{
    Array, Grid, VtuEncoding, WriteVtuError, write_pvd, write_vtu, write_vtu_grid,
};
use sinew_mesh::{
    AddGroupError, CellData, GroupMembers, Mesh, MshEncoding, MshVersion, PointData, TetMeshError,
    WriteMshError, write_msh,
};

/// Reasons why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub(super) enum FilesError {
    #[error(transparent)]
    Cube(#[from] StructuredError),
    #[error(transparent)]
    Group(#[from] AddGroupError),
    #[error(transparent)]
    NoTets(#[from] TetMeshError),
    #[error(transparent)]
    Msh(#[from] WriteMshError),
    #[error(transparent)]
    Vtu(#[from] WriteVtuError),
    #[error(transparent)]
    Pvd(#[from] std::io::Error),
}

pub(super) const MSH: [(&str, MshVersion, MshEncoding); 4] = [
    ("22-text.msh", MshVersion::V22, MshEncoding::Text),
    ("22-binary.msh", MshVersion::V22, MshEncoding::Binary),
    ("41-text.msh", MshVersion::V41, MshEncoding::Text),
    ("41-binary.msh", MshVersion::V41, MshEncoding::Binary),
];

pub(super) const VTU: [(&str, VtuEncoding); 3] = [
    ("raw.vtu", VtuEncoding::RawAppended),
    ("compressed.vtu", VtuEncoding::CompressedAppended),
    ("base64.vtu", VtuEncoding::Base64),
];

/// Files of the mesh whose groups overlap.
pub(super) const OVERLAPPING_MSH: [(&str, MshEncoding); 2] = [
    ("overlapping-text.msh", MshEncoding::Text),
    ("overlapping-binary.msh", MshEncoding::Binary),
];

/// The same as .vtu, with an array for each group.
pub(super) const OVERLAPPING_VTU: &str = "overlapping.vtu";

/// The tetrahedra alone, with whole numbers at nodes and tetrahedra.
pub(super) const GRID: &str = "grid.vtu";

/// A value for each of `count` nodes or tetrahedra, beyond the precision of a 32-bit float.
pub(super) fn integers(count: usize) -> Vec<i64> {
    (0..).take(count).map(|i: i64| (1 << 40) - 3 * i).collect()
}

/// A cube with groups, values at the nodes and in the cells, most of them with no short decimal form.
pub(super) fn mesh() -> Result<Mesh, StructuredError> {
    let mut mesh = cube(2, 0.1, Split::Mirrored)?.to_mesh();
    // meshio joins blocks of version 2.2 and takes tags for ordinals.
    let mut next = 1;
    for block in &mut mesh.cells {
        block.element_tags = (next..).take(block.len()).collect();
        next += block.len() as u64;
    }
    let points = mesh.points.clone();
    mesh.point_data = vec![
        PointData {
            name: "temperature".to_owned(),
            step: 0,
            time: 0.5,
            components: 1,
            values: points.iter().map(|p| p[0] / 3.0 - 1e-30).collect(),
        },
        PointData {
            name: "displacement".to_owned(),
            step: 0,
            time: 0.5,
            components: 3,
            values: points.iter().flatten().map(|x| x / 7.0).collect(),
        },
    ];
    let mut value = 0.0;
    let energies = mesh.cells.iter().map(|block| {
        let values = (0..block.len()).map(|_| {
            value += 0.1;
            value
        });
        values.collect()
    });
    mesh.cell_data = vec![CellData {
        name: "energy".to_owned(),
        step: 0,
        time: 0.5,
        components: 1,
        blocks: energies.collect(),
    }];
    Ok(mesh)
}

/// A cube with tetrahedra in two groups and triangles in two groups.
pub(super) fn overlapping() -> Result<Mesh, FilesError> {
    let mut cube = cube(2, 0.1, Split::Kuhn)?;
    let patch = cube.boundary(None)[..5].to_vec();
    cube.add_group("stiff \u{e4}", GroupMembers::Tets((3..30).collect()))?;
    cube.add_group("patch", GroupMembers::Triangles(patch))?;
    Ok(cube.to_mesh())
}

/// The names and bytes of all files.
pub(super) fn all(mesh: &Mesh) -> Result<Vec<(&'static str, Vec<u8>)>, FilesError> {
    let mut files = Vec::new();
    for (name, version, encoding) in MSH {
        let mut bytes = Vec::new();
        write_msh(mesh, version, encoding, &mut bytes)?;
        files.push((name, bytes));
    }
    for (name, encoding) in VTU {
        let mut bytes = Vec::new();
        write_vtu(mesh, encoding, &mut bytes)?;
        files.push((name, bytes));
    }
    let with_overlaps = overlapping()?;
    for (name, encoding) in OVERLAPPING_MSH {
        let mut bytes = Vec::new();
        write_msh(&with_overlaps, MshVersion::V41, encoding, &mut bytes)?;
        files.push((name, bytes));
    }
    let mut bytes = Vec::new();
    write_vtu(&with_overlaps, VtuEncoding::RawAppended, &mut bytes)?;
    files.push((OVERLAPPING_VTU, bytes));
    let tissue = mesh.to_tet_mesh()?;
    let grid = Grid {
        point_data: vec![Array::of_integers("node", integers(tissue.points.len()))],
        cell_data: vec![Array::of_integers("region", integers(tissue.tets.len()))],
        ..Grid::of(&tissue)
    };
    let mut bytes = Vec::new();
    write_vtu_grid(&grid, VtuEncoding::Base64, &mut bytes)?;
    files.push((GRID, bytes));
    let mut series = Vec::new();
    write_pvd(&[(0.0, "raw.vtu"), (0.5, "base64.vtu")], &mut series)?;
    files.push(("series.pvd", series));
    Ok(files)
}

//! VTK's XML.

use super::{fixture, path, refusal, refused};
use sinew_mesh::MeshFormat::Vtu;
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::vtu::{VtuEncoding, read_vtu, write_vtu};
use sinew_mesh::{GroupMembers, Mesh};

use crate::common::full_mesh;

fn written(mesh: &Mesh, encoding: VtuEncoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_vtu(mesh, encoding, &mut bytes).expect("memory does not fail");
    bytes
}

/// Dimension, name and members of each group. Its tag may differ if all its cells have another group first.
fn groups(mesh: &Mesh) -> Vec<(u8, String, GroupMembers)> {
    let groups = mesh.to_tet_mesh().expect("tetrahedra").groups.into_iter();
    let mut groups: Vec<_> = groups
        .map(|group| (group.dim, group.name, group.members))
        .collect();
    groups.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
    groups
}

#[test]
fn what_is_written_comes_back_with_groups_tags_and_data() {
    let mut overlapping = cube(2, 0.1, Split::Kuhn).expect("valid");
    overlapping
        .add_group("half", GroupMembers::Tets((0..24).collect()))
        .expect("it is new");
    let overlapping = overlapping.to_mesh();
    let mut full = full_mesh();
    // Not written.
    full.cell_node_data.clear();
    full.periodic.clear();
    full.node_entities.clear();
    for mesh in [overlapping, full] {
        for encoding in [VtuEncoding::RawAppended, VtuEncoding::Base64] {
            let back = read_vtu(&written(&mesh, encoding)).expect("it was written");
            assert_eq!(back.points, mesh.points);
            assert_eq!(back.node_tags, mesh.node_tags);
            assert_eq!(groups(&back), groups(&mesh));
            assert_eq!(back.cell_data.len(), mesh.cell_data.len());
            for (a, b) in back.cell_data.iter().zip(&mesh.cell_data) {
                assert_eq!(a.name, b.name);
                let same = |(a, b): (&f64, &f64)| a == b || (a.is_nan() && b.is_nan());
                assert!(a.blocks.concat().iter().zip(&b.blocks.concat()).all(same));
            }
        }
    }
}

#[test]
fn damage_is_refused_with_its_place() {
    let raw = std::fs::read(path("vtk-raw.vtu")).unwrap();
    let cut = refused(&raw[..raw.len() - 100], Vtu).to_string();
    assert!(
        cut.contains(
            "its bytes are cut off or damaged; expected as many whole numbers as its head says"
        ),
        "{cut}"
    );
    let text = std::fs::read_to_string(path("vtk-ascii.vtu")).unwrap();
    for (from, to, end) in [
        (
            "1000 2500.5",
            "1000 25o0.5",
            "CellData, array \"young\", entry 2: a number is \"25o0.5\"; expected a number",
        ),
        (
            "NumberOfCells=\"3\"",
            "NumberOfCells=\"4\"",
            "Cells: there are 3 offsets; expected 4, the NumberOfCells",
        ),
        (
            "NumberOfCells=\"3\"",
            "NumberOfCells=\"x\"",
            "NumberOfCells of <Piece> is \"x\"; expected a non-negative whole number",
        ),
        (
            "NumberOfPoints=\"5\"",
            "NumberOfPoints=\"999999999999\"",
            "Points, array \"Points\": it has 15 numbers; expected 3 for each of 999999999999",
        ),
        (
            "\"UnstructuredGrid\"",
            "\"PolyData\"",
            "the file holds \"PolyData\"; a body is an UnstructuredGrid of tetrahedra: in ParaView the filter Tetrahedralize makes one of a grid, and a mesh generator fills a surface",
        ),
        (
            "byte_order=\"LittleEndian\"",
            "byte_order=\"Middle\"",
            "byte_order is \"Middle\"; expected LittleEndian or BigEndian",
        ),
        (
            "format=\"ascii\"",
            "format=\"latin\"",
            "the format is \"latin\"; expected ascii, binary or appended",
        ),
        (
            "\"connectivity\"",
            "\"corners\"",
            "Cells: there is no array \"connectivity\"; expected arrays \"connectivity\", \"offsets\" and \"types\"",
        ),
        ("</VTKFile>", "", "the file ends here; expected </VTKFile>"),
    ] {
        assert!(text.contains(from), "{from}");
        let said = refusal(&text.replacen(from, to, 1), Vtu);
        assert!(said.starts_with("line ") && said.ends_with(end), "{said}");
    }
    assert_eq!(
        refusal("# vtk DataFile Version 3.0\n", Vtu),
        "line 1 (byte 0): the file starts with \"# vtk DataFile Version 3.0\"; expected a .vtu file of VTK: XML that begins with \
         <VTKFile type=\"UnstructuredGrid\">"
    );
}

#[test]
fn declared_sizes_take_no_memory_before_the_bytes_are_there() {
    let text = std::fs::read_to_string(path("vtk-ascii.vtu")).unwrap();
    let huge = text
        .replace("NumberOfCells=\"3\"", "NumberOfCells=\"1000000000000\"")
        .replace("NumberOfPoints=\"5\"", "NumberOfPoints=\"1000000000000\"")
        .replace(
            "NumberOfComponents=\"3\"",
            "NumberOfComponents=\"1000000000\"",
        );
    let mut raw = std::fs::read(path("vtk-raw-zlib-big.vtu")).unwrap();
    let start = raw
        .windows(2)
        .position(|pair| pair == b"\n_" || pair == b" _")
        .expect("numbers follow")
        + 2;
    // The number of blocks, then the size of one.
    raw[start..start + 8].fill(0xff);
    for bytes in [huge.as_bytes(), &raw] {
        let (outcome, peak) = sinew_core::CountingAllocator::peak(|| read_vtu(bytes).map(drop));
        assert!(outcome.is_err());
        assert!(peak < 1 << 20, "{peak} bytes");
    }
}

#[test]
fn labels_of_a_written_file_are_not_lost_on_the_way_to_gmsh() {
    let mesh = fixture("vtk-base64.vtu");
    let mut file = Vec::new();
    sinew_mesh::write_msh41_ascii(&mesh, &mut file).expect("memory does not fail");
    let back = sinew_mesh::read_msh(&file)
        .expect("it was written")
        .to_tet_mesh()
        .expect("tetrahedra");
    assert_eq!(back.data("labels").expect("kept").values, [1.0, 2.0]);
}

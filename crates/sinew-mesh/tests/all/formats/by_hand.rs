//! The mesh of the files under `data/formats`, stated by hand.

use sinew_mesh::MeshFormat;

use super::{cell_data, fixture, point_data, read, rows};

const POINTS: [[f64; 3]; 5] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
];

#[test]
fn points_cells_and_data_are_the_same_from_every_encoding_of_vtk() {
    for name in [
        "vtk-ascii.vtu",
        "vtk-binary-big.vtu",
        "vtk-binary-zlib.vtu",
        "vtk-raw.vtu",
        "vtk-raw-zlib-big.vtu",
        "vtk-base64.vtu",
        "vtk-base64-zlib.vtu",
        "meshio-ascii.vtu",
        "meshio-zlib.vtu",
        "vtk-4.2-text.vtk",
        "vtk-4.2-bytes.vtk",
        "vtk-5.1-text.vtk",
        "vtk-5.1-bytes.vtk",
    ] {
        if name.contains("zlib") && !cfg!(feature = "compress") {
            continue;
        }
        let mesh = fixture(name);
        assert_eq!(mesh.points, POINTS, "{name}");
        assert_eq!(mesh.node_tags, [1, 2, 3, 4, 5], "{name}");
        let cells = [
            ("tetra", vec![vec![0, 1, 2, 3], vec![1, 2, 3, 4]]),
            ("triangle", vec![vec![0, 2, 1]]),
        ];
        assert_eq!(rows(&mesh), cells, "{name}");
        let tags: Vec<&[u64]> = mesh
            .cells
            .iter()
            .map(|block| block.element_tags.as_slice())
            .collect();
        assert_eq!(tags, [&[1, 2][..], &[3]], "{name}");
        let data = [
            ("labels", vec![vec![1.0, 2.0], vec![7.0]]),
            ("young", vec![vec![1000.0, 2500.5], vec![0.5]]),
            (
                "fibre axis",
                vec![vec![1.0, 0.0, 0.0, 0.0, 0.5, 0.0], vec![0.0, 0.0, -2.0]],
            ),
        ];
        assert_eq!(cell_data(&mesh), data, "{name}");
        assert_eq!(
            point_data(&mesh),
            [("ids", vec![1.0, 1.0, 2.0, 2.0, 3.0])],
            "{name}"
        );
        assert_eq!(mesh.warnings, [], "{name}");
        assert!(mesh.physical_names.is_empty(), "{name}");
    }
}

#[cfg(feature = "compress")]
#[test]
fn numbers_compressed_by_lz4_are_refused_with_what_to_do() {
    let error = sinew_mesh::read_mesh_file(super::path("vtk-raw-lz4.vtu")).unwrap_err();
    let said = error.to_string();
    let end = ":1 (byte 0): Points: the numbers are compressed by \"vtkLZ4DataCompressor\"; zlib and plain numbers are read: in ParaView, \
               Save Data with the compressor ZLib or None";
    assert!(said.ends_with(end), "{said}");
}

#[test]
fn data_of_cells_and_points_come_into_the_mesh_of_a_simulation() {
    let tissue = fixture("vtk-raw.vtu").to_tet_mesh().unwrap();
    assert_eq!(tissue.data("labels").unwrap().values, [1.0, 2.0]);
    assert_eq!(tissue.data("young").unwrap().values, [1000.0, 2500.5]);
    assert_eq!(tissue.node_data[0].values, [1.0, 1.0, 2.0, 2.0, 3.0]);
}

#[test]
fn numbers_as_numpy_shows_them_are_read_in_every_text_format() {
    for (name, spellings) in [
        (
            "vtk-4.2-text.vtk",
            [
                ("2500.5", "np.float64(2500.5)"),
                ("CELL_TYPES 3", "CELL_TYPES np.int64(3)"),
            ],
        ),
        (
            "vtk-5.1-text.vtk",
            [
                ("2500.5", "np.float32(2500.5)"),
                ("CELL_DATA 3", "CELL_DATA np.int64(3)"),
            ],
        ),
        (
            "vtk-ascii.vtu",
            [
                ("1000 2500.5", "1000 np.longdouble(2500.5)"),
                ("1000 np", "np.uint16(1000) np"),
            ],
        ),
        (
            "meshio.mesh",
            [
                ("\n1 2 3 4 1", "\n1 np.int32(2) 3 4 np.uint8(1)"),
                ("Vertices\n5", "Vertices\nnp.int64(5)"),
            ],
        ),
        (
            "flat.inp",
            [
                ("5, 1.0, 1.0, 1.0", "5, np.float64(1.0), 1.0, 1.0"),
                ("2, 2, 3, 4, 5", "2, np.int64(2), 3, 4, 5"),
            ],
        ),
    ] {
        let mut text = std::fs::read_to_string(super::path(name)).unwrap();
        for (from, to) in spellings {
            text = crate::common::with(&text, from, to);
        }
        let format = MeshFormat::of_path(name.as_ref()).unwrap();
        // Places in warnings are others.
        let [read, plain] = [read(&text, format), fixture(name)].map(|mut mesh| {
            mesh.warnings.clear();
            mesh
        });
        assert_eq!(read, plain, "{name}");
    }
}

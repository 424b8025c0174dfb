//! Files that gmsh and meshio wrote give the arrays that meshio 5.3.5 reads from them.
//!
//! The packs under `data` are made by `meshes/reference.py`.

use std::collections::BTreeMap;
use std::fs;
use std::str::SplitAsciiWhitespace;

use sinew_mesh::{CellType, Mesh, read_msh};

/// The files of a pack, and meshio's result for each that it reads.
struct Pack {
    files: BTreeMap<String, Vec<u8>>,
    expected: BTreeMap<String, String>,
}

fn pack(name: &str) -> Pack {
    let path = format!("{}/tests/data/{name}.pack", env!("CARGO_MANIFEST_DIR"));
    let bytes = fs::read(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let mut pack = Pack {
        files: BTreeMap::new(),
        expected: BTreeMap::new(),
    };
    let mut rest = bytes.as_slice();
    while !rest.is_empty() {
        let end = rest
            .iter()
            .position(|&b| b == b'\n')
            .expect("a header line");
        let header = std::str::from_utf8(&rest[..end]).expect("headers are text");
        let words: Vec<&str> = header.split(' ').collect();
        let length: usize = words[2].parse().expect("a length");
        let content = &rest[end + 1..end + 1 + length];
        if words[0] == "file" {
            pack.files.insert(words[1].to_owned(), content.to_vec());
        } else {
            let text = String::from_utf8(content.to_vec()).expect("arrays are text");
            pack.expected.insert(words[1].to_owned(), text);
        }
        rest = &rest[end + 2 + length..];
    }
    pack
}

/// Dimension and entities, transformation, pairs of node tags minus one.
type Link = (Vec<i32>, Vec<f64>, Vec<Vec<u64>>);

/// meshio's arrays.
#[derive(Debug, Default, PartialEq)]
struct Arrays {
    points: Vec<Vec<f64>>,
    cells: Vec<(String, Vec<Vec<u32>>)>,
    field_data: BTreeMap<String, (i32, u8)>,
    point_data: BTreeMap<String, Vec<Vec<f64>>>,
    cell_data: BTreeMap<String, Vec<Vec<Vec<f64>>>>,
    cell_sets: BTreeMap<String, Vec<Vec<u32>>>,
    periodic: Vec<Link>,
}

fn parsed<T: std::str::FromStr>(words: SplitAsciiWhitespace<'_>) -> Vec<T> {
    words
        .map(|word| {
            word.parse()
                .unwrap_or_else(|_| panic!("{word:?} is no number"))
        })
        .collect()
}

fn expected_arrays(text: &str) -> Arrays {
    let mut arrays = Arrays::default();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let mut words = line.split_ascii_whitespace();
        let kind = words.next().expect("no line is empty");
        let name = |skipped: usize| {
            line.splitn(skipped + 2, ' ')
                .last()
                .expect("a name")
                .to_owned()
        };
        let mut rows = |count: usize| -> Vec<Vec<f64>> {
            lines
                .by_ref()
                .take(count)
                .map(|row| parsed(row.split_ascii_whitespace()))
                .collect()
        };
        let count =
            |word: Option<&str>| -> usize { word.expect("a count").parse().expect("a count") };
        match kind {
            "points" => arrays.points = rows(count(words.next())),
            "cells" => {
                let cell_type = words.next().expect("a type").to_owned();
                let rows = rows(count(words.next()));
                let rows = rows
                    .into_iter()
                    .map(|row| row.into_iter().map(|x| x as u32).collect());
                arrays.cells.push((cell_type, rows.collect()));
            }
            "field" => {
                let tag = count(words.next()) as i32;
                let dim = count(words.next()) as u8;
                arrays.field_data.insert(name(2), (tag, dim));
            }
            "point_data" => {
                let values = rows(count(words.next()));
                arrays.point_data.insert(name(1), values);
            }
            "cell_data" => {
                let blocks = (0..count(words.next()))
                    .map(|_| {
                        let header = rows_header(&mut lines);
                        lines
                            .by_ref()
                            .take(header)
                            .map(|row| parsed(row.split_ascii_whitespace()))
                            .collect()
                    })
                    .collect();
                arrays.cell_data.insert(name(1), blocks);
            }
            "cell_set" => {
                let blocks = (0..count(words.next()))
                    .map(|_| {
                        let line = lines.next().expect("a set");
                        parsed(
                            line.strip_prefix("set")
                                .expect("a set")
                                .split_ascii_whitespace(),
                        )
                    })
                    .collect();
                arrays.cell_sets.insert(name(1), blocks);
            }
            "periodic" => {
                let pairs = count(words.next());
                let entities: Vec<i32> = words
                    .by_ref()
                    .take(3)
                    .map(|word| word.parse().expect("a tag"))
                    .collect();
                let affine = parsed(words);
                let pairs = lines
                    .by_ref()
                    .take(pairs)
                    .map(|row| parsed(row.split_ascii_whitespace()))
                    .collect();
                arrays.periodic.push((entities, affine, pairs));
            }
            other => panic!("{other:?}"),
        }
    }
    arrays
}

fn rows_header(lines: &mut std::str::Lines<'_>) -> usize {
    let line = lines.next().expect("a block");
    line.strip_prefix("block ")
        .expect("a block")
        .parse()
        .expect("a count")
}

fn rows(values: &[f64], components: usize) -> Vec<Vec<f64>> {
    values
        .chunks_exact(components)
        .map(<[f64]>::to_vec)
        .collect()
}

/// The mesh in meshio's arrangement, limited to meshio's contents.
fn arrays_of(mesh: &Mesh) -> Arrays {
    let singles = |values: Vec<i32>| values.into_iter().map(|x| vec![f64::from(x)]).collect();
    let mut arrays = Arrays {
        points: mesh.points.iter().map(|point| point.to_vec()).collect(),
        ..Arrays::default()
    };
    for block in &mesh.cells {
        let rows = block.cells().map(<[u32]>::to_vec).collect();
        arrays.cells.push((block.kind.name().to_owned(), rows));
    }
    for (name, tag, dim) in mesh.field_data() {
        arrays.field_data.insert(name.to_owned(), (tag, dim));
    }
    for data in &mesh.point_data {
        arrays
            .point_data
            .insert(data.name.clone(), rows(&data.values, data.components));
    }
    if !mesh.node_entities.is_empty() {
        let dim_tags = mesh
            .node_entities
            .iter()
            .map(|e| vec![f64::from(e.dim), f64::from(e.tag)]);
        arrays
            .point_data
            .insert("gmsh:dim_tags".to_owned(), dim_tags.collect());
    }
    for data in &mesh.cell_data {
        let blocks = data
            .blocks
            .iter()
            .map(|values| rows(values, data.components));
        arrays.cell_data.insert(data.name.clone(), blocks.collect());
    }
    let physical = mesh.cells.iter().map(|block| {
        let firsts = (0..block.len()).map(|cell| block.physical.first_of(cell));
        singles(firsts.collect())
    });
    // meshio's version 4.0 has groups as data only.
    let key = "gmsh:physical".to_owned();
    arrays
        .cell_data
        .entry(key)
        .or_insert_with(|| physical.collect());
    let geometrical = mesh
        .cells
        .iter()
        .map(|block| singles(block.geometrical.clone()));
    arrays
        .cell_data
        .insert("gmsh:geometrical".to_owned(), geometrical.collect());
    for set in mesh.cell_sets() {
        arrays.cell_sets.insert(set.name, set.blocks);
    }
    for link in &mesh.periodic {
        let entities = vec![i32::from(link.dim), link.entity, link.master];
        let pairs = link
            .node_tags
            .iter()
            .map(|pair| pair.map(|tag| tag - 1).to_vec());
        arrays
            .periodic
            .push((entities, link.affine.clone(), pairs.collect()));
    }
    arrays
}

/// Compares the contents of meshio; contents that it leaves out are not compared.
fn assert_same(name: &str, mesh: &Mesh, expected: &Arrays) {
    let mut read = arrays_of(mesh);
    read.point_data
        .retain(|key, _| expected.point_data.contains_key(key));
    read.cell_data
        .retain(|key, _| expected.cell_data.contains_key(key));
    if expected.cell_sets.is_empty() {
        read.cell_sets.clear();
    }
    if expected.periodic.is_empty() {
        read.periodic.clear();
    }
    if name.starts_with("reversed") {
        // meshio gives no cells to a group whose tag has a sign.
        for (key, blocks) in &expected.cell_sets {
            for (block, cells) in blocks
                .iter()
                .enumerate()
                .filter(|(_, cells)| !cells.is_empty())
            {
                assert_eq!(&read.cell_sets[key][block], cells, "{name}: {key}");
            }
        }
        read.cell_sets = expected.cell_sets.clone();
    }
    assert_eq!(read.points, expected.points, "{name}: points");
    for (block, (read, expected)) in read.cells.iter().zip(&expected.cells).enumerate() {
        assert_eq!(read, expected, "{name}: cells of block {block}");
    }
    assert_eq!(read.cell_data, expected.cell_data, "{name}: cell data");
    assert_eq!(read.cell_sets, expected.cell_sets, "{name}: cell sets");
    assert_eq!(&read, expected, "{name}");
}

fn read(name: &str, bytes: &[u8]) -> Mesh {
    read_msh(bytes).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn assert_pack_is_read(pack: &Pack) {
    for (name, bytes) in &pack.files {
        let mesh = read(name, bytes);
        if let Some(expected) = pack.expected.get(name) {
            assert_same(name, &mesh, &expected_arrays(expected));
        }
    }
}

#[test]
fn every_cell_type_in_every_version_and_encoding_of_meshio() {
    let pack = pack("cell-types");
    assert_pack_is_read(&pack);
    for kind in CellType::ALL.iter().filter(|kind| kind.node_count() <= 30) {
        for version in ["2.2", "4.0", "4.1"] {
            for encoding in ["ascii", "binary"] {
                let name = format!("{kind}-{version}-{encoding}");
                assert!(pack.expected.contains_key(&name), "{name}");
            }
        }
    }
}

#[test]
fn groups_and_data_of_meshio() {
    let pack = pack("meshio-data");
    assert_pack_is_read(&pack);
    assert_eq!(pack.files.len(), pack.expected.len());
    for name in ["data-4.0-ascii", "data-4.0-binary", "data-4.0-ascii-repr"] {
        let mesh = read(name, &pack.files[name]);
        assert_eq!(
            mesh.cells[0].physical.of(0),
            [2],
            "{name}: groups that are data are groups"
        );
        assert_eq!(mesh.cells[1].physical.of(1), [7], "{name}");
    }
    let mesh = read("repr", &pack.files["data-4.1-ascii-repr"]);
    let is_named = |w: &sinew_mesh::Warning| w.message.contains("np.float64");
    assert!(mesh.warnings.iter().any(is_named), "{:?}", mesh.warnings);
}

#[test]
fn files_of_gmsh() {
    let pack = pack("gmsh");
    assert_pack_is_read(&pack);
    let unread: Vec<_> = pack
        .files
        .keys()
        .filter(|name| !pack.expected.contains_key(*name))
        .collect();
    assert!(
        unread.iter().all(|name| name.starts_with("partitioned")),
        "{unread:?}"
    );
}

/// meshio does not read version 1, but version 2.2 of the same mesh, without names.
#[test]
fn files_of_gmsh_in_version_1() {
    let pack = pack("version-1");
    assert_pack_is_read(&pack);
    assert_eq!(pack.files.len(), 4);
    assert_eq!(pack.files.len(), pack.expected.len());
}

/// Each mid-edge node lies in the middle of the edge that VTK's file formats give it.
#[test]
fn mid_edge_nodes_lie_at_edge_midpoints() {
    let pack = pack("gmsh");
    let tetra: &[(usize, usize)] = &[(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];
    let hexahedron: &[(usize, usize)] = &[
        (0, 1),
        (1, 2),
        (2, 3),
        (3, 0),
        (4, 5),
        (5, 6),
        (6, 7),
        (7, 4),
        (0, 4),
        (1, 5),
        (2, 6),
        (3, 7),
    ];
    let wedge: &[(usize, usize)] = &[
        (0, 1),
        (1, 2),
        (2, 0),
        (3, 4),
        (4, 5),
        (5, 3),
        (0, 3),
        (1, 4),
        (2, 5),
    ];
    let pyramid: &[(usize, usize)] = &[
        (0, 1),
        (1, 2),
        (2, 3),
        (3, 0),
        (0, 4),
        (1, 4),
        (2, 4),
        (3, 4),
    ];
    let edges = |kind: CellType| match kind {
        CellType::Line3 => Some((2, &tetra[..1])),
        CellType::Triangle6 => Some((3, &tetra[..3])),
        CellType::Quad8 | CellType::Quad9 => Some((4, &hexahedron[..4])),
        CellType::Tetra10 => Some((4, tetra)),
        CellType::Hexahedron20 | CellType::Hexahedron27 => Some((8, hexahedron)),
        CellType::Wedge15 => Some((6, wedge)),
        CellType::Pyramid13 => Some((5, pyramid)),
        // Left in gmsh's order, as meshio does.
        CellType::Wedge18 | CellType::Pyramid14 => None,
        _ => None,
    };
    let mut seen: Vec<CellType> = Vec::new();
    for (name, bytes) in &pack.files {
        let mesh = read(name, bytes);
        for block in &mesh.cells {
            let Some((corners, edges)) = edges(block.kind) else {
                continue;
            };
            for row in block.cells() {
                let point = |i: usize| mesh.points[row[i] as usize];
                for (i, &(a, b)) in edges.iter().enumerate() {
                    for axis in 0..3 {
                        let middle = f64::midpoint(point(a)[axis], point(b)[axis]);
                        let found = point(corners + i)[axis];
                        assert!(
                            (found - middle).abs() < 1e-12,
                            "{name}: {} node {}",
                            block.kind,
                            corners + i
                        );
                    }
                }
            }
            seen.push(block.kind);
        }
    }
    seen.sort_unstable();
    seen.dedup();
    let names: Vec<&str> = seen.iter().map(|kind| kind.name()).collect();
    assert_eq!(
        names,
        [
            "line3",
            "triangle6",
            "quad9",
            "tetra10",
            "hexahedron27",
            "quad8",
            "hexahedron20",
            "wedge15",
            "pyramid13"
        ]
    );
}

/// A partitioned file has the cells of the whole one, in the same groups.
#[test]
fn partitioned_files_have_the_cells_of_the_whole() {
    let pack = pack("gmsh");
    for label in [
        "2.2-ascii",
        "2.2-binary",
        "4-ascii",
        "4.1-ascii",
        "4.1-binary",
    ] {
        let members = |name: String| {
            let mesh = read(&name, &pack.files[&name]);
            let tissue = mesh
                .to_tet_mesh()
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            let mut volumes: Vec<(String, usize)> = tissue
                .groups
                .iter()
                .map(|group| (group.name.clone(), group.members.len()))
                .collect();
            volumes.sort();
            let volume: f64 = tissue.signed_volumes().iter().sum();
            assert!((volume - 1.5).abs() < 1e-12, "{name}: {volume}");
            (tissue.tets.len(), volumes)
        };
        assert_eq!(
            members(format!("partitioned-{label}")),
            members(format!("boxes-{label}")),
            "{label}"
        );
    }
}

//! Refinement of meshes: invariants, sizes and shapes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::common::read;
use proptest::prelude::*;
use sinew_mesh::structured::{Split, block, cube};
use sinew_mesh::{
    GroupMembers, MshEncoding, MshVersion, TetMesh, read_msh, read_msh_file, write_msh,
};

fn organ() -> TetMesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/organ.msh");
    let mesh = read_msh_file(path).expect("it is in the repository");
    mesh.to_tet_mesh().expect("it has tetrahedra")
}

fn area(mesh: &TetMesh, triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|node| mesh.points[node as usize]);
    let (u, v) = (
        [0, 1, 2].map(|i| b[i] - a[i]),
        [0, 1, 2].map(|i| c[i] - a[i]),
    );
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    normal.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
}

/// Volume, area, length or number of the members.
fn measure(mesh: &TetMesh, members: &GroupMembers) -> f64 {
    let point = |node: u32| mesh.points[node as usize];
    let distance = |[a, b]: [u32; 2]| {
        let squares = point(a)
            .into_iter()
            .zip(point(b))
            .map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    };
    match members {
        GroupMembers::Tets(tets) => tets.iter().map(|&tet| mesh.volume(tet as usize)).sum(),
        GroupMembers::Triangles(triangles) => triangles.iter().map(|&t| area(mesh, t)).sum(),
        GroupMembers::Lines(lines) => lines.iter().map(|&line| distance(line)).sum(),
        GroupMembers::Nodes(nodes) => nodes.len() as f64,
    }
}

/// Number of tetrahedra that share each face.
fn faces(mesh: &TetMesh) -> BTreeMap<[u32; 3], usize> {
    let mut faces = BTreeMap::new();
    for &[a, b, c, d] in &mesh.tets {
        for mut face in [[a, b, c], [a, b, d], [a, c, d], [b, c, d]] {
            face.sort_unstable();
            *faces.entry(face).or_default() += 1;
        }
    }
    faces
}

/// The mean ratio of a tetrahedron, 12 (3 V)^(2/3) over the sum of its squared edges: 1 for a regular one, 0 for a flat
/// one. Returns the worst of a mesh.
fn worst_shape(mesh: &TetMesh) -> f64 {
    let ratios = mesh
        .tets
        .iter()
        .zip(mesh.signed_volumes())
        .map(|(tet, volume)| {
            let edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
            let squares = edges.map(|(a, b)| {
                let (a, b) = (mesh.points[tet[a] as usize], mesh.points[tet[b] as usize]);
                a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
            });
            12.0 * (3.0 * volume.abs()).powf(2.0 / 3.0) / squares.iter().sum::<f64>()
        });
    ratios.fold(f64::INFINITY, f64::min)
}

#[test]
fn volumes_areas_and_groups_stay_and_inner_faces_are_shared_by_two() {
    let coarse = organ();
    let fine = coarse.refined().expect("it is small");
    assert_eq!(fine.tets.len(), 8 * coarse.tets.len());
    assert_eq!(
        fine.points.len(),
        coarse.points.len() + coarse.edges().len()
    );
    for (tet, volume) in coarse.signed_volumes().into_iter().enumerate() {
        for child in 8 * tet..8 * tet + 8 {
            let share = fine.volume(child) / volume;
            assert!((share - 0.125).abs() < 1e-9, "{tet}: {share}");
        }
    }
    assert_eq!(fine.groups.len(), coarse.groups.len());
    for (fine_group, group) in fine.groups.iter().zip(&coarse.groups) {
        let name = |g: &sinew_mesh::Group| (g.name.clone(), g.dim, g.tag);
        assert_eq!(name(fine_group), name(group));
        let factor = [1, 2, 4, 8][usize::from(group.dim)];
        assert_eq!(fine_group.members.len(), factor * group.members.len());
        let (before, after) = (
            measure(&coarse, &group.members),
            measure(&fine, &fine_group.members),
        );
        assert!((after / before - 1.0).abs() < 1e-12, "{}", group.name);
    }
    let faces = faces(&fine);
    for group in &fine.groups {
        if let GroupMembers::Triangles(triangles) = &group.members {
            let are_faces = |&t: &[u32; 3]| faces.contains_key(&sorted(t));
            assert!(triangles.iter().all(are_faces), "{}", group.name);
        }
    }
    let boundary: BTreeSet<[u32; 3]> = fine.boundary(None).into_iter().map(sorted).collect();
    assert_eq!(boundary.len(), 4 * coarse.boundary(None).len());
    for (face, count) in faces {
        let expected = if boundary.contains(&face) { 1 } else { 2 };
        assert_eq!(count, expected, "{face:?}");
    }
    assert_eq!(fine.notes, coarse.notes);
}

fn sorted(mut face: [u32; 3]) -> [u32; 3] {
    face.sort_unstable();
    face
}

/// The corners of each tetrahedron in sixteenths, unordered.
fn tets_in_sixteenths(mesh: &TetMesh) -> BTreeSet<BTreeSet<[u32; 3]>> {
    let corner = |&node: &u32| mesh.points[node as usize].map(|x| (x * 16.0) as u32);
    let tets = mesh.tets.iter().map(|tet| tet.iter().map(corner).collect());
    tets.collect()
}

#[test]
fn a_cube_of_equal_diagonals_becomes_the_one_with_twice_as_many_cells() {
    let mut fine = cube(2, 1.0, Split::Kuhn).expect("valid");
    for cells in [4, 8] {
        fine = fine.refined().expect("it is small");
        let expected = cube(cells, 1.0, Split::Kuhn).expect("valid");
        assert_eq!(tets_in_sixteenths(&fine), tets_in_sixteenths(&expected));
        for group in &expected.groups {
            let found = fine.group(&group.name).expect("groups stay");
            let nodes = |mesh: &TetMesh, group| -> BTreeSet<[u32; 3]> {
                let nodes = mesh.group_nodes(group);
                let place = |&node: &u32| mesh.points[node as usize].map(|x| (x * 16.0) as u32);
                nodes.iter().map(place).collect()
            };
            assert_eq!(nodes(&fine, found), nodes(&expected, group));
        }
        assert!(fine.signed_volumes().iter().all(|&volume| volume > 0.0));
    }
}

#[test]
fn groups_that_overlap_and_groups_of_lines_and_points_go_through_a_file() {
    let mut coarse = block([2, 1, 1], [0.2, 0.1, 0.1], Split::Mirrored).expect("valid");
    let edge = coarse.edges()[0];
    let face = coarse.boundary(None)[3];
    let add = |mesh: &mut TetMesh, name: &str, members| {
        mesh.add_group(name, members).expect("it is new");
    };
    add(&mut coarse, "half", GroupMembers::Tets((0..6).collect()));
    add(&mut coarse, "patch", GroupMembers::Triangles(vec![face]));
    add(&mut coarse, "thread", GroupMembers::Lines(vec![edge]));
    add(&mut coarse, "pins", GroupMembers::Nodes(vec![0, 5]));
    let fine = coarse.refined().expect("it is small");
    for version in [MshVersion::V22, MshVersion::V41] {
        let mut file = Vec::new();
        write_msh(&fine.to_mesh(), version, MshEncoding::Binary, &mut file).expect("it fits");
        let back = read_msh(&file).expect("it was written").to_tet_mesh();
        let back = back.expect("it has tetrahedra");
        for group in &fine.groups {
            let found = back.group(&group.name).expect("groups stay");
            let (there, here) = (
                measure(&back, &found.members),
                measure(&fine, &group.members),
            );
            assert_eq!(found.members.len(), group.members.len(), "{}", group.name);
            assert!((there / here - 1.0).abs() < 1e-12, "{}", group.name);
        }
    }
    let counts: Vec<(&str, usize)> = fine
        .groups
        .iter()
        .map(|group| (group.name.as_str(), group.members.len()))
        .collect();
    assert_eq!(counts[1], ("half", 48));
    let names = ["patch", "thread", "pins"];
    let found = names.map(|name| fine.group(name).map(|group| group.members.len()));
    assert_eq!(found, [Ok(4), Ok(2), Ok(2)]);
}

#[test]
fn old_nodes_keep_their_tags_and_new_ones_come_after() {
    let mut coarse = cube(1, 1.0, Split::Kuhn).expect("valid");
    coarse.node_tags = vec![5, 4, 40, 7, 8, 9, 10, 11];
    let fine = coarse.refined().expect("it is small");
    assert_eq!(fine.points[..8], coarse.points);
    assert_eq!(fine.node_tags[..8], coarse.node_tags);
    let new: Vec<u64> = (41..).take(fine.points.len() - 8).collect();
    assert_eq!(fine.node_tags[8..], new);
    assert_eq!(fine.tet_tags, (1..=48).collect::<Vec<u64>>());
    coarse.node_tags[2] = u64::MAX - 3;
    let fine = coarse.refined().expect("it is small");
    assert_eq!(fine.node_tags, (1..=27).collect::<Vec<u64>>());
}

#[test]
fn cells_of_groups_off_the_edges_of_tetrahedra_stay_and_are_named() {
    let mesh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 3 \"across\"\n$EndPhysicalNames\n$Nodes\n5\n\
                1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n$Elements\n4\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 2 3 4 5\n\
                3 1 2 3 1 1 5\n4 1 2 3 1 1 2\n$EndElements\n";
    let coarse = read(mesh).to_tet_mesh().expect("it has tetrahedra");
    let fine = coarse.refined().expect("it is small");
    let across = fine.group("across").expect("it stays");
    assert_eq!(across.members.len(), 3);
    assert_eq!(
        fine.notes,
        [
            "cells of group \"across\" (dimension 1, tag 3) that are not made of edges of tetrahedra and were not refined: 1"
        ]
    );
}

#[test]
fn inverted_and_collapsed_tetrahedra_stay_what_they_are() {
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let tets = vec![[0, 2, 1, 3], [0, 1, 2, 2]];
    let mesh = TetMesh::new(corners, tets).expect("indices are in range");
    let volumes = mesh.refined().expect("it is small").signed_volumes();
    assert!(volumes[..8].iter().all(|&volume| volume == -1.0 / 48.0));
    assert!(volumes[8..].iter().all(|&volume| volume == 0.0));
}

#[test]
fn a_regular_tetrahedron_keeps_the_known_shape_of_its_inner_parts() {
    let corners = vec![
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let mut mesh = TetMesh::new(corners, vec![[0, 1, 2, 3]]).expect("valid");
    assert!((worst_shape(&mesh) - 1.0).abs() < 1e-12);
    // A quarter of a regular octahedron of edge 1, cut along a diagonal of length sqrt(2): its volume is sqrt(2)/12, and five of
    // its edges are 1 long.
    let expected = 12.0 * (2.0f64.sqrt() / 4.0).powf(2.0 / 3.0) / 7.0;
    for _ in 0..4 {
        mesh = mesh.refined().expect("it is small");
        assert!((worst_shape(&mesh) - expected).abs() < 1e-9);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Shapes after four refinements are no worse than after one, and the volume is that of the start.
    #[test]
    fn shapes_do_not_degrade_however_often_a_mesh_is_refined(
        corners in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 4),
        flatness in 0.03..1.0f64,
    ) {
        let corners: Vec<[f64; 3]> = corners.iter().map(|&[x, y, z]| [x, y, z * flatness]).collect();
        let start = TetMesh::new(corners, vec![[0, 1, 2, 3]]).expect("valid");
        prop_assume!(worst_shape(&start) > 1e-2);
        let mut mesh = start.refined().expect("it is small");
        let after_one = worst_shape(&mesh);
        for _ in 0..3 {
            mesh = mesh.refined().expect("it is small");
            prop_assert!(worst_shape(&mesh) > after_one * (1.0 - 1e-6));
        }
        prop_assert_eq!(mesh.tets.len(), 8usize.pow(4));
        let volume: f64 = mesh.signed_volumes().iter().sum();
        prop_assert!((volume / start.volume(0) - 1.0).abs() < 1e-10);
    }
}

//! Facts about the structured blocks.

use std::collections::HashMap;

use sinew_mesh::structured::{Split, StructuredError, block, cube};
use sinew_mesh::{GroupMembers, TetMesh};

const SPLITS: [Split; 2] = [Split::Kuhn, Split::Mirrored];

/// The number of tetrahedra at each face, by its sorted nodes.
fn tets_per_face(mesh: &TetMesh) -> HashMap<[u32; 3], usize> {
    let mut faces = HashMap::new();
    for &[a, b, c, d] in &mesh.tets {
        for mut face in [[a, b, c], [a, b, d], [a, c, d], [b, c, d]] {
            face.sort_unstable();
            *faces.entry(face).or_default() += 1;
        }
    }
    faces
}

fn triangles<'m>(mesh: &'m TetMesh, name: &str) -> &'m [[u32; 3]] {
    match &mesh.group(name).expect("the group exists").members {
        GroupMembers::Triangles(triangles) => triangles,
        other => panic!("{name} holds {other:?}"),
    }
}

/// Twice the area of a triangle as a vector along its normal.
fn normal(mesh: &TetMesh, triangle: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = triangle.map(|node| mesh.points[node as usize]);
    let (u, v) = (
        [0, 1, 2].map(|i| b[i] - a[i]),
        [0, 1, 2].map(|i| c[i] - a[i]),
    );
    [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ]
}

#[test]
fn ten_cells_make_the_known_counts() {
    for split in SPLITS {
        let mesh = cube(10, 0.2, split).expect("valid");
        assert_eq!(mesh.points.len(), 1331, "{split:?}");
        assert_eq!(mesh.tets.len(), 6000, "{split:?}");
        assert_eq!(mesh.edges().len(), 7930, "{split:?}");
        assert_eq!(mesh.node_tags, (1..=1331).collect::<Vec<u64>>());
        assert_eq!(mesh.tet_tags, (1..=6000).collect::<Vec<u64>>());
        assert_eq!(mesh.notes, [] as [&str; 0]);
    }
}

#[test]
fn edges_of_the_kuhn_cube_are_axes_and_diagonals() {
    let mesh = cube(10, 0.1, Split::Kuhn).expect("valid");
    let mut by_direction = [0; 4];
    for [a, b] in mesh.edges() {
        let (p, q) = (mesh.points[a as usize], mesh.points[b as usize]);
        by_direction[(0..3)
            .filter(|&axis| (p[axis] - q[axis]).abs() > 1e-9)
            .count()] += 1;
    }
    assert_eq!(by_direction, [0, 3630, 3300, 1000]);
}

#[test]
fn nodes_count_x_fastest_at_exact_multiples() {
    let mesh = block([2, 3, 4], [0.3, 0.9, 1.0], Split::Kuhn).expect("valid");
    for k in 0..=4 {
        for j in 0..=3 {
            for i in 0..=2 {
                let expected = [
                    i as f64 * 0.3 / 2.0,
                    j as f64 * 0.9 / 3.0,
                    k as f64 * 1.0 / 4.0,
                ];
                assert_eq!(mesh.points[i + 3 * (j + 4 * k)], expected);
            }
        }
    }
}

#[test]
fn blocks_fill_their_box_with_positive_tets_face_to_face() {
    for split in SPLITS {
        for (cells, size) in [([1, 1, 1], [1.0, 1.0, 1.0]), ([3, 2, 4], [0.3, 0.1, 2.0])] {
            let mesh = block(cells, size, split).expect("valid");
            let volumes = mesh.signed_volumes();
            let each = size[0] * size[1] * size[2] / mesh.tets.len() as f64;
            assert!(
                volumes.iter().all(|v| (v / each - 1.0).abs() < 1e-12),
                "{split:?} {cells:?}"
            );

            let faces = tets_per_face(&mesh);
            let on_box = |face: &[u32; 3]| {
                (0..3).any(|axis| {
                    let at = face.map(|node| mesh.points[node as usize][axis]);
                    at == [0.0; 3] || at == [size[axis]; 3]
                })
            };
            for (face, &count) in &faces {
                assert_eq!(
                    count,
                    if on_box(face) { 1 } else { 2 },
                    "{split:?} {cells:?} {face:?}"
                );
            }
            let [nx, ny, nz] = cells;
            let outer = faces.values().filter(|&&count| count == 1).count();
            assert_eq!(outer, 4 * (nx * ny + ny * nz + nz * nx));
        }
    }
}

#[test]
fn every_kuhn_tet_has_its_hexahedrons_diagonal() {
    let mesh = cube(3, 3.0, Split::Kuhn).expect("valid");
    for (index, tet) in mesh.tets.iter().enumerate() {
        let hexahedron = index / 6;
        let corner = [hexahedron % 3, hexahedron / 3 % 3, hexahedron / 9].map(|i| i as f64);
        let opposite = corner.map(|x| x + 1.0);
        let points = tet.map(|node| mesh.points[node as usize]);
        assert!(
            points.contains(&corner) && points.contains(&opposite),
            "tet {index}"
        );
    }
}

#[test]
fn mirrored_hexahedra_alternate_their_diagonals() {
    let mesh = cube(2, 2.0, Split::Mirrored).expect("valid");
    let edges = mesh.edges();
    // All eight diagonals meet in the middle, node (1, 1, 1) = 13.
    let corners = [0, 2, 6, 8, 18, 20, 24, 26];
    for corner in corners {
        let edge = [corner.min(13), corner.max(13)];
        assert!(edges.contains(&edge), "corner {corner}");
    }
    assert_ne!(mesh.tets, cube(2, 2.0, Split::Kuhn).expect("valid").tets);
    let first = |split| cube(2, 2.0, split).expect("valid").tets[..6].to_vec();
    assert_eq!(
        first(Split::Mirrored),
        first(Split::Kuhn),
        "hexahedron (0, 0, 0) is plain"
    );
}

#[test]
fn groups_are_the_faces_of_the_box() {
    for split in SPLITS {
        let mesh = block([2, 3, 4], [2.0, 3.0, 4.0], split).expect("valid");
        let tissue = mesh.group("tissue").expect("it exists");
        assert_eq!((tissue.dim, tissue.members.len()), (3, 144));
        assert_eq!(triangles(&mesh, "top").len(), 12);
        assert_eq!(triangles(&mesh, "bottom").len(), 12);
        assert_eq!(triangles(&mesh, "sides").len(), 2 * 2 * (2 * 4 + 3 * 4));

        for (name, axis, at) in [("top", 2, 4.0), ("bottom", 2, 0.0)] {
            let nodes = mesh.group_nodes(mesh.group(name).expect("it exists"));
            assert_eq!(nodes.len(), 12, "{name}");
            assert!(
                nodes
                    .iter()
                    .all(|&node| mesh.points[node as usize][axis] == at),
                "{name}"
            );
        }
        let side_nodes = mesh.group_nodes(mesh.group("sides").expect("it exists"));
        let is_lateral = |p: &[f64; 3]| p[0] == 0.0 || p[0] == 2.0 || p[1] == 0.0 || p[1] == 3.0;
        let lateral = mesh.points.iter().filter(|p| is_lateral(p)).count();
        assert_eq!(side_nodes.len(), lateral);
        assert!(
            side_nodes
                .iter()
                .all(|&node| is_lateral(&mesh.points[node as usize]))
        );
    }
}

#[test]
fn surface_triangles_already_point_outwards() {
    for split in SPLITS {
        let mesh = cube(3, 0.6, split).expect("valid");
        let mut total = [0.0; 3];
        for name in ["sides", "top", "bottom"] {
            let given = triangles(&mesh, name);
            assert_eq!(
                mesh.outward_triangles(given).as_deref(),
                Ok(given),
                "{name}"
            );
            let turned: Vec<[u32; 3]> = given.iter().map(|&[a, b, c]| [b, a, c]).collect();
            let outward = mesh.outward_triangles(&turned).expect("on the surface");
            for (&back, &given) in outward.iter().zip(given) {
                let (back, given) = (normal(&mesh, back), normal(&mesh, given));
                assert!(
                    back.iter().zip(given).all(|(a, b)| (a - b).abs() < 1e-15),
                    "{name}"
                );
                total = [0, 1, 2].map(|axis| total[axis] + given[axis]);
            }
        }
        assert!(
            total.iter().all(|x| x.abs() < 1e-12),
            "the surface is closed: {total:?}"
        );
        let up: f64 = triangles(&mesh, "top")
            .iter()
            .map(|&t| normal(&mesh, t)[2] / 2.0)
            .sum();
        assert!(
            (up - 0.36).abs() < 1e-12,
            "the top has its area, upwards: {up}"
        );
    }
}

#[test]
fn what_cannot_be_built_is_refused() {
    let message = |result: Result<TetMesh, StructuredError>| match result {
        Err(error) => error.to_string(),
        Ok(mesh) => panic!("built {} tets", mesh.tets.len()),
    };
    let kuhn = |cells, size| message(block(cells, size, Split::Kuhn));
    insta::assert_snapshot!(
        kuhn([1, 0, 1], [1.0; 3]), @"the number of cells along y is 0; at least 1 is needed");
    insta::assert_snapshot!(
        kuhn([1; 3], [1.0, 1.0, 0.0]), @"the edge along z is 0.0 long; a positive, finite length is needed");
    insta::assert_snapshot!(
        kuhn([1; 3], [-0.5, 1.0, 1.0]), @"the edge along x is -0.5 long; a positive, finite length is needed");
    insta::assert_snapshot!(
        kuhn([1; 3], [f64::NAN, 1.0, 1.0]), @"the edge along x is NaN long; a positive, finite length is needed");
    insta::assert_snapshot!(
        kuhn([1; 3], [1.0, f64::INFINITY, 1.0]), @"the edge along y is inf long; a positive, finite length is needed");
    insta::assert_snapshot!(
        kuhn([10; 3], [1e308; 3]), @"10 cells along x on an edge of 1e308 cannot be told apart in floating point");
    insta::assert_snapshot!(
        kuhn([3; 3], [5e-324; 3]), @"3 cells along x on an edge of 5e-324 cannot be told apart in floating point");
    insta::assert_snapshot!(
        kuhn([895; 3], [1.0; 3]), @"895 x 895 x 895 cells make more than 4294967295 tetrahedra or nodes");
    for cells in [usize::MAX, usize::MAX / 2, 1 << 33] {
        let error = cube(cells, 1.0, Split::Mirrored);
        assert!(
            matches!(error, Err(StructuredError::TooLarge { .. })),
            "{error:?}"
        );
    }
}

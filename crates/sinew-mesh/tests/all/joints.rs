//! Bodies that seem to be connected: parts that touch, hinges, faces that do not match, tangled tetrahedra.

use sinew_mesh::structured::{Split, block};
use sinew_mesh::{CellBlock, CellType, Joints, Mesh, TetMesh};

/// A block at a position, with its axes cyclically permuted by a number of places.
fn block_at(cells: [usize; 3], size: [f64; 3], at: [f64; 3], split: Split, turn: usize) -> Mesh {
    let mut mesh = block(cells, size, split).expect("valid").to_mesh();
    for point in &mut mesh.points {
        *point = [0, 1, 2].map(|axis| point[axis] + at[axis]);
        point.rotate_right(turn);
    }
    mesh
}

/// Several meshes as one, without common nodes.
fn beside(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    let mut rows = Vec::new();
    for mesh in meshes {
        let first = all.points.len() as u32;
        all.points.extend(&mesh.points);
        let tets = mesh
            .cells
            .iter()
            .filter(|block| block.kind == CellType::Tetra);
        let nodes = tets.flat_map(|block| &block.connectivity);
        rows.extend(nodes.map(|node| node + first));
    }
    all.cells = vec![CellBlock::new(CellType::Tetra, rows)];
    all
}

fn joints(mesh: &Mesh) -> Joints {
    mesh.to_tet_mesh().expect("tetrahedra").joints()
}

fn of_tets(points: &[[f64; 3]], tets: &[[u32; 4]]) -> Joints {
    let mesh = TetMesh::new(points.to_vec(), tets.to_vec());
    mesh.expect("nodes are in range").joints()
}

const SIZE: [f64; 3] = [0.1, 0.025, 0.025];

#[test]
fn blocks_that_touch_node_by_node_are_two_parts_until_their_nodes_are_merged() {
    for (turn, unit) in [(0, 1.0), (1, 1000.0), (2, 1e-3)] {
        let size = SIZE.map(|x| x * unit);
        for jitter in [0.0, 1e-11] {
            let next = [size[0] * (1.0 + jitter), 0.0, 0.0];
            let left = block_at([8, 2, 3], size, [0.0; 3], Split::Mirrored, turn);
            let right = block_at([8, 2, 3], size, next, Split::Mirrored, turn);
            let far = block_at([1, 1, 1], size, [5.0 * unit; 3], Split::Mirrored, turn);
            let mut mesh = beside(&[left, right, far]);
            let check = mesh.check();
            let found = &check.joints;
            assert_eq!((found.parts, found.parts_apart), (3, 2), "{found:?}");
            assert_eq!((found.touching.total, found.mergeable), (12, 12));
            assert!(found.touching_partly.is_empty() && found.hinges.is_empty());
            let [place] = [found.touching.first[0]].map(|mut place| {
                place.rotate_left(turn);
                place
            });
            assert!((place[0] - size[0]).abs() < 1e-9 * unit, "{place:?}");
            let problems = check.problems().join("\n");
            assert!(problems.contains("--fix merge-nodes"), "{problems}");
            assert!(problems.contains("loose parts: 2"), "{problems}");
            assert_eq!(mesh.merge_nodes(), 12);
            let whole = joints(&mesh);
            assert_eq!((whole.parts, whole.parts_apart), (2, 2));
            assert!(whole.is_clean(), "{whole:?}");
            assert_eq!(mesh.merge_nodes(), 0);
            let one = block([16, 2, 3], [0.2, 0.025, 0.025], Split::Mirrored).expect("valid");
            assert_eq!(mesh.points.len() - 8, one.points.len());
        }
    }
}

#[test]
fn a_block_that_touches_a_larger_one_or_one_of_other_cells_touches_partly() {
    let large = || block_at([4, 4, 4], [0.04; 3], [0.0; 3], Split::Kuhn, 0);
    // Beside the other's nodes; on a piece of it; with finer cells.
    for (cells, size, at) in [
        ([2, 2, 2], [0.02; 3], [0.04, 0.005, 0.003]),
        ([3, 5, 7], [0.04; 3], [0.04, 0.0, 0.0]),
        ([1, 1, 1], [0.3; 3], [0.04, -0.1, -0.1]),
    ] {
        let mesh = beside(&[large(), block_at(cells, size, at, Split::Kuhn, 0)]);
        let found = joints(&mesh);
        assert!(found.touching_partly.total > 0, "{found:?}");
        assert_eq!((found.parts, found.parts_apart), (2, 1));
        assert!(found.mismatched.is_empty() && found.hinges.is_empty());
    }
    // A gap of a hundredth of an edge is none.
    let apart = block_at([2, 2, 2], [0.02; 3], [0.0402, 0.005, 0.003], Split::Kuhn, 0);
    let found = joints(&beside(&[large(), apart]));
    assert!(found.is_clean() && found.parts_apart == 2, "{found:?}");
}

/// The faces of a cut into a block coincide node by node, and the block is connected next to them.
#[test]
fn cuts_within_a_part_are_no_finding_and_stay() {
    let whole = block([4, 2, 2], [0.04, 0.02, 0.02], Split::Mirrored).expect("valid");
    let mut mesh = whole.to_mesh();
    let is_cut = |p: [f64; 3]| (p[0] - 0.02).abs() < 1e-9 && p[2] > 0.015;
    let cut: Vec<u32> = (0u32..)
        .zip(&whole.points)
        .filter(|(_, p)| is_cut(**p))
        .map(|(node, _)| node)
        .collect();
    assert_eq!(cut.len(), 3);
    let tets = mesh.cells.last_mut().expect("the tetrahedra come last");
    for row in tets.connectivity.chunks_exact_mut(4) {
        let middle: f64 = row.iter().map(|node| mesh.points[*node as usize][0]).sum();
        for node in row.iter_mut().filter(|_| middle > 4.0 * 0.02) {
            if let Some(place) = cut.iter().position(|of| of == node) {
                *node = (mesh.points.len() + place) as u32;
            }
        }
    }
    for node in cut {
        mesh.points.push(whole.points[node as usize]);
    }
    mesh.node_tags.clear();
    let check = mesh.check();
    assert!(check.joints.is_clean() && check.is_clean(), "{check}");
    assert_eq!(mesh.merge_nodes(), 0);
}

#[test]
fn halves_of_a_beam_on_one_node_or_one_edge_hang_by_hinges() {
    let right = |at: [f64; 3]| block_at([2, 2, 2], [0.02; 3], at, Split::Mirrored, 0);
    let left = || block_at([2, 2, 2], [0.02; 3], [0.0; 3], Split::Mirrored, 0);
    // By a corner, and by an edge of two cells.
    for (at, nodes) in [([0.02; 3], 1), ([0.02, 0.02, 0.0], 3)] {
        let mut mesh = beside(&[left(), right(at)]);
        assert!(
            joints(&mesh).is_clean(),
            "parts that meet at a node do not touch by faces"
        );
        assert_eq!(mesh.merge_nodes(), 0);
        let points = mesh.points.clone();
        for node in &mut mesh.cells[0].connectivity {
            let place = points[*node as usize];
            let first = points
                .iter()
                .position(|p| (0..3).all(|i| (p[i] - place[i]).abs() < 1e-12));
            *node = first.expect("itself at least") as u32;
        }
        let found = joints(&mesh);
        assert_eq!((found.hinges.total, found.hinged_blocks), (nodes, 2));
        assert_eq!(found.parts, 1);
        let check = mesh.check();
        assert!(check.problems()[1].contains("hinges: 2 blocks"), "{check}");
    }
}

#[test]
fn faces_split_along_different_diagonals_do_not_match() {
    // Two pyramids on one square, each cut along another diagonal.
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.5, 1.0],
        [0.5, 0.5, -1.0],
    ];
    let above = [[0, 1, 2, 4], [0, 2, 3, 4]];
    let other = [[1, 0, 3, 5], [1, 3, 2, 5]];
    let found = of_tets(&points, &[above, other].concat());
    assert_eq!((found.parts, found.mismatched.total), (1, 4), "{found:?}");
    assert!(found.hanging.is_empty() && found.hinges.is_empty());
    let (_, words) = &found.findings()[0];
    assert!(words.contains("different diagonals"), "{words}");
    let same = [[0, 2, 1, 5], [0, 3, 2, 5]];
    assert!(of_tets(&points, &[above, same].concat()).is_clean());
}

#[test]
fn nodes_on_a_face_of_a_larger_neighbour_hang() {
    // A tetrahedron on one half of a face, with a node in the middle of its edge.
    let points = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.3, 0.3, -1.0],
    ];
    let found = of_tets(&points, &[[0, 1, 2, 3], [0, 2, 4, 5]]);
    assert_eq!(
        (found.hanging.total, found.hanging.first[0]),
        (1, points[4])
    );
    assert_eq!(found.mismatched.total, 2, "{found:?}");
    assert!(found.hinges.is_empty());
    let (_, words) = &found.findings()[0];
    assert!(words.contains("1 nodes hang"), "{words}");
}

#[test]
fn mirrored_meshes_mixed_windings_and_tangled_ones_are_three_findings() {
    let good = block([2, 2, 2], [0.02; 3], Split::Kuhn)
        .expect("valid")
        .to_mesh();
    let mut mirrored = good.clone();
    mirrored
        .points
        .iter_mut()
        .for_each(|point| point[1] = -point[1]);
    let check = mirrored.check();
    assert!(
        check.problems()[0].contains("the mesh is mirrored"),
        "{check}"
    );
    mirrored.orient();
    assert!(mirrored.check().is_clean());

    let mut mixed = good;
    let tets = mixed.cells.last_mut().expect("the tetrahedra come last");
    for row in tets.connectivity.chunks_exact_mut(4).step_by(3) {
        row.swap(1, 2);
    }
    let check = mixed.check();
    assert!(check.problems()[0].contains("--fix orient"), "{check}");
    mixed.orient();
    assert!(mixed.check().is_clean());

    let mut tangled = Mesh::default();
    tangled.points = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.2; 3],
    ];
    for rows in [
        [0, 1, 2, 3, 1, 2, 3, 4],
        [0, 1, 2, 3, 2, 1, 3, 4],
        [0, 2, 1, 3, 1, 2, 3, 4],
    ] {
        tangled.cells = vec![CellBlock::new(CellType::Tetra, rows.to_vec())];
        for _ in 0..2 {
            let check = tangled.check();
            assert_eq!(check.joints.tangled.total, 1, "{check}");
            let problems = check.problems().join("\n");
            assert!(problems.contains("this cannot be repaired"), "{problems}");
            assert!(!problems.contains("--fix orient"), "{problems}");
            tangled.orient();
        }
    }
}

#[test]
fn nodes_on_edges_of_second_order_follow_their_corners() {
    // Two tetrahedra on the same face, each with nodes of its own.
    let corners = [
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ],
        [
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, -1.0],
        ],
    ];
    let edges = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    let mut mesh = Mesh::default();
    for tet in corners {
        mesh.points.extend(tet);
        let middle = |[a, b]: [usize; 2]| [0, 1, 2].map(|i| f64::midpoint(tet[a][i], tet[b][i]));
        mesh.points.extend(edges.map(middle));
    }
    mesh.cells = vec![CellBlock::new(CellType::Tetra10, (0..20).collect())];
    assert_eq!(mesh.check().joints.touching.total, 1);
    assert_eq!(mesh.merge_nodes(), 6);
    assert_eq!((mesh.points.len(), mesh.check().part_count), (14, 1));
    assert_eq!(mesh.check().orphans.total, 0);
}

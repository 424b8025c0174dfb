//! Parts of a mesh chosen by the values of data.

use sinew_mesh::structured::{Split, block};
use sinew_mesh::{Condition, DataValues, NodeData, Selection, SelectionError, TetData, TetMesh};

/// A bar of three cells along x with the labels 1, 2, 3 in tetrahedra, and x as data at nodes.
fn bar() -> TetMesh {
    let mut bar = block([3, 1, 1], [0.3, 0.1, 0.1], Split::Kuhn).unwrap();
    let label = |tet: &[u32; 4]| {
        let x = tet
            .iter()
            .map(|node| bar.points[*node as usize][0])
            .sum::<f64>()
            / 4.0;
        (x / 0.1).floor() + 1.0
    };
    let values: Vec<f64> = bar.tets.iter().map(label).collect();
    let at_nodes = bar.points.iter().map(|point| point[0]).collect();
    bar.data = vec![
        TetData {
            name: "labels".into(),
            step: 0,
            components: 1,
            values,
        },
        TetData {
            name: "fibre".into(),
            step: 0,
            components: 3,
            values: vec![1.0; 3 * bar.tets.len()],
        },
    ];
    bar.node_data = vec![NodeData {
        name: "x".into(),
        step: 0,
        components: 1,
        values: at_nodes,
    }];
    bar
}

fn with(name: &str, values: DataValues) -> Selection {
    let name = name.to_owned();
    Selection::new(vec![Condition::Data { name, values }])
}

fn labelled(labels: &[f64]) -> Selection {
    with("labels", DataValues::Equal(labels.to_vec()))
}

#[test]
fn data_of_tetrahedra_choose_tetrahedra_their_surface_and_their_nodes() {
    let bar = bar();
    let tets = |labels: &[f64]| labelled(labels).tets(&bar).unwrap();
    assert_eq!(tets(&[2.0]), (6..12).collect::<Vec<u32>>());
    assert_eq!(tets(&[1.0, 3.0]).len(), 12);
    // The nodes of the cell in the middle, and the four walls of it: the neighbours' walls between the same nodes are none.
    assert_eq!(labelled(&[2.0]).nodes(&bar).unwrap().len(), 8);
    assert_eq!(labelled(&[2.0]).triangles(&bar).unwrap().len(), 8);
    assert_eq!(labelled(&[1.0]).triangles(&bar).unwrap().len(), 10);
}

#[test]
fn data_at_nodes_choose_nodes_and_what_has_only_such() {
    let bar = bar();
    let part = with("x", DataValues::Between([0.05, 0.25]));
    assert_eq!(part.nodes(&bar).unwrap().len(), 8);
    assert_eq!(part.tets(&bar).unwrap(), (6..12).collect::<Vec<u32>>());
    assert_eq!(part.triangles(&bar).unwrap().len(), 8);
}

#[test]
fn data_and_places_must_both_hold() {
    let bar = bar();
    let Condition::Data { name, values } = labelled(&[2.0]).conditions()[0].clone() else {
        panic!("it is one of data");
    };
    let floor = Condition::facing([0.0, 0.0, -1.0], 10.0);
    let both = Selection::new(vec![Condition::Data { name, values }, floor]);
    assert_eq!(both.nodes(&bar).unwrap().len(), 4);
    assert_eq!(both.triangles(&bar).unwrap().len(), 2);
    assert_eq!(
        both.to_string(),
        "with labels = 2 and facing (0, 0, -1) within 10 degrees"
    );
}

#[test]
fn what_chooses_nothing_says_what_there_is() {
    let bar = bar();
    let said = |selection: &Selection| selection.tets(&bar).unwrap_err().to_string();
    assert_eq!(
        said(&labelled(&[4.0, 5.0])),
        "no tetrahedron is with labels = 4 or 5; of the values there are 1, 2, 3"
    );
    assert_eq!(
        said(&with("label", DataValues::Equal(vec![1.0]))),
        "no data at nodes or of tetrahedra are named \"label\"; there are \"fibre\", \"labels\", \"x\""
    );
    let error = with("fibre", DataValues::Equal(vec![1.0]))
        .nodes(&bar)
        .unwrap_err();
    assert!(
        matches!(error, SelectionError::NotOneNumber { components: 3, .. }),
        "{error}"
    );
}

#[test]
fn data_follow_a_finer_mesh_and_a_file() {
    let bar = bar();
    let fine = bar.refined().unwrap();
    assert_eq!(labelled(&[2.0]).tets(&fine).unwrap().len(), 48);
    for (point, x) in fine.points.iter().zip(&fine.node_data[0].values) {
        assert!((point[0] - x).abs() < 1e-15);
    }
    let mut file = Vec::new();
    sinew_mesh::write_msh41_ascii(&bar.to_mesh(), &mut file).unwrap();
    let back = sinew_mesh::read_msh(&file).unwrap().to_tet_mesh().unwrap();
    assert_eq!(back.node_data, bar.node_data);
}

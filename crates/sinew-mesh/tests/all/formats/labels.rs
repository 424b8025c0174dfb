//! Groups made of labels.

use super::fixture;
use sinew_mesh::{LabelError, MshEncoding, MshVersion, read_msh, write_msh};

#[test]
fn each_label_is_a_group_in_each_dimension_and_stays_so_in_a_file_of_gmsh() {
    let mut mesh = fixture("vtk-4.2-bytes.vtk");
    let made = mesh.groups_from_data("labels").unwrap();
    let made: Vec<_> = made
        .iter()
        .map(|group| (group.dim, group.name.as_str(), group.cells))
        .collect();
    assert_eq!(
        made,
        [(2, "labels_7", 1), (3, "labels_1", 1), (3, "labels_2", 1)]
    );
    for version in [MshVersion::V22, MshVersion::V41] {
        let mut file = Vec::new();
        write_msh(&mesh, version, MshEncoding::Text, &mut file).unwrap();
        let tissue = read_msh(&file).unwrap().to_tet_mesh().unwrap();
        let groups: Vec<_> = tissue
            .groups
            .iter()
            .map(|group| {
                (
                    group.dim,
                    group.tag,
                    group.name.as_str(),
                    group.members.len(),
                )
            })
            .collect();
        assert_eq!(
            groups,
            [
                (3, 1, "labels_1", 1),
                (3, 2, "labels_2", 1),
                (2, 7, "labels_7", 1)
            ]
        );
        assert_eq!(tissue.data("labels").unwrap().values, [1.0, 2.0]);
        assert_eq!(tissue.node_data[0].values, [1.0, 1.0, 2.0, 2.0, 3.0]);
    }
}

#[test]
fn groups_of_before_stay_and_their_tags_too() {
    let mut mesh = fixture("meshio.mesh");
    mesh.groups_from_data("medit:ref").unwrap();
    let names: Vec<_> = mesh
        .physical_names
        .iter()
        .map(|((dim, tag), name)| (*dim, *tag, name.as_str()))
        .collect();
    let expected = [
        (2, 1, "medit:ref_7"),
        (2, 7, "7"),
        (3, 1, "1"),
        (3, 2, "2"),
        (3, 3, "medit:ref_1"),
        (3, 4, "medit:ref_2"),
    ];
    assert_eq!(names, expected);
    assert_eq!(mesh.cells[0].physical.of(1), [2, 4]);
}

#[test]
fn what_is_no_label_is_refused() {
    let mesh = fixture("vtk-ascii.vtu");
    let refused = |name: &str| mesh.clone().groups_from_data(name).unwrap_err();
    assert_eq!(
        refused("label").to_string(),
        "no data of cells are named \"label\"; there are \"fibre axis\", \"labels\", \"young\""
    );
    assert_eq!(
        refused("young").to_string(),
        "the data \"young\" are no labels: 2500.5 in the cell with tag 2 is not a whole number below 2^53; a scene takes such data by \
         where = { data = { name = \"young\", between = [..] } }"
    );
    assert!(matches!(
        refused("fibre axis"),
        LabelError::NotScalar { components: 3, .. }
    ));
    let mut twice = mesh.clone();
    twice.groups_from_data("labels").unwrap();
    let taken = twice.groups_from_data("labels").unwrap_err();
    assert!(matches!(taken, LabelError::Taken { dim: 2, .. }), "{taken}");
}

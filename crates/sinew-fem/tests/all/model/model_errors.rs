//! The faults for which a problem is refused, and the messages.

use crate::common::{DENSITY, add_node_group, body, held, held_along, linear, load, springs};
use sinew_core::{Ramp, RampError};
use sinew_fem::{
    Cause, FemError, Fixed, Item, Law, LoadKind, LoadSpec, Model, On, Problem, Region, SpringRule,
};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

const KNOWN: &str = "the groups are \"tissue\" (dimension 3), \"sides\" (dimension 2), \
                     \"top\" (dimension 2), \"bottom\" (dimension 2)";

/// A mesh of two hexahedra along each edge, tags from 101.
fn mesh() -> TetMesh {
    let mut mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    mesh.tet_tags.iter_mut().for_each(|tag| *tag += 100);
    mesh
}

fn tissue() -> Problem {
    body(linear(3500.0, 0.45))
}

fn region(group: Option<&str>) -> Region {
    Region {
        group: group.map(Into::into),
        ..Region::new(linear(3500.0, 0.45), DENSITY)
    }
}

fn with_regions(groups: &[Option<&str>]) -> Problem {
    Problem::of(groups.iter().map(|group| region(*group)))
}

fn with_load(group: &str, kind: LoadKind) -> Problem {
    loaded_on(group.into(), kind)
}

fn loaded_on(on: On, kind: LoadKind) -> Problem {
    Problem {
        loads: vec![LoadSpec::new(on, kind)],
        ..tissue()
    }
}

fn add_group(mesh: &mut TetMesh, name: &str, dim: u8, members: GroupMembers) {
    mesh.groups.push(Group {
        name: name.into(),
        dim,
        tag: 99,
        members,
    });
}

fn refusal(mesh: &TetMesh, problem: &Problem) -> FemError {
    match Model::build(mesh, problem) {
        Err(error) => error,
        Ok(_) => panic!("accepted: {problem:?}"),
    }
}

#[track_caller]
fn refused(mesh: &TetMesh, problem: &Problem, item: Item, message: &str) -> Cause {
    let error = refusal(mesh, problem);
    println!("{error}");
    assert_eq!(error.to_string(), message);
    assert_eq!(error.item(), item);
    error.cause().clone()
}

#[test]
fn a_group_the_mesh_does_not_have() {
    let unknown = |cause| assert!(matches!(cause, Cause::Group(_)), "{cause:?}");
    unknown(refused(
        &mesh(),
        &with_regions(&[Some("tisue")]),
        Item::Region(0),
        &format!("region 1: no group is named \"tisue\", did you mean \"tissue\"?; {KNOWN}"),
    ));
    let problem = Problem {
        fixed: vec![held("bottom"), held("side")],
        ..tissue()
    };
    unknown(refused(
        &mesh(),
        &problem,
        Item::Fixed(1),
        &format!("support 2: no group is named \"side\", did you mean \"sides\"?; {KNOWN}"),
    ));
    for kind in [LoadKind::Pressure(1.0), LoadKind::Force([1.0; 3])] {
        unknown(refused(
            &mesh(),
            &with_load("lid", kind),
            Item::Load(0),
            &format!("load 1: no group is named \"lid\"; {KNOWN}"),
        ));
    }
}

#[test]
fn a_group_of_the_wrong_dimension() {
    let wrong = |cause, found| match cause {
        Cause::GroupDimension { dim, .. } => assert_eq!(dim, found),
        other => panic!("{other:?}"),
    };
    let cause = refused(
        &mesh(),
        &with_regions(&[Some("top")]),
        Item::Region(0),
        "region 1: group `top` has cells of dimension 2, expected a group of tetrahedra",
    );
    wrong(cause, 2);
    for kind in [LoadKind::Traction([1.0; 3]), LoadKind::Pressure(1.0)] {
        let cause = refused(
            &mesh(),
            &with_load("tissue", kind),
            Item::Load(0),
            "load 1: group `tissue` has cells of dimension 3, \
             expected a group of triangles (dimension 2)",
        );
        wrong(cause, 3);
    }
    let mut mesh = mesh();
    add_node_group(&mut mesh, "corner", |point| point == [0.0; 3]);
    let cause = refused(
        &mesh,
        &with_load("corner", LoadKind::Pressure(1.0)),
        Item::Load(0),
        "load 1: group `corner` has cells of dimension 0, \
         expected a group of triangles (dimension 2)",
    );
    wrong(cause, 0);
}

#[test]
fn regions_that_overlap() {
    let mut mesh = mesh();
    add_group(&mut mesh, "tumour", 3, GroupMembers::Tets(vec![4, 5]));
    let cause = refused(
        &mesh,
        &with_regions(&[None, Some("tumour")]),
        Item::Region(1),
        "region 2: tetrahedron 105 is in region 1 already; regions must not overlap",
    );
    assert_eq!(cause, Cause::RegionsOverlap { tag: 105, first: 1 });
}

#[test]
fn tetrahedra_in_no_region() {
    let mut mesh = mesh();
    add_group(&mut mesh, "tumour", 3, GroupMembers::Tets(vec![0, 1, 3]));
    let advice = "give a region for them, or one without a group for the whole mesh";
    let cause = refused(
        &mesh,
        &with_regions(&[Some("tumour")]),
        Item::Mesh,
        &format!("mesh: 45 tetrahedra are in no region (first: 103); {advice}"),
    );
    assert_eq!(
        cause,
        Cause::NoRegion {
            count: 45,
            tag: 103
        }
    );
    refused(
        &mesh,
        &Problem::default(),
        Item::Mesh,
        &format!("mesh: 48 tetrahedra are in no region (first: 101); {advice}"),
    );
}

#[test]
fn inverted_tetrahedra() {
    let mut mesh = mesh();
    for tet in [7, 30] {
        mesh.tets[tet].swap(0, 1);
    }
    let cause = refused(
        &mesh,
        &tissue(),
        Item::Mesh,
        "mesh: tetrahedron 108 is inverted (volume -2.083e-5 m3), 2 in all; `sinew mesh check --fix orient` \
         turns those that only count corners the other way, and says where a mesh is tangled",
    );
    assert!(
        matches!(
            cause,
            Cause::Inverted {
                tag: 108,
                count: 2,
                ..
            }
        ),
        "{cause:?}"
    );
}

#[test]
fn flat_tetrahedra() {
    let mut mesh = mesh();
    let [first, second, ..] = mesh.tets[2];
    mesh.tets[2][3] = second;
    mesh.tets[2][2] = first;
    let cause = refused(
        &mesh,
        &tissue(),
        Item::Mesh,
        "mesh: tetrahedron 103 is flat (volume 0.000e0 m3, longest edge 5.000e-2 m); \
         repair the mesh",
    );
    assert!(matches!(cause, Cause::Flat { tag: 103, .. }), "{cause:?}");
}

#[test]
fn places_that_are_no_numbers_make_no_volume() {
    for coordinate in [f64::NAN, f64::INFINITY] {
        let mut mesh = mesh();
        mesh.points[0][1] = coordinate;
        let error = refusal(&mesh, &tissue());
        println!("{error}");
        assert_eq!(error.item(), Item::Mesh);
        assert!(
            matches!(error.cause(), Cause::Flat { tag: 101, .. }),
            "{error}"
        );
    }
}

#[test]
fn supports_that_leave_nothing_free() {
    let axes = [
        [true, false, false],
        [false, true, false],
        [false, false, true],
    ];
    let problem = Problem {
        fixed: axes.map(|axes| held_along("tissue", axes)).to_vec(),
        ..tissue()
    };
    let cause = refused(
        &mesh(),
        &problem,
        Item::Fixed(2),
        "support 3: no degree of freedom is free: all 27 nodes are fixed; free some of them",
    );
    assert_eq!(cause, Cause::NothingFree { nodes: 27 });
}

#[test]
fn loads_that_act_on_nothing() {
    let vertical = [0.0, 0.0, -1.0];
    let kinds = [
        LoadKind::Traction(vertical),
        LoadKind::Pressure(1.0),
        LoadKind::Force(vertical),
    ];
    // Held altogether, and held along the load only.
    for axes in [[true; 3], [false, false, true]] {
        for kind in kinds {
            let problem = Problem {
                fixed: vec![held_along("top", axes)],
                ..with_load("top", kind)
            };
            let cause = refused(
                &mesh(),
                &problem,
                Item::Load(0),
                "load 1: all nodes of group `top` are fixed, so the load has no effect",
            );
            let on = "top".into();
            assert_eq!(cause, Cause::NothingLoaded { on });
        }
    }
}

#[test]
fn nodes_the_mesh_does_not_have() {
    let out_of_range = |cause| {
        let expected = Cause::NodeOutOfRange {
            node: 27,
            nodes: 27,
        };
        assert_eq!(cause, expected);
    };
    let words = "node index 27 is out of range: the mesh has 27 nodes, counted from 0";
    let nodes = On::Nodes(vec![3, 27, 90]);
    let triangles = On::Triangles(vec![[0, 1, 3], [26, 2, 27]]);
    for on in [nodes, triangles.clone()] {
        let problem = Problem {
            fixed: vec![Fixed::at(on.clone())],
            ..tissue()
        };
        let message = format!("support 1: {words}");
        out_of_range(refused(&mesh(), &problem, Item::Fixed(0), &message));
        let problem = loaded_on(on, LoadKind::Force([1.0; 3]));
        let message = format!("load 1: {words}");
        out_of_range(refused(&mesh(), &problem, Item::Load(0), &message));
    }
    for kind in [LoadKind::Traction([1.0; 3]), LoadKind::Pressure(1.0)] {
        let problem = loaded_on(triangles.clone(), kind);
        let message = format!("load 1: {words}");
        out_of_range(refused(&mesh(), &problem, Item::Load(0), &message));
    }
}

#[test]
fn nodes_where_a_load_needs_triangles() {
    for kind in [LoadKind::Traction([1.0; 3]), LoadKind::Pressure(1.0)] {
        let cause = refused(
            &mesh(),
            &loaded_on(On::Nodes(vec![0, 1, 3]), kind),
            Item::Load(0),
            "load 1: a traction or pressure acts on triangles, but 3 nodes are given",
        );
        assert_eq!(cause, Cause::NoTriangles { nodes: 3 });
    }
}

#[test]
fn pressure_on_triangles_off_the_surface() {
    let mut mesh = mesh();
    let [a, _, b, c] = mesh.tets[0];
    add_group(
        &mut mesh,
        "cut",
        2,
        GroupMembers::Triangles(vec![[a, b, c], [b, a, c]]),
    );
    add_group(
        &mut mesh,
        "askew",
        2,
        GroupMembers::Triangles(vec![[0, 1, 26]]),
    );
    for (group, complaint) in [
        (
            "cut",
            "lies inside the mesh, between the tetrahedra with tags [101, 106]",
        ),
        ("askew", "is not a face of any tetrahedron"),
    ] {
        let error = refusal(&mesh, &with_load(group, LoadKind::Pressure(1.0)));
        println!("{error}");
        let message = error.to_string();
        assert!(
            message.starts_with("load 1: triangle 0 with node tags"),
            "{message}"
        );
        assert!(message.contains(complaint), "{message}");
        assert_eq!(error.item(), Item::Load(0));
        assert!(matches!(error.cause(), Cause::Surface(_)), "{error:?}");
    }
}

#[track_caller]
fn value_refused(problem: &Problem, item: Item, name: &str, value: f64, expected: &str) {
    let message = format!("{item}: {name} = {value}: expected {expected}");
    let cause = refused(&mesh(), problem, item, &message);
    match cause {
        Cause::Value {
            quantity, found, ..
        } => {
            assert_eq!(quantity, name);
            assert_eq!(found.to_bits(), value.to_bits());
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn materials_of_impossible_numbers() {
    let material = |law| {
        Problem::of([
            region(Some("tissue")),
            Region {
                law,
                ..region(None)
            },
        ])
    };
    let item = Item::Region(1);
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut problem = with_regions(&[None]);
        problem.regions[0].density = value;
        let expected = "a finite density above 0 kg/m3";
        value_refused(&problem, Item::Region(0), "density", value, expected);

        let spring = springs(value, SpringRule::Lloyd, true);
        for law in [linear(value, 0.3), spring] {
            let expected = "a finite modulus above 0 Pa";
            value_refused(&material(law), item, "youngs_modulus", value, expected);
        }
    }
    for value in [0.5, -1.0, 7.0, f64::NAN, f64::INFINITY] {
        let problem = material(linear(3500.0, value));
        let expected = "a number above -1 and below 0.5";
        value_refused(&problem, item, "poissons_ratio", value, expected);
    }
    for value in [-0.1, f64::NAN, f64::INFINITY] {
        let problem = material(Law::Springs {
            youngs_modulus: 3500.0,
            rule: SpringRule::VanGelder,
            calibrate: false,
            damping_ratio: value,
        });
        let expected = "a finite number, 0 or above";
        value_refused(&problem, item, "damping_ratio", value, expected);
    }
}

#[test]
fn damping_of_impossible_numbers() {
    for value in [-1.0, f64::NAN, f64::INFINITY] {
        let mut problem = tissue();
        problem.damping.mass = value;
        let expected = "a finite rate, 0 or above, in 1/s";
        value_refused(&problem, Item::Damping, "mass", value, expected);

        let mut problem = tissue();
        problem.damping.stiffness = value;
        let expected = "a finite time, 0 or above, in s";
        value_refused(&problem, Item::Damping, "stiffness", value, expected);
    }
}

#[test]
fn loads_of_impossible_numbers() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let vector = [0.0, value, 1.0];
        for (name, kind) in [
            ("traction", LoadKind::Traction(vector)),
            ("pressure", LoadKind::Pressure(value)),
            ("force", LoadKind::Force(vector)),
        ] {
            let problem = with_load("top", kind);
            value_refused(&problem, Item::Load(0), name, value, "finite numbers");
        }
        let problem = Problem {
            gravity: Some(vector),
            ..tissue()
        };
        value_refused(&problem, Item::Gravity, "gravity", value, "finite numbers");
    }
}

#[test]
fn impossible_ramps() {
    let with_ramp = |ramp| Problem {
        loads: vec![
            load("top", LoadKind::Pressure(1.0)),
            LoadSpec {
                ramp,
                ..load("top", LoadKind::Pressure(1.0))
            },
        ],
        ..tissue()
    };
    let cause = refused(
        &mesh(),
        &with_ramp(Ramp::Sin2 { rise: 0.0 }),
        Item::Load(1),
        "load 2: ramp: rise = 0 s: expected a finite time above 0",
    );
    assert_eq!(cause, Cause::Ramp(RampError::Rise(0.0)));
    let ramp = Ramp::Pulse {
        from: 0.0,
        to: f64::NAN,
    };
    refused(
        &mesh(),
        &with_ramp(ramp),
        Item::Load(1),
        "load 2: ramp: pulse from 0 s to NaN s: expected finite times with from < to",
    );
}

//! Bodies that pass through each other, found from geometry alone: displacements are given.

use std::fs;

use sinew_mesh::structured::{Split, block};
use sinew_mesh::{CellBlock, CellType, Group, GroupMembers, Mesh, TetMesh, write_msh41_ascii};
use sinew_scene::{Overlap, OverlapWatch, Scene, Simulation};

const MATERIAL: &str = "[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 5000.0\npoissons_ratio = 0.3\n[run]\nduration = 1.0\n\
     integrator = \"newmark\"\ndt = 0.1\n";

/// A block from `low` to `high` (m) as a part of this name.
fn part(name: &str, cells: [usize; 3], [low, high]: [[f64; 3]; 2]) -> TetMesh {
    let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let mut mesh = block(cells, size, Split::Mirrored).unwrap();
    for point in &mut mesh.points {
        *point = [0, 1, 2].map(|axis| point[axis] + low[axis]);
    }
    mesh.groups = vec![Group {
        name: name.to_owned(),
        dim: 3,
        tag: 1,
        members: GroupMembers::Tets((0..).take(mesh.tets.len()).collect()),
    }];
    mesh
}

/// Parts in one mesh, without common nodes.
fn together(parts: impl IntoIterator<Item = TetMesh>) -> TetMesh {
    let mut mesh = TetMesh::default();
    for part in parts {
        let (nodes, tets) = (mesh.points.len() as u32, mesh.tets.len() as u32);
        let [nodes_before, tets_before] = [nodes, tets].map(u64::from);
        mesh.points.extend(part.points);
        mesh.tets
            .extend(part.tets.iter().map(|tet| tet.map(|node| node + nodes)));
        mesh.node_tags
            .extend(part.node_tags.iter().map(|tag| tag + nodes_before));
        mesh.tet_tags
            .extend(part.tet_tags.iter().map(|tag| tag + tets_before));
        for mut group in part.groups {
            if let GroupMembers::Tets(members) = &mut group.members {
                members.iter_mut().for_each(|tet| *tet += tets);
                group.tag = mesh.groups.len() as i32 + 1;
                mesh.groups.push(group);
            }
        }
    }
    mesh
}

/// The part of a mesh with the tetrahedra whose centroids are kept.
fn only(mesh: &TetMesh, keep: impl Fn([f64; 3]) -> bool) -> TetMesh {
    let kept = mesh.tets.iter().filter(|tet| {
        let corners = tet.map(|node| mesh.points[node as usize]);
        keep([0, 1, 2].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0))
    });
    let mut points = Vec::new();
    let mut number = vec![None; mesh.points.len()];
    let tets = kept.map(|tet| {
        tet.map(|node| {
            *number[node as usize].get_or_insert_with(|| {
                points.push(mesh.points[node as usize]);
                points.len() as u32 - 1
            })
        })
    });
    let tets = tets.collect();
    TetMesh::new(points, tets).unwrap()
}

fn build(mesh: &Mesh, order: &str) -> Simulation {
    let folder = tempfile::tempdir().unwrap();
    let mut file = Vec::new();
    write_msh41_ascii(mesh, &mut file).unwrap();
    fs::write(folder.path().join("body.msh"), file).unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(
        &path,
        format!("[mesh]\nfile = \"body.msh\"\n{order}{MATERIAL}"),
    )
    .unwrap();
    Scene::load(path).and_then(Scene::build).unwrap()
}

/// Overlap reported for a body with this displacement (m) of its nodes.
fn told_of(simulation: &Simulation, by: impl Fn([f64; 3]) -> [f64; 3]) -> Option<Overlap> {
    let body = simulation.model().body().unwrap();
    let displacements: Vec<[f64; 3]> = body.mesh.points.iter().map(|point| by(*point)).collect();
    let mut watch = OverlapWatch::new(body);
    watch.look(0.5, &displacements);
    watch.into_deepest()
}

fn told(mesh: &TetMesh, by: impl Fn([f64; 3]) -> [f64; 3]) -> Option<Overlap> {
    told_of(&build(&mesh.to_mesh(), ""), by)
}

/// A rotation about an axis in a general direction.
fn turned([x, y, z]: [f64; 3]) -> [f64; 3] {
    let ([sin, cos], [s, c]) = ([0.6, 0.8], [5.0 / 13.0, 12.0 / 13.0]);
    let (x, y) = (c * x - s * y, s * x + c * y);
    [cos * x + sin * z, y, cos * z - sin * x]
}

fn assert_deep(told: Option<Overlap>, depth: f64, parts: [&str; 2]) {
    let told = told.unwrap();
    assert!((told.depth / depth - 1.0).abs() < 1e-9, "{told:?} {depth}");
    let (mut found, mut parts) = (told.parts.clone(), parts);
    found.sort();
    parts.sort();
    assert_eq!(found, parts);
    assert_eq!(told.t, 0.5);
}

#[test]
fn cubes_are_as_deep_in_each_other_as_they_are_driven_in_millimetres_and_metres_and_turned() {
    for scale in [0.01, 1.0, 100.0] {
        // The upper one begins 5 mm over the lower one.
        let at = |corner: [f64; 3]| corner.map(|along| scale * along);
        let cubes = |cells: usize| {
            let lower = [[0.0; 3], [0.1; 3]].map(at);
            let upper = [[0.0, 0.0, 0.105], [0.1, 0.1, 0.205]].map(at);
            let upper = part("upper", [cells; 3], upper);
            build(
                &together([part("lower", [cells; 3], lower), upper]).to_mesh(),
                "",
            )
        };
        for (cells, aside) in [(4, [0.0, 0.0]), (3, [0.011, 0.017])] {
            let simulation = cubes(cells);
            let driven = |by: f64, turn: bool| {
                told_of(&simulation, |point| {
                    let by = if point[2] > 0.102 * scale { by } else { 0.0 };
                    let asides = if by > 0.0 { aside } else { [0.0; 2] };
                    let place = [asides[0], asides[1], -by].map(|along| scale * along);
                    let place = [0, 1, 2].map(|axis| point[axis] + place[axis]);
                    let place = if turn { turned(place) } else { place };
                    [0, 1, 2].map(|axis| place[axis] - point[axis])
                })
            };
            for turn in [false, true] {
                for beside in [0.0, 0.004, 0.005, 0.205, 0.4] {
                    assert_eq!(driven(beside, turn), None, "{scale} {beside}");
                }
                for depth in [1e-6, 0.001, 0.02] {
                    assert_deep(
                        driven(0.005 + depth, turn),
                        scale * depth,
                        ["lower", "upper"],
                    );
                }
            }
            if cells == 4 {
                // Farther in, the middle of a face is nearest to the opposite one.
                for depth in [0.05_f64, 0.08] {
                    let nearest = depth.min(0.1 - depth);
                    assert_deep(
                        driven(0.005 + depth, true),
                        scale * nearest,
                        ["lower", "upper"],
                    );
                }
                let told = driven(0.025, false).unwrap();
                let body = simulation.model().body().unwrap();
                let node = body.mesh.node_tags.iter().position(|tag| *tag == told.node);
                let rest = body.mesh.points[node.unwrap()];
                let moved = if rest[2] > 0.102 * scale {
                    0.025 * scale
                } else {
                    0.0
                };
                assert_eq!(told.at, [rest[0], rest[1], rest[2] - moved]);
            }
        }
    }
}

#[test]
fn coarse_bodies_of_one_cell_are_told_as_well() {
    let cubes = |cells: usize| {
        let upper = part("upper", [cells; 3], [[0.0, 0.0, 0.1], [0.1, 0.1, 0.2]]);
        together([part("lower", [cells; 3], [[0.0; 3], [0.1; 3]]), upper])
    };
    let down = |by: f64| move |point: [f64; 3]| [0.0, 0.0, if point[2] > 0.11 { -by } else { 0.0 }];
    // All nodes of a part lie on the sides of the other part, but its interior does not. At zero gap, the position of a
    // node does not show to which part it belongs.
    let split = |by: f64| {
        let simulation = build(&cubes(1).to_mesh(), "");
        let body = simulation.model().body().unwrap();
        let nodes = body.mesh.points.len();
        let displacements: Vec<[f64; 3]> = (0..nodes)
            .map(|node| [0.0, 0.0, if node < nodes / 2 { 0.0 } else { -by }])
            .collect();
        let mut watch = OverlapWatch::new(body);
        watch.look(0.5, &displacements);
        watch.into_deepest()
    };
    assert_eq!(split(0.0), None);
    assert_deep(split(0.01), 0.01, ["lower", "upper"]);
    // The upper one is squeezed from above, which leaves the faces on each other.
    assert_eq!(told(&cubes(2), down(0.03)), None);
}

#[test]
fn bars_that_cross_without_a_node_inside_are_told_by_their_edges() {
    for scale in [0.01, 1.0, 30.0] {
        let at = |corner: [f64; 3]| corner.map(|along| scale * along);
        let along_x = [[-0.15, 0.0, 0.0], [0.15, 0.02, 0.02]].map(at);
        let along_y = [[-0.012, -0.14, 0.03], [0.012, 0.16, 0.05]].map(at);
        let bars = [part("x", [1, 1, 1], along_x), part("y", [1, 1, 1], along_y)];
        let simulation = build(&together(bars).to_mesh(), "");
        let driven = |by: f64| {
            told_of(&simulation, |point| {
                [
                    0.0,
                    0.0,
                    if point[2] > 0.025 * scale {
                        -scale * by
                    } else {
                        0.0
                    },
                ]
            })
        };
        assert_eq!(driven(0.01), None);
        assert_deep(driven(0.014), 0.004 * scale, ["x", "y"]);
    }
}

#[test]
fn of_three_parts_the_two_that_are_deepest_in_each_other_are_named() {
    let of = |name: &str, low: f64| part(name, [3; 3], [[0.0, 0.0, low], [0.06, 0.06, low + 0.06]]);
    let mesh = together([of("foot", 0.0), of("middle", 0.07), of("head", 0.14)]);
    let simulation = build(&mesh.to_mesh(), "");
    let driven = |middle: f64, head: f64| {
        told_of(&simulation, |[x, _, z]| {
            let by = [0.0, middle, head][((z + 0.005) / 0.07) as usize];
            [if by > 0.0 { 0.1 * (x - 0.03) } else { 0.0 }, 0.0, -by]
        })
    };
    assert_eq!(driven(0.009, 0.018), None);
    assert_deep(driven(0.013, 0.025), 0.003, ["foot", "middle"]);
    assert_deep(driven(0.013, 0.028), 0.005, ["head", "middle"]);
}

#[test]
fn a_part_within_another_one_is_told_and_one_in_its_cavity_is_not() {
    let outer = part("outer", [5; 3], [[0.0; 3], [0.1; 3]]);
    let inner = part("inner", [2; 3], [[0.045; 3], [0.055; 3]]);
    let filled = together([outer.clone(), inner.clone()]);
    // Its nodes are all 45 mm beneath a face of the outer one, to which the surface of the inner one adds nothing.
    assert_deep(told(&filled, |_| [0.0; 3]), 0.045, ["outer", "inner"]);
    let hollow = only(&outer, |centre| {
        centre.iter().any(|along| (along - 0.05).abs() > 0.01)
    });
    let inner = || part("inner", [2; 3], [[0.045; 3], [0.055; 3]]);
    assert_eq!(told(&together([hollow, inner()]), |_| [0.0; 3]), None);
}

/// A block with a slot, whose upper arm goes down by the height of the slot and `depth` (m), times `scale`.
fn folded(scale: f64, depth: f64) -> Option<Overlap> {
    let whole = block(
        [6, 4, 5],
        [0.06, 0.04, 0.05].map(|size| scale * size),
        Split::Kuhn,
    )
    .unwrap();
    let mesh = only(&whole, |[x, _, z]| {
        x > 0.04 * scale || !(0.02..0.03).contains(&(z / scale))
    });
    told(&mesh, |[x, _, z]| {
        let share = ((0.04 - x / scale) / 0.02).clamp(0.0, 1.0);
        let is_above = z > 0.025 * scale;
        [
            0.0,
            0.0,
            if is_above {
                -scale * share * (0.01 + depth)
            } else {
                0.0
            },
        ]
    })
}

#[test]
fn a_slot_whose_roof_is_in_its_floor_is_told() {
    for scale in [0.01, 1.0, 100.0] {
        assert_eq!(folded(scale, -0.004), None);
        assert_eq!(folded(scale, 0.0), None);
        assert_deep(folded(scale, 0.004), 0.004 * scale, ["whole body"; 2]);
    }
}

#[test]
fn tissue_that_is_bent_twisted_squeezed_or_far_away_is_not_told() {
    let beam = build(
        &part("beam", [24, 3, 3], [[0.0; 3], [0.24, 0.02, 0.02]]).to_mesh(),
        "",
    );
    let of = |to: &dyn Fn([f64; 3]) -> [f64; 3]| {
        told_of(&beam, |point| {
            let place = to(point);
            [0, 1, 2].map(|axis| place[axis] - point[axis])
        })
    };
    // To a ring that is open by a tenth, and to one whose ends go through each other.
    let ring = |degrees: f64| {
        of(&|[x, y, z]| {
            let angle = (degrees * x / 0.24).to_radians();
            let radius = 0.24 / std::f64::consts::TAU + z;
            [radius * angle.sin(), y, radius * angle.cos()]
        })
    };
    assert_eq!(ring(324.0), None);
    let told = ring(380.0).unwrap();
    assert_eq!(told.parts, ["beam", "beam"]);
    assert!(told.depth > 0.003 && told.depth < 0.01, "{told:?}");
    let twisted = of(&|[x, y, z]| {
        let (sin, cos) = (8.0 * x).sin_cos();
        let (y, z) = (y - 0.01, z - 0.01);
        [x, cos * y - sin * z, sin * y + cos * z]
    });
    assert_eq!(twisted, None);
    assert_eq!(of(&|[x, y, z]| [0.02 * x, 1.5 * y, 1.5 * z]), None);
    assert_eq!(of(&|[x, y, z]| [40.0 * x, 0.1 * y, 0.1 * z]), None);
    let far = |x: f64| x as f32 as f64;
    assert_eq!(of(&|[x, y, z]| [x + 1e4, y, z - 1e4].map(far)), None);
    assert_eq!(of(&|[x, y, _]| [x, y, f64::NAN]), None);
    assert_eq!(of(&|[x, y, _]| [x, y, f64::INFINITY]), None);
    assert_eq!(of(&|_| [0.0; 3]), None);
    // A node pushed through its tetrahedra is inside out, and told as that.
    let crushed = of(
        &|[x, y, z]| match [x, y, z].map(|along| (along * 1e4).round()) {
            [1000.0, 67.0, 200.0] => [x, y, 0.008],
            _ => [x, y, z],
        },
    );
    assert_eq!(crushed, None);
}

/// The same mesh of tetrahedra of second order.
fn of_second_order(mesh: &TetMesh) -> Mesh {
    const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];
    let mut second = mesh.to_mesh();
    for block in &mut second.cells {
        let CellBlock {
            kind, connectivity, ..
        } = block;
        let mut nodes = Vec::new();
        for corners in connectivity.as_chunks::<4>().0 {
            nodes.extend(corners);
            for [a, b] in EDGES {
                let [a, b] = [a, b].map(|corner| second.points[corners[corner] as usize]);
                nodes.push(second.points.len() as u32);
                second
                    .points
                    .push([0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis])));
            }
        }
        (*kind, *connectivity) = (CellType::Tetra10, nodes);
    }
    let nodes = second.points.len() as u64;
    second.node_tags = (1..=nodes).collect();
    second.node_entities.clear();
    second
}

#[test]
fn tetrahedra_of_second_order_are_told_by_their_corners() {
    let upper = part("upper", [2; 3], [[0.0, 0.0, 0.11], [0.1, 0.1, 0.21]]);
    let mesh = together([part("lower", [2; 3], [[0.0; 3], [0.1; 3]]), upper]);
    let simulation = build(&of_second_order(&mesh), "order = \"linear\"\n");
    let driven = |by: f64| {
        told_of(&simulation, |point| {
            [0.0, 0.0, if point[2] > 0.105 { -by } else { 0.0 }]
        })
    };
    assert_eq!(driven(0.01), None);
    assert_deep(driven(0.017), 0.007, ["lower", "upper"]);
}

#[test]
fn parts_that_touch_with_nodes_of_their_own_are_not_told_until_they_are_in_each_other() {
    let mesh = {
        let of =
            |name: &str, low: f64| part(name, [2; 3], [[0.0, 0.0, low], [0.1, 0.1, low + 0.1]]);
        together([of("lower", 0.0), of("upper", 0.1)])
    };
    let simulation = build(&mesh.to_mesh(), "");
    let told = |by: &dyn Fn([f64; 3]) -> [f64; 3]| told_of(&simulation, by);
    assert_eq!(told(&|_| [0.0; 3]), None);
    // Moved alike, with places rounded to single precision.
    let single = |along: f64| f64::from(along as f32);
    assert_eq!(
        told(&|point| turned(point.map(|along| 3.0 * along)).map(single)),
        None
    );
    assert_eq!(told(&|[x, y, z]| [0.3 * z * z, 0.1 * x, -0.2 * y]), None);
}

#[test]
fn plans_say_beforehand_what_nothing_keeps_apart() {
    let upper = part("upper", [1; 3], [[0.0, 0.0, 0.2], [0.1, 0.1, 0.3]]);
    let lower = part("lower", [1; 3], [[0.0; 3], [0.1; 3]]);
    let of = |parts: &[&TetMesh]| {
        let mesh = together(parts.iter().map(|part| (*part).clone()));
        let plan = build(&mesh.to_mesh(), "").plan();
        let apart = plan
            .sections
            .into_iter()
            .find(|section| section.heading == "apart");
        apart.map(|section| section.lines.join("\n"))
    };
    assert_eq!(of(&[&lower]), None);
    insta::assert_snapshot!(of(&[&lower, &upper]).unwrap(), @"2 parts: nothing keeps them apart; where they are in each other a run warns");
}

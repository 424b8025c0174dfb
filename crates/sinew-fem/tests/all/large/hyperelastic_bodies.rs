//! Bodies of hyperelastic regions: forces are the gradient of the energy, tangents their derivative, for every law and element.

use crate::common::{
    at, at_most, body, build, dot, edges, elastic, held, linear, max_abs, product,
    relative_difference, stiffness_times, uneven_cube, waves,
};
use sinew_core::{BlockMatrix, ElasticLaw, ForceLaw, Layers, Pattern, System, TangentKind};
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_fem::{Element, Law, Model, Problem, Region};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

const YOUNGS_MODULUS: f64 = 3500.0;
const NU: f64 = 0.45;

const ELEMENTS: [Element; 5] = [
    Element::P1,
    Element::Fbar { patch: None },
    Element::Fbar { patch: Some(12) },
    edges(0.9),
    edges(1.0),
];

fn law(id: &'static str) -> Law {
    Law::hyperelastic(
        id,
        Hyperelastic::parameters(id, YOUNGS_MODULUS, NU).unwrap(),
    )
}

fn of(id: &'static str, element: Element) -> Problem {
    let mut problem = body(law(id));
    problem.regions[0].element = element;
    problem
}

/// Every law on every element.
fn all() -> impl Iterator<Item = (&'static str, Element)> {
    let ids = Hyperelastic::IDS.iter();
    ids.flat_map(|id| ELEMENTS.into_iter().map(move |element| (*id, element)))
}

/// A displacement that squeezes, turns and bends, with strains of some 30 %.
fn bent(mesh: &TetMesh, model: &Model, size: f64) -> Vec<f64> {
    crate::common::on_cells(model, |node| {
        let [x, y, z] = mesh.points[node];
        [
            size * (0.03 * (25.0 * z).sin() - 0.2 * x + 2.0 * y * z),
            size * (0.02 * (31.0 * x + 8.0 * y).cos() - 0.3 * z),
            size * (-0.25 * z + 0.15 * y + 3.0 * x * x),
        ]
    })
}

#[test]
fn forces_are_the_slope_of_the_energy() {
    let mesh = uneven_cube();
    for (id, element) in all() {
        let model = build(&mesh, &of(id, element));
        let u = bent(&mesh, &model, 1.0);
        let w = waves(u.len(), 1.7);
        let (_, force) = elastic(&model, &u);
        let along = |h: f64| {
            let moved: Vec<f64> = u.iter().zip(&w).map(|(u, w)| u + h * w).collect();
            elastic(&model, &moved).0
        };
        let h = 2e-5;
        let pair = |h: f64| (along(h) - along(-h)) / (2.0 * h);
        let by_energy = (4.0 * pair(h / 2.0) - pair(h)) / 3.0;
        let error = (by_energy / dot(&force, &w) - 1.0).abs();
        at_most(&format!("{id}, {element}"), error, 2e-8);
    }
}

#[test]
fn tangents_are_the_slope_of_the_forces_as_products_and_as_matrices() {
    let mesh = uneven_cube();
    for (id, element) in all() {
        let mut problem = of(id, element);
        problem.fixed = vec![
            held("bottom"),
            crate::common::held_along("sides", [true, false, false]),
        ];
        let model = build(&mesh, &problem);
        let u = {
            let free = bent(&mesh, &model, 0.5);
            let pinned = model.pinned();
            free.iter()
                .zip(pinned)
                .map(|(u, held)| if *held { 0.0 } else { *u })
                .collect::<Vec<f64>>()
        };
        let mut w = waves(u.len(), 1.3);
        w.iter_mut()
            .zip(model.pinned())
            .filter(|(_, held)| **held)
            .for_each(|(w, _)| *w = 0.0);
        let exact = product(&model, TangentKind::Exact, &u, &w);
        let moved = |h: f64| {
            let moved: Vec<f64> = u.iter().zip(&w).map(|(u, w)| u + h * w).collect();
            elastic(&model, &moved).1
        };
        let pair = |h: f64| -> Vec<f64> {
            let (up, down) = (moved(h), moved(-h));
            up.iter()
                .zip(&down)
                .map(|(a, b)| (a - b) / (2.0 * h))
                .collect()
        };
        let h = 2e-5;
        let slope: Vec<f64> = pair(h / 2.0)
            .iter()
            .zip(pair(h))
            .map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0)
            .collect();
        at_most(
            &format!("{id}, {element}"),
            relative_difference(&exact, &slope),
            1e-7,
        );

        for kind in [
            TangentKind::Exact,
            TangentKind::Projected,
            TangentKind::Frozen,
        ] {
            let mut matrix = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
            let v = vec![0.0; u.len()];
            model.tangent(&at(&u, &v), kind, &mut matrix).unwrap();
            let mut by_matrix = vec![0.0; u.len()];
            matrix.multiply(&w, &mut by_matrix);
            let by_product = product(&model, kind, &u, &w);
            let difference = relative_difference(&by_matrix, &by_product);
            at_most(
                &format!("{id}, {element}, {kind:?} as a matrix"),
                difference,
                1e-11,
            );
            // Symmetric, and without negative eigenvalues unless it is exact.
            let other = waves(u.len(), 0.9);
            let other: Vec<f64> = other
                .iter()
                .zip(model.pinned())
                .map(|(x, held)| if *held { 0.0 } else { *x })
                .collect();
            let back = product(&model, kind, &u, &other);
            let scale = dot(&by_product, &by_product).sqrt() * dot(&other, &other).sqrt();
            at_most(
                "symmetry",
                (dot(&by_product, &other) - dot(&back, &w)).abs() / scale,
                1e-12,
            );
            if kind != TangentKind::Exact {
                assert!(dot(&by_product, &w) >= 0.0 && dot(&back, &other) >= 0.0);
            }
        }
    }
}

#[test]
fn at_small_strain_every_law_is_the_linear_one_on_the_same_element() {
    let mesh = uneven_cube();
    for (id, element) in all() {
        let model = build(&mesh, &of(id, element));
        let mut small = body(linear(YOUNGS_MODULUS, NU));
        small.regions[0].element = element;
        let small = build(&mesh, &small);
        let u = bent(&mesh, &model, 1.0);
        let at_rest = vec![0.0; u.len()];
        let tangent = product(&model, TangentKind::Exact, &at_rest, &u);
        let expected = stiffness_times(&small, &u);
        at_most(
            &format!("{id}, {element}"),
            relative_difference(&tangent, &expected),
            1e-12,
        );
        let (energy, force) = elastic(&model, &at_rest);
        at_most("energy at rest", energy.abs(), 1e-15);
        at_most("force at rest", max_abs(&force) / max_abs(&expected), 1e-13);
    }
}

/// The indefinite part of the tangent drops out of a node's own block, so that the block is exact and positive for the laws in I1 and J.
#[test]
fn own_blocks_are_those_of_the_tangent_and_never_indefinite() {
    let mesh = uneven_cube();
    for (id, element) in all() {
        let model = build(&mesh, &of(id, element));
        let u = bent(&mesh, &model, 1.0);
        let v = vec![0.0; u.len()];
        let trial = at(&u, &v);
        let mut blocks = vec![0.0; 3 * u.len()];
        model.node_blocks(&trial, &mut blocks).unwrap();
        let mut exact = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
        model
            .tangent(&trial, TangentKind::Exact, &mut exact)
            .unwrap();
        let is_closed_form = [
            "neo-hookean",
            "stable-neo-hookean",
            "stable-neo-hookean-log",
        ]
        .contains(&id);
        for (cell, block) in blocks.chunks_exact(9).enumerate() {
            let own = exact.block(cell, cell).unwrap();
            let size = max_abs(own);
            if is_closed_form {
                let difference = block.iter().zip(own).map(|(a, b)| (a - b).abs());
                let difference = difference.fold(0.0, f64::max);
                assert!(
                    difference <= 1e-12 * size,
                    "{id}, {element}: {difference:e} of {size:e}"
                );
            }
            let matrix = nalgebra::Matrix3::from_row_slice(block);
            let least = matrix.symmetric_eigenvalues().min();
            assert!(least > 0.0, "{id}, {element}: {least}");
        }
    }
}

#[test]
fn inverted_elements_are_refused_by_name_where_a_law_has_no_meaning_and_counted_elsewhere() {
    let mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    for id in Hyperelastic::IDS {
        for element in ELEMENTS {
            let model = build(&mesh, &of(id, element));
            // One corner pushed through the body.
            let mut u = vec![0.0; model.dofs()];
            u[..3].fill(0.12);
            let (mut force, v) = (vec![0.0; u.len()], vec![0.0; u.len()]);
            let answer = model.elastic_force(&at(&u, &v), &mut force);
            let net = model.net_force(&at(&u, &v), &mut force);
            if [
                "stable-neo-hookean",
                "stable-neo-hookean-log",
                "corotational",
                "stvk",
            ]
            .contains(id)
            {
                let found = answer.unwrap();
                assert!(
                    found.inverted > 0 && found.smallest_volume_ratio < 0.0,
                    "{id}: {found:?}"
                );
                assert!(found.worst_element.is_some());
                net.unwrap();
            } else {
                let error = answer.unwrap_err();
                assert!(error.element >= 1 && error.reason.contains(id), "{error}");
                assert!(net.is_err());
            }
        }
    }
}

#[test]
fn regions_of_different_laws_and_elements_add_up() {
    let mut mesh = uneven_cube();
    let third = mesh.tets.len() as u32 / 3;
    for (name, range) in [
        ("low", 0..third),
        ("middle", third..2 * third),
        ("high", 2 * third..3 * third),
    ] {
        mesh.groups.push(Group {
            name: name.into(),
            dim: 3,
            tag: 7,
            members: GroupMembers::Tets(range.collect()),
        });
    }
    let laws = [
        ("low", linear(YOUNGS_MODULUS, NU), Element::P1),
        ("middle", law("neo-hookean"), edges(0.9)),
        ("high", law("corotational"), Element::Fbar { patch: None }),
    ];
    // Each region among others that are as good as not there.
    let model = |stiff: Option<usize>| {
        let regions = laws
            .iter()
            .enumerate()
            .map(|(index, (group, law, element))| {
                let mut law = law.clone();
                if stiff.is_some_and(|stiff| stiff != index) {
                    law.scale_stiffness(1e-20);
                }
                Region::new(law, 1060.0).on(*group).with_element(*element)
            });
        build(&mesh, &Problem::of(regions))
    };
    let all = model(None);
    let u = bent(&mesh, &all, 0.5);
    let (energy, force) = elastic(&all, &u);
    let mut sum = vec![0.0; u.len()];
    let mut energies = 0.0;
    for region in 0..3 {
        let (energy, force) = elastic(&model(Some(region)), &u);
        energies += energy;
        sum.iter_mut()
            .zip(force)
            .for_each(|(sum, force)| *sum += force);
    }
    at_most("energy", (energy / energies - 1.0).abs(), 1e-13);
    at_most("force", relative_difference(&force, &sum), 1e-13);
}

/// A block that is stretched, sheared and turned uniformly has the stress `P F'/J` of its law, Green's strain and the
/// reactions that keep this state.
#[test]
fn a_uniform_deformation_has_its_stress_strain_and_reactions() {
    use nalgebra::{Matrix3, Vector3};
    use sinew_fem::hyperelastic::Tensor;

    let mesh = uneven_cube();
    let gradient = Matrix3::new(0.2, -0.4, 0.1, 0.5, -0.15, 0.0, -0.1, 0.2, 0.1);
    let f = Matrix3::identity() + gradient;
    let rows: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| gradient[(i, j)]));
    for (id, element) in all() {
        let mut problem = of(id, element);
        problem.fixed = vec![held("bottom")];
        let model = build(&mesh, &problem);
        let field: Vec<[f64; 3]> = mesh
            .points
            .iter()
            .map(|point| (gradient * Vector3::from(*point)).into())
            .collect();
        let Law::Hyperelastic { id, parameters } = law(id) else {
            panic!("a hyperelastic law");
        };
        let p = Hyperelastic::new(id, &parameters).unwrap();
        let p = p.stress(Tensor::of(rows)).0;
        let p = Matrix3::from_fn(|i, j| p[i][j]);
        let cauchy = p * f.transpose() / f.determinant();
        let green = (f.transpose() * f - Matrix3::identity()) / 2.0;
        let places = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
        for tet in model.deformed_tets(&field).unwrap() {
            let stress = tet.stress.unwrap();
            for (k, place) in places.into_iter().enumerate() {
                assert!(
                    (stress[k] - cauchy[place]).abs() < 1e-10 * cauchy.norm(),
                    "{id}, {element}"
                );
                assert!((tet.strain[k] - green[place]).abs() < 1e-14);
            }
            assert!(tet.is_hyperelastic && !tet.is_inverted);
        }
    }
}

/// The supports balance the loads, also with stiffness damping of a motion.
#[test]
fn reactions_are_the_forces_that_are_missing() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        for beta in [0.0, 0.01] {
            let mut free = of("neo-hookean", element);
            free.damping.stiffness = beta;
            let mut held_below = free.clone();
            held_below.fixed = vec![held("bottom")];
            let (free, model) = (build(&mesh, &free), build(&mesh, &held_below));
            let u = bent(&mesh, &model, 0.5);
            let v = waves(u.len(), 1.1);
            let reaction = model.reaction(0.0, &u, &v, &"bottom".into()).unwrap();
            let (mut all_u, mut all_v) = (
                vec![[0.0; 3]; mesh.points.len()],
                vec![[0.0; 3]; mesh.points.len()],
            );
            model.to_nodes(&u, &mut all_u).unwrap();
            model.to_nodes(&v, &mut all_v).unwrap();
            let mut net = vec![0.0; free.dofs()];
            free.net_force(&at(all_u.as_flattened(), all_v.as_flattened()), &mut net)
                .unwrap();
            for (axis, reaction) in reaction.into_iter().enumerate() {
                let missing: f64 = model
                    .held_nodes()
                    .iter()
                    .map(|node| -net[3 * *node as usize + axis])
                    .sum();
                assert!(
                    (reaction / missing - 1.0).abs() < 1e-11,
                    "{element}: {reaction} {missing}"
                );
            }
        }
    }
}

/// A tangent without a block for each coupling would be a different matrix, also for linear regions; with more blocks
/// it is the same.
#[test]
fn a_tangent_on_another_pattern_is_refused_and_on_a_larger_one_taken() {
    let mesh = uneven_cube();
    for problem in [
        body(linear(YOUNGS_MODULUS, NU)),
        of("neo-hookean", Element::P1),
        of("corotational", edges(0.9)),
    ] {
        let model = build(&mesh, &problem);
        let u = bent(&mesh, &model, 0.3);
        let v = vec![0.0; u.len()];
        let cells = model.pattern().cells();
        let on = |elements: Vec<Vec<u32>>, layers: Layers| {
            let pattern = Pattern::from_elements(cells, elements).unwrap();
            BlockMatrix::zeros(pattern.into(), layers)
        };
        let alone = (0..cells as u32).map(|cell| vec![cell]).collect();
        let mut diagonal = on(alone, Layers::Three);
        let kind = TangentKind::Exact;
        let refused = model.tangent(&at(&u, &v), kind, &mut diagonal).unwrap_err();
        assert!(
            refused.element == 0 && refused.reason.contains("not neighbours in the pattern"),
            "{refused}"
        );
        let all = || vec![(0..cells as u32).collect()];
        let mut scalar = on(all(), Layers::One);
        assert!(model.tangent(&at(&u, &v), kind, &mut scalar).is_err());
        let (mut full, mut own) = (
            on(all(), Layers::Three),
            BlockMatrix::zeros(model.pattern().clone(), Layers::Three),
        );
        for matrix in [&mut full, &mut own] {
            model.tangent(&at(&u, &v), kind, matrix).unwrap();
        }
        for row in 0..cells {
            for (column, block) in full.row_blocks(row) {
                let expected = own.block(row, column);
                assert!(expected.map_or(block.iter().all(|x| *x == 0.0), |own| own == block));
            }
        }
    }
}

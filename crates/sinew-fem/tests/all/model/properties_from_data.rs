//! Young's modulus, density and the direction of fibres from the data of a mesh: closed forms, equal regions, one
//! energy, errors.

use crate::common::{
    ELEMENTS, at, at_most, body, build, dot, elastic, equilibrium, held, held_along, linear, load,
    max_abs, moved, on_cells, product, relative_difference, springs, stiffness_times, uneven_cube,
    waves,
};
use sinew_core::{
    BlockMatrix, ElasticLaw, Inputs, Layers, LinearSystem, LoadTime, State, System, TangentKind,
    Trial,
};
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::hyperelastic::prony::Term;
use sinew_fem::{
    Direction, Element, FibreFamily, FromMesh, Law, LoadKind, Memory, Model, Moduli, Problem,
    Region, SpringRule, ViscousPart,
};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetData, TetMesh};

fn large(id: &'static str, youngs_modulus: f64, nu: f64) -> Law {
    let parameters = Hyperelastic::parameters(id, youngs_modulus, nu).unwrap();
    Law::hyperelastic(id, parameters)
}

fn along() -> Direction {
    Direction::Data("along".to_owned())
}

fn fibres(direction: impl Into<Direction>) -> Vec<FibreFamily> {
    let fibres = Fibres::new(Stiffening::Quadratic { eta: 2000.0 }).unwrap();
    vec![FibreFamily::new(fibres, direction)]
}

fn memory(part: ViscousPart) -> Option<Memory> {
    let term = |share, time| Term { share, time };
    Some(Memory {
        terms: vec![term(0.3, 0.05), term(0.2, 0.5)],
        part,
        moduli: Moduli::LongTerm,
    })
}

/// Adds data to a mesh, from a function of the tetrahedron.
fn add<const N: usize>(mesh: &mut TetMesh, name: &str, of: impl Fn(usize) -> [f64; N]) {
    let values = (0..mesh.tets.len()).flat_map(of);
    mesh.data.push(TetData {
        name: name.to_owned(),
        step: 0,
        components: N,
        values: values.collect(),
    });
}

fn named(name: &str) -> Option<String> {
    Some(name.to_owned())
}

/// Moduli that jump by a factor of up to 16 from one tetrahedron to the next.
fn modulus(tet: usize) -> f64 {
    [800.0, 12800.0, 3500.0, 1700.0][(tet * 7 + tet / 5) % 4]
}

/// A problem with these moduli, those of the data `E`.
fn by_data(law: Law, element: Element) -> Problem {
    let mut problem = body(law);
    problem.regions[0].law.set_youngs_modulus(1.0);
    problem.regions[0].element = element;
    problem.regions[0].from_mesh.youngs_modulus = named("E");
    problem
}

fn uneven_cube_with_moduli() -> TetMesh {
    let mut mesh = uneven_cube();
    add(&mut mesh, "E", |tet| [modulus(tet)]);
    add(&mut mesh, "along", |tet| {
        let turn = 0.4 * tet as f64;
        [3.0 * turn.cos(), 3.0 * turn.sin(), -1.0]
    });
    mesh
}

/// The middle of a tetrahedron.
fn middle(mesh: &TetMesh, tet: usize) -> [f64; 3] {
    let corners = mesh.tets[tet].map(|node| mesh.points[node as usize]);
    [0, 1, 2].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0)
}

fn bent(mesh: &TetMesh, model: &Model, size: f64) -> Vec<f64> {
    on_cells(model, |node| {
        let [x, y, z] = mesh.points[node];
        [
            size * (0.03 * (25.0 * z).sin() - 0.2 * x + 2.0 * y * z),
            size * (0.02 * (31.0 * x + 8.0 * y).cos() - 0.3 * z),
            size * (0.25 * z + 0.15 * y + 3.0 * x * x),
        ]
    })
}

/// All laws on all elements that support them, with fibres and memory if a law supports them.
fn kinds() -> Vec<(String, Problem)> {
    let mut kinds = Vec::new();
    for element in ELEMENTS {
        let mut add = |law: Law, with: &dyn Fn(&mut Problem)| {
            let mut problem = body(law.clone());
            problem.regions[0].element = element;
            with(&mut problem);
            let name = format!("{law}, {element}, {:?}", problem.regions[0].tissue);
            kinds.push((name, problem));
        };
        add(linear(3500.0, 0.45), &|_| {});
        for id in Hyperelastic::IDS {
            add(large(id, 3500.0, 0.45), &|_| {});
        }
        add(large("neo-hookean", 3500.0, 0.45), &|problem| {
            problem.regions[0].tissue.fibres = fibres([3.0, -1.0, 2.0]);
            problem.regions[0].tissue.memory = memory(ViscousPart::All);
        });
        add(large("neo-hookean-iso", 3500.0, 0.45), &|problem| {
            problem.regions[0].tissue.fibres = fibres([3.0, -1.0, 2.0]);
            problem.regions[0].tissue.memory = memory(ViscousPart::Deviatoric);
        });
    }
    for (rule, calibrate) in [(SpringRule::Lloyd, true), (SpringRule::VanGelder, false)] {
        let law = springs(3500.0, rule, calibrate);
        kinds.push((law.to_string(), body(law)));
    }
    kinds
}

/// A state that was bent at once and another way some time later.
fn used(mesh: &TetMesh, model: &Model) -> State {
    let mut state = State::at_rest(model.dofs());
    state.internal = vec![0.0; model.internal_variables()];
    for (size, dt) in [(0.5, 0.0), (-0.2, 0.03)] {
        state.u = bent(mesh, model, size);
        model.accept(&mut state, &Inputs::default(), dt).unwrap();
    }
    state
}

/// Energy (J), force (N), a product of the tangent (N), stresses (Pa), own blocks and the squares of frequencies in a
/// state with a history.
fn everything(mesh: &TetMesh, model: &Model) -> Vec<Vec<f64>> {
    let state = used(mesh, model);
    let u = bent(mesh, model, 0.3);
    let (w, v) = (waves(u.len(), 1.7), vec![0.0; u.len()]);
    let mut all = vec![
        model.mass().to_vec(),
        model.tet_omegas_squared(),
        stiffness_times(model, &u),
    ];
    let mut stress = vec![[0.0; 6]; mesh.tets.len()];
    if model.stress(0.0, &u, &mut stress).is_ok() {
        all.push(stress.as_flattened().to_vec());
    }
    let field: Vec<[f64; 3]> = waves(3 * mesh.points.len(), 0.7)
        .as_chunks::<3>()
        .0
        .iter()
        .map(|point| point.map(|x| 1e-3 * x))
        .collect();
    all.push(vec![model.elastic_energy(&field).unwrap()]);
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.02,
        u: &u,
        v: &v,
        internal: &state.internal,
    };
    let mut force = vec![0.0; u.len()];
    let found = model.elastic_force(&trial, &mut force).unwrap();
    all.push(vec![found.energy]);
    all.push(force);
    for kind in [TangentKind::Exact, TangentKind::Projected] {
        let mut out = vec![0.0; u.len()];
        model.tangent_product(&trial, kind, &w, &mut out).unwrap();
        all.push(out);
        let mut matrix = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
        model.tangent(&trial, kind, &mut matrix).unwrap();
        let mut out = vec![0.0; u.len()];
        matrix.multiply(&w, &mut out);
        all.push(out);
    }
    let mut blocks = vec![0.0; 3 * u.len()];
    model.node_blocks(&trial, &mut blocks).unwrap();
    all.push(blocks);
    all.push(state.internal);
    all
}

#[test]
fn data_that_are_the_same_everywhere_give_the_bits_of_numbers() {
    let mut mesh = uneven_cube();
    add(&mut mesh, "E", |_| [3500.0]);
    add(&mut mesh, "rho", |_| [1060.0]);
    add(&mut mesh, "along", |_| [3.0, -1.0, 2.0]);
    for (name, mut problem) in kinds() {
        problem.fixed = vec![held("bottom")];
        // Moduli of a law's own are rounded where they are divided by Young's modulus.
        let mut of_one = problem.regions[0].law.clone();
        of_one.set_youngs_modulus(1.0);
        problem.regions[0].law = of_one.clone();
        problem.regions[0].law.scale_stiffness(3500.0);
        let expected = build(&mesh, &problem);
        let region = &mut problem.regions[0];
        region.law = of_one;
        region.density = 1.0;
        let has_fibres = !region.tissue.fibres.is_empty();
        region.from_mesh = FromMesh {
            youngs_modulus: named("E"),
            density: named("rho"),
        };
        if has_fibres {
            region.tissue.fibres = fibres(along());
        }
        let model = build(&mesh, &problem);
        assert!(
            everything(&mesh, &model) == everything(&mesh, &expected),
            "{name}"
        );
    }
}

/// The same body cut into one region for each modulus.
fn in_regions(mesh: &TetMesh, problem: &Problem) -> (TetMesh, Problem) {
    let (mut mesh, mut problem) = (mesh.clone(), problem.clone());
    let whole = problem.regions.remove(0);
    for (tag, wanted) in (1..).zip([800.0, 12800.0, 3500.0, 1700.0]) {
        let tets = (0..mesh.tets.len()).filter(|tet| modulus(*tet) == wanted);
        mesh.groups.push(Group {
            name: format!("E {wanted}"),
            dim: 3,
            tag,
            members: GroupMembers::Tets(tets.map(|tet| tet as u32).collect()),
        });
        let mut region = whole.clone();
        region.group = Some(format!("E {wanted}"));
        region.law.set_youngs_modulus(wanted);
        region.from_mesh.youngs_modulus = None;
        problem.regions.push(region);
    }
    (mesh, problem)
}

#[test]
fn plain_tetrahedra_of_moduli_by_data_are_those_of_regions() {
    let mesh = uneven_cube_with_moduli();
    let plain = kinds().into_iter();
    let plain = plain.filter(|(_, problem)| problem.regions[0].element == Element::P1);
    for (name, mut problem) in plain {
        // Calibrated springs have the mean of each region.
        if let Law::Springs { calibrate, .. } = &mut problem.regions[0].law {
            *calibrate = false;
        }
        problem.fixed = vec![held("bottom")];
        let region = &mut problem.regions[0];
        region.law.set_youngs_modulus(1.0);
        region.from_mesh.youngs_modulus = named("E");
        let model = build(&mesh, &problem);
        let (cut, problem) = in_regions(&mesh, &problem);
        let expected = build(&cut, &problem);
        let found = everything(&mesh, &model);
        let expected = everything(&cut, &expected);
        // Internal variables stand in the order of regions.
        let counted = found.len() - 1;
        for (found, expected) in found.iter().zip(&expected).take(counted) {
            if !expected.iter().all(|x| *x == 0.0) {
                at_most(&name, relative_difference(found, expected), 1e-12);
            }
        }
    }
}

#[test]
fn forces_are_the_slope_of_the_energy_and_tangents_that_of_the_forces() {
    let mesh = uneven_cube_with_moduli();
    for (name, problem) in kinds() {
        let Law::Hyperelastic { .. } = problem.regions[0].law else {
            continue;
        };
        let element = problem.regions[0].element;
        let mut uneven = by_data(problem.regions[0].law.clone(), element);
        uneven.regions[0].tissue = problem.regions[0].tissue.clone();
        for family in &mut uneven.regions[0].tissue.fibres {
            family.direction = along();
        }
        let model = build(&mesh, &uneven);
        let state = used(&mesh, &model);
        let u = bent(&mesh, &model, 0.4);
        let (w, v) = (waves(u.len(), 1.7), vec![0.0; u.len()]);
        let with = |u: &[f64]| {
            let trial = Trial {
                dt: 0.02,
                internal: &state.internal,
                ..at(u, &v)
            };
            let mut force = vec![0.0; u.len()];
            let found = model.elastic_force(&trial, &mut force).unwrap();
            (found.energy, force)
        };
        let h = 1e-6;
        let (before, after) = (with(&moved(&u, -h, &w)), with(&moved(&u, h, &w)));
        let slope = (after.0 - before.0) / (2.0 * h);
        let force = with(&u).1;
        at_most(&name, (slope / dot(&force, &w) - 1.0).abs(), 1e-5);
        let slopes = after.1.iter().zip(&before.1);
        let slope: Vec<f64> = slopes.map(|(a, b)| (a - b) / (2.0 * h)).collect();
        let trial = Trial {
            dt: 0.02,
            internal: &state.internal,
            ..at(&u, &v)
        };
        let mut exact = vec![0.0; u.len()];
        model
            .tangent_product(&trial, TangentKind::Exact, &w, &mut exact)
            .unwrap();
        at_most(&name, relative_difference(&exact, &slope), 1e-5);
        let mut matrix = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
        model
            .tangent(&trial, TangentKind::Exact, &mut matrix)
            .unwrap();
        let mut by_matrix = vec![0.0; u.len()];
        matrix.multiply(&w, &mut by_matrix);
        at_most(&name, relative_difference(&by_matrix, &exact), 1e-12);
        let mut blocks = vec![0.0; 3 * u.len()];
        model.node_blocks(&trial, &mut blocks).unwrap();
        for block in blocks.as_chunks::<9>().0 {
            let least = nalgebra::Matrix3::from_row_slice(block)
                .symmetric_eigenvalues()
                .min();
            assert!(least > 0.0, "{name}: {least}");
        }
    }
}

/// The linear body is assembled apart from the force loops.
#[test]
fn at_small_strain_every_law_is_the_linear_one_with_the_same_moduli() {
    let mesh = uneven_cube_with_moduli();
    for element in ELEMENTS {
        let small = build(&mesh, &by_data(linear(1.0, 0.45), element));
        for id in Hyperelastic::IDS {
            let model = build(&mesh, &by_data(large(id, 1.0, 0.45), element));
            let u = bent(&mesh, &model, 1.0);
            let at_rest = vec![0.0; u.len()];
            let tangent = product(&model, TangentKind::Exact, &at_rest, &u);
            let expected = stiffness_times(&small, &u);
            let difference = relative_difference(&tangent, &expected);
            at_most(&format!("{id}, {element}"), difference, 1e-12);
            let omegas =
                relative_difference(&model.tet_omegas_squared(), &small.tet_omegas_squared());
            at_most("omega^2", omegas, 1e-12);
        }
    }
}

#[test]
fn stresses_of_linear_bodies_do_the_work_that_the_energy_tells() {
    let mesh = uneven_cube_with_moduli();
    for element in ELEMENTS {
        let model = build(&mesh, &by_data(linear(1.0, 0.45), element));
        let u = bent(&mesh, &model, 1e-3);
        let [mut strain, mut stress] = [(); 2].map(|()| vec![[0.0; 6]; mesh.tets.len()]);
        model.strain(0.0, &u, &mut strain).unwrap();
        model.stress(0.0, &u, &mut stress).unwrap();
        let tets = strain.iter().zip(&stress).enumerate();
        let work = tets.map(|(tet, (strain, stress))| {
            let products = (0..6).map(|i| if i < 3 { 1.0 } else { 2.0 } * strain[i] * stress[i]);
            mesh.volume(tet) * products.sum::<f64>()
        });
        let twice = dot(&u, &stiffness_times(&model, &u));
        at_most("work", (work.sum::<f64>() / twice - 1.0).abs(), 1e-12);
        for tet in [0, 17, 80] {
            let own = model.tet_stress(0.0, &u, tet).unwrap();
            at_most("one", relative_difference(&own, &stress[tet]), 1e-12);
        }
    }
}

/// Only the six rigid motions need no force, also if neighbours are a thousand times as stiff.
#[test]
fn jumps_of_the_modulus_leave_the_matrix_symmetric_and_its_only_null_vectors_rigid() {
    let mut mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    add(&mut mesh, "E", |tet| [if tet % 3 == 0 { 1e6 } else { 1e3 }]);
    for element in ELEMENTS {
        let model = build(&mesh, &by_data(linear(1.0, 0.49), element));
        let dofs = model.dofs();
        let columns = (0..dofs).map(|dof| {
            let mut unit = vec![0.0; dofs];
            unit[dof] = 1.0;
            nalgebra::DVector::from_vec(stiffness_times(&model, &unit))
        });
        let matrix = nalgebra::DMatrix::from_columns(&columns.collect::<Vec<_>>());
        let lack = (&matrix - matrix.transpose()).amax();
        at_most("lack of symmetry", lack / matrix.amax(), 1e-15);
        let mut values: Vec<f64> = matrix.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        let scale = 1e3 * 0.1;
        at_most("rigid", max_abs(&values[..6]) / scale, 1e-9);
        assert!(values[6] > 1e-2 * scale, "{element}: {}", values[6]);
    }
}

/// A bar of 2 x 2 x 20 cm along z, of 10 layers.
fn bar() -> TetMesh {
    structured::block([2, 2, 10], [0.02, 0.02, 0.2], Split::Kuhn).unwrap()
}

/// A bar along z, whose bottom may shrink across.
fn pulled(mesh: &TetMesh, mut problem: Problem, traction: f64) -> Model {
    problem.fixed = vec![held_along("bottom", [false, false, true])];
    let sides = (0u32..).zip(&mesh.points);
    let at = |x: f64, y: f64| {
        let found = sides.clone().find(|(_, point)| **point == [x, y, 0.0]);
        found.unwrap().0
    };
    let on = |nodes: Vec<u32>, axes| sinew_fem::Fixed::at(sinew_fem::On::Nodes(nodes)).along(axes);
    problem
        .fixed
        .push(on(vec![at(0.0, 0.0)], [true, true, false]));
    problem
        .fixed
        .push(on(vec![at(0.02, 0.0)], [false, true, false]));
    problem.loads = vec![load("top", LoadKind::Traction([0.0, 0.0, traction]))];
    build(mesh, &problem)
}

/// Two halves in series under a traction t: `u = t (l1/E1 + l2/E2)`, without transverse contraction (Poisson's ratio
/// 0).
#[test]
fn two_layers_in_series_give_way_by_the_sum_of_their_compliances() {
    let mut mesh = bar();
    let moduli: Vec<f64> = (0..mesh.tets.len())
        .map(|tet| {
            if middle(&mesh, tet)[2] < 0.1 {
                2000.0
            } else {
                50000.0
            }
        })
        .collect();
    add(&mut mesh, "E", |tet| [moduli[tet]]);
    for element in [Element::P1, Element::Fbar { patch: Some(12) }] {
        let model = pulled(&mesh, by_data(linear(1.0, 0.0), element), 100.0);
        let u = equilibrium(&model);
        for (node, z) in model.nodes().iter().zip(u.as_chunks::<3>().0) {
            let height = mesh.points[*node as usize][2];
            let (lower, upper) = (height.min(0.1), (height - 0.1).max(0.0));
            let expected = 100.0 * (lower / 2000.0 + upper / 50000.0);
            assert!((z[2] - expected).abs() < 1e-12, "{height}: {z:?}");
        }
        let mut stress = vec![[0.0; 6]; mesh.tets.len()];
        model.stress(0.0, &u, &mut stress).unwrap();
        let off = stress.iter().map(|stress| (stress[2] - 100.0).abs());
        at_most("stress", off.fold(0.0, f64::max), 1e-8);
    }
}

/// The same for a law of large deformation: with Poisson's ratio 0 a neo-Hookean bar has `P = mu (l - 1/l)` and does
/// not contract, and the same holds for two halves with their own stretches.
#[test]
fn two_layers_in_series_have_the_stretches_of_their_law() {
    let mut mesh = bar();
    let moduli: Vec<f64> = (0..mesh.tets.len())
        .map(|tet| {
            if middle(&mesh, tet)[2] < 0.1 {
                2000.0
            } else {
                8000.0
            }
        })
        .collect();
    add(&mut mesh, "E", |tet| [moduli[tet]]);
    let traction = 900.0;
    // mu = E/2.
    let stretch = |modulus: f64| {
        let half = traction / modulus;
        half + (half * half + 1.0).sqrt()
    };
    for element in [Element::P1, Element::Fbar { patch: Some(12) }] {
        let problem = by_data(large("neo-hookean", 1.0, 0.0), element);
        let model = pulled(&mesh, problem, traction);
        let u = on_cells(&model, |node| {
            let height = mesh.points[node][2];
            let (lower, upper) = (height.min(0.1), (height - 0.1).max(0.0));
            let z = (stretch(2000.0) - 1.0) * lower + (stretch(8000.0) - 1.0) * upper;
            [0.0, 0.0, z]
        });
        let (_, force) = elastic(&model, &u);
        let mut loads = vec![0.0; u.len()];
        model
            .operators()
            .external_force(LoadTime::at(0.0), &mut loads);
        at_most("balance", relative_difference(&force, &loads), 1e-12);
    }
}

/// A bar that hangs by its top: `u(z) = -g/E int_z^L int_0^s rho`, with two densities.
#[test]
fn a_bar_of_two_densities_weighs_and_hangs_as_it_should() {
    let mut mesh = bar();
    let densities: Vec<f64> = (0..mesh.tets.len())
        .map(|tet| {
            if middle(&mesh, tet)[2] < 0.1 {
                3000.0
            } else {
                1000.0
            }
        })
        .collect();
    add(&mut mesh, "rho", |tet| [densities[tet]]);
    let mut problem = body(linear(10000.0, 0.0));
    problem.regions[0].density = 1.0;
    problem.regions[0].from_mesh.density = named("rho");
    problem.fixed = vec![held_along("top", [false, false, true])];
    problem.gravity = Some([0.0, 0.0, -10.0]);
    let on = |axis: usize, axes| {
        sinew_fem::Fixed::at(sinew_fem::On::Nodes(
            (0u32..)
                .zip(&mesh.points)
                .filter_map(|(node, point)| (point[axis] == 0.0).then_some(node))
                .collect(),
        ))
        .along(axes)
    };
    problem.fixed.push(on(0, [true, false, false]));
    problem.fixed.push(on(1, [false, true, false]));
    let model = build(&mesh, &problem);
    let area = 4e-4;
    let mass = area * (0.1 * 3000.0 + 0.1 * 1000.0);
    at_most("mass", (model.report().mass / mass - 1.0).abs(), 1e-13);
    assert_eq!(model.report().regions[0].density, [1000.0, 3000.0]);
    let u = equilibrium(&model);
    let v = vec![0.0; u.len()];
    let weight = model.reaction(0.0, &u, &v, &"top".into()).unwrap()[2];
    at_most("weight", (weight / (10.0 * mass) - 1.0).abs(), 1e-12);
    // The mean over each cross-section: lumped masses are not the same at all its nodes.
    let mean = |height: f64| {
        let nodes = model.nodes().iter().zip(u.as_chunks::<3>().0);
        let at_height = nodes.filter(|(node, _)| mesh.points[**node as usize][2] == height);
        let (sum, count) =
            at_height.fold((0.0, 0.0), |(sum, count), (_, u)| (sum + u[2], count + 1.0));
        sum / count
    };
    let below = 10.0 / 10000.0 * 3000.0 * 0.1 * 0.1 / 2.0;
    let above = 10.0 / 10000.0 * (300.0 * 0.1 + 1000.0 * 0.1 * 0.1 / 2.0);
    at_most("tip", (mean(0.0) / -(below + above) - 1.0).abs(), 2e-3);
}

/// A region for each layer, which has its own direction, in the order of the tetrahedra.
#[test]
fn fibres_that_turn_through_a_bar_have_the_bits_of_regions_with_a_direction_each() {
    let mut mesh = bar();
    let layer: Vec<usize> = (0..mesh.tets.len())
        .map(|tet| (middle(&mesh, tet)[2] / 0.02) as usize)
        .collect();
    let mut order: Vec<usize> = (0..mesh.tets.len()).collect();
    order.sort_by_key(|tet| layer[*tet]);
    mesh.tets = order.iter().map(|tet| mesh.tets[*tet]).collect();
    let layer: Vec<usize> = order.iter().map(|tet| layer[*tet]).collect();
    mesh.groups.retain(|group| group.dim != 3);
    let direction = |layer: usize| {
        let turn = 0.3 * layer as f64;
        [2.0 * turn.cos(), 0.0, 2.0 * turn.sin()]
    };
    add(&mut mesh, "along", |tet| direction(layer[tet]));
    for memory in [None, memory(ViscousPart::All)] {
        let mut problem = body(large("neo-hookean", 3500.0, 0.4));
        problem.fixed = vec![held("bottom")];
        problem.regions[0].tissue.memory = memory;
        let mut in_layers = problem.clone();
        let whole = in_layers.regions.remove(0);
        problem.regions[0].tissue.fibres = fibres(along());
        let mut cut = mesh.clone();
        for number in 0..10 {
            let tets = (0u32..).zip(&layer).filter(|(_, of)| **of == number);
            cut.groups.push(Group {
                name: format!("layer {number}"),
                dim: 3,
                tag: number as i32 + 1,
                members: GroupMembers::Tets(tets.map(|(tet, _)| tet).collect()),
            });
            let mut region = whole.clone();
            region.group = Some(format!("layer {number}"));
            region.tissue.fibres = fibres(direction(number));
            in_layers.regions.push(region);
        }
        let (model, expected) = (build(&mesh, &problem), build(&cut, &in_layers));
        let (found, expected) = (everything(&mesh, &model), everything(&cut, &expected));
        // What is remembered stands in the order of the regions, and energies are summed up by region.
        let counted = found.len() - 1;
        for (number, (found, expected)) in found.iter().zip(&expected).enumerate().take(counted) {
            if let ([found], [expected]) = (&found[..], &expected[..]) {
                at_most("energy", (found / expected - 1.0).abs(), 1e-13);
            } else {
                assert!(found == expected, "{number}");
            }
        }
    }
}

#[test]
fn another_distribution_is_another_body() {
    let mesh = uneven_cube_with_moduli();
    let mut swapped = mesh.clone();
    // The same stiffness in all, at other places.
    swapped.data[0].values.swap(0, 1);
    let mut turned = mesh.clone();
    turned.data[1].values[4] += 1e-9;
    let mut problem = by_data(large("neo-hookean", 1.0, 0.45), Element::P1);
    problem.regions[0].tissue.fibres = fibres(along());
    let of = |mesh: &TetMesh| (&build(mesh, &problem) as &dyn System).fingerprint();
    assert_eq!(of(&mesh), of(&mesh.clone()));
    assert_ne!(of(&mesh), of(&swapped));
    assert_ne!(of(&mesh), of(&turned));
}

#[test]
fn stiffness_contrast_spans_the_data() {
    let mesh = uneven_cube_with_moduli();
    let contrast = |problem: &Problem| build(&mesh, problem).stiffness_contrast().unwrap();
    let uneven = contrast(&by_data(linear(1.0, 0.45), Element::P1));
    let even = contrast(&body(linear(3500.0, 0.45)));
    at_most("contrast", (uneven / (16.0 * even) - 1.0).abs(), 1e-14);
}

#[test]
fn calibrated_springs_have_the_mean_modulus_of_the_data() {
    let mesh = uneven_cube_with_moduli();
    let law = springs(1.0, SpringRule::Lloyd, true);
    let model = build(&mesh, &by_data(law, Element::P1));
    let moduli = (0..mesh.tets.len()).map(|tet| mesh.volume(tet) * modulus(tet));
    let mean = moduli.sum::<f64>() / 1e-3;
    let facts = model.report().regions[0];
    at_most(
        "mean",
        (facts.mean_youngs_modulus / mean - 1.0).abs(),
        1e-12,
    );
    at_most(
        "voigt",
        (facts.network.unwrap().voigt / mean - 1.0).abs(),
        1e-12,
    );
    assert_eq!(facts.youngs_modulus, [800.0, 12800.0]);
}

#[test]
fn data_that_cannot_give_a_property_are_refused_by_name_and_tag() {
    let mut mesh = uneven_cube();
    mesh.tet_tags = (101..).take(mesh.tets.len()).collect();
    add(&mut mesh, "E", |_| [3500.0]);
    add(&mut mesh, "along", |tet| {
        [0.0, 0.0, if tet == 5 { 0.0 } else { 1.0 }]
    });
    add(&mut mesh, "endless", |tet| {
        [1.0, 0.0, if tet == 6 { f64::INFINITY } else { 1.0 }]
    });
    add(&mut mesh, "negative", |tet| {
        [if tet == 7 { -2.0 } else { 1.0 }]
    });
    add(&mut mesh, "zero", |tet| [if tet == 8 { 0.0 } else { 1.0 }]);
    add(&mut mesh, "holes", |tet| {
        [if tet % 9 == 4 { f64::NAN } else { 1.0 }]
    });
    add(&mut mesh, "twice", |_| [1.0]);
    add(&mut mesh, "twice", |_| [2.0]);
    let last = mesh.data.len() - 1;
    mesh.data[last].step = 3;
    let refused = |mesh: &TetMesh, change: &dyn Fn(&mut Region)| {
        let mut problem = body(large("neo-hookean", 1.0, 0.45));
        change(&mut problem.regions[0]);
        Model::build(mesh, &problem).unwrap_err().to_string()
    };
    let said = |mesh: &TetMesh, from_mesh: FromMesh| {
        refused(mesh, &|region| region.from_mesh = from_mesh.clone())
    };
    let along = |name: &str| {
        let direction = Direction::Data(name.to_owned());
        refused(&mesh, &|region| {
            region.tissue.fibres = fibres(direction.clone());
        })
    };
    let young = |name: &str| FromMesh {
        youngs_modulus: named(name),
        ..FromMesh::default()
    };
    let density = |name: &str| FromMesh {
        density: named(name),
        ..FromMesh::default()
    };
    assert_eq!(
        said(&mesh, young("e")),
        "region 1: youngs_modulus: no data of tetrahedra are named \"e\"; there are \"E\" (a number), \"along\" (3 numbers), \
         \"endless\" (3 numbers), \"holes\" (a number), \"negative\" (a number), \"twice\" (a number), \"zero\" (a number)"
    );
    assert_eq!(
        said(&uneven_cube(), young("E")),
        "region 1: youngs_modulus: no data of tetrahedra are named \"E\"; the mesh has none"
    );
    assert_eq!(
        said(&mesh, young("twice")),
        "region 1: youngs_modulus: 2 data of tetrahedra are named \"twice\" (time steps 0, 3): keep one of them, or give each a \
         name of its own"
    );
    assert_eq!(
        said(&mesh, density("along")),
        "region 1: density: data \"along\" are 3 numbers for each tetrahedron: expected a number"
    );
    assert_eq!(
        along("E"),
        "region 1: direction: data \"E\" are a number for each tetrahedron: expected 3 numbers"
    );
    assert_eq!(
        said(&mesh, young("holes")),
        "region 1: youngs_modulus: data \"holes\" have no value for 18 of the region's tetrahedra (first: 105)"
    );
    assert_eq!(
        said(&mesh, young("negative")),
        "region 1: youngs_modulus: data \"negative\" are -2 in tetrahedron 108: expected a finite modulus above 0 Pa"
    );
    assert_eq!(
        said(&mesh, density("zero")),
        "region 1: density: data \"zero\" are 0 in tetrahedron 109: expected a finite density above 0 kg/m3"
    );
    assert_eq!(
        along("along"),
        "region 1: direction: data \"along\" are [0.0, 0.0, 0.0] in tetrahedron 106: expected a finite vector that is not 0"
    );
    assert!(along("endless").contains("[1.0, 0.0, inf] in tetrahedron 107"));
}

/// Invalid values outside a region do not affect it.
#[test]
fn data_count_in_the_regions_that_name_them_only() {
    let mut mesh = uneven_cube();
    let half = mesh.tets.len() / 2;
    for (tag, name) in [(1, "lower"), (2, "upper")] {
        let tets = (0..mesh.tets.len()).filter(|tet| (*tet < half) == (tag == 1));
        mesh.groups.push(Group {
            name: name.to_owned(),
            dim: 3,
            tag,
            members: GroupMembers::Tets(tets.map(|tet| tet as u32).collect()),
        });
    }
    add(&mut mesh, "E", |tet| {
        [if tet < half { modulus(tet) } else { f64::NAN }]
    });
    let mut problem = by_data(linear(1.0, 0.3), Element::P1);
    problem.regions[0].group = named("lower");
    let mut upper = body(linear(5000.0, 0.3)).regions.remove(0);
    upper.group = named("upper");
    problem.regions.push(upper);
    let model = build(&mesh, &problem);
    let spans = model
        .report()
        .regions
        .iter()
        .map(|facts| facts.youngs_modulus);
    assert_eq!(spans.collect::<Vec<_>>(), [[800.0, 12800.0], [5000.0; 2]]);
}

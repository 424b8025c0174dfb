//! Bodies with fibres: forces are the gradient of one energy, tangents its second derivative, stresses those of the closed forms.

use crate::common::{
    ELEMENTS, at, at_most, bent, body, build, by_elements, dot, elastic, held, moved, product,
    relative_difference, uneven_cube, waves,
};
use sinew_core::{BlockMatrix, ElasticLaw, ForceLaw, Layers, System, TangentKind};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::{Cause, FibreFamily, Law, Model, Problem, Tissue};
use sinew_mesh::structured::{self, Split};

const QUADRATIC: Stiffening = Stiffening::Quadratic { eta: 2000.0 };

const DISPERSED: Stiffening = Stiffening::Exponential {
    k1: 1000.0,
    k2: 2.0,
    dispersion: 0.1,
};

/// A problem with fibres, E = 3500 Pa and nu = .45.
fn with_fibres(id: &'static str, fibres: Fibres, direction: [f64; 3]) -> Problem {
    with_families(id, vec![FibreFamily::new(fibres, direction)])
}

fn with_families(id: &'static str, fibres: Vec<FibreFamily>) -> Problem {
    let mut problem = body(Law::hyperelastic(id, Parameters::new(3500.0, 0.45)));
    problem.regions[0].tissue.fibres = fibres;
    problem
}

/// Laws that are defined or not defined for inverted elements, among them one that has a rotation, and fibres of all
/// kinds, of one family and of four, on every element.
fn all() -> impl Iterator<Item = (String, Problem)> {
    let kinds = [QUADRATIC, DISPERSED].map(|kind| Fibres::new(kind).unwrap());
    let kinds = [kinds[0], kinds[1], kinds[0].split(), kinds[1].split()];
    let directions = [
        [3.0, -1.0, 2.0],
        [0.0, 1.0, 1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 2.0, 0.0],
    ];
    let of = |kind: usize| FibreFamily::new(kinds[kind], directions[kind]);
    let mut families: Vec<Vec<FibreFamily>> = kinds
        .map(|kind| vec![FibreFamily::new(kind, directions[0])])
        .into();
    families.push([0, 1, 2, 3].map(of).into());
    let laws = ["neo-hookean", "corotational"];
    laws.into_iter().flat_map(move |law| {
        let cases = families.clone().into_iter();
        cases.flat_map(move |fibres| {
            let said: Vec<String> = fibres.iter().map(FibreFamily::to_string).collect();
            let said = said.join(", ");
            ELEMENTS.map(|element| {
                let mut problem = with_families(law, fibres.clone());
                problem.regions[0].element = element;
                (format!("{law}, {said}, {element}"), problem)
            })
        })
    })
}

#[test]
fn forces_are_the_slope_of_the_energy_and_tangents_that_of_the_forces() {
    let mesh = uneven_cube();
    for (name, problem) in all() {
        let model = build(&mesh, &problem);
        let u = bent(&mesh, &model, 0.6);
        let w = waves(u.len(), 1.7);
        let (energy, force) = elastic(&model, &u);
        let without = with_plain(&problem);
        assert!(
            energy > 1.01 * elastic(&build(&mesh, &without), &u).0,
            "{name}"
        );
        let h = 1e-6;
        let (before, after) = (
            elastic(&model, &moved(&u, -h, &w)),
            elastic(&model, &moved(&u, h, &w)),
        );
        let slope = (after.0 - before.0) / (2.0 * h);
        at_most(&name, (slope / dot(&force, &w) - 1.0).abs(), 1e-5);
        let slope: Vec<f64> = after
            .1
            .iter()
            .zip(&before.1)
            .map(|(a, b)| (a - b) / (2.0 * h))
            .collect();
        let exact = product(&model, TangentKind::Exact, &u, &w);
        at_most(&name, relative_difference(&exact, &slope), 1e-5);
    }
}

fn with_plain(problem: &Problem) -> Problem {
    let mut problem = problem.clone();
    problem.regions[0].tissue = Tissue::default();
    problem
}

#[test]
fn tangents_are_symmetric_the_same_as_matrices_and_definite_where_they_are_not_exact() {
    let mesh = uneven_cube();
    for (name, mut problem) in all() {
        problem.fixed = vec![held("bottom")];
        let model = build(&mesh, &problem);
        let u = bent(&mesh, &model, 0.6);
        let (w, other) = (waves(u.len(), 1.3), waves(u.len(), 0.9));
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
            at_most(&name, relative_difference(&by_matrix, &by_product), 1e-11);
            let back = product(&model, kind, &u, &other);
            let scale = dot(&by_product, &by_product).sqrt() * dot(&other, &other).sqrt();
            let difference = dot(&by_product, &other) - dot(&back, &w);
            at_most(&name, difference.abs() / scale, 1e-12);
            if kind != TangentKind::Exact {
                assert!(dot(&by_product, &w) >= 0.0 && dot(&back, &other) >= 0.0);
            }
        }
    }
}

#[test]
fn own_blocks_stay_definite_and_are_no_less_than_those_of_the_tangent() {
    let mesh = uneven_cube();
    for (name, problem) in all() {
        let model = build(&mesh, &problem);
        for size in [0.0, 0.6, -0.6] {
            let u = bent(&mesh, &model, size);
            let v = vec![0.0; u.len()];
            let mut blocks = vec![0.0; 3 * u.len()];
            model.node_blocks(&at(&u, &v), &mut blocks).unwrap();
            let mut tangent = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
            let kind = TangentKind::Frozen;
            model.tangent(&at(&u, &v), kind, &mut tangent).unwrap();
            for (cell, block) in blocks.chunks_exact(9).enumerate() {
                let matrix = nalgebra::Matrix3::from_row_slice(block);
                assert!(matrix.symmetric_eigenvalues().min() > 0.0, "{name}");
                if name.contains("corotational") {
                    let own = nalgebra::Matrix3::from_row_slice(tangent.block(cell, cell).unwrap());
                    let more = (matrix - own).symmetric_eigenvalues().min();
                    assert!(more > -1e-11 * matrix.norm(), "{name}: {more}");
                }
            }
        }
    }
}

/// A step that is stable with fibres in compression is also stable when they are pulled: the bound of the fastest
/// motions takes them as pulled.
#[test]
fn the_elements_and_the_spectrum_at_rest_have_the_fibres_as_if_they_were_pulled() {
    let mesh = uneven_cube();
    for kind in [QUADRATIC, DISPERSED] {
        for element in ELEMENTS {
            let mut problem =
                with_fibres("neo-hookean", Fibres::new(kind).unwrap(), [0.0, 2.0, 1.0]);
            problem.regions[0].element = element;
            problem.fixed = vec![held("bottom")];
            let model = build(&mesh, &problem);
            let u = waves(model.dofs(), 0.7);
            let by_elements = by_elements(&model, &u);
            // All fibres are stretched a little.
            let pulled = crate::common::on_cells(&model, |node| {
                let [x, y, z] = mesh.points[node];
                [1e-9 * x, 1e-9 * y, 1e-9 * z]
            });
            let expected = product(&model, TangentKind::Exact, &pulled, &u);
            // The held nodes do not follow, which only leaves the lowest elements idle.
            let idle = product(&model, TangentKind::Exact, &vec![0.0; u.len()], &u);
            let far = relative_difference(&idle, &by_elements);
            let near = relative_difference(&expected, &by_elements);
            assert!(near < 1e-6 && far > 1e-3, "{element}: {near}, {far}");
            let at_rest = model.spectrum(None).unwrap().omega_max;
            let plain = build(&mesh, &with_plain(&problem));
            assert!(at_rest > 1.001 * plain.spectrum(None).unwrap().omega_max);
        }
    }
}

#[test]
fn fibres_freed_of_volume_change_refuse_what_is_inverted_by_name_also_with_laws_that_do_not() {
    let mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    let fibres = Fibres::new(QUADRATIC).unwrap();
    for element in ELEMENTS {
        for (fibres, is_refused) in [(fibres, false), (fibres.split(), true)] {
            let mut problem = with_fibres("stable-neo-hookean", fibres, [1.0, 0.0, 0.0]);
            problem.regions[0].element = element;
            let model = build(&mesh, &problem);
            let mut u = vec![0.0; model.dofs()];
            u[..3].fill(0.12);
            let (v, mut out) = (vec![0.0; u.len()], vec![0.0; u.len()]);
            let trial = at(&u, &v);
            let kind = TangentKind::Exact;
            let answers = [
                model.net_force(&trial, &mut out),
                model.tangent_product(&trial, kind, &v, &mut out),
            ];
            for answer in answers {
                assert_eq!(answer.is_err(), is_refused, "{element}");
                if let Err(error) = answer {
                    assert!(error.element > 0);
                    assert!(error.reason.contains("fibres freed of volume change"));
                }
            }
        }
    }
}

#[test]
fn two_families_of_half_the_modulus_along_one_direction_are_one() {
    let mesh = uneven_cube();
    for kind in [QUADRATIC, DISPERSED] {
        let whole = Fibres::new(kind).unwrap();
        let half = || FibreFamily::new(whole.scaled(0.5), [3.0, -1.0, 2.0]);
        let one = build(&mesh, &with_fibres("neo-hookean", whole, [3.0, -1.0, 2.0]));
        let two = build(&mesh, &with_families("neo-hookean", vec![half(), half()]));
        let u = bent(&mesh, &one, 0.6);
        let w = waves(u.len(), 1.3);
        let [of_one, of_two] = [&one, &two].map(|model| elastic(model, &u));
        at_most("energy", (of_two.0 / of_one.0 - 1.0).abs(), 1e-14);
        at_most("forces", relative_difference(&of_two.1, &of_one.1), 1e-14);
        let [of_one, of_two] = [&one, &two].map(|model| product(model, TangentKind::Exact, &u, &w));
        at_most("tangent", relative_difference(&of_two, &of_one), 1e-14);
        let bounds = [&one, &two].map(|model| model.spectrum(None).unwrap().omega_max);
        at_most("spectrum", (bounds[1] / bounds[0] - 1.0).abs(), 1e-12);
    }
}

#[test]
fn fibres_without_a_direction_or_beside_another_law_are_refused() {
    let mesh = structured::cube(1, 0.1, Split::Kuhn).unwrap();
    let fibres = Fibres::new(QUADRATIC).unwrap();
    let refused = |problem: &Problem| Model::build(&mesh, problem).unwrap_err().cause().clone();
    let none = with_fibres("neo-hookean", fibres, [0.0; 3]);
    assert_eq!(
        refused(&none),
        Cause::NoDirection {
            quantity: "direction"
        }
    );
    let mut linear = with_fibres("neo-hookean", fibres, [1.0; 3]);
    linear.regions[0].law = crate::common::linear(3500.0, 0.45);
    assert_eq!(refused(&linear), Cause::TissueOfSmallStrain);
    let families = vec![FibreFamily::new(fibres, [1.0; 3]); 5];
    let (found, most) = (5, Tissue::MOST_FAMILIES);
    let five = with_families("neo-hookean", families);
    assert_eq!(refused(&five), Cause::Families { found, most });
    let endless = with_fibres("neo-hookean", fibres, [f64::INFINITY, 0.0, 0.0]);
    assert!(matches!(
        refused(&endless),
        Cause::Value {
            quantity: "direction",
            ..
        }
    ));
}

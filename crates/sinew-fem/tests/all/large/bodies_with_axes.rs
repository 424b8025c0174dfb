//! Bodies of a law with axes: forces, tangents and stiffness at rest are consistent, for any axes and any way to state
//! them.

use crate::common::{
    ELEMENTS, at_most, bent, body, build, by_elements, dot, elastic, moved, product,
    relative_difference, uneven_cube, waves,
};
use sinew_core::{System, TangentKind};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Cause, Direction, Element, Law, Model, Problem};
use sinew_mesh::{TetData, TetMesh};

const FORM: [f64; 9] = [0.6, 0.45, 0.3, 0.06, -0.03, 0.09, 0.24, 0.18, 0.21];

const AXES: [[f64; 3]; 2] = [[1.0, 2.0, -1.0], [0.3, 1.0, 1.0]];

fn fung(form: &[f64]) -> Law {
    let parameters = Parameters::default()
        .with("c", &[4000.0])
        .with("b", form)
        .with("bulk_modulus", &[2e4]);
    Law::hyperelastic("fung", parameters)
}

fn with_axes(element: Element, axes: Option<[[f64; 3]; 2]>) -> Problem {
    let mut problem = body(fung(&FORM));
    problem.regions[0].element = element;
    problem.regions[0].tissue.axes = axes.map(|axes| axes.map(Direction::Everywhere));
    problem
}

#[test]
fn forces_and_tangents_are_slopes_of_one_energy() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        let model = build(&mesh, &with_axes(element, Some(AXES)));
        let u = bent(&mesh, &model, 0.6);
        let w = waves(u.len(), 1.7);
        let (_, force) = elastic(&model, &u);
        let h = 1e-6;
        let [before, after] = [-h, h].map(|h| elastic(&model, &moved(&u, h, &w)));
        let slope = (after.0 - before.0) / (2.0 * h);
        at_most(
            &element.to_string(),
            (slope / dot(&force, &w) - 1.0).abs(),
            1e-5,
        );
        let slope: Vec<f64> = after
            .1
            .iter()
            .zip(&before.1)
            .map(|(a, b)| (a - b) / (2.0 * h))
            .collect();
        let exact = product(&model, TangentKind::Exact, &u, &w);
        at_most(
            &element.to_string(),
            relative_difference(&exact, &slope),
            1e-5,
        );
    }
}

#[test]
fn elements_at_rest_are_the_tangent_at_rest() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        for axes in [None, Some(AXES)] {
            let model = build(&mesh, &with_axes(element, axes));
            let u = waves(model.dofs(), 0.7);
            let by_elements = by_elements(&model, &u);
            let rest = vec![0.0; u.len()];
            let expected = product(&model, TangentKind::Exact, &rest, &u);
            at_most(
                &element.to_string(),
                relative_difference(&by_elements, &expected),
                1e-12,
            );
        }
    }
}

/// The energy of a body whose material is turned with its axes, and of one that is not.
#[test]
fn axes_matter_and_none_are_those_of_coordinates() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        let coordinates = [[2.0, 0.0, 0.0], [1.0, 3.0, 0.0]];
        let of = |axes| build(&mesh, &with_axes(element, axes));
        let [none, same, other] = [None, Some(coordinates), Some(AXES)].map(of);
        let u = bent(&mesh, &none, 0.6);
        assert_eq!(elastic(&none, &u), elastic(&same, &u));
        let far = relative_difference(&elastic(&other, &u).1, &elastic(&none, &u).1);
        assert!(far > 0.01, "{element}: {far}");
    }
}

fn with_data(mesh: &TetMesh, axes: impl Fn(usize) -> [[f64; 3]; 2]) -> TetMesh {
    let mut mesh = mesh.clone();
    for (axis, name) in ["one", "two"].into_iter().enumerate() {
        let values = (0..mesh.tets.len()).flat_map(|tet| axes(tet)[axis]);
        mesh.data.push(TetData {
            name: name.into(),
            components: 3,
            values: values.collect(),
            step: 0,
        });
    }
    mesh
}

fn by_data(element: Element) -> Problem {
    let mut problem = with_axes(element, None);
    let named = ["one", "two"].map(|name| Direction::Data(name.to_owned()));
    problem.regions[0].tissue.axes = Some(named);
    problem
}

#[test]
fn axes_by_data_that_are_the_same_everywhere_have_the_bits_of_stated_ones() {
    let mesh = with_data(&uneven_cube(), |tet| {
        AXES.map(|axis| axis.map(|x| x * 2.0_f64.powi(tet as i32 % 5)))
    });
    for element in ELEMENTS
        .into_iter()
        .filter(|element| element.edge_share() == 0.0)
    {
        let [stated, given] = [with_axes(element, Some(AXES)), by_data(element)]
            .map(|problem| build(&mesh, &problem));
        let u = bent(&mesh, &stated, 0.6);
        assert_eq!(elastic(&given, &u), elastic(&stated, &u));
        let w = waves(u.len(), 1.3);
        let of = |model| product(model, TangentKind::Projected, &u, &w);
        assert_eq!(of(&given), of(&stated));
    }
}

#[test]
fn axes_that_are_none_or_do_not_go_together_are_refused() {
    let mesh = uneven_cube();
    let refused =
        |mesh: &TetMesh, problem: &Problem| Model::build(mesh, problem).unwrap_err().to_string();
    let stated = |axes| refused(&mesh, &with_axes(Element::P1, Some(axes)));
    assert_eq!(
        stated([[1.0, 0.0, 0.0], [-2.0, 0.0, 0.0]]),
        "region 1: the first two axes are parallel: expected directions that are not"
    );
    assert_eq!(
        stated([[1.0, 0.0, 0.0], [0.0; 3]]),
        "region 1: axes = [0, 0, 0]: expected a vector that is not 0"
    );
    let parallel = with_data(&mesh, |tet| match tet {
        5 => [[1.0, 0.0, 0.0]; 2],
        _ => AXES,
    });
    assert_eq!(
        refused(&parallel, &by_data(Element::P1)),
        "region 1: axes: the first two axes are [1.0, 0.0, 0.0] and [1.0, 0.0, 0.0] in tetrahedron 6: expected directions that are not parallel"
    );
    let edges = Element::FbarEdge {
        edge_share: 0.9,
        patch: None,
    };
    let cause = Model::build(&with_data(&mesh, |_| AXES), &by_data(edges)).unwrap_err();
    assert_eq!(*cause.cause(), Cause::AxesOnEdges { law: "fung" });
    let mut isotropic = with_axes(Element::P1, Some(AXES));
    isotropic.regions[0].law = Law::hyperelastic("stvk", Parameters::new(1.0, 0.3));
    let cause = Model::build(&mesh, &isotropic).unwrap_err();
    assert_eq!(*cause.cause(), Cause::NeedlessAxes { law: "stvk" });
}

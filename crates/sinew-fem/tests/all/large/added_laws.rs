//! Laws that a program adds to those of the library.

use std::sync::Arc;

use crate::common::{
    at, at_most, body, build, elastic, held, on_cells, product, relative_difference, uneven_cube,
    waves,
};
use sinew_core::{ElasticLaw, System, TangentKind};
use sinew_fem::hyperelastic::{
    HyperelasticLaw, LawParameter, LawValues, NeoHookean, ParameterError, Parameters, PointLaw,
    Tensor, register_boxed,
};
use sinew_fem::{Element, Law, Model};

fn make(values: &LawValues<'_>) -> Result<Arc<dyn PointLaw>, ParameterError> {
    Ok(Arc::new(Scripted(NeoHookean::from_values(values)?)))
}

/// The neo-Hookean law as one without a type.
#[derive(Debug)]
struct Scripted(NeoHookean);

impl PointLaw for Scripted {
    fn id(&self) -> &'static str {
        "scripted"
    }

    fn lame(&self) -> (f64, f64) {
        self.0.lame()
    }

    fn energy(&self, h: Tensor<f64>) -> f64 {
        self.0.energy(&self.0.at(h))
    }

    fn stress(&self, h: Tensor<f64>) -> Tensor<f64> {
        self.0.stress(&self.0.at(h))
    }

    fn tangent(&self, h: Tensor<f64>, change: Tensor<f64>) -> Tensor<f64> {
        self.0.tangent(&self.0.at(h), change)
    }
}

#[test]
fn a_boxed_law_is_the_compiled_one_in_forces_and_tangents() {
    let meaning = "is an example";
    register_boxed("scripted", meaning, LawParameter::MODULI, Box::new(make)).unwrap();
    let mesh = uneven_cube();
    let model = |id: &'static str, element: Element| -> Model {
        let parameters = Parameters::new(3500.0, 0.45);
        let mut problem = body(Law::hyperelastic(id, parameters));
        problem.regions[0].element = element;
        problem.fixed = vec![held("bottom")];
        build(&mesh, &problem)
    };
    for element in [Element::P1, Element::Fbar { patch: None }] {
        let (boxed, compiled) = (model("scripted", element), model("neo-hookean", element));
        let u: Vec<f64> = waves(compiled.dofs(), 0.7)
            .iter()
            .map(|u| 1e-3 * u)
            .collect();
        let forces = [&boxed, &compiled].map(|model| elastic(model, &u).1);
        at_most("force", relative_difference(&forces[0], &forces[1]), 1e-13);
        let w = waves(u.len(), 1.3);
        let kind = TangentKind::Exact;
        let products = [&boxed, &compiled].map(|model| product(model, kind, &u, &w));
        at_most(
            "tangent",
            relative_difference(&products[0], &products[1]),
            1e-13,
        );
    }
}

/// The error message contains the id of the law.
#[test]
fn a_boxed_law_refuses_a_mirrored_body_by_its_name() {
    let parameters = LawParameter::MODULI;
    register_boxed("scripted-too", "is an example", parameters, Box::new(make)).unwrap();
    let id = "scripted-too";
    let parameters = Parameters::new(3500.0, 0.45);
    let mesh = uneven_cube();
    let model = build(&mesh, &body(Law::hyperelastic(id, parameters)));
    let mirrored = |node: usize| [-2.0 * mesh.points[node][0], 0.0, 0.0];
    let u = on_cells(&model, mirrored);
    let (v, mut force) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    let refused = model.elastic_force(&at(&u, &v), &mut force).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("the law `scripted` is not defined"),
        "{refused}"
    );
}

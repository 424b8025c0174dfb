//! The stiffness matrix is the sum of its elements, each of which can be requested.

use crate::common::{DENSITY, at_most, linear, springs};
use sinew_core::{
    ElementStiffness, Elements, LinearSystem, System, element_omegas_squared, spectrum,
};
use sinew_fem::{Fixed, Law, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};

fn model(law: Law, axes: [bool; 3]) -> Model {
    let mesh = structured::cube(3, 0.1, Split::Kuhn).unwrap();
    let problem =
        Problem::of([Region::new(law, DENSITY)]).with_fixed(Fixed::at("sides").along(axes));
    Model::build(&mesh, &problem).unwrap()
}

fn laws() -> [Law; 4] {
    [
        linear(3500.0, 0.45),
        springs(3500.0, SpringRule::Lloyd, false),
        springs(3500.0, SpringRule::VanGelder, false),
        springs(3500.0, SpringRule::Lloyd, true),
    ]
}

#[test]
fn elements_add_up_to_the_matrix() {
    for law in laws() {
        // Held in all directions, and in one, which keeps the cell and clears a component.
        for axes in [[true; 3], [true, false, false]] {
            let model = model(law.clone(), axes);
            let n = model.dofs();
            let x: Vec<f64> = (0..n).map(|i| (1.7 * i as f64).sin()).collect();
            let mut expected = vec![0.0; n];
            model.operators().stiffness().multiply(&x, &mut expected);
            let (mut sum, mut element) = (vec![0.0; n], ElementStiffness::default());
            for index in 0..model.count() {
                model.stiffness(index, &mut element);
                element.add_product(1.0, &x, &mut sum);
            }
            let size = expected.iter().fold(0.0_f64, |max, f| max.max(f.abs()));
            let difference = sum.iter().zip(&expected).map(|(a, b)| (a - b).abs());
            at_most(
                "sum of elements",
                difference.fold(0.0, f64::max) / size,
                1e-14,
            );
        }
    }
}

/// Rayleigh: `x' K_e x <= x' K x`, so that no element alone swings faster than the whole.
#[test]
fn no_element_is_faster_than_the_whole() {
    for law in laws() {
        let model = model(law, [true; 3]);
        let mass = model.mass();
        let stiffness = model.operators().stiffness();
        let whole = spectrum::largest_eigenvalue(mass, |x, out| stiffness.multiply(x, out));
        let omegas = element_omegas_squared(&model, mass);
        let fastest = omegas.iter().copied().fold(0.0, f64::max);
        assert!(fastest <= whole * (1.0 + 1e-9), "{fastest} {whole}");
        // Nor is the whole faster than its fastest element times the elements round a cell.
        assert!(fastest >= whole / 24.0, "{fastest} {whole}");
    }
}

#[test]
fn elements_are_named_by_their_tags() {
    let model = model(linear(3500.0, 0.3), [true; 3]);
    assert_eq!(model.name(0), "tetrahedron 1");
}

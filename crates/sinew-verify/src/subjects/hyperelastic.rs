//! Laws of large deformation, element by element.

use sinew_core::vectors::largest;
use sinew_fem::hyperelastic::{Hyperelastic, NodeBlock, SingularValues, Tensor};
use sinew_fem::{Element, Law, Model};
use sinew_mesh::structured::{Split, cube};

use crate::bodies::{YOUNGS_MODULUS, body, of_law};
use crate::check::{Asked, Check, Source};
use crate::closed_forms;
use crate::error::LabError;
use crate::subject::Subject;
use crate::tissue;
use crate::uniform::{EDGE, ELEMENTS, Uniform, name};

pub(super) const SUBJECT: Subject = Subject {
    id: "hyperelastic",
    title: "Laws of large deformation",
    says: "E = 3500 Pa, nu = .45, C1 : C2 = 4 : 1. Slopes of the energy psi and of the stress P by differences of fourth order, turns of body and \
           material, and own blocks of nodes at 200 random deformations, J from .2 to 3 and, where a law is defined there, from -3 to -.2 in \
           half of them; each figure is the largest difference over the size of what is compared. Then uniform deformations with known stress.",
    checks,
    quoted: &[],
};

const NU: f64 = 0.45;

fn checks() -> Vec<Check> {
    let mut checks: Vec<Check> = Hyperelastic::IDS.iter().map(|&id| laws_of(id)).collect();
    checks.push(
        Check::one(
            "linear, turned by 30 degrees",
            "largest stress (Pa)",
            Asked::value(3233.87, 0.005),
            Source::ClosedForm("(2 mu + 2 lambda)(1 - cos 30) along the axes that turn"),
            |_| linear_stress_of_a_turn(),
        )
        .noted("what a rotation costs where the theory is linear; 0 in all other laws"),
    );
    checks.extend(Hyperelastic::IDS.iter().map(|&id| closed_forms_of(id)));
    checks.push(confined());
    checks.extend(Hyperelastic::IDS.iter().map(|&id| rotations_of(id)));
    checks
}

/// A nearly incompressible block in confined compression by a tenth, on every element.
fn confined() -> Check {
    let figures = ELEMENTS.into_iter().flat_map(|element| {
        let of = name(element);
        [
            (
                format!("{of}: P33 for E = 1 Pa"),
                Asked::value(-16.714_846_935, 1e-9),
            ),
            (
                format!("{of}: largest force within over that on the top"),
                Asked::at_most(1e-12),
            ),
        ]
    });
    let source = Source::ClosedForm("mu (l - 1/l) + lambda (l - 1), l = .9");
    Check::several(
        "neo-hookean, nu = .499, confined compression",
        figures,
        source,
        |_| {
            let h = Tensor([[0.0; 3], [0.0; 3], [0.0, 0.0, -0.1]]);
            let mut found = Vec::new();
            for element in ELEMENTS {
                let body =
                    Uniform::new(&of_law(tissue::law("neo-hookean", 1.0, 0.499), element), h)?;
                let (_, force) = body.forces()?;
                let top = body.at_end(&force, 2, 2);
                found.extend([top / (EDGE * EDGE), body.within(&force) / top.abs()]);
            }
            Ok(found)
        },
    )
}

/// Rotations of a body as a whole, by any angle, on every element.
fn rotations_of(id: &'static str) -> Check {
    let figures = [
        ("largest force (N)", Asked::at_most(1e-11)),
        ("energy (J)", Asked::at_most(1e-12)),
    ];
    let source = Source::ClosedForm("objectivity");
    let case = format!("{id}, turned by .5, 2 and 3.1, every element");
    Check::several(case, figures, source, move |_| {
        let mut worst = [0.0_f64; 2];
        for (element, angle) in ELEMENTS
            .into_iter()
            .flat_map(|of| [0.5, 2.0, 3.1].map(|by| (of, by)))
        {
            let (sin, cos) = f64::sin_cos(angle);
            let h = Tensor([[cos - 1.0, -sin, 0.0], [sin, cos - 1.0, 0.0], [0.0; 3]]);
            let body = Uniform::new(&of_law(tissue::law(id, YOUNGS_MODULUS, NU), element), h)?;
            let (energy, force) = body.forces()?;
            worst = [worst[0].max(largest(&force)), worst[1].max(energy.abs())];
        }
        Ok(worst.into())
    })
}

/// Check of the identities that every law must fulfil.
fn laws_of(id: &'static str) -> Check {
    let figures = [
        ("P beside the slope of psi", Asked::at_most(1e-8)),
        ("dP/dF beside the slope of P", Asked::at_most(1e-7)),
        (
            "dP/dF at rest beside linear elasticity",
            Asked::at_most(1e-10),
        ),
        ("P(QF) - Q P(F)", Asked::at_most(1e-13)),
        ("P(FQ) - P(F) Q", Asked::at_most(1e-13)),
        (
            "own block of a node beside that of dP/dF",
            Asked::at_most(1e-13),
        ),
    ];
    let source = Source::ClosedForm(
        "definitions: P = d psi/dF, objectivity, isotropy, Hooke's law; Holzapfel, Nonlinear Solid Mechanics, chapter 6",
    );
    Check::several(id, figures, source, move |_| {
        let Law::Hyperelastic { id, parameters } = tissue::law(id, YOUNGS_MODULUS, NU) else {
            return Ok(Vec::new());
        };
        Ok(measure(&Hyperelastic::new(id, &parameters)?).into())
    })
}

/// The largest differences of a law.
fn measure(law: &Hyperelastic) -> [f64; 6] {
    let (lambda, mu) = law.lame();
    let scale = lambda + 2.0 * mu;
    let mut worst = [0.0; 6];
    let mut note = |figure: usize, difference: f64, size: f64| {
        let share = difference / size;
        worst[figure] = if share.is_nan() {
            f64::INFINITY
        } else {
            f64::max(worst[figure], share)
        };
    };
    let energy = |h: Tensor<f64>| law.energy(h);
    let stress = |h: Tensor<f64>| law.stress(h);
    let tangent = |h: Tensor<f64>, change: Tensor<f64>| law.tangent(h, change);
    for (entry, unit) in units().into_iter().enumerate() {
        let mut expected = unit.symmetric().scaled(2.0 * mu);
        if entry % 4 == 0 {
            expected = expected + Tensor::diagonal(lambda);
        }
        note(
            2,
            (tangent(Tensor::zero(), unit) - expected).largest(),
            scale,
        );
    }
    for [h, change] in law.samples() {
        let found = stress(h);
        let size = found.largest() + scale;
        for unit in units() {
            let slope = slope(|x| Tensor::diagonal(energy(h.plus(x, unit))), 5e-5);
            note(0, (slope.0[0][0] - found.contracted(unit)).abs(), size);
        }
        let slope = slope(|x| stress(h.plus(x, change)), 5e-5);
        let of_change = tangent(h, change);
        note(
            1,
            (slope - of_change).largest(),
            of_change.largest() + scale,
        );

        let q = SingularValues::of(change).rotation();
        let turn = q - Tensor::identity();
        // Stresses change by roundings of F times their slope.
        let steepest = units().map(|unit| tangent(h, unit).largest());
        let steepest = steepest.into_iter().fold(0.0, f64::max);
        let length = (h + Tensor::identity()).squared().sqrt();
        let size = size + length * steepest;
        note(3, (stress(q * h + turn) - q * found).largest(), size);
        note(4, (stress(h * q + turn) - found * q).largest(), size);

        let gradient = change.0[0];
        let block = law.node_block(h, gradient);
        let columns = [0, 1, 2].map(|axis| {
            let mut along = [0.0; 3];
            along[axis] = 1.0;
            tangent(h, Tensor::outer(along, gradient)).on(gradient)
        });
        let own = Tensor::from_columns(columns);
        let square: f64 = gradient.iter().map(|g| g * g).sum();
        let size = square * steepest + block.largest();
        note(
            5,
            match law.node_block_kind() {
                NodeBlock::Exact => (block - own).largest(),
                NodeBlock::Majorant => -least_eigenvalue(block - own).min(0.0),
            },
            size,
        );
    }
    worst
}

/// The tensors with one entry of 1.
fn units() -> [Tensor<f64>; 9] {
    std::array::from_fn(|entry| {
        let mut unit = Tensor::zero();
        unit.0[entry / 3][entry % 3] = 1.0;
        unit
    })
}

/// A derivative at 0 by differences of fourth order.
fn slope(of: impl Fn(f64) -> Tensor<f64>, step: f64) -> Tensor<f64> {
    let terms = [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)];
    terms
        .into_iter()
        .fold(Tensor::zero(), |sum, (place, weight)| {
            sum.plus(weight / (12.0 * step), of(place * step))
        })
}

/// The smallest eigenvalue of a symmetric tensor, from the singular values of the tensor shifted to be positive
/// semidefinite.
fn least_eigenvalue(tensor: Tensor<f64>) -> f64 {
    let shift = 3.0 * tensor.largest();
    let [_, _, least] = SingularValues::of(tensor.symmetric() + Tensor::diagonal(shift)).values;
    least - shift
}

/// The largest stress (Pa) of linear elasticity in a cube that is rotated as a whole by 30 degrees.
fn linear_stress_of_a_turn() -> Result<f64, LabError> {
    let model = Model::build(
        &cube(2, 0.1, Split::Kuhn)?,
        &body(YOUNGS_MODULUS, NU, Element::P1),
    )?;
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    let points = &model.mesh().points;
    let turned = |[x, y, _]: [f64; 3]| [cos * x - sin * y - x, sin * x + cos * y - y, 0.0];
    let field: Vec<[f64; 3]> = points.iter().map(|point| turned(*point)).collect();
    let mut u = vec![0.0; 3 * field.len()];
    model.to_dofs(&field, &mut u)?;
    let stress = model.tet_stress(0.0, &u, 0)?;
    Ok(stress
        .into_iter()
        .fold(0.0, |most: f64, s| most.max(s.abs())))
}

/// The closed forms of a law.
fn closed_forms_of(id: &'static str) -> Check {
    // Where the tables cannot be computed the row says so.
    let forms = closed_forms::all().unwrap_or_default();
    let forms: Vec<_> = forms.into_iter().filter(|form| form.law == id).collect();
    let source = Source::Independent(
        "the energies of the literature, differentiated in 50 digits (xtask/python/law_figures.py)",
    );
    let count = ("closed forms".to_owned(), Asked::at_least(10.0));
    let figures = forms.into_iter().map(|form| (form.case, form.asked));
    let case = format!("{id}, uniform deformations");
    Check::several(case, figures.chain([count]), source, move |_| {
        let forms = closed_forms::all()?.into_iter();
        let mut figures: Vec<f64> = forms
            .filter(|form| form.law == id)
            .map(|form| form.got)
            .collect();
        figures.push(figures.len() as f64);
        Ok(figures)
    })
}

//! A material with axes under uniform deformations.

use sinew_fem::hyperelastic::{Parameters, Tensor};
use sinew_fem::{Direction, Law, Problem};

use crate::bodies::of_law;
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::subject::Subject;
use crate::uniform::{EDGE, ELEMENTS, Uniform};

pub(super) const SUBJECT: Subject = Subject {
    id: "axes",
    title: "Materials with axes",
    says: "The law `fung` with c = 4 kPa, b = (2, 1.5, 1, .2, -.1, .3, .8, .6, .7) and kappa = 20 kPa in axes that are turned out of those of the \
           body: stretches along the axes, shears along them, and bodies of every element.",
    checks,
    quoted: &[],
};

const C: f64 = 4000.0;
const BULK: f64 = 2e4;

/// b11, b22, b33, b12, b23, b31, g12, g23, g31.
const FORM: [f64; 9] = [2.0, 1.5, 1.0, 0.2, -0.1, 0.3, 0.8, 0.6, 0.7];

/// Unit vectors, the third the cross product of the others.
const AXES: [[f64; 3]; 3] = [[0.6, 0.8, 0.0], [0.0, 0.0, 1.0], [0.8, -0.6, 0.0]];

const STRETCHES: [(&str, [f64; 3]); 4] = [
    ("pulled along the first axis", [1.3, 0.9, 0.88]),
    ("pulled along the second", [0.88, 1.3, 0.9]),
    ("pressed along the third", [1.1, 1.15, 0.7]),
    ("widened", [1.1, 1.2, 1.05]),
];

const SHEARS: [(&str, [usize; 2]); 6] = [
    ("axis 1 along axis 2", [1, 0]),
    ("axis 2 along axis 1", [0, 1]),
    ("axis 2 along axis 3", [2, 1]),
    ("axis 3 along axis 2", [1, 2]),
    ("axis 3 along axis 1", [0, 2]),
    ("axis 1 along axis 3", [2, 0]),
];

fn checks() -> Vec<Check> {
    let stretched = STRETCHES.into_iter().map(|(name, stretches)| {
        let mut h = Tensor::zero();
        for (axis, stretch) in AXES.into_iter().zip(stretches) {
            h = h.plus(stretch - 1.0, Tensor::outer(axis, axis));
        }
        let stress = principal(stretches);
        let along = AXES.into_iter().zip(stress);
        let p = along.fold(Tensor::zero(), |sum, (axis, stress)| {
            sum.plus(stress, Tensor::outer(axis, axis))
        });
        let figures = [
            (
                "forces at the ends beside P A, over the largest",
                Asked::at_most(1e-12),
            ),
            (
                "stress of any tetrahedron beside that, over it",
                Asked::at_most(1e-12),
            ),
        ];
        let source = Source::ClosedForm("the derivative of the energy by each stretch, by hand");
        Check::several(name, figures, source, move |_| {
            let mut worst = vec![0.0_f64; 2];
            for element in ELEMENTS {
                let body = Uniform::new(&problem(element), h)?;
                let off = [off_ends(&body, p)?, body.off(h, p)?];
                worst
                    .iter_mut()
                    .zip(off)
                    .for_each(|(worst, off)| *worst = worst.max(off));
            }
            Ok(worst)
        })
    });
    let sheared = SHEARS.into_iter().map(|(name, [along, of])| {
        let amount = 0.4;
        let h = Tensor::outer(AXES[along], AXES[of]).scaled(amount);
        let expected = shear_stress(amount, along, of);
        let source = Source::ClosedForm("the derivative of the energy by the shear, by hand");
        let figures = [(
            "shear stress over its closed form less 1",
            Asked::at_most(1e-12),
        )];
        Check::several(format!("shear .4, {name}"), figures, source, move |_| {
            let mut worst = 0.0_f64;
            for element in ELEMENTS {
                let body = Uniform::new(&problem(element), h)?;
                let found = stress(&body)?.contracted(Tensor::outer(AXES[along], AXES[of]));
                worst = worst.max((found / expected - 1.0).abs());
            }
            Ok(vec![worst])
        })
    });
    stretched.chain(sheared).collect()
}

fn problem(element: sinew_fem::Element) -> Problem {
    let parameters = Parameters::default()
        .with("c", &[C])
        .with("b", &FORM)
        .with("bulk_modulus", &[BULK]);
    let mut problem = of_law(Law::hyperelastic("fung", parameters), element);
    let [first, second, _] = AXES;
    // Of other lengths, and the second not perpendicular.
    let second = [0, 1, 2].map(|i| 3.0 * second[i] - 0.5 * first[i]);
    let first = first.map(|x| 5.0 * x);
    problem.regions[0].tissue.axes = Some([first, second].map(Direction::Everywhere));
    problem
}

/// The first Piola-Kirchhoff stress (Pa) from the forces at the ends.
fn stress(body: &Uniform) -> Result<Tensor<f64>, LabError> {
    let (_, force) = body.forces()?;
    let entry = |axis: usize, end: usize| body.at_end(&force, end, axis) / (EDGE * EDGE);
    Ok(Tensor(
        [0, 1, 2].map(|axis| [0, 1, 2].map(|end| entry(axis, end))),
    ))
}

fn off_ends(body: &Uniform, p: Tensor<f64>) -> Result<f64, LabError> {
    Ok((stress(body)? - p).largest() / p.largest())
}

/// Principal first Piola-Kirchhoff stresses (Pa) at stretches along the axes.
fn principal(stretches: [f64; 3]) -> [f64; 3] {
    let [b11, b22, b33, b12, b23, b31, ..] = FORM;
    let j: f64 = stretches.iter().product();
    let scale = j.powf(-2.0 / 3.0);
    let [x, y, z] = stretches.map(|stretch| 0.5 * (scale * stretch * stretch - 1.0));
    let form =
        b11 * x * x + b22 * y * y + b33 * z * z + 2.0 * (b12 * x * y + b23 * y * z + b31 * z * x);
    let grown = C * form.exp();
    let slopes = [
        grown * (b11 * x + b12 * y + b31 * z),
        grown * (b12 * x + b22 * y + b23 * z),
        grown * (b31 * x + b23 * y + b33 * z),
    ];
    let work = |i: usize| slopes[i] * scale * stretches[i] * stretches[i];
    let mean = (work(0) + work(1) + work(2)) / 3.0;
    [0, 1, 2].map(|i| (work(i) - mean + BULK * (j - 1.0) * j) / stretches[i])
}

/// The shear stress (Pa) at a volume-preserving shear of axis `of` along axis `along`: the strains are half of the
/// shear between the two and half of its square along `of`.
fn shear_stress(amount: f64, along: usize, of: usize) -> f64 {
    let normal = FORM[of];
    let shear = match (along.min(of), along.max(of)) {
        (0, 1) => FORM[6],
        (1, 2) => FORM[7],
        _ => FORM[8],
    };
    let (square, half) = (amount * amount / 2.0, amount / 2.0);
    let form = normal * square * square + 2.0 * shear * half * half;
    0.5 * C * form.exp() * (normal * amount.powi(3) + shear * amount)
}

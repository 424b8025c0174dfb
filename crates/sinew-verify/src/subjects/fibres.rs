//! Fibres in a neo-Hookean material under uniform deformations.

use sinew_fem::FibreFamily;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::hyperelastic::{
    Deformation, HyperelasticLaw, LawError, NeoHookean, Parameters, Tensor,
};

use crate::bodies::{YOUNGS_MODULUS, of_law};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::sources::PROTOTYPE_OF_MOTIONS;
use crate::subject::Subject;
use crate::tissue::law;
use crate::uniform::{EDGE, ELEMENTS, Uniform};

pub(super) const SUBJECT: Subject = Subject {
    id: "fibres",
    title: "Fibres",
    says: "A family of fibres in the law `neo-hookean` with E = 3500 Pa, nu = .45: quadratic, eta = 2000 Pa, or exponential, k1 = 1000 Pa, k2 = 2. \
           Stresses P (Pa) at the stretches at which nothing pulls from the sides; what is left there is a row of its own. Then two families, the law of Holzapfel, Gasser and Ogden.",
    checks,
    quoted: &[],
};

const QUADRATIC: Stiffening = Stiffening::Quadratic { eta: 2000.0 };

const fn exponential(dispersion: f64) -> Stiffening {
    Stiffening::Exponential {
        k1: 1000.0,
        k2: 2.0,
        dispersion,
    }
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
const ROOT_OF_HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A pull or push along z, with the free stretches along x and y, and its stress.
struct Uniaxial {
    name: &'static str,
    stiffening: Stiffening,
    direction: [f64; 3],
    stretches: [f64; 3],
    stress: f64,
}

const UNIAXIAL: [Uniaxial; 9] = [
    along(
        "quadratic, along, 1.1",
        QUADRATIC,
        1.1,
        0.957_790_599,
        1_245.075_264,
    ),
    along(
        "quadratic, along, 1.3",
        QUADRATIC,
        1.3,
        0.887_142_868,
        4_426.308_053,
    ),
    along(
        "quadratic, along, .9: idle",
        QUADRATIC,
        0.9,
        1.048_226_728,
        -387.251_898,
    ),
    along(
        "exponential, along, 1.1",
        exponential(0.0),
        1.1,
        0.957_790_599,
        825.674_686,
    ),
    along(
        "exponential, along, 1.3",
        exponential(0.0),
        1.3,
        0.887_142_868,
        5_487.287_694,
    ),
    along(
        "exponential, dispersion .1, along, 1.1",
        exponential(0.1),
        1.1,
        0.956_657_902,
        575.386_417,
    ),
    along(
        "exponential, dispersion .1, along, 1.3",
        exponential(0.1),
        1.3,
        0.882_415_113,
        2_512.747_410,
    ),
    Uniaxial {
        name: "quadratic, across, .9",
        stiffening: QUADRATIC,
        direction: X,
        stretches: [1.017_084_647, 1.073_597_376, 0.9],
        stress: -459.440_475,
    },
    Uniaxial {
        name: "exponential, across, .9",
        stiffening: exponential(0.0),
        direction: X,
        stretches: [1.024_918_664, 1.067_118_728, 0.9],
        stress: -440.842_270,
    },
];

const fn along(
    name: &'static str,
    stiffening: Stiffening,
    stretch: f64,
    lateral: f64,
    stress: f64,
) -> Uniaxial {
    Uniaxial {
        name,
        stiffening,
        direction: Z,
        stretches: [lateral, lateral, stretch],
        stress,
    }
}

fn checks() -> Vec<Check> {
    let pulled = UNIAXIAL.iter().map(|case| {
        // The stretches are printed to 9 places.
        let figures = [
            ("P along (Pa)", Asked::relative(case.stress, 1e-7)),
            ("largest P across (Pa)", Asked::at_most(5e-5)),
        ];
        Check::several(case.name, figures, PROTOTYPE_OF_MOTIONS, |_| {
            let [x, y, z] = case.stretches;
            let h = Tensor([
                [x - 1.0, 0.0, 0.0],
                [0.0, y - 1.0, 0.0],
                [0.0, 0.0, z - 1.0],
            ]);
            let Tensor([[xx, ..], [_, yy, _], [.., zz]]) =
                stress(case.stiffening, case.direction, h)?;
            Ok(vec![zz, xx.abs().max(yy.abs())])
        })
    });
    let sheared = [
        (
            "quadratic, shear .5",
            QUADRATIC,
            [2_478.448_276, 1_853.448_276],
        ),
        (
            "exponential, shear .5",
            exponential(0.0),
            [2_651.136_536, 1_968.573_783],
        ),
        (
            "exponential, dispersion .1, shear .5",
            exponential(0.1),
            [1_419.290_513, 1_100.047_898],
        ),
    ];
    let sheared = sheared
        .into_iter()
        .map(|(name, stiffening, [forward, back])| {
            let figures = [
                ("P12 (Pa)", Asked::relative(forward, 1e-7)),
                ("P21 (Pa)", Asked::relative(back, 1e-7)),
            ];
            let check = Check::several(name, figures, PROTOTYPE_OF_MOTIONS, move |_| {
                let h = Tensor([[0.0, 0.5, 0.0], [0.0; 3], [0.0; 3]]);
                let diagonal = [ROOT_OF_HALF, ROOT_OF_HALF, 0.0];
                let Tensor([[_, forward, _], [back, ..], _]) = stress(stiffening, diagonal, h)?;
                Ok(vec![forward, back])
            });
            check.noted("fibres along (1, 1, 0)")
        });
    let mut checks: Vec<Check> = pulled.chain(sheared).collect();
    let half = ROOT_OF_HALF;
    let shear = Tensor([[0.0, 0.5, 0.0], [0.0; 3], [0.0; 3]]);
    let uniaxial = UNIAXIAL.iter().map(|case| {
        let [x, y, z] = case.stretches.map(|stretch| stretch - 1.0);
        let h = Tensor([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]);
        (case.name, case.stiffening, case.direction, h)
    });
    let oblique = [
        ("quadratic, shear .5", QUADRATIC),
        ("exponential, shear .5", exponential(0.0)),
        ("exponential, dispersion .1, shear .5", exponential(0.1)),
    ];
    let oblique = oblique.map(|(name, stiffening)| (name, stiffening, [half, half, 0.0], shear));
    checks.extend(uniaxial.chain(oblique).map(in_bodies));
    checks.extend(TWO_FAMILIES.map(two_families));
    checks
}

/// Fibres in a body: their energy, direction, and a flag: true if their invariant is isochoric.
type Family = (Stiffening, [f64; 3], bool);

/// Stretches along the axes, with a flag: true if the fibres' invariant is isochoric.
const TWO_FAMILIES: [(&str, [f64; 3], bool); 4] = [
    ("around and along", [0.7, 1.25, 1.15], false),
    ("around and along", [0.7, 1.25, 1.15], true),
    ("around alone", [0.9, 1.3, 0.95], false),
    ("around alone", [0.9, 1.3, 0.95], true),
];

/// The media of a rabbit's carotid artery (Holzapfel, Gasser and Ogden, Journal of Elasticity 61, 2000, table 2): c, k1 (Pa), k2, and the angle
/// (degrees) of the fibres to the circumference.
const MEDIA: [f64; 4] = [3000.0, 2363.2, 0.8393, 29.0];

/// The law of Holzapfel, Gasser and Ogden as two families in `neo-hookean-iso`, y around the artery and z along it.
fn two_families((name, stretches, is_split): (&'static str, [f64; 3], bool)) -> Check {
    let [c, k1, k2, angle] = MEDIA;
    let (sine, cosine) = angle.to_radians().sin_cos();
    let dispersion = 0.0;
    let kind = Stiffening::Exponential { k1, k2, dispersion };
    let families: Vec<Family> = [sine, -sine]
        .map(|along| (kind, [0.0, cosine, along], is_split))
        .into();
    let freed = if is_split {
        ", freed of volume change"
    } else {
        ""
    };
    let figures = [
        (
            "P through the wall, off its closed form over the largest P",
            Asked::at_most(1e-12),
        ),
        ("P around", Asked::at_most(1e-12)),
        ("P along", Asked::at_most(1e-12)),
    ];
    // mu = c, E = 2 mu (1 + nu).
    let poissons_ratio = 0.49;
    let youngs_modulus = 2.0 * c * (1.0 + poissons_ratio);
    let source = Source::ClosedForm("principal stresses by derivatives of the energy by hand");
    Check::several(
        format!("two families at +-29 degrees, {name}{freed}"),
        figures,
        source,
        move |_| {
            let [x, y, z] = stretches;
            let h = Tensor([
                [x - 1.0, 0.0, 0.0],
                [0.0, y - 1.0, 0.0],
                [0.0, 0.0, z - 1.0],
            ]);
            let j = x * y * z;
            let scale = j.powf(-2.0 / 3.0);
            let i1 = x * x + y * y + z * z;
            let kappa = youngs_modulus / (3.0 * (1.0 - 2.0 * poissons_ratio));
            let i4 = y * y * cosine * cosine + z * z * sine * sine;
            let shares = [0.0, cosine * cosine, sine * sine];
            let (measure, factor) = if is_split {
                (scale * i4 - 1.0, scale)
            } else {
                (i4 - 1.0, 1.0)
            };
            let slope = 2.0 * k1 * measure * (k2 * measure * measure).exp();
            let expected = [0, 1, 2].map(|i| {
                let stretch = stretches[i];
                let matrix = c * scale * (stretch - i1 / (3.0 * stretch));
                let volume = kappa * (j - 1.0) * j / stretch;
                let freed = if is_split { i4 / (3.0 * stretch) } else { 0.0 };
                matrix + volume + 2.0 * slope * factor * (shares[i] * stretch - freed)
            });
            let law = law("neo-hookean-iso", youngs_modulus, poissons_ratio);
            let mut worst = vec![0.0_f64; 3];
            for element in ELEMENTS {
                let mut problem = of_law(law.clone(), element);
                problem.regions[0].tissue.fibres = made(&families)?;
                let body = Uniform::new(&problem, h)?;
                let (_, force) = body.forces()?;
                let size = expected.iter().fold(0.0_f64, |size, p| size.max(p.abs()));
                for (end, worst) in worst.iter_mut().enumerate() {
                    let found = body.at_end(&force, end, end) / (EDGE * EDGE);
                    *worst = worst.max((found - expected[end]).abs() / size);
                }
            }
            Ok(worst)
        },
    )
}

fn made(families: &[Family]) -> Result<Vec<FibreFamily>, LabError> {
    let made = families.iter().map(|(kind, direction, is_split)| {
        let fibres = Fibres::new(*kind).map_err(LawError::from)?;
        let fibres = if *is_split { fibres.split() } else { fibres };
        // Vectors of any length.
        Ok(FibreFamily::new(fibres, direction.map(|x| 7.0 * x)))
    });
    made.collect()
}

/// A uniform deformation in bodies of every element, whose fibres are given by a vector of any length.
fn in_bodies((name, stiffening, direction, h): (&str, Stiffening, [f64; 3], Tensor<f64>)) -> Check {
    let figures = [
        "stress of any tetrahedron beside that of the material, over it",
        "forces at an end beside P A, over it",
        "largest force within over P A",
    ];
    let figures = figures.map(|name| (name, Asked::at_most(1e-11)));
    let source = Source::ClosedForm(
        "a uniform deformation is in equilibrium, with the stress of the material",
    );
    Check::several(
        format!("{name}, bodies of every element"),
        figures,
        source,
        move |_| {
            let p = stress(stiffening, direction, h)?;
            let mut worst = vec![0.0_f64; 3];
            for element in ELEMENTS {
                let mut problem = of_law(law("neo-hookean", YOUNGS_MODULUS, 0.45), element);
                problem.regions[0].tissue.fibres = made(&[(stiffening, direction, false)])?;
                let body = Uniform::new(&problem, h)?;
                let (_, force) = body.forces()?;
                let (area, size) = (EDGE * EDGE, p.largest());
                let mut off_end = 0.0_f64;
                for end in 0..3 {
                    for axis in 0..3 {
                        let found = body.at_end(&force, end, axis) / area;
                        off_end = off_end.max((found - p.0[axis][end]).abs() / size);
                    }
                }
                let found = [
                    body.off(h, p)?,
                    off_end,
                    body.within(&force) / (area * size),
                ];
                worst
                    .iter_mut()
                    .zip(found)
                    .for_each(|(worst, found)| *worst = worst.max(found));
            }
            Ok(worst)
        },
    )
}

/// The first Piola-Kirchhoff stress (Pa) at a gradient of the displacement.
fn stress(
    stiffening: Stiffening,
    direction: [f64; 3],
    h: Tensor<f64>,
) -> Result<Tensor<f64>, LabError> {
    let law = NeoHookean::new(&Parameters::new(YOUNGS_MODULUS, 0.45)).map_err(LawError::from)?;
    let at = law.at(h);
    let fibres = Fibres::new(stiffening).map_err(LawError::from)?;
    let pull = fibres.stress(&fibres.at(&Deformation::of(h), direction));
    Ok(law.stress_with(&at, law.own_bulk(&at)) + pull)
}

//! A bar that hangs under its own weight, in each law.

use sinew_fem::hyperelastic::{Hyperelastic, Tensor};
use sinew_fem::{Element, Law, Model, Problem};
use sinew_mesh::structured::{Split, block};

use crate::bodies::{equilibrium, held};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::places::nodes_where;
use crate::subject::{Quoted, Subject};
use crate::tissue;
use sinew_fem::On;

pub(super) const SUBJECT: Subject = Subject {
    id: "hanging-bar",
    title: "A bar that hangs under its own weight",
    says: "1 m long, 0.1 m thick, rho = 1000 kg/m3, g = 9.81 m/s2, mu = lambda = 50 kPa at small strain. Above each place hangs what is below \
           it, so that with sides that are free the sag is the integral of the stretch in uniaxial stress: exact but for the end that is \
           held. On tetrahedra the middle planes are held across, by symmetry.",
    checks,
    quoted: &[Quoted::new(
        "a report of another engine",
        "sag (m), accepted against a target of its own",
        ".0999",
    )],
};

const LENGTH: f64 = 1.0;
const WIDTH: f64 = 0.1;
const DENSITY: f64 = 1000.0;
const GRAVITY: f64 = 9.81;
const MODULUS: f64 = 5e4;

/// Law and sag (m).
const SAG: &[(&str, f64)] = &[
    ("neo-hookean", 0.040_603),
    ("neo-hookean-log", 0.040_756),
    ("stable-neo-hookean", 0.040_510),
    ("stable-neo-hookean-log", 0.040_287),
    ("stvk", 0.036_563),
    ("corotational", 0.039_240),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    let linear = DENSITY * GRAVITY * LENGTH * LENGTH / (2.0 * 2.5 * MODULUS);
    checks.push(Check::one(
        "linear",
        "sag of tetrahedra (m)",
        Asked::relative(linear, 0.01),
        Source::ClosedForm("rho g L^2/(2 E)"),
        |_| sag_of_tetrahedra(Law::linear(2.5 * MODULUS, 0.25)),
    ));
    for &(id, sag) in SAG {
        let prototype =
            Source::Independent("the integral by another program; its digits as it printed them");
        checks.push(Check::one(
            id,
            "sag as an integral (m)",
            Asked::value(sag, 1e-6),
            prototype,
            move |_| sag_as_integral(id),
        ));
    }
    for &id in Hyperelastic::IDS {
        let integral = Source::ClosedForm(
            "the integral of the stretch that the weight below makes in uniaxial stress",
        );
        checks.push(Check::one(
            id,
            "sag of tetrahedra over the integral",
            Asked::value(1.0, 0.01),
            integral,
            move |_| Ok(sag_of_tetrahedra(law(id))? / sag_as_integral(id)?),
        ));
    }
    checks
}

/// mu = lambda, so that nu = 1/4 and E = 2.5 mu.
fn law(id: &'static str) -> Law {
    tissue::law(id, 2.5 * MODULUS, 0.25)
}

fn sag_of_tetrahedra(law: Law) -> Result<f64, LabError> {
    let mesh = block([2, 2, 20], [WIDTH, WIDTH, LENGTH], Split::Mirrored)?;
    let near = |x: f64, place: f64| (x - place).abs() < 1e-9;
    let on = |belongs: &dyn Fn([f64; 3]) -> bool| On::Nodes(nodes_where(&mesh, belongs));
    let mut problem = Problem {
        fixed: vec![
            held("top", [false, false, true]),
            held(on(&|[x, _, _]| near(x, WIDTH / 2.0)), [true, false, false]),
            held(on(&|[_, y, _]| near(y, WIDTH / 2.0)), [false, true, false]),
        ],
        gravity: Some([0.0, 0.0, -GRAVITY]),
        ..tissue::free(law, Element::P1)
    };
    problem.regions[0].density = DENSITY;
    let model = Model::build(&mesh, &problem)?;
    let u = equilibrium(&model)?;
    let mut field = vec![[0.0; 3]; mesh.points.len()];
    model.to_nodes(&u, &mut field)?;
    let ends = nodes_where(&mesh, |[_, _, z]| near(z, 0.0));
    let sum: f64 = ends.iter().map(|node| -field[*node as usize][2]).sum();
    Ok(sum / ends.len() as f64)
}

/// The sag (m) by Simpson's rule over the length.
fn sag_as_integral(id: &'static str) -> Result<f64, LabError> {
    const PARTS: usize = 400;
    let Law::Hyperelastic { id, parameters } = law(id) else {
        return Err(LabError::no_body());
    };
    let law = Hyperelastic::new(id, &parameters)?;
    // Stretches along and across, which go on from place to place.
    let mut stretch = [1.0, 1.0];
    let mut sum = 0.0;
    for place in 0..=PARTS {
        let below = LENGTH * place as f64 / PARTS as f64;
        stretch = uniaxial(&law, DENSITY * GRAVITY * below, stretch);
        let weight = match place {
            0 | PARTS => 1.0,
            _ if place % 2 == 1 => 4.0,
            _ => 2.0,
        };
        sum += weight * (stretch[0] - 1.0);
    }
    Ok(sum * LENGTH / (3.0 * PARTS as f64))
}

/// Stretches along and across under a nominal stress (Pa), by Newton's method from a guess.
fn uniaxial(law: &Hyperelastic, stress: f64, mut stretch: [f64; 2]) -> [f64; 2] {
    let diagonal = |along: f64, across: f64| {
        Tensor::<f64>::of([[along, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]])
    };
    for _ in 0..20 {
        let h = diagonal(stretch[0] - 1.0, stretch[1] - 1.0);
        let left = law.stress(h).0;
        let (f, g) = (left[0][0] - stress, left[1][1]);
        let along = law.tangent(h, diagonal(1.0, 0.0)).0;
        let across = law.tangent(h, diagonal(0.0, 1.0)).0;
        let determinant = along[0][0] * across[1][1] - across[0][0] * along[1][1];
        stretch[0] -= (f * across[1][1] - g * across[0][0]) / determinant;
        stretch[1] -= (g * along[0][0] - f * along[1][1]) / determinant;
    }
    stretch
}

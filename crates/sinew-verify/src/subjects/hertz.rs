//! A rigid ball on a block.

use sinew_core::Options;
use sinew_fem::{Element, Problem, Rayleigh};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block};
use sinew_tools::Convex;

use crate::bodies::{DENSITY, YOUNGS_MODULUS, body, held};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::places::nodes_where;
use crate::pressed::{Pressed, method, through, tool};
use crate::subject::Subject;
use sinew_fem::On;

pub(super) const SUBJECT: Subject = Subject {
    id: "hertz",
    title: "A rigid ball on a block",
    says: "A quarter of a block of 20 a (where said: 40 a) with symmetric sides, held at the bottom, a = sqrt(R d) = R/10 being the radius of \
           contact; cells of h to 1.5 a, then each longer than the one before by 30 %. A ball of radius R is pressed in by d = R/100, slowly, and the force is taken when \
           all has come to rest: contact acts at nodes, by the closed form of the explicit step. Beside 1, the half-space, stand \
           the figures of another program on a mesh graded in its own way; plain tetrahedra are too stiff where the volume hardly changes.",
    checks,
    quoted: &[],
};

/// Radius of contact (m).
const CONTACT: f64 = 1e-3;

/// Radius of the ball (m).
const BALL: f64 = 10.0 * CONTACT;

/// Length of each cell over the previous one, outside the contact.
const GROWTH: f64 = 1.3;

/// The smoothed element for nearly incompressible tissue.
const SMOOTHED: Element = Element::FbarEdge {
    edge_share: 0.9,
    patch: None,
};

/// A ball on a block.
#[derive(Clone, Copy)]
struct Press {
    /// a/h.
    cells: f64,
    nu: f64,
    element: Element,
    /// Size of the block over a.
    size: f64,
    /// d/R.
    depth: f64,
}

impl Press {
    const fn of(cells: f64, nu: f64) -> Self {
        Self {
            cells,
            nu,
            element: Element::P1,
            size: 20.0,
            depth: 0.01,
        }
    }
}

/// a/h, nu, size over a, F/F_Hertz from the other program.
const PRESSES: &[(f64, f64, f64, f64)] = &[
    (1.0, 0.3, 20.0, 1.208),
    (2.0, 0.3, 20.0, 1.125),
    (4.0, 0.3, 20.0, 1.080),
    (6.0, 0.3, 20.0, 1.070),
    (4.0, 0.3, 40.0, 1.057),
    (2.0, 0.45, 20.0, 1.224),
    (4.0, 0.45, 20.0, 1.134),
    (2.0, 0.49, 20.0, 1.535),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for &(cells, nu, size, ratio) in PRESSES {
        let press = Press {
            size,
            ..Press::of(cells, nu)
        };
        let check = Check::one(
            format!("a/h {cells}, nu {nu}, block of {size} a"),
            "force over Hertz's",
            Asked::value(ratio, 0.02),
            Source::Independent("another program, block graded in its own way"),
            move |_| force_over_hertz(press),
        );
        checks.push(check.long(cells > 4.0 || size > 20.0));
    }
    let smoothed = Press {
        element: SMOOTHED,
        ..Press::of(2.0, 0.49)
    };
    checks.push(
        Check::one(
            "a/h 2, nu .49, element fbar-edge",
            "distance of the force from Hertz's, of it",
            Asked::at_most(0.15),
            Source::ClosedForm(HERTZ),
            move |_| Ok((force_over_hertz(smoothed)? - 1.0).abs()),
        )
        .noted("plain tetrahedra are off by half here"),
    );
    checks.push(Check::one(
        "a/h 4, nu .3, d from R/200 to R/50",
        "exponent of the force over the depth",
        Asked::value(1.5, 0.05),
        Source::ClosedForm(HERTZ),
        move |_| {
            let at = |depth: f64| {
                let press = Press {
                    depth,
                    ..Press::of(4.0, 0.3)
                };
                force(press)
            };
            Ok((at(0.02)? / at(0.005)?).ln() / 4.0_f64.ln())
        },
    ));
    checks
}

const HERTZ: &str = "F = 4/3 E/(1 - nu^2) sqrt(R) d^1.5 (Johnson, Contact Mechanics, section 4.2)";

fn force_over_hertz(press: Press) -> Result<f64, LabError> {
    let depth = press.depth * BALL;
    let plane = YOUNGS_MODULUS / (1.0 - press.nu * press.nu);
    Ok(force(press)? / (4.0 / 3.0 * plane * BALL.sqrt() * depth.powf(1.5)))
}

/// Distances (m) of planes of nodes from the middle: cells of one length to 1.5 a, then growing ones to the end.
fn planes(press: Press) -> Vec<f64> {
    let (end, mut length) = (press.size * CONTACT, CONTACT / press.cells);
    let (mut planes, mut at) = (vec![0.0], 0.0);
    while at + 1.5 * length < end {
        at += length;
        planes.push(at);
        if at >= 1.5 * CONTACT - 1e-9 {
            length *= GROWTH;
        }
    }
    planes.push(end);
    planes
}

/// A quarter of the block below z = 0, its symmetric sides at x = 0 and y = 0.
fn quarter(press: Press) -> Result<TetMesh, LabError> {
    let planes = planes(press);
    let cells = planes.len() - 1;
    let mut mesh = block([cells; 3], [cells as f64; 3], Split::Kuhn)?;
    for point in &mut mesh.points {
        let [x, y, z] = point.map(|number| number.round() as usize);
        *point = [planes[x], planes[y], -planes[cells - z]];
    }
    Ok(mesh)
}

/// The force (N) on the whole ball at rest.
fn force(press: Press) -> Result<f64, LabError> {
    let (size, depth) = (press.size * CONTACT, press.depth * BALL);
    let mesh = quarter(press)?;
    let near = |x: f64, place: f64| (x - place).abs() < 1e-9;
    let on = |belongs: &dyn Fn([f64; 3]) -> bool| On::Nodes(nodes_where(&mesh, belongs));
    // The slowest motion, about, in shear.
    let shear = YOUNGS_MODULUS / (2.0 * (1.0 + press.nu));
    let slowest = 1.57 * (shear / DENSITY).sqrt() / size;
    let problem = Problem {
        damping: Rayleigh::new(2.0 * slowest, 0.0),
        fixed: vec![
            held(on(&|[_, _, z]| near(z, -size)), [true; 3]),
            held(on(&|[x, _, _]| near(x, 0.0)), [true, false, false]),
            held(on(&|[_, y, _]| near(y, 0.0)), [false, true, false]),
        ],
        ..body(YOUNGS_MODULUS, press.nu, press.element)
    };
    let down = [
        (0.0, [0.0, 0.0, BALL]),
        (6.0 / slowest, [0.0, 0.0, BALL - depth]),
    ];
    let ball = tool(Convex::sphere(BALL)?, through(&down, [0.0; 3])?, 0.0);
    let mut pressed = Pressed::new(&mesh, &problem, ball, |[_, _, z]| near(z, 0.0))?;
    let dt = 0.9 * pressed.stable_step()?;
    let mut integrator = method("symplectic-euler", &Options::new())?;
    pressed.run(&mut *integrator, dt, (26.0 / (slowest * dt)) as usize)?;
    Ok(4.0 * pressed.force()[2])
}

//! Cut bodies, compared with closed forms of slit bodies.

use std::sync::Arc;

use sinew_core::{Inputs, State, System};
use sinew_cutting::Sheet;
use sinew_fem::{CutModel, Element, LoadKind, On, Problem};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block};

use crate::bodies::{YOUNGS_MODULUS, body, equilibrium, held, load, loads};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::modes::lowest_omega_lumped;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "slits",
    title: "Slits",
    says: "What a cut leaves is another body: a bar of half the length swings twice as fast, and a slit in a plate that is pulled apart releases the \
           energy of a crack.",
    checks,
    quoted: &[],
};

const HALF_BAR: Source =
    Source::ClosedForm("omega = pi/(2 L) sqrt(E/rho) of a bar that is held at one end");

const CRACK: Source = Source::ClosedForm(
    "K_I = sigma sqrt(pi a sec(pi a / (2 W))), C. E. Feddersen 1966, ASTM STP 410; G = K_I^2 (1 - nu^2) / E, G. R. Irwin 1957",
);

fn checks() -> Vec<Check> {
    vec![
        Check::one(
            "bar of 40 cells and nu 0, cut in its middle",
            "lowest frequency along it over that before",
            Asked::relative(2.0, 1e-3),
            HALF_BAR,
            |_| doubled(),
        ),
        Check::one(
            "plate in plane strain with a slit in its middle of 2 x 10 cells, nu 0.3",
            "energy released by two cells more over that of a crack",
            Asked::relative(1.0, 0.1),
            CRACK,
            |_| released(),
        ),
    ]
}

/// Nodes for which `holds` is true.
fn nodes(mesh: &TetMesh, holds: impl Fn([f64; 3]) -> bool) -> On {
    let places = (0..).zip(&mesh.points);
    On::Nodes(
        places
            .filter(|(_, p)| holds(**p))
            .map(|(node, _)| node)
            .collect(),
    )
}

/// Cuts by a blade along y, longer than the body, that moves along x at a height (m) up to a position (m).
fn slit(cut: &mut CutModel, height: f64, end: f64) -> Result<(), LabError> {
    let blade = |x: f64| [[x, -1.0, height], [x, 1.0, height]];
    let sheet = Sheet::swept(blade(-1.0), blade(end)).ok_or_else(LabError::no_body)?;
    let mut state = State::at_rest(cut.model().dofs());
    cut.stroke(&sheet, &mut state, Inputs::none())?;
    Ok(())
}

fn doubled() -> Result<f64, LabError> {
    let layers = 40;
    let mesh = Arc::new(block([1, 1, layers], [0.01, 0.01, 0.4], Split::Kuhn)?);
    // Up to some height (m) nothing moves but along the bar.
    let model = |height: f64| -> Result<CutModel, LabError> {
        let problem = Problem {
            fixed: vec![
                held("bottom", [true; 3]),
                held(nodes(&mesh, |p| p[2] < height), [true, true, false]),
            ],
            ..body(YOUNGS_MODULUS, 0.0, Element::P1)
        };
        Ok(CutModel::new(Arc::clone(&mesh), problem, 0.0)?)
    };
    let whole = lowest_omega_lumped(model(1.0)?.model())?;
    // Nothing holds what comes off.
    let mut cut = model(0.195)?;
    slit(&mut cut, 0.2, 1.0)?;
    let mut state = State::at_rest(cut.model().dofs());
    cut.remove_loose(&[], &mut state, Inputs::none())?;
    Ok(lowest_omega_lumped(cut.model())? / whole)
}

fn released() -> Result<f64, LabError> {
    let (h, width, height, nu, pull) = (1e-3, 25, 100, 0.3, 10.0);
    let size = [width, 1, height].map(|cells| h * f64::from(cells as u32));
    let mesh = Arc::new(block([width, 1, height], size, Split::Kuhn)?);
    // Half of the plate: what lies across x = 0 does the same.
    let problem = Problem {
        fixed: vec![
            held(nodes(&mesh, |p| p[0] == 0.0), [true, false, false]),
            held(nodes(&mesh, |_| true), [false, true, false]),
            held("bottom", [false, false, true]),
        ],
        loads: vec![load("top", LoadKind::Traction([0.0, 0.0, pull]))],
        ..body(YOUNGS_MODULUS, nu, Element::P1)
    };
    let energy = |cells: f64| -> Result<f64, LabError> {
        let mut cut = CutModel::new(Arc::clone(&mesh), problem.clone(), 0.0)?;
        slit(&mut cut, 0.5 * size[2], (cells + 0.01) * h)?;
        let u = equilibrium(cut.model())?;
        let forces = loads(cut.model());
        let work = forces.iter().zip(&u).map(|(force, u)| force * u);
        Ok(0.5 * work.sum::<f64>())
    };
    let (shorter, longer) = (energy(9.0)?, energy(11.0)?);
    let released = (longer - shorter) / (2.0 * h * size[1]);
    let a = 10.0 * h;
    let shape = (std::f64::consts::PI * a / (2.0 * size[0])).cos().recip();
    let intensity = pull * (std::f64::consts::PI * a * shape).sqrt();
    Ok(released / (intensity * intensity * (1.0 - nu * nu) / YOUNGS_MODULUS))
}

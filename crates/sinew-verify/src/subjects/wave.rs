//! Waves and vibrations along a bar.

use std::f64::consts::PI;
use std::sync::Arc;

use sinew_core::vectors::{dot, weighted_dot};
use sinew_core::{
    BlockMatrix, Damping, Layers, LinearModel, LinearOperators, Options, Pattern, State, System,
};
use sinew_fem::Model;
use sinew_mesh::structured::{Split, block};

use crate::bodies::{DENSITY, YOUNGS_MODULUS, body, held, stiffness_times};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::kinds::Kind;
use crate::modes::lowest_omega_lumped;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "bar",
    title: "Waves and vibrations along a bar",
    says: "A bar of 0.1 m, E = 3500 Pa, rho = 1060 kg/m3. As a chain of masses at a Courant number of 1 central differences carry a hump \
           without error. As tetrahedra with nu = 0, held at one end, it stores and moves as much in its first axial mode as a chain of \
           its layers, whose frequency is (sin x/x) (pi/2) c/L with x = pi/(4 n).",
    checks,
    quoted: &[],
};

const LENGTH: f64 = 0.1;

fn wave_speed() -> f64 {
    (YOUNGS_MODULUS / DENSITY).sqrt()
}

fn checks() -> Vec<Check> {
    let dalembert =
        Source::ClosedForm("d'Alembert's solution; Hughes, The Finite Element Method, section 9.1");
    let mut checks = Vec::new();
    for (name, is_free) in [("held at both ends", false), ("free at one end", true)] {
        checks.push(Check::one(
            format!("a hump on a bar of 50 cells {name}, two passes"),
            "largest error over its height",
            Asked::at_most(1e-12),
            dalembert,
            move |_| hump_error(50, is_free),
        ));
    }
    for cells in [20_usize, 40] {
        for (split, name) in [(Split::Kuhn, "Kuhn"), (Split::Mirrored, "mirrored")] {
            for kind in [Kind::P1, Kind::Edge(0.9)] {
                let x = PI / (4.0 * cells as f64);
                let asked = match kind {
                    Kind::P1 => Asked::value(x.sin() / x, 1e-12),
                    // Averages over edges soften the ends of a wave by a little, of second order.
                    _ => Asked::value(x.sin() / x, 2.0 * x * x),
                };
                let case = format!("{kind}, {name}, {cells} layers");
                let chain =
                    Source::ClosedForm("the Rayleigh quotient of a quarter sine on a chain");
                checks.push(Check::one(
                    case,
                    "axial frequency over (pi/2) c/L",
                    asked,
                    chain,
                    move |_| axial_frequency(split, cells, kind),
                ));
            }
        }
    }
    let textbook =
        Source::ClosedForm("2 (c/h) sin(pi/(2 n)), Clough and Penzien, Dynamics of Structures");
    let expected = 2.0 * wave_speed() / (LENGTH / 40.0) * (PI / 80.0).sin();
    checks.push(Check::one(
        "a chain of 40 springs held at both ends",
        "lowest frequency (rad/s)",
        Asked::relative(expected, 1e-9),
        textbook,
        |_| lowest_omega_lumped(&chain(40, false)?),
    ));
    checks
}

/// The Rayleigh quotient of a quarter sine on the bar as tetrahedra with nu = 0, fixed at z = 0.
fn axial_frequency(split: Split, cells: usize, kind: Kind) -> Result<f64, LabError> {
    let size = [LENGTH / 10.0, LENGTH / 10.0, LENGTH];
    let mesh = block([2, 3, cells], size, split)?;
    let mut problem = body(YOUNGS_MODULUS, 0.0, kind.element(None));
    problem.fixed = vec![held("bottom", [true; 3])];
    let model = Model::build(&mesh, &problem)?;
    let along = |[_, _, z]: &[f64; 3]| [0.0, 0.0, (PI / 2.0 * z / LENGTH).sin()];
    let field: Vec<[f64; 3]> = mesh.points.iter().map(along).collect();
    let mut mode = vec![0.0; model.dofs()];
    model.to_dofs(&field, &mut mode)?;
    let elastic = dot(&mode, &stiffness_times(&model, &mode));
    let omega = (elastic / weighted_dot(model.mass(), &mode, &mode)).sqrt();
    Ok(omega / (PI / 2.0 * wave_speed() / LENGTH))
}

/// A bar of unit section as a chain of masses, fixed at both ends or only at the first.
fn chain(cells: usize, is_free: bool) -> Result<LinearModel, LabError> {
    let spacing = LENGTH / cells as f64;
    let spring = YOUNGS_MODULUS / spacing;
    let moving = if is_free { cells } else { cells - 1 };
    // A free end has a spring on one side, and half of a mass.
    let share = |cell: usize| if cell + 1 == cells { 0.5 } else { 1.0 };
    let pairs = (1..moving as u32).map(|cell| [cell - 1, cell]);
    let pattern = Arc::new(Pattern::from_elements(moving, pairs)?);
    let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
    for cell in 0..moving as u32 {
        stiffness.add_block(cell, cell, &[2.0 * spring * share(cell as usize)])?;
        if cell > 0 {
            stiffness.add_block(cell - 1, cell, &[-spring])?;
            stiffness.add_block(cell, cell - 1, &[-spring])?;
        }
    }
    let mass = (0..moving).map(|cell| DENSITY * spacing * share(cell));
    let operators =
        LinearOperators::new(mass.collect(), stiffness, Damping::default(), Vec::new())?;
    Ok(LinearModel::new(operators))
}

/// A narrow hump outside the middle, continued beyond the ends by reflection: odd at a fixed end, even at a free one.
fn hump(x: f64, is_free: bool) -> f64 {
    let there_and_back = 2.0 * LENGTH;
    let (turned, inside) = match x.rem_euclid(2.0 * there_and_back) {
        x if x <= there_and_back => (1.0, x),
        x => (-1.0, x - there_and_back),
    };
    let (mirrored, inside) = match inside <= LENGTH {
        true => (1.0, inside),
        false => (-1.0, there_and_back - inside),
    };
    let sign = if is_free { turned } else { mirrored };
    let distance = (inside / LENGTH - 0.3).abs();
    if distance < 0.15 {
        sign * (PI * distance / 0.3).cos().powi(2)
    } else {
        0.0
    }
}

fn hump_error(cells: usize, is_free: bool) -> Result<f64, LabError> {
    let spacing = LENGTH / cells as f64;
    let dt = spacing / wave_speed();
    let model = chain(cells, is_free)?;
    let hump = |x: f64| hump(x, is_free);
    let place = |cell: usize| (cell + 1) as f64 * spacing;
    let start = (0..model.dofs()).map(|cell| hump(place(cell)));
    let mut state = State::new(start.collect(), vec![0.0; model.dofs()]);
    let mut integrator = sinew_integrators::build("central-difference", &Options::new())?;
    let mut worst = 0.0_f64;
    for step in 1..=4 * cells {
        integrator.step(&model, &mut state, dt)?;
        let travelled = step as f64 * spacing;
        for (cell, u) in state.u.iter().enumerate() {
            let x = place(cell);
            let exact = (hump(x - travelled) + hump(x + travelled)) / 2.0;
            worst = worst.max((u - exact).abs());
        }
    }
    Ok(worst)
}

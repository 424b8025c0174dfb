//! Large motions of blocks, compared with those of another program.

use sinew_core::vectors::{largest, weighted_dot};
use sinew_core::{Inputs, OptionValue, Options, Ramp, State, System};
use sinew_fem::Element;

use crate::check::{Asked, Check};
use crate::error::LabError;
use crate::places::node_at;
use crate::sources::PROTOTYPE_OF_MOTIONS;
use crate::subject::Subject;
use crate::tissue::{self, COLUMN, Specimen, relative_error, rotation_of_top};

pub(super) const SUBJECT: Subject = Subject {
    id: "large-motion",
    title: "Large motions: a release, a twist and a push",
    says: "Mirrored blocks of plain tetrahedra, neo-hookean, E = 3500 Pa, nu = .45, rho = 1060 kg/m3, bottom held, .5 s. Release: a cube of 0.1 m \
           with 6 cells a side, stretched by half at the volume of rest. Twist: a column of 20 x 20 x 120 mm, spun by 75/s. Push: the cube with \
           mass damping of 10/s under 12 N on its top, which rise in .2 s. The exact motion is that of central difference at 8000 and 16000 \
           steps a second, extrapolated; errors are relative, over all nodes and 50 instants.",
    checks,
    quoted: &[],
};

const DURATION: f64 = 0.5;
const INSTANTS: usize = 50;

/// Number of steps per second of the finer one of the two motions for extrapolation.
const FINEST: usize = 16_000;

/// A scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scene {
    Release,
    Twist,
    Push,
}

impl Scene {
    fn name(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Twist => "twist",
            Self::Push => "push",
        }
    }

    fn specimen(self) -> Result<Specimen, LabError> {
        let law = tissue::soft();
        match self {
            Self::Release => tissue::release(6, law, Element::P1),
            Self::Twist => {
                let problem = tissue::standing(law, Element::P1);
                tissue::spun_column([3, 3, 18], COLUMN, 75.0, &problem)
            }
            Self::Push => tissue::pressed(6, law, Element::P1, 10.0, Ramp::Sin2 { rise: 0.2 }),
        }
    }
}

/// The displacements by central difference with `rate` steps per second.
fn track(specimen: &Specimen, rate: usize, instants: usize) -> Result<Vec<Vec<f64>>, LabError> {
    let steps = (DURATION * rate as f64 / instants as f64).round() as usize;
    Ok(specimen.by_central_difference(1.0 / rate as f64, steps, instants)?)
}

/// The same, extrapolated to steps of zero length.
fn exact(specimen: &Specimen, instants: usize) -> Result<Vec<Vec<f64>>, LabError> {
    let coarse = track(specimen, FINEST / 2, instants)?;
    let mut fine = track(specimen, FINEST, instants)?;
    for (fine, coarse) in fine.iter_mut().flatten().zip(coarse.iter().flatten()) {
        *fine += (*fine - coarse) / 3.0;
    }
    Ok(fine)
}

/// The vertical displacement (m) of the middle of the top at instants given by their numbers.
fn tops(specimen: &Specimen, track: &[Vec<f64>], instants: &[usize]) -> Result<Vec<f64>, LabError> {
    let mesh = specimen.model.mesh();
    let (_, high) = mesh.bounding_box();
    let node = node_at(&mesh.points, [high[0] / 2.0, high[1] / 2.0, high[2]])?;
    let cell = specimen
        .model
        .cell_of_node(node)
        .ok_or_else(LabError::no_body)?;
    let heights = instants
        .iter()
        .map(|instant| track[instant - 1][3 * cell as usize + 2]);
    Ok(heights.collect())
}

fn checks() -> Vec<Check> {
    let mut checks = vec![energies(), released(), twisted(), pressed()];
    checks.push(errors(
        Scene::Release,
        &[
            (8000, 1.36e-3),
            (4000, 5.4e-3),
            (2000, 0.0215),
            (1000, 0.0758),
            (600, 0.127),
        ],
    ));
    checks.push(errors(
        Scene::Twist,
        &[
            (8000, 2.6e-4),
            (4000, 9.8e-4),
            (2000, 3.1e-3),
            (1000, 5.9e-3),
        ],
    ));
    checks.push(errors(
        Scene::Push,
        &[(2000, 6.3e-6), (1000, 2.5e-5), (600, 7.0e-5), (500, 1.0e-4)],
    ));
    checks.push(refused(Scene::Release, 500));
    checks.push(refused(Scene::Twist, 800));
    checks.extend([Scene::Release, Scene::Twist, Scene::Push].map(methods));
    checks
}

/// Energies of initial states.
fn energies() -> Check {
    let figures = [
        ("release: elastic (J)", Asked::value(0.730_783_744, 1e-9)),
        ("twist: kinetic (J)", Asked::value(5.83e-3, 5e-6)),
    ];
    Check::several("energy at the start", figures, PROTOTYPE_OF_MOTIONS, |_| {
        let energy = |scene: Scene| -> Result<_, LabError> {
            let Specimen { model, start } = scene.specimen()?;
            model
                .energy(&start.u, &start.v)
                .ok_or_else(LabError::no_body)
        };
        Ok(vec![
            energy(Scene::Release)?.elastic,
            energy(Scene::Twist)?.kinetic,
        ])
    })
}

fn released() -> Check {
    let digits = [
        ("t = .05 s", 0.007_115),
        ("t = .1 s", -0.046_017),
        ("t = .2 s", 0.044_194),
        ("t = .3 s", -0.036_658),
    ];
    let tops_at = digits.map(|(t, z)| {
        (
            format!("u_z of the top's middle (m), {t}"),
            Asked::value(z, 2e-5),
        )
    });
    let energies = [("kinetic", 0.180_58), ("elastic", 0.550_20)].map(|(kind, energy)| {
        (
            format!("{kind} energy (J), t = .1 s"),
            Asked::value(energy, 2e-4),
        )
    });
    let figures = tops_at.into_iter().chain(energies);
    Check::several("release", figures, PROTOTYPE_OF_MOTIONS, |_| {
        let specimen = Scene::Release.specimen()?;
        let mut figures = tops(&specimen, &exact(&specimen, INSTANTS)?, &[5, 10, 20, 30])?;
        figures.extend(energies_at(&specimen, 0.1)?);
        Ok(figures)
    })
}

/// Kinetic and elastic energy (J) at a time (s), with the finest steps.
fn energies_at(specimen: &Specimen, t: f64) -> Result<[f64; 2], LabError> {
    let mut integrator = sinew_integrators::build("central-difference", &Options::new())?;
    let mut state: State = specimen.start.clone();
    let dt = 1.0 / FINEST as f64;
    for _ in 0..(t / dt).round() as usize {
        integrator.step(&specimen.model, &mut state, dt)?;
    }
    let mut v = vec![0.0; state.v.len()];
    state.velocity_at_t(&specimen.model, Inputs::none(), &mut v)?;
    let energy = specimen
        .model
        .energy(&state.u, &v)
        .ok_or_else(LabError::no_body)?;
    Ok([
        0.5 * weighted_dot(specimen.model.mass(), &v, &v),
        energy.elastic,
    ])
}

fn twisted() -> Check {
    let digits = [
        (".01", -40.292),
        (".05", -186.147),
        (".1", -282.498),
        (".2", -41.384),
        (".3", 265.881),
    ];
    let turns = digits.map(|(t, turn)| {
        (
            format!("mean turn of the top (degrees), t = {t} s"),
            Asked::value(turn, 0.001),
        )
    });
    let most = (
        "farthest turn at the instants (degrees)".to_owned(),
        Asked::value(284.1, 0.05),
    );
    Check::several(
        "twist",
        turns.into_iter().chain([most]),
        PROTOTYPE_OF_MOTIONS,
        |_| {
            let specimen = Scene::Twist.specimen()?;
            let mut angle = 0.0;
            let exact = exact(&specimen, INSTANTS)?;
            let turns: Vec<f64> = exact
                .iter()
                .map(|u| {
                    angle = rotation_of_top(&specimen, u, angle);
                    angle.to_degrees()
                })
                .collect();
            let mut figures: Vec<f64> = [1, 5, 10, 20, 30].map(|instant| turns[instant - 1]).into();
            figures.push(largest(&turns));
            Ok(figures)
        },
    )
}

fn pressed() -> Check {
    let digits = [
        (".1", -0.008_181),
        (".2", -0.026_137),
        (".3", -0.020_415),
        (".5", -0.022_173),
    ];
    let figures = digits.map(|(t, z)| {
        (
            format!("u_z of the top's middle (m), t = {t} s"),
            Asked::value(z, 1e-6),
        )
    });
    Check::several("push", figures, PROTOTYPE_OF_MOTIONS, |_| {
        let specimen = Scene::Push.specimen()?;
        tops(&specimen, &exact(&specimen, INSTANTS)?, &[10, 20, 30, 50])
    })
}

/// Errors of central difference for numbers of steps per second.
fn errors(scene: Scene, table: &'static [(usize, f64)]) -> Check {
    let figures = table.iter().map(|(rate, error)| {
        // Half a unit of two digits is up to 5 %, as much as is asked.
        let share = if scene == Scene::Release { 0.05 } else { 0.06 };
        (
            format!("error at {rate} steps/s"),
            Asked::relative(*error, share),
        )
    });
    let case = format!("{}, central-difference", scene.name());
    Check::several(case, figures, PROTOTYPE_OF_MOTIONS, move |_| {
        let specimen = scene.specimen()?;
        let exact = exact(&specimen, INSTANTS)?;
        let error = |(rate, _): &(usize, f64)| {
            Ok(relative_error(&track(&specimen, *rate, INSTANTS)?, &exact))
        };
        table.iter().map(error).collect()
    })
}

/// Steps that are too long, although below the stable step at rest.
fn refused(scene: Scene, rate: usize) -> Check {
    let case = format!("{}, central-difference, {rate} steps/s", scene.name());
    let asked = Asked::at_most(DURATION - 0.01);
    Check::one(
        case,
        "time (s) at which the law refuses the state",
        asked,
        PROTOTYPE_OF_MOTIONS,
        move |_| {
            let specimen = scene.specimen()?;
            let mut integrator = sinew_integrators::build("central-difference", &Options::new())?;
            let (mut state, dt) = (specimen.start.clone(), 1.0 / rate as f64);
            while state.t() < DURATION - 0.5 * dt {
                if integrator.step(&specimen.model, &mut state, dt).is_err() {
                    break;
                }
            }
            Ok(state.t())
        },
    )
}

/// A method with its options, the step (ms), its error, and, if known, its Newton iterations per step with a factor, as
/// in the prototype: with conjugate gradients, which solve only as accurately as an iteration needs, there are more.
type Row = (
    Scene,
    &'static str,
    Option<(&'static str, u32)>,
    usize,
    f64,
    Option<f64>,
);

const METHODS: &[Row] = &[
    (Scene::Push, "newmark", None, 10, 0.0044, Some(2.00)),
    (Scene::Push, "newmark", None, 5, 0.0011, Some(1.97)),
    (Scene::Push, "newmark", None, 20, 0.0174, None),
    (Scene::Push, "generalized-alpha", None, 10, 0.0046, None),
    (Scene::Push, "generalized-alpha", None, 20, 0.0183, None),
    (Scene::Push, "implicit-euler", None, 10, 0.0438, None),
    (Scene::Push, "implicit-euler", None, 20, 0.063, None),
    (Scene::Release, "newmark", None, 5, 0.27, Some(4.06)),
    (Scene::Release, "newmark", None, 5, 0.27, None),
    (Scene::Release, "generalized-alpha", None, 5, 0.27, None),
    (Scene::Release, "generalized-alpha", None, 10, 0.37, None),
    (Scene::Release, "implicit-euler", None, 5, 0.52, None),
    (
        Scene::Release,
        "implicit-euler",
        None,
        10,
        0.702,
        Some(2.48),
    ),
    (Scene::Twist, "newmark", None, 5, 0.094, Some(3.0)),
    (Scene::Twist, "newmark", None, 5, 0.094, None),
    (Scene::Twist, "generalized-alpha", None, 5, 0.099, None),
    (Scene::Twist, "implicit-euler", None, 10, 0.85, None),
    (Scene::Push, "cnn-energy", Some(("ie", 4)), 10, 0.0436, None),
    (
        Scene::Push,
        "cnn-energy",
        Some(("ie", 16)),
        10,
        0.0437,
        None,
    ),
    (
        Scene::Push,
        "cnn-energy",
        Some(("trap", 4)),
        10,
        0.0178,
        None,
    ),
    (
        Scene::Push,
        "cnn-energy",
        Some(("trap", 16)),
        10,
        0.0044,
        None,
    ),
    (Scene::Push, "cnn-energy", Some(("ie", 4)), 5, 0.0282, None),
    (Scene::Push, "cnn-energy", Some(("ie", 16)), 5, 0.0275, None),
    (
        Scene::Push,
        "cnn-energy",
        Some(("trap", 4)),
        5,
        0.0015,
        None,
    ),
    (
        Scene::Push,
        "cnn-energy",
        Some(("trap", 16)),
        5,
        0.0011,
        None,
    ),
    (Scene::Push, "cnn-energy", Some(("ie", 16)), 20, 0.063, None),
    (
        Scene::Push,
        "cnn-energy",
        Some(("trap", 4)),
        20,
        0.066,
        None,
    ),
    (
        Scene::Push,
        "cnn-energy",
        Some(("trap", 16)),
        20,
        0.0171,
        None,
    ),
    (
        Scene::Release,
        "cnn-energy",
        Some(("ie", 16)),
        10,
        0.702,
        None,
    ),
    (
        Scene::Twist,
        "cnn-energy",
        Some(("ie", 16)),
        10,
        0.894,
        None,
    ),
    (
        Scene::Twist,
        "cnn-energy",
        Some(("trap", 16)),
        5,
        0.21,
        None,
    ),
];

/// Number of sweeps from which on a step hardly depends on the starting point of the sweeps. The prototype's sweeps
/// start from rest, and those of the library from the displacement by the velocity: with fewer sweeps the prototype's
/// errors are only bounds.
const FINISHED: u32 = 16;

/// Errors of implicit and cellular methods on a scene.
fn methods(scene: Scene) -> Check {
    let rows = move || METHODS.iter().filter(move |row| row.0 == scene);
    let figures = rows().flat_map(|&(_, id, own, ms, error, iterations)| {
        let is_unfinished = own.is_some_and(|(_, sweeps)| sweeps < FINISHED);
        let own = own.map_or_else(String::new, |(kind, sweeps)| {
            format!(" {kind}, {sweeps} sweeps")
        });
        let by_factor = iterations.map_or("", |_| " by a factor");
        let label = format!("{id}{own}{by_factor}, {ms} ms");
        let digit = if error < 0.01 { 1e-4 } else { 1e-3 };
        let asked = match is_unfinished {
            true => Asked::at_most(1.3 * error),
            false => Asked::value(error, f64::max(0.05 * error, 0.5 * digit)),
        };
        let counted = iterations.map(|count| {
            let figure = format!("{label}: Newton iterations a step");
            (figure, Asked::relative(count, 0.15))
        });
        [(format!("{label}: error"), asked)]
            .into_iter()
            .chain(counted)
    });
    let case = format!("{}, long steps", scene.name());
    Check::several(case, figures, PROTOTYPE_OF_MOTIONS, move |_| {
        let specimen = scene.specimen()?;
        let exact = exact(&specimen, INSTANTS)?;
        let mut figures = Vec::new();
        for &(_, id, own, ms, _, iterations) in rows() {
            let mut options = Options::new();
            if let Some((kind, sweeps)) = own {
                options = options
                    .with("kind", OptionValue::Text(kind.into()))
                    .with_number("sweeps", f64::from(sweeps));
            }
            if iterations.is_some() {
                options = options.with("factor", OptionValue::Text("always".into()));
            }
            let mut integrator = sinew_integrators::build(id, &options)?;
            let (steps, every) = (500 / ms, (10 / ms).max(1));
            let dt = ms as f64 / 1000.0;
            let (found, work) = specimen.track(&mut *integrator, dt, every, steps / every)?;
            // Instants are 10 ms apart, or a step.
            let apart = (ms / 10).max(1);
            let seen: Vec<Vec<f64>> = exact
                .iter()
                .skip(apart - 1)
                .step_by(apart)
                .cloned()
                .collect();
            figures.push(relative_error(&found, &seen));
            figures.extend(iterations.map(|_| work.newton_iterations as f64 / steps as f64));
        }
        Ok(figures)
    })
}

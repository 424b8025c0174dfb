//! Motions of the paper's and the peers' cubes.

use sinew_core::Options;
use sinew_core::vectors::largest;
use sinew_measure::{Case, Effort, MethodChoice, measure};

use crate::bodies::equilibrium;
use crate::check::{Asked, Check, Source};
use crate::error::VerifyError;
use crate::inputs::Inputs;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "motion",
    title: "Motions of a cube over a second",
    says: "Errors over all nodes and instants of a second, relative in the mean square. The peers' cube has no damping; VegaFEM, SOFA and \
           SciPy computed the same errors on the same mesh, mass and load. The paper's cube is its section 4.2 with an edge of 0.2 m, \
           Lloyd's springs and mass damping of 80/s. References are Taylor series in time, to rounding, and none of the methods.",
    checks,
    quoted: &[],
};

const PEERS: &str = "peers-cube.toml";
const PAPERS: &str = "paper-cube.toml";

/// Method, step (ms), error (%) and half a unit of its last digit.
const PEERS_ERRORS: &[(&str, f64, f64, f64)] = &[
    ("central-difference", 2.0, 6.0, 0.05),
    ("central-difference", 1.0, 3.1, 0.05),
    ("central-difference", 0.5, 1.6, 0.05),
    ("central-difference", 0.25, 0.47, 0.005),
    ("central-difference", 0.1, 0.076, 0.0005),
    ("newmark", 10.0, 33.9, 0.05),
    ("newmark", 5.0, 21.2, 0.05),
    ("newmark", 1.0, 4.3, 0.05),
    ("implicit-euler", 10.0, 54.0, 0.5),
    ("implicit-euler", 1.0, 27.0, 0.5),
];

/// Method with options, in words, error (%) at 20 ms and one unit of its last digit.
type PapersError = (&'static str, &'static str, fn(Options) -> Options, f64, f64);

const PAPERS_ERRORS: &[PapersError] = &[
    (
        "cnn",
        "Q = 4",
        |options| options.with_number("saturation", 4.0),
        2520.0,
        10.0,
    ),
    ("cnn-stabilised", "1 sweep", |options| options, 5.92, 0.01),
    ("newmark", "direct", |options| options, 0.924, 0.001),
    (
        "central-difference",
        "3 sub-steps",
        |options| options.with_number("substeps", 3.0),
        0.123,
        0.001,
    ),
    (
        "modified-leapfrog",
        "3 sub-steps",
        |options| options.with_number("substeps", 3.0),
        0.037,
        0.001,
    ),
];

fn checks() -> Vec<Check> {
    let peers = Source::Independent(
        "VegaFEM, SOFA and SciPy on the same mesh, mass and load, measured once for this project",
    );
    let figures = PEERS_ERRORS.iter().map(|(method, ms, percent, half_unit)| {
        (
            format!("{method}, {ms} ms: error (%)"),
            Asked::value(*percent, *half_unit),
        )
    });
    let mut checks = vec![Check::several(
        "the peers' cube",
        figures,
        peers,
        |inputs| {
            let mut case = case(inputs, PEERS)?;
            let errors = PEERS_ERRORS
                .iter()
                .map(|(method, ms, ..)| error(&mut case, method, Options::new(), 1e-3 * ms));
            errors.collect()
        },
    )];
    let prototype = Source::Independent(
        "each method in Python on the same matrices; its digits as it printed them",
    );
    let figures = PAPERS_ERRORS
        .iter()
        .map(|(method, options, _, percent, unit)| {
            (
                format!("{method}, {options}, 20 ms: error (%)"),
                Asked::value(*percent, *unit),
            )
        });
    let figures = figures.chain([
        (
            "propagator, 20 ms: error (%)".to_owned(),
            Asked::at_most(1e-6),
        ),
        (
            "largest static displacement (m)".to_owned(),
            Asked::value(0.01695, 1e-5),
        ),
        ("stable step (ms)".to_owned(), Asked::value(7.9, 0.05)),
    ]);
    checks.push(Check::several(
        "the paper's cube",
        figures,
        prototype,
        |inputs| {
            let mut case = case(inputs, PAPERS)?;
            let mut found = Vec::new();
            for (method, _, options, ..) in PAPERS_ERRORS {
                found.push(error(&mut case, method, options(Options::new()), 0.02)?);
            }
            found.push(error(&mut case, "propagator", Options::new(), 0.02)?);
            found.push(static_displacement(&case)?);
            found.push(1e3 * case.critical_step().unwrap_or(f64::NAN));
            Ok(found)
        },
    ));
    checks
}

fn case(inputs: &Inputs, scene: &str) -> Result<Case, VerifyError> {
    Ok(Case::load(&inputs.scene(scene))?)
}

/// The error (%) of a method.
fn error(case: &mut Case, method: &str, options: Options, dt: f64) -> Result<f64, VerifyError> {
    let mut method = MethodChoice::new(method);
    method.options = options;
    let row = measure(case, &method, dt, Effort::QUICK)?;
    Ok(100.0 * row.error.unwrap_or(f64::INFINITY))
}

fn static_displacement(case: &Case) -> Result<f64, VerifyError> {
    let body = case.simulation().model().body();
    let model = body.map(|body| &body.model).ok_or(VerifyError::NoBody)?;
    Ok(largest(&equilibrium(model)?))
}

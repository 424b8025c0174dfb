//! Motions of the paper's and the peers' cubes.

use std::collections::BTreeMap;

use sinew_core::vectors::largest;
use sinew_core::{OptionValue, Options};
use sinew_measure::{Case, Effort, MethodChoice, Row, measure};

use crate::bodies::equilibrium;
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
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

/// Method with options, its description, error (%) at 20 ms and one unit of its last digit.
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

const LIGHT: &str = "light-cube.toml";

/// A run whose error and work are known: method, options, steps for every 20 ms, error (fraction, to 3 %, or a bound)
/// and sweeps, or solutions of implicit methods, of the second.
type Costed = (&'static str, Options, usize, Asked, u64);

fn number(name: &str, value: f64) -> Options {
    Options::new().with_number(name, value)
}

fn text(name: &str, value: &str) -> Options {
    Options::new().with_text(name, value)
}

fn chebyshev(sweeps: f64) -> Options {
    let entries = [
        ("kind".to_owned(), OptionValue::Text("chebyshev".to_owned())),
        ("sweeps".to_owned(), OptionValue::Number(sweeps)),
    ];
    Options::new().with("inner", OptionValue::Table(BTreeMap::from(entries)))
}

/// Runs on the paper's cube and on one of half its size, damped by 10/s. The modified leapfrog begins with three sweeps
/// instead of two; a propagator takes two per degree and one for the residual.
fn costed() -> [(&'static str, Vec<Costed>); 2] {
    let about = |error: f64| Asked::relative(error, 0.03);
    let plain = Options::new;
    let of_paper = vec![
        ("cnn", number("saturation", 4.0), 1, about(25.2), 50),
        ("cnn", number("saturation", 0.0097), 1, about(0.82), 50),
        ("forward-euler", plain(), 20, about(0.0024), 1000),
        ("cnn-stabilised", plain(), 1, about(0.0592), 50),
        ("cnn-stabilised", plain(), 2, about(0.0081), 100),
        ("cnn-stabilised", chebyshev(4.0), 1, about(0.0125), 200),
        ("cnn-stabilised", chebyshev(8.0), 1, about(0.00783), 400),
        (
            "central-difference",
            number("substeps", 3.0),
            1,
            about(0.00123),
            150,
        ),
        (
            "modified-leapfrog",
            number("substeps", 3.0),
            1,
            Asked::value(4.25e-4, 7.5e-5),
            301,
        ),
        (
            "propagator",
            number("degree", 8.0),
            1,
            Asked::at_most(1e-8),
            850,
        ),
        ("rk4", plain(), 20, Asked::at_most(1e-6), 4000),
        ("newmark", plain(), 1, about(0.00924), 50),
    ];
    let krylov = text("kind", "krylov").with_number("degree", 20.0);
    let two_step = text("kind", "two-step").with_number("tolerance", 1e-6);
    let of_light = vec![
        ("central-difference", plain(), 20, about(0.0028), 1000),
        ("central-difference", plain(), 6, about(0.0148), 300),
        ("modified-leapfrog", plain(), 3, about(0.0104), 301),
        ("modified-leapfrog", plain(), 4, about(0.0072), 401),
        ("modified-leapfrog", plain(), 8, about(8.9e-4), 801),
        ("rk4", plain(), 20, about(1.1e-4), 4000),
        ("rk4", plain(), 40, Asked::at_most(1e-5), 8000),
        ("cnn-stabilised", plain(), 1, about(0.597), 50),
        ("cnn-stabilised", plain(), 4, about(0.189), 200),
        ("cnn-stabilised", chebyshev(8.0), 1, about(0.170), 400),
        ("cnn-stabilised", chebyshev(8.0), 4, about(0.0071), 1600),
        ("cnn", number("saturation", 4.0), 20, about(18.0), 1000),
        ("cnn", number("saturation", 4.0), 4, about(41.0), 200),
        ("cnn", number("saturation", 4.0), 1, about(81.0), 50),
        (
            "propagator",
            number("degree", 12.0),
            1,
            Asked::at_most(4e-8),
            1250,
        ),
        (
            "propagator",
            number("degree", 10.0),
            1,
            Asked::at_most(1e-5),
            1050,
        ),
        // Twenty for the space and one for the residual.
        ("propagator", krylov, 1, Asked::at_most(4e-6), 1050),
        ("propagator", two_step, 1, Asked::at_most(5e-7), 765),
        ("newmark", plain(), 1, about(0.141), 50),
        ("newmark", plain(), 4, about(0.036), 200),
        ("newmark", plain(), 20, about(0.0049), 1000),
        ("implicit-euler", plain(), 1, about(0.156), 50),
        ("implicit-euler", plain(), 20, about(0.038), 1000),
    ];
    [(PAPERS, of_paper), (LIGHT, of_light)]
}

/// Errors and work of runs on one cube.
fn errors_and_work((scene, runs): (&'static str, Vec<Costed>)) -> Check {
    let figures: Vec<_> = runs
        .iter()
        .flat_map(|(method, options, parts, asked, work)| {
            let mut choice = MethodChoice::new(*method);
            choice.options = options.clone();
            let run = format!("{}, {parts} steps for every 20 ms", choice.label());
            let work = Asked::value(*work as f64, 0.0);
            [
                (format!("{run}: error"), *asked),
                (
                    format!("{run}: sweeps, or solutions where there are any"),
                    work,
                ),
            ]
        })
        .collect();
    let source = Source::Independent(
        "each method in Python on the same matrices; work by the formula of the method",
    );
    Check::several(
        format!("{scene}: errors and work"),
        figures,
        source,
        move |inputs| {
            let mut case = case(inputs, scene)?;
            let mut found = Vec::new();
            for (method, options, parts, ..) in &runs {
                let row = row(&mut case, method, options.clone(), 0.02 / *parts as f64)?;
                found.push(row.error.unwrap_or(f64::INFINITY));
                let work = if row.work.solves > 0 {
                    row.work.solves
                } else {
                    row.work.sweeps
                };
                found.push(work as f64);
            }
            Ok(found)
        },
    )
}

/// Tolerance, fit to the load, error and sweeps per second of the two-step propagator.
type TwoStep = (Option<f64>, bool, f64, f64);

/// Runs on the peers' cube; a sweep should cost a fifth of a product of SciPy, whose central difference takes 1000.
const TWO_STEP: &[TwoStep] = &[
    (Some(1e-3), false, 1e-3, 1666.0),
    (Some(1e-8), false, 1e-6, 5000.0),
    (None, true, 6e-3, 720.0),
    (Some(6e-3), true, 6e-3, 720.0),
    (Some(1e-3), true, 1e-3, 820.0),
    (Some(2e-6), true, 4e-6, 1020.0),
];

/// Errors of the two-step propagator, its sweeps, and, if it is fitted to the load, its error over the error estimated
/// for eight periods.
fn two_step() -> Check {
    let figures = TWO_STEP
        .iter()
        .flat_map(|run @ &(_, is_fitted, error, sweeps)| {
            let mut choice = MethodChoice::new("propagator");
            choice.options = two_step_options(run);
            let name = choice.label();
            let estimate = format!("{name}: binary logarithm of the error over its estimate");
            let estimate = is_fitted.then_some((estimate, Asked::value(0.0, 1.0)));
            let figures = [
                (format!("{name}: error"), Asked::at_most(error)),
                (format!("{name}: sweeps"), Asked::at_most(sweeps)),
            ];
            figures.into_iter().chain(estimate)
        });
    let mark = Source::Independent("SciPy's central difference on the same mesh, mass and load");
    Check::several("the peers' cube, 10 ms", figures, mark, |inputs| {
        let mut case = case(inputs, PEERS)?;
        let mut found = Vec::new();
        for run @ &(_, is_fitted, ..) in TWO_STEP {
            let row = row(&mut case, "propagator", two_step_options(run), 0.01)?;
            let error = row.error.unwrap_or(f64::INFINITY);
            found.extend([error, row.sweeps_per_s]);
            if is_fitted {
                let estimate = row.facts.get("estimated_error").copied();
                found.push((error / estimate.unwrap_or(f64::NAN)).log2());
            }
        }
        Ok(found)
    })
}

fn two_step_options(&(tolerance, is_fitted, ..): &TwoStep) -> Options {
    let mut options = text("kind", "two-step");
    if is_fitted {
        options = options.with_text("fit", "load");
    }
    match tolerance {
        Some(tolerance) => options.with_number("tolerance", tolerance),
        None => options,
    }
}

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
    checks.extend(costed().map(errors_and_work));
    checks.push(two_step());
    checks
}

fn case(inputs: &Inputs, scene: &str) -> Result<Case, LabError> {
    Ok(Case::load(&inputs.scene(scene))?)
}

fn row(case: &mut Case, method: &str, options: Options, dt: f64) -> Result<Row, LabError> {
    let mut method = MethodChoice::new(method);
    method.options = options;
    Ok(measure(case, &method, dt, Effort::UNTIMED)?)
}

/// The error (%) of a method.
fn error(case: &mut Case, method: &str, options: Options, dt: f64) -> Result<f64, LabError> {
    let row = row(case, method, options, dt)?;
    Ok(100.0 * row.error.unwrap_or(f64::INFINITY))
}

fn static_displacement(case: &Case) -> Result<f64, LabError> {
    let body = case.simulation().model().body();
    let model = body.map(|body| &body.model).ok_or_else(LabError::no_body)?;
    Ok(largest(&equilibrium(model)?))
}

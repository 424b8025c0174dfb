//! A bench that never ran, with figures of realistic size: every file is written, has the expected contents, and can be
//! viewed in the directory that the test prints.

use std::{collections::BTreeMap, fs, path::Path};

use serde_json::{Value, json};
use sinew_bench::{
    report::{markdown, terminal, write_all},
    results::{BenchResults, Skipped},
};
use sinew_draw::{Axis, Plot, Series, Style, Surface};
use sinew_measure::{CaseInfo, Row, RowOutcome, RowVerdict, Work, mark_pareto};
use sinew_scene::output::OutputFolder;
use sinew_verify::Machine;

const DOFS: usize = 2673;
/// CPU seconds of a sweep over the cube, and of a solve with its factorised matrix.
const SWEEP: f64 = 18.9e-6;
const SOLVE: f64 = 410e-6;

fn options(value: &Value) -> BTreeMap<String, Value> {
    let entries = value.as_object().into_iter().flatten();
    entries.map(|(k, v)| (k.clone(), v.clone())).collect()
}

/// One method on the cube at 1, 2, 5, 10 and 20 ms.
struct MethodChoice {
    id: &'static str,
    options: Value,
    /// Sweeps and solves of a step.
    work: (f64, f64),
    /// Errors (fraction); infinite where the run diverges.
    errors: [f64; 5],
    /// Shares of saturated cells, for the same steps.
    saturated: [f64; 5],
}

const DTS: [f64; 5] = [0.001, 0.002, 0.005, 0.01, 0.02];
const NEVER: [f64; 5] = [0.0; 5];
const DIVERGED: f64 = f64::INFINITY;

fn methods() -> Vec<MethodChoice> {
    let method = |id, options, work, errors, saturated| MethodChoice {
        id,
        options,
        work,
        errors,
        saturated,
    };
    let inner = |kind: &str, sweeps: u32| json!({ "inner": { "kind": kind, "sweeps": sweeps } });
    let block = json!({ "inner": { "kind": "block" } });
    let late = [0.0, 0.0, 0.0, 0.31, 0.766];
    vec![
        method(
            "forward-euler",
            json!({}),
            (1.0, 0.0),
            [2.4e-3, 4.9e-3, 1.3e-2, DIVERGED, DIVERGED],
            NEVER,
        ),
        method(
            "symplectic-euler",
            json!({}),
            (1.0, 0.0),
            [1.1e-3, 2.2e-3, 5.6e-3, DIVERGED, DIVERGED],
            NEVER,
        ),
        method(
            "central-difference",
            json!({}),
            (1.0, 0.0),
            [1.4e-5, 5.5e-5, 3.5e-4, DIVERGED, DIVERGED],
            NEVER,
        ),
        method(
            "central-difference",
            json!({ "substeps": 3 }),
            (3.0, 0.0),
            [1.6e-6, 6.2e-6, 3.9e-5, 1.6e-4, 1.23e-3],
            NEVER,
        ),
        method(
            "modified-leapfrog",
            json!({ "substeps": 3 }),
            (6.0, 0.0),
            [5.1e-9, 4.2e-8, 1.2e-6, 2.1e-5, 3.7e-4],
            NEVER,
        ),
        method(
            "rk4",
            json!({}),
            (4.0, 0.0),
            [2.0e-9, 3.3e-8, 1.4e-6, 2.5e-5, DIVERGED],
            NEVER,
        ),
        method(
            "newmark",
            json!({}),
            (0.0, 1.0),
            [2.4e-5, 9.6e-5, 5.9e-4, 2.4e-3, 9.24e-3],
            NEVER,
        ),
        method(
            "implicit-euler",
            json!({}),
            (0.0, 1.0),
            [2.2e-3, 4.4e-3, 1.1e-2, 2.2e-2, 4.3e-2],
            NEVER,
        ),
        method(
            "cnn",
            json!({ "saturation": 4.0 }),
            (1.0, 0.0),
            [2.4e-3, 4.9e-3, 1.3e-2, 11.8, 25.2],
            late,
        ),
        method(
            "cnn",
            json!({ "saturation": 0.0097 }),
            (1.0, 0.0),
            [0.61, 0.62, 0.66, 0.74, 0.82],
            [0.4, 0.41, 0.45, 0.6, 0.8],
        ),
        method(
            "cnn-stabilised",
            block,
            (1.0, 0.0),
            [1.4e-5, 5.5e-5, 3.5e-4, 8.1e-3, 5.92e-2],
            NEVER,
        ),
        method(
            "cnn-stabilised",
            inner("chebyshev", 4),
            (4.0, 0.0),
            [1.4e-5, 5.5e-5, 3.5e-4, 3.1e-3, 1.25e-2],
            NEVER,
        ),
        method(
            "cnn-stabilised",
            inner("chebyshev", 8),
            (8.0, 0.0),
            [1.4e-5, 5.5e-5, 3.5e-4, 2.2e-3, 7.83e-3],
            NEVER,
        ),
        method(
            "propagator",
            json!({ "kind": "chebyshev", "degree": 8 }),
            (16.0, 0.0),
            [1e-13, 1e-13, 2e-12, 4e-10, 8e-9],
            NEVER,
        ),
    ]
}

fn cube_rows(case: &str, harder: f64) -> Vec<Row> {
    let rows = methods().into_iter().flat_map(|method| {
        DTS.iter().enumerate().map(move |(i, &dt)| {
            let steps = (1.0 / dt).round();
            let per_step = method.work.0 * SWEEP + method.work.1 * SOLVE;
            let error = method.errors[i] * harder;
            let diverged = error.is_infinite();
            let saturated = method.saturated[i];
            Row {
                case: case.into(),
                integrator: method.id.into(),
                options: options(&method.options),
                dt,
                steps: if diverged { 17 } else { steps as u64 },
                sweeps_per_s: method.work.0 / dt,
                outcome: if diverged {
                    RowOutcome::Diverged
                } else {
                    RowOutcome::Finished
                },
                diverged_at_s: diverged.then_some(17.0 * dt),
                bounded: error < 200.0,
                settles: error < 0.3,
                error: (!diverged).then_some(error),
                max_u: (!diverged).then_some(if error > 1.0 { 0.16 } else { 0.02 }),
                late_amplitude: (!diverged).then_some(if error > 1.0 { 0.08 } else { 1e-5 }),
                saturated,
                guarded: saturated > 0.0,
                inverted: if saturated > 0.5 { 1676 } else { 0 },
                work: Work {
                    sweeps: (method.work.0 * steps) as u64,
                    force_evaluations: (method.work.0 * steps) as u64,
                    solves: (method.work.1 * steps) as u64,
                    factorizations: method.work.1 as u64,
                    ..Work::default()
                },
                cpu_s_per_s: per_step / dt,
                us_per_step: 1e6 * per_step,
                setup_cpu_s: 0.011 + 0.083 * method.work.1,
                facts: BTreeMap::new(),
                pareto: false,
                ..Row::default()
            }
        })
    });
    rows.collect()
}

fn oscillator_rows() -> Vec<Row> {
    let runs = [
        ("forward-euler", json!({}), 0.001, 0.0772),
        ("forward-euler", json!({}), 0.02, 4e3),
        ("cnn", json!({ "saturation": 4.0 }), 0.001, 0.0736),
        ("cnn", json!({ "saturation": 4.0 }), 0.015, 3.496),
        ("cnn", json!({ "saturation": 4.0 }), 0.02, 4.257),
        ("cnn", json!({ "saturation": 2.0 }), 0.001, 0.4875),
        ("cnn", json!({ "saturation": 2.0 }), 0.015, 2.085),
        ("cnn", json!({ "saturation": 2.0 }), 0.02, 2.390),
        ("symplectic-euler", json!({}), 0.001, 0.0150),
        ("symplectic-euler", json!({}), 0.015, 0.240),
        ("symplectic-euler", json!({}), 0.02, 0.330),
        ("central-difference", json!({}), 0.001, 2.32e-4),
        ("central-difference", json!({}), 0.015, 0.0542),
        ("central-difference", json!({}), 0.02, 0.0993),
        ("newmark", json!({}), 0.001, 3.77e-4),
        ("newmark", json!({}), 0.02, 0.152),
        ("rk4", json!({}), 0.001, 3.79e-8),
        ("rk4", json!({}), 0.02, 6.55e-3),
    ];
    let rows = runs.into_iter().map(|(id, values, dt, error)| {
        let guarded = id == "cnn";
        let per_step = if id == "rk4" { 9e-8 } else { 3e-8 };
        Row {
            case: "oscillator".into(),
            integrator: id.into(),
            options: options(&values),
            dt,
            steps: (1.0_f64 / dt - 1e-9).ceil() as u64,
            sweeps_per_s: 1.0 / dt,
            bounded: error < 10.0,
            settles: error < 1.0,
            error: Some(error),
            max_u: Some(0.126),
            late_amplitude: Some(1e-3),
            saturated: if guarded { 0.2 } else { 0.0 },
            guarded,
            work: Work {
                sweeps: (1.0 / dt) as u64,
                ..Work::default()
            },
            cpu_s_per_s: per_step / dt,
            us_per_step: 1e6 * per_step,
            setup_cpu_s: 2e-6,
            ..Row::default()
        }
    });
    rows.collect()
}

fn case(id: &str, title: &str, dofs: usize, critical_step_s: f64) -> CaseInfo {
    CaseInfo {
        id: id.into(),
        remarks: Vec::new(),
        title: title.into(),
        dofs,
        duration_s: 1.0,
        reference: "Chebyshev propagator, degree 40, 1 ms steps".into(),
        reference_error: 3e-12,
        max_u_m: 0.02,
        late_amplitude_m: 1.2e-5,
        critical_step_s: Some(critical_step_s),
        stable_steps_s: BTreeMap::new(),
    }
}

fn results() -> BenchResults {
    let machine = Machine {
        cpu: "A processor that was never built".into(),
        threads: 2,
        os: "linux".into(),
        arch: "x86_64".into(),
        compiler: Some("rustc 1.95.0".into()),
    };
    let mut results = BenchResults::new("synthetic", machine);
    results.date = Some("2026-11-20".into());
    results.cases = vec![
        case(
            "paper-cube",
            "The paper's cube, reproduction scene",
            DOFS,
            7.9e-3,
        ),
        case(
            "oscillator",
            "Damped oscillator of the paper's section 4.1",
            1,
            0.0632,
        ),
        case(
            "stiff-inclusion",
            "Stiff inclusion, E 1 : 10000 & density 1 : 10",
            DOFS,
            8e-4,
        ),
    ];
    results.rows = cube_rows("paper-cube", 1.0);
    results.rows.extend(oscillator_rows());
    results.rows.extend(cube_rows("stiff-inclusion", 14.0));
    mark_pareto(&mut results.rows);
    results.skipped.push(Skipped {
        case: "stiff-inclusion".into(),
        integrator: "modal".into(),
        dt: 0.02,
        reason: "needs 2673 modes; more than the 500 allowed".into(),
    });
    results
}

fn directory() -> &'static Path {
    Path::new(concat!(env!("CARGO_TARGET_TMPDIR"), "/sample-report"))
}

#[test]
fn everything_is_written() {
    let results = results();
    let written = write_all(&results, &OutputFolder::new(directory(), &[])).unwrap();
    println!("look at {}", written.report.display());

    let json = fs::read_to_string(&written.results).unwrap();
    assert!(BenchResults::from_json(&json).unwrap() == results);

    let names: Vec<_> = written
        .plots
        .iter()
        .map(|path| path.file_name().unwrap().to_str().unwrap())
        .collect();
    assert_eq!(
        names,
        [
            "work-precision-paper-cube.svg",
            "stability-paper-cube.svg",
            "work-precision-oscillator.svg",
            "stability-oscillator.svg",
            "work-precision-stiff-inclusion.svg",
            "stability-stiff-inclusion.svg",
        ]
    );
    for path in &written.plots {
        let svg = fs::read_to_string(path).unwrap();
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{path:?}");
        let open = svg.matches("<g>").count() + svg.matches("<g ").count();
        assert_eq!(open, svg.matches("</g>").count());
    }
    let page = fs::read_to_string(&written.report).unwrap();
    assert_eq!(page.matches("<svg xmlns").count(), written.plots.len());
    assert!(page.contains("E 1 : 10000 &amp; density"));
    assert!(page.contains("needs 2673 modes"));

    for entry in fs::read_dir(directory()).unwrap() {
        let name = entry.unwrap().file_name();
        assert!(!name.to_string_lossy().ends_with(".tmp"), "{name:?}");
    }
}

#[test]
fn the_table_tells_what_happened() {
    let results = results();
    let text = terminal(&results);
    println!("{text}");
    let line = |needle: &str| {
        let found = text.lines().find(|line| line.contains(needle));
        found.unwrap_or_else(|| panic!("{needle}")).to_owned()
    };
    assert!(line("diverged at t=0.34 s").contains("forward-euler"));
    assert!(line("2520").contains("cnn Q=4"));
    assert!(line("modal").contains("needs 2673 modes"));
    assert!(text.lines().any(|l| l.contains("unbounded (4.00e5)")));

    let markdown = markdown(&results);
    fs::write(directory().join("../table.md"), &markdown).unwrap();
    assert_eq!(
        markdown
            .lines()
            .filter(|line| line.starts_with('|'))
            .count(),
        results.rows.len() + 2 * results.cases.len()
    );
}

#[test]
fn the_front_holds_only_good_runs() {
    let results = results();
    let front: Vec<&Row> = results.rows.iter().filter(|row| row.pareto).collect();
    assert!(front.len() > 6);
    for row in front {
        assert!(row.error.unwrap() <= 0.5);
        assert!(!matches!(
            row.verdict(),
            RowVerdict::Diverged | RowVerdict::Unbounded
        ));
    }
}

#[test]
fn displacement_over_time() {
    let damped = |t: f64| -0.158 * (-5.0 * t).exp() * (31.2 * t).sin();
    let times = |n: usize, dt: f64| (0..=n).map(move |i| i as f64 * dt);
    let exact = times(1000, 0.001).map(|t| (t, damped(t)));
    // Grows by a constant factor from step to step, as forward Euler does.
    let growing = times(66, 0.015).map(|t| (t, -0.16 * (2.4 * t).exp() * (31.2 * t).sin()));
    let cycle = times(66, 0.015).map(|t| (t, -0.21 * (33.0 * t).sin()));
    let plot = Plot::new(
        "Oscillator, dt = 15 ms",
        Axis::linear("time [s]").range(0.0, 1.0),
        Axis::linear("displacement [m]").range(-0.25, 0.25),
    )
    .with(Series::line("exact", Style::nth(6), exact))
    .with(Series::line("forward Euler", Style::nth(1), growing))
    .with(Series::line("cnn Q=4", Style::nth(0), cycle))
    .with_vertical_rule(0.5, "load off");
    let svg = plot.svg();
    assert!(svg.contains("forward Euler leaves the frame"));
    fs::create_dir_all(directory()).unwrap();
    fs::write(directory().join("../time.svg"), &svg).unwrap();
}

#[test]
fn every_triangle_of_a_deformed_cube_is_drawn() {
    let n = 10_u32;
    let edge = 0.2;
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [0.0, edge] {
            let first = points.len() as u32;
            for i in 0..=n {
                for j in 0..=n {
                    let mut p = [side; 3];
                    p[(axis + 1) % 3] = edge * f64::from(i) / f64::from(n);
                    p[(axis + 2) % 3] = edge * f64::from(j) / f64::from(n);
                    points.push(p);
                }
            }
            for i in 0..n {
                for j in 0..n {
                    let at = |i: u32, j: u32| first + i * (n + 1) + j;
                    let (a, b) = (at(i, j), at(i + 1, j));
                    let (c, d) = (at(i + 1, j + 1), at(i, j + 1));
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
    }
    let sag = |p: &[f64; 3]| {
        let bump = |x: f64| (std::f64::consts::PI * x / edge).sin();
        -0.05 * bump(p[0]) * bump(p[1]) * (0.4 + 0.6 * p[2] / edge)
    };
    let values: Vec<f64> = points.iter().map(|p| -1e3 * sag(p)).collect();
    let moved: Vec<[f64; 3]> = points.iter().map(|p| [p[0], p[1], p[2] + sag(p)]).collect();
    let mut surface = Surface::new(
        "Cube under 500 Pa, stabilised CNN, 20 ms",
        &moved,
        &triangles,
        &values,
        "displacement |u| [mm]",
    );
    surface.outline = Some([[0.0; 3], [edge; 3]]);
    fs::create_dir_all(directory()).unwrap();
    // A facet is what has an edge of half a pixel.
    let facets = |svg: &str| svg.matches("stroke-width=\"0.5\"").count();
    let svg = surface.svg();
    assert_eq!(facets(&svg), triangles.len());
    assert!(svg.contains("displacement |u| [mm]") && !svg.contains("NaN"));
    fs::write(directory().join("../cube.svg"), svg).unwrap();

    let wild: Vec<[f64; 3]> = points
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let jump = |k: usize| 0.16 * ((i * (7 + 5 * k)) as f64 * 2.399).sin();
            [p[0] + jump(0), p[1] + jump(1), p[2] + jump(2)]
        })
        .collect();
    surface.points = &wild;
    surface.title = "The same, paper's CNN Q=4 (same colours)".into();
    let svg = surface.svg();
    assert_eq!(facets(&svg), triangles.len());
    assert!(!svg.contains("NaN"));
    fs::write(directory().join("../wild.svg"), svg).unwrap();
}

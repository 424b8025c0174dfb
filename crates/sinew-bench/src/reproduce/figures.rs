//! The figures.

use sinew_mesh::GroupMembers;

use super::runs::{History, LARGE, Runs, SMALL, Snapshot, VOLTAGES, wrong};
use crate::report::three;
use sinew_draw::{Axis, Plot, Series, Style, Surface};
use sinew_measure::Row;
use sinew_verify::LabError;

/// A figure of the paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its number, as in `1b`.
    pub number: &'static str,
    /// Its caption.
    pub caption: String,
    /// The picture.
    pub svg: String,
}

/// The numbers of all figures, in the paper's order.
pub(super) const NUMBERS: [&str; 8] = ["1b", "2a", "2b", "3a", "3b", "4b", "4c", "4d"];

/// Range (m) of the paper's vertical axes, slightly extended.
const FRAME: f64 = 0.3;

pub(super) fn figures(runs: &Runs<'_>) -> Result<Vec<Figure>, LabError> {
    let [small, middle, large] = &runs.euler;
    let at_q4 = &runs.network[0];
    let mut figures = vec![
        oscillator(
            runs,
            "1b",
            "explicit integration at three steps",
            &[
                (format!("explicit, {}", step(SMALL)), small),
                (format!("explicit, {}", step(LARGE[0])), middle),
                (format!("explicit, {}", step(LARGE[1])), large),
            ],
        ),
        oscillator(
            runs,
            "2a",
            "explicit integration and the network, Q = 4",
            &[
                (format!("explicit, {}", step(SMALL)), small),
                (format!("CNN, {}", step(SMALL)), &at_q4[0]),
                (format!("CNN, {}", step(LARGE[0])), &at_q4[1]),
                (format!("CNN, {}", step(LARGE[1])), &at_q4[2]),
            ],
        ),
        oscillator(
            runs,
            "2b",
            "explicit integration and the network at a large step",
            &[
                (format!("explicit, {}", step(LARGE[1])), large),
                (format!("CNN, {}", step(LARGE[1])), &at_q4[2]),
            ],
        ),
    ];
    for (number, index, dt) in [("3a", 0, SMALL), ("3b", 2, LARGE[1])] {
        let series: Vec<(String, &History)> = VOLTAGES
            .iter()
            .zip(&runs.network)
            .map(|(q, histories)| (format!("CNN, Q = {q}"), &histories[index]))
            .collect();
        let title = format!("three saturation voltages at {}", step(dt));
        figures.push(oscillator(runs, number, &title, &series));
    }
    let [euler_small, network_small] = &runs.cube_small;
    let [euler_large, network_large] = &runs.cube_large;
    figures.push(cube(
        runs,
        "4b",
        if euler_small.u == network_small.u {
            format!("{}, both methods, same bits", step(SMALL))
        } else {
            format!("{}, network", step(SMALL))
        },
        network_small,
    )?);
    let title = format!(
        "{}: explicit integration after {} s",
        step(LARGE[1]),
        shown(euler_large.t)
    );
    figures.push(cube(runs, "4c", title, euler_large)?);
    let title = format!(
        "{}: network after {} s",
        step(LARGE[1]),
        shown(network_large.t)
    );
    figures.push(cube(runs, "4d", title, network_large)?);
    Ok(figures)
}

fn step(dt: f64) -> String {
    format!("dt = {dt} s")
}

fn shown(t: f64) -> f64 {
    (t * 1e6).round() / 1e6
}

fn oscillator(
    runs: &Runs<'_>,
    number: &'static str,
    title: &str,
    histories: &[(String, &History)],
) -> Figure {
    let mut plot = Plot::new(
        format!("Figure {number}: {title}"),
        Axis::linear("t [s]").range(0.0, 1.0),
        Axis::linear("u [m]").range(-FRAME, FRAME),
    );
    let reference = runs.reference.iter().copied();
    plot = plot.with(Series::line("reference", Style::nth(0), reference));
    for (index, (name, history)) in histories.iter().enumerate() {
        let points = history.points.iter().copied();
        plot = plot.with(Series::line(name.clone(), Style::nth(index + 1), points));
    }
    let errors: Vec<String> = histories
        .iter()
        .map(|(name, history)| format!("{name}: {}", error_in_words(&history.row)))
        .collect();
    Figure {
        number,
        caption: format!(
            "Oscillator of section 4.1, {title}. Errors: {}.",
            errors.join("; ")
        ),
        svg: plot.svg(),
    }
}

/// A fraction in per cent, three significant digits.
pub(super) fn percent(fraction: f64) -> String {
    format!("{} %", three(100.0 * fraction))
}

/// The error of a run, or its outcome.
pub(super) fn error_in_words(row: &Row) -> String {
    match row.error {
        Some(error) if row.bounded => percent(error),
        Some(error) => format!("unbounded ({})", percent(error)),
        None => "unbounded".into(),
    }
}

fn cube(
    runs: &Runs<'_>,
    number: &'static str,
    title: String,
    snapshot: &Snapshot,
) -> Result<Figure, LabError> {
    let Some(body) = runs.cube.simulation().model().body() else {
        return Err(wrong(runs.cube, "a body"));
    };
    let mesh = &body.mesh;
    let mut points = mesh.points.clone();
    let mut values = vec![0.0; points.len()];
    for (node, point) in (0..).zip(&mut points) {
        let u = body.model.node_displacement(snapshot.t, &snapshot.u, node);
        let u = u.map_err(|_| wrong(runs.cube, "a snapshot of its own"))?;
        values[node as usize] = u.iter().map(|u| u * u).sum::<f64>().sqrt() * 1e3;
        for (coordinate, u) in point.iter_mut().zip(u) {
            *coordinate += u;
        }
    }
    let surfaces = mesh.groups.iter().filter_map(|group| match &group.members {
        GroupMembers::Triangles(triangles) => Some(triangles),
        _ => None,
    });
    let triangles: Vec<[u32; 3]> = surfaces.flatten().copied().collect();
    let (low, high) = mesh.bounding_box();
    let surface = Surface {
        outline: Some([low, high]),
        ..Surface::new(
            format!("Figure {number}: {title}"),
            &points,
            &triangles,
            &values,
            "|u| [mm]",
        )
    };
    Ok(Figure {
        number,
        caption: format!(
            "Cube of section 4.2, {title}. Error over the run {}; {} of {} tetrahedra inverted in this state.",
            error_in_words(&snapshot.row),
            snapshot.inverted,
            mesh.tets.len()
        ),
        svg: surface.svg(),
    })
}

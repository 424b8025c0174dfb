//! Heat maps: error and boundedness over step and a parameter, a panel for each method.

use sinew_draw::colour_map::viridis;
use sinew_draw::svg::{Anchor, Frame, Paint, Stroke, Svg, Text, text_width};
use sinew_draw::{Axis, Colour, Dash};
use sinew_measure::RowVerdict;

use super::{number, verdict};
use crate::results::{MapPanel, MapRun, StabilityMap};

const MARGIN: f64 = 14.0;
const TITLE: f64 = 15.0;
const TEXT: f64 = 12.0;
const SMALL: f64 = 11.0;
const CELL: (f64, f64) = (23.0, 22.0);
const COLUMNS: usize = 3;
/// Room above a panel for its name, and below it for its axis.
const HEAD: f64 = 40.0;
const FOOT: f64 = 44.0;
const BETWEEN: f64 = 22.0;
/// Errors (fraction) at the ends of the colours.
const RANGE: (f64, f64) = (1e-4, 1.0);

/// The map as SVG: colours for errors, signs for runs that failed, a line for the stable step that
/// each method gives.
#[must_use]
pub fn heat_map(map: &StabilityMap) -> String {
    let layout = Layout::of(map);
    let title = format!("{}: error by step and by method", map.title);
    let mut svg = Svg::new(layout.width, layout.height, &title);
    svg.text(
        &Text::new(MARGIN, MARGIN + 0.6 * TITLE, &title)
            .sized(TITLE)
            .bold(),
    );
    for (index, panel) in map.panels.iter().enumerate() {
        draw_panel(
            &mut svg,
            map,
            panel,
            layout.frame(index),
            index % COLUMNS == 0,
        );
    }
    draw_legend(&mut svg, MARGIN, layout.legend_top);
    svg.finish()
}

struct Layout {
    gutter: f64,
    panel: (f64, f64),
    top: f64,
    legend_top: f64,
    width: f64,
    height: f64,
}

impl Layout {
    fn of(map: &StabilityMap) -> Self {
        let labels = map
            .values
            .iter()
            .map(|value| text_width(&number::short(*value), SMALL));
        // Values, and the parameter's name along them.
        let gutter = labels.fold(20.0, f64::max) + 10.0 + TEXT + 8.0;
        let panel = (
            map.steps.len() as f64 * CELL.0,
            map.values.len() as f64 * CELL.1,
        );
        let top = MARGIN + TITLE + 10.0;
        let rows = map.panels.len().div_ceil(COLUMNS) as f64;
        let columns = map.panels.len().min(COLUMNS) as f64;
        let legend_top = top + rows * (HEAD + panel.1 + FOOT);
        let width =
            MARGIN + columns * (gutter + panel.0) + (columns - 1.0).max(0.0) * BETWEEN + MARGIN;
        Self {
            gutter,
            panel,
            top,
            legend_top,
            width: width.max(1040.0),
            height: legend_top + 66.0 + MARGIN,
        }
    }

    fn frame(&self, index: usize) -> Frame {
        let (row, column) = ((index / COLUMNS) as f64, (index % COLUMNS) as f64);
        Frame {
            left: MARGIN + self.gutter + column * (self.gutter + self.panel.0 + BETWEEN),
            top: self.top + HEAD + row * (HEAD + self.panel.1 + FOOT),
            width: self.panel.0,
            height: self.panel.1,
        }
    }
}

fn draw_panel(svg: &mut Svg, map: &StabilityMap, panel: &MapPanel, frame: Frame, named: bool) {
    svg.text(
        &Text::new(frame.left, frame.top - 27.0, &panel.method)
            .sized(13.0)
            .bold(),
    );
    let computed = panel.stable_steps.iter().any(Option::is_some);
    let theory = match (computed, panel.cannot_tell) {
        (true, false) => "line: largest stable step, computed",
        (true, true) => "line: largest stable step, where it is known",
        (false, false) => "stable at any step",
        (false, true) => "cannot tell its stable step",
    };
    svg.text(
        &Text::new(frame.left, frame.top - 11.0, theory)
            .sized(SMALL)
            .painted(Paint::Muted),
    );
    for (row, (value, runs)) in map.values.iter().zip(&panel.runs).enumerate() {
        // The first value at the bottom, as on an axis.
        let top = frame.bottom() - (row + 1) as f64 * CELL.1;
        svg.text(
            &Text::new(frame.left - 6.0, top + 0.5 * CELL.1, &number::short(*value))
                .sized(SMALL)
                .anchored(Anchor::End),
        );
        for (column, (dt, run)) in map.steps.iter().zip(runs).enumerate() {
            let cell = Frame {
                left: frame.left + column as f64 * CELL.0,
                top,
                width: CELL.0,
                height: CELL.1,
            };
            let note = note(map, panel, *value, *dt, run);
            svg.noted(&note, |svg| draw_run(svg, cell, run));
        }
    }
    draw_limit(svg, map, panel, frame);
    draw_steps(svg, map, frame);
    if named {
        let middle = frame.top + 0.5 * frame.height;
        let parameter = Text::new(MARGIN + 0.5 * TEXT, middle, &map.parameter);
        svg.text(&parameter.anchored(Anchor::Middle).upward());
    }
}

fn draw_steps(svg: &mut Svg, map: &StabilityMap, frame: Frame) {
    let mut free = f64::NEG_INFINITY;
    for (column, dt) in map.steps.iter().enumerate() {
        let x = frame.left + (column as f64 + 0.5) * CELL.0;
        let tick = frame.bottom();
        svg.line((x, tick), (x, tick + 4.0), Stroke::new(Paint::Muted, 1.0));
        let label = number::milliseconds((*dt * 1e6).round() / 1e6);
        let half = 0.5 * text_width(&label, SMALL);
        if x - half > free {
            svg.text(
                &Text::new(x, tick + 13.0, &label)
                    .sized(SMALL)
                    .anchored(Anchor::Middle),
            );
            free = x + half + 8.0;
        }
    }
    let middle = frame.left + 0.5 * frame.width;
    svg.text(&Text::new(middle, frame.bottom() + 29.0, "step dt [ms]").anchored(Anchor::Middle));
}

fn draw_run(svg: &mut Svg, cell: Frame, run: &MapRun) {
    let (fill, ink) = match (run.verdict(), run.error) {
        (RowVerdict::Unbounded | RowVerdict::Diverged, _) | (_, None) => {
            (verdict::tint(run.verdict()), Paint::OnTint)
        }
        (_, Some(error)) => {
            let share = share(error);
            // Light on the dark half of the colours.
            let ink = if share < 0.6 {
                Colour(0xff, 0xff, 0xff)
            } else {
                Colour(0x11, 0x11, 0x11)
            };
            (viridis(share), Paint::Data(ink))
        }
    };
    svg.facet(
        &[
            (cell.left, cell.top),
            (cell.right(), cell.top),
            (cell.right(), cell.bottom()),
            (cell.left, cell.bottom()),
        ],
        fill,
        fill,
    );
    let sign = sign(run);
    if !sign.is_empty() {
        let middle = (cell.left + 0.5 * cell.width, cell.top + 0.5 * cell.height);
        let text = Text::new(middle.0, middle.1, sign)
            .anchored(Anchor::Middle)
            .painted(ink);
        svg.text(&text.sized(SMALL).bold());
    }
}

/// A sign for what colour alone must not say.
fn sign(run: &MapRun) -> &'static str {
    match run.verdict() {
        RowVerdict::Accurate => "",
        RowVerdict::Wrong if run.error.is_some_and(|error| error < 1.0) => "",
        verdict => verdict.symbol(),
    }
}

/// Place of an error among the colours.
fn share(error: f64) -> f64 {
    let (low, high) = (RANGE.0.log10(), RANGE.1.log10());
    ((error.log10() - low) / (high - low)).clamp(0.0, 1.0)
}

/// The stable step of each row, joined from row to row; along the edge where it lies outside.
fn draw_limit(svg: &mut Svg, map: &StabilityMap, panel: &MapPanel, frame: Frame) {
    let mut line = Vec::new();
    let mut lines = Vec::new();
    for (row, limit) in panel.stable_steps.iter().enumerate() {
        let Some(limit) = limit else {
            lines.push(std::mem::take(&mut line));
            continue;
        };
        let x = frame.left + CELL.0 * place(&map.steps, *limit);
        let bottom = frame.bottom() - row as f64 * CELL.1;
        line.extend([(x, bottom), (x, bottom - CELL.1)]);
    }
    lines.push(line);
    // A rim of paper keeps it apart from every colour.
    for stroke in [Stroke::new(Paint::Paper, 4.5), Stroke::new(Paint::Ink, 2.0)] {
        for line in &lines {
            svg.polyline(line, stroke);
        }
    }
}

/// The place of a step among columns that stand for `steps`, in columns from the left edge: a column's
/// middle is its step, between middles the logarithm counts.
fn place(steps: &[f64], dt: f64) -> f64 {
    let columns = steps.len() as f64;
    if dt <= 0.0 {
        return 0.0;
    }
    let after = steps.partition_point(|step| *step <= dt);
    let (low, high) = match after {
        0 => (0, 1),
        after if after == steps.len() => (after.saturating_sub(2), after.saturating_sub(1)),
        after => (after - 1, after),
    };
    let (Some(a), Some(b)) = (steps.get(low), steps.get(high)) else {
        return 0.5 * columns;
    };
    let between = (dt / a).ln() / (b / a).ln();
    (low as f64 + 0.5 + between).clamp(0.0, columns)
}

fn note(map: &StabilityMap, panel: &MapPanel, value: f64, dt: f64, run: &MapRun) -> String {
    let error = run.error.map_or_else(
        || "none".to_owned(),
        |error| format!("{} %", number::percent(error)),
    );
    format!(
        "{}, {} = {}, dt = {} ms: {}, error {error}",
        panel.method,
        map.parameter,
        number::short(value),
        number::milliseconds(dt),
        run.verdict().word(),
    )
}

/// Colours, signs and the line, in one row beneath the panels.
fn draw_legend(svg: &mut Svg, left: f64, top: f64) {
    let bar = Frame {
        left: left + 24.0,
        top: top + 20.0,
        width: 250.0,
        height: 14.0,
    };
    svg.text(&Text::new(
        bar.left,
        top + 8.0,
        "error (relative L2 of the displacement) [%]",
    ));
    let slices = 64;
    for i in 0..slices {
        let colour = viridis((f64::from(slices - 1 - i) + 0.5) / f64::from(slices));
        // Each begins at the left and the next covers it: no seams.
        let width = bar.width * (1.0 - f64::from(i) / f64::from(slices));
        svg.rect(Frame { width, ..bar }, Paint::Data(colour));
    }
    let axis = Axis::log("").range(100.0 * RANGE.0, 100.0 * RANGE.1);
    for tick in axis.fitted(std::iter::empty()).ticks(5) {
        let Some(label) = tick.label else { continue };
        let x = bar.left + tick.at * bar.width;
        svg.line(
            (x, bar.bottom()),
            (x, bar.bottom() + 4.0),
            Stroke::new(Paint::Muted, 1.0),
        );
        let label = match tick.at {
            at if at < 1e-6 => format!("≤ {label}"),
            at if at > 1.0 - 1e-6 => format!("≥ {label}"),
            _ => label,
        };
        svg.text(
            &Text::new(x, bar.bottom() + 13.0, &label)
                .sized(SMALL)
                .anchored(Anchor::Middle),
        );
    }
    let signs = [
        (RowVerdict::Wrong, "worse than returning zero"),
        (RowVerdict::Guarded, "cells saturated"),
        (RowVerdict::Unbounded, "|u| > 10× the reference's"),
        (RowVerdict::Diverged, "diverged, given up"),
    ];
    let mut x = bar.right() + 40.0;
    let y = bar.top + 7.0;
    for (verdict, text) in signs {
        let failed = matches!(verdict, RowVerdict::Unbounded | RowVerdict::Diverged);
        let tint = if failed {
            verdict::tint(verdict)
        } else {
            viridis(1.0)
        };
        let sample = Frame {
            left: x,
            top: y - 9.0,
            width: 20.0,
            height: 18.0,
        };
        svg.rect(sample, Paint::Data(tint));
        let sign = Text::new(x + 10.0, y, verdict.symbol()).anchored(Anchor::Middle);
        svg.text(&sign.painted(Paint::OnTint).bold());
        svg.text(&Text::new(x + 26.0, y, text));
        x += 26.0 + text_width(text, TEXT) + 10.0;
    }
    let y = bar.bottom() + 13.0;
    let x = bar.right() + 40.0;
    let line = Stroke {
        dash: Dash::Solid,
        ..Stroke::new(Paint::Ink, 2.0)
    };
    svg.line((x, y), (x + 20.0, y), line);
    svg.text(&Text::new(
        x + 26.0,
        y,
        "largest stable step by theory, along the edge where it lies outside",
    ));
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_measure::RowOutcome;

    fn run(error: Option<f64>, bounded: bool, guarded: bool) -> MapRun {
        MapRun {
            error,
            outcome: if error.is_some() {
                RowOutcome::Finished
            } else {
                RowOutcome::Diverged
            },
            bounded,
            guarded,
        }
    }

    fn map() -> StabilityMap {
        let panel = |method: &str, stable_steps| MapPanel {
            method: method.into(),
            stable_steps,
            cannot_tell: false,
            runs: vec![
                vec![
                    run(Some(1e-3), true, false),
                    run(Some(0.2), true, false),
                    run(None, false, false),
                ],
                vec![
                    run(Some(0.9), true, true),
                    run(Some(7.0), true, false),
                    run(Some(99.0), false, false),
                ],
            ],
        };
        StabilityMap {
            id: "m".into(),
            title: "A <title>".into(),
            parameter: "rate [1/s]".into(),
            values: vec![1.0, 10.0],
            steps: vec![0.001, 0.01, 0.1],
            panels: vec![
                panel("limited", vec![Some(0.01), Some(0.0)]),
                panel("unlimited", vec![None, None]),
            ],
        }
    }

    #[test]
    fn every_run_is_a_square_with_a_note_and_failures_have_signs() {
        let svg = heat_map(&map());
        let squares = svg.matches("<g><title>").count();
        assert_eq!(squares, 2 * 6);
        // Two panels and the legend.
        for (sign, times) in [(">D<", 3), (">∞<", 3), (">G<", 3), (">✗<", 3), (">✓<", 0)] {
            assert_eq!(svg.matches(sign).count(), times, "{sign}");
        }
        for text in [
            "limited",
            "unlimited",
            "stable at any step",
            "rate [1/s]",
            "step dt [ms]",
            "[%]",
        ] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(svg.contains("A &lt;title&gt;") && !svg.contains("NaN") && !svg.contains("inf"));
        assert!(svg.contains("limited, rate [1/s] = 1, dt = 10 ms: wrong, error 20.0 %"));
    }

    #[test]
    fn the_line_of_theory_is_drawn_where_there_is_one() {
        let lines = |map: &StabilityMap| {
            let svg = heat_map(map);
            svg.matches("stroke-width=\"4.5\"").count()
        };
        assert_eq!(lines(&map()), 1);
        let mut unlimited = map();
        unlimited.panels.remove(0);
        assert_eq!(lines(&unlimited), 0);
        unlimited.panels[0].cannot_tell = true;
        let svg = heat_map(&unlimited);
        assert!(svg.contains("cannot tell its stable step") && !svg.contains("stable at any step"));
    }

    #[test]
    fn a_step_lies_in_its_column() {
        let steps = [0.001, 0.01, 0.1];
        for (dt, expected) in [
            (0.001, 0.5),
            (0.01, 1.5),
            (0.1, 2.5),
            (1.0, 3.0),
            (1e-9, 0.0),
            (0.0, 0.0),
        ] {
            assert!((place(&steps, dt) - expected).abs() < 1e-9, "{dt}");
        }
        let half_way = 0.01 * 10.0_f64.sqrt();
        assert!((place(&steps, half_way) - 2.0).abs() < 1e-9);
    }

    #[test]
    fn colours_tell_errors_apart() {
        assert_eq!(share(1e-6), 0.0);
        assert!((share(0.01) - 0.5).abs() < 1e-12);
        assert_eq!(share(50.0), 1.0);
    }

    #[test]
    fn a_map_of_nothing_is_a_picture() {
        let svg = heat_map(&StabilityMap::default());
        assert!(svg.starts_with("<svg") && !svg.contains("NaN"));
    }
}

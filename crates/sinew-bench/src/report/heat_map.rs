//! Heat maps: error and boundedness over step and a parameter, a panel for each method.

mod legend;
mod look;
mod steps;

use sinew_draw::Colour;
use sinew_draw::axis::Tick;
use sinew_draw::colour_map::viridis;
use sinew_draw::svg::{Anchor, Frame, Paint, Stroke, Svg, Text, text_width};
use sinew_measure::RowVerdict;

use super::{number, verdict};
use crate::results::{MapPanel, MapRun, StabilityMap};
use legend::draw_legend;
use look::{SMALL, TEXT, share};
use steps::Steps;

const MARGIN: f64 = 14.0;
const TITLE: f64 = 15.0;
const HEAD_TEXT: f64 = 13.0;
/// Height of a row.
const ROW: f64 = 22.0;
/// Space that a sign needs on each side of its middle.
const SIGN: f64 = 6.0;
const COLUMNS: usize = 3;
/// Space above a panel for its name, and below it for its axis.
const HEAD: f64 = 40.0;
const FOOT: f64 = 44.0;
const BETWEEN: f64 = 22.0;

/// The map as SVG: colours for errors, signs for runs that failed, a line for the stable step that each method states.
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
            &layout.steps,
            (map, panel),
            layout.frame(index),
            index % COLUMNS == 0,
        );
    }
    draw_legend(&mut svg, MARGIN, layout.legend_top);
    svg.finish()
}

struct Layout {
    gutter: f64,
    steps: Steps,
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
        let steps = Steps::of(map);
        // The texts above a panel must fit there.
        let heads = map.panels.iter().flat_map(|panel| {
            [
                text_width(&panel.method, HEAD_TEXT),
                text_width(theory(panel), SMALL),
            ]
        });
        let panel = (
            heads.fold(steps.width, f64::max),
            map.values.len() as f64 * ROW,
        );
        let top = MARGIN + TITLE + 10.0;
        let rows = map.panels.len().div_ceil(COLUMNS) as f64;
        let columns = map.panels.len().min(COLUMNS) as f64;
        let legend_top = top + rows * (HEAD + panel.1 + FOOT);
        let width =
            MARGIN + columns * (gutter + panel.0) + (columns - 1.0).max(0.0) * BETWEEN + MARGIN;
        Self {
            gutter,
            steps,
            panel,
            top,
            legend_top,
            width: width.max(1180.0),
            height: legend_top + 66.0 + MARGIN,
        }
    }

    fn frame(&self, index: usize) -> Frame {
        let (row, column) = ((index / COLUMNS) as f64, (index % COLUMNS) as f64);
        Frame {
            left: MARGIN + self.gutter + column * (self.gutter + self.panel.0 + BETWEEN),
            top: self.top + HEAD + row * (HEAD + self.panel.1 + FOOT),
            width: self.steps.width,
            height: self.panel.1,
        }
    }
}

fn theory(panel: &MapPanel) -> &'static str {
    let computed = panel.stable_steps.iter().any(Option::is_some);
    match (computed, panel.cannot_tell) {
        (true, false) => "line: largest stable step, computed",
        (true, true) => "line: largest stable step, where it is known",
        (false, false) => "stable at any step",
        (false, true) => "cannot tell its stable step",
    }
}

fn draw_panel(
    svg: &mut Svg,
    steps: &Steps,
    (map, panel): (&StabilityMap, &MapPanel),
    frame: Frame,
    named: bool,
) {
    svg.text(
        &Text::new(frame.left, frame.top - 27.0, &panel.method)
            .sized(HEAD_TEXT)
            .bold(),
    );
    svg.text(
        &Text::new(frame.left, frame.top - 11.0, theory(panel))
            .sized(SMALL)
            .painted(Paint::Muted),
    );
    for (row, (value, runs)) in map.values.iter().zip(&panel.runs).enumerate() {
        // The first value at the bottom, as on an axis.
        let top = frame.bottom() - (row + 1) as f64 * ROW;
        svg.text(
            &Text::new(frame.left - 6.0, top + 0.5 * ROW, &number::short(*value))
                .sized(SMALL)
                .anchored(Anchor::End),
        );
        let limit = panel.stable_steps.get(row).copied().flatten();
        let limit = limit.map(|dt| frame.left + steps.place(dt));
        for ((dt, run), (left, right)) in map.steps.iter().zip(runs).zip(&steps.columns) {
            let cell = Frame {
                left: frame.left + left,
                top,
                width: right - left,
                height: ROW,
            };
            let note = note(map, panel, *value, *dt, run);
            svg.noted(&note, |svg| draw_run(svg, cell, run, limit));
        }
    }
    draw_limit(svg, steps, panel, frame);
    draw_steps(svg, steps, frame);
    if named {
        let middle = frame.top + 0.5 * frame.height;
        let parameter = Text::new(MARGIN + 0.5 * TEXT, middle, &map.parameter);
        svg.text(&parameter.anchored(Anchor::Middle).upward());
    }
}

fn draw_steps(svg: &mut Svg, steps: &Steps, frame: Frame) {
    let tick = frame.bottom();
    let mut free = f64::NEG_INFINITY;
    for Tick { at, label } in steps.axis.ticks(8) {
        let x = frame.left + at * frame.width;
        let long = if label.is_some() { 5.0 } else { 3.0 };
        svg.line((x, tick), (x, tick + long), Stroke::new(Paint::Muted, 1.0));
        let Some(label) = label else { continue };
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

/// A run in its cell; its sign does not overlap the line of the stable step at `limit`.
fn draw_run(svg: &mut Svg, cell: Frame, run: &MapRun, limit: Option<f64>) {
    let (fill, ink) = match (run.verdict(), run.error) {
        (RowVerdict::Unbounded | RowVerdict::Diverged | RowVerdict::Refused, _) | (_, None) => {
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
        let place = (sign_place(cell, limit), cell.top + 0.5 * cell.height);
        let text = Text::new(place.0, place.1, sign)
            .anchored(Anchor::Middle)
            .painted(ink);
        svg.text(&text.sized(SMALL).bold());
    }
}

/// The middle of a cell, or of its larger part if a line would cross the sign.
fn sign_place(cell: Frame, limit: Option<f64>) -> f64 {
    let middle = cell.left + 0.5 * cell.width;
    match limit {
        Some(limit) if (limit - middle).abs() < SIGN && limit > middle => {
            0.5 * (cell.left + limit) - 1.0
        }
        Some(limit) if (limit - middle).abs() < SIGN => 0.5 * (cell.right() + limit) + 1.0,
        _ => middle,
    }
}

/// A sign for facts that colour alone must not show.
fn sign(run: &MapRun) -> &'static str {
    match run.verdict() {
        RowVerdict::Accurate => "",
        RowVerdict::Wrong if run.error.is_some_and(|error| error < 1.0) => "",
        verdict => verdict.symbol(),
    }
}

/// The stable step of each row, joined from row to row; along the edge if it is outside.
fn draw_limit(svg: &mut Svg, steps: &Steps, panel: &MapPanel, frame: Frame) {
    let mut line = Vec::new();
    let mut lines = Vec::new();
    for (row, limit) in panel.stable_steps.iter().enumerate() {
        let Some(limit) = limit else {
            lines.push(std::mem::take(&mut line));
            continue;
        };
        let x = frame.left + steps.place(*limit);
        let bottom = frame.bottom() - row as f64 * ROW;
        line.extend([(x, bottom), (x, bottom - ROW)]);
    }
    lines.push(line);
    // A rim of paper keeps it apart from every colour.
    for stroke in [Stroke::new(Paint::Paper, 4.5), Stroke::new(Paint::Ink, 2.0)] {
        for line in &lines {
            svg.polyline(line, stroke);
        }
    }
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
    fn a_sign_keeps_clear_of_the_line() {
        let cell = Frame {
            left: 100.0,
            top: 0.0,
            width: 24.0,
            height: ROW,
        };
        assert_eq!(sign_place(cell, None), 112.0);
        assert_eq!(sign_place(cell, Some(101.0)), 112.0);
        for limit in [107.0, 111.0, 112.0, 114.0, 117.0] {
            let place = sign_place(cell, Some(limit));
            assert!((place - limit).abs() >= 5.0, "{limit}: {place}");
            assert!((104.0..=120.0).contains(&place), "{limit}: {place}");
        }
    }

    #[test]
    fn a_map_of_nothing_is_a_picture() {
        let svg = heat_map(&StabilityMap::default());
        assert!(svg.starts_with("<svg") && !svg.contains("NaN"));
    }
}

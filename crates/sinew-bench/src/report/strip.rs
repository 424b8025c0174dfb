//! Stability strip: the verdict on every method at every step.

use sinew_draw::Dash;
use sinew_draw::svg::{Anchor, Frame, Paint, Stroke, Svg, Text, text_width};
use sinew_measure::{Row, RowOutcome, RowVerdict};

use super::{missing::shown, number, verdict};
use crate::results::BenchResults;

const MARGIN: f64 = 12.0;
const TITLE: f64 = 15.0;
const TEXT: f64 = 12.0;
const CELL: (f64, f64) = (98.0, 24.0);
const GAP: f64 = 2.0;
const DOES_NOT_SETTLE: &str = "~";

/// Verdicts on the runs of a case as SVG: a row per method, a column per step, and the position of the critical step.
/// Columns are evenly spaced for any steps, so that every cell can show its error and its verdict.
#[must_use]
pub fn strip(results: &BenchResults, case: &str) -> String {
    let rows: Vec<&Row> = results.rows_of(case).collect();
    let strip = Strip::of(&rows);
    let critical = results
        .case(case)
        .and_then(|case| case.critical_step_s)
        .filter(|&dt| dt > 0.0);
    strip.draw(case, critical)
}

struct Strip<'a> {
    labels: Vec<String>,
    dts: Vec<f64>,
    cells: Vec<Cell<'a>>,
}

struct Cell<'a> {
    row: usize,
    column: usize,
    run: &'a Row,
}

impl<'a> Strip<'a> {
    fn of(rows: &[&'a Row]) -> Self {
        let mut dts: Vec<f64> = rows.iter().map(|row| row.dt).collect();
        dts.sort_by(f64::total_cmp);
        dts.dedup();
        let mut labels: Vec<String> = Vec::new();
        let mut cells = Vec::new();
        for run in rows.iter().copied() {
            let label = run.label();
            let row = match labels.iter().position(|l| *l == label) {
                Some(row) => row,
                None => {
                    labels.push(label);
                    labels.len() - 1
                }
            };
            let column = dts.iter().position(|&dt| dt == run.dt).unwrap_or(0);
            cells.push(Cell { row, column, run });
        }
        Self { labels, dts, cells }
    }

    /// Columns whose step is at most `dt`.
    fn up_to(&self, dt: f64) -> usize {
        self.dts.partition_point(|&x| x <= dt)
    }

    fn draw(&self, case: &str, critical: Option<f64>) -> String {
        let gutter = self
            .labels
            .iter()
            .map(|label| text_width(label, TEXT))
            .fold(60.0, f64::max);
        let left = MARGIN + gutter + 10.0;
        let legend = legend();
        let width = (left + self.dts.len() as f64 * CELL.0 + MARGIN).max(560.0);
        let title_end = MARGIN + TITLE + 10.0;
        let note_height = if critical.is_some() { 20.0 } else { 0.0 };
        let heads = title_end + note_height;
        let top = heads + 22.0;
        let bottom = top + self.labels.len() as f64 * CELL.1;
        let legend_rows = flow(&legend, width - 2.0 * MARGIN);
        let height = bottom + 14.0 + legend_rows.len() as f64 * 22.0 + MARGIN;

        let title = format!("{case}: verdict and error by step");
        let mut svg = Svg::new(width, height, &title);
        svg.text(
            &Text::new(MARGIN, MARGIN + 0.6 * TITLE, &title)
                .sized(TITLE)
                .bold(),
        );
        svg.text(
            &Text::new(left - 10.0, heads + 10.0, "dt [ms]")
                .anchored(Anchor::End)
                .painted(Paint::Muted),
        );
        for (i, &dt) in self.dts.iter().enumerate() {
            let x = left + (i as f64 + 0.5) * CELL.0;
            svg.text(
                &Text::new(x, heads + 10.0, &number::milliseconds(dt))
                    .anchored(Anchor::Middle)
                    .bold(),
            );
        }
        for (i, label) in self.labels.iter().enumerate() {
            let y = top + (i as f64 + 0.5) * CELL.1;
            svg.text(&Text::new(left - 10.0, y, label).anchored(Anchor::End));
        }
        for cell in &self.cells {
            let frame = Frame {
                left: left + cell.column as f64 * CELL.0 + 0.5 * GAP,
                top: top + cell.row as f64 * CELL.1 + 0.5 * GAP,
                width: CELL.0 - GAP,
                height: CELL.1 - GAP,
            };
            svg.noted(&note(cell.run), |svg| draw_cell(svg, frame, cell.run));
        }
        if let Some(dt) = critical {
            let x = left + self.up_to(dt) as f64 * CELL.0;
            self.draw_critical(&mut svg, dt, x, (title_end, bottom), width);
        }
        let mut y = bottom + 14.0 + 11.0;
        for row in legend_rows {
            let mut x = MARGIN;
            for entry in row {
                entry.draw(&mut svg, x, y);
                x += entry.width();
            }
            y += 22.0;
        }
        svg.finish()
    }

    /// Separates the steps up to the critical one from those beyond it.
    fn draw_critical(&self, svg: &mut Svg, dt: f64, x: f64, (top, bottom): (f64, f64), width: f64) {
        let label = format!("critical step 2/ω = {} ms", number::milliseconds(dt));
        let half = 0.5 * text_width(&label, TEXT);
        let middle = x.clamp(MARGIN + half, (width - MARGIN - half).max(MARGIN + half));
        svg.text(
            &Text::new(middle, top + 7.0, &label)
                .anchored(Anchor::Middle)
                .painted(Paint::Muted),
        );
        let stroke = Stroke {
            dash: Dash::Dashed,
            ..Stroke::new(Paint::Ink, 1.5)
        };
        svg.line((x, top + 16.0), (x, bottom), stroke);
    }
}

fn note(run: &Row) -> String {
    let settles = if run.settles {
        "settles"
    } else {
        "does not settle"
    };
    format!(
        "{}, dt = {} ms: {}, {settles}, error {}, saturated {} %",
        run.label(),
        number::milliseconds(run.dt),
        run.verdict().word(),
        verdict::error_with_unit(run),
        shown(run.saturated, number::percent),
    )
}

fn draw_cell(svg: &mut Svg, frame: Frame, run: &Row) {
    let verdict = run.verdict();
    svg.rect(frame, Paint::Data(verdict::tint(verdict)));
    let y = frame.top + 0.5 * frame.height;
    let restless = run.outcome == RowOutcome::Finished && run.bounded && !run.settles;
    let symbol = if restless {
        format!("{}{DOES_NOT_SETTLE}", verdict.symbol())
    } else {
        verdict.symbol().to_owned()
    };
    svg.text(
        &Text::new(frame.left + 6.0, y, &symbol)
            .painted(Paint::OnTint)
            .bold(),
    );
    // The symbol already says "unbounded", "diverged" and "refused".
    let text = match (run.outcome, run.error, run.diverged_at_s) {
        (RowOutcome::Finished, Some(_), _) if run.error_is_below.is_some() => {
            format!("{} %", run.error_in_percent().unwrap_or_default())
        }
        (RowOutcome::Finished, Some(error), _) => {
            shown(100.0 * error, |x| format!("{} %", number::three(x)))
        }
        (RowOutcome::Finished, None, _) => "n/a".to_owned(),
        (RowOutcome::Diverged | RowOutcome::Refused, _, Some(t)) => {
            format!("at {} s", number::short(t))
        }
        _ => String::new(),
    };
    svg.text(
        &Text::new(frame.right() - 6.0, y, &text)
            .sized(11.0)
            .anchored(Anchor::End)
            .painted(Paint::OnTint),
    );
}

struct Entry {
    verdict: Option<RowVerdict>,
    symbol: &'static str,
    text: String,
}

impl Entry {
    fn width(&self) -> f64 {
        30.0 + text_width(&self.text, TEXT) + 12.0
    }

    fn draw(&self, svg: &mut Svg, x: f64, y: f64) {
        let paint = match self.verdict {
            Some(verdict) => {
                let frame = Frame {
                    left: x,
                    top: y - 8.0,
                    width: 22.0,
                    height: 16.0,
                };
                svg.rect(frame, Paint::Data(verdict::tint(verdict)));
                Paint::OnTint
            }
            None => Paint::Ink,
        };
        svg.text(
            &Text::new(x + 11.0, y, self.symbol)
                .anchored(Anchor::Middle)
                .painted(paint)
                .bold(),
        );
        svg.text(&Text::new(x + 28.0, y, &self.text));
    }
}

fn legend() -> Vec<Entry> {
    let verdicts = RowVerdict::ALL.into_iter().map(|verdict| Entry {
        verdict: Some(verdict),
        symbol: verdict.symbol(),
        text: format!("{}: {}", verdict.word(), verdict::meaning(verdict)),
    });
    verdicts
        .chain([Entry {
            verdict: None,
            symbol: DOES_NOT_SETTLE,
            text: "does not settle".to_owned(),
        }])
        .collect()
}

/// Entries in rows no wider than `width`.
fn flow(entries: &[Entry], width: f64) -> Vec<Vec<&Entry>> {
    let mut rows: Vec<Vec<&Entry>> = vec![Vec::new()];
    let mut used = 0.0;
    for entry in entries {
        if used + entry.width() > width && used > 0.0 {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += entry.width();
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_verify::Machine;

    #[test]
    fn the_critical_step_parts_the_columns() {
        let rows: Vec<Row> = [0.01, 0.001, 0.1]
            .map(|dt| Row {
                dt,
                ..Row::default()
            })
            .into();
        let strip = Strip::of(&rows.iter().collect::<Vec<_>>());
        let parted = [1e-9, 0.001, 0.03, 1.0].map(|dt| strip.up_to(dt));
        assert_eq!(parted, [0, 1, 2, 3]);
    }

    #[test]
    fn every_verdict_has_its_symbol() {
        let mut results = BenchResults::new("r", Machine::default());
        results.rows = vec![Row {
            case: "<a>".into(),
            integrator: "cnn".into(),
            dt: 0.02,
            bounded: true,
            saturated: 0.5,
            error: Some(25.2),
            ..Row::default()
        }];
        let svg = strip(&results, "<a>");
        assert!(svg.contains(">G~<") && svg.contains(">2520 %<"));
        assert!(svg.contains("&lt;a&gt;") && !svg.contains("<a>"));
        for verdict in RowVerdict::ALL {
            assert!(svg.contains(verdict.word()));
            assert!(
                svg.contains(&format!(">{}<", verdict.symbol())),
                "{verdict:?}"
            );
        }
    }
}

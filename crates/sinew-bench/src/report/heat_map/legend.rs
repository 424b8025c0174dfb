//! The legend below the panels.

use sinew_draw::colour_map::viridis;
use sinew_draw::svg::{Anchor, Frame, Paint, Stroke, Svg, Text, text_width};
use sinew_draw::{Axis, Dash};
use sinew_measure::RowVerdict;

use super::look::{RANGE, SMALL, TEXT};
use crate::report::verdict;

/// Colours, signs and the line, in one row below the panels.
pub(super) fn draw_legend(svg: &mut Svg, left: f64, top: f64) {
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
        (RowVerdict::Guarded, "cells saturated, coloured by error"),
        (RowVerdict::Unbounded, "|u| > 10× the reference's"),
        (RowVerdict::Diverged, "diverged, given up"),
    ];
    let mut x = bar.right() + 40.0;
    let y = bar.top + 7.0;
    for (verdict, text) in signs {
        let sample = Frame {
            left: x,
            top: y - 9.0,
            width: 20.0,
            height: 18.0,
        };
        // Only failures have a colour of their own; other signs are drawn on that of their error.
        let ink = match verdict {
            RowVerdict::Unbounded | RowVerdict::Diverged | RowVerdict::Refused => {
                svg.rect(sample, Paint::Data(verdict::tint(verdict)));
                Paint::OnTint
            }
            RowVerdict::Wrong => {
                svg.rect(sample, Paint::Data(viridis(1.0)));
                Paint::OnTint
            }
            RowVerdict::Guarded | RowVerdict::Accurate => Paint::Ink,
        };
        let sign = Text::new(x + 10.0, y, verdict.symbol()).anchored(Anchor::Middle);
        svg.text(&sign.painted(ink).bold());
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

//! Axes, their ticks, lanes and rules.

use super::Plot;
use super::layout::{LABEL, LANE, Layout, MARGIN, TICK};
use crate::style::Dash;
use crate::svg::{Anchor, Frame, Paint, Stroke, Svg, Text};

impl Layout {
    pub(super) fn axes(&self, svg: &mut Svg, plot: &Plot) {
        let Frame {
            left, top, height, ..
        } = self.frame;
        let (right, bottom) = (self.frame.right(), self.frame.bottom());
        let base = self.base();
        for tick in &self.x_ticks {
            let x = self.px_x(tick.at);
            let width = if tick.label.is_some() { 1.0 } else { 0.4 };
            svg.line((x, top), (x, base), Stroke::new(Paint::Grid, width));
            if let Some(label) = &tick.label {
                svg.line((x, base), (x, base + 4.0), Stroke::new(Paint::Muted, 1.0));
                svg.text(
                    &Text::new(x, base + 14.0, label)
                        .sized(TICK)
                        .anchored(Anchor::Middle),
                );
            }
        }
        for tick in &self.y_ticks {
            let y = self.px_y(tick.at);
            let width = if tick.label.is_some() { 1.0 } else { 0.4 };
            svg.line((left, y), (right, y), Stroke::new(Paint::Grid, width));
            if let Some(label) = &tick.label {
                svg.line((left - 4.0, y), (left, y), Stroke::new(Paint::Muted, 1.0));
                svg.text(
                    &Text::new(left - 8.0, y, label)
                        .sized(TICK)
                        .anchored(Anchor::End),
                );
            }
        }
        svg.polyline(
            &[(left, top), (left, bottom), (right, bottom)],
            Stroke::new(Paint::Muted, 1.0),
        );
        for (middle, name) in [
            (self.above, &plot.lane_above),
            (self.below, &plot.lane_below),
        ] {
            if let (Some(middle), Some(name)) = (middle, name) {
                self.lane(svg, middle, name);
            }
        }
        svg.text(
            &Text::new(
                left + 0.5 * self.frame.width,
                base + 24.0 + LABEL,
                &plot.x.label,
            )
            .sized(LABEL)
            .anchored(Anchor::Middle),
        );
        svg.text(
            &Text::new(MARGIN + 0.5 * LABEL, top + 0.5 * height, &plot.y.label)
                .sized(LABEL)
                .anchored(Anchor::Middle)
                .upward(),
        );
    }

    fn lane(&self, svg: &mut Svg, middle: f64, name: &str) {
        let (left, right) = (self.frame.left, self.frame.right());
        let (above, below) = (middle - 0.5 * LANE, middle + 0.5 * LANE);
        for edge in [above, below] {
            svg.line((left, edge), (right, edge), Stroke::new(Paint::Grid, 1.0));
        }
        svg.line((left, above), (left, below), Stroke::new(Paint::Muted, 1.0));
        svg.text(
            &Text::new(left - 8.0, middle, name)
                .sized(TICK)
                .anchored(Anchor::End),
        );
    }

    pub(super) fn rules(&self, svg: &mut Svg, plot: &Plot) {
        let stroke = Stroke {
            dash: Dash::Dashed,
            ..Stroke::new(Paint::Muted, 1.25)
        };
        for (rule, &(text_x, text_y)) in plot.vertical_rules.iter().zip(&self.rule_labels) {
            let share = self.x.share(rule.at);
            if !(0.0..=1.0).contains(&share) {
                continue;
            }
            let x = self.px_x(share);
            svg.line((x, text_y + 8.0), (x, self.base()), stroke);
            svg.text(
                &Text::new(text_x, text_y, &rule.label)
                    .sized(TICK)
                    .anchored(Anchor::Middle)
                    .painted(Paint::Muted),
            );
        }
        for rule in &plot.horizontal_rules {
            let share = self.y.share(rule.at);
            if !(0.0..=1.0).contains(&share) {
                continue;
            }
            let y = self.px_y(share);
            svg.line((self.frame.left, y), (self.frame.right(), y), stroke);
            let lines = rule.label.lines().count() as f64;
            for (i, line) in rule.label.lines().enumerate() {
                let down = (i as f64 - 0.5 * (lines - 1.0)) * 1.2 * TICK;
                svg.text(
                    &Text::new(self.frame.right() + 6.0, y + down, line)
                        .sized(TICK)
                        .painted(Paint::Muted),
                );
            }
        }
    }
}

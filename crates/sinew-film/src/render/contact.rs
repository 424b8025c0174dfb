//! Darkening of the floor beneath objects: less light of the sky reaches it.

use super::model::Model;
use super::shadow::spread_over;

/// Cells along an edge of the map.
const EDGE: usize = 128;

/// Half the width of the map, in units of the body's radius.
const REACH: f32 = 2.2;

/// Number of cells by which the dark area is spread to each side, twice.
const SPREAD: usize = 4;

/// The height above the floor at which an object darkens it by a third.
const HEIGHT: f32 = 0.22;

/// The hidden share of the sky, for each part of the floor.
pub(super) struct Contact {
    hidden: Vec<f32>,
}

impl Contact {
    /// The darkening beneath a model on a floor at this height.
    pub(super) fn of(model: &Model, floor: f32) -> Self {
        let mut lowest = vec![f32::MAX; EDGE * EDGE];
        let cells = EDGE as f32 / (2.0 * REACH);
        for (corners, _) in &model.triangles {
            let corners = corners.map(|corner| {
                let [x, y, z] = model.vertices[corner as usize].place;
                [(x + REACH) * cells, (y + REACH) * cells, z - floor]
            });
            spread_over(corners, EDGE, |place, height| {
                lowest[place] = lowest[place].min(height.max(0.0));
            });
        }
        let hidden = lowest.into_iter().map(|height| (-height / HEIGHT).exp());
        let mut hidden: Vec<f32> = hidden.collect();
        for _ in 0..2 {
            hidden = smoothed(&hidden);
        }
        Self { hidden }
    }

    /// The share of the sky that is hidden from the floor at a position.
    pub(super) fn at(&self, x: f32, y: f32) -> f32 {
        let cells = EDGE as f32 / (2.0 * REACH);
        let [x, y] = [x, y].map(|along| (along + REACH) * cells - 0.5);
        let last = (EDGE - 1) as f32;
        if !(x >= 0.0 && y >= 0.0 && x < last && y < last) {
            return 0.0;
        }
        let (column, row) = (x as i32 as usize, y as i32 as usize);
        let [along, down] = [x - column as f32, y - row as f32];
        let value = |place: usize| self.hidden[place];
        let first = row * EDGE + column;
        let upper = value(first) + along * (value(first + 1) - value(first));
        let below = first + EDGE;
        let lower = value(below) + along * (value(below + 1) - value(below));
        upper + down * (lower - upper)
    }
}

/// Means over squares of neighbours.
fn smoothed(values: &[f32]) -> Vec<f32> {
    let mean = |values: &[f32], place: usize, stride: usize| {
        let at = (place / stride) % EDGE;
        let around = at.saturating_sub(SPREAD)..(at + SPREAD + 1).min(EDGE);
        let first = place - at * stride;
        let sum: f32 = around.map(|at| values[first + at * stride]).sum();
        sum / (2 * SPREAD + 1) as f32
    };
    let rows: Vec<f32> = (0..values.len())
        .map(|place| mean(values, place, 1))
        .collect();
    (0..rows.len())
        .map(|place| mean(&rows, place, EDGE))
        .collect()
}

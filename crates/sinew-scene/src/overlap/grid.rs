//! A uniform grid of boxes, hashed, so that it is unbounded.

use sinew_tools::vector::Vector;

/// Low and high corner (m) of an axis-aligned box.
pub(super) type Bounds = [Vector; 2];

/// Entries for each box beyond which cells are made larger: a few long boxes among small ones fill many cells.
const ENTRIES: usize = 16;

/// The bounds of some points, wider by a margin `room` on all sides.
pub(super) fn bounds(points: &[Vector], room: f64) -> Bounds {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for point in points {
        include(&mut bounds, point);
    }
    [
        bounds[0].map(|low| low - room),
        bounds[1].map(|high| high + room),
    ]
}

/// Widens bounds so that a point is in them.
pub(super) fn include([low, high]: &mut Bounds, point: &Vector) {
    for axis in 0..3 {
        low[axis] = low[axis].min(point[axis]);
        high[axis] = high[axis].max(point[axis]);
    }
}

/// True if two boxes have a point in common.
pub(super) fn meet(one: &Bounds, other: &Bounds) -> bool {
    (0..3).all(|axis| one[0][axis] <= other[1][axis] && other[0][axis] <= one[1][axis])
}

/// The largest edge (m) of a box.
pub(super) fn longest([low, high]: &Bounds) -> f64 {
    (0..3).fold(0.0, |most: f64, axis| most.max(high[axis] - low[axis]))
}

/// A cell by its index along each axis.
type Cell = [i64; 3];

/// Boxes by the cells of a grid that they overlap (Teschner and others, Optimized spatial hashing, VMV 2003).
#[derive(Debug, Default)]
pub(super) struct Grid {
    /// Cells in a metre.
    cells: f64,
    /// The lowest and the highest cell of each box.
    spans: Vec<[Cell; 2]>,
    /// The first entry of each bucket, and the end.
    starts: Vec<u32>,
    /// Boxes by their places, bucket by bucket.
    entries: Vec<u32>,
}

impl Grid {
    /// Puts boxes into cells of about this edge (m).
    pub(super) fn fill(&mut self, boxes: &[Bounds], edge: f64) {
        self.cells = 1.0 / edge.max(1e-300);
        loop {
            let mut spans = std::mem::take(&mut self.spans);
            spans.clear();
            spans.extend(boxes.iter().map(|of| self.span(of)));
            self.spans = spans;
            let entries: f64 = self.spans.iter().map(count).sum();
            if entries <= (ENTRIES * boxes.len()) as f64 {
                break;
            }
            self.cells /= 1.5;
        }
        let buckets = (2 * boxes.len()).next_power_of_two();
        self.starts.clear();
        self.starts.resize(buckets + 1, 0);
        for span in &self.spans {
            each_cell(span, |cell| self.starts[hash(cell, buckets) + 1] += 1);
        }
        for bucket in 0..buckets {
            self.starts[bucket + 1] += self.starts[bucket];
        }
        self.entries.clear();
        self.entries.resize(self.starts[buckets] as usize, 0);
        for (number, span) in (0..).zip(&self.spans) {
            each_cell(span, |cell| {
                let start = &mut self.starts[hash(cell, buckets)];
                self.entries[*start as usize] = number;
                *start += 1;
            });
        }
        // Each start points to the beginning of the next bucket.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Calls `take` with the index of each box that meets this one among `boxes`, with which the grid was filled;
    /// rarely twice. Returns the number of comparisons.
    pub(super) fn visit(&self, of: &Bounds, boxes: &[Bounds], mut take: impl FnMut(u32)) -> usize {
        let span = self.span(of);
        if count(&span) > boxes.len() as f64 {
            let all = (0..).zip(boxes);
            all.filter(|(_, other)| meet(of, other))
                .for_each(|(number, _)| take(number));
            return boxes.len();
        }
        let buckets = self.starts.len() - 1;
        let mut compared = 0;
        each_cell(&span, |cell| {
            let bucket = hash(cell, buckets);
            let entries = self.starts[bucket] as usize..self.starts[bucket + 1] as usize;
            compared += entries.len();
            for number in &self.entries[entries] {
                // Of all cells that both are in the lowest counts.
                let [low, _] = &self.spans[*number as usize];
                let is_home = (0..3).all(|axis| cell[axis] == span[0][axis].max(low[axis]));
                if is_home && meet(of, &boxes[*number as usize]) {
                    take(*number);
                }
            }
        });
        compared
    }

    /// The cells that a box overlaps.
    fn span(&self, of: &Bounds) -> [Cell; 2] {
        of.map(|corner| {
            corner.map(|along| {
                let along = along * self.cells;
                let towards_0 = along as i64;
                towards_0.saturating_sub(i64::from(towards_0 as f64 > along))
            })
        })
    }
}

/// Number of cells from one to another.
fn count([low, high]: &[Cell; 2]) -> f64 {
    let along = |axis: usize| high[axis].saturating_sub(low[axis]) as f64 + 1.0;
    along(0) * along(1) * along(2)
}

fn each_cell([low, high]: &[Cell; 2], mut take: impl FnMut(Cell)) {
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                take([x, y, z]);
            }
        }
    }
}

/// The bucket of a cell; the number of buckets is a power of two.
fn hash([x, y, z]: Cell, buckets: usize) -> usize {
    let mixed =
        x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791);
    (mixed as usize) & (buckets - 1)
}

#[cfg(test)]
mod tests {
    use super::super::random;
    use super::*;

    #[test]
    fn boxes_that_meet_are_visited_whatever_their_sizes_and_places() {
        let mut random = random(1);
        for scale in [1e-4, 1.0, 1e3] {
            let mut boxes: Vec<Bounds> = Vec::new();
            for number in 0..300 {
                let low = [0; 3].map(|_| scale * (random() - 0.5));
                let size = if number % 50 == 0 { 1.0 } else { 0.05 };
                boxes.push([low, low.map(|along| along + scale * size * random())]);
            }
            let mut grid = Grid::default();
            grid.fill(&boxes, 0.05 * scale);
            for of in &boxes {
                let mut found = Vec::new();
                grid.visit(of, &boxes, |number| found.push(number));
                found.sort_unstable();
                found.dedup();
                let all = (0..).zip(&boxes).filter(|(_, other)| meet(of, other));
                let all: Vec<u32> = all.map(|(number, _)| number).collect();
                assert_eq!(found, all);
            }
        }
    }
}

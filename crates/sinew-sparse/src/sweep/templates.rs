//! Cells on a lattice, and the templates that their rows repeat.

use std::collections::HashMap;

use super::lattice::{Lattice, Run};
use super::rounding::{Units, round_row};
use super::{CHUNK, Numbering};
use crate::BlockMatrix;
use crate::simd::Real;

/// Largest distance of a cell from its place, as a share of the spacing.
const OFF_PLACE: f64 = 1e-4;

/// Largest number of places for each cell: vectors also have space for empty ones.
const MOST_PLACES: f64 = 12.0;

/// Difference between entries that counts as rounding of the same template, as a share of the largest
/// entry of the row: coordinates of cells are rounded.
const SAME: f64 = 1e-13;

/// The difference between entries of a row that counts as rounding. A power of two, so that rows that are equal up to
/// rounding have the same value.
fn same<'a>(entries: impl Iterator<Item = &'a f64>) -> f64 {
    let largest = entries.fold(0.0, |most: f64, entry| entry.abs().max(most));
    match largest > 0.0 {
        true => SAME * largest.log2().ceil().exp2(),
        false => 0.0,
    }
}

/// Smallest mean number of cells for each template: with fewer, there is little repetition.
const FEWEST_CELLS: usize = 8;

/// Number of templates into which others are merged.
const MERGED_INTO: usize = 32;

/// Places of cells on a lattice: one position more than there are cells along each line, and one line more in each
/// plane, so that every position outside a body's sides is empty.
#[derive(Clone, Debug)]
pub struct Grid {
    numbering: Numbering,
    /// Distance between lines and between planes (positions).
    pitch: [usize; 2],
    /// Cells along each axis, from its first to its last.
    extent: [usize; 3],
    place: Vec<[i32; 3]>,
}

impl Grid {
    /// The lattice of cells at these points, for kernels with `lanes` lanes; `None` if they are not on a lattice, or
    /// too far apart.
    #[must_use]
    pub fn find(points: &[[f64; 3]], lanes: usize) -> Option<Self> {
        let axes = [0, 1, 2].map(|axis| places(points, axis));
        let [Some(x), Some(y), Some(z)] = axes else {
            return None;
        };
        let extent = [&x, &y, &z].map(|axis| 1 + axis.iter().max().copied().unwrap_or(0) as usize);
        let pitch_of_lines = extent[0] + 1;
        let pitch_of_planes = pitch_of_lines.checked_mul(extent[1] + 1)?;
        let positions = pitch_of_planes.checked_mul(extent[2])?;
        if positions as f64 > MOST_PLACES * points.len() as f64 + 64.0 {
            return None;
        }
        let positions = positions.next_multiple_of(lanes);
        if positions > i32::MAX as usize {
            return None;
        }
        let place: Vec<[i32; 3]> = (0..points.len()).map(|i| [x[i], y[i], z[i]]).collect();
        let at = |[x, y, z]: &[i32; 3]| {
            *x as u32 + *y as u32 * pitch_of_lines as u32 + *z as u32 * pitch_of_planes as u32
        };
        let position: Vec<u32> = place.iter().map(at).collect();
        let mut taken = vec![false; positions];
        if position
            .iter()
            .any(|position| std::mem::replace(&mut taken[*position as usize], true))
        {
            return None;
        }
        Some(Self {
            numbering: Numbering::at(position, positions),
            pitch: [pitch_of_lines, pitch_of_planes],
            extent,
            place,
        })
    }

    /// The cells' positions.
    #[must_use]
    pub fn numbering(&self) -> &Numbering {
        &self.numbering
    }

    /// Distance (positions) to the farthest neighbour of a cell.
    #[must_use]
    pub fn reach(&self) -> usize {
        self.pitch[1] + self.pitch[0] + 1
    }

    /// Cells along each axis.
    #[must_use]
    pub fn extent(&self) -> [usize; 3] {
        self.extent
    }

    /// Distance between neighbours on the lattice; `None` if they are not next to each other.
    fn offset(&self, cell: usize, neighbour: usize) -> Option<i32> {
        let (from, to) = (self.place[cell], self.place[neighbour]);
        let step = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let near = step.iter().all(|step| step.abs() <= 1);
        let pitch = self.pitch.map(|pitch| pitch as i32);
        near.then_some(step[0] + step[1] * pitch[0] + step[2] * pitch[1])
    }

    fn is_empty(&self, position: i64) -> bool {
        let position = usize::try_from(position).ok();
        let inside = position.filter(|position| *position < self.numbering.positions());
        inside.is_none_or(|position| self.numbering.cell(position).is_none())
    }
}

/// Index of each point along an axis, in equal steps from the first; `None` if the steps are not equal.
fn places(points: &[[f64; 3]], axis: usize) -> Option<Vec<i32>> {
    let mut sorted: Vec<f64> = points.iter().map(|point| point[axis]).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (first, last) = (*sorted.first()?, *sorted.last()?);
    let extent = last - first;
    if !extent.is_finite() {
        return None;
    }
    if extent == 0.0 {
        return Some(vec![0; points.len()]);
    }
    let gaps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let spacing = gaps
        .filter(|gap| *gap > 1e-6 * extent)
        .fold(extent, f64::min);
    // Of many rounded gaps the smallest is a little too small; the whole extent says it better.
    let spacing = extent / (extent / spacing).round();
    let place = |point: &[f64; 3]| {
        let steps = (point[axis] - first) / spacing;
        let near = steps.round();
        ((steps - near).abs() <= OFF_PLACE).then_some(near as i32)
    };
    points.iter().map(place).collect()
}

/// Rows whose numbers differ only by rounding.
struct Template {
    offsets: Vec<i32>,
    /// Unit of each block's entries, see [`units`].
    units: Vec<f64>,
    blocks: Vec<f64>,
    rows: usize,
}

impl<T: Real> Lattice<T> {
    /// The rows of a matrix on a lattice; `None` if too few repeat, or if a cell's neighbours are
    /// not next to it.
    #[must_use]
    pub fn new(matrix: &BlockMatrix, grid: &Grid) -> Option<Self> {
        let (templates, mut of_cell) = find(matrix, &Units::of::<T>(matrix), grid)?;
        merge(&templates, grid, &mut of_cell);
        let used = number_used(templates.len(), &mut of_cell);
        let layers = matrix.layers().count();
        let mut lattice = Self {
            layers,
            positions: grid.numbering().positions(),
            reach: grid.reach(),
            starts: vec![0],
            offsets: Vec::new(),
            blocks: Vec::new(),
            first_run: vec![0],
            runs: Vec::new(),
        };
        for template in used {
            let Template {
                offsets,
                units,
                blocks,
                ..
            } = &templates[template];
            lattice.offsets.extend(offsets);
            let entries = layers * layers;
            let first = lattice.blocks.len();
            lattice.blocks.resize(first + blocks.len(), T::default());
            let own = offsets.partition_point(|offset| *offset < 0);
            let row = blocks.chunks_exact(entries).zip(units.iter().copied());
            round_row(row, own, layers, |block, entry, value| {
                lattice.blocks[first + block * entries + entry] = value;
            });
            lattice.starts.push(lattice.offsets.len() as u32);
        }
        lattice.add_runs(grid, &of_cell);
        Some(lattice)
    }

    /// Runs of equal templates, chunk by chunk. Positions without a cell may belong to any.
    fn add_runs(&mut self, grid: &Grid, of_cell: &[u32]) {
        let numbering = grid.numbering();
        let chunk = CHUNK * T::LANES;
        for from in (0..numbering.positions()).step_by(chunk) {
            let to = (from + chunk).min(numbering.positions());
            // Template, first and last position.
            let mut open: Option<(u32, usize, usize)> = None;
            for position in from..to {
                let Some(cell) = numbering.cell(position) else {
                    continue;
                };
                let template = of_cell[cell as usize];
                open = match open {
                    Some((same, first, last))
                        if same == template && position - last <= T::LANES =>
                    {
                        Some((same, first, position))
                    }
                    _ => {
                        self.close(open);
                        Some((template, position, position))
                    }
                };
            }
            self.close(open);
            self.first_run.push(self.runs.len() as u32);
        }
    }

    fn close(&mut self, run: Option<(u32, usize, usize)>) {
        if let Some((template, first, last)) = run {
            self.runs.push(Run {
                template,
                first: first as u32,
                vectors: (last + 1 - first).div_ceil(T::LANES) as u32,
            });
        }
    }
}

/// A sum of entries with weights from 0 to 1 without any symmetry of a row: plain sums of rows of K are all 0.
fn fingerprint<'a>(entries: impl Iterator<Item = &'a f64>) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let weights = (1..).map(|number| (f64::from(number) * GOLDEN).fract());
    entries
        .zip(weights)
        .map(|(entry, weight)| weight * entry)
        .sum()
}

/// The templates of all rows, and the template of each cell.
fn find(matrix: &BlockMatrix, units: &Units, grid: &Grid) -> Option<(Vec<Template>, Vec<u32>)> {
    let cells = matrix.pattern().cells();
    let layers = matrix.layers().count();
    let mut templates: Vec<Template> = Vec::new();
    let mut of_cell = Vec::with_capacity(cells);
    // Templates by their offsets and a fingerprint of their entries, which rounding may move to the next number.
    let mut known: HashMap<(Vec<i32>, i64), Vec<u32>> = HashMap::new();
    let mut row: Vec<(i32, &[f64], f64)> = Vec::new();
    let mut key = (Vec::new(), 0);
    for cell in 0..cells {
        row.clear();
        for (column, block) in matrix.row_blocks(cell) {
            row.push((
                grid.offset(cell, column)?,
                block,
                units.between(cell, column),
            ));
        }
        row.sort_unstable_by_key(|(offset, ..)| *offset);
        let same = same(row.iter().flat_map(|(_, block, _)| block.iter()));
        let sum = fingerprint(row.iter().flat_map(|(_, block, _)| block.iter()));
        let entries = row.len() * layers * layers;
        let width = 4.0 * same * entries as f64;
        let step = if width > 0.0 {
            (sum / width).floor() as i64
        } else {
            0
        };
        key.0.clear();
        key.0.extend(row.iter().map(|(offset, ..)| *offset));
        let mut found = None;
        for near in [step, step - 1, step + 1] {
            key.1 = near;
            let like = |number: &&u32| {
                let template = &templates[**number as usize];
                let units = row.iter().map(|(.., unit)| unit);
                let entries = row.iter().flat_map(|(_, block, _)| block.iter());
                let mut pairs = entries.zip(&template.blocks);
                units.eq(&template.units) && pairs.all(|(a, b)| (a - b).abs() <= same)
            };
            found = known
                .get(&key)
                .and_then(|numbers| numbers.iter().find(like));
            if found.is_some() {
                break;
            }
        }
        let number = match found {
            Some(number) => *number,
            None => {
                let number = templates.len() as u32;
                if templates.len() * FEWEST_CELLS > cells.max(64 * FEWEST_CELLS) {
                    return None;
                }
                key.1 = step;
                known.entry(key.clone()).or_default().push(number);
                templates.push(Template {
                    offsets: key.0.clone(),
                    units: row.iter().map(|(.., unit)| *unit).collect(),
                    blocks: row
                        .iter()
                        .flat_map(|(_, block, _)| block.iter().copied())
                        .collect(),
                    rows: 0,
                });
                number
            }
        };
        templates[number as usize].rows += 1;
        of_cell.push(number);
    }
    Some((templates, of_cell))
}

/// Gives a row that lacks neighbours the template of rows that have them, if the missing positions are empty and add
/// nothing: this concerns rows next to fixed cells.
fn merge(templates: &[Template], grid: &Grid, of_cell: &mut [u32]) {
    let mut frequent: Vec<usize> = (0..templates.len()).collect();
    frequent.sort_by_key(|number| std::cmp::Reverse(templates[*number].rows));
    frequent.truncate(MERGED_INTO);
    // The larger templates of each, with the neighbours that they have more.
    let larger: Vec<Vec<(usize, Vec<i32>)>> = templates
        .iter()
        .map(|small| {
            let larger = frequent.iter();
            let larger = larger.filter_map(|number| {
                let more = templates[*number].more_than(small)?;
                Some((*number, more))
            });
            larger.collect()
        })
        .collect();
    for (cell, number) in of_cell.iter_mut().enumerate() {
        let position = grid.numbering().position(cell as u32) as i64;
        let fits = |(_, more): &&(usize, Vec<i32>)| {
            let mut more = more.iter();
            more.all(|offset| grid.is_empty(position + i64::from(*offset)))
        };
        if let Some((larger, _)) = larger[*number as usize].iter().find(fits) {
            *number = *larger as u32;
        }
    }
}

impl Template {
    /// Offset and unit of each block, with its entries.
    fn places(&self) -> impl Iterator<Item = ((i32, f64), &[f64])> {
        let len = self.blocks.len() / self.offsets.len();
        let places = self.offsets.iter().copied().zip(self.units.iter().copied());
        places.zip(self.blocks.chunks_exact(len))
    }

    /// The offsets that only this template has and not `small`; `None` if anything else differs.
    fn more_than(&self, small: &Self) -> Option<Vec<i32>> {
        if self.offsets.len() <= small.offsets.len() {
            return None;
        }
        let same = same(self.blocks.iter());
        let mut more = Vec::new();
        let mut blocks = small.places().peekable();
        for (place, block) in self.places() {
            match blocks.next_if(|(of_small, _)| of_small.0 == place.0) {
                Some((of_small, entries)) => {
                    let mut pairs = block.iter().zip(entries);
                    if of_small.1 != place.1 || !pairs.all(|(a, b)| (a - b).abs() <= same) {
                        return None;
                    }
                }
                None => more.push(place.0),
            }
        }
        blocks.peek().is_none().then_some(more)
    }
}

/// The templates that are used, renumbered in `of_cell`.
fn number_used(templates: usize, of_cell: &mut [u32]) -> Vec<usize> {
    let mut number = vec![u32::MAX; templates];
    let mut used = Vec::new();
    for template in of_cell {
        let new = &mut number[*template as usize];
        if *new == u32::MAX {
            *new = used.len() as u32;
            used.push(*template as usize);
        }
        *template = *new;
    }
    used
}

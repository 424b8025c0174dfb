//! Added inertia without effect on rigid motions.

use std::ops::Range;

use sinew_core::FreePart;

use super::factor::Factor;
use super::{LAYERS, MOST, RigidMotions};

/// `P = M' + S - S R (R'S R)^-1 R'S`: the inertia M' plus the stiffness terms of a step, one block S for each cell,
/// without their effect on the rigid motions R.
///
/// For a matrix W with `W <= S` and `W R = 0`, `W <= P - M'`: with the projection `Z = I - R (R'S R)^-1 R'S` one has
/// `W = Z'W Z <= Z'S Z = P - M'`. So P is an upper bound of `M' + W` like the blocks `B = M' + S`, is never above these
/// blocks, and equals M' on rigid motions. Its inverse is that of the blocks plus a correction by sums over each part,
///
/// `P^-1 = B^-1 + U G^-1 U'`, with `U = B^-1 S R` and `G = U'M' R`
///
/// (Sherman, Morrison and Woodbury, as `R'S R - R'S B^-1 S R = G`). Motions are orthonormal in S: P depends on their
/// span alone.
#[derive(Clone, Debug)]
pub struct Deflation {
    parts: Vec<Part>,
}

/// A part that may move as a rigid body.
#[derive(Clone, Debug)]
struct Part {
    /// R and S R.
    rigid: RigidMotions,
    /// U.
    moved: Vec<[f64; LAYERS]>,
    /// G and its factor.
    gram: [[f64; MOST]; MOST],
    factor: Factor,
    /// True if S resists all motions; otherwise nothing is subtracted.
    is_sound: bool,
}

impl Deflation {
    /// The rigid motions of these parts, of 1 to 6 each; nothing is removed before [`Deflation::weigh`].
    #[must_use]
    pub fn new(parts: Vec<FreePart>) -> Self {
        let of = |free: FreePart| Part {
            moved: vec![[0.0; LAYERS]; free.twists.len() * free.cells.len()],
            rigid: RigidMotions::new(free),
            gram: [[0.0; MOST]; MOST],
            factor: Factor::default(),
            is_sound: false,
        };
        Self {
            parts: parts.into_iter().map(of).collect(),
        }
    }

    /// True if there are no parts.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Number of the motions of all parts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.parts.iter().map(|part| part.rigid.count()).sum()
    }

    /// Sets the motions about the rest positions of cells, or about positions displaced by displacements (m), S as
    /// `factor` times the blocks `added`, `B^-1` as `of_inverse` times `inverse`, all row by row, and the diagonal of
    /// M'.
    pub fn weigh(
        &mut self,
        u: Option<&[f64]>,
        (factor, added): (f64, &[f64]),
        (of_inverse, inverse): (f64, &[f64]),
        inertia: impl Fn(usize) -> f64,
    ) {
        for part in &mut self.parts {
            let times = |blocks: &[f64], factor: f64, cell: usize, x: [f64; LAYERS]| {
                let rows = &blocks[9 * cell..9 * cell + 9];
                [0, 1, 2].map(|axis| {
                    let row = &rows[3 * axis..3 * axis + 3];
                    factor * (row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
                })
            };
            part.is_sound = part.rigid.take(u, |cell, x| times(added, factor, cell, x));
            if !part.is_sound {
                continue;
            }
            let count = part.rigid.count();
            let mut gram = [[0.0; MOST]; MOST];
            let rows = part.rigid.motions.chunks_exact(count);
            let rows = rows.zip(part.rigid.weighted.chunks_exact(count));
            let rows = rows.zip(part.moved.chunks_exact_mut(count));
            for (cell, ((motions, weighted), moved)) in part.rigid.free.cells.iter().zip(rows) {
                let cell = *cell as usize;
                for (moved, weighted) in moved.iter_mut().zip(weighted) {
                    *moved = times(inverse, 1.0 / of_inverse, cell, *weighted);
                }
                for (row, moved) in gram.iter_mut().zip(&*moved) {
                    for (entry, motion) in row.iter_mut().zip(motions) {
                        for axis in 0..LAYERS {
                            *entry += moved[axis] * inertia(LAYERS * cell + axis) * motion[axis];
                        }
                    }
                }
            }
            let factor = Factor::of(&gram, count);
            part.is_sound = factor.is_some();
            (part.gram, part.factor) = (gram, factor.unwrap_or_default());
        }
    }

    /// The motions of each part, by their numbers among the motions of all parts.
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        let mut first = 0;
        self.parts.iter().map(move |part| {
            let range = first..first + part.rigid.count();
            first = range.end;
            range
        })
    }

    /// `out += U G^-1 U' r`: the correction from `B^-1 r` to `P^-1 r`.
    pub fn correct(&self, r: &[f64], out: &mut [f64]) {
        for part in self.sound() {
            let mut sums = part.rigid.sums(&part.moved, r);
            part.factor.solve(&mut sums);
            part.rigid.add(&part.moved, &sums, out);
        }
    }

    /// `x'(B - P) y`.
    #[must_use]
    pub fn taken_out(&self, x: &[f64], y: &[f64]) -> f64 {
        let of_part = |part: &Part| {
            let [x, y] = [x, y].map(|of| part.rigid.sums(&part.rigid.weighted, of));
            x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>()
        };
        self.sound().map(of_part).sum()
    }

    /// Calls `each` with every cell on which the motions act, the number of the first motion of its part, and the
    /// cell's rows of S R and U.
    pub fn for_each_cell(
        &self,
        mut each: impl FnMut(usize, usize, &[[f64; LAYERS]], &[[f64; LAYERS]]),
    ) {
        for (part, range) in self.parts.iter().zip(self.ranges()) {
            if part.is_sound {
                let rows = part.rigid.weighted.chunks_exact(range.len());
                let rows = rows.zip(part.moved.chunks_exact(range.len()));
                for (cell, (weighted, moved)) in part.rigid.free.cells.iter().zip(rows) {
                    each(*cell as usize, range.start, weighted, moved);
                }
            }
        }
    }

    /// `out -= G c`, over the motions of all parts.
    pub fn subtract_gram(&self, c: &[f64], out: &mut [f64]) {
        for (part, range) in self.parts.iter().zip(self.ranges()) {
            if part.is_sound {
                let c = &c[range.clone()];
                for (row, out) in part.gram.iter().zip(&mut out[range]) {
                    *out -= row.iter().zip(c).map(|(entry, c)| entry * c).sum::<f64>();
                }
            }
        }
    }

    fn sound(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| part.is_sound)
    }
}

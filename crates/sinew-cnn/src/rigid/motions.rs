//! The rigid motions of one part as vectors over its cells.

use sinew_core::FreePart;

use super::factor::Factor;
use super::{Coefficients, LAYERS, MOST};

/// Largest number of improvements of a rigid displacement: each leaves an error of about the square of the remaining
/// angle.
const MOST_TURNS: usize = 12;

/// Square of a change, as a share of that of the displacement, at which a rigid displacement has converged.
const FOUND: f64 = 1e-28;

/// The rigid motions of a part, about the rest or current positions of its cells, orthonormal in a metric with one
/// matrix for each cell.
#[derive(Clone, Debug)]
pub struct RigidMotions {
    pub(crate) free: FreePart,
    /// R: for each cell the components of each motion.
    pub(crate) motions: Vec<[f64; LAYERS]>,
    /// The metric times R.
    pub(crate) weighted: Vec<[f64; LAYERS]>,
    /// The factor of the metric of the part's twists.
    factor: Factor,
    /// The centre (m) of these rotations: it moves with an unsupported part, so that they stay independent
    /// at any displacement.
    origin: [f64; 3],
}

impl RigidMotions {
    /// Storage for the motions of a part.
    #[must_use]
    pub fn new(free: FreePart) -> Self {
        let count = free.twists.len() * free.cells.len();
        Self {
            free,
            motions: vec![[0.0; LAYERS]; count],
            weighted: vec![[0.0; LAYERS]; count],
            factor: Factor::default(),
            origin: [0.0; 3],
        }
    }

    /// Their number, 1 to 6.
    pub(super) fn count(&self) -> usize {
        self.free.twists.len()
    }

    /// Computes the motions about rest, or about displacements (m), and makes them orthonormal in the metric that
    /// `weigh` applies to a cell's vector; returns false if they are linearly dependent in this metric.
    pub(crate) fn take(
        &mut self,
        u: Option<&[f64]>,
        weigh: impl Fn(usize, [f64; LAYERS]) -> [f64; LAYERS],
    ) -> bool {
        let count = self.count();
        let FreePart {
            cells,
            rest,
            moves,
            centre,
            twists,
        } = &self.free;
        self.origin = *centre;
        if let (Some(u), MOST) = (u, count) {
            let share = 1.0 / cells.len() as f64;
            for cell in cells {
                let u = at(u, *cell);
                (0..3).for_each(|axis| self.origin[axis] += share * u[axis]);
            }
        }
        let origin = self.origin;
        let mut metric = [[0.0; MOST]; MOST];
        let rows = self.motions.chunks_exact_mut(count);
        let rows = rows.zip(self.weighted.chunks_exact_mut(count));
        let places = cells.iter().zip(rest).zip(moves);
        for (((cell, rest), moves), (motions, weighted)) in places.zip(rows) {
            let cell = *cell as usize;
            let arm = [0, 1, 2].map(|axis| {
                let moved = u.map_or(0.0, |u| u[LAYERS * cell + axis]);
                rest[axis] + moved - origin[axis]
            });
            for (j, twist) in twists.iter().enumerate() {
                let at = twist.at(arm);
                motions[j] = [0, 1, 2].map(|axis| if moves[axis] { at[axis] } else { 0.0 });
                weighted[j] = weigh(cell, motions[j]);
                for (i, motion) in motions[..=j].iter().enumerate() {
                    metric[j][i] += dot(*motion, weighted[j]);
                }
            }
        }
        let Some(factor) = Factor::of(&metric, count) else {
            return false;
        };
        self.factor = factor;
        for list in [&mut self.motions, &mut self.weighted] {
            for of_cell in list.chunks_exact_mut(count) {
                for axis in 0..LAYERS {
                    let mut row = [0.0; MOST];
                    row.iter_mut()
                        .zip(&*of_cell)
                        .for_each(|(entry, motion)| *entry = motion[axis]);
                    self.factor.forward(&mut row);
                    of_cell
                        .iter_mut()
                        .zip(row)
                        .for_each(|(motion, entry)| motion[axis] = entry);
                }
            }
        }
        true
    }

    /// `list' x` over the part, by motions.
    pub(crate) fn sums(&self, list: &[[f64; LAYERS]], x: &[f64]) -> Coefficients {
        let mut sums = [0.0; MOST];
        let rows = list.chunks_exact(self.count()).zip(&self.free.cells);
        for (row, cell) in rows {
            let x = at(x, *cell);
            for (sum, motion) in sums.iter_mut().zip(row) {
                *sum += dot(*motion, x);
            }
        }
        sums
    }

    /// `out += list c` over the part.
    pub(crate) fn add(&self, list: &[[f64; LAYERS]], c: &Coefficients, out: &mut [f64]) {
        let rows = list.chunks_exact(self.count()).zip(&self.free.cells);
        for (row, cell) in rows {
            let first = LAYERS * *cell as usize;
            for (motion, c) in row.iter().zip(c) {
                for (out, motion) in out[first..first + LAYERS].iter_mut().zip(motion) {
                    *out += c * motion;
                }
            }
        }
    }

    /// Sets the part's cells of a vector to 0.
    pub fn clear(&self, of: &mut [f64]) {
        for cell in &self.free.cells {
            of[LAYERS * *cell as usize..][..LAYERS].fill(0.0);
        }
    }

    /// Writes the rigid displacement y (m) of the part from the displacement `u` (m) on, of any size, that minimises
    /// `y'M y/2 - b'y` for the forces b (N) `pull` and the diagonal M (N/m) of `inertia`; `places` is scratch space.
    /// Cells of other parts are unchanged.
    ///
    /// It is the rigid motion that is nearest to `M^-1 b` in the metric of M (Kabsch, Acta Cryst. A 32, 1976, for an
    /// unsupported part), with twists that the exponential map makes finite.
    pub fn lead(
        &mut self,
        u: &[f64],
        pull: &[f64],
        inertia: impl Fn(usize) -> f64,
        (y, places): (&mut [f64], &mut [f64]),
    ) {
        self.clear(y);
        for _ in 0..MOST_TURNS {
            for cell in &self.free.cells {
                let first = LAYERS * *cell as usize;
                for dof in first..first + LAYERS {
                    places[dof] = u[dof] + y[dof];
                }
            }
            if !self.take(Some(places), by_diagonal(&inertia)) {
                return;
            }
            let (mut c, mut size) = ([0.0; MOST], 0.0);
            let rows = self.motions.chunks_exact(self.count());
            for (cell, motions) in self.free.cells.iter().zip(rows) {
                let first = LAYERS * *cell as usize;
                let left = [0, 1, 2].map(|axis| {
                    let dof = first + axis;
                    let held = inertia(dof) * y[dof];
                    size += held * y[dof];
                    pull[dof] - held
                });
                for (c, motion) in c.iter_mut().zip(motions) {
                    *c += dot(*motion, left);
                }
            }
            let change: f64 = c.iter().map(|c| c * c).sum();
            let goes_on = change > FOUND * size;
            if !(goes_on && change.is_finite()) {
                return;
            }
            self.factor.back(&mut c);
            self.turn(&c, places, y);
        }
    }

    /// Adds `factor` times the small rigid displacement, about rest or a displacement `u` (m), that is nearest to `M^-1 b` in the metric of the diagonal M of `inertia`, b being `pull`.
    pub fn add_small(
        &mut self,
        u: Option<&[f64]>,
        pull: &[f64],
        inertia: impl Fn(usize) -> f64,
        (factor, out): (f64, &mut [f64]),
    ) {
        if self.take(u, by_diagonal(&inertia)) {
            let sums = self.sums(&self.motions, pull).map(|sum| factor * sum);
            self.add(&self.motions, &sums, out);
        }
    }

    /// Moves the part from its position by the exponential of a sum of its twists.
    fn turn(&self, c: &Coefficients, places: &[f64], y: &mut [f64]) {
        let (mut translation, mut rotation) = ([0.0; 3], [0.0; 3]);
        for (twist, c) in self.free.twists.iter().zip(c) {
            for axis in 0..3 {
                translation[axis] += c * twist.translation[axis];
                rotation[axis] += c * twist.rotation[axis];
            }
        }
        let square = dot(rotation, rotation);
        let angle = square.sqrt();
        // sin a/a, (1 - cos a)/a^2 and (a - sin a)/a^3.
        let [sine, cosine, third] = if angle < 1e-2 {
            let of = |first: f64, a: f64, b: f64| first * (1.0 - square / a * (1.0 - square / b));
            [
                of(1.0, 6.0, 20.0),
                of(0.5, 12.0, 30.0),
                of(1.0 / 6.0, 20.0, 42.0),
            ]
        } else {
            let half = (0.5 * angle).sin();
            [
                angle.sin() / angle,
                2.0 * half * half / square,
                (angle - angle.sin()) / (square * angle),
            ]
        };
        let turned = |x: [f64; 3], [first, second]: [f64; 2]| {
            let once = cross(rotation, x);
            let twice = cross(rotation, once);
            [0, 1, 2].map(|axis| first * once[axis] + second * twice[axis])
        };
        let slide = turned(translation, [cosine, third]);
        let cells = self.free.cells.iter().zip(&self.free.rest);
        for ((cell, rest), moves) in cells.zip(&self.free.moves) {
            let first = LAYERS * *cell as usize;
            let arm = [0, 1, 2].map(|axis| rest[axis] + places[first + axis] - self.origin[axis]);
            let moved = turned(arm, [sine, cosine]);
            for axis in (0..LAYERS).filter(|axis| moves[*axis]) {
                y[first + axis] += moved[axis] + translation[axis] + slide[axis];
            }
        }
    }
}

/// A diagonal matrix times a vector of a cell.
pub(crate) fn by_diagonal(
    diagonal: impl Fn(usize) -> f64,
) -> impl Fn(usize, [f64; LAYERS]) -> [f64; LAYERS] {
    move |cell, x| [0, 1, 2].map(|axis| diagonal(LAYERS * cell + axis) * x[axis])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [f64; LAYERS], b: [f64; LAYERS]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn at(x: &[f64], cell: u32) -> [f64; LAYERS] {
    let first = LAYERS * cell as usize;
    [x[first], x[first + 1], x[first + 2]]
}

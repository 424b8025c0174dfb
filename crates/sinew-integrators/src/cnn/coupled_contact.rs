//! Contact in a step, coupled with rigid motions of whole parts.

use sinew_cnn::Deflation;
use sinew_core::vectors::norm;
use sinew_core::{AllShown, Contact, Meeting, State};

/// Largest number of improvements of the response in a step.
const MOST_ROUNDS: usize = 40;

/// Residual of the rigid motions' equation, relative to its terms, at which they count as found.
const FOUND: f64 = 1e-11;

/// The same if rounded positions prevent a smaller residual.
const ROUNDED: f64 = 1e-7;

/// Relative change of a response for slopes by differences.
const NUDGE: f64 = 1e-7;

/// Halvings of an improvement, and steps of the alternating minimisation if none helps.
const HALVINGS: usize = 6;
const PLAIN_STEPS: usize = 3;

/// Reduction of the residual below which slopes are reused.
const MUCH: f64 = 0.25;

/// Minimum reduction, as a share of the residual, by a whole improvement.
const LOWERED: f64 = 1e-4;

/// Finds the forces lambda of contact in a step of `P (v+ - v-) = dt F` with the matrix P of a [`Deflation`], `P^-1 = B^-1 + U G^-1 U'`.
///
/// With the rigid motions' response `c = G^-1 U' lambda` known, contact acts on cells from `v + U c` by their diagonal
/// blocks B alone, as in other methods. Since `U' lambda = R'S d`, d being the change of the cells' velocities by
/// contact, c is the root of `f(c) = R'S d(c) - G c`: a few numbers for each part. f is linear except for contacts that
/// begin, end, stick or slip, and Newton's method finds c in a few rounds, with slopes by differences (Qi and Sun,
/// Math. Program. 58, 1993). If none of its steps helps, c is replaced by `c + f`: an alternating minimisation over
/// cells and rigid motions, which converges if contact is the minimum of a convex function. So all laws of contact hold
/// as with one block for each cell.
#[derive(Debug, Default)]
pub(super) struct CoupledContact {
    /// u and v of contact's cells without the response, three components each.
    u: Vec<f64>,
    v: Vec<f64>,
    /// Rows of contact's cells; none if no rigid motion moves them.
    rows: Vec<Option<Row>>,
    /// Index of a cell among those of contact, plus one; 0 for other cells.
    place_of: Vec<u32>,
    /// c, and f at c.
    answer: Vec<f64>,
    left: Vec<f64>,
    /// c and f of the last evaluation of contact.
    asked: Vec<f64>,
    found: Vec<f64>,
    /// The motions of parts that are in contact.
    active: Vec<usize>,
    /// The slopes of f over them, row by row, and an improvement of c.
    slopes: Vec<f64>,
    eliminated: Vec<f64>,
    step: Vec<f64>,
    /// Residual of the worst step, relative to its terms.
    pub(super) largest_left: f64,
}

/// A cell in the motions of its part: the number of the first, and the cell's rows of S R and U.
#[derive(Clone, Copy, Debug)]
struct Row {
    first: usize,
    count: usize,
    weighted: [[f64; 3]; 6],
    moved: [[f64; 3]; 6],
}

/// Inputs of a step of contact.
#[derive(Clone, Copy)]
pub(super) struct Coupled<'a> {
    pub(super) contact: &'a dyn Contact,
    /// The step, with the blocks B and no acceleration.
    pub(super) meeting: &'a Meeting<'a>,
    pub(super) deflation: &'a Deflation,
    /// History variables of contact before the step.
    pub(super) kept: &'a [f64],
}

impl CoupledContact {
    /// Scratch space for contact on a body with `motions` rigid motions.
    pub(super) fn new(contact: &dyn Contact, dofs: usize, motions: usize) -> Self {
        let cells = contact.cells();
        let mut place_of = vec![0; dofs / 3];
        for (place, cell) in (1..).zip(cells) {
            place_of[*cell as usize] = place;
        }
        let zeros = || vec![0.0; motions];
        Self {
            u: vec![0.0; 3 * cells.len()],
            v: vec![0.0; 3 * cells.len()],
            rows: vec![None; cells.len()],
            place_of,
            answer: zeros(),
            left: zeros(),
            asked: zeros(),
            found: zeros(),
            active: Vec::with_capacity(motions),
            slopes: vec![0.0; motions * motions],
            eliminated: vec![0.0; motions * motions],
            step: zeros(),
            largest_left: 0.0,
        }
    }

    /// Resolves contact on a trial state, rigid motions included: changes u, v and the contact variables.
    pub(super) fn meet(&mut self, coupled: Coupled<'_>, state: &mut State, pushed: &mut Vec<u32>) {
        self.look(coupled, state);
        self.answer.fill(0.0);
        self.asked.fill(0.0);
        self.active.clear();
        let mut size = self.ask(coupled, state, pushed);
        for round in 0.. {
            self.left.copy_from_slice(&self.found);
            let left = norm(&self.left);
            if left <= FOUND * size {
                break;
            }
            let is_rounded = left <= ROUNDED * size;
            if round == MOST_ROUNDS {
                self.largest_left = self.largest_left.max(left / size);
                break;
            }
            let Some(better) = self.improve(coupled, state, pushed) else {
                self.asked.copy_from_slice(&self.answer);
                size = self.ask(coupled, state, pushed);
                if is_rounded {
                    break;
                }
                for _ in 0..PLAIN_STEPS {
                    for (asked, found) in self.asked.iter_mut().zip(&self.found) {
                        *asked += found;
                    }
                    size = self.ask(coupled, state, pushed);
                }
                self.answer.copy_from_slice(&self.asked);
                continue;
            };
            size = better;
            self.answer.copy_from_slice(&self.asked);
        }
        if norm(&self.answer) != 0.0 {
            self.carry(coupled, state);
        }
    }

    /// Improves a response that leaves a residual; returns the size of the terms of f there, or `None` if no share of
    /// the improvement helps. Slopes are reused as long as they reduce the residual enough.
    fn improve(
        &mut self,
        coupled: Coupled<'_>,
        state: &mut State,
        pushed: &mut Vec<u32>,
    ) -> Option<f64> {
        let before = self.active.len();
        self.activate(coupled.deflation);
        if self.active.len() != before {
            self.find_slopes_without_contact(coupled.deflation);
        }
        let left = norm(&self.left);
        if self.find_step().is_some() {
            let size = self.go(1.0, coupled, state, pushed);
            if norm(&self.found) < MUCH * left {
                return Some(size);
            }
        }
        self.find_slopes(coupled, state, pushed);
        self.find_step()?;
        let mut share = 1.0;
        for _ in 0..=HALVINGS {
            let size = self.go(share, coupled, state, pushed);
            if norm(&self.found) < (1.0 - LOWERED * share) * left {
                return Some(size);
            }
            share *= 0.5;
        }
        None
    }

    /// Finds the motions of parts that are in contact.
    fn activate(&mut self, deflation: &Deflation) {
        self.active.clear();
        for range in deflation.ranges() {
            let mut values = range.clone().map(|at| (self.left[at], self.answer[at]));
            if values.any(|values| values != (0.0, 0.0)) {
                self.active.extend(range);
            }
        }
    }

    /// The slopes - G of f with constant contact forces.
    fn find_slopes_without_contact(&mut self, deflation: &Deflation) {
        let count = self.active.len();
        for column in 0..count {
            self.asked.fill(0.0);
            self.asked[self.active[column]] = 1.0;
            self.found.fill(0.0);
            deflation.subtract_gram(&self.asked, &mut self.found);
            for (row, at) in self.active.iter().enumerate() {
                self.slopes[row * count + column] = self.found[*at];
            }
        }
    }

    /// The slopes of f by differences.
    fn find_slopes(&mut self, coupled: Coupled<'_>, state: &mut State, pushed: &mut Vec<u32>) {
        let count = self.active.len();
        let nudge = NUDGE * norm(&self.answer).max(norm(&self.left));
        for column in 0..count {
            self.asked.copy_from_slice(&self.answer);
            self.asked[self.active[column]] += nudge;
            self.ask(coupled, state, pushed);
            for (row, at) in self.active.iter().enumerate() {
                self.slopes[row * count + column] = (self.found[*at] - self.left[*at]) / nudge;
            }
        }
    }

    /// Finds the improvement from the slopes; `None` if they are singular.
    fn find_step(&mut self) -> Option<()> {
        let count = self.active.len();
        for (step, at) in self.step.iter_mut().zip(&self.active) {
            *step = -self.left[*at];
        }
        let eliminated = &mut self.eliminated[..count * count];
        eliminated.copy_from_slice(&self.slopes[..count * count]);
        solve(eliminated, &mut self.step[..count])
    }

    /// Resolves contact at the response plus a share of the improvement; returns the size of the terms of f.
    fn go(
        &mut self,
        share: f64,
        coupled: Coupled<'_>,
        state: &mut State,
        pushed: &mut Vec<u32>,
    ) -> f64 {
        self.asked.copy_from_slice(&self.answer);
        for (at, step) in self.active.iter().zip(&self.step) {
            self.asked[*at] += share * step;
        }
        self.ask(coupled, state, pushed)
    }

    /// Resolves contact of the cells at the given response, and computes f; returns the size of its terms.
    fn ask(&mut self, coupled: Coupled<'_>, state: &mut State, pushed: &mut Vec<u32>) -> f64 {
        let Coupled {
            contact,
            meeting,
            deflation,
            kept,
        } = coupled;
        for (place, cell) in contact.cells().iter().enumerate() {
            let shift = self.shift(place);
            let first = 3 * *cell as usize;
            for (axis, shift) in shift.into_iter().enumerate() {
                state.v[first + axis] = self.v[3 * place + axis] + shift;
                state.u[first + axis] = self.u[3 * place + axis] + meeting.dt * shift;
            }
        }
        kept.clone_into(&mut state.contact);
        pushed.clear();
        contact.meet(meeting, &mut AllShown, state, pushed);
        self.found.fill(0.0);
        for cell in &*pushed {
            let cell = *cell as usize;
            let Some(place) = self.place_of[cell].checked_sub(1) else {
                continue;
            };
            let place = place as usize;
            let shift = self.shift(place);
            let Some(row) = &self.rows[place] else {
                continue;
            };
            let change = [0, 1, 2]
                .map(|axis| state.v[3 * cell + axis] - (self.v[3 * place + axis] + shift[axis]));
            for (motion, weighted) in row.weighted[..row.count].iter().enumerate() {
                let of_cell: f64 = (0..3).map(|axis| weighted[axis] * change[axis]).sum();
                self.found[row.first + motion] += of_cell;
            }
        }
        let given = norm(&self.found);
        deflation.subtract_gram(&self.asked, &mut self.found);
        given
    }

    /// Stores the contact-free displacements and velocities of contact's cells, and how rigid motions move them.
    fn look(&mut self, coupled: Coupled<'_>, state: &State) {
        for (place, cell) in coupled.contact.cells().iter().enumerate() {
            let first = 3 * *cell as usize;
            self.u[3 * place..3 * place + 3].copy_from_slice(&state.u[first..first + 3]);
            self.v[3 * place..3 * place + 3].copy_from_slice(&state.v[first..first + 3]);
        }
        self.rows.fill(None);
        let (rows, place_of) = (&mut self.rows, &self.place_of);
        coupled
            .deflation
            .for_each_cell(|cell, first, weighted, moved| {
                if let Some(place) = place_of[cell].checked_sub(1) {
                    let mut row = Row {
                        first,
                        count: moved.len(),
                        weighted: [[0.0; 3]; 6],
                        moved: [[0.0; 3]; 6],
                    };
                    row.weighted[..row.count].copy_from_slice(weighted);
                    row.moved[..row.count].copy_from_slice(moved);
                    rows[place as usize] = Some(row);
                }
            });
    }

    /// U c of the trial response, at one of contact's cells.
    fn shift(&self, place: usize) -> [f64; 3] {
        let mut shift = [0.0; 3];
        if let Some(row) = &self.rows[place] {
            let motions = row.moved[..row.count].iter();
            for (motion, c) in motions.zip(&self.asked[row.first..]) {
                for axis in 0..3 {
                    shift[axis] += c * motion[axis];
                }
            }
        }
        shift
    }

    /// Moves all cells by the response of the rigid motions, except those of contact, which already have it.
    fn carry(&self, coupled: Coupled<'_>, state: &mut State) {
        let dt = coupled.meeting.dt;
        coupled.deflation.for_each_cell(|cell, first, _, moved| {
            if self.place_of[cell] != 0 {
                return;
            }
            for (motion, c) in moved.iter().zip(&self.answer[first..]) {
                let (v, u) = (&mut state.v[3 * cell..], &mut state.u[3 * cell..]);
                for ((v, u), motion) in v.iter_mut().zip(u).zip(motion) {
                    *v += c * motion;
                    *u += dt * c * motion;
                }
            }
        });
    }
}

/// Replaces x by the solution with a matrix, row by row, by Gauss's elimination with pivots in each column; `None` if
/// it is singular.
fn solve(matrix: &mut [f64], x: &mut [f64]) -> Option<()> {
    let n = x.len();
    for k in 0..n {
        let size = |row: &usize| matrix[row * n + k].abs();
        let pivot = (k..n).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        if !(size(&pivot) > 0.0 && size(&pivot).is_finite()) {
            return None;
        }
        if pivot != k {
            (0..n).for_each(|column| matrix.swap(k * n + column, pivot * n + column));
            x.swap(k, pivot);
        }
        for row in k + 1..n {
            let factor = matrix[row * n + k] / matrix[k * n + k];
            for column in k..n {
                matrix[row * n + column] -= factor * matrix[k * n + column];
            }
            x[row] -= factor * x[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n)
            .map(|column| matrix[k * n + column] * x[column])
            .sum();
        x[k] = (x[k] - known) / matrix[k * n + k];
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::solve;

    #[test]
    fn a_solution_fits_its_matrix() {
        let matrix = [0.0, 2.0, 1.0, 1.0, 1.0, 0.0, 3.0, 0.5, -1.0];
        let expected = [1.0, -2.0, 3.0];
        let row = |i: usize| (0..3).map(|j| matrix[3 * i + j] * expected[j]).sum::<f64>();
        let (mut kept, mut x) = (matrix, [row(0), row(1), row(2)]);
        assert!(solve(&mut kept, &mut x).is_some());
        for (x, expected) in x.iter().zip(expected) {
            assert!((x - expected).abs() < 1e-14);
        }
        assert!(solve(&mut [1.0, 2.0, 2.0, 4.0], &mut [1.0, 1.0]).is_none());
    }
}

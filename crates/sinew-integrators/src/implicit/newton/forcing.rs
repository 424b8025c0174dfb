//! Accuracy of the linear solution in an iteration.

/// The share of the residual that the first solution may leave.
const FIRST: f64 = 0.01;

/// The largest share that a solution may leave.
const MOST: f64 = 0.3;

/// Share of the tolerance to which the solution that is presumably the last is computed.
const LAST: f64 = 0.5;

/// Relative residuals that linear solutions may leave: about those that the nonlinearity leaves (Eisenstat and
/// Walker, SIAM J. Sci. Comput. 17, 1996).
#[derive(Clone, Copy, Debug)]
pub(super) struct Forcing {
    tolerance: f64,
    /// True if the residual of linear solutions decreases as the square of Newton's residual.
    is_quadratic: bool,
    /// Residual over the size of the forces.
    residual: f64,
    /// The share of it that the linear equations would have left.
    expected: Option<f64>,
    next: f64,
}

impl Forcing {
    pub(super) fn new(tolerance: f64, is_quadratic: bool) -> Self {
        Self {
            tolerance,
            is_quadratic,
            residual: 0.0,
            expected: None,
            next: FIRST,
        }
    }

    /// Sets the residual, over the size of the forces, at the beginning of an iteration.
    pub(super) fn at(&mut self, residual: f64) {
        let before = std::mem::replace(&mut self.residual, residual);
        if let Some(left) = self.expected.take() {
            let reached = residual / before;
            let lacking = (reached - left).abs();
            self.next = match self.is_quadratic {
                true => lacking * reached,
                false => lacking,
            };
        }
    }

    /// The share of the residual that the next solution may leave.
    pub(super) fn share(&self) -> f64 {
        // A residual that is not a number asks for the most.
        let last = LAST * self.tolerance / self.residual;
        self.next.min(MOST).max(last)
    }

    /// Sets the share that a solution left.
    pub(super) fn left(&mut self, share: f64) {
        self.expected = Some(share);
    }

    /// Sets the share of the direction that was taken.
    pub(super) fn gone(&mut self, share: f64) {
        self.expected = self.expected.map(|left| 1.0 - share * (1.0 - left));
    }
}

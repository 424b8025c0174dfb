//! The box about points.

/// The least and the greatest coordinates of points.
pub(crate) struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Default for Bounds {
    fn default() -> Bounds {
        Bounds {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
        }
    }
}

impl Bounds {
    pub(crate) fn add(&mut self, point: [f64; 3]) {
        for ((low, high), x) in self.low.iter_mut().zip(&mut self.high).zip(point) {
            *low = low.min(x);
            *high = high.max(x);
        }
    }

    /// Widths along x, y and z; 0 if no point was added.
    pub(crate) fn widths(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| (self.high[axis] - self.low[axis]).max(0.0))
    }

    /// The largest of the widths.
    pub(crate) fn longest_side(&self) -> f64 {
        self.widths().into_iter().fold(0.0, f64::max)
    }
}

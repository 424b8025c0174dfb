//! Isometric projection of points in metres, seen from above the corner towards -x, -y and +z.

/// Length in the picture of a unit along any of the three axes.
pub(super) const SHORTENING: f64 = 0.816_496_580_927_726;

/// A projected point: `x` to the right, `y` downwards, `depth` away from the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Projected {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) depth: f64,
}

pub(super) fn project([x, y, z]: [f64; 3]) -> Projected {
    let half = SHORTENING * 0.5;
    let wide = SHORTENING * 0.75_f64.sqrt();
    Projected {
        x: wide * (x - y),
        y: -half * (x + y) - SHORTENING * z,
        depth: x + y - z,
    }
}

/// The brightness of a triangle, in 0.72..1: it varies little, since colour represents the number. Both sides have the
/// same brightness, since inverted elements exchange their sides.
pub(super) fn light(corners: &[[f64; 3]; 3]) -> f64 {
    // From above, more from the left than from the right.
    const LAMP: [f64; 3] = [-0.62, -0.18, 0.76];
    let edge = |i: usize| std::array::from_fn::<f64, 3, _>(|k| corners[i][k] - corners[0][k]);
    let (a, b) = (edge(1), edge(2));
    let normal = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    let dot = |u: &[f64; 3], v: &[f64; 3]| u.iter().zip(v).map(|(x, y)| x * y).sum::<f64>();
    let length = dot(&normal, &normal).sqrt();
    if length > 0.0 && length.is_finite() {
        0.72 + 0.28 * (dot(&normal, &LAMP) / length).abs().min(1.0)
    } else {
        1.0
    }
}

/// The corners of a box.
pub(super) fn corners([low, high]: [[f64; 3]; 2]) -> [[f64; 3]; 8] {
    std::array::from_fn(|i| {
        std::array::from_fn(|axis| {
            if i >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        })
    })
}

type Edge = [[f64; 3]; 2];

/// The edges of a box: those at the back, and those at the front.
pub(super) fn edges(bounds: [[f64; 3]; 2]) -> (Vec<Edge>, Vec<Edge>) {
    let corners = corners(bounds);
    // Farthest from the viewer: +x, +y, -z.
    let hidden = 0b011;
    (0..8usize)
        .flat_map(|from| (0..3).map(move |axis| (from, from | 1 << axis)))
        .filter(|(from, to)| from != to)
        .map(|(from, to)| (from == hidden || to == hidden, [corners[from], corners[to]]))
        .fold((Vec::new(), Vec::new()), |mut sides, (behind, edge)| {
            if behind {
                sides.0.push(edge);
            } else {
                sides.1.push(edge);
            }
            sides
        })
}

/// The box that a picture has to contain.
#[derive(Debug)]
pub(super) struct Extent {
    low: (f64, f64),
    high: (f64, f64),
}

impl Default for Extent {
    fn default() -> Self {
        Self {
            low: (f64::INFINITY, f64::INFINITY),
            high: (f64::NEG_INFINITY, f64::NEG_INFINITY),
        }
    }
}

impl Extent {
    pub(super) fn add(&mut self, p: Projected) {
        self.low = (self.low.0.min(p.x), self.low.1.min(p.y));
        self.high = (self.high.0.max(p.x), self.high.1.max(p.y));
    }

    /// Width and height, 1 without an extent.
    pub(super) fn size(&self) -> (f64, f64) {
        let size = |low: f64, high: f64| if high > low { high - low } else { 1.0 };
        (size(self.low.0, self.high.0), size(self.low.1, self.high.1))
    }

    /// Its middle, the origin without points.
    pub(super) fn middle(&self) -> (f64, f64) {
        let middle = |low: f64, high: f64| if low <= high { 0.5 * (low + high) } else { 0.0 };
        (
            middle(self.low.0, self.high.0),
            middle(self.low.1, self.high.1),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_shortened_alike() {
        for axis in 0..3 {
            let mut unit = [0.0; 3];
            unit[axis] = 1.0;
            let p = project(unit);
            assert!((p.x.hypot(p.y) - SHORTENING).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_in_front_is_near() {
        let depth = |p| project(p).depth;
        assert!(depth([0.0, 0.0, 1.0]) < depth([0.0, 0.0, 0.0]));
        assert!(depth([0.0, 0.0, 0.0]) < depth([1.0, 0.0, 0.0]));
        // Points on a line of sight fall together.
        let (a, b) = (project([0.0; 3]), project([1.0, 1.0, -1.0]));
        assert!((a.x - b.x).abs() < 1e-12 && (a.y - b.y).abs() < 1e-12);
    }

    #[test]
    fn a_box_has_three_hidden_edges() {
        let (hidden, seen) = edges([[0.0; 3], [1.0; 3]]);
        assert_eq!((hidden.len(), seen.len()), (3, 9));
        assert!(hidden.iter().all(|edge| edge.contains(&[1.0, 1.0, 0.0])));
    }

    #[test]
    fn both_sides_are_lit_alike() {
        let [a, b, c] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(light(&[a, b, c]), light(&[a, c, b]));
        assert_eq!(light(&[a, a, a]), 1.0);
    }
}

//! Connected parts of a body that may move as rigid bodies.

/// A motion of a rigid body about a point: a cell at the place x (m) from there moves by `translation + rotation x x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Displacement of the point itself.
    pub translation: [f64; 3],
    /// Axis, times the angle (1/m where the translation has no unit).
    pub rotation: [f64; 3],
}

impl Twist {
    /// The displacement of a cell at a place (m) from the centre.
    #[must_use]
    pub fn at(&self, place: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.rotation;
        let [x, y, z] = place;
        let [p, q, r] = self.translation;
        [p + b * z - c * y, q + c * x - a * z, r + a * y - b * x]
    }
}

/// A connected part of a body with the rigid motions that its supports allow.
#[derive(Clone, Debug, PartialEq)]
pub struct FreePart {
    /// Its cells, increasing.
    pub cells: Vec<u32>,
    /// Rest positions of the cells (m).
    pub rest: Vec<[f64; 3]>,
    /// Components of each cell that move.
    pub moves: Vec<[bool; 3]>,
    /// The point (m) about which motions turn.
    pub centre: [f64; 3],
    /// Independent motions about the rest: six for a part without supports.
    pub twists: Vec<Twist>,
}

//! Forces of contact at one node.

use crate::vector::{Vector, add, dot, length, scaled, sub};

/// Most constraints at a node that are solved together; more are left to the next step.
pub(super) const MOST: usize = 8;

/// Share of a node's largest response below which it counts as held in the direction of a normal: a normal that is all but along a held axis leaves 1e-3 of itself, and would
/// have to be answered with a force a million times as large.
const HELD: f64 = 1e-6;

/// What a node would move by under forces within a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compliance {
    /// `dt^2 P^-1` (m/N), zero in the directions in which the node is held.
    block: [Vector; 3],
    free: [bool; 3],
}

/// A surface that a node must not pass: `gap + normal . d >= 0` for its displacement d (m) from where the step led it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constraint {
    /// The unit normal, away from the tool.
    pub(super) normal: Vector,
    /// Distance (m) of where the step led from the plane through the first contact, negative beyond it.
    pub(super) gap: f64,
    /// The displacement (m) that takes the node where the tool has carried the place at which it was touched.
    pub(super) stick: Vector,
    /// Coefficient of Coulomb's friction.
    pub(super) friction: f64,
}

impl Compliance {
    /// By the block of `P^-1` (1/kg) and the step (s).
    pub(super) fn new(inverse: [Vector; 3], free: [bool; 3], dt: f64) -> Self {
        let mut block = inverse.map(|row| scaled(row, dt * dt));
        for (row, own) in block.iter_mut().zip(free) {
            for (entry, other) in row.iter_mut().zip(free) {
                if !(own && other) {
                    *entry = 0.0;
                }
            }
        }
        Self { block, free }
    }

    /// The displacement (m) by a force (N).
    pub(super) fn displacement(&self, force: Vector) -> Vector {
        self.block.map(|row| dot(row, force))
    }

    /// The force (N) that causes a displacement (m) in the directions that are free, and none in the others.
    pub(super) fn force(&self, displacement: Vector) -> Vector {
        let mut block = self.block;
        let mut wanted = displacement;
        for axis in 0..3 {
            if !self.free[axis] {
                block[axis][axis] = 1.0;
                wanted[axis] = 0.0;
            }
        }
        solved(block, wanted).unwrap_or_default()
    }

    /// The force (N) of one constraint: the cone of friction in closed form.
    fn of_one(&self, constraint: &Constraint) -> Vector {
        let Constraint {
            normal,
            gap,
            stick,
            friction,
        } = *constraint;
        if gap >= 0.0 {
            return [0.0; 3];
        }
        if friction > 0.0 {
            let sticking = self.force(stick);
            let pressing = dot(sticking, normal);
            let along = sub(sticking, scaled(normal, pressing));
            let size = length(along);
            if pressing > 0.0 && size <= friction * pressing {
                return sticking;
            }
            if size > 0.0 {
                let direction = add(normal, scaled(along, friction / size));
                let response = dot(normal, self.displacement(direction));
                if self.moves(response) {
                    return scaled(direction, -gap / response);
                }
            }
        }
        let response = dot(normal, self.displacement(normal));
        if self.moves(response) {
            scaled(normal, -gap / response)
        } else {
            [0.0; 3]
        }
    }

    /// Whether a node with this response (m/N) to a unit force moves in the direction of that force.
    fn moves(&self, response: f64) -> bool {
        let own = [0, 1, 2].map(|axis| self.block[axis][axis]);
        response > HELD * own.into_iter().fold(0.0, f64::max)
    }

    /// Writes the force (N) of each constraint: at one exactly, with friction; at several exactly too, without it.
    pub(super) fn solve(&self, constraints: &[Constraint], forces: &mut [Vector; MOST]) {
        forces.fill([0.0; 3]);
        match constraints {
            [] => {}
            [one] => forces[0] = self.of_one(one),
            several => self.of_several(several, forces),
        }
    }

    /// The linear complementarity problem `0 <= lambda, gap + N C N' lambda >= 0`, of which at most three constraints act in space: sets of one, two
    /// and three are tried in turn. Where no point satisfies all, as between closing jaws, the one that violates the others least is taken.
    fn of_several(&self, constraints: &[Constraint], forces: &mut [Vector; MOST]) {
        let count = constraints.len().min(MOST);
        let violation = |displacement: Vector| {
            let gaps = constraints.iter();
            let gaps = gaps.map(|of| of.gap + dot(of.normal, displacement));
            gaps.fold(0.0, |worst: f64, gap| worst.max(-gap))
        };
        let scale = violation([0.0; 3]);
        let mut best = (scale, [usize::MAX; 3], [0.0; 3]);
        let mut attempt = |active: [usize; 3]| {
            let Some(lambda) = self.multipliers(constraints, active) else {
                return false;
            };
            if lambda.iter().any(|value| *value < 0.0) {
                return false;
            }
            let left = violation(self.displacement(sum_of(constraints, active, lambda)));
            if left < best.0 {
                best = (left, active, lambda);
            }
            left <= 1e-12 * scale
        };
        let none = usize::MAX;
        let singles = (0..count).map(|a| [a, none, none]);
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b, none]));
        let triples = (0..count)
            .flat_map(|a| (a + 1..count).flat_map(move |b| (b + 1..count).map(move |c| [a, b, c])));
        if scale > 0.0 {
            let _found = singles.chain(pairs).chain(triples).any(&mut attempt);
        }
        let (_, active, lambda) = best;
        for (index, lambda) in active.into_iter().zip(lambda) {
            if index < count {
                forces[index] = scaled(constraints[index].normal, lambda);
            }
        }
    }

    /// The multipliers (N) that close the gaps of some constraints.
    fn multipliers(&self, constraints: &[Constraint], active: [usize; 3]) -> Option<Vector> {
        let mut matrix = [[0.0; 3]; 3];
        let mut wanted = [0.0; 3];
        for (i, a) in active.into_iter().enumerate() {
            let Some(own) = constraints.get(a) else {
                matrix[i][i] = 1.0;
                continue;
            };
            wanted[i] = -own.gap;
            let response = self.displacement(own.normal);
            if !self.moves(dot(own.normal, response)) {
                return None;
            }
            for (entry, b) in matrix[i].iter_mut().zip(active) {
                *entry = constraints.get(b).map_or(0.0, |b| dot(b.normal, response));
            }
        }
        solved(matrix, wanted)
    }
}

fn sum_of(constraints: &[Constraint], active: [usize; 3], lambda: Vector) -> Vector {
    let mut sum = [0.0; 3];
    for (index, lambda) in active.into_iter().zip(lambda) {
        if let Some(constraint) = constraints.get(index) {
            sum = add(sum, scaled(constraint.normal, lambda));
        }
    }
    sum
}

/// `A^-1 b` of a symmetric positive definite matrix by its Cholesky factor; `None` where it is singular.
fn solved(a: [Vector; 3], b: Vector) -> Option<Vector> {
    let positive = |pivot: f64, of: f64| (pivot > 1e-13 * of).then(|| pivot.sqrt());
    let l00 = positive(a[0][0], 0.0)?;
    let (l10, l20) = (a[1][0] / l00, a[2][0] / l00);
    let l11 = positive(a[1][1] - l10 * l10, a[1][1])?;
    let l21 = (a[2][1] - l20 * l10) / l11;
    let l22 = positive(a[2][2] - l20 * l20 - l21 * l21, a[2][2])?;
    let y0 = b[0] / l00;
    let y1 = (b[1] - l10 * y0) / l11;
    let y2 = (b[2] - l20 * y0 - l21 * y1) / l22;
    let x2 = y2 / l22;
    let x1 = (y1 - l21 * x2) / l11;
    Some([(y0 - l10 * x1 - l20 * x2) / l00, x1, x2])
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: [Vector; 3] = [[2.0, 0.3, -0.1], [0.3, 1.0, 0.2], [-0.1, 0.2, 1.5]];

    fn compliance(free: [bool; 3]) -> Compliance {
        Compliance::new(BLOCK, free, 1.0)
    }

    fn plane(normal: Vector, gap: f64) -> Constraint {
        Constraint {
            normal: scaled(normal, 1.0 / length(normal)),
            gap,
            stick: [0.0; 3],
            friction: 0.0,
        }
    }

    fn total(compliance: &Compliance, constraints: &[Constraint]) -> (Vector, [Vector; MOST]) {
        let mut forces = [[0.0; 3]; MOST];
        compliance.solve(constraints, &mut forces);
        let sum = forces.into_iter().fold([0.0; 3], add);
        (compliance.displacement(sum), forces)
    }

    #[test]
    fn a_node_is_brought_to_the_surface_and_no_farther() {
        let constraint = plane([1.0, 2.0, 2.0], -0.01);
        let (moved, forces) = total(&compliance([true; 3]), &[constraint]);
        assert!((dot(constraint.normal, moved) - 0.01).abs() < 1e-16);
        assert!(length(sub(forces[0], scaled(constraint.normal, length(forces[0])))) < 1e-16);
        let (moved, _) = total(&compliance([true; 3]), &[plane([1.0, 2.0, 2.0], 1e-9)]);
        assert_eq!(moved, [0.0; 3]);
    }

    #[test]
    fn held_directions_stay_and_a_node_that_cannot_go_feels_nothing() {
        let constraint = plane([1.0, 0.0, 1.0], -0.01);
        let (moved, _) = total(&compliance([false, true, true]), &[constraint]);
        assert_eq!(moved[0], 0.0);
        assert!((dot(constraint.normal, moved) - 0.01).abs() < 1e-16);
        for normal in [[1.0, 0.0, 0.0], [-1.0, 1e-16, 1e-16], [1.0, 1e-4, 0.0]] {
            let along = [plane(normal, -0.01), plane(normal, -0.02)];
            for constraints in [&along[..1], &along] {
                let (moved, forces) = total(&compliance([false, true, true]), constraints);
                assert_eq!((moved, forces[0]), ([0.0; 3], [0.0; 3]));
            }
        }
    }

    #[test]
    fn friction_sticks_within_the_cone_and_slips_at_its_edge() {
        let compliance = compliance([true; 3]);
        let mut constraint = plane([0.0, 0.0, 1.0], -0.01);
        constraint.stick = [0.002, -0.001, 0.01];
        constraint.friction = 10.0;
        let (moved, _) = total(&compliance, &[constraint]);
        assert!(length(sub(moved, constraint.stick)) < 1e-16, "{moved:?}");
        constraint.friction = 0.01;
        let (moved, forces) = total(&compliance, &[constraint]);
        let [x, y, z] = forces[0];
        assert!((moved[2] - 0.01).abs() < 1e-16);
        assert!((x.hypot(y) / z - 0.01).abs() < 1e-12);
        // Against the slip that is left.
        let left = sub(constraint.stick, moved);
        assert!(x * left[0] + y * left[1] > 0.0);
    }

    #[test]
    fn several_surfaces_are_met_at_once_and_none_pulls() {
        let compliance = compliance([true; 3]);
        let walls = [
            plane([1.0, 0.0, 0.1], -0.01),
            plane([0.0, 1.0, 0.2], -0.02),
            plane([0.3, 0.0, 1.0], -0.005),
            plane([1.0, 1.0, 1.0], -0.001),
        ];
        for count in 2..=walls.len() {
            let (moved, forces) = total(&compliance, &walls[..count]);
            for (wall, force) in walls[..count].iter().zip(forces) {
                let (gap, pressing) = (wall.gap + dot(wall.normal, moved), dot(wall.normal, force));
                assert!(gap >= -1e-15, "{count}: {gap}");
                assert!(pressing >= 0.0);
                assert!(gap * pressing < 1e-15, "{count}: {gap} {pressing}");
            }
        }
    }

    #[test]
    fn between_closing_jaws_the_violation_is_not_made_worse() {
        let jaws = [
            plane([0.0, 0.0, 1.0], -0.01),
            plane([0.0, 0.0, -1.0], -0.002),
        ];
        let (moved, _) = total(&compliance([true; 3]), &jaws);
        let worst = jaws
            .iter()
            .map(|jaw| -(jaw.gap + dot(jaw.normal, moved)))
            .fold(0.0, f64::max);
        assert!(worst <= 0.01 + 1e-15, "{worst}");
    }
}

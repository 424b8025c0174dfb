//! Forces of contact at one node.

use crate::vector::{Vector, add, dot, length, scaled, sub};

/// Largest number of constraints at a node that are solved together; further ones are treated in the next step.
pub(super) const MOST: usize = 8;

/// Share of a node's largest response below which it counts as fixed in the direction of a normal: a normal almost
/// along a fixed axis has a component of 1e-3 in the free directions, and would need a force a million times as large.
pub(super) const HELD: f64 = 1e-6;

/// Largest number of sweeps of an iteration for forces that act on each other.
pub(super) const MOST_SWEEPS: usize = 500;

/// Change of a displacement in a sweep, as a share of the largest that any force causes, below which an iteration has
/// converged.
pub(super) const CONVERGED: f64 = 1e-13;

/// Residual above which an iteration has failed.
const WEDGED: f64 = 1e-3;

/// Violation of constraints, as a share of that without forces, up to which the constraints of a node count as
/// compatible.
const MEANT_TO_FIT: f64 = 1e-9;

/// Nodal compliance: displacement per unit force over one step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Compliance {
    /// `dt^2 P^-1` (m/N), zero in fixed directions of the node.
    block: [Vector; 3],
    free: [bool; 3],
}

/// A surface that a node must not pass: `gap + normal . d >= 0` for its displacement d (m) from its contact-free
/// position after the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constraint {
    /// The unit normal, away from the tool.
    pub(super) normal: Vector,
    /// Distance (m) of the contact-free position from the plane through the first contact, negative beyond it.
    pub(super) gap: f64,
    /// The displacement (m) that moves the node with the point of the tool at which it was touched.
    pub(super) stick: Vector,
    /// Coefficient of Coulomb's friction.
    pub(super) friction: f64,
    /// Displacement (m) along which friction does work: that of the node relative to the tool in the step, in staggered
    /// steps together with that in the step before.
    pub(super) swing: Vector,
}

impl Constraint {
    /// The constraint after a displacement (m).
    pub(super) fn behind(&self, displacement: Vector) -> Self {
        Self {
            gap: self.gap + dot(self.normal, displacement),
            stick: sub(self.stick, displacement),
            swing: add(self.swing, displacement),
            ..*self
        }
    }
}

impl Compliance {
    /// Compliance from the block of `P^-1` (1/kg) and the step (s).
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

    /// Compliance that is free in all directions, with a symmetric block (m/N).
    pub(super) fn yielding(block: [Vector; 3]) -> Self {
        let free = [true; 3];
        Self { block, free }
    }

    /// The sum of this one and a share of another one, as for springs in series.
    pub(super) fn plus(&self, other: &Self, share: f64) -> Self {
        Self {
            block: [0, 1, 2].map(|axis| add(self.block[axis], scaled(other.block[axis], share))),
            free: [0, 1, 2].map(|axis| self.free[axis] || other.free[axis]),
        }
    }

    /// Its largest entry (m/N) along an axis.
    pub(super) fn largest(&self) -> f64 {
        let own = [0, 1, 2].map(|axis| self.block[axis][axis]);
        own.into_iter().fold(0.0, f64::max)
    }

    /// The displacement (m) due to a force (N).
    pub(super) fn displacement(&self, force: Vector) -> Vector {
        self.block.map(|row| dot(row, force))
    }

    /// The force (N) that causes a displacement (m) in the directions that are free, and none in the others.
    pub(super) fn force(&self, displacement: Vector) -> Vector {
        self.factor().force(displacement)
    }

    /// Its Cholesky factor, for the computation of many forces.
    pub(super) fn factor(&self) -> Stiffness {
        let mut block = self.block;
        for (axis, row) in block.iter_mut().enumerate() {
            if !self.free[axis] {
                row[axis] = 1.0;
            }
        }
        Stiffness {
            factor: Factor::of(block),
            free: self.free,
        }
    }

    /// The force (N) of one constraint: the friction cone in closed form.
    fn of_one(&self, constraint: &Constraint) -> Vector {
        self.of_one_by(|displacement| self.force(displacement), constraint)
    }

    /// The same, with `force` instead of [`Compliance::force`].
    pub(super) fn of_one_by(
        &self,
        force: impl Fn(Vector) -> Vector,
        constraint: &Constraint,
    ) -> Vector {
        let Constraint {
            normal,
            gap,
            stick,
            friction,
            swing,
        } = *constraint;
        if gap >= 0.0 {
            return [0.0; 3];
        }
        if friction > 0.0 {
            let sticking = force(stick);
            let pressing = dot(sticking, normal);
            let along = sub(sticking, scaled(normal, pressing));
            let size = length(along);
            let sticks = pressing > 0.0 && size <= friction * pressing;
            let share = if sticks { size / pressing } else { friction };
            let most = match size > 0.0 {
                true => self.most_friction(constraint, scaled(along, 1.0 / size), swing),
                false => f64::INFINITY,
            };
            if sticks && share <= most {
                return sticking;
            }
            if size > 0.0 {
                let direction = add(normal, scaled(along, share.min(most) / size));
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

    /// The largest friction in a direction across the normal, as a share of the pressure, that does no work on tissue
    /// and tool together: in staggered steps forces work at the mean of the velocities before and after, and friction
    /// against the latter alone would add energy to a motion that reverses from step to step.
    ///
    /// With the force `lambda (n + s d)` that closes the gap, `d . (swing + C lambda (n + s d))` times `n . C (n + s d)` is `before + s by`.
    fn most_friction(&self, constraint: &Constraint, direction: Vector, swing: Vector) -> f64 {
        let Constraint { normal, gap, .. } = *constraint;
        let [of_normal, of_direction] = [normal, direction].map(|of| self.displacement(of));
        let along = dot(direction, swing);
        let before = along * dot(normal, of_normal) - gap * dot(direction, of_normal);
        let by = along * dot(normal, of_direction) - gap * dot(direction, of_direction);
        if before >= 0.0 {
            0.0
        } else if by > 0.0 {
            // What sticks does so up to rounding.
            -before / by * (1.0 + 1e-9)
        } else {
            f64::INFINITY
        }
    }

    /// True if a node with this response (m/N) to a unit force moves in the direction of that force.
    fn moves(&self, response: f64) -> bool {
        response > HELD * self.largest()
    }

    /// Writes the force (N) of each constraint: for one constraint exactly, with friction; for several exactly without
    /// friction, and with friction by an iteration, whose residual is returned.
    pub(super) fn solve(&self, constraints: &[Constraint], forces: &mut [Vector; MOST]) -> f64 {
        forces.fill([0.0; 3]);
        match constraints {
            [] => 0.0,
            [one] => {
                forces[0] = self.of_one(one);
                0.0
            }
            several => {
                let left = self.of_several(several, forces);
                // If the constraints are not compatible, cones would push each other on without end.
                let rubs = several.iter().any(|one| one.friction > 0.0);
                if rubs && left <= MEANT_TO_FIT {
                    self.rub(several, forces)
                } else {
                    0.0
                }
            }
        }
    }

    /// Finds the forces (N) with friction from those without it by Gauss-Seidel iteration: each constraint exactly for
    /// the forces of the others. Returns the residual: the change of a displacement in the last sweep as a share of the
    /// largest displacement due to a force. If a node is wedged between surfaces, no such bounded forces exist: it then
    /// gets those without friction.
    fn rub(&self, constraints: &[Constraint], forces: &mut [Vector; MOST]) -> f64 {
        let (mut left, without) = (0.0, *forces);
        let stiffness = self.factor();
        for _ in 0..MOST_SWEEPS {
            let mut sum = forces.iter().copied().fold([0.0; 3], add);
            let (mut change, mut largest): (f64, f64) = (0.0, 0.0);
            for (constraint, own) in constraints.iter().zip(forces.iter_mut()) {
                let others = sub(sum, *own);
                let behind = constraint.behind(self.displacement(others));
                let force = self.of_one_by(|displacement| stiffness.force(displacement), &behind);
                change = change.max(length(self.displacement(sub(force, *own))));
                largest = largest.max(length(self.displacement(force)));
                (sum, *own) = (add(others, force), force);
            }
            left = if change > 0.0 { change / largest } else { 0.0 };
            if left <= CONVERGED {
                return left;
            }
        }
        if left > WEDGED {
            *forces = without;
        }
        left
    }

    /// The linear complementarity problem `0 <= lambda, gap + N C N' lambda >= 0`, in which at most three constraints
    /// are active in three dimensions: sets of one, two and three are tried in turn. If no point satisfies all, as
    /// between closing jaws, the one with the least violation is taken. Returns the remaining violation, as a share of
    /// that without forces.
    fn of_several(&self, constraints: &[Constraint], forces: &mut [Vector; MOST]) -> f64 {
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
        let (left, active, lambda) = best;
        for (index, lambda) in active.into_iter().zip(lambda) {
            if index < count {
                forces[index] = scaled(constraints[index].normal, lambda);
            }
        }
        if scale > 0.0 { left / scale } else { 0.0 }
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

/// `A^-1 b` of a symmetric positive definite matrix by its Cholesky factor; `None` if it is singular.
fn solved(a: [Vector; 3], b: Vector) -> Option<Vector> {
    Some(Factor::of(a)?.solve(b))
}

/// Forces from displacements: the inverse of a compliance.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stiffness {
    /// `None` if it is singular.
    factor: Option<Factor>,
    free: [bool; 3],
}

impl Stiffness {
    /// The force (N) that causes a displacement (m) in the directions that are free, and none in the others.
    pub(super) fn force(&self, displacement: Vector) -> Vector {
        let mut wanted = displacement;
        for (wanted, free) in wanted.iter_mut().zip(self.free) {
            if !free {
                *wanted = 0.0;
            }
        }
        self.factor.map_or([0.0; 3], |factor| factor.solve(wanted))
    }
}

/// Cholesky's factor of a symmetric positive definite matrix.
#[derive(Clone, Copy, Debug)]
enum Factor {
    /// The diagonal of a diagonal matrix.
    Diagonal(Vector),
    /// The lower triangle, row by row.
    Lower([f64; 6]),
}

impl Factor {
    /// The factor of a matrix; `None` if the matrix is singular.
    fn of(a: [Vector; 3]) -> Option<Self> {
        let positive = |pivot: f64, of: f64| (pivot > 1e-13 * of).then(|| pivot.sqrt());
        if [a[1][0], a[2][0], a[2][1]] == [0.0; 3] {
            let diagonal = [a[0][0], a[1][1], a[2][2]];
            let is_sound = diagonal.iter().all(|entry| *entry > 0.0);
            return is_sound.then_some(Self::Diagonal(diagonal));
        }
        let l00 = positive(a[0][0], 0.0)?;
        let (l10, l20) = (a[1][0] / l00, a[2][0] / l00);
        let l11 = positive(a[1][1] - l10 * l10, a[1][1])?;
        let l21 = (a[2][1] - l20 * l10) / l11;
        let l22 = positive(a[2][2] - l20 * l20 - l21 * l21, a[2][2])?;
        Some(Self::Lower([l00, l10, l11, l20, l21, l22]))
    }

    fn solve(self, b: Vector) -> Vector {
        let [l00, l10, l11, l20, l21, l22] = match self {
            Self::Diagonal(diagonal) => return [0, 1, 2].map(|axis| b[axis] / diagonal[axis]),
            Self::Lower(lower) => lower,
        };
        let y0 = b[0] / l00;
        let y1 = (b[1] - l10 * y0) / l11;
        let y2 = (b[2] - l20 * y0 - l21 * y1) / l22;
        let x2 = y2 / l22;
        let x1 = (y1 - l21 * x2) / l11;
        [(y0 - l10 * x1 - l20 * x2) / l00, x1, x2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::cross;

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
            swing: [0.0; 3],
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
        constraint.swing = scaled(constraint.stick, -1.0);
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

    /// Friction from the velocity after the step alone would add energy to a motion that reverses in each step.
    #[test]
    fn friction_does_no_work_whatever_the_motion_was_before() {
        let compliance = compliance([true; 3]);
        let mut limited = 0;
        for before in [-3.0, -1.1, -0.9, -0.3, 0.0, 0.4, 2.0] {
            for friction in [0.01, 0.3, 10.0, 1e6] {
                let mut constraint = plane([0.1, 0.2, 1.0], -0.01);
                constraint.stick = add(scaled(constraint.normal, 0.01), [0.002, -0.001, 0.0]);
                constraint.gap = -dot(constraint.normal, constraint.stick);
                constraint.swing = scaled(constraint.stick, -1.0 - before);
                constraint.friction = friction;
                let (moved, forces) = total(&compliance, &[constraint]);
                let normal = constraint.normal;
                let pressing = dot(forces[0], normal);
                let along = sub(forces[0], scaled(normal, pressing));
                let power = dot(along, add(constraint.swing, moved));
                assert!(power <= 1e-12, "{before} {friction}: {power}");
                assert!((dot(normal, moved) + constraint.gap).abs() < 1e-15);
                let share = length(along) / pressing;
                assert!(share <= friction * (1.0 + 1e-12));
                let sticks = length(sub(moved, constraint.stick)) < 1e-12;
                limited += i32::from(share < friction && !sticks);
            }
        }
        assert!(limited > 4, "{limited}");
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
    fn friction_at_several_surfaces_stays_in_its_cones_and_slows_what_slips() {
        let compliance = compliance([true; 3]);
        for (first, second) in [(0.3, 0.3), (0.0, 0.5), (1.0, 0.2)] {
            for side in [-0.02, 0.0, 0.004, 0.03] {
                let mut walls = [plane([1.0, 0.0, 0.1], -0.01), plane([0.1, 1.0, 0.2], -0.02)];
                for (wall, friction) in walls.iter_mut().zip([first, second]) {
                    // Where the wall was touched, so far to its side.
                    let across = cross(wall.normal, [0.0, 0.0, 1.0]);
                    wall.stick = add(scaled(wall.normal, -wall.gap), scaled(across, side));
                    wall.swing = scaled(wall.stick, -1.0);
                    wall.friction = friction;
                }
                let mut forces = [[0.0; 3]; MOST];
                let residual = compliance.solve(&walls, &mut forces);
                assert!(residual <= CONVERGED, "{first} {second} {side}: {residual}");
                let moved = compliance.displacement(forces.into_iter().fold([0.0; 3], add));
                for (wall, force) in walls.iter().zip(forces) {
                    let after = wall.behind(moved);
                    let pressing = dot(wall.normal, force);
                    let along = sub(force, scaled(wall.normal, pressing));
                    let slip = sub(
                        after.stick,
                        scaled(wall.normal, dot(wall.normal, after.stick)),
                    );
                    assert!(after.gap > -1e-14 && pressing >= 0.0);
                    assert!(after.gap * pressing < 1e-14);
                    assert!(length(along) <= wall.friction * pressing + 1e-13);
                    let sticks = length(along) < wall.friction * pressing - 1e-9;
                    assert!(!sticks || length(slip) < 1e-12, "{slip:?}");
                    assert!(dot(along, slip) >= -1e-14);
                }
            }
        }
    }

    #[test]
    fn a_node_that_is_wedged_is_pushed_without_friction_and_that_is_told() {
        let mut walls = [plane([1.0, 0.0, 0.1], -0.01), plane([0.1, 1.0, 0.2], -0.02)];
        let (expected, _) = total(&compliance([true; 3]), &walls);
        for wall in &mut walls {
            let across = cross(wall.normal, [0.0, 0.0, 1.0]);
            wall.stick = add(scaled(wall.normal, -wall.gap), scaled(across, -0.02));
            wall.swing = scaled(wall.stick, -1.0);
            wall.friction = 5.0;
        }
        let mut forces = [[0.0; 3]; MOST];
        let residual = compliance([true; 3]).solve(&walls, &mut forces);
        let (moved, _) = total(&compliance([true; 3]), &walls);
        assert!(residual > 0.01, "{residual}");
        assert_eq!(moved, expected);
    }

    #[test]
    fn between_closing_jaws_the_violation_is_not_made_worse() {
        let jaws = [
            plane([0.0, 0.0, 1.0], -0.01),
            plane([0.0, 0.0, -1.0], -0.002),
        ];
        let jaws = jaws.map(|jaw| Constraint {
            friction: 0.5,
            ..jaw
        });
        let (moved, _) = total(&compliance([true; 3]), &jaws);
        let worst = jaws
            .iter()
            .map(|jaw| -(jaw.gap + dot(jaw.normal, moved)))
            .fold(0.0, f64::max);
        assert!(worst <= 0.01 + 1e-15, "{worst}");
    }
}

//! The step of a tool that is a dynamic body.
//!
//! With d the offset from the path and w the velocity of the path, the step with tissue whose velocities are staggered
//! is `m (v+ - v-) = -dt k (d_before + 2 d + d_after)/4 - dt b ((v+ + v-)/2 - (w+ + w-)/2) + dt f`, the average
//! acceleration method (Newmark 1959) in the form of central difference, whose matrix is `P = m + dt/2 b + dt^2/4 k`.
//! It is stable at any stiffness and step, and with the mean offset `D = d + dt/2 (v+ - w+)` the energy `(m v+^2 + k
//! D^2)/2` changes by the work of the path, the dissipation of the damper, and `dt f (v+ + v-)/2`, exactly: contact
//! treats it the same as tissue. A body whose period the step does not resolve would oscillate forever from step to
//! step: it gets additional damping and mass ([`Spring`]), which keep the balance of energy.
//!
//! If the step before had another length, impulses are those of the time between the two velocities, half of each step,
//! the same as for the tissue, and `d_before` is `d - dt_before (v- - w-)`. The balance is then off by `k D (dt -
//! dt_before)(v+ - v-)/4`, of order 2, in this step only.
//!
//! With tissue whose velocities are at the ends of steps it is implicit Euler, `m (v+ - v) = -dt k d_after - dt b (v+ -
//! w+) + dt f`, of which `P = m + dt b + dt^2 k`: there contact works at `v+`, and `(m v+^2 + k d_after^2)/2` rises by
//! no more than the work of contact and of the path.
//!
//! Rotation is treated in the same way in the body's own axes, `J (W+ - W-) + dt W x J W = dt torque` with W the mean
//! of both, or the new one; the gyroscopic term has no power.

use super::record::{Body, OF_BODY};
use super::tool_body::ToolBody;
use super::twist::Twist;
use crate::pose::Pose;
use crate::vector::{Vector, add, cross, dot, scaled, sub};

/// Number of iterations for the gyroscopic term, each with the spin of the one before. Each conserves the energy.
const GYROSCOPIC: usize = 3;

/// A body during a step.
#[derive(Clone, Debug)]
pub(super) struct BodyStep {
    dt: f64,
    /// The length of the step before (s).
    dt_before: f64,
    /// The time (s) between the velocities before and after.
    kick: f64,
    is_staggered: bool,
    before: Pose,
    /// The coupling along, and about its own axes.
    spring: Spring,
    springs: [Spring; 3],
    /// Velocity before.
    last: Twist,
    /// Velocity of the path in the last step and in this one.
    path: [Twist; 2],
    /// Offset from the path before.
    offset: Twist,
    /// Velocity after the step without contact.
    free: Twist,
    /// Displacement due to contact within the step.
    pub(super) pushed: Twist,
    /// The displacement per force (m/N): `dt^2 / P`.
    along: f64,
    /// The rotation per torque (rad/(N m)) about its own axes.
    about: Vector,
}

impl BodyStep {
    /// A step of `dt` (s) after one of another length, without contact, with the poses of the path before and after it.
    pub(super) fn new(
        body: &ToolBody,
        numbers: &[f64; OF_BODY],
        path: [Pose; 2],
        ([dt_before, dt], is_staggered): ([f64; 2], bool),
    ) -> Self {
        let kick = if is_staggered {
            0.5 * (dt_before + dt)
        } else {
            dt
        };
        let now = Twist::between(&path[0], &path[1]).times(1.0 / dt);
        let (before, last, earlier) = match Body::read(numbers) {
            Some(body) => (body.pose, body.velocity, body.path),
            None => (path[0], now, now),
        };
        let ToolBody { inertia, .. } = *body;
        let damping = body.damping;
        let spring = |mass: f64, stiffness: f64| {
            let spring = Spring::new(mass, stiffness, damping);
            if is_staggered {
                spring.told_by_steps_of(dt)
            } else {
                spring
            }
        };
        let along = spring(body.mass, body.coupling);
        let about = inertia.map(|moment| spring(moment, body.rotational_coupling));
        let metric = along.metric([dt, kick], is_staggered);
        let metrics = about.map(|spring| spring.metric([dt, kick], is_staggered));
        let mut step = Self {
            dt,
            dt_before,
            kick,
            is_staggered,
            before,
            spring: along,
            springs: about,
            last,
            path: [earlier, now],
            offset: Twist::between(&path[0], &before),
            free: Twist::default(),
            pushed: Twist::default(),
            along: dt * dt / metric,
            about: metrics.map(|metric| dt * dt / metric),
        };
        // Without a change of velocity, the coupling pulls with this.
        let pull = step.coupling(last);
        let turning = before.turned_back(pull.about);
        let spin = before.turned_back(last.about);
        let share = if is_staggered { 0.5 } else { 1.0 };
        let mut change = [0.0; 3];
        for _ in 0..GYROSCOPIC {
            let turned = add(spin, scaled(change, share));
            let momentum = [0, 1, 2].map(|axis| inertia[axis] * turned[axis]);
            let torque = scaled(sub(turning, cross(spin, momentum)), kick);
            change = solved(metrics, scaled(momentum, -kick * share), torque);
        }
        step.free = Twist {
            along: add(last.along, scaled(pull.along, kick / metric)),
            about: add(last.about, before.turned(change)),
        };
        step
    }

    /// The force (N) and torque (N m) of the coupling on the body, by which a step that ends with this velocity changes it.
    fn coupling(&self, after: Twist) -> Twist {
        let [earlier, now] = self.path;
        let relative = [self.last.minus(earlier), after.minus(now)];
        let (offset, slip) = if self.is_staggered {
            let ways = relative[1]
                .times(self.dt)
                .minus(relative[0].times(self.dt_before));
            let change = ways.times(0.25);
            let slip = relative[0].plus(relative[1]).times(0.5);
            (self.offset.plus(change), slip)
        } else {
            let after = self.offset.plus(relative[1].times(self.dt));
            (after, relative[1])
        };
        let own = self.before.turned_back(slip.about);
        let damped = [0, 1, 2].map(|axis| self.springs[axis].damper * own[axis]);
        let spring = scaled(offset.about, self.springs[0].stiffness);
        Twist {
            along: scaled(
                add(
                    scaled(offset.along, self.spring.stiffness),
                    scaled(slip.along, self.spring.damper),
                ),
                -1.0,
            ),
            about: scaled(add(spring, self.before.turned(damped)), -1.0),
        }
    }

    pub(super) fn before(&self) -> Pose {
        self.before
    }

    /// The pose after the step, with the contact displacement so far.
    pub(super) fn after(&self) -> Pose {
        self.at(1.0)
    }

    /// The pose at a share of the step, with the contact displacement so far.
    pub(super) fn at(&self, share: f64) -> Pose {
        let moved = self.free.times(share * self.dt).plus(self.pushed);
        self.before.advanced(moved.along, moved.about)
    }

    /// The velocity (m/s) at an arm (m) for the work of contact: with staggered velocities the mean of this step's
    /// and the last one's.
    pub(super) fn working_velocity(&self, arm: Vector) -> Vector {
        if self.is_staggered {
            self.last.plus(self.velocity()).times(0.5).at(arm)
        } else {
            self.velocity().at(arm)
        }
    }

    /// The displacement (m) at an arm (m) in this step, without contact; in staggered steps together with that in the last one.
    pub(super) fn swing(&self, arm: Vector) -> Vector {
        let velocity = if self.is_staggered {
            self.last.plus(self.free)
        } else {
            self.free
        };
        velocity.times(self.dt).at(arm)
    }

    fn velocity(&self) -> Twist {
        self.free.plus(self.pushed.times(1.0 / self.dt))
    }

    /// Motion within the step under a force (N) at an arm (m).
    pub(super) fn response(&self, arm: Vector, force: Vector) -> Twist {
        let torque = self.before.turned_back(cross(arm, force));
        let own = [0, 1, 2].map(|axis| self.about[axis] * torque[axis]);
        Twist {
            along: scaled(force, self.along),
            about: self.before.turned(own),
        }
    }

    /// Writes the numbers that are kept after the step.
    pub(super) fn keep(&self, numbers: &mut [f64; OF_BODY]) {
        let (velocity, [earlier, now]) = (self.velocity(), self.path);
        let known = Body::read(numbers);
        let pull = self.coupling(velocity);
        let (hand, share) = if self.is_staggered {
            (earlier.plus(now).times(0.5), 0.5)
        } else {
            (now, 1.0)
        };
        let work = self.kick * pull.dot(hand);
        let offset = velocity.minus(now).times(self.dt * share).plus(self.offset);
        let spin = self.before.turned_back(velocity.about);
        let turning: f64 = (0..3)
            .map(|axis| self.springs[axis].mass * spin[axis].powi(2))
            .sum();
        let stretched = self.spring.stiffness * dot(offset.along, offset.along)
            + self.springs[0].stiffness * dot(offset.about, offset.about);
        let kinetic = self.spring.mass * dot(velocity.along, velocity.along) + turning;
        Body {
            pose: self.after(),
            velocity,
            path: now,
            energy: 0.5 * (kinetic + stretched),
            hand_work: known.map_or(0.0, |known| known.hand_work) + work,
        }
        .write(numbers);
    }
}

/// A mass, or a moment of inertia, on a spring and a damper: in units of kg, N/m and N s/m, or kg m^2, N m/rad and N m s/rad.
#[derive(Clone, Copy, Debug)]
struct Spring {
    mass: f64,
    stiffness: f64,
    damper: f64,
}

impl Spring {
    /// A spring with damping as a share of critical damping.
    fn new(mass: f64, stiffness: f64, damping: f64) -> Self {
        let damper = 2.0 * damping * (stiffness * mass).sqrt();
        Self {
            mass,
            stiffness,
            damper,
        }
    }

    /// A spring that staggered steps of `dt` (s) bring to rest, where they would otherwise oscillate forever.
    ///
    /// With x the frequency times the step, its damping grows by `dt k x^2/(1 + x^2)`, a share `x^3/2` of critical
    /// damping at small x, so that the method stays of order 2. Its mass grows until the damper just stops it within
    /// a step, `P = dt b`: not at all for x below 2 and weak damping.
    fn told_by_steps_of(self, dt: f64) -> Self {
        let stiff = dt * dt * self.stiffness;
        let damper = match stiff > 0.0 {
            true => self.damper + self.stiffness * dt * (stiff / (self.mass + stiff)),
            false => self.damper,
        };
        let least = dt / 2.0 * damper - stiff / 4.0;
        Self {
            mass: self.mass.max(least),
            damper,
            ..self
        }
    }

    /// Effective mass by which impulses are divided, in a step of `dt` (s) with a time `kick` (s) between the
    /// velocities before and after.
    fn metric(&self, [dt, kick]: [f64; 2], is_staggered: bool) -> f64 {
        let Self {
            mass,
            stiffness,
            damper,
        } = *self;
        let share = if is_staggered { 0.5 } else { 1.0 };
        mass + share * kick * (damper + share * dt * stiffness)
    }
}

/// The solution x of `D x + s x x = b`, D being a diagonal matrix of positive numbers, by its adjugate: the determinant is `det D + s' D s`, which is positive too.
fn solved(diagonal: Vector, skew: Vector, b: Vector) -> Vector {
    let [p, q, r] = diagonal;
    let weighted = [0, 1, 2].map(|axis| diagonal[axis] * skew[axis]);
    let determinant = p * q * r + dot(skew, weighted);
    let others = [q * r * b[0], p * r * b[1], p * q * b[2]];
    let along = scaled(skew, dot(skew, b));
    let turned = cross(weighted, b);
    let sum = sub(add(others, along), turned);
    scaled(sum, 1.0 / determinant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::length;

    #[test]
    fn a_diagonal_with_a_skew_part_is_solved() {
        let (d, s, b) = ([2.0, 3.0, 5.0], [0.3, -0.7, 1.1], [1.0, -2.0, 0.5]);
        let x = solved(d, s, b);
        let back = add([0, 1, 2].map(|axis| d[axis] * x[axis]), cross(s, x));
        assert!(length(sub(back, b)) < 1e-15, "{back:?}");
    }
}

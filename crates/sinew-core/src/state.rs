//! The state of a simulation.

use std::borrow::Cow;

use crate::clock::Clock;
use crate::load_time::LoadTime;
use crate::revision::Revision;

/// Displacement and velocity of a system: free degrees of freedom only, node-major (x y z).
///
/// A plain value: a clone is a checkpoint, and a run continued from a clone with a fresh integrator is bit-identical.
/// It therefore carries everything that a method must keep.
///
/// Two states are equal if all that determines the motion is equal; the identity of the loads
/// does not count.
#[derive(Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State {
    /// Time of `u`.
    pub clock: Clock,
    /// Displacement (m).
    pub u: Vec<f64>,
    /// Velocity (m/s), at the time given by `velocity`.
    pub v: Vec<f64>,
    /// The velocity's time.
    pub velocity: VelocityTime,
    /// Times at which damping takes velocities.
    pub damped: DampedAt,
    /// Acceleration (m/s^2), of the kind given by `acceleration`; work space otherwise.
    pub a: Vec<f64>,
    /// Kind of acceleration in `a`.
    pub acceleration: Acceleration,
    /// Internal variables of laws with memory, in an order that the system knows; empty for
    /// elastic ones.
    pub internal: Vec<f64>,
    /// History variables of contact, in an order defined by [`crate::Contact`]; empty if nothing touches the body.
    pub contact: Vec<f64>,
    /// Identity of the matrices and the loads under which the last step was taken. It is not written with serde.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub loads: Option<[Revision; 2]>,
    /// Start of the motion, for a guarded method that bounds velocities by its energy; `None` until
    /// then. Set it to `None` after changing `u` or `v` directly. It is not written with serde.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub start: Option<Start>,
    /// The division of steps into substeps by the current stiffness, for methods that use it.
    pub cut: Option<StepCut>,
    /// Two fields over all degrees of freedom that approximate the body's fastest mode, if it determines the substeps
    /// ([`crate::spectrum::follow_largest_eigenvalue`]); empty otherwise.
    pub fastest: Vec<f64>,
}

/// The division of steps into substeps by the current stiffness of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepCut {
    /// Number of substeps of a step.
    pub parts: u32,
    /// Substeps taken since the stable step was found; with stiffness damping, since the quantities that no product
    /// gives were found.
    pub taken: u32,
    /// The stable step (s) that was found last.
    pub stable_step: f64,
    /// The square (1/s^2) of the fastest wave ([`crate::ElasticLaw::fastest_wave`]) at the time the stable step was
    /// found; 0 if the law gives none.
    pub wave: f64,
    /// The square (1/s^2) of the fastest wave at the last check.
    pub seen: f64,
    /// The largest eigenvalue of `M^-1 D` over that of `M^-1 K` (s), D being the damping without the mass-proportional
    /// part, at that time.
    pub damping: f64,
    /// The largest number of substeps that one of the last steps needed.
    pub needed: u32,
    /// Number of these steps.
    pub steps: u32,
}

impl StepCut {
    /// False for a division that no method produces.
    #[cfg(feature = "serde")]
    pub(crate) fn is_sound(self) -> bool {
        let Self {
            parts,
            taken: _,
            stable_step,
            wave,
            seen,
            damping,
            needed,
            steps: _,
        } = self;
        parts > 0 && needed > 0 && stable_step > 0.0 && wave >= 0.0 && seen >= 0.0 && damping >= 0.0
    }
}

impl Clone for State {
    fn clone(&self) -> Self {
        let mut clone = Self::new(Vec::new(), Vec::new());
        clone.clone_from(self);
        clone
    }

    /// Takes over another state without allocating if the capacity suffices.
    fn clone_from(&mut self, other: &Self) {
        let Self {
            clock,
            u,
            v,
            velocity,
            damped,
            a,
            acceleration,
            internal,
            contact,
            loads,
            start,
            cut,
            fastest,
        } = other;
        self.u.clone_from(u);
        self.v.clone_from(v);
        self.a.clone_from(a);
        self.internal.clone_from(internal);
        self.contact.clone_from(contact);
        self.fastest.clone_from(fastest);
        (self.clock, self.loads, self.start, self.cut) = (*clock, *loads, *start, *cut);
        (self.velocity, self.damped) = (*velocity, *damped);
        self.acceleration = *acceleration;
    }
}

impl PartialEq for State {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            clock,
            u,
            v,
            velocity,
            damped,
            a,
            acceleration,
            internal,
            contact,
            loads: _,
            start,
            cut,
            fastest,
        } = self;
        (clock, velocity, damped, acceleration, start, cut)
            == (
                &other.clock,
                &other.velocity,
                &other.damped,
                &other.acceleration,
                &other.start,
                &other.cut,
            )
            && (u, v, a) == (&other.u, &other.v, &other.a)
            && (internal, contact, fastest) == (&other.internal, &other.contact, &other.fastest)
    }
}

/// Time of a state's velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum VelocityTime {
    /// The displacement's time.
    Same,
    /// The middle of the last step: staggered methods.
    MiddleOfStep,
    /// The mean over the last step, which does not resolve the fastest motions, so that the velocity at any instant is
    /// unknown.
    MeanOverStep,
}

/// Offsets, in steps, of the times at which a method's damping uses velocities when the forces of a state are
/// evaluated.
///
/// First-order methods combine displacements per time of two steps; the damping force on supports is that of this
/// pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DampedAt {
    /// Offset for cells, after the velocity's own time: more than 0 if a state keeps the acceleration of the last kick
    /// and damping lags by less than a whole step.
    pub cells: f64,
    /// Offset for moving supports, after the displacement's time: -1/2 means their displacement over the last step, 1/2
    /// that over the next.
    pub supports: f64,
}

impl DampedAt {
    /// Damping by the velocities at the end of a step, which are the step's displacement over its length.
    pub const WAY_OF_STEP: Self = Self::supports(-0.5);

    /// Damping of a leapfrog that keeps the acceleration of its last kick, of which it takes this share at the displacement's time.
    #[must_use]
    pub const fn centred(share: f64) -> Self {
        Self {
            cells: 0.5 * share,
            supports: 0.0,
        }
    }

    /// Damping by the velocity that a state has, and that of supports `steps` steps after the displacement's time.
    #[must_use]
    pub const fn supports(steps: f64) -> Self {
        Self {
            cells: 0.0,
            supports: steps,
        }
    }
}

/// Kind of acceleration that a state keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Acceleration {
    /// No acceleration.
    None,
    /// The acceleration at the displacement's time, under the loads at the end of the last step.
    Same,
    /// The acceleration of the last kick, which produced a velocity in the middle of the last step.
    Kick,
}

/// Start of a motion, whose energy bounds velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The system in which it began; in another system the motion begins again.
    pub system: Revision,
    /// Kinetic and elastic energy (J).
    pub energy: f64,
}

impl State {
    /// A state at rest, undeformed, at t = 0.
    #[must_use]
    pub fn at_rest(dofs: usize) -> Self {
        Self::new(vec![0.0; dofs], vec![0.0; dofs])
    }

    /// A state with this displacement (m) and velocity (m/s) at t = 0.
    #[must_use]
    pub fn new(u: Vec<f64>, v: Vec<f64>) -> Self {
        Self {
            clock: Clock::at(0.0),
            u,
            v,
            velocity: VelocityTime::Same,
            damped: DampedAt::default(),
            a: Vec::new(),
            acceleration: Acceleration::None,
            internal: Vec::new(),
            contact: Vec::new(),
            loads: None,
            start: None,
            cut: None,
            fastest: Vec::new(),
        }
    }

    /// Time of the displacement (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.clock.time()
    }

    /// True if a staggered method has taken the last step, of `dt` (s), and can continue with another.
    #[must_use]
    pub fn is_staggered_by(&self, dt: f64) -> bool {
        self.velocity != VelocityTime::Same && self.clock.last_step() == Some(dt)
    }

    /// The displacement (m) and velocity (m/s) that damping uses when the method computes the forces of this state,
    /// with the time for the positions and speeds of supports.
    #[must_use]
    pub fn damping(&self) -> (Cow<'_, [f64]>, Cow<'_, [f64]>, LoadTime<'static>) {
        let (u, v) = (Cow::Borrowed(&self.u[..]), Cow::Borrowed(&self.v[..]));
        let (t, Some(dt)) = (self.t(), self.clock.last_step()) else {
            return (u, v, LoadTime::at(self.t()));
        };
        let DampedAt { cells, supports } = self.damped;
        let moved = |from: &[f64], by: &[f64], time: f64| -> Cow<'_, [f64]> {
            let values = from.iter().zip(by);
            values.map(|(from, by)| from + time * by).collect()
        };
        let v = match cells {
            0.0 => v,
            _ => moved(&self.v, &self.a, cells * dt),
        };
        match supports {
            0.0 => (u, v, LoadTime::around(t, dt.min(t), dt)),
            _ => {
                let back = supports.min(0.0) * dt;
                let from = t + (supports - 0.5) * dt;
                let u = match back {
                    0.0 => u,
                    _ => moved(&self.u, &self.v, back),
                };
                (u, v, LoadTime::mean_at(t + back, from, dt))
            }
        }
    }

    /// Ends a step of `dt` (s) that moved `u` and `v` to the same time and keeps no acceleration.
    pub fn advance(&mut self, dt: f64) {
        self.end_step(dt, VelocityTime::Same, Acceleration::None);
    }

    /// Ends a step of `dt` (s).
    pub fn end_step(&mut self, dt: f64, velocity: VelocityTime, acceleration: Acceleration) {
        self.clock.advance(dt);
        self.velocity = velocity;
        self.damped = DampedAt::default();
        self.acceleration = acceleration;
    }
}

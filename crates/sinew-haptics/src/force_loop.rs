//! The force on a device at each of its ticks.

use sinew_tools::vector::{Vector, add, dot, length, scaled, sub};

use crate::coupling::{Coupling, CouplingError, DeviceLimits};
use crate::local_model::LocalModel;
use crate::published::Published;

/// Energy (J) that a device is granted before it has supplied any: without it no first force could ever be rendered.
const LENT: f64 = 5e-7;

/// Energy (J) that is kept in reserve for a device that yields: without it, no force could ever grow again.
const KEPT: f64 = 0.5 * LENT;

/// Largest displacement of a device in the next tick, over that in the last one.
const MOST_FASTER: f64 = 1.5;

/// Bound of the energy in the tissue, over its energy as a spring; under the law of Hertz it is 1.2 times as much.
const TISSUE: f64 = 2.0;

/// The loop that renders forces at the rate of a device, from the data that a slower simulation publishes.
///
/// It never waits and reads no clock: each tick takes the position of the device and returns the force until the next.
/// Between two steps the tool is at the equilibrium of the coupling and the tissue of the last step, taken as a spring.
/// Changes by a new step are blended in linearly, over the time of one step.
///
/// The device never receives more energy than it has supplied: the coupling is stretched only as far as that energy
/// allows, for any published data and any delay of the simulation. This is the passive set-position modulation of Lee
/// and Huang (IEEE Transactions on Robotics 26, 2010) with the work of the held force computed from positions
/// (Hannaford and Ryu, IEEE Transactions on Robotics and Automation 18, 2002), which is exact at any tick.
#[derive(Clone, Debug)]
pub struct ForceLoop {
    coupling: Coupling,
    device: DeviceLimits,
    model: LocalModel,
    /// Distance vector (m) between the rendered tool and the position that a new step gave it.
    offset: Vector,
    /// Ticks that the offset takes to vanish, and those since the last step was received.
    blend: [u32; 2],
    /// Position (m) of the device at the last tick, from the first on.
    last: Option<Vector>,
    /// Vector from the device to the tool (m).
    stretched: Vector,
    force: Vector,
    /// Energy (J) that the device has supplied and may take out again.
    energy: f64,
    reserve: f64,
    is_limited: bool,
}

impl ForceLoop {
    /// A loop for a device, with the tool before the first step.
    ///
    /// # Errors
    /// [`CouplingError`] for a coupling that the device cannot render.
    pub fn new(
        coupling: Coupling,
        device: DeviceLimits,
        first: &Published,
    ) -> Result<Self, CouplingError> {
        coupling.check(&device)?;
        Ok(Self {
            coupling,
            device,
            model: LocalModel::of(first),
            offset: [0.0; 3],
            blend: [1, 1],
            last: None,
            stretched: [0.0; 3],
            force: [0.0; 3],
            energy: LENT,
            reserve: 0.5 * coupling.stiffness * 1e-6,
            is_limited: false,
        })
    }

    /// Limits the stored energy (J) in excess of that in coupling and tissue, initially to that of a coupling stretched
    /// by 1 mm: the energy that tissue has dissipated must not come back if a simulation is wrong.
    #[must_use]
    pub fn with_reserve(self, reserve: f64) -> Self {
        Self { reserve, ..self }
    }

    /// Receives the result of a step.
    pub fn take(&mut self, published: &Published) {
        self.model = LocalModel::of(published);
        let ticks = (published.dt / self.device.tick).round().max(1.0);
        self.blend = [ticks as u32, 0];
        if let Some(last) = self.last {
            let shown = add(last, self.stretched);
            self.offset = sub(shown, self.model.tool(self.coupling.stiffness, last));
        }
    }

    /// The force (N) on the device at this position (m), until the next tick; 0 if the position is not finite.
    pub fn tick(&mut self, position: Vector) -> Vector {
        let Coupling { stiffness, damping } = self.coupling;
        if !position.iter().all(|value| value.is_finite()) {
            // What the last force has done is not known.
            self.energy = self.energy.min(KEPT);
            (self.last, self.stretched, self.force) = (None, [0.0; 3], [0.0; 3]);
            return self.force;
        }
        let last = self.last.replace(position).unwrap_or(position);
        let by = sub(position, last);
        self.energy -= dot(self.force, by);

        let [ticks, since] = &mut self.blend;
        *since = since.saturating_add(1);
        let left = 1.0 - f64::from(*since.min(ticks)) / f64::from(*ticks);
        let tool = self.model.tool(stiffness, position);
        let wanted = sub(add(tool, scaled(self.offset, left)), position);
        let longest = (2.0 * self.energy.max(0.0) / stiffness).sqrt();
        self.stretched = shortened(wanted, longest);

        // Its rate by the motion of the device alone: what a new step changes is no motion.
        let before = sub(self.model.tool(stiffness, last), last);
        let rate = scaled(sub(sub(tool, position), before), 1.0 / self.device.tick);
        let force = add(scaled(self.stretched, stiffness), scaled(rate, damping));
        let affordable = self.affordable(dot(force, by) < 0.0, length(by));
        self.force = shortened(force, affordable.min(self.device.largest_force));
        self.is_limited = self.stretched != wanted || self.force != force;

        let spring = scaled(self.stretched, stiffness);
        let held = 0.5 * dot(spring, self.stretched) + TISSUE * self.model.energy(spring);
        self.energy = self.energy.min(held + self.reserve);
        self.force
    }

    /// The largest force (N) until the next tick that the energy allows, if the device moves along it by up to 1.5
    /// times its last displacement (m). A force that resists a motion may be as large as that of the damper, whose
    /// energy the motion itself supplies: so a deficit, for example after a late update of the force, is compensated.
    fn affordable(&self, resists: bool, moved: f64) -> f64 {
        let Self { device, energy, .. } = self;
        let way = MOST_FASTER * moved + device.resolution;
        let of = |energy: f64| energy.max(0.0) / way;
        match resists {
            true if moved > 2.0 * device.resolution => {
                of(*energy).max(self.coupling.damping * moved / device.tick)
            }
            true => of(*energy),
            false => of(energy - KEPT),
        }
    }

    /// The force (N) that is rendered now.
    #[must_use]
    pub fn force(&self) -> [f64; 3] {
        self.force
    }

    /// Position (m) of the tool that the user feels.
    #[must_use]
    pub fn tool(&self) -> [f64; 3] {
        add(self.last.unwrap_or_default(), self.stretched)
    }

    /// The energy (J) that the device may take out.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// True if the last force is below that of coupling and tissue, because the device has not supplied the energy or
    /// is not strong enough.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.is_limited
    }

    /// Ticks by which the next step is late: the number of ticks since the last one was received, beyond its own
    /// length.
    #[must_use]
    pub fn late(&self) -> u32 {
        let [ticks, since] = self.blend;
        since.saturating_sub(ticks)
    }
}

/// A vector, shortened to this length if it is longer.
fn shortened(vector: Vector, longest: f64) -> Vector {
    let size = length(vector);
    if size > longest {
        scaled(vector, longest / size)
    } else {
        vector
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEVICE: DeviceLimits = DeviceLimits {
        tick: 1e-3,
        damping: 5.0,
        resolution: 25e-6,
        largest_force: 6.0,
    };

    /// A wall at z = 0 of this stiffness (N/m), pressed with a force (N).
    fn wall(stiffness: f64, force: f64) -> Published {
        let mut wall = Published::free_at([0.0, 0.0, -force / stiffness]);
        (wall.dt, wall.force[2]) = (0.01, force);
        wall.stiffness[2][2] = stiffness;
        wall
    }

    /// A device that has gone down to a depth (m) of a wall.
    fn pressing(stiffness: f64, depth: f64) -> ForceLoop {
        let coupling = Coupling::of(1000.0, &DEVICE);
        let mut forces = ForceLoop::new(coupling, DEVICE, &wall(stiffness, 1e-6)).unwrap();
        go(&mut forces, 0.0, -depth);
        forces
    }

    /// Moves from a height (m) to another at 75 mm/s.
    fn go(forces: &mut ForceLoop, from: f64, to: f64) {
        let ticks = ((to - from).abs() / 75e-6).round();
        for tick in 1..=ticks as u32 {
            let share = f64::from(tick) / ticks;
            forces.tick([0.0, 0.0, from + share * (to - from)]);
        }
    }

    #[test]
    fn springs_in_series_are_felt_at_once() {
        // 250 N/m behind 1000 N/m, less the little that was not paid for.
        let mut forces = pressing(250.0, 0.01);
        forces.tick([0.0, 0.0, -0.01]);
        let expected = 200.0 * 0.01;
        assert!(
            (forces.force()[2] / expected - 1.0).abs() < 0.03,
            "{forces:?}"
        );
    }

    #[test]
    fn what_a_step_changes_is_felt_within_its_time() {
        let mut forces = pressing(250.0, 0.01);
        let at = [0.0, 0.0, -0.01];
        let mut before = forces.tick(at)[2];
        // Softer by a tenth: no energy is needed.
        forces.take(&wall(225.0, 1e-6));
        let all = before - 0.01 / (1.0 / 225.0 + 1.0 / 1000.0);
        for tick in 1..=10 {
            let force = forces.tick(at)[2];
            let change = (before - force) / all;
            assert!((change - 0.1).abs() < 0.01, "{tick}: {change}");
            before = force;
        }
        assert_eq!((forces.tick(at)[2], forces.late()), (before, 1));
    }

    #[test]
    fn no_force_is_stronger_than_the_device() {
        let forces = pressing(1e6, 0.02);
        assert_eq!(forces.force()[2], DEVICE.largest_force);
        assert!(forces.is_limited());
    }

    #[test]
    fn a_debt_is_worked_off_by_pressing() {
        let mut forces = pressing(1e6, 0.002);
        // A force that is held while the handle goes far away, as where the computer was busy.
        forces.tick([0.0, 0.0, 0.001]);
        assert!(forces.energy() < -1e-3, "{forces:?}");
        for _ in 0..20 {
            go(&mut forces, 0.001, -0.003);
            go(&mut forces, -0.003, 0.001);
        }
        go(&mut forces, 0.001, -0.003);
        assert!(forces.energy() > 0.0, "{forces:?}");
        assert!(forces.force()[2] > 1.0, "{forces:?}");
    }

    #[test]
    fn a_position_or_a_step_that_is_no_number_gives_no_force() {
        let mut forces = pressing(250.0, 0.01);
        assert_eq!(forces.tick([0.0, f64::NAN, -0.01]), [0.0; 3]);
        assert!(forces.tick([0.0, 0.0, -0.01])[2].is_finite());
        let mut nothing = wall(250.0, 1.0);
        nothing.stiffness[0][1] = f64::NAN;
        nothing.force[1] = f64::NAN;
        forces.take(&nothing);
        for _ in 0..20 {
            forces.tick([0.0, 0.0, -0.01]);
        }
        assert_eq!(forces.force(), [0.0; 3]);
    }
}

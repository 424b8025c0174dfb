//! The virtual coupling between a device and a tool, and the limits of the device.

/// A spring and a damper between a device and the tool of a simulation: the only thing that the device feels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Damping (N s/m).
    pub damping: f64,
}

/// Capabilities of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceLimits {
    /// Time (s) for which a force is constant: one tick.
    pub tick: f64,
    /// Lower bound of the damping (N s/m) of the device together with the user's hand.
    pub damping: f64,
    /// The smallest displacement (m) that it measures.
    pub resolution: f64,
    /// The largest force (N) that it can render.
    pub largest_force: f64,
}

/// A coupling that a device cannot render.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CouplingError {
    /// A number out of range.
    #[error("{name} = {value}: expected a finite number above 0")]
    Number {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// An invalid damping.
    #[error("damping of the coupling = {0} N s/m: expected a finite number, 0 or above")]
    Damping(f64),
    /// A coupling that would create energy in each tick.
    #[error(
        "a coupling of {stiffness} N/m and {damping} N s/m on a device with {device} N s/m and ticks of {tick} s: its forces would be held so long that they drive \
         the device; it has to be below {largest} N/m with this damping"
    )]
    TooStiff {
        /// Its stiffness (N/m).
        stiffness: f64,
        /// Its damping (N s/m).
        damping: f64,
        /// Damping of the device (N s/m).
        device: f64,
        /// A tick (s).
        tick: f64,
        /// The stiffness (N/m) below which it must be with that damping; 0 if no stiffness is possible.
        largest: f64,
    },
}

impl Coupling {
    /// A coupling of this stiffness k (N/m) with the damping `B = k T`: twice the damping that is lost by the
    /// zero-order hold of the spring's force for a tick T.
    ///
    /// [`Self::check`] accepts it for `k < 2 b/(3 T)`, where b is the damping of the device.
    #[must_use]
    pub fn of(stiffness: f64, device: &DeviceLimits) -> Self {
        Self {
            stiffness,
            damping: stiffness * device.tick,
        }
    }

    /// The stiffness (N/m) below which a device renders a coupling of this damping, `2 (b - |B|)/T`; 0 if it renders
    /// none. The bound itself is refused.
    ///
    /// From `b > k T/2 + |B|`: Colgate and Schenkel, Passivity of a class of sampled-data systems (Journal of Robotic
    /// Systems 14, 1997), for a spring k and a damper B whose force is held for T on a device with the damping b.
    #[must_use]
    pub fn largest_stiffness(&self, device: &DeviceLimits) -> f64 {
        (2.0 * (device.damping - self.damping.abs()) / device.tick).max(0.0)
    }

    /// Checks all numbers, and the bound of [`Self::largest_stiffness`].
    ///
    /// # Errors
    /// [`CouplingError`] for a coupling that the device cannot render, with the stiffness below which it can.
    pub fn check(&self, device: &DeviceLimits) -> Result<(), CouplingError> {
        for (name, value) in [
            ("stiffness of the coupling", self.stiffness),
            ("tick of the device", device.tick),
            ("damping of the device", device.damping),
            ("resolution of the device", device.resolution),
            ("largest force of the device", device.largest_force),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(CouplingError::Number { name, value });
            }
        }
        if !(self.damping.is_finite() && self.damping >= 0.0) {
            return Err(CouplingError::Damping(self.damping));
        }
        let largest = self.largest_stiffness(device);
        if self.stiffness >= largest {
            return Err(CouplingError::TooStiff {
                stiffness: self.stiffness,
                damping: self.damping,
                device: device.damping,
                tick: device.tick,
                largest,
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEVICE: DeviceLimits = DeviceLimits {
        tick: 1e-3,
        damping: 1.0,
        resolution: 25e-6,
        largest_force: 10.0,
    };

    #[test]
    fn a_device_of_1_ns_per_m_at_1_khz_renders_less_than_2000_n_per_m() {
        let spring = |stiffness: f64| Coupling {
            stiffness,
            damping: 0.0,
        };
        assert_eq!(spring(1999.0).check(&DEVICE), Ok(()));
        let refused = spring(2000.0).check(&DEVICE).unwrap_err().to_string();
        assert!(refused.contains("below 2000 N/m"), "{refused}");
        // Its own damper takes a share.
        let damped = Coupling {
            stiffness: 1000.0,
            damping: 0.6,
        };
        assert_eq!(damped.largest_stiffness(&DEVICE), 800.0);
        assert!(damped.check(&DEVICE).is_err());
    }

    #[test]
    fn a_coupling_with_its_own_damping_is_below_two_thirds_of_b_over_t() {
        assert_eq!(Coupling::of(666.0, &DEVICE).check(&DEVICE), Ok(()));
        assert!(Coupling::of(667.0, &DEVICE).check(&DEVICE).is_err());
    }

    #[test]
    fn numbers_that_are_none_are_refused_by_name() {
        for (coupling, device, name) in [
            ((0.0, 0.0), DEVICE, "stiffness of the coupling"),
            ((f64::NAN, 0.0), DEVICE, "stiffness of the coupling"),
            ((10.0, -1.0), DEVICE, "damping of the coupling"),
            (
                (10.0, 0.0),
                DeviceLimits {
                    tick: 0.0,
                    ..DEVICE
                },
                "tick",
            ),
            (
                (10.0, 0.0),
                DeviceLimits {
                    resolution: f64::INFINITY,
                    ..DEVICE
                },
                "resolution",
            ),
        ] {
            let (stiffness, damping) = coupling;
            let coupling = Coupling { stiffness, damping };
            let refused = coupling.check(&device).unwrap_err().to_string();
            assert!(refused.contains(name), "{refused}");
        }
    }
}

//! The three lights of a pane: bounded, settles, error.

/// Colour of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Colour {
    /// Not measured.
    Grey,
    /// Good.
    Green,
    /// Acceptable with restrictions.
    Amber,
    /// Bad.
    Red,
}

/// A light with the number of its reason, for which the page has a text (`page/src/lights.js`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Light {
    pub(crate) colour: Colour,
    pub(crate) reason: u32,
}

impl Light {
    const fn new(colour: Colour, reason: u32) -> Self {
        Self { colour, reason }
    }

    /// Nothing measured.
    pub(crate) const GREY: Self = Self::new(Colour::Grey, 0);
}

/// Tolerance of energy above the supplied energy, over the largest energy so far: rounding, and the difference between
/// energies half a step apart.
const SLACK: f64 = 0.05;

/// Data from which the light for a bounded motion is derived.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounds {
    /// True if it stopped with an error.
    pub(crate) stopped: bool,
    /// True if velocities were at their limit.
    pub(crate) is_saturated: bool,
    /// Number of inverted tetrahedra.
    pub(crate) inverted: u32,
    /// True if parts or surfaces of the body overlap.
    pub(crate) overlaps: bool,
    /// Energy minus the supplied energy (J), NaN if unknown, and the largest energy or work so far (J).
    pub(crate) balance: f64,
    pub(crate) scale: f64,
}

impl Bounds {
    pub(crate) fn light(&self) -> Light {
        if self.stopped {
            Light::new(Colour::Red, 4)
        } else if self.balance.is_nan() {
            Light::GREY
        } else if self.balance > SLACK * self.scale {
            Light::new(Colour::Red, 3)
        } else if self.is_saturated {
            Light::new(Colour::Amber, 2)
        } else if self.inverted > 0 {
            Light::new(Colour::Amber, 5)
        } else if self.overlaps {
            Light::new(Colour::Amber, 6)
        } else {
            Light::new(Colour::Green, 1)
        }
    }
}

/// Length (s) of the spans over which kinetic energy is averaged.
const SPAN: f64 = 0.25;

/// Share of the largest mean of kinetic energy below which a motion has come to rest.
const RESTS: f64 = 1e-3;

/// Simulated time (s) after which a motion with constant amplitude counts as not settling.
const PATIENCE: f64 = 3.0;

/// Detection of a body's rest after the user's last action or the last cut.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Settling {
    /// Simulated time (s) of the last disturbance: a steered tool, a command or a cut.
    since: f64,
    span_began: f64,
    sum: f64,
    time: f64,
    /// Mean kinetic energy of the last whole span and of the one before.
    means: [f64; 2],
    spans: u32,
    largest: f64,
}

impl Settling {
    /// Records a disturbance at a time (s).
    pub(crate) fn disturbed(&mut self, t: f64) {
        let largest = self.largest;
        *self = Self {
            since: t,
            span_began: t,
            largest,
            ..Self::default()
        };
    }

    /// Records a step of `dt` that ended at `t` (s) with a kinetic energy (J).
    pub(crate) fn step(&mut self, t: f64, dt: f64, kinetic: f64) {
        self.sum += dt * kinetic;
        self.time += dt;
        if t - self.span_began >= SPAN {
            let mean = self.sum / self.time;
            self.means = [mean, self.means[0]];
            self.largest = self.largest.max(mean);
            self.spans += 1;
            (self.span_began, self.sum, self.time) = (t, 0.0, 0.0);
        }
    }

    /// Kinetic energy of the last span over that of the one before; NaN before there are two.
    pub(crate) fn ratio(&self) -> f64 {
        match self.spans {
            0 | 1 => f64::NAN,
            _ if self.means[1] == 0.0 => 0.0,
            _ => self.means[0] / self.means[1],
        }
    }

    pub(crate) fn light(&self, t: f64) -> Light {
        if self.spans < 2 {
            Light::GREY
        } else if self.means[0] <= RESTS * self.largest {
            Light::new(Colour::Green, 1)
        } else if self.ratio() < 0.9 {
            Light::new(Colour::Amber, 2)
        } else if t - self.since > PATIENCE || self.ratio().is_nan() {
            Light::new(Colour::Red, 3)
        } else {
            Light::new(Colour::Amber, 2)
        }
    }
}

/// The light of a relative error.
pub(crate) fn error_light(error: f64) -> Light {
    match error {
        _ if error.is_nan() => Light::GREY,
        _ if error < 0.05 => Light::new(Colour::Green, 1),
        _ if error < 0.2 => Light::new(Colour::Amber, 2),
        _ => Light::new(Colour::Red, 3),
    }
}

/// Colours, two bits each, and reasons, eight bits each.
pub(crate) fn packed(lights: [Light; 3]) -> (u32, u32) {
    let shifted = (0..).zip(lights);
    shifted.fold((0, 0), |(colours, reasons), (place, light)| {
        (
            colours | (light.colour as u32) << (2 * place),
            reasons | light.reason << (8 * place),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_green_before_it_was_measured() {
        assert_eq!(Settling::default().light(0.0), Light::GREY);
        assert_eq!(error_light(f64::NAN), Light::GREY);
        let of_no_energy = Bounds {
            balance: f64::NAN,
            ..Bounds::default()
        };
        assert_eq!(of_no_energy.light(), Light::GREY);
        assert_eq!(packed([Light::GREY; 3]), (0, 0));
    }

    #[test]
    fn energy_that_nobody_put_in_is_red() {
        let bounds = |balance| Bounds {
            balance,
            scale: 1.0,
            ..Bounds::default()
        };
        assert_eq!(bounds(-0.5).light().colour, Colour::Green);
        assert_eq!(bounds(0.01).light().colour, Colour::Green);
        assert_eq!(bounds(0.3).light().colour, Colour::Red);
        assert_eq!(bounds(f64::INFINITY).light().colour, Colour::Red);
    }

    /// The page's words for the reasons of a light, in the order of their numbers.
    fn words_of(light: usize) -> Vec<&'static str> {
        let script = include_str!("../../page/src/lights.js");
        let (_, lists) = script.split_once("const reasons = [\n").unwrap();
        let (lists, _) = lists.split_once("\n  ];").unwrap();
        let list = lists.split("    [\n").nth(light + 1).unwrap();
        let words = list.lines().map(str::trim);
        words.take_while(|line| *line != "],").collect()
    }

    fn has_words(light: usize, found: Light, expected: &str) {
        let words = words_of(light)[found.reason as usize];
        assert!(words.contains(expected), "{found:?}: {words}");
    }

    #[test]
    fn the_page_has_the_words_of_each_reason() {
        let bounds = Bounds {
            scale: 1.0,
            ..Bounds::default()
        };
        for (bounds, expected) in [
            (bounds, "no more energy"),
            (
                Bounds {
                    is_saturated: true,
                    ..bounds
                },
                "at their limit",
            ),
            (
                Bounds {
                    balance: 1.0,
                    ..bounds
                },
                "more energy than anybody",
            ),
            (
                Bounds {
                    stopped: true,
                    ..bounds
                },
                "stopped",
            ),
            (
                Bounds {
                    inverted: 1,
                    ..bounds
                },
                "inside out",
            ),
            (
                Bounds {
                    overlaps: true,
                    ..bounds
                },
                "in each other",
            ),
        ] {
            has_words(0, bounds.light(), expected);
        }
        for (decay, expected) in [
            (-2.0, "came to rest"),
            (-0.7, "still swings"),
            (0.0, "does not come to rest"),
        ] {
            has_words(1, watched(decay), expected);
        }
        for light in 0..3 {
            has_words(light, Light::GREY, "not measured");
        }
        // The error is reported by its number, whatever the colour.
        let largest = error_light(1.0).reason as usize;
        assert_eq!(words_of(2).len(), largest + 1);
    }

    fn after(decay: f64) -> Colour {
        watched(decay).colour
    }

    /// The light of a motion whose energy decays with this exponent.
    fn watched(decay: f64) -> Light {
        let mut settling = Settling::default();
        let mut t = 0.0;
        for _ in 0..6000 {
            t += 0.001;
            settling.step(t, 0.001, (decay * t).exp());
        }
        settling.light(t)
    }

    #[test]
    fn what_decays_settles_and_what_does_not_does_not() {
        assert_eq!(after(-2.0), Colour::Green);
        assert_eq!(after(-0.7), Colour::Amber);
        assert_eq!(after(0.0), Colour::Red);
        assert_eq!(after(1.0), Colour::Red);
    }
}

//! Colours of screens and amounts of light.

use crate::vector::V3;

/// Steps of the table from light to sRGB: a dark colour is ten of them.
const STEPS: usize = 1 << 14;

/// Light of a component of sRGB, by IEC 61966-2-1.
fn light(component: f32) -> f32 {
    if component <= 0.040_45 {
        component / 12.92
    } else {
        ((component + 0.055) / 1.055).powf(2.4)
    }
}

/// The amounts of light of a colour on a screen.
pub(crate) fn linear(colour: [u8; 3]) -> V3 {
    colour.map(|component| light(f32::from(component) / 255.0))
}

/// A table from amounts of light to colours. Computing a power for each colour would cost more than the rest of a
/// pixel.
pub(crate) struct Screen {
    table: Vec<u8>,
}

impl Screen {
    pub(crate) fn new() -> Self {
        let table = (0..STEPS).map(|step| {
            let light = step as f32 / (STEPS - 1) as f32;
            let component = if light <= 0.003_130_8 {
                12.92 * light
            } else {
                1.055 * light.powf(1.0 / 2.4) - 0.055
            };
            (255.0 * component).round() as u8
        });
        Self {
            table: table.collect(),
        }
    }

    /// The colour of light; values above 1 count as 1.
    pub(crate) fn colour(&self, light: V3) -> [u8; 3] {
        light.map(|light| {
            let step = light.clamp(0.0, 1.0) * (STEPS - 1) as f32;
            // By way of i32, which is one instruction.
            self.table[(step + 0.5) as i32 as usize]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_and_colour_undo_each_other() {
        let screen = Screen::new();
        for component in 0..=255_u8 {
            let [back, ..] = screen.colour(linear([component; 3]));
            assert!(back.abs_diff(component) <= 1, "{component} became {back}");
        }
    }
}

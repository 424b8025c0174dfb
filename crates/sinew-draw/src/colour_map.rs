//! A colour for a number.

use crate::style::Colour;

/// Nine stops of `viridis` (N. Smith and S. van der Walt, 2015): even to the eye, and readable
/// without colour vision or in grey.
const VIRIDIS: [Colour; 9] = [
    Colour(0x44, 0x01, 0x54),
    Colour(0x47, 0x2d, 0x7b),
    Colour(0x3b, 0x52, 0x8b),
    Colour(0x2c, 0x72, 0x8e),
    Colour(0x21, 0x91, 0x8c),
    Colour(0x28, 0xae, 0x80),
    Colour(0x5e, 0xc9, 0x62),
    Colour(0xad, 0xdc, 0x30),
    Colour(0xfd, 0xe7, 0x25),
];

/// The colour at a share of the map, clamped to its ends.
#[must_use]
pub fn viridis(share: f64) -> Colour {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let stop = (place as usize).min(VIRIDIS.len() - 2);
    mix(VIRIDIS[stop], VIRIDIS[stop + 1], place - stop as f64)
}

/// A darker colour: 1 leaves it unchanged, 0 is black.
#[must_use]
pub fn shade(colour: Colour, light: f64) -> Colour {
    mix(Colour(0, 0, 0), colour, light.clamp(0.0, 1.0))
}

fn mix(a: Colour, b: Colour, share: f64) -> Colour {
    let channel =
        |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    Colour(channel(a.0, b.0), channel(a.1, b.1), channel(a.2, b.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_has_ends() {
        assert_eq!(viridis(-1.0), VIRIDIS[0]);
        assert_eq!(viridis(0.5), VIRIDIS[4]);
        assert_eq!(viridis(2.0), VIRIDIS[8]);
        // NaN is nothing to crash on.
        let _ = viridis(f64::NAN);
    }
}

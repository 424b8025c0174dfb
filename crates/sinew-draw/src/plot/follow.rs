//! A line that leaves the frame.

/// Position in shares of the frame: to the right, and upwards.
type Place = (f64, f64);

/// Shares of the frame's height beyond which a line is not followed: well outside the frame, yet
/// safe as coordinates.
const FAR: (f64, f64) = (-2.0, 3.0);

/// The part of a stretch that is followed.
pub(super) fn followed(a: Place, b: Place) -> Option<(Place, Place)> {
    let (low, high) = FAR;
    if a.1.max(b.1) < low || a.1.min(b.1) > high {
        return None;
    }
    // A stretch to infinity goes straight up or down.
    let upright = |to: Place, from: Place| match to.1.is_finite() {
        true => to,
        false => (from.0, to.1.clamp(low, high)),
    };
    let (a, b) = (upright(a, b), upright(b, a));
    let cut = |to: Place, from: Place| {
        let edge = to.1.clamp(low, high);
        if edge == to.1 {
            return to;
        }
        let way = (edge - from.1) / (to.1 - from.1);
        (from.0 + way * (to.0 - from.0), edge)
    };
    Some((cut(a, b), cut(b, a)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_stays() {
        let (a, b) = ((0.1, 0.2), (0.3, 1.5));
        assert_eq!(followed(a, b), Some((a, b)));
    }

    #[test]
    fn what_goes_far_is_cut_on_its_way() {
        let cut = followed((0.0, 0.0), (1.0, 6.0));
        assert_eq!(cut, Some(((0.0, 0.0), (0.5, 3.0))));
        let cut = followed((0.0, 13.0), (1.0, -7.0));
        assert_eq!(cut, Some(((0.5, 3.0), (0.75, -2.0))));
        assert_eq!(followed((0.0, 4.0), (1.0, 1e300)), None);
    }

    #[test]
    fn infinity_is_straight_up() {
        let up = followed((0.2, 0.5), (0.4, f64::INFINITY));
        assert_eq!(up, Some(((0.2, 0.5), (0.2, 3.0))));
        let down = followed((0.2, f64::NEG_INFINITY), (0.4, 0.5));
        assert_eq!(down, Some(((0.4, -2.0), (0.4, 0.5))));
    }
}

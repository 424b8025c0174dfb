//! Linear combinations of slices.

/// Largest number of slices that one pass adds up.
pub(super) const MOST: usize = 4;

/// A second slice that follows the sum in the same pass: `out = own out + weight sum`.
pub(super) struct Follower<'a> {
    pub(super) out: &'a mut [f64],
    pub(super) own: f64,
    pub(super) weight: f64,
}

/// A bound on the size of a sum, and marks of the values that reached it.
pub(super) struct Bound<'a> {
    pub(super) limit: f64,
    /// Set to 1 where the bound was reached: as wide as the values, so that several are compared at a time.
    pub(super) reached: &'a mut [u64],
}

/// `out = own out + sum of weight slice`, or without its first term if `own` is `None`, added up in that order,
/// then bounded; returns true if the bound was reached. At most [`MOST`] slices, of the length of `out`.
pub(super) fn combine(
    out: &mut [f64],
    own: Option<f64>,
    parts: &[(f64, &[f64])],
    bound: Option<Bound<'_>>,
    follower: Option<Follower<'_>>,
) -> bool {
    let length = out.len();
    let mut any = 0;
    match (bound, follower) {
        (None, None) => few(out, own, parts, |_, sum| sum),
        (
            None,
            Some(Follower {
                out: next,
                own: kept,
                weight,
            }),
        ) => {
            let next = &mut next[..length];
            few(out, own, parts, |i, sum| {
                next[i] = kept * next[i] + weight * sum;
                sum
            });
        }
        (Some(Bound { limit, reached }), None) => {
            let reached = &mut reached[..length];
            few(out, own, parts, |i, sum| {
                let beyond = u64::from(sum.abs() >= limit);
                reached[i] |= beyond;
                any |= beyond;
                sum.clamp(-limit, limit)
            });
        }
        (
            Some(Bound { limit, reached }),
            Some(Follower {
                out: next,
                own: kept,
                weight,
            }),
        ) => {
            let (reached, next) = (&mut reached[..length], &mut next[..length]);
            few(out, own, parts, |i, sum| {
                let beyond = u64::from(sum.abs() >= limit);
                reached[i] |= beyond;
                any |= beyond;
                let sum = sum.clamp(-limit, limit);
                next[i] = kept * next[i] + weight * sum;
                sum
            });
        }
    }
    any != 0
}

/// [`combine`] for at most [`MOST`] slices; `finish` turns each sum into the stored value.
fn few(
    out: &mut [f64],
    own: Option<f64>,
    parts: &[(f64, &[f64])],
    finish: impl FnMut(usize, f64) -> f64,
) {
    match parts {
        [a] => pass(out, own, [*a], finish),
        [a, b] => pass(out, own, [*a, *b], finish),
        [a, b, c] => pass(out, own, [*a, *b, *c], finish),
        [a, b, c, d, ..] => pass(out, own, [*a, *b, *c, *d], finish),
        [] => pass(out, own, [], finish),
    }
}

#[inline(always)]
fn pass<const N: usize>(
    out: &mut [f64],
    own: Option<f64>,
    parts: [(f64, &[f64]); N],
    mut finish: impl FnMut(usize, f64) -> f64,
) {
    let length = out.len();
    let parts = parts.map(|(weight, slice)| (weight, &slice[..length]));
    match own {
        Some(own) => {
            for (i, out) in out.iter_mut().enumerate() {
                let mut sum = own * *out;
                for (weight, slice) in &parts {
                    sum += weight * slice[i];
                }
                *out = finish(i, sum);
            }
        }
        None => {
            for (i, out) in out.iter_mut().enumerate() {
                let terms = parts.iter().map(|(weight, slice)| weight * slice[i]);
                let sum = terms.reduce(|sum, term| sum + term).unwrap_or(0.0);
                *out = finish(i, sum);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_added_up_bounded_and_passed_on() {
        let slices: Vec<Vec<f64>> = (1..=MOST as u32).map(|k| vec![f64::from(k); 5]).collect();
        for count in 0..=MOST {
            let parts: Vec<(f64, &[f64])> = slices[..count]
                .iter()
                .map(|slice| (0.5, slice.as_slice()))
                .collect();
            let sum = 0.5 * (count * (count + 1) / 2) as f64;
            for (own, expected) in [(None, sum), (Some(1.0), 2.0 + sum), (Some(-3.0), sum - 6.0)] {
                let mut out = vec![2.0; 5];
                combine(&mut out, own, &parts, None, None);
                assert_eq!(out, [expected; 5], "{count} {own:?}");

                let (mut out, mut next) = (vec![2.0; 5], vec![4.0; 5]);
                let follower = Follower {
                    out: &mut next,
                    own: 0.5,
                    weight: -3.0,
                };
                combine(&mut out, own, &parts, None, Some(follower));
                assert_eq!(out, [expected; 5], "{count} {own:?}");
                assert_eq!(next, [2.0 - 3.0 * expected; 5], "{count} {own:?}");

                let (mut out, mut reached) = (vec![2.0; 5], vec![0; 5]);
                let limit = 3.0;
                let bound = Bound {
                    limit,
                    reached: &mut reached,
                };
                let any = combine(&mut out, own, &parts, Some(bound), None);
                assert_eq!(out, [expected.clamp(-limit, limit); 5], "{count} {own:?}");
                assert_eq!(any, expected.abs() >= limit);
                assert_eq!(reached, [u64::from(any); 5]);
            }
        }
    }
}

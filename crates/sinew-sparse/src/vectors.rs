//! Sums over vectors, in one order of additions.
//!
//! Every sum over all degrees of freedom that affects a result is computed here, so that changes of its order (lanes,
//! threads, parts on several computers) are made in one place. The order depends on the length only.

/// Numbers summed side by side, so that sums can be kept in vector registers.
const LANES: usize = 8;

/// `sum_i a_i b_i` over the shorter length.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, a_rest) = a[..n].as_chunks::<LANES>();
    let (b, b_rest) = b[..n].as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// `sum_i w_i a_i b_i`, for example with the masses as weights, over the shortest length.
#[must_use]
pub fn weighted_dot(weights: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let n = weights.len().min(a.len()).min(b.len());
    let (w, w_rest) = weights[..n].as_chunks::<LANES>();
    let (a, a_rest) = a[..n].as_chunks::<LANES>();
    let (b, b_rest) = b[..n].as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for ((w, a), b) in w.iter().zip(a).zip(b) {
        for (((sum, w), a), b) in sums.iter_mut().zip(w).zip(a).zip(b) {
            *sum += w * a * b;
        }
    }
    let rest = w_rest.iter().zip(a_rest).zip(b_rest);
    let rest: f64 = rest.map(|((w, a), b)| w * a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// `sum_i (a_i - b_i) x_i` over the shortest length: exact to the rounding of the differences, while two products would
/// have their own rounding errors.
#[must_use]
pub fn dot_of_difference(a: &[f64], b: &[f64], x: &[f64]) -> f64 {
    let n = a.len().min(b.len()).min(x.len());
    let (a, a_rest) = a[..n].as_chunks::<LANES>();
    let (b, b_rest) = b[..n].as_chunks::<LANES>();
    let (x, x_rest) = x[..n].as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for ((a, b), x) in a.iter().zip(b).zip(x) {
        for (((sum, a), b), x) in sums.iter_mut().zip(a).zip(b).zip(x) {
            *sum += (a - b) * x;
        }
    }
    let rest = a_rest.iter().zip(b_rest).zip(x_rest);
    let rest: f64 = rest.map(|((a, b), x)| (a - b) * x).sum();
    sums.iter().sum::<f64>() + rest
}

/// `sqrt(sum_i a_i^2)`.
#[must_use]
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// The largest |a_i|, 0 without any; infinite if one is NaN.
#[must_use]
pub fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |most, value| larger(most, value.abs()))
}

/// The larger of two sizes; NaN counts as infinite.
#[must_use]
pub fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// `a *= factor`.
pub fn scale(a: &mut [f64], factor: f64) {
    a.iter_mut().for_each(|value| *value *= factor);
}

/// `out += factor a`.
pub fn add_scaled(factor: f64, a: &[f64], out: &mut [f64]) {
    for (out, a) in out.iter_mut().zip(a) {
        *out += factor * a;
    }
}

/// A fixed vector with components in every direction, between -1/2 and 1/2, different for each seed: the start of
/// iterations for eigenvalues.
#[must_use]
pub fn noise(n: usize, seed: u64) -> Vec<f64> {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(2 * seed + 1);
    let value = |_| {
        // xorshift64: Marsaglia, J. Stat. Softw. 8(14), 2003.
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    (0..n).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_whole_numbers() {
        for n in [0, 1, 7, 8, 9, 40] {
            let a: Vec<f64> = (0..n).map(f64::from).collect();
            let b: Vec<f64> = a.iter().map(|a| 2.0 * a + 1.0).collect();
            let plain: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            assert_eq!(dot(&a, &b), plain);
            let weighted: f64 = a.iter().zip(&b).map(|(a, b)| a * a * b).sum();
            assert_eq!(weighted_dot(&a, &a, &b), weighted);
            let differences: f64 = a.iter().zip(&b).map(|(a, b)| (b - a) * a).sum();
            assert_eq!(dot_of_difference(&b, &a, &a), differences);
        }
        assert_eq!(norm(&[3.0, -4.0]), 5.0);
        assert_eq!(dot(&[1.0, 2.0], &[3.0]), 3.0);
    }

    #[test]
    fn what_is_not_a_number_is_the_largest() {
        assert_eq!(largest(&[]), 0.0);
        assert_eq!(largest(&[1.0, -5.0, 2.0]), 5.0);
        assert_eq!(largest(&[1.0, f64::NAN, 2.0]), f64::INFINITY);
        assert_eq!(larger(f64::INFINITY, f64::NAN), f64::INFINITY);
    }

    #[test]
    fn vectors_are_scaled_and_added() {
        let mut a = [1.0, -2.0];
        scale(&mut a, 3.0);
        let mut out = [1.0, 1.0];
        add_scaled(0.5, &a, &mut out);
        assert_eq!((a, out), ([3.0, -6.0], [2.5, -2.0]));
    }

    #[test]
    fn noise_is_reproduced_and_leans_to_no_side() {
        let noise_of = |seed| noise(4096, seed);
        assert_eq!(noise_of(0), noise_of(0));
        assert_ne!(noise_of(0), noise_of(1));
        let mean = noise_of(0).iter().sum::<f64>() / 4096.0;
        assert!(mean.abs() < 0.02, "{mean}");
    }
}

//! The largest eigenvalue of a matrix that changes slowly, followed by a product at a time.

use sinew_sparse::vectors::{noise, scale, weighted_dot};

/// Products by which [`follow_largest_eigenvalue`] begins.
pub const PRODUCTS_OF_BEGINNING: u64 = 16;

/// Share of the estimate up to which eigenvalues count as too small to be sought.
const TOO_SMALL: f64 = 0.9;

/// Growth of the estimate by a product up to which the eigenvalue counts as found.
const SETTLED: f64 = 1.005;

/// Size of the noise that is added with each product, as a share of the field: a field that has converged to its
/// eigenvector would otherwise contain nothing of another one that grows elsewhere.
const NOISE: f64 = 0.1;

/// A lower estimate, to some thousandths, of the largest eigenvalue of `M^-1 S`, S symmetric and M diagonal, for an S
/// that has changed little since the last call. One product improves the two fields that approximate the eigenvector,
/// each of the length of `mass`. Without such fields the iteration begins from noise that is always the same, with
/// [`PRODUCTS_OF_BEGINNING`] products. `multiply(x, out)` writes `out = S x`; `room` is scratch space, of the length of
/// `mass`.
///
/// Chebyshev's recurrence (Saad, Numerical Methods for Large Eigenvalue Problems, section 7.4), scaled again in each
/// step: parts with eigenvalues from -.45 to .9 of the estimate are unchanged, and those beyond grow in a product, the
/// part of the eigenvalue found by a factor of 1.7 and that of one larger by half by 3.5. So the fields turn to another
/// eigenvector within a few products; the power iteration, in which parts grow like the eigenvalues, would take some
/// ten. The result is infinite if products are not finite.
///
/// # Errors
/// That of `multiply`.
pub fn follow_largest_eigenvalue<E>(
    fields: &mut Vec<f64>,
    mass: &[f64],
    room: &mut [f64],
    most: u64,
    mut multiply: impl FnMut(&[f64], &mut [f64]) -> Result<(), E>,
) -> Result<f64, E> {
    let n = mass.len();
    let mut products = most.max(1);
    let is_known = fields.len() == 2 * n;
    if !is_known {
        fields.clear();
        fields.extend(noise(n, 0));
        multiply(fields, room)?;
        // Without parts that S knows nothing of.
        let divided = room.iter().zip(mass).map(|(force, mass)| force / mass);
        fields.clear();
        fields.extend(divided);
        fields.resize(2 * n, 0.0);
        products = PRODUCTS_OF_BEGINNING - 1;
    }
    let (now, before) = fields.split_at_mut(n);
    let mut estimate = 0.0;
    for _ in 0..products {
        multiply(now, room)?;
        room.iter_mut()
            .zip(mass)
            .for_each(|(force, mass)| *force /= mass);
        let [pushed, size] = [&*room, &*now].map(|field| weighted_dot(mass, field, field));
        let before_it = estimate;
        estimate = if pushed == 0.0 {
            0.0
        } else {
            (pushed / size).sqrt()
        };
        if estimate == 0.0 || !estimate.is_finite() {
            fields.clear();
            return Ok(if estimate == 0.0 { 0.0 } else { f64::INFINITY });
        }
        let [middle, half] = [0.25, 0.75].map(|share| share * TOO_SMALL * estimate);
        for ((before, now), product) in before.iter_mut().zip(&*now).zip(&*room) {
            *before = 2.0 * (product - middle * now) / half - *before;
        }
        now.swap_with_slice(before);
        let size = weighted_dot(mass, now, now).sqrt();
        scale(now, 1.0 / size);
        scale(before, 1.0 / size);
        let share = NOISE / (n as f64).sqrt();
        for (dof, ((now, mass), product)) in now.iter_mut().zip(mass).zip(&*room).enumerate() {
            // None where S knows of nothing.
            if *product != 0.0 {
                *now += sign(dof) * share / mass.sqrt();
            }
        }
        if is_known && estimate <= SETTLED * before_it {
            break;
        }
    }
    Ok(estimate)
}

/// A sign at random that is the same in each call (splitmix64: Steele, Lea and Flood, OOPSLA 2014).
fn sign(dof: usize) -> f64 {
    let mut hash = (dof as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    hash = (hash ^ (hash >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    hash = (hash ^ (hash >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    if (hash ^ (hash >> 31)) & 1 == 0 {
        1.0
    } else {
        -1.0
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    /// `out`: force of a chain of springs between walls, one mass per spring.
    fn chain(stiffness: impl Fn(usize) -> f64, x: &[f64], out: &mut [f64]) {
        let n = x.len();
        let at = |i: usize| x.get(i).copied().unwrap_or(0.0);
        for i in 0..n {
            let left = if i > 0 { x[i - 1] } else { 0.0 };
            out[i] = stiffness(i) * (x[i] - left) + stiffness(i + 1) * (x[i] - at(i + 1));
        }
    }

    fn exact(mass: &[f64], stiffness: impl Fn(usize) -> f64) -> f64 {
        crate::spectrum::largest_eigenvalue(mass, |x, out| chain(&stiffness, x, out))
    }

    fn follow(fields: &mut Vec<f64>, mass: &[f64], stiffness: impl Fn(usize) -> f64) -> f64 {
        let mut room = vec![0.0; mass.len()];
        let found = follow_largest_eigenvalue(fields, mass, &mut room, 1, |x, out| {
            chain(&stiffness, x, out);
            Ok::<_, Infallible>(())
        });
        match found {
            Ok(found) => found,
        }
    }

    /// One spring at the other end of the chain becomes ten times as stiff within 40 products.
    #[test]
    fn a_stiffness_that_grows_elsewhere_is_found_within_a_few_products() {
        let mass: Vec<f64> = (0..60).map(|i| 1.0 + 0.5 * f64::from(i % 3)).collect();
        let at_rest = |i: usize| if i == 50 { 3.0 } else { 1.0 };
        let mut fields = Vec::new();
        let first = follow(&mut fields, &mass, at_rest) / exact(&mass, at_rest);
        assert!((0.95..=1.0 + 1e-12).contains(&first), "{first}");
        for product in 1..=60 {
            let grown = 1.0 + 9.0 * f64::from(product.min(40)) / 40.0;
            let now = |i: usize| if i == 5 { grown } else { at_rest(i) };
            let share = follow(&mut fields, &mass, now) / exact(&mass, now);
            assert!(share <= 1.0 + 1e-9, "product {product}: {share}");
            assert!(share >= 0.8, "product {product}: {share}");
            assert!(product < 20 || share > 0.99, "product {product}: {share}");
        }
    }

    /// Buckled bodies have tangents with negative eigenvalues.
    #[test]
    fn negative_eigenvalues_are_not_followed() {
        let values = [-0.4, 0.1, 0.5, 0.8, 1.0];
        let (mut fields, mut room) = (Vec::new(), [0.0; 5]);
        let mut found = 0.0;
        for _ in 0..20 {
            let result =
                follow_largest_eigenvalue(&mut fields, &[1.0; 5], &mut room, 1, |x, out| {
                    for ((out, x), value) in out.iter_mut().zip(x).zip(values) {
                        *out = value * x;
                    }
                    Ok::<_, Infallible>(())
                });
            found = match result {
                Ok(found) => found,
            };
        }
        assert!((found - 1.0).abs() < 1e-2, "{found}");
    }

    #[test]
    fn without_stiffness_there_is_nothing_to_follow() {
        let mut fields = Vec::new();
        assert_eq!(follow(&mut fields, &[1.0; 4], |_| 0.0), 0.0);
    }
}

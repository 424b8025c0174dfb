//! Products with a dense matrix of many columns of length n, stored column by column.

use sinew_core::vectors::{dot, norm};

/// `out[j] = column_j . x`.
pub(super) fn project(columns: &[f64], x: &[f64], out: &mut [f64]) {
    for (value, column) in out.iter_mut().zip(columns.chunks_exact(x.len().max(1))) {
        *value = dot(column, x);
    }
}

/// Projections of two vectors in one pass over the matrix.
pub(super) fn project_two(
    columns: &[f64],
    (x, y): (&[f64], &[f64]),
    (p, q): (&mut [f64], &mut [f64]),
) {
    let out = p.iter_mut().zip(q);
    for ((p, q), column) in out.zip(columns.chunks_exact(x.len().max(1))) {
        *p = dot(column, x);
        *q = dot(column, y);
    }
}

/// `x += scale sum_j coefficients[j] column_j`, four columns at a time.
pub(super) fn add(columns: &[f64], coefficients: &[f64], scale: f64, x: &mut [f64]) {
    let n = x.len();
    let (quadruples, rest) = coefficients.as_chunks::<4>();
    let (blocks, last) = columns.split_at(quadruples.len() * 4 * n);
    for (c, block) in quadruples.iter().zip(blocks.chunks_exact(4 * n.max(1))) {
        let [c0, c1, c2, c3] = c.map(|c| scale * c);
        let (a, b) = block.split_at(2 * n);
        let (a0, a1) = a.split_at(n);
        let (b0, b1) = b.split_at(n);
        let parts = a0.iter().zip(a1).zip(b0.iter().zip(b1));
        for (x, ((a0, a1), (b0, b1))) in x.iter_mut().zip(parts) {
            *x += (c0 * a0 + c1 * a1) + (c2 * b0 + c3 * b1);
        }
    }
    for (c, column) in rest.iter().zip(last.chunks_exact(n.max(1))) {
        for (x, value) in x.iter_mut().zip(column) {
            *x += scale * c * value;
        }
    }
}

/// `x = sum_j p[j] column_j` and `y = sum_j q[j] column_j` in one pass over the matrix.
pub(super) fn lift_two(
    columns: &[f64],
    (p, q): (&[f64], &[f64]),
    (x, y): (&mut [f64], &mut [f64]),
) {
    x.fill(0.0);
    y.fill(0.0);
    let pairs = p.chunks(4).zip(q.chunks(4));
    for ((p, q), block) in pairs.zip(columns.chunks(4 * x.len().max(1))) {
        add(block, p, 1.0, x);
        add(block, q, 1.0, y);
    }
}

/// Removes from `x` the components along orthonormal columns, twice if the first pass left rounding errors (Daniel,
/// Gragg, Kaufman and Stewart, Math. Comp. 30, 1976), and adds them to `parts`.
pub(super) fn orthogonalise(columns: &[f64], x: &mut [f64], parts: &mut [f64], work: &mut [f64]) {
    let work = &mut work[..parts.len()];
    let mut before = norm(x);
    for _ in 0..3 {
        project(columns, x, work);
        add(columns, work, -1.0, x);
        for (part, more) in parts.iter_mut().zip(work.iter()) {
            *part += more;
        }
        let after = norm(x);
        if after > 0.7 * before {
            break;
        }
        before = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(n: usize, rate: f64) -> Vec<f64> {
        (0..n).map(|i| (rate * i as f64).sin()).collect()
    }

    #[test]
    fn products_are_the_plain_sums() {
        for (n, m) in [(1, 1), (7, 3), (19, 9), (8, 4)] {
            let columns = wave(n * m, 0.7);
            let (x, y) = (wave(n, 1.3), wave(n, 0.2));
            let (mut p, mut q) = (vec![0.0; m], vec![0.0; m]);
            project_two(&columns, (&x, &y), (&mut p, &mut q));
            let (mut a, mut b) = (vec![9.0; n], vec![9.0; n]);
            lift_two(&columns, (&p, &q), (&mut a, &mut b));
            for j in 0..m {
                let plain: f64 = (0..n).map(|i| columns[j * n + i] * y[i]).sum();
                assert!((q[j] - plain).abs() < 1e-13);
            }
            for i in 0..n {
                let plain: f64 = (0..m).map(|j| columns[j * n + i] * p[j]).sum();
                assert!((a[i] - plain).abs() < 1e-12);
            }
        }
    }
}

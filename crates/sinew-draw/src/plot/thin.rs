//! Long lines, thinned to the resolution of a picture.

/// A line in pixels of which, among neighbours in the same column of pixels, only the first, the lowest, the
/// highest and the last are kept: it looks the same.
pub(super) fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::with_capacity(points.len().min(4096));
    let column = |point: &(f64, f64)| point.0.floor();
    for part in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height =
            |(_, a): &(usize, &(f64, f64)), (_, b): &(usize, &(f64, f64))| a.1.total_cmp(&b.1);
        let lowest = part.iter().enumerate().min_by(by_height);
        let highest = part.iter().enumerate().max_by(by_height);
        let mut wanted = [
            0,
            lowest.map_or(0, |(at, _)| at),
            highest.map_or(0, |(at, _)| at),
            part.len() - 1,
        ];
        wanted.sort_unstable();
        let mut last = None;
        for at in wanted {
            if last != Some(at) {
                kept.push(part[at]);
            }
            last = Some(at);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_lines_stay() {
        let line = [(0.0, 1.0), (5.0, 2.0), (10.5, -1.0)];
        assert_eq!(thinned(&line), line);
        assert_eq!(thinned(&[]), []);
    }

    #[test]
    fn no_column_of_pixels_loses_its_ends_or_its_extremes() {
        let line: Vec<(f64, f64)> = (0..100_000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|x| (x, 50.0 * (7.3 * x).sin() + 3.0 * (91.0 * x).sin()))
            .collect();
        let kept = thinned(&line);
        assert!(kept.len() <= 4 * 100, "{}", kept.len());
        for column in 0..100 {
            let of = |line: &[(f64, f64)]| {
                let here = |p: &&(f64, f64)| p.0.floor() == f64::from(column);
                let ys: Vec<f64> = line.iter().filter(here).map(|p| p.1).collect();
                let low = ys.iter().copied().fold(f64::INFINITY, f64::min);
                let high = ys.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                (ys[0], low, high, ys[ys.len() - 1])
            };
            assert_eq!(of(&line), of(&kept));
        }
    }
}

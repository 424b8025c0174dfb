//! Rule that decides if a factorisation is tried: its time and memory grow faster than the body.

use super::row::ScaleRow;

/// Largest accepted time of a set-up (s).
const LONGEST: f64 = 90.0;

/// Share of the available memory that a factor may take.
const SHARE: f64 = 0.5;

/// Memory (bytes) assumed if the system does not report it.
const ASSUMED: f64 = 4e9;

/// Powers of the number of unknowns with which memory and time of a factor of a cube grow at least, for the best
/// ordering (George, SIAM Journal on Numerical Analysis 10, 1973; in space, memory n^(4/3), work n^2).
const MEMORY: f64 = 4.0 / 3.0;
const TIME: f64 = 2.0;

/// The reason for which a factor of a body with `tets` tetrahedra is not tried, judged from the factors of smaller
/// ones.
pub(super) fn refused(rows: &[ScaleRow], tets: f64) -> Option<String> {
    judged(rows, tets, SHARE * available())
}

fn judged(rows: &[ScaleRow], tets: f64, most: f64) -> Option<String> {
    // The first body has none before it, and is tried.
    let row = rows.iter().rfind(|row| row.integrator == "newmark")?;
    let times = tets / row.tets as f64;
    let bytes = row
        .bytes_per_tet
        .map(|each| each * row.tets as f64 * times.powf(MEMORY));
    let setup = row.setup_cpu_s * times.powf(TIME);
    if let Some(bytes) = bytes.filter(|bytes| *bytes > most) {
        return Some(format!(
            "its factor is expected to take {:.1} GB, {:.1} GB may be used",
            1e-9 * bytes,
            1e-9 * most
        ));
    }
    (setup > LONGEST).then(|| {
        format!("its factorisation is expected to take {setup:.0} s, {LONGEST:.0} s are waited for")
    })
}

/// Memory (bytes) that is available.
fn available() -> f64 {
    let text = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("MemAvailable:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kilobytes.map_or(ASSUMED, |kilobytes| 1024.0 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::row;
    use super::*;

    #[test]
    fn a_factor_that_will_not_fit_is_not_tried_and_says_so() {
        // 1 kB each of 1e5 tetrahedra: of 8e5, 16 times as much.
        let rows = [row("newmark", 100_000, 1.0, 1.0)];
        assert_eq!(judged(&rows, 8e5, 2e9), None);
        let reason = judged(&rows, 8e5, 1e9).unwrap();
        assert!(
            reason.contains("1.6 GB") && reason.contains("1.0 GB"),
            "{reason}"
        );
        let slow = judged(&rows, 1e6, 1e12).unwrap();
        assert!(slow.contains("100 s"), "{slow}");
        assert_eq!(judged(&[], 1e9, 1.0), None);
    }
}

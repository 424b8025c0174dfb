//! A small bench over sizes.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sinew_bench::scale::ScaleBench;
use sinew_core::CountingAllocator;
use sinew_verify::machine;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn two_cubes_have_rows_fits_and_a_plot() {
    let bench = ScaleBench { quick: true };
    let results = bench.run("a test".into(), machine(), |_| {}).unwrap();

    let tets: Vec<usize> = results.bodies.iter().map(|body| body.tets).collect();
    assert_eq!(tets, [6_000, 48_000]);
    for body in &results.bodies {
        assert!(body.reference_error < 1e-8, "{body:?}");
        assert!(body.reference_sweeps_per_omega_t <= 4.0, "{body:?}");
        // Three coordinates, four corners and blocks of 72 bytes: some hundred bytes, not ten thousand.
        let bytes = body.bytes_per_tet.unwrap();
        assert!((100.0..10_000.0).contains(&bytes), "{body:?}");
    }
    let find = |integrator: &str, precision: &str, mesh: &str| {
        let mut rows = results.rows.iter();
        rows.find(|row| {
            row.integrator == integrator && row.precision == precision && row.mesh == mesh
        })
        .unwrap()
    };
    for mesh in ["cube 11^3", "cube 21^3"] {
        // Forward differences of the same scheme in other precision differ by rounding only.
        let [double, single] =
            ["f64", "f32"].map(|precision| find("central-difference", precision, mesh));
        let errors = [double, single].map(|row| row.error.unwrap());
        assert!(
            (errors[0] - errors[1]).abs() < 1e-3 * errors[0],
            "{errors:?}"
        );
        assert!(double.kernel.as_ref().unwrap().contains("f64"));
        assert!(single.kernel.as_ref().unwrap().contains("f32"));
        assert!((double.step_over_critical / 0.9 - 1.0).abs() < 1e-9);
        assert!(single.bytes_per_tet < double.bytes_per_tet);
        let row = find("two-step", "f64", mesh);
        assert!(row.error.unwrap() < 0.02, "{row:?}");
        let row = find("newmark", "f64", mesh);
        assert!(row.kernel.is_none() && row.error.unwrap() < 0.2, "{row:?}");
    }
    for row in &results.rows {
        assert!(row.wall_s_per_s > 0.0 && row.setup_wall_s >= 0.0, "{row:?}");
        assert!(row.error.is_some_and(|error| error < 1.0), "{row:?}");
    }
    // A lattice's templates do not grow with it: what is kept is vectors.
    let fit = results.fits.iter().find(|fit| fit.integrator == "newmark");
    let exponents = fit.unwrap().exponents;
    assert!(exponents.bytes_per_tet.unwrap() > 0.1, "{exponents:?}");

    let text = results.to_string();
    assert!(
        text.contains("two-step") && text.contains("cube 21^3"),
        "{text}"
    );
    let json = serde_json::to_value(&results).unwrap();
    for field in [
        "mesh",
        "nodes",
        "tets",
        "integrator",
        "dt",
        "precision",
        "threads",
        "kernel",
        "error",
        "reference_error",
        "cpu_s_per_s",
        "wall_s_per_s",
        "setup_cpu_s",
        "bytes_per_tet",
    ] {
        assert!(!json["rows"][0][field].is_null(), "{field}");
    }
    let svg = results.plot().svg();
    assert!(svg.contains("real time") && !svg.contains("NaN"));
}

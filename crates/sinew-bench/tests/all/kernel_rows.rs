//! A small bench of kernels.

use std::path::PathBuf;

use sinew_bench::kernels::KernelBench;
use sinew_verify::machine;

#[test]
fn every_machine_takes_the_same_steps_and_allocates_nothing() {
    let bench = KernelBench {
        meshes: PathBuf::new(),
        generated: None,
        quick: true,
    };
    let results = bench.run("a test".into(), machine(), |_| {}).unwrap();
    let kernels = ["general", "template lattice"];
    for kernel in kernels {
        for (precision, rounding) in [("f64", 1e-13), ("f32", 1e-5)] {
            let mut rows = results.rows.iter();
            let row = rows.find(|row| (row.kernel.as_str(), row.precision) == (kernel, precision));
            let row = row.unwrap();
            assert!(row.difference < rounding, "{row:?}");
            assert_eq!(row.threads, 1);
            assert_eq!(row.allocations_per_step, Some(0.0), "{row:?}");
            assert!(
                row.ratio_to_b1 > 0.0 && row.share_of_bandwidth > 0.0,
                "{row:?}"
            );
            assert_eq!(row.templates, (kernel == kernels[1]).then_some(3));
        }
    }
    for row in &results.rows {
        // Two operations for each byte at least where blocks of f64 are read, of 8 bytes an entry.
        let least = if row.kernel == "general" { 0.1 } else { 0.5 };
        assert!(row.intensity > least && row.gflops > 0.0, "{row:?}");
        let roof = results.roofs.multiply_adds.iter();
        let mut roof = roof.filter(|rate| rate.precision == row.precision);
        assert!(
            roof.any(|rate| 1e9 * row.gflops < rate.operations_per_s),
            "{row:?}"
        );
    }
    // Six laws and elements, by plain numbers and by vectors of both precisions.
    assert_eq!(results.elements.len(), 18);
    for row in &results.elements {
        let rounding = if row.precision == "f64" { 1e-13 } else { 1e-4 };
        assert!(row.difference < rounding, "{row:?}");
        let ratios = [row.ns_per_tet, row.ratio_to_p1, row.gain_over_scalar];
        assert!(ratios.iter().all(|ratio| *ratio > 0.0), "{row:?}");
    }
    // Three elements in both precisions.
    assert_eq!(results.pulled.len(), 6);
    for row in &results.pulled {
        let rounding = if row.precision == "f64" { 1e-10 } else { 1e-3 };
        assert!(row.off_plain.is_none_or(|off| off < rounding), "{row:?}");
        assert_eq!(row.off_plain.is_some(), row.element == "p1");
        assert!(row.error < 0.1 && row.error_of_automatic < 0.1, "{row:?}");
        let ratios = [row.times_plain, row.over_fixed, row.share_of_roof];
        assert!(ratios.iter().all(|ratio| *ratio > 0.0), "{row:?}");
    }
    // Steps without a factor, tools on two machines, blades through two laws.
    assert_eq!(results.pairs.len(), 5);
    assert!(results.pairs[0].off.is_some_and(|off| off < 1e-4));
    for row in &results.pairs {
        assert!(row.ratio > 0.0 && row.cpu_s_per_s > 0.0, "{row:?}");
    }
    assert_eq!(results.marks.len(), 21);
    assert!(results.guards.len() > 4);
    assert!(results.guards.iter().all(|guard| guard.ratio > 0.0));
    let page = results.html();
    assert!(page.contains("Kernels on one thread") && page.contains("template lattice f32"));
    assert!(
        !page.contains("http://") || page.matches("http://").count() == 1,
        "SVG's own name"
    );
    let text = results.to_string();
    assert!(
        text.contains("cube 7^3") && text.contains("template lattice (3 templates)"),
        "{text}"
    );
}

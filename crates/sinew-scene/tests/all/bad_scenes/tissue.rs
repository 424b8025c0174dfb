//! Mistakes in the fibres and the memory of `[[region]]`.

use super::refusal;
use super::scenes::BODY;

/// The error of a region with these lines instead of its model.
fn refused(lines: &str) -> String {
    let springs = "model = \"springs\"\nyoungs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }\n";
    refusal(
        BODY,
        springs,
        &format!("youngs_modulus = 3500.0\npoissons_ratio = 0.45\n{lines}\n"),
    )
}

/// The error of these fibres.
fn refused_fibres(table: &str) -> String {
    refused(&format!("model = \"neo-hookean\"\nfibres = {{ {table} }}"))
}

#[test]
fn fibres_in_linear_tissue() {
    insta::assert_snapshot!(
        refused("model = \"linear\"\nfibres = { direction = [1, 0, 0], eta = 1.0 }"),
        @r#"scene.toml:9: [[region]] 1: `fibres` goes with laws of large deformation only, such as model = "neo-hookean""#
    );
}

#[test]
fn fibres_without_length() {
    insta::assert_snapshot!(refused_fibres("direction = [0, 0, 0], eta = 1.0"), @r#"scene.toml:9: [[region]] 1 fibres: direction = [0, 0, 0]: expected a vector [x, y, z], all finite, that is not 0, or { data = "name" }"#);
}

#[test]
fn fibres_without_direction() {
    insta::assert_snapshot!(refused_fibres("eta = 1.0"), @r#"scene.toml:9: [[region]] 1 fibres: `direction` is missing: expected a vector [x, y, z], all finite, that is not 0, or { data = "name" }"#);
}

#[test]
fn fibres_without_stiffness() {
    insta::assert_snapshot!(refused_fibres("direction = [1, 0, 0]"), @"scene.toml:9: [[region]] 1 fibres: expected exactly one of `eta`, `k1`, found none");
}

#[test]
fn fibres_of_two_kinds() {
    insta::assert_snapshot!(
        refused_fibres("direction = [1, 0, 0], eta = 1.0, k1 = 1.0, k2 = 1.0"),
        @"scene.toml:9: [[region]] 1 fibres: expected exactly one of `eta`, `k1`, found `eta`, `k1`"
    );
}

#[test]
fn fibres_of_no_stiffness() {
    insta::assert_snapshot!(refused_fibres("direction = [1, 0, 0], eta = 0.0"), @"scene.toml:9: [[region]] 1 fibres: eta = 0.0: expected a finite modulus above 0 Pa");
}

#[test]
fn exponential_fibres_without_exponent() {
    insta::assert_snapshot!(refused_fibres("direction = [1, 0, 0], k1 = 1.0"), @"scene.toml:9: [[region]] 1 fibres: `k2` is missing: expected a finite number above 0");
}

#[test]
fn exponential_fibres_that_do_not_stiffen() {
    insta::assert_snapshot!(
        refused_fibres("direction = [1, 0, 0], k1 = 1.0, k2 = 0.0"),
        @"scene.toml:9: [[region]] 1 fibres: k2 = 0.0: expected a finite number above 0"
    );
}

#[test]
fn fibres_that_stray_more_than_evenly() {
    insta::assert_snapshot!(
        refused_fibres("direction = [1, 0, 0], k1 = 1.0, k2 = 1.0, dispersion = 0.34"),
        @"scene.toml:9: [[region]] 1 fibres: dispersion = 0.34: expected a number from 0 to 1/3"
    );
}

#[test]
fn dispersion_of_quadratic_fibres() {
    insta::assert_snapshot!(
        refused_fibres("direction = [1, 0, 0], eta = 1.0, dispersion = 0.1"),
        @"scene.toml:9: [[region]] 1 fibres: `dispersion` goes with `k1` only"
    );
}

#[test]
fn five_families_of_fibres() {
    let family = "{ direction = [1, 0, 0], eta = 1.0 }";
    let families = [family; 5].join(", ");
    insta::assert_snapshot!(refused(&format!("model = \"neo-hookean\"\nfibres = [{families}]")), @"scene.toml:9: [[region]] 1: fibres = [{ direction = [1, 0, 0], eta = 1.0 }, { direction = [1, 0, ..: expected one to four families");
}

#[test]
fn a_list_of_no_fibres() {
    insta::assert_snapshot!(refused("model = \"neo-hookean\"\nfibres = []"), @"scene.toml:9: [[region]] 1: fibres = []: expected one to four families");
}

#[test]
fn axes_of_a_law_without_any() {
    insta::assert_snapshot!(refused("model = \"neo-hookean\"\naxes = [[1, 0, 0], [0, 1, 0]]"), @"scene.toml:9: [[region]] 1: `axes` goes with laws that have axes only; this one is alike in all directions");
}

#[test]
fn axes_that_are_parallel_or_missing_or_mixed() {
    let fung = |axes: &str| {
        let springs =
            "model = \"springs\"\nyoungs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }\n";
        let law = "model = \"fung\"\nc = 1000.0\nb = [2, 2, 2, 0.5, 0.5, 0.5, 1, 1, 1]\nbulk_modulus = 1.0e5\n";
        refusal(BODY, springs, &format!("{law}{axes}\n"))
    };
    insta::assert_snapshot!(fung("axes = [[1, 0, 0], [2, 0, 0]]"), @r#"scene.toml:10: [[region]] 1: axes = [[1, 0, 0], [2, 0, 0]]: expected two directions that are not parallel, [[x, y, z], [x, y, z]], or [{ data = "name" }, { data = "name" }]"#);
    insta::assert_snapshot!(fung(""), @r#"scene.toml:4: [[region]] 1: `axes` is missing: expected two directions that are not parallel, [[x, y, z], [x, y, z]], or [{ data = "name" }, { data = "name" }]"#);
    insta::assert_snapshot!(fung("axes = [[1, 0, 0], { data = \"two\" }]"), @r#"scene.toml:10: [[region]] 1: axes = [[1, 0, 0], { data = "two" }]: expected two directions that are not parallel, [[x, y, z], [x, y, z]], or [{ data = "name" }, { data = "name" }]"#);
    insta::assert_snapshot!(fung("axes = [[1, 0, 0]]"), @r#"scene.toml:10: [[region]] 1: axes = [[1, 0, 0]]: expected two directions that are not parallel, [[x, y, z], [x, y, z]], or [{ data = "name" }, { data = "name" }]"#);
}

/// The error of these lines in a region of this law.
fn refused_memory(law: &str, lines: &str) -> String {
    refused(&format!("model = \"{law}\"\n{lines}"))
}

#[test]
fn memory_of_linear_tissue() {
    insta::assert_snapshot!(refused_memory("linear", "prony = [[0.5, 1.0]]"), @r#"scene.toml:9: [[region]] 1: `prony` goes with laws of large deformation only, such as model = "neo-hookean""#);
}

#[test]
fn shares_that_leave_nothing() {
    insta::assert_snapshot!(
        refused_memory("neo-hookean", "prony = [[0.5, 1.0], [0.5, 2.0]]"),
        @"scene.toml:9: [[region]] 1: prony = [[0.5, 1.0], [0.5, 2.0]]: expected a list of 1 to 8 pairs [share, time in s], all above 0, with shares that together are below 1"
    );
}

#[test]
fn a_term_that_takes_no_time() {
    insta::assert_snapshot!(refused_memory("neo-hookean", "prony = [[0.5, 0.0]]"), @"scene.toml:9: [[region]] 1: prony = [[0.5, 0.0]]: expected a list of 1 to 8 pairs [share, time in s], all above 0, with shares that together are below 1");
}

#[test]
fn a_term_without_time() {
    insta::assert_snapshot!(refused_memory("neo-hookean", "prony = [[0.5]]"), @"scene.toml:9: [[region]] 1: prony = [[0.5]]: expected a list of 1 to 8 pairs [share, time in s], all above 0, with shares that together are below 1");
}

#[test]
fn no_terms() {
    insta::assert_snapshot!(refused_memory("neo-hookean", "prony = []"), @"scene.toml:9: [[region]] 1: prony = []: expected a list of 1 to 8 pairs [share, time in s], all above 0, with shares that together are below 1");
}

#[test]
fn the_deviatoric_part_of_a_law_that_has_none() {
    insta::assert_snapshot!(
        refused_memory("neo-hookean", "prony = [[0.5, 1.0]]\nviscous_part = \"deviatoric\""),
        @r#"scene.toml:10: [[region]] 1: `viscous_part` = "deviatoric" goes with model = "mooney-rivlin", "neo-hookean-iso", "yeoh", "fung", "gent", "arruda-boyce", "veronda-westmann" or "ogden" only, which have a part that keeps the volume"#
    );
}

#[test]
fn a_viscous_part_without_memory() {
    insta::assert_snapshot!(refused_memory("neo-hookean-iso", "viscous_part = \"all\""), @"scene.toml:9: [[region]] 1: `viscous_part` goes with `prony` only");
}

#[test]
fn moduli_without_memory() {
    insta::assert_snapshot!(refused_memory("neo-hookean", "moduli = \"longterm\""), @"scene.toml:9: [[region]] 1: `moduli` goes with `prony` only");
}

#[test]
fn unknown_moduli() {
    insta::assert_snapshot!(
        refused_memory("neo-hookean", "prony = [[0.5, 1.0]]\nmoduli = \"long\""),
        @r#"
    scene.toml:10: [[region]] 1: moduli = "long": expected "instantaneous" or "longterm"
    help: did you mean `longterm`?
    "#
    );
}

/// Volume relaxes less than shape, so that under an instantaneous pull the tissue would become wider.
#[test]
fn longterm_moduli_that_no_law_has_at_once() {
    insta::assert_snapshot!(
        refused(
            "model = \"neo-hookean-iso\"\nprony = [[0.97, 1.0]]\nviscous_part = \"deviatoric\"\nmoduli = \"longterm\""
        ),
        @"scene.toml:4: [[region]] 1: so much of the deviatoric stress relaxes that Poisson's ratio would be -0.302 at once, and laws of large deformation have none below 0: take smaller shares, or a larger long-term ratio"
    );
}

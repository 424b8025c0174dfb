//! Mistakes in `[[region]]`.

use super::refusal;
use super::scenes::BODY;

const SPRINGS: &str = r#"model = "springs"
youngs_modulus = 3500.0
springs = { rule = "lloyd" }"#;

const REGION: &str = r#"[[region]]
density = 1060.0
model = "springs"
youngs_modulus = 3500.0
springs = { rule = "lloyd" }
"#;

const NAMED_REGION: &str = r#"[[region]]
group = "tissue"
density = 1060.0
model = "springs"
youngs_modulus = 3500.0
springs = { rule = "lloyd" }
"#;

#[test]
fn no_region() {
    insta::assert_snapshot!(
        refusal(BODY, REGION, ""),
        @"scene.toml: `region` is missing: expected a table [[region]] for each material"
    );
}

#[test]
fn single_brackets() {
    insta::assert_snapshot!(
        refusal(BODY, "[[region]]", "[region]"),
        @"scene.toml:4: `region` is one table: write [[region]], as there may be several"
    );
}

#[test]
fn negative_density() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = -3"),
        @r#"scene.toml:5: [[region]] 1: density = -3: expected a finite density above 0 kg/m3, or { data = "name" }"#
    );
}

#[test]
fn zero_density() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = 0.0"),
        @r#"scene.toml:5: [[region]] 1: density = 0.0: expected a finite density above 0 kg/m3, or { data = "name" }"#
    );
}

#[test]
fn density_that_is_not_a_number() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = nan"),
        @r#"scene.toml:5: [[region]] 1: density = nan: expected a finite density above 0 kg/m3, or { data = "name" }"#
    );
}

#[test]
fn density_in_words() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = \"like water\""),
        @r#"scene.toml:5: [[region]] 1: density = "like water": expected a finite density above 0 kg/m3, or { data = "name" }, found a string"#
    );
}

#[test]
fn density_beyond_all_numbers() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = 1e999"),
        @r#"scene.toml:5: [[region]] 1: density = 1e999: expected a finite density above 0 kg/m3, or { data = "name" }"#
    );
}

#[test]
fn misspelt_density() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "densty = 1060.0"),
        @"
    scene.toml:5: [[region]] 1: unknown key `densty`; did you mean `density`?
    help: the keys here are `group`, `where`, `density`, `model`, `youngs_modulus`, `springs`
    "
    );
}

#[test]
fn no_density() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0\n", ""),
        @r#"scene.toml:4: [[region]] 1: `density` is missing: expected a finite density above 0 kg/m3, or { data = "name" }"#
    );
}

#[test]
fn zero_modulus() {
    insta::assert_snapshot!(
        refusal(BODY, "youngs_modulus = 3500.0", "youngs_modulus = 0"),
        @r#"scene.toml:7: [[region]] 1: youngs_modulus = 0: expected a finite Young's modulus above 0 Pa, or { data = "name" }"#
    );
}

#[test]
fn infinite_modulus() {
    insta::assert_snapshot!(
        refusal(BODY, "youngs_modulus = 3500.0", "youngs_modulus = inf"),
        @r#"scene.toml:7: [[region]] 1: youngs_modulus = inf: expected a finite Young's modulus above 0 Pa, or { data = "name" }"#
    );
}

#[test]
fn unknown_model() {
    insta::assert_snapshot!(
        refusal(BODY, "model = \"springs\"", "model = \"rubber\""),
        @r#"scene.toml:6: [[region]] 1: model = "rubber": expected "springs", "linear", "neo-hookean", "stable-neo-hookean", "corotational", "stvk", "mooney-rivlin", "neo-hookean-log", "neo-hookean-iso", "stable-neo-hookean-log", "yeoh", "fung", "gent", "arruda-boyce", "veronda-westmann" or "ogden""#
    );
}

#[test]
fn no_model() {
    insta::assert_snapshot!(
        refusal(BODY, "model = \"springs\"\n", ""),
        @r#"scene.toml:4: [[region]] 1: `model` is missing: expected "springs", "linear", "neo-hookean", "stable-neo-hookean", "corotational", "stvk", "mooney-rivlin", "neo-hookean-log", "neo-hookean-iso", "stable-neo-hookean-log", "yeoh", "fung", "gent", "arruda-boyce", "veronda-westmann" or "ogden""#
    );
}

#[test]
fn poissons_ratio_of_springs() {
    insta::assert_snapshot!(
        refusal(BODY, "springs = {", "poissons_ratio = 0.45\nsprings = {"),
        @r#"
    scene.toml:8: [[region]] 1: `poissons_ratio` does not go with springs: their Poisson's ratio is 1/4, whatever their stiffness
    help: take the key out, or use model = "linear"
    "#
    );
}

#[test]
fn no_springs() {
    insta::assert_snapshot!(
        refusal(BODY, "springs = { rule = \"lloyd\" }\n", ""),
        @r#"scene.toml:4: [[region]] 1: `springs` is missing: expected a table such as { rule = "lloyd" }"#
    );
}

#[test]
fn unknown_rule() {
    insta::assert_snapshot!(
        refusal(BODY, "\"lloyd\"", "\"loyd\""),
        @r#"
    scene.toml:8: [[region]] 1 springs: rule = "loyd": expected "lloyd" or "van-gelder"
    help: did you mean `lloyd`?
    "#
    );
}

#[test]
fn negative_damping_ratio() {
    insta::assert_snapshot!(
        refusal(BODY, "rule = \"lloyd\"", "rule = \"lloyd\", damping_ratio = -0.1"),
        @"scene.toml:8: [[region]] 1 springs: damping_ratio = -0.1: expected a finite share of the critical damping, 0 or above"
    );
}

#[test]
fn calibration_in_words() {
    insta::assert_snapshot!(
        refusal(BODY, "rule = \"lloyd\"", "rule = \"lloyd\", calibrate = \"yes\""),
        @r#"scene.toml:8: [[region]] 1 springs: calibrate = "yes": expected true or false, found a string"#
    );
}

#[test]
fn springs_of_a_continuum() {
    insta::assert_snapshot!(
        refusal(BODY, "model = \"springs\"", "model = \"linear\"\npoissons_ratio = 0.45"),
        @r#"scene.toml:9: [[region]] 1: `springs` goes with model = "springs" only"#
    );
}

#[test]
fn incompressible() {
    insta::assert_snapshot!(
        refusal(BODY, SPRINGS, "model = \"linear\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.5"),
        @r#"
    scene.toml:8: [[region]] 1: poissons_ratio = 0.5: expected a number above -1 and below 0.5, from 0 on for laws of large deformation
    help: 0.5 is incompressible, which a displacement alone cannot describe; soft tissue is usually given 0.45 to 0.499, with element = "fbar-edge"
    "#
    );
}

#[test]
fn poissons_ratio_too_low() {
    insta::assert_snapshot!(
        refusal(BODY, SPRINGS, "model = \"linear\"\nyoungs_modulus = 3500.0\npoissons_ratio = -1"),
        @"scene.toml:8: [[region]] 1: poissons_ratio = -1: expected a number above -1 and below 0.5, from 0 on for laws of large deformation"
    );
}

#[test]
fn no_poissons_ratio() {
    insta::assert_snapshot!(
        refusal(BODY, SPRINGS, "model = \"linear\"\nyoungs_modulus = 3500.0"),
        @"scene.toml:4: [[region]] 1: `poissons_ratio` is missing: expected a number above -1 and below 0.5, from 0 on for laws of large deformation"
    );
}

#[test]
fn the_same_group_twice() {
    insta::assert_snapshot!(
        refusal(BODY, REGION, &format!("{NAMED_REGION}{NAMED_REGION}")),
        @r#"scene.toml:11: [[region]] 2: group = "tissue" is taken by [[region]] 1 on line 5"#
    );
}

#[test]
fn two_regions_without_groups() {
    insta::assert_snapshot!(
        refusal(BODY, REGION, &format!("{REGION}{REGION}")),
        @r#"scene.toml:4: [[region]] 1: `group` is missing: expected a group, or where = "rest", as there are several regions"#
    );
}

#[test]
fn unknown_group() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "group = \"tisue\"\ndensity = 1060.0"),
        @r#"scene.toml:5: [[region]] 1: no group is named "tisue", did you mean "tissue"?; the groups are "tissue" (dimension 3), "sides" (dimension 2), "top" (dimension 2), "bottom" (dimension 2)"#
    );
}

#[test]
fn a_surface_for_a_region() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "group = \"top\"\ndensity = 1060.0"),
        @"scene.toml:5: [[region]] 1: group `top` has cells of dimension 2, expected a group of tetrahedra"
    );
}

#[test]
fn negative_damping() {
    insta::assert_snapshot!(
        refusal(BODY, "mass = 80.0", "mass = -80.0"),
        @"scene.toml:10: [damping]: mass = -80.0: expected a finite rate, 0 1/s or above"
    );
}

#[test]
fn damping_that_is_not_a_number() {
    insta::assert_snapshot!(
        refusal(BODY, "mass = 80.0", "stiffness = nan"),
        @"scene.toml:10: [damping]: stiffness = nan: expected a finite time, 0 s or above"
    );
}

#[test]
fn of_two_unknown_keys_the_first_in_the_file_is_named() {
    let message = refusal(
        BODY,
        "density = 1060.0",
        "zeta = 1\ndensity = 1060.0\nalpha = 2",
    );
    assert!(
        message.starts_with("scene.toml:5: [[region]] 1: unknown key `zeta`"),
        "{message}"
    );
}

/// The error of a linear region with these lines.
fn refused_element(lines: &str) -> String {
    let springs = "model = \"springs\"\nyoungs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }\n";
    let linear = "model = \"linear\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\n";
    refusal(BODY, springs, &format!("{linear}{lines}"))
}

#[test]
fn element_on_springs() {
    insta::assert_snapshot!(refusal(BODY, "springs = {", "element = \"fbar\"\nsprings = {"), @r#"scene.toml:8: [[region]] 1: `element` does not go with springs, which are no elements"#);
}

#[test]
fn unknown_element() {
    insta::assert_snapshot!(refused_element("element = \"f-bar\"\n"), @r#"
    scene.toml:9: [[region]] 1: element = "f-bar": expected "p1", "fbar" or "fbar-edge"
    help: did you mean `fbar`?
    "#);
}

#[test]
fn edge_share_without_edges() {
    insta::assert_snapshot!(refused_element("element = \"fbar\"\nedge_share = 0.5\n"), @r#"scene.toml:10: [[region]] 1: `edge_share` goes with element = "fbar-edge" only"#);
}

#[test]
fn edge_share_above_one() {
    insta::assert_snapshot!(refused_element("element = \"fbar-edge\"\nedge_share = 1.5\n"), @r#"scene.toml:10: [[region]] 1: edge_share = 1.5: expected a number from 0 to 1"#);
}

#[test]
fn patch_of_seven() {
    insta::assert_snapshot!(refused_element("element = \"fbar\"\npatch = 7\n"), @r#"scene.toml:10: [[region]] 1: patch = 7: expected a whole number from 8 to 1000"#);
}

#[test]
fn patch_of_plain_tetrahedra() {
    insta::assert_snapshot!(refused_element("patch = 12\n"), @r#"scene.toml:9: [[region]] 1: `patch` goes with element = "fbar" or "fbar-edge" only"#);
}

#[test]
fn constants_of_mooney_and_rivlin_with_another_law() {
    let lines = "c1_over_c2 = 4.0\n";
    insta::assert_snapshot!(refused_element(lines), @r#"scene.toml:9: [[region]] 1: `c1_over_c2` goes with model = "mooney-rivlin" only"#);
}

/// The error of a region of this law with these lines.
fn refused_law(law: &str, lines: &str) -> String {
    let springs = "model = \"springs\"\nyoungs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }\n";
    refusal(
        BODY,
        springs,
        &format!("model = \"{law}\"\nyoungs_modulus = 3500.0\n{lines}"),
    )
}

#[test]
fn mooney_and_rivlin_without_their_constants() {
    insta::assert_snapshot!(refused_law("mooney-rivlin", "poissons_ratio = 0.45\n"), @r#"scene.toml:4: [[region]] 1: `c1_over_c2` is missing: expected a finite ratio above 0"#);
}

/// The error of a region of the law of Yeoh with these lines.
fn refused_yeoh(lines: &str) -> String {
    let springs = "model = \"springs\"\nyoungs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }\n";
    refusal(BODY, springs, &format!("model = \"yeoh\"\n{lines}"))
}

#[test]
fn an_unknown_key_of_a_law_lists_the_keys_of_that_law() {
    let said = refused_yeoh("c9 = 600.0\npoissons_ratio = 0.45\n");
    insta::assert_snapshot!(said, @"
    scene.toml:7: [[region]] 1: unknown key `c9`; did you mean `c`?
    help: the keys here are `group`, `where`, `density`, `model`, `poissons_ratio`, `bulk_modulus`, `c`, `element`, `edge_share`, `patch`, `fibres`, `prony`, `viscous_part`, `moduli`
    ");
}

#[test]
fn a_law_with_moduli_of_its_own_takes_no_youngs_modulus() {
    let said = refused_yeoh("c = [600.0]\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\n");
    insta::assert_snapshot!(said, @"scene.toml:8: [[region]] 1: `youngs_modulus` does not go with this model, whose stiffness is given by its own parameters");
}

#[test]
fn a_first_constant_below_zero() {
    let said = refused_yeoh("c = [-600.0, 3.0]\npoissons_ratio = 0.45\n");
    insta::assert_snapshot!(said, @"scene.toml:7: [[region]] 1: c = [-600.0, 3.0]: expected c1 above 0 Pa");
}

#[test]
fn four_constants() {
    let said = refused_yeoh("c = [1.0, 2.0, 3.0, 4.0]\npoissons_ratio = 0.45\n");
    insta::assert_snapshot!(said, @"scene.toml:7: [[region]] 1: c = [1.0, 2.0, 3.0, 4.0]: expected a list of 1 to 3, each a finite modulus in Pa, the first above 0");
}

#[test]
fn neither_stiffness_of_volume() {
    insta::assert_snapshot!(refused_yeoh("c = [600.0]\n"), @"scene.toml:4: [[region]] 1: expected exactly one of `poissons_ratio`, `bulk_modulus`, found none");
}

#[test]
fn constants_of_yeoh_with_another_law() {
    let lines = "poissons_ratio = 0.45\nc = [600.0]\n";
    insta::assert_snapshot!(refused_law("neo-hookean", lines), @r#"scene.toml:9: [[region]] 1: `c` goes with model = "yeoh" or "fung" only"#);
}

#[test]
fn a_law_of_large_deformation_that_widens_when_pulled() {
    insta::assert_snapshot!(refused_law("neo-hookean", "poissons_ratio = -0.1\n"), @r#"scene.toml:8: [[region]] 1: poissons_ratio = -0.1: expected a number above -1 and below 0.5, from 0 on for laws of large deformation"#);
}

/// A stiffness that overflows is refused with a message about the step.
#[test]
fn a_stiffness_beyond_all_numbers() {
    let scene = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\n\
                 youngs_modulus = 1e308\npoissons_ratio = 0.4\n[[fixed]]\ngroup = \"bottom\"\n[run]\nduration = 0.1\n\
                 integrator = \"central-difference\"\ndt = \"auto\"\n";
    let scene =
        sinew_scene::Scene::parse(sinew_scene::SceneSource::new("scene.toml", scene)).unwrap();
    let refused = scene.build().unwrap_err().to_string();
    assert!(
        refused.ends_with("cannot tell up to which step it is stable"),
        "{refused}"
    );
}

/// The error of a region of the law of Ogden with these terms.
fn refused_ogden(terms: &str) -> String {
    let springs = "model = \"springs\"\nyoungs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }\n";
    let lines = format!("model = \"ogden\"\npoissons_ratio = 0.45\nterms = {terms}\n");
    refusal(BODY, springs, &lines)
}

#[test]
fn terms_that_are_no_pairs() {
    insta::assert_snapshot!(refused_ogden("[[600.0, 2.0], [1.0]]"), @"scene.toml:8: [[region]] 1: terms = [[600.0, 2.0], [1.0]]: expected a list of 1 to 6 of [mu in Pa, alpha], each of a finite modulus in Pa and a finite exponent other than 0");
    insta::assert_snapshot!(refused_ogden("[600.0, 2.0]"), @"scene.toml:8: [[region]] 1: terms = [600.0, 2.0]: expected a list of 1 to 6 of [mu in Pa, alpha], each of a finite modulus in Pa and a finite exponent other than 0");
    insta::assert_snapshot!(refused_ogden("[]"), @"scene.toml:8: [[region]] 1: terms = []: expected a list of 1 to 6 of [mu in Pa, alpha], each of a finite modulus in Pa and a finite exponent other than 0");
}

#[test]
fn terms_that_make_no_law() {
    insta::assert_snapshot!(refused_ogden("[[600.0, 0.0]]"), @"scene.toml:8: [[region]] 1: terms = [[600.0, 0.0]]: expected an alpha other than 0 in each term");
    insta::assert_snapshot!(refused_ogden("[[600.0, 2.0], [-600.0, 4.0]]"), @"scene.toml:8: [[region]] 1: terms = [[600.0, 2.0], [-600.0, 4.0]]: expected a sum of mu above 0 Pa");
}

#[test]
fn two_stiffnesses_of_volume_beside_youngs_modulus() {
    let lines = "poissons_ratio = 0.45\nbulk_modulus = 35000.0\n";
    insta::assert_snapshot!(refused_law("neo-hookean-iso", lines), @"scene.toml:9: [[region]] 1: expected exactly one of `poissons_ratio`, `bulk_modulus`, found `poissons_ratio`, `bulk_modulus`");
    insta::assert_snapshot!(refused_law("neo-hookean-iso", "bulk_modulus = 1000.0\n"), @"scene.toml:8: [[region]] 1: bulk_modulus = 1000.0: expected at least 1/3 of Young's modulus: Poisson's ratio is 0 or above for laws of large deformation");
}

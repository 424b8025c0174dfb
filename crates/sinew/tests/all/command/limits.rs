//! Runs that end at the limit of a law.

use std::fs;

use crate::common::sinew;

/// A cube that is pulled, by a law of its own.
fn scene(law: &str, pull: &str, method: &str) -> String {
    format!(
        "[mesh]\ncube = {{ cells = 2, edge = 0.1 }}\n[[region]]\ndensity = 1060.0\n{law}\n[damping]\nmass = 20.0\n\
         [[fixed]]\ngroup = \"bottom\"\n{pull}\nramp = {{ kind = \"table\", times = [0.0, 0.2], values = [0.0, 1.0] }}\n\
         [run]\nduration = 0.2\nintegrator = \"{method}\"\ndt = 0.002\n"
    )
}

/// Every method names the element and the reason of the law, for every way to this state.
#[test]
fn a_run_that_ends_at_a_limit_names_the_element_and_the_reason() {
    let gent = "model = \"gent\"\nshear_modulus = 1200.0\nlimit = 0.5\npoissons_ratio = 0.45";
    let skin = "model = \"veronda-westmann\"\nc1 = 1.0\nc2 = 300.0\npoissons_ratio = 0.45";
    let fibres = "model = \"neo-hookean-iso\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.45\n\
                  fibres = { direction = [0.0, 0.0, 1.0], k1 = 1.0, k2 = 500.0 }";
    let load = "[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, 1e6]";
    let moved = "[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, 0.2]";
    let of_gent = "the law `gent` ends where its chains are straight";
    let of_skin = "the law `veronda-westmann` ends where exp(";
    let of_fibres = "its fibres are stretched until exp(k2 X^2)";
    let folder = tempfile::tempdir().unwrap();
    for (law, pull, method, reason) in [
        (gent, load, "newmark", of_gent),
        (gent, load, "generalized-alpha", of_gent),
        (gent, moved, "cnn-energy", of_gent),
        (skin, moved, "newmark", of_skin),
        (skin, moved, "cnn-energy", of_skin),
        (fibres, moved, "newmark", of_fibres),
        (fibres, moved, "implicit-euler", of_fibres),
        (fibres, moved, "cnn-energy", of_fibres),
    ] {
        fs::write(folder.path().join("a.toml"), scene(law, pull, method)).unwrap();
        let said = sinew(folder.path(), &["run", "a.toml", "--out", "out", "--force"]);
        assert!(
            said.code.is_some_and(|code| code != 0),
            "{method}: {}",
            said.out
        );
        let is_named = said.err.contains("element ") && said.err.contains(reason);
        assert!(is_named, "{method}: {}", said.err);
    }
}

#[test]
fn modes_say_that_fibres_are_idle_at_rest() {
    let law = "model = \"neo-hookean\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.45\n\
               fibres = { direction = [0.0, 0.0, 1.0], eta = 1e5 }";
    let moved = "[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, 0.0]";
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), scene(law, moved, "newmark")).unwrap();
    let said = sinew(folder.path(), &["modes", "a.toml", "--count", "3"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(
        said.out
            .contains("without the fibres, which are idle at rest"),
        "{}",
        said.out
    );
}

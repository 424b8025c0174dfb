//! The paper's figures and claims.

use std::path::PathBuf;

use sinew_bench::reproduce::{Holds, Reproduction, reproduce};
use sinew_measure::Case;
use sinew_scene::output::OutputFolder;

fn case(name: &str) -> Case {
    let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    Case::load(&scenes.join(name)).unwrap()
}

#[test]
fn every_figure_and_every_claim() {
    let reproduction = reproduce(
        &mut case("paper-oscillator.toml"),
        &mut case("paper-cube.toml"),
    )
    .unwrap();
    let numbers: Vec<&str> = reproduction
        .figures
        .iter()
        .map(|figure| figure.number)
        .collect();
    assert_eq!(numbers, ["1b", "2a", "2b", "3a", "3b", "4b", "4c", "4d"]);

    let claim = |place: &str, word: &str| {
        let mut claims = reproduction.claims.iter();
        claims
            .find(|claim| claim.place == place && claim.says.contains(word))
            .unwrap()
    };
    let small = claim("4.1, Fig. 2a", "almost identical");
    assert!(small.measured.contains("7.36 %") && small.measured.contains("0.12602 m"));
    assert_eq!(small.holds, Holds::InPart);
    assert_eq!(claim("4.1, Fig. 1b", "diverges").holds, Holds::Yes);
    let limit_cycles = claim("4.1, Fig. 3b", "smaller Q");
    assert!(limit_cycles.measured.contains("0.255/0.204/0.128"));
    assert!(limit_cycles.measured.contains("426 %") && limit_cycles.measured.contains("239 %"));
    assert_eq!(claim("4.2, Fig. 4b", "identical").holds, Holds::Yes);
    let large = claim("4.2, Fig. 4d", "stable");
    assert!(large.measured.contains("1676 tetrahedra inverted"));
    assert_eq!(large.holds, Holds::InPart);
    assert!(claim("4.2, Fig. 4c", "unstable").measured.contains("e30 m"));

    let directory = tempfile::tempdir().unwrap();
    let folder = OutputFolder::new(directory.path(), &[]);
    let written = reproduction.write(&folder).unwrap();
    assert_eq!(written.figures.len(), 8);
    let entries = std::fs::read_dir(directory.path()).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    let mut known = Reproduction::output_files();
    names.sort();
    known.sort();
    assert_eq!(names, known);
    let table = std::fs::read_to_string(written.claims).unwrap();
    assert_eq!(table.lines().count(), 2 + reproduction.claims.len());
}

#[test]
fn cases_of_the_wrong_kind_are_refused() {
    let mut oscillator = case("paper-oscillator.toml");
    let mut cube = case("paper-cube.toml");
    let error = reproduce(&mut oscillator, &mut case("paper-oscillator.toml")).unwrap_err();
    assert_eq!(
        error.to_string(),
        "paper-oscillator: expected the paper's cube, a body"
    );
    let error = reproduce(&mut cube, &mut case("paper-cube.toml")).unwrap_err();
    assert_eq!(
        error.to_string(),
        "paper-cube: expected the paper's oscillator, one degree of freedom"
    );
}

//! The verification as its users call it.

use std::path::Path;

use sinew_verify::{Machine, Verification, VerifyPlan};

fn plan(only: &[&str]) -> VerifyPlan {
    VerifyPlan {
        root: Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."),
        only: only.iter().map(|&name| name.to_owned()).collect(),
        long: false,
        threads: 2,
    }
}

fn run(only: &[&str]) -> Verification {
    plan(only)
        .run("r".into(), Machine::default(), |_| {})
        .unwrap()
}

/// Subjects whose rows are all computed here; the others take long without optimisation, and `cargo xtask ci` computes
/// them.
const QUICK: [&str; 19] = [
    "uniform-strain",
    "cook",
    "free-cube",
    "convergence",
    "oscillator",
    "bar",
    "motion",
    "laws",
    "springs",
    "hyperelastic",
    "fibres",
    "axes",
    "memory",
    "hanging-bar",
    "bent-beam",
    "tissue-laws",
    "contact",
    "cutting",
    "slits",
];

#[test]
fn quick_subjects_pass_and_come_in_the_order_of_the_page() {
    let verification = run(&QUICK);
    let ids: Vec<&str> = verification
        .subjects
        .iter()
        .map(|subject| subject.id)
        .collect();
    assert_eq!(ids, QUICK);
    let failures: Vec<_> = verification.failures().map(|(_, row)| row).collect();
    assert!(failures.is_empty(), "{failures:?}");
    assert!(verification.rows().count() > 1000);
}

#[test]
fn page_and_json_have_every_row_with_its_source() {
    let verification = run(&["springs"]);
    let page = verification.html();
    let json = serde_json::to_value(&verification).unwrap();
    let rows = json["subjects"][0]["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 12);
    for row in rows {
        let [case, figure, source] = [&row["case"], &row["figure"], &row["source"]["reference"]]
            .map(|text| text.as_str().unwrap().replace('\'', "&#39;"));
        assert!(page.contains(&case) && page.contains(&figure) && page.contains(&source));
        assert_eq!(row["verdict"], "pass");
        assert_eq!(row["asked"]["kind"], "value");
        assert!(row["got"].as_f64().unwrap().is_finite());
    }
}

#[test]
fn a_subject_that_does_not_exist_is_named_with_those_that_do() {
    let unknown = plan(&["sprigns"]).run("r".into(), Machine::default(), |_| {});
    let message = unknown.unwrap_err().to_string();
    assert!(
        message.contains("\"sprigns\"") && message.contains("cantilever, cook"),
        "{message}"
    );
}

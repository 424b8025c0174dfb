//! `cargo xtask verify`.

use std::path::PathBuf;

use sinew_scene::output::{OutputFolder, OwnedFolder, say};
use sinew_verify::{Verification, VerifyPlan, WriteVerificationError};
use sinew_verify::{machine, revision};

use crate::failure::Failure;
use crate::progress::Bar;
use crate::repository::root;

/// The kind of the folder, which is also its name under `target`.
const KIND: &str = "verify";

/// Subjects to verify, and the folder for page and JSON.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Also run the rows that take long
    #[arg(long)]
    long: bool,
    /// A subject by its short name; may be given several times [default: all]
    #[arg(long = "subject", value_name = "NAME")]
    subjects: Vec<String>,
    /// Print every row instead of counts and failures
    #[arg(long)]
    all: bool,
    /// The folder for verification.html and verification.json, checked before anything is computed [default: target/verify]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let plan = VerifyPlan {
        root: root(),
        only: arguments.subjects.clone(),
        long: arguments.long,
        threads: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
    };
    let out = arguments.out.clone();
    let folder = OutputFolder::new(out.unwrap_or_else(|| root().join("target").join(KIND)), &[]);
    let names = Verification::output_files();
    folder.check(&names)?;
    OwnedFolder::check(folder.path(), KIND, &[])?;
    let bar = Bar::new();
    let verification = plan.run(revision(&root()), machine(), |progress| bar.show(progress));
    bar.finish();
    let verification = verification.map_err(Failure::input)?;
    let _mine = OwnedFolder::claim(folder.path(), KIND, &[], &names)?;
    conclude(&verification, &folder, arguments.all)
}

/// Writes and prints everything, then fails if a row fails.
fn conclude(verification: &Verification, folder: &OutputFolder, all: bool) -> Result<(), Failure> {
    let written = verification.write(folder).map_err(|error| match error {
        WriteVerificationError::Output(error) => error.into(),
        error => Failure::chore(error),
    })?;
    say(&match all {
        true => verification.to_string(),
        false => verification.brief(),
    })?;
    say(&format!(
        "\nresults: {}\npage:    {}",
        written.json.display(),
        written.page.display()
    ))?;
    match verification.failures().next() {
        None => Ok(()),
        Some(_) => Err(Failure::Chore(verification.summary())),
    }
}

#[cfg(test)]
mod tests {
    use std::process::ExitCode;

    use sinew_verify::MarkVerdict;
    use sinew_verify::{Asked, Source, VerifiedRow, VerifiedSubject};

    use super::*;

    /// Files that a verification of one row leaves in a folder, and the result of the command.
    fn concluded(got: f64, verdict: MarkVerdict) -> (Result<(), Failure>, String) {
        let row = VerifiedRow {
            case: "a beam".into(),
            figure: "deflection".into(),
            asked: Asked::value(1.0, 0.01),
            got: Some(got),
            missing: None,
            source: Source::ClosedForm("Timoshenko"),
            verdict,
            note: "",
            seconds: 0.0,
        };
        let verification = Verification {
            schema: 1,
            revision: "r".into(),
            machine: machine(),
            subjects: vec![VerifiedSubject {
                id: "beams",
                title: "Beams",
                says: "",
                rows: vec![row],
                quoted: &[],
            }],
            left_out: 0,
        };
        let directory = tempfile::tempdir().unwrap();
        let folder = OutputFolder::new(directory.path(), &[]);
        let outcome = conclude(&verification, &folder, false);
        let page = std::fs::read_to_string(directory.path().join("verification.html")).unwrap();
        assert!(directory.path().join("verification.json").exists());
        (outcome, page)
    }

    #[test]
    fn a_wrong_figure_is_written_and_then_exits_with_1() {
        let (outcome, page) = concluded(1.3, MarkVerdict::Fail);
        assert!(page.contains("FAIL") && page.contains("1.3"));
        let code = outcome.unwrap_err().report();
        assert_eq!(format!("{code:?}"), format!("{:?}", ExitCode::from(1)));
    }

    #[test]
    fn figures_that_pass_are_no_failure() {
        let (outcome, page) = concluded(1.003, MarkVerdict::Pass);
        assert!(outcome.is_ok() && !page.contains("FAIL"));
    }
}

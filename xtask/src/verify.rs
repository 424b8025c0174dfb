//! `cargo xtask verify`.

use std::path::PathBuf;

use sinew_bench::output::{OutputFolder, OwnedFolder, say};
use sinew_bench::verify::{Verification, VerifyPlan, WriteVerificationError};
use sinew_bench::{machine, revision};

use crate::failure::Failure;
use crate::progress::Bar;
use crate::repository::root;

/// The kind of the folder, which is also its name under `target`.
const KIND: &str = "verify";

/// Subjects to verify, and the folder for page and JSON.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Run the rows that take long, too
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

/// Writes and prints everything, then fails if a row does.
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

//! `cargo xtask reproduce`.

use std::path::PathBuf;

use sinew_bench::reproduce::reproduce;
use sinew_measure::Case;

use crate::bench::say;
use crate::failure::Failure;
use crate::root;

/// Where to write.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Where the figures and the table go [default: target/reproduce]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let case = |name: &str| Case::load(&root().join("scenes").join(name)).map_err(Failure::input);
    let mut oscillator = case("paper-oscillator.toml")?;
    let mut cube = case("paper-cube.toml")?;
    let reproduction = reproduce(&mut oscillator, &mut cube).map_err(Failure::chore)?;
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| root().join("target").join("reproduce"));
    let written = reproduction.write(&out).map_err(Failure::input)?;
    for claim in &reproduction.claims {
        let (place, says, verdict) = (claim.place, claim.says, claim.holds.word());
        say(&format!(
            "{place}: {says}\n    {verdict}: {}",
            claim.measured
        ));
    }
    say(&format!(
        "page:    {}\ntable:   {}\nfigures: {}",
        written.page.display(),
        written.claims.display(),
        out.display()
    ));
    Ok(())
}

//! The `sinew` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(sinew::cli::run(std::env::args_os()))
}

//! The program as a user runs it.

use std::process::Command;

#[test]
fn it_ends_without_an_error() -> std::io::Result<()> {
    let output = Command::new(env!("CARGO_BIN_EXE_own-law")).output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    Ok(())
}

//! System libraries that a program needs.

use std::fmt;
use std::path::Path;

use crate::failure::Failure;

/// Requirements of a program.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Needs {
    /// No library of the system: the program contains all it needs.
    Nothing,
    /// The C library of GNU from this version on: major, minor, patch.
    Glibc([u32; 3]),
    /// Only the libraries that every system of this kind has.
    System,
}

impl fmt::Display for Needs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("It needs Linux and no library of the system"),
            Self::Glibc([major, minor, 0]) => write!(f, "It needs glibc {major}.{minor} or later"),
            Self::Glibc([major, minor, patch]) => {
                write!(f, "It needs glibc {major}.{minor}.{patch} or later")
            }
            Self::System => f.write_str("It needs the libraries of the system only"),
        }
    }
}

/// Reads the needs of a program for this target from its symbols.
///
/// # Errors
/// [`Failure::Chore`] if it cannot be read.
pub(super) fn of(program: &Path, target: &str) -> Result<Needs, Failure> {
    if !target.contains("linux") {
        return Ok(Needs::System);
    }
    let bytes = std::fs::read(program).map_err(Failure::chore)?;
    Ok(of_elf(&bytes))
}

/// A program that loads libraries names the loader; its symbols contain the version of glibc that introduced them.
fn of_elf(bytes: &[u8]) -> Needs {
    const LOADER: &[u8] = b"/ld-";
    const VERSION: &[u8] = b"GLIBC_";
    // The loader's name stands near the start, in a segment of its own.
    let start = &bytes[..bytes.len().min(4096)];
    if !start.windows(LOADER.len()).any(|part| part == LOADER) {
        return Needs::Nothing;
    }
    let found = bytes
        .windows(VERSION.len())
        .enumerate()
        .filter(|(_, part)| *part == VERSION)
        .filter_map(|(at, _)| version(&bytes[at + VERSION.len()..]));
    found.max().map_or(Needs::System, Needs::Glibc)
}

/// The version at the start of a text that ends with a zero byte.
fn version(bytes: &[u8]) -> Option<[u32; 3]> {
    let end = bytes.iter().take(16).position(|byte| *byte == 0)?;
    let text = std::str::from_utf8(&bytes[..end]).ok()?;
    let mut parts = text.split('.').map(str::parse::<u32>);
    let mut version = [parts.next()?.ok()?, parts.next()?.ok()?, 0];
    if let Some(patch) = parts.next() {
        version[2] = patch.ok()?;
    }
    Some(version)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_version_among_the_symbols_is_the_one_needed() {
        let program = b"\x7fELF /lib64/ld-linux-x86-64.so.2\0 GLIBC_2.9\0GLIBC_2.34\0GLIBC_2.3.4\0GLIBC_PRIVATE\0";
        assert_eq!(of_elf(program), Needs::Glibc([2, 34, 0]));
    }

    #[test]
    fn a_program_without_a_loader_needs_nothing() {
        assert_eq!(of_elf(b"\x7fELF no loader, GLIBC_2.34\0"), Needs::Nothing);
    }
}

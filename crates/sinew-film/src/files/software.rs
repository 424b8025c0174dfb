//! The program that wrote a file.

/// The mark of the writing program in files: a keyword of the PNG standard, and the program.
pub(super) const SOFTWARE: [&str; 2] = ["Software", "sinew film"];

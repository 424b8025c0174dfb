//! Who wrote a file.

/// What the files say of who wrote them: a keyword of the PNG standard, and the program.
pub(super) const SOFTWARE: [&str; 2] = ["Software", "sinew film"];

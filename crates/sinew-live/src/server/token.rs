//! The secret in the address of a page.

use std::fmt::{self, Debug, Display, Formatter, Write};

/// Random bytes of a token.
const BYTES: usize = 16;

/// A secret that the address of the page contains, so that no other page and no other user of this computer finds it.
#[derive(Clone)]
pub(crate) struct Token(String);

/// Without the secret, so that no message shows it by mistake.
impl Debug for Token {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("Token(..)")
    }
}

impl Token {
    /// A new random token.
    pub(crate) fn random() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; BYTES];
        getrandom::fill(&mut bytes)?;
        let mut text = String::with_capacity(2 * BYTES);
        for byte in bytes {
            // Writing to a string never fails.
            let _ = write!(text, "{byte:02x}");
        }
        Ok(Self(text))
    }

    /// True if a text is this token. The time taken does not depend on the position of a difference.
    pub(crate) fn is(&self, text: &str) -> bool {
        if text.len() != self.0.len() {
            return false;
        }
        let pairs = self.0.bytes().zip(text.bytes());
        let differences = pairs.fold(0, |sum, (own, other)| sum | (own ^ other));
        std::hint::black_box(differences) == 0
    }
}

impl Display for Token {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_itself_and_nothing_else() {
        let (token, other) = (Token::random().unwrap(), Token::random().unwrap());
        let text = token.to_string();
        assert_eq!(text.len(), 2 * BYTES);
        assert!(token.is(&text) && !other.is(&text));
        assert!(!token.is("") && !token.is(&text[1..]) && !token.is(&format!("{text}0")));
    }
}

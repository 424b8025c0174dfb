//! A place in the bytes, moving forward only.

use super::fault::Fault;

/// Longer tokens and lines belong to no .msh file; messages that quote them stay short too.
pub(super) const LONGEST: usize = 4096;

pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    offset: usize,
}

/// A run of bytes without blanks.
#[derive(Clone, Copy)]
pub(super) struct Token<'a> {
    pub(super) text: &'a [u8],
    pub(super) offset: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Cursor<'a> {
        const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
        let offset = if bytes.starts_with(BYTE_ORDER_MARK) {
            BYTE_ORDER_MARK.len()
        } else {
            0
        };
        Cursor { bytes, offset }
    }

    pub(super) fn offset(&self) -> usize {
        self.offset
    }

    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.offset..).unwrap_or_default()
    }

    /// The bytes from an earlier offset to here.
    pub(super) fn since(&self, offset: usize) -> &'a [u8] {
        self.bytes.get(offset..self.offset).unwrap_or_default()
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.rest().is_empty()
    }

    /// Moves over blanks and line breaks; tells whether there was a line break.
    pub(super) fn skip_blanks(&mut self) -> bool {
        let mut passed_line_break = false;
        for &byte in self.rest() {
            if !is_blank(byte) {
                break;
            }
            passed_line_break |= byte == b'\n';
            self.offset += 1;
        }
        passed_line_break
    }

    /// Whether nothing but blanks is left on this line.
    pub(super) fn is_at_line_end(&self) -> bool {
        let next = self
            .rest()
            .iter()
            .find(|&&byte| byte == b'\n' || !is_blank(byte));
        next.is_none_or(|&byte| byte == b'\n')
    }

    /// The next token, on this line or a later one; `what` names it for the message.
    pub(super) fn token(&mut self, what: &str) -> Result<Token<'a>, Fault> {
        self.skip_blanks();
        let offset = self.offset;
        let rest = self.rest();
        let length = rest
            .iter()
            .take(LONGEST + 1)
            .take_while(|&&byte| !is_blank(byte))
            .count();
        if length == 0 {
            return Err(Fault::shortage(offset, "the file ends here", what));
        }
        if length > LONGEST {
            let problem = format!("a word is longer than {LONGEST} bytes");
            return Err(Fault::new(offset, problem, what));
        }
        self.offset += length;
        let text = rest.get(..length).unwrap_or_default();
        Ok(Token { text, offset })
    }

    /// The rest of this line without its line break and surrounding blanks; moves to the next line.
    pub(super) fn line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest
            .iter()
            .position(|&byte| byte == b'\n')
            .unwrap_or(rest.len());
        self.offset += rest.len().min(length + 1);
        rest.get(..length).unwrap_or_default().trim_ascii()
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | b'\x0b' | b'\x0c')
}

/// Bytes of the file as a message can show them: short, printable, in quotes.
pub(super) fn quoted(bytes: &[u8]) -> String {
    const SHOWN: usize = 40;
    let text = String::from_utf8_lossy(bytes.get(..SHOWN).unwrap_or(bytes));
    let more = if bytes.len() > SHOWN { "..." } else { "" };
    let text = text
        .escape_debug()
        .to_string()
        .replace("\\\"", "\"")
        .replace("\\'", "'");
    format!("\"{text}{more}\"")
}

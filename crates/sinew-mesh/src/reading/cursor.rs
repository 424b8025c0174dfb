//! A position in the bytes of a file that moves forward only.

use super::fault::Fault;

/// Greatest length of a token or line. Longer ones belong to no mesh file, and messages that quote them stay short.
pub(crate) const LONGEST: usize = 4096;

#[derive(Clone)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    offset: usize,
    /// Offset after the last line break that was passed.
    line_start: usize,
}

/// A run of bytes without blanks.
#[derive(Clone, Copy)]
pub(crate) struct Token<'a> {
    pub(crate) text: &'a [u8],
    pub(crate) offset: usize,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Cursor<'a> {
        const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
        let offset = if bytes.starts_with(BYTE_ORDER_MARK) {
            BYTE_ORDER_MARK.len()
        } else {
            0
        };
        Cursor {
            bytes,
            offset,
            line_start: offset,
        }
    }

    /// A cursor at an offset.
    pub(crate) fn at(bytes: &'a [u8], offset: usize) -> Cursor<'a> {
        Cursor {
            bytes,
            offset: offset.min(bytes.len()),
            line_start: 0,
        }
    }

    pub(crate) fn offset(&self) -> usize {
        self.offset
    }

    pub(crate) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.offset..).unwrap_or_default()
    }

    /// Number of bytes in the whole file.
    pub(crate) fn file_length(&self) -> usize {
        self.bytes.len()
    }

    /// True if a line break was passed since an earlier offset.
    pub(crate) fn has_passed_line_break_since(&self, offset: usize) -> bool {
        self.line_start > offset
    }

    pub(crate) fn is_at_end(&self) -> bool {
        self.rest().is_empty()
    }

    /// Moves over blanks and line breaks. Returns true if there was a line break.
    #[inline]
    pub(crate) fn skip_blanks(&mut self) -> bool {
        let mut passed_line_break = false;
        while let Some(&byte) = self.bytes.get(self.offset) {
            if !is_blank(byte) {
                break;
            }
            self.offset += 1;
            if byte == b'\n' {
                passed_line_break = true;
                self.line_start = self.offset;
            }
        }
        passed_line_break
    }

    /// Moves over a word if more words follow on the same line; otherwise does not move.
    pub(crate) fn begins_with_word(&mut self, word: &[u8]) -> bool {
        let after = self.rest().strip_prefix(word);
        let Some([next, ..]) = after else {
            return false;
        };
        let mut ahead = self.clone();
        ahead.offset += word.len();
        let found = is_blank(*next) && !ahead.is_at_line_end();
        if found {
            *self = ahead;
        }
        found
    }

    /// True if only blanks remain on this line.
    pub(crate) fn is_at_line_end(&self) -> bool {
        let next = self
            .rest()
            .iter()
            .find(|&&byte| byte == b'\n' || !is_blank(byte));
        next.is_none_or(|&byte| byte == b'\n')
    }

    /// The next token, on this line or a later one; `what` names it for the message.
    #[inline]
    pub(crate) fn token(&mut self, what: &str) -> Result<Token<'a>, Fault> {
        self.skip_blanks();
        let offset = self.offset;
        let rest = self.rest();
        let window = rest.get(..=LONGEST).unwrap_or(rest);
        let length = window
            .iter()
            .position(|&byte| is_blank(byte))
            .unwrap_or(window.len());
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

    /// The next token, if it is a number of at most 19 decimal digits. Otherwise only blanks are skipped.
    #[inline]
    pub(crate) fn plain_number(&mut self) -> Option<u64> {
        self.skip_blanks();
        let rest = self.rest();
        let (value, length) = match rest.first_chunk() {
            Some(&chunk) => match short_number(chunk) {
                (_, 8) => long_number(rest)?,
                short => short,
            },
            None => long_number(rest)?,
        };
        if length == 0 || !is_blank(*rest.get(length)?) {
            return None;
        }
        self.offset += length;
        Some(value)
    }

    /// The rest of this line without its line break and surrounding blanks; moves to the next line.
    pub(crate) fn line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest
            .iter()
            .position(|&byte| byte == b'\n')
            .unwrap_or(rest.len());
        self.offset += rest.len().min(length + 1);
        self.line_start = self.offset;
        rest.get(..length).unwrap_or_default().trim_ascii()
    }

    /// Moves past the end of this line, on which only blanks may come before it.
    pub(crate) fn line_end(&mut self, after: &str) -> Result<(), Fault> {
        let offset = self.offset;
        match self.line() {
            [] => Ok(()),
            line => Err(Fault::new(
                offset,
                format!("{} follows {after}", quoted(line)),
                "the end of the line",
            )),
        }
    }

    /// The next `length` bytes, or nothing if the file has fewer left.
    #[inline]
    pub(crate) fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let taken = self.rest().get(..length)?;
        self.offset += length;
        Some(taken)
    }
}

/// The digits at the start of eight bytes, as a number, and their count. All bytes are processed together (Lemire 2018,
/// "Quickly parsing eight digits").
#[inline]
fn short_number(bytes: [u8; 8]) -> (u64, usize) {
    const EACH: u64 = 0x0101_0101_0101_0101;
    let bytes = u64::from_le_bytes(bytes);
    // The top bit of a byte is set where the byte is no digit; carries go to later bytes only.
    let digits = bytes ^ (EACH * 0x30);
    let above_9 = (digits & (EACH * 0x7f)) + EACH * 0x76;
    let others = (above_9 | digits) & (EACH * 0x80);
    let length = others.trailing_zeros() as usize / 8;
    if length == 0 {
        return (0, 0);
    }
    // The last digit goes into the last byte; zeros come before the first.
    let digits = (digits << (64 - 8 * length)) & (EACH * 0x0f);
    let pairs = (digits * 10 + (digits >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    let all = (fours.wrapping_mul(10_000)).wrapping_add(fours >> 32) & 0xffff_ffff;
    (all, length)
}

/// The number of up to 19 digits at the start of the bytes, and the count of digits.
fn long_number(bytes: &[u8]) -> Option<(u64, usize)> {
    let length = bytes
        .iter()
        .take(20)
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    let digits = bytes.get(..length).filter(|digits| digits.len() < 20)?;
    let value = digits
        .iter()
        .fold(0, |value: u64, byte| value * 10 + u64::from(byte - b'0'));
    Some((value, length))
}

#[inline]
fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | b'\x0b' | b'\x0c')
}

/// Bytes of the file for a message: short, printable, in quotes.
pub(crate) fn quoted(bytes: &[u8]) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_numbers_of_every_length_are_read() {
        let mut expected: u64 = 0;
        let mut text = String::new();
        for digit in "9876543210123456789".chars() {
            text.push(digit);
            expected = expected * 10 + u64::from(digit as u8 - b'0');
            for after in [" ", "\n", "\t 4711 4711", " x and more"] {
                let file = format!("  {text}{after}");
                let mut cursor = Cursor::new(file.as_bytes());
                assert_eq!(cursor.plain_number(), Some(expected), "{file:?}");
                assert_eq!(cursor.offset(), 2 + text.len());
            }
        }
    }

    #[test]
    fn other_tokens_are_left_alone() {
        for text in [
            "",
            "x",
            "-1 ",
            "+1 ",
            "1.5 ",
            "12345678.5 ",
            "1e3 ",
            "12x4567890 ",
            "\u{0}1 ",
            "98765432109876543210 ",
            "1/2 ",
            "1:2 ",
            "\u{b1} ",
        ] {
            let mut cursor = Cursor::new(text.as_bytes());
            assert_eq!(cursor.plain_number(), None, "{text:?}");
            assert_eq!(cursor.offset(), 0, "{text:?}");
        }
        // The last number of a file may be cut off, so it is left to the slower way.
        assert_eq!(Cursor::new(b"12").plain_number(), None);
    }

    #[test]
    fn every_byte_ends_a_short_number_or_belongs_to_it() {
        for byte in 0..=u8::MAX {
            let bytes = [b'4', b'2', byte, b'7', b'7', b'7', b'7', b' '];
            let expected = if byte.is_ascii_digit() {
                (4_207_777 + 10_000 * u64::from(byte - b'0'), 7)
            } else {
                (42, 2)
            };
            assert_eq!(short_number(bytes), expected, "{byte}");
        }
    }
}

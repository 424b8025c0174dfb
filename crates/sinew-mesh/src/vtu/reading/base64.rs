//! Base64 decoded piece by piece.

/// A reader of consecutive base64 texts of RFC 4648: pieces that are each padded with `=` are read as one.
pub(super) struct Base64<'a> {
    text: &'a [u8],
    /// Decoded bytes that were not requested yet, the next one last.
    waiting: Vec<u8>,
}

/// The value of each digit; other characters have [`NO_DIGIT`].
const VALUES: [u8; 256] = values();

#[allow(
    clippy::indexing_slicing,
    reason = "an index that is out of bounds would not compile"
)]
const fn values() -> [u8; 256] {
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut values = [NO_DIGIT; 256];
    let mut value = 0;
    while value < digits.len() {
        values[digits[value] as usize] = value as u8;
        value += 1;
    }
    values
}

const NO_DIGIT: u8 = 64;

impl<'a> Base64<'a> {
    pub(super) fn new(text: &'a [u8]) -> Base64<'a> {
        Base64 {
            text,
            waiting: Vec::new(),
        }
    }

    /// The next `length` bytes; `None` if there are fewer, or the text is not base64.
    pub(super) fn take(&mut self, length: usize) -> Option<Vec<u8>> {
        // Four characters make at most three bytes.
        if length > self.waiting.len().saturating_add(self.text.len()) {
            return None;
        }
        let mut bytes = Vec::with_capacity(length);
        while bytes.len() < length {
            if let Some(byte) = self.waiting.pop() {
                bytes.push(byte);
                continue;
            }
            let (group, count) = self.group()?;
            match bytes.len() + count <= length {
                true => bytes.extend(group.get(..count)?),
                false => self.waiting.extend(group.get(..count)?.iter().rev()),
            }
        }
        Some(bytes)
    }

    /// Decodes the next four characters to up to three bytes.
    fn group(&mut self) -> Option<([u8; 3], usize)> {
        let mut digits = [0; 4];
        let mut count = 0;
        if let Some((&group, rest)) = self.text.split_first_chunk::<4>()
            && let values = group.map(value)
            && values.iter().all(|value| *value < NO_DIGIT)
        {
            self.text = rest;
            digits = values;
            count = 4;
        } else {
            let mut place = 0;
            while place < 4 {
                let (&character, rest) = self.text.split_first()?;
                self.text = rest;
                if character.is_ascii_whitespace() {
                    continue;
                }
                if character != b'=' {
                    let digit = value(character);
                    if digit == NO_DIGIT || count < place {
                        return None;
                    }
                    *digits.get_mut(place)? = digit;
                    count += 1;
                }
                place += 1;
            }
        }
        let [a, b, c, d] = digits.map(u32::from);
        let [_, bytes @ ..] = (a << 18 | b << 12 | c << 6 | d).to_be_bytes();
        (count > 1).then(|| (bytes, count - 1))
    }
}

#[allow(
    clippy::indexing_slicing,
    reason = "the table has a place for every byte"
)]
fn value(character: u8) -> u8 {
    VALUES[character as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_with_and_without_padding_read_as_one() {
        let mut base64 = Base64::new(b"Zg==Zm8=\n Zm 9v Zm9vYmFy=");
        assert_eq!(base64.take(2).unwrap(), b"ff");
        assert_eq!(base64.take(7).unwrap(), b"ofoofoo");
        assert_eq!(base64.take(3).unwrap(), b"bar");
        assert_eq!(base64.take(0).unwrap(), b"");
        assert_eq!(base64.take(1), None);
    }

    #[test]
    fn other_characters_and_cut_groups_are_no_bytes() {
        for text in ["Zm9", "Zm!v", "Z===", "Zm=v", "====", ""] {
            assert_eq!(Base64::new(text.as_bytes()).take(3), None, "{text}");
        }
        assert_eq!(Base64::new(b"Zm9v").take(usize::MAX), None);
    }
}

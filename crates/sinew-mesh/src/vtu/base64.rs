//! Base64 of RFC 4648.

use std::io::{self, Write};

/// A writer that encodes its input.
pub(super) struct Base64<W> {
    to: W,
    /// Up to two bytes that wait for a third.
    waiting: [u8; 3],
    count: usize,
}

impl<W: Write> Base64<W> {
    pub(super) fn new(to: W) -> Base64<W> {
        Base64 {
            to,
            waiting: [0; 3],
            count: 0,
        }
    }

    fn group(&mut self) -> io::Result<()> {
        const DIGITS: &[u8; 64] =
            b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let [a, b, c] = self.waiting.map(u32::from);
        let bits = a << 16 | b << 8 | c;
        let mut digits = [18, 12, 6, 0].map(|shift| DIGITS[(bits >> shift & 63) as usize]);
        digits[self.count + 1..].fill(b'=');
        self.waiting = [0; 3];
        self.count = 0;
        self.to.write_all(&digits)
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        match self.count {
            0 => Ok(()),
            _ => self.group(),
        }
    }
}

impl<W: Write> Write for Base64<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for &byte in bytes {
            self.waiting[self.count] = byte;
            self.count += 1;
            if self.count == 3 {
                self.group()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_rfc_4648() {
        let cases = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, expected) in cases {
            let mut encoded = Vec::new();
            let mut base64 = Base64::new(&mut encoded);
            base64
                .write_all(plain.as_bytes())
                .expect("memory takes all");
            base64.finish().expect("memory takes all");
            assert_eq!(String::from_utf8_lossy(&encoded), expected);
        }
    }
}

//! Tags and texts of XML, as far as .vtu files need them.

use crate::reading::cursor::quoted;
use crate::reading::fault::Fault;

/// The next part of a file.
pub(super) enum Part<'a> {
    /// `<name ..>`, or `<name ../>`, which has no end tag.
    Start(Tag<'a>),
    /// `</name>`.
    End(&'a str),
    /// Text up to the next tag, from this offset on.
    Text { offset: usize, text: &'a [u8] },
}

/// A start tag.
pub(super) struct Tag<'a> {
    pub(super) name: &'a str,
    pub(super) offset: usize,
    pub(super) is_closed: bool,
    attributes: Vec<(&'a str, &'a str)>,
}

impl Tag<'_> {
    /// The value of an attribute on one line, with the characters that XML reserves restored.
    pub(super) fn attribute(&self, name: &str) -> Option<String> {
        let given = self.attributes.iter().find(|(given, _)| *given == name);
        given.map(|(_, value)| unescaped(value).replace(char::is_control, " "))
    }

    /// The value of an attribute that is a count; `otherwise` if it is absent.
    pub(super) fn count(&self, name: &str, otherwise: Option<usize>) -> Result<usize, Fault> {
        let wrong = |found: String| {
            let problem = format!("{name} of <{}> is {found}", self.name);
            Fault::new(self.offset, problem, "a non-negative whole number")
        };
        match self.attribute(name) {
            None => otherwise.ok_or_else(|| wrong("missing".to_owned())),
            Some(value) => {
                let count = value.trim().parse().ok();
                count.ok_or_else(|| wrong(quoted(value.as_bytes())))
            }
        }
    }
}

/// A position in the text of a file.
pub(super) struct Xml<'a> {
    bytes: &'a [u8],
    offset: usize,
}

impl<'a> Xml<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Xml<'a> {
        Xml { bytes, offset: 0 }
    }

    pub(super) fn offset(&self) -> usize {
        self.offset
    }

    fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.offset..).unwrap_or_default()
    }

    /// The next tag or text; `None` at the end of the file. Comments, declarations and instructions are skipped.
    pub(super) fn next(&mut self) -> Result<Option<Part<'a>>, Fault> {
        loop {
            let rest = self.rest();
            match rest {
                [] => return Ok(None),
                [b'<', b'!', b'-', b'-', ..] => self.skip_past(b"-->", "a comment")?,
                [b'<', b'?', ..] => self.skip_past(b"?>", "an instruction")?,
                [b'<', b'!', ..] => self.skip_past(b">", "a declaration")?,
                [b'<', b'/', ..] => return self.end_tag().map(Some),
                [b'<', ..] => return self.start_tag().map(Some),
                _ => {
                    let length = rest.iter().position(|&byte| byte == b'<');
                    let (text, _) = rest
                        .split_at_checked(length.unwrap_or(rest.len()))
                        .unwrap_or_default();
                    let offset = self.offset;
                    self.offset += text.len();
                    return Ok(Some(Part::Text { offset, text }));
                }
            }
        }
    }

    fn skip_past(&mut self, end: &[u8], what: &str) -> Result<(), Fault> {
        let length = self
            .rest()
            .windows(end.len())
            .position(|bytes| bytes == end);
        let Some(length) = length else {
            let expected = format!("{} behind it", quoted(end));
            return Err(Fault::new(
                self.offset,
                format!("{what} does not end"),
                expected,
            ));
        };
        self.offset += length + end.len();
        Ok(())
    }

    fn end_tag(&mut self) -> Result<Part<'a>, Fault> {
        let start = self.offset;
        self.skip_past(b">", "an end tag")?;
        let inside = self.bytes.get(start + 2..self.offset - 1);
        let name = inside.and_then(|name| str::from_utf8(name).ok());
        let name = name.ok_or_else(|| not_text(start))?;
        Ok(Part::End(name.trim()))
    }

    fn start_tag(&mut self) -> Result<Part<'a>, Fault> {
        let offset = self.offset;
        let length = length_of_tag(self.rest())
            .ok_or_else(|| Fault::new(offset, "a tag does not end", "\">\" behind it"))?;
        self.offset += length;
        let inside = self.bytes.get(offset + 1..self.offset - 1);
        let inside = inside.and_then(|inside| str::from_utf8(inside).ok());
        let inside = inside.ok_or_else(|| not_text(offset))?;
        let (inside, is_closed) = match inside.strip_suffix('/') {
            Some(inside) => (inside, true),
            None => (inside, false),
        };
        let name_end = inside
            .find(|c: char| c.is_whitespace())
            .unwrap_or(inside.len());
        let (name, attributes) = inside.split_at(name_end);
        Ok(Part::Start(Tag {
            name,
            offset,
            is_closed,
            attributes: attributes_of(attributes, offset)?,
        }))
    }
}

fn not_text(offset: usize) -> Fault {
    Fault::new(offset, "a tag has bytes that are no text", "text in UTF-8")
}

/// Number of bytes of the tag that begins here, including its `>`; a `>` in an attribute's value does not end it.
fn length_of_tag(bytes: &[u8]) -> Option<usize> {
    let mut quote = None;
    let end = bytes.iter().position(|&byte| match quote {
        Some(open) => {
            if byte == open {
                quote = None;
            }
            false
        }
        None => {
            if matches!(byte, b'"' | b'\'') {
                quote = Some(byte);
            }
            byte == b'>'
        }
    })?;
    Some(end + 1)
}

fn attributes_of(mut text: &str, offset: usize) -> Result<Vec<(&str, &str)>, Fault> {
    let mut attributes = Vec::new();
    loop {
        text = text.trim_start();
        if text.is_empty() {
            return Ok(attributes);
        }
        let parts = text.split_once('=').and_then(|(name, rest)| {
            let rest = rest.trim_start();
            let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let (value, rest) = rest.get(1..)?.split_once(quote)?;
            Some((name.trim(), value, rest))
        });
        let Some((name, value, rest)) = parts else {
            let problem = format!("a tag has {}", quoted(text.as_bytes()));
            return Err(Fault::new(
                offset,
                problem,
                "attributes of the form name=\"value\"",
            ));
        };
        attributes.push((name, value));
        text = rest;
    }
}

/// Text with names and numbers of characters replaced by the characters; unknown names stay.
fn unescaped(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        plain.push_str(before);
        let named = after.split_once(';').and_then(|(name, after)| {
            let character = match name {
                "amp" => '&',
                "lt" => '<',
                "gt" => '>',
                "quot" => '"',
                "apos" => '\'',
                _ => {
                    let number = name.strip_prefix('#')?;
                    let code = match number.strip_prefix('x') {
                        Some(hexadecimal) => u32::from_str_radix(hexadecimal, 16),
                        None => number.parse(),
                    };
                    char::from_u32(code.ok()?)?
                }
            };
            Some((character, after))
        });
        match named {
            Some((character, after)) => {
                plain.push(character);
                rest = after;
            }
            None => {
                plain.push('&');
                rest = after;
            }
        }
    }
    plain.push_str(rest);
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tag(text: &str) -> Option<Tag<'_>> {
        match Xml::new(text.as_bytes()).next() {
            Ok(Some(Part::Start(tag))) => Some(tag),
            _ => None,
        }
    }

    #[test]
    fn attributes_may_hold_what_ends_a_tag_elsewhere() {
        let tag = tag(
            "<!-- a > b --><?xml?><DataArray Name='a > b' b = \"x &lt;&amp;&#65;&#x42;&no; y\" />",
        );
        let tag = tag.unwrap();
        assert_eq!(tag.name, "DataArray");
        assert!(tag.is_closed);
        assert_eq!(tag.attribute("Name").unwrap(), "a > b");
        assert_eq!(tag.attribute("b").unwrap(), "x <&AB&no; y");
        assert_eq!(tag.attribute("c"), None);
    }

    #[test]
    fn what_does_not_end_is_an_error() {
        for text in [
            "<a",
            "<a b=\"",
            "<a b>",
            "<a b=c>",
            "<!-- a",
            "</a",
            "<a b=\"x\" c>",
        ] {
            assert!(Xml::new(text.as_bytes()).next().is_err(), "{text}");
        }
    }
}

//! Lines of a log as words: plain ones, numbers, quoted texts and options.

use std::fmt::Write;
use std::str::FromStr;

use sinew_core::{OptionValue, Options};

use super::error::LogFault;

/// Adds a text in quotes.
pub(super) fn push_quoted(out: &mut String, text: &str) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            c => out.push(c),
        }
    }
    out.push('"');
}

/// Adds a number that reads back with the same bits.
pub(super) fn push_number(out: &mut String, value: f64) {
    // Writing to a string does not fail.
    let _ = write!(out, "{value:?}");
}

/// Adds options, each after a space.
pub(super) fn push_options<'o>(
    out: &mut String,
    options: impl Iterator<Item = (&'o str, &'o OptionValue)>,
) {
    for (key, value) in options {
        out.push(' ');
        push_quoted(out, key);
        out.push('=');
        push_value(out, value);
    }
}

fn push_value(out: &mut String, value: &OptionValue) {
    match value {
        OptionValue::Number(number) => push_number(out, *number),
        OptionValue::Text(text) => push_quoted(out, text),
        OptionValue::Table(entries) => {
            out.push('{');
            push_options(
                out,
                entries.iter().map(|(key, value)| (key.as_str(), value)),
            );
            out.push_str(" }");
        }
    }
}

/// Rest of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words<'a>(&'a str);

impl<'a> Words<'a> {
    pub(super) fn of(line: &'a str) -> Self {
        Self(line.trim_matches(' '))
    }

    /// The next plain word; empty at the end of the line.
    pub(super) fn word(&mut self) -> &'a str {
        let end = self.0.find([' ', '=', '"']).unwrap_or(self.0.len());
        self.take(end)
    }

    fn take(&mut self, end: usize) -> &'a str {
        let (word, rest) = self.0.split_at(end);
        self.0 = rest.trim_start_matches(' ');
        word
    }

    /// The next number.
    pub(super) fn number(&mut self, what: &'static str) -> Result<f64, LogFault> {
        let word = self.word();
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.fault(what, word)),
        }
    }

    /// The next three numbers.
    pub(super) fn vector(&mut self, what: &'static str) -> Result<[f64; 3], LogFault> {
        Ok([self.number(what)?, self.number(what)?, self.number(what)?])
    }

    /// The next whole number.
    pub(super) fn count<T: FromStr>(&mut self, what: &'static str) -> Result<T, LogFault> {
        let word = self.word();
        word.parse().map_err(|_| self.fault(what, word))
    }

    /// The next text in quotes.
    pub(super) fn quoted(&mut self, what: &'static str) -> Result<String, LogFault> {
        let Some(inside) = self.0.strip_prefix('"') else {
            let word = self.word();
            return Err(self.fault(what, word));
        };
        let mut text = String::new();
        let mut letters = inside.char_indices();
        while let Some((at, c)) = letters.next() {
            match c {
                '"' => {
                    self.take(1 + at + 1);
                    return Ok(text);
                }
                '\\' => match letters.next() {
                    Some((_, 'n')) => text.push('\n'),
                    Some((_, 'r')) => text.push('\r'),
                    Some((_, c @ ('"' | '\\'))) => text.push(c),
                    _ => break,
                },
                c => text.push(c),
            }
        }
        Err(self.fault(what, self.0))
    }

    /// All options that are left on the line.
    pub(super) fn options(&mut self) -> Result<Options, LogFault> {
        let mut options = Options::new();
        while !self.0.is_empty() {
            let (key, value) = self.option(0)?;
            options.insert(key, value);
        }
        Ok(options)
    }

    fn option(&mut self, depth: u32) -> Result<(String, OptionValue), LogFault> {
        const OPTION: &str = "an option, as \"key\"=value";
        let key = self.quoted(OPTION)?;
        let Some(rest) = self.0.strip_prefix('=') else {
            return Err(self.fault(OPTION, self.0));
        };
        self.0 = rest.trim_start_matches(' ');
        if self.0.starts_with('"') {
            return Ok((key, OptionValue::Text(self.quoted(OPTION)?)));
        }
        let Some(rest) = self.0.strip_prefix('{') else {
            return Ok((key, OptionValue::Number(self.number(OPTION)?)));
        };
        // No method has options within options within options.
        if depth > 3 {
            return Err(self.fault(OPTION, self.0));
        }
        self.0 = rest.trim_start_matches(' ');
        let mut entries = std::collections::BTreeMap::new();
        loop {
            if let Some(rest) = self.0.strip_prefix('}') {
                self.0 = rest.trim_start_matches(' ');
                return Ok((key, OptionValue::Table(entries)));
            }
            let (key, value) = self.option(depth + 1)?;
            entries.insert(key, value);
        }
    }

    /// True at the end of the line.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Refuses further words on the line.
    pub(super) fn end(&self) -> Result<(), LogFault> {
        if self.0.is_empty() {
            return Ok(());
        }
        Err(self.fault("the end of the line", self.0))
    }

    fn fault(&self, expected: &'static str, found: &str) -> LogFault {
        LogFault::Word {
            found: found.chars().take(40).collect(),
            expected,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_and_options_come_back() {
        let names = ["", "a b", "\"", "\\", "\\\"n\n\r", "größe = 1"];
        for name in names {
            let mut line = String::new();
            push_quoted(&mut line, name);
            line.push_str(" 7");
            let mut words = Words::of(&line);
            assert_eq!(words.quoted("a name").unwrap(), name);
            assert_eq!(words.count::<usize>("a count").unwrap(), 7);
            words.end().unwrap();
        }
        let inner = [("x y".to_owned(), OptionValue::Number(-0.0))];
        let options = Options::new()
            .with_number("b", 0.1 + 0.2)
            .with_text("a", "1 = \"2\"")
            .with("c", OptionValue::Table(inner.into()));
        let mut line = String::new();
        push_options(&mut line, options.iter());
        assert_eq!(Words::of(&line).options().unwrap(), options);
    }

    #[test]
    fn what_is_no_word_is_named() {
        let said = |line: &str| Words::of(line).options().unwrap_err().to_string();
        let expected = "expected an option, as \"key\"=value";
        for (line, found) in [
            ("\"a\"", ""),
            ("a=1", "a"),
            ("\"a\"=one", "one"),
            ("\"a\"=NaN", "NaN"),
            ("\"a", "\"a"),
            ("\"a\\x\"=1", "\"a\\x\"=1"),
            ("\"a\"={", ""),
        ] {
            assert_eq!(said(line), format!("\"{found}\": {expected}"));
        }
        let deep = "\"a\"={ ".repeat(1000);
        assert!(said(&deep).contains(expected));
    }
}

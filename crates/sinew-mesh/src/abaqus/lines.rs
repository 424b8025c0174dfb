//! Lines of keywords and of data.

use crate::reading::cursor::{Cursor, LONGEST, Token, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;

/// A line of data or of a keyword, which may continue over several lines of the file.
pub(super) enum Line<'a> {
    Keyword(Keyword),
    /// Fields between commas.
    Data(Data<'a>),
}

/// `*NAME, PARAMETER=VALUE, ..`.
pub(super) struct Keyword {
    /// The name in capitals, with single blanks.
    pub(super) name: String,
    pub(super) offset: usize,
    /// Names in capitals, values as written.
    parameters: Vec<(String, String)>,
}

impl Keyword {
    /// The value of a parameter; empty for one without a value.
    pub(super) fn parameter(&self, name: &str) -> Option<&str> {
        let given = self.parameters.iter().find(|(given, _)| given == name);
        given.map(|(_, value)| value.as_str())
    }

    /// The value of a required parameter.
    pub(super) fn needed(&self, name: &str) -> Result<&str, Fault> {
        let value = self.parameter(name).filter(|value| !value.is_empty());
        value.ok_or_else(|| {
            let problem = format!("*{} has no {name}", self.name);
            Fault::new(
                self.offset,
                problem,
                format!("{name}=.. behind the keyword"),
            )
        })
    }
}

/// The fields of a line of data.
#[derive(Clone, Copy)]
pub(super) struct Data<'a> {
    pub(super) offset: usize,
    text: &'a [u8],
}

impl<'a> Data<'a> {
    /// The fields, without blanks around them. An empty text after a comma at the end is not a field.
    pub(super) fn fields(self) -> impl Iterator<Item = Token<'a>> {
        let mut rest = Some(self.text);
        let mut offset = self.offset;
        std::iter::from_fn(move || {
            let text = rest?;
            let length = text.iter().position(|&byte| byte == b',');
            let (field, after) = match length {
                Some(length) => {
                    let (field, after) = text.split_at_checked(length)?;
                    (field, after.get(1..))
                }
                None => (text, None),
            };
            rest = after.filter(|after| !after.trim_ascii().is_empty());
            let blanks = field.len() - field.trim_ascii_start().len();
            let token = Token {
                text: field.trim_ascii(),
                offset: offset + blanks,
            };
            offset += field.len() + 1;
            Some(token)
        })
    }

    /// True if a comma ends the line, so that it continues on the next one.
    pub(super) fn goes_on(self) -> bool {
        self.text.ends_with(b",")
    }
}

/// A whole number above 0: the label of a node or an element.
pub(super) fn label(field: Token<'_>, what: &str) -> Result<u64, Fault> {
    match number::unsigned(field, what)? {
        0 => {
            let problem = format!("{what} is 0");
            Err(Fault::new(field.offset, problem, "a whole number above 0"))
        }
        label => Ok(label),
    }
}

/// A finite number; an empty field is 0, and exponents may be Fortran's.
pub(super) fn coordinate(field: Token<'_>, what: &str) -> Result<f64, Fault> {
    if field.text.is_empty() {
        return Ok(0.0);
    }
    let text: Vec<u8> = field
        .text
        .iter()
        .map(|&byte| {
            if matches!(byte, b'd' | b'D') {
                b'e'
            } else {
                byte
            }
        })
        .collect();
    let value = number::double(
        Token {
            text: &text,
            ..field
        },
        what,
    )?;
    if value.is_finite() {
        return Ok(value);
    }
    let problem = format!("{what} is {}", quoted(field.text));
    Err(Fault::new(field.offset, problem, "a finite number"))
}

/// The lines of a file without comments and empty ones.
pub(super) struct Reader<'a> {
    cursor: Cursor<'a>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Reader<'a> {
        Reader {
            cursor: Cursor::new(bytes),
        }
    }

    pub(super) fn offset(&self) -> usize {
        self.cursor.offset()
    }

    /// The next line; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<Line<'a>>, Fault> {
        loop {
            self.cursor.skip_blanks();
            if self.cursor.is_at_end() {
                return Ok(None);
            }
            let offset = self.cursor.offset();
            let text = self.cursor.line();
            if text.starts_with(b"**") {
                continue;
            }
            if text.len() > 16 * LONGEST {
                let problem = format!("a line is longer than {} bytes", 16 * LONGEST);
                return Err(Fault::new(
                    offset,
                    problem,
                    "the lines of an input file of Abaqus",
                ));
            }
            return Ok(Some(match text.strip_prefix(b"*") {
                Some(text) => Line::Keyword(self.keyword(text, offset)),
                None => Line::Data(Data { offset, text }),
            }));
        }
    }

    /// A keyword's line, and those on which it continues after a comma.
    fn keyword(&mut self, text: &[u8], offset: usize) -> Keyword {
        let mut text = text.to_vec();
        while text.ends_with(b",") && !self.cursor.is_at_end() {
            let mut ahead = self.cursor.clone();
            let more = ahead.line();
            if more.starts_with(b"*") && !more.starts_with(b"**") {
                break;
            }
            self.cursor = ahead;
            if !more.starts_with(b"**") {
                text.extend_from_slice(more);
                if more.is_empty() {
                    break;
                }
            }
        }
        let text = String::from_utf8_lossy(&text).into_owned();
        let mut parts = split_outside_quotes(&text).into_iter();
        let name = parts.next().unwrap_or_default();
        let words: Vec<&str> = name.split_whitespace().collect();
        let parameters = parts.map(|part| match part.split_once('=') {
            Some((name, value)) => (name.trim().to_ascii_uppercase(), unquoted(value)),
            None => (part.trim().to_ascii_uppercase(), String::new()),
        });
        Keyword {
            name: words.join(" ").to_ascii_uppercase(),
            offset,
            parameters: parameters.collect(),
        }
    }
}

/// The parts between commas that are not in quotation marks.
fn split_outside_quotes(text: &str) -> Vec<&str> {
    let mut is_quoted = false;
    let comma = |c: char| {
        if c == '"' {
            is_quoted = !is_quoted;
        }
        c == ',' && !is_quoted
    };
    text.split(comma).collect()
}

/// A name without blanks and quotation marks around it.
pub(super) fn unquoted(name: &str) -> String {
    name.trim().trim_matches('"').to_owned()
}

//! `$PhysicalNames`: dimension, tag and name of each group.

use std::collections::BTreeMap;

use super::header::Version;
use super::source::{Record, Source, Text};
use crate::reading::cursor::{Cursor, LONGEST, Token, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::reading::remarks::Remarks;

/// Names by dimension and tag.
pub(super) type PhysicalNames = BTreeMap<(u8, i32), String>;

/// Names by tag alone: version 2.0 has no column for the dimension.
pub(super) type NamesWithoutDim = BTreeMap<i32, String>;

/// The tables in which names are stored.
pub(super) struct Names<'n> {
    pub(super) version: Version,
    pub(super) names: &'n mut PhysicalNames,
    pub(super) without_dim: &'n mut NamesWithoutDim,
}

pub(super) fn read(
    cursor: &mut Cursor<'_>,
    mut names: Names<'_>,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let mut source = Text::new(cursor);
    let count = source.size("the number of names")?;
    source.room_for(count, "the number of names", Record::ints(2))?;
    for number in 1..=count {
        read_row(cursor, &mut names, remarks)
            .map_err(|fault| fault.in_record("name", number, count))?;
    }
    Ok(())
}

fn read_row(
    cursor: &mut Cursor<'_>,
    names: &mut Names<'_>,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    cursor.skip_blanks();
    let row_offset = cursor.offset();
    let dim = if names.version == Version::V20 && is_tag_and_name(cursor) {
        None
    } else {
        let token = cursor.token("the dimension")?;
        Some(dimension(
            number::signed(token, "the dimension")?,
            token.offset,
        )?)
    };
    let tag_token = number_before_name(cursor, "the tag")?;
    let tag = number::signed(tag_token, "the tag")?;
    if tag < 0 {
        return Err(Fault::new(
            tag_token.offset,
            format!("the tag is {tag}"),
            "a positive tag",
        ));
    }
    if tag == 0 {
        remarks.at(
            tag_token.offset,
            "$PhysicalNames: tag 0 is not the tag of a group",
        );
    }
    let Token { text, offset } = quoted_text(cursor)?;
    let name = match std::str::from_utf8(text) {
        Ok(name) => name.to_owned(),
        Err(error) => {
            let bad_byte = offset + error.valid_up_to();
            remarks.at(
                bad_byte,
                format!("$PhysicalNames: the name {} is not UTF-8", quoted(text)),
            );
            String::from_utf8_lossy(text).into_owned()
        }
    };
    let earlier = match dim {
        Some(dim) => names.names.insert((dim, tag), name.clone()),
        None => names.without_dim.insert(tag, name.clone()),
    };
    if let Some(earlier) = earlier.filter(|earlier| *earlier != name) {
        let of_dim = dim.map_or_else(String::new, |dim| format!(" of dimension {dim}"));
        let message = format!(
            "$PhysicalNames: group {tag}{of_dim} is named again: {} after {}; the later name counts",
            quoted(name.as_bytes()),
            quoted(earlier.as_bytes()),
        );
        remarks.at(row_offset, message);
    }
    Ok(())
}

/// True if a name follows the first number of this row, rather than a second number.
fn is_tag_and_name(cursor: &Cursor<'_>) -> bool {
    let mut ahead = cursor.clone();
    let is_number = number_before_name(&mut ahead, "the tag").is_ok();
    ahead.skip_blanks();
    is_number && ahead.rest().starts_with(b"\"")
}

/// The next token, which ends before a name that follows it without a blank.
fn number_before_name<'a>(cursor: &mut Cursor<'a>, what: &str) -> Result<Token<'a>, Fault> {
    let mut ahead = cursor.clone();
    let token = ahead.token(what)?;
    let length = token.text.iter().position(|&byte| byte == b'"');
    match length.filter(|&length| length > 0) {
        None => {
            *cursor = ahead;
            Ok(token)
        }
        Some(length) => {
            cursor.skip_blanks();
            let text = cursor.take(length).unwrap_or_default();
            Ok(Token { text, ..token })
        }
    }
}

/// The text between the first and the last quote of this line, without blanks around it.
fn quoted_text<'a>(cursor: &mut Cursor<'a>) -> Result<Token<'a>, Fault> {
    let before = cursor.offset();
    let rest = cursor.rest();
    let line = cursor.line();
    let is_quote = |&byte: &u8| byte == b'"';
    let ends = (
        line.iter().position(is_quote),
        line.iter().rposition(is_quote),
    );
    let expected = "a name in double quotes on the same line";
    let (Some(first), Some(last)) = ends else {
        return Err(Fault::new(
            before,
            format!("the name is {}", quoted(line)),
            expected,
        ));
    };
    let name = line.get(first + 1..last);
    let leading = rest.iter().position(is_quote).unwrap_or(0);
    match name {
        Some(name) if first == 0 && name.len() <= LONGEST => {
            let blanks = name.len() - name.trim_ascii_start().len();
            Ok(Token {
                text: name.trim_ascii(),
                offset: before + leading + 1 + blanks,
            })
        }
        Some(name) if first == 0 => {
            let problem = format!("the name has {} bytes", name.len());
            Err(Fault::new(before, problem, format!("at most {LONGEST}")))
        }
        _ => Err(Fault::new(
            before,
            format!("the name is {}", quoted(line)),
            expected,
        )),
    }
}

/// A dimension of 0 to 3.
pub(super) fn dimension(value: i32, offset: usize) -> Result<u8, Fault> {
    match u8::try_from(value) {
        Ok(dim) if dim <= 3 => Ok(dim),
        _ => Err(Fault::new(
            offset,
            format!("the dimension is {value}"),
            "0, 1, 2 or 3",
        )),
    }
}

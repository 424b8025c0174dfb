//! `$PhysicalNames`: dimension, tag and name of each group.

use std::collections::BTreeMap;

use super::cursor::{Cursor, LONGEST, Token, quoted};
use super::fault::Fault;
use super::number;
use super::remarks::Remarks;
use super::source::{Record, Source, Text};

pub(super) type PhysicalNames = BTreeMap<(u8, i32), String>;

pub(super) fn read(
    cursor: &mut Cursor<'_>,
    names: &mut PhysicalNames,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let mut source = Text::new(cursor);
    let count = source.size("the number of names")?;
    let least = Record {
        ints: 2,
        sizes: 1,
        ..Record::default()
    };
    source.room_for(count, "the number of names", least)?;
    for number in 1..=count {
        read_row(cursor, names, remarks).map_err(|fault| fault.in_record("name", number, count))?;
    }
    Ok(())
}

fn read_row(
    cursor: &mut Cursor<'_>,
    names: &mut PhysicalNames,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let dim_token = cursor.token("the dimension")?;
    let dim = dimension(
        number::signed(dim_token, "the dimension")?,
        dim_token.offset,
    )?;
    let tag_token = cursor.token("the tag")?;
    let tag = number::signed(tag_token, "the tag")?;
    if tag < 0 {
        return Err(Fault::new(
            tag_token.offset,
            format!("the tag is {tag}"),
            "a positive tag",
        ));
    }
    if tag == 0 {
        let message = format!("$PhysicalNames: tag 0 of dimension {dim} stands for no group");
        remarks.at(tag_token.offset, message);
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
    if let Some(earlier) = names.insert((dim, tag), name.clone()) {
        let message = format!(
            "$PhysicalNames: group {tag} of dimension {dim} is named again: {} after {}; the later name counts",
            quoted(name.as_bytes()),
            quoted(earlier.as_bytes()),
        );
        remarks.at(dim_token.offset, message);
    }
    Ok(())
}

/// What stands between the first and the last quote of this line.
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
        Some(name) if first == 0 && name.len() <= LONGEST => Ok(Token {
            text: name,
            offset: before + leading + 1,
        }),
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

//! Arrays of data: `SCALARS`, `VECTORS`, `FIELD` and their like.

use super::numbers::{Numbers, ValueType, times};
use crate::reading::cursor::Cursor;
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::reading::remarks::Remarks;
use crate::unstructured::{Field, Scalar};

/// The part of a grid to which data belong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Holder {
    Grid,
    Points,
    Cells,
}

/// True if a keyword in capitals begins data.
pub(super) fn is_one(keyword: &[u8]) -> bool {
    matches!(
        keyword,
        b"SCALARS" | b"COLOR_SCALARS" | b"LOOKUP_TABLE" | b"FIELD" | b"TEXTURE_COORDINATES"
    ) || fixed(keyword).is_some()
}

/// Number of values per point or cell for a keyword.
fn fixed(keyword: &[u8]) -> Option<u64> {
    Some(match keyword {
        b"VECTORS" | b"NORMALS" => 3,
        b"TENSORS" => 9,
        b"TENSORS6" => 6,
        b"GLOBAL_IDS" | b"PEDIGREE_IDS" | b"EDGE_FLAGS" => 1,
        _ => return None,
    })
}

/// Reads the data after a keyword. `holders` is the number of points or cells; `None` for data of the whole grid, whose
/// number is arbitrary.
pub(super) fn read(
    keyword: &[u8],
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    holders: Option<usize>,
    remarks: &mut Remarks,
) -> Result<Vec<Field>, Fault> {
    let offset = cursor.offset();
    if keyword == b"FIELD" {
        return field(cursor, numbers, holders, remarks);
    }
    let name = name(cursor)?;
    let holders = match (keyword, holders) {
        (b"LOOKUP_TABLE", _) => 0,
        (_, Some(holders)) => holders as u64,
        (_, None) => {
            let problem = "data come before POINT_DATA or CELL_DATA";
            return Err(Fault::new(
                offset,
                problem,
                "POINT_DATA or CELL_DATA before them",
            ));
        }
    };
    let named = |fault: Fault| fault.inside(format!("\"{name}\""));
    let of = |components: u64, kind: ValueType, values| Field {
        name: name.clone(),
        components: usize::try_from(components).unwrap_or(usize::MAX),
        is_integer: kind.is_integer(),
        values,
    };
    let is_bytes = numbers == Numbers::Bytes;
    match keyword {
        // Colours of values, which are no data of the mesh.
        b"LOOKUP_TABLE" => {
            let rows = count(cursor, "the number of colours")?;
            let kind = colour(is_bytes);
            let _ = numbers
                .doubles(cursor, kind, times(rows, 4, offset)?)
                .map_err(named)?;
            Ok(Vec::new())
        }
        b"COLOR_SCALARS" => {
            let components = count(cursor, "the number of components")?;
            let kind = colour(is_bytes);
            let all = times(holders, components, offset)?;
            let mut values = numbers.doubles(cursor, kind, all).map_err(named)?;
            if !is_bytes {
                values
                    .iter_mut()
                    .for_each(|value| *value = (*value * 255.0).round());
            }
            Ok(vec![of(components, ValueType::Number(Scalar::U8), values)])
        }
        b"SCALARS" => {
            let kind = ValueType::read(cursor).map_err(named)?;
            let components = match cursor.is_at_line_end() {
                true => 1,
                false => count(cursor, "the number of components")?,
            };
            skip_table_name(cursor);
            array(cursor, numbers, kind, (holders, components), offset)
                .map(|values| vec![of(components, kind, values)])
                .map_err(named)
        }
        _ => {
            let components = match fixed(keyword) {
                Some(components) => components,
                None => count(cursor, "the dimension")?,
            };
            let kind = ValueType::read(cursor).map_err(named)?;
            array(cursor, numbers, kind, (holders, components), offset)
                .map(|values| vec![of(components, kind, values)])
                .map_err(named)
        }
    }
}

fn colour(is_bytes: bool) -> ValueType {
    ValueType::Number(if is_bytes { Scalar::U8 } else { Scalar::F64 })
}

/// Moves past the line `LOOKUP_TABLE name` after that of `SCALARS`, up to its end.
fn skip_table_name(cursor: &mut Cursor<'_>) {
    let mut ahead = cursor.clone();
    if ahead.line().is_empty() {
        ahead.skip_blanks();
        let word = ahead.token("").map(|token| token.text.to_ascii_uppercase());
        if word.is_ok_and(|word| word == b"LOOKUP_TABLE") && ahead.token("").is_ok() {
            *cursor = ahead;
        }
    }
}

fn array(
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    kind: ValueType,
    (holders, components): (u64, u64),
    offset: usize,
) -> Result<Vec<f64>, Fault> {
    if kind == ValueType::Text || components == 0 {
        let problem = "each holder has no numbers";
        return Err(Fault::new(
            offset,
            problem,
            "at least one number of a type of numbers",
        ));
    }
    numbers.doubles(cursor, kind, times(holders, components, offset)?)
}

/// Reads `FIELD name n`, and `name components rows type` with the values of each array.
fn field(
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    holders: Option<usize>,
    remarks: &mut Remarks,
) -> Result<Vec<Field>, Fault> {
    let _ = name(cursor)?;
    let arrays = count(cursor, "the number of arrays")?;
    let mut fields = Vec::new();
    for number in 1..=arrays {
        let in_array = |fault: Fault| fault.in_record("array", number, arrays);
        skip_metadata_of_array(cursor);
        cursor.skip_blanks();
        let offset = cursor.offset();
        let name = name(cursor).map_err(in_array)?;
        let named = |fault: Fault| in_array(fault.inside(format!("\"{name}\"")));
        let components = count(cursor, "the number of components").map_err(named)?;
        let rows = count(cursor, "the number of rows").map_err(named)?;
        let kind = ValueType::read(cursor).map_err(named)?;
        let all = times(rows, components, offset).map_err(named)?;
        if kind == ValueType::Text {
            numbers.skip_texts(cursor, all).map_err(named)?;
            let message = format!("data \"{name}\": left out, since they are texts and no numbers");
            remarks.at(offset, message);
            continue;
        }
        let values = numbers.doubles(cursor, kind, all).map_err(named)?;
        match holders {
            None => {}
            Some(holders) if rows == holders as u64 && components > 0 => fields.push(Field {
                name,
                components: usize::try_from(components).unwrap_or(usize::MAX),
                is_integer: kind.is_integer(),
                values,
            }),
            Some(holders) => {
                let problem = format!("it has {rows} rows of {components} numbers");
                let expected = format!("a number or more for each of {holders}");
                return Err(named(Fault::new(offset, problem, expected)));
            }
        }
    }
    Ok(fields)
}

/// Moves past the metadata of the previous array, up to an empty line.
pub(super) fn skip_metadata(cursor: &mut Cursor<'_>) {
    let _ = cursor.line();
    while !cursor.is_at_end() && !cursor.line().is_empty() {}
}

fn skip_metadata_of_array(cursor: &mut Cursor<'_>) {
    let mut ahead = cursor.clone();
    if ahead
        .token("")
        .is_ok_and(|token| token.text.eq_ignore_ascii_case(b"METADATA"))
    {
        skip_metadata(&mut ahead);
        *cursor = ahead;
    }
}

fn count(cursor: &mut Cursor<'_>, what: &str) -> Result<u64, Fault> {
    number::unsigned(cursor.token(what)?, what)
}

/// A name, in which `%20` and similar codes stand for the characters that a word cannot have.
fn name(cursor: &mut Cursor<'_>) -> Result<String, Fault> {
    let word = cursor.token("the name of the data")?.text;
    let mut plain = Vec::with_capacity(word.len());
    let mut rest = word;
    while let Some((&byte, after)) = rest.split_first() {
        let code = after.get(..2).filter(|_| byte == b'%');
        let code = code.and_then(|code| u8::from_str_radix(str::from_utf8(code).ok()?, 16).ok());
        match code {
            Some(code) => {
                plain.push(code);
                rest = after.get(2..).unwrap_or_default();
            }
            None => {
                plain.push(byte);
                rest = after;
            }
        }
    }
    Ok(String::from_utf8_lossy(&plain).replace(char::is_control, " "))
}

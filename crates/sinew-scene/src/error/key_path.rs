//! The path of keys to a position in a text.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

/// The keys to the smallest key or value of a TOML text that contains a byte, such as `region[1].density`; tables of a
/// list are counted from 1. `None` for a byte that belongs to no key, and for a text that is not TOML.
pub(super) fn key_path(text: &str, byte: usize) -> Option<String> {
    let document = DeTable::parse(text).ok()?;
    let mut smallest = None;
    find_in_table(document.get_ref(), byte, "", &mut smallest);
    smallest.map(|(path, _)| path)
}

type Found = Option<(String, usize)>;

fn find_in_table(table: &DeTable<'_>, byte: usize, before: &str, smallest: &mut Found) {
    for (key, value) in table {
        let path = match before {
            "" => key.get_ref().to_string(),
            before => format!("{before}.{}", key.get_ref()),
        };
        consider(&key.span(), byte, &path, smallest);
        consider(&value.span(), byte, &path, smallest);
        match value.get_ref() {
            DeValue::Table(table) => find_in_table(table, byte, &path, smallest),
            DeValue::Array(list) => {
                for (number, item) in (1..).zip(list.iter()) {
                    let path = format!("{path}[{number}]");
                    consider(&item.span(), byte, &path, smallest);
                    if let DeValue::Table(table) = item.get_ref() {
                        find_in_table(table, byte, &path, smallest);
                    }
                }
            }
            _ => {}
        }
    }
}

/// Keeps the path if its span contains the byte and is not longer than the one found before.
fn consider(span: &Range<usize>, byte: usize, path: &str, smallest: &mut Found) {
    let shorter = |(_, length): &(String, usize)| span.len() <= *length;
    if span.contains(&byte) && smallest.as_ref().is_none_or(shorter) {
        *smallest = Some((path.to_owned(), span.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_is_reached_by_its_keys() {
        let text = "a = 1\n[mesh.block]\ncells = [2, 3]\n[[region]]\nx = 0\n[[region]]\nshape = { r = 5 }\n";
        let path = |part: &str| key_path(text, text.find(part).unwrap());
        assert_eq!(path("a = 1").as_deref(), Some("a"));
        assert_eq!(path("3]").as_deref(), Some("mesh.block.cells[2]"));
        assert_eq!(path("x = 0").as_deref(), Some("region[1].x"));
        assert_eq!(path("5 }").as_deref(), Some("region[2].shape.r"));
        assert_eq!(key_path("= no", 0), None);
    }
}

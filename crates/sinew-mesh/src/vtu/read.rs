//! Reads arrays of .vtu files back.

use thiserror::Error;

/// A reason for which an array cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ReadVtuError {
    /// A file without numbers after its text.
    #[error("expected a .vtu file with appended numbers, as this program writes it")]
    NotAppended,
    /// No array of floating-point numbers has this name.
    #[error("expected an array {name:?} of floating-point numbers")]
    NoArray {
        /// The name that was looked for.
        name: String,
    },
    /// The array's numbers are cut off, or are not what their length says.
    #[error("the numbers of the array {name:?} are damaged")]
    Damaged {
        /// The array's name.
        name: String,
    },
    /// The file is compressed, which this build cannot read.
    #[error("the numbers are compressed, which this program was built without")]
    Compressed,
}

/// The floating-point numbers of an array of a file that [`super::write_vtu_grid`] wrote with appended numbers; single
/// precision is widened. It is no reader of VTK's format at large.
///
/// # Errors
/// [`ReadVtuError`] for other files, damaged ones and names that are not there.
pub fn read_appended_array(bytes: &[u8], name: &str) -> Result<Vec<f64>, ReadVtuError> {
    let marker = bytes.windows(2).position(|pair| pair == b"\n_");
    let (text, data) = bytes.split_at(marker.ok_or(ReadVtuError::NotAppended)? + 2);
    let text = str::from_utf8(text).map_err(|_| ReadVtuError::NotAppended)?;
    let is_compressed = text.contains("compressor=\"vtkZLibDataCompressor\"");
    let array = text.lines().find(|line| {
        line.starts_with("<DataArray")
            && attribute(line, "Name") == Some(&super::out::escaped(name))
    });
    let missing = || ReadVtuError::NoArray {
        name: name.to_owned(),
    };
    let damaged = || ReadVtuError::Damaged {
        name: name.to_owned(),
    };
    let array = array.ok_or_else(missing)?;
    let offset: usize = attribute(array, "offset")
        .and_then(|offset| offset.parse().ok())
        .ok_or(ReadVtuError::NotAppended)?;
    let data = data.get(offset..).ok_or_else(damaged)?;
    let numbers = match is_compressed {
        false => plain(data).map(<[u8]>::to_vec),
        #[cfg(feature = "compress")]
        true => inflated(data),
        #[cfg(not(feature = "compress"))]
        true => return Err(ReadVtuError::Compressed),
    };
    let numbers = numbers.ok_or_else(damaged)?;
    match (
        attribute(array, "type"),
        numbers.as_chunks(),
        numbers.as_chunks(),
    ) {
        (Some("Float64"), (numbers, []), _) => Ok(numbers
            .iter()
            .map(|bytes| f64::from_le_bytes(*bytes))
            .collect()),
        (Some("Float32"), _, (numbers, [])) => Ok(numbers
            .iter()
            .map(|bytes| f32::from_le_bytes(*bytes).into())
            .collect()),
        (Some("Float32" | "Float64"), ..) => Err(damaged()),
        _ => Err(missing()),
    }
}

/// The next number of a head.
fn number(data: &mut &[u8]) -> Option<usize> {
    let (number, rest) = data.split_first_chunk::<8>()?;
    *data = rest;
    usize::try_from(u64::from_le_bytes(*number)).ok()
}

fn plain(mut data: &[u8]) -> Option<&[u8]> {
    let length = number(&mut data)?;
    data.get(..length)
}

/// The bytes of an array before compression; see `compressed` in the writer.
#[cfg(feature = "compress")]
fn inflated(mut data: &[u8]) -> Option<Vec<u8>> {
    use std::io::Read;

    let (blocks, size, last) = (number(&mut data)?, number(&mut data)?, number(&mut data)?);
    if blocks > data.len() / 8 {
        return None;
    }
    let sizes: Option<Vec<usize>> = (0..blocks).map(|_| number(&mut data)).collect();
    let mut numbers = Vec::new();
    for (block, compressed) in sizes?.into_iter().enumerate() {
        let (head, rest) = data.split_at_checked(compressed)?;
        data = rest;
        let expected = match block + 1 == blocks && last > 0 {
            true => last,
            false => size,
        };
        let before = numbers.len();
        // One byte more than it should have shows that it has too many.
        let mut stream = flate2::read::ZlibDecoder::new(head).take(expected as u64 + 1);
        stream.read_to_end(&mut numbers).ok()?;
        if numbers.len() - before != expected {
            return None;
        }
    }
    Some(numbers)
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let begin = format!(" {name}=\"");
    tag.split(&begin).nth(1)?.split('"').next()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellType;
    use crate::vtu::{Array, Grid, VtuEncoding, write_vtu_grid};

    fn file(encoding: VtuEncoding, points: &[[f64; 3]], singles: &[f32]) -> Vec<u8> {
        let cells: Vec<u32> = (0..points.len() as u32).collect();
        let grid = Grid {
            points,
            cells: vec![(CellType::Vertex, &cells)],
            point_data: vec![
                Array::of_singles("u <m>", 3, singles),
                Array::of_integers("tag", vec![7; points.len()]),
            ],
            cell_data: Vec::new(),
        };
        let mut bytes = Vec::new();
        write_vtu_grid(&grid, encoding, &mut bytes).unwrap();
        bytes
    }

    /// More than one block of the compression, and a last one that is not full.
    fn motion() -> (Vec<[f64; 3]>, Vec<f32>) {
        let points: Vec<[f64; 3]> = (0..7000)
            .map(|i| [f64::from(i) / 3.0, (f64::from(i) / 50.0).sin(), -1e-300])
            .collect();
        let singles = points.as_flattened().iter().map(|x| (x / 7.0) as f32);
        let singles = singles.collect();
        (points, singles)
    }

    fn encodings() -> Vec<VtuEncoding> {
        vec![
            VtuEncoding::RawAppended,
            #[cfg(feature = "compress")]
            VtuEncoding::CompressedAppended,
        ]
    }

    #[test]
    fn numbers_come_back_with_the_same_bits() {
        let (points, singles) = motion();
        for encoding in encodings() {
            let bytes = file(encoding, &points, &singles);
            let read = read_appended_array(&bytes, "Points").unwrap();
            assert!(read.iter().eq(points.as_flattened()), "{encoding:?}");
            let read = read_appended_array(&bytes, "u <m>").unwrap();
            assert!(
                read.iter().eq(singles
                    .iter()
                    .map(|x| f64::from(*x))
                    .collect::<Vec<_>>()
                    .iter())
            );
            let empty = file(encoding, &[], &[]);
            assert_eq!(read_appended_array(&empty, "u <m>").unwrap(), []);
        }
    }

    #[test]
    fn what_is_not_there_or_cut_off_is_an_error() {
        let (points, singles) = motion();
        for encoding in encodings() {
            let bytes = file(encoding, &points, &singles);
            for name in ["v", "tag"] {
                let error = read_appended_array(&bytes, name).unwrap_err();
                assert!(matches!(error, ReadVtuError::NoArray { .. }), "{error}");
            }
            let start = bytes.windows(2).position(|pair| pair == b"\n_").unwrap();
            for length in (start + 2..bytes.len()).step_by(997) {
                if let Ok(read) = read_appended_array(&bytes[..length], "Points") {
                    assert_eq!(read, points.as_flattened(), "{length}");
                }
            }
        }
        let text = file(VtuEncoding::Base64, &points, &singles);
        assert_eq!(
            read_appended_array(&text, "Points"),
            Err(ReadVtuError::NotAppended)
        );
    }

    #[cfg(feature = "compress")]
    #[test]
    fn damaged_streams_are_errors() {
        let (points, singles) = motion();
        let mut bytes = file(VtuEncoding::CompressedAppended, &points, &singles);
        let start = bytes.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
        bytes[start + 200] ^= 0x55;
        assert!(read_appended_array(&bytes, "u <m>").is_err());
        // A head that claims more blocks than there are bytes.
        bytes[start + 7] = 0xff;
        assert!(read_appended_array(&bytes, "u <m>").is_err());
    }
}

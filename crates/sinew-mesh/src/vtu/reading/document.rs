//! The tags of a file.

use super::array::{Appended, Array, File};
use super::encoding::{Encoding, UnreadCompressor};
use super::xml::{Part, Tag, Xml};
use crate::reading::cursor::quoted;
use crate::reading::fault::Fault;
use crate::unstructured::{ByteOrder, Scalar};

/// A file, as described by its tags.
pub(super) struct Document {
    encoding: Encoding,
    unread_compressor: Option<UnreadCompressor>,
    pub(super) pieces: Vec<Piece>,
    appended: Option<AppendedData>,
}

/// A piece of a grid.
#[derive(Default)]
pub(super) struct Piece {
    pub(super) offset: usize,
    pub(super) point_count: usize,
    pub(super) cell_count: usize,
    pub(super) points: Vec<Array>,
    pub(super) cells: Vec<Array>,
    pub(super) point_data: Vec<Array>,
    pub(super) cell_data: Vec<Array>,
}

/// The numbers after the tags.
#[derive(Clone, Copy)]
struct AppendedData {
    /// Offset of their first byte, after the underscore.
    start: usize,
    is_base64: bool,
}

const EXPECTED: &str =
    "a .vtu file of VTK: XML that begins with <VTKFile type=\"UnstructuredGrid\">";

impl Document {
    pub(super) fn read(bytes: &[u8]) -> Result<Document, Fault> {
        let mut xml = Xml::new(bytes);
        let (encoding, unread_compressor) = encoding_of(&begin(&mut xml)?)?;
        let mut document = Document {
            encoding,
            unread_compressor,
            pieces: Vec::new(),
            appended: None,
        };
        let mut section = None;
        let mut array: Option<Array> = None;
        loop {
            match xml.next()? {
                None => return Err(cut_off(xml.offset())),
                Some(Part::Text { offset, text }) => {
                    if let Some(array) = &mut array {
                        array.take_text(offset, text);
                    }
                }
                Some(Part::End("VTKFile")) => break,
                Some(Part::End("DataArray")) => {
                    if let Some(array) = array.take() {
                        document.add(section, array);
                    }
                }
                Some(Part::End(name)) => {
                    if section == Section::of(name) {
                        section = None;
                    }
                }
                Some(Part::Start(tag)) => match tag.name {
                    "Piece" => document.pieces.push(Piece {
                        offset: tag.offset,
                        point_count: tag.count("NumberOfPoints", Some(0))?,
                        cell_count: tag.count("NumberOfCells", Some(0))?,
                        ..Piece::default()
                    }),
                    "AppendedData" => {
                        document.appended = Some(appended(&tag, bytes, xml.offset())?);
                        break;
                    }
                    "DataArray" if section.is_some() && array.is_none() => {
                        let known = document.pieces.last().map_or(0, Piece::arrays);
                        let read = Array::of(&tag, &format!("unnamed {}", known + 1))?;
                        match tag.is_closed {
                            true => document.add(section, read),
                            false => array = Some(read),
                        }
                    }
                    // The attributes of an array are inside its tag.
                    name if array.is_none() && !tag.is_closed => {
                        section = Section::of(name).or(section);
                    }
                    _ => {}
                },
            }
        }
        if document.pieces.is_empty() {
            let problem = "there is no <Piece> with points and cells";
            return Err(Fault::new(xml.offset(), problem, EXPECTED));
        }
        Ok(document)
    }

    fn add(&mut self, section: Option<Section>, array: Array) {
        let Some(piece) = self.pieces.last_mut() else {
            return;
        };
        match section {
            Some(Section::Points) => piece.points.push(array),
            Some(Section::Cells) => piece.cells.push(array),
            Some(Section::PointData) => piece.point_data.push(array),
            Some(Section::CellData) => piece.cell_data.push(array),
            Some(Section::FieldData) | None => {}
        }
    }

    /// The file of these bytes, for reading arrays.
    pub(super) fn file<'a>(&'a self, bytes: &'a [u8]) -> File<'a> {
        let data = |start: usize| bytes.get(start..).unwrap_or_default();
        let appended = match self.appended {
            None => Appended::None,
            Some(AppendedData {
                start,
                is_base64: false,
            }) => Appended::Raw(data(start)),
            Some(AppendedData {
                start,
                is_base64: true,
            }) => {
                let text = data(start);
                let end = text.iter().position(|&byte| byte == b'<');
                Appended::Base64(text.get(..end.unwrap_or(text.len())).unwrap_or_default())
            }
        };
        File {
            bytes,
            encoding: self.encoding,
            unread_compressor: self.unread_compressor.as_ref(),
            appended,
        }
    }
}

impl Piece {
    fn arrays(&self) -> usize {
        self.points.len() + self.cells.len() + self.point_data.len() + self.cell_data.len()
    }
}

/// A part of a piece.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Points,
    Cells,
    PointData,
    CellData,
    /// Values of the grid as a whole, which are not data of a mesh.
    FieldData,
}

impl Section {
    fn of(name: &str) -> Option<Section> {
        Some(match name {
            "Points" => Section::Points,
            "Cells" => Section::Cells,
            "PointData" => Section::PointData,
            "CellData" => Section::CellData,
            "FieldData" => Section::FieldData,
            _ => return None,
        })
    }
}

/// The first tag of the file.
fn begin<'a>(xml: &mut Xml<'a>) -> Result<Tag<'a>, Fault> {
    const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
    loop {
        match xml.next() {
            Ok(Some(Part::Text { text, .. }))
                if matches!(text.trim_ascii(), [] | BYTE_ORDER_MARK) => {}
            Ok(Some(Part::Start(tag))) if tag.name == "VTKFile" => return Ok(tag),
            Ok(Some(Part::Start(tag))) => {
                let problem = format!("the first tag is <{}>", shortened(tag.name));
                return Err(Fault::new(0, problem, EXPECTED));
            }
            Ok(Some(Part::Text { text, .. })) => {
                let problem = format!("the file starts with {}", quoted(text.trim_ascii()));
                return Err(Fault::new(0, problem, EXPECTED));
            }
            Ok(Some(Part::End(_)) | None) | Err(_) => {
                return Err(Fault::new(0, "the file has no tag <VTKFile>", EXPECTED));
            }
        }
    }
}

fn encoding_of(tag: &Tag<'_>) -> Result<(Encoding, Option<UnreadCompressor>), Fault> {
    let kind = tag.attribute("type").unwrap_or_default();
    if kind != "UnstructuredGrid" {
        let problem = format!("the file holds {}", quoted(kind.as_bytes()));
        let advice = "a body is an UnstructuredGrid of tetrahedra: in ParaView the filter Tetrahedralize makes one of a grid, and a mesh \
                      generator fills a surface";
        return Err(Fault::unsupported(tag.offset, problem, advice));
    }
    let wrong = |name: &str, value: &str, expected: &str| {
        let problem = format!("{name} is {}", quoted(value.as_bytes()));
        Fault::new(tag.offset, problem, expected)
    };
    let order = match tag.attribute("byte_order").as_deref() {
        None | Some("LittleEndian") => ByteOrder::Little,
        Some("BigEndian") => ByteOrder::Big,
        Some(other) => return Err(wrong("byte_order", other, "LittleEndian or BigEndian")),
    };
    let header = match tag.attribute("header_type").as_deref() {
        None | Some("UInt32") => Scalar::U32,
        Some("UInt64") => Scalar::U64,
        Some(other) => return Err(wrong("header_type", other, "UInt32 or UInt64")),
    };
    let compressor = tag.attribute("compressor").filter(|name| !name.is_empty());
    let is_compressed = compressor.is_some();
    let can_read = |name: &String| cfg!(feature = "compress") && name == "vtkZLibDataCompressor";
    let unread = compressor.filter(|name| !can_read(name));
    let encoding = Encoding {
        order,
        header,
        is_compressed,
    };
    let unread = unread.map(|name| UnreadCompressor {
        name,
        offset: tag.offset,
    });
    Ok((encoding, unread))
}

/// The appended numbers, whose tag ends at `from`.
fn appended(tag: &Tag<'_>, bytes: &[u8], from: usize) -> Result<AppendedData, Fault> {
    let is_base64 = match tag.attribute("encoding").as_deref() {
        Some("raw") => false,
        None | Some("base64") => true,
        Some(other) => {
            let problem = format!("the appended numbers are {}", quoted(other.as_bytes()));
            return Err(Fault::new(tag.offset, problem, "raw or base64"));
        }
    };
    let rest = bytes.get(from..).unwrap_or_default();
    let blanks = rest
        .iter()
        .take_while(|byte| byte.is_ascii_whitespace())
        .count();
    match rest.get(blanks) {
        Some(b'_') => Ok(AppendedData {
            start: from + blanks + 1,
            is_base64,
        }),
        _ => {
            let problem = "the appended numbers do not begin";
            Err(Fault::new(from, problem, "an underscore before them"))
        }
    }
}

fn cut_off(offset: usize) -> Fault {
    Fault::new(offset, "the file ends here", "</VTKFile>")
}

fn shortened(name: &str) -> String {
    name.chars().take(40).collect()
}

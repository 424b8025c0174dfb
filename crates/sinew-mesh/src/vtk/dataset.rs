//! The grid: points, cells, their types, and the parts between them.

use super::attributes::{self, Holder};
use super::numbers::{Numbers, ValueType, times};
use crate::mesh::Mesh;
use crate::reading::cursor::{Cursor, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::reading::remarks::Remarks;
use crate::unstructured::{Cells, Field, GridBuilder, Scalar};

/// The grid as far as it has been read.
#[derive(Default)]
pub(super) struct Dataset {
    points: Option<Vec<[f64; 3]>>,
    cells: Option<Rows>,
    types: Option<Vec<i64>>,
    pub(super) point_fields: Vec<Field>,
    pub(super) cell_fields: Vec<Field>,
}

/// The nodes of all cells, and the end of each cell's nodes.
struct Rows {
    connectivity: Vec<i64>,
    ends: Vec<i64>,
    offset: usize,
}

pub(super) fn read(
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    remarks: &mut Remarks,
) -> Result<Dataset, Fault> {
    let mut grid = Dataset::default();
    let mut holder = Holder::Grid;
    loop {
        cursor.skip_blanks();
        if cursor.is_at_end() {
            return Ok(grid);
        }
        let offset = cursor.offset();
        let keyword = cursor.token("a keyword")?;
        let name = keyword.text.to_ascii_uppercase();
        let section = String::from_utf8_lossy(&name).into_owned();
        let outcome = match name.as_slice() {
            b"DATASET" => kind(cursor),
            b"POINTS" => points(cursor, numbers, offset, &mut grid),
            b"CELLS" => cells(cursor, numbers, offset, &mut grid),
            b"CELL_TYPES" => types(cursor, numbers, offset, &mut grid),
            b"POINT_DATA" => {
                holder = Holder::Points;
                let points = grid.points.as_ref().map_or(0, Vec::len);
                holders(cursor, "points", points)
            }
            b"CELL_DATA" => {
                holder = Holder::Cells;
                let cells = grid.cells.as_ref().map_or(0, |rows| rows.ends.len());
                holders(cursor, "cells", cells)
            }
            b"METADATA" => {
                attributes::skip_metadata(cursor);
                Ok(())
            }
            _ if attributes::is_one(&name) => {
                let count = match holder {
                    Holder::Grid => None,
                    Holder::Points => Some(grid.points.as_ref().map_or(0, Vec::len)),
                    Holder::Cells => Some(grid.cells.as_ref().map_or(0, |rows| rows.ends.len())),
                };
                let fields = attributes::read(&name, cursor, numbers, count, remarks);
                fields.map(|fields| match holder {
                    Holder::Grid => {}
                    Holder::Points => grid.point_fields.extend(fields),
                    Holder::Cells => grid.cell_fields.extend(fields),
                })
            }
            _ => {
                let problem = format!("{} follows", quoted(keyword.text));
                let expected = "a keyword such as POINTS, CELLS, CELL_TYPES, CELL_DATA or SCALARS";
                return Err(Fault::new(offset, problem, expected));
            }
        };
        outcome.map_err(|fault| fault.inside(section))?;
    }
}

fn kind(cursor: &mut Cursor<'_>) -> Result<(), Fault> {
    let kind = cursor.token("the kind of grid")?;
    if kind.text.eq_ignore_ascii_case(b"UNSTRUCTURED_GRID") {
        return Ok(());
    }
    let problem = format!("the grid is {}", quoted(kind.text));
    let advice = "a body is an UNSTRUCTURED_GRID of tetrahedra: in ParaView the filter Tetrahedralize makes one of a grid, and a mesh \
                  generator fills a surface";
    Err(Fault::unsupported(kind.offset, problem, advice))
}

fn points(
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    offset: usize,
    grid: &mut Dataset,
) -> Result<(), Fault> {
    let count = number::unsigned(
        cursor.token("the number of points")?,
        "the number of points",
    )?;
    let kind = ValueType::read(cursor)?;
    let values = numbers.doubles(cursor, kind, times(count, 3, offset)?)?;
    if let Some(wrong) = values.iter().position(|x| !x.is_finite()) {
        let problem = "a coordinate is infinite or not a number";
        let fault = Fault::new(offset, problem, "finite coordinates");
        return Err(fault.in_record("point", wrong as u64 / 3 + 1, count));
    }
    once(&mut grid.points, values.as_chunks().0.to_vec(), offset)
}

fn cells(
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    offset: usize,
    grid: &mut Dataset,
) -> Result<(), Fault> {
    let first = number::unsigned(cursor.token("the number of cells")?, "the number of cells")?;
    let size = number::unsigned(
        cursor.token("the size of the list")?,
        "the size of the list",
    )?;
    let rows = match is_next(cursor, b"OFFSETS") {
        true => {
            let ends = list(cursor, numbers, b"OFFSETS", first)?;
            let connectivity = list(cursor, numbers, b"CONNECTIVITY", size)?;
            if ends.first().is_some_and(|start| *start != 0) {
                return Err(Fault::new(offset, "the first offset is not 0", "0"));
            }
            Rows {
                connectivity,
                ends: ends.into_iter().skip(1).collect(),
                offset,
            }
        }
        false => {
            let list = numbers.integers(cursor, Scalar::I32, size)?;
            rows_with_counts(&list, first, offset)?
        }
    };
    once(&mut grid.cells, rows, offset)
}

/// True if a word follows, on this line or a later one.
fn is_next(cursor: &Cursor<'_>, word: &[u8]) -> bool {
    let mut ahead = cursor.clone();
    ahead.skip_blanks();
    let next = ahead.rest().get(..word.len());
    next.is_some_and(|next| next.eq_ignore_ascii_case(word))
}

/// A list after its name and type.
fn list(
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    name: &'static [u8],
    count: u64,
) -> Result<Vec<i64>, Fault> {
    let expected = String::from_utf8_lossy(name);
    let token = cursor.token(&expected)?;
    if !token.text.eq_ignore_ascii_case(name) {
        let problem = format!("{} follows", quoted(token.text));
        return Err(Fault::new(token.offset, problem, expected.into_owned()));
    }
    let offset = cursor.offset();
    match ValueType::read(cursor)? {
        ValueType::Number(scalar) => numbers
            .integers(cursor, scalar, count)
            .map_err(|fault| fault.inside(expected.into_owned())),
        ValueType::Bit | ValueType::Text => {
            let problem = "the list has no numbers by its type";
            Err(Fault::new(offset, problem, "a type of whole numbers"))
        }
    }
}

/// Rows that begin with their count.
fn rows_with_counts(list: &[i64], cells: u64, offset: usize) -> Result<Rows, Fault> {
    let mut rows = Rows {
        connectivity: Vec::with_capacity(list.len()),
        ends: Vec::new(),
        offset,
    };
    let mut rest = list;
    while let Some((&count, after)) = rest.split_first() {
        let row = usize::try_from(count)
            .ok()
            .and_then(|count| after.split_at_checked(count));
        let Some((row, after)) = row else {
            let problem = format!("its number of nodes is {count}");
            let expected = format!("a count up to {}, the numbers that are left", after.len());
            let cell = rows.ends.len() as u64 + 1;
            return Err(Fault::new(offset, problem, expected).in_record("cell", cell, cells));
        };
        rest = after;
        rows.connectivity.extend_from_slice(row);
        rows.ends.push(rows.connectivity.len() as i64);
    }
    if rows.ends.len() as u64 != cells {
        let problem = format!("the list has {} cells", rows.ends.len());
        return Err(Fault::new(offset, problem, format!("{cells}, as declared")));
    }
    Ok(rows)
}

fn types(
    cursor: &mut Cursor<'_>,
    numbers: Numbers,
    offset: usize,
    grid: &mut Dataset,
) -> Result<(), Fault> {
    let count = number::unsigned(cursor.token("the number of cells")?, "the number of cells")?;
    let types = numbers.integers(cursor, Scalar::I32, count)?;
    once(&mut grid.types, types, offset)
}

/// Reads the number of points or cells with data, which must be the number of all.
fn holders(cursor: &mut Cursor<'_>, what: &str, count: usize) -> Result<(), Fault> {
    let token = cursor.token("a count")?;
    let given = number::unsigned(token, "the count")?;
    if given == count as u64 {
        return Ok(());
    }
    let problem = format!("the data are of {given} {what}");
    let expected = format!("{count}, as the grid has");
    Err(Fault::new(token.offset, problem, expected))
}

fn once<T>(place: &mut Option<T>, value: T, offset: usize) -> Result<(), Fault> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(Fault::new(offset, "it occurs again", "one grid in a file")),
    }
}

impl Dataset {
    pub(super) fn into_mesh(self, remarks: &mut Remarks) -> Result<Mesh, Fault> {
        let mut builder = GridBuilder::default();
        let missing = |what: &str| {
            Fault::new(
                0,
                format!("the file has no {what}"),
                "POINTS, CELLS and CELL_TYPES",
            )
        };
        let points = self.points.ok_or_else(|| missing("POINTS"))?;
        let types = match (&self.cells, self.types) {
            (_, Some(types)) => types,
            (None, None) => Vec::new(),
            (Some(_), None) => return Err(missing("CELL_TYPES")),
        };
        let rows = match self.cells {
            Some(rows) => rows,
            None if types.is_empty() => Rows {
                connectivity: Vec::new(),
                ends: Vec::new(),
                offset: 0,
            },
            None => return Err(missing("CELLS")),
        };
        let cells = Cells {
            connectivity: rows.connectivity,
            ends: rows.ends,
            // Numbers beyond 255 are no types either.
            types: types
                .into_iter()
                .map(|kind| u8::try_from(kind).unwrap_or(u8::MAX))
                .collect(),
            offset: rows.offset,
        };
        let added = builder.add(points, &cells, self.point_fields, self.cell_fields);
        added.map_err(|fault| fault.inside("CELLS"))?;
        Ok(builder.finish(remarks))
    }
}

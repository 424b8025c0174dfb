//! Differences of fields.

use std::borrow::Cow;
use std::path::Path;

use sinew_mesh::Mesh;
use sinew_mesh::vtu::read_vtu;

use super::outcome::{CompareError, Comparison, Difference, damaged, length, read, relative};
use super::places;
use crate::csv::SAME_TIME;
use crate::frames::SERIES;

/// The end of a frame's file.
const END: &[u8] = b"</VTKFile>";

/// Units of arrays; others are plain numbers.
const UNITS: [(&str, &str); 8] = [
    ("displacement", "m"),
    ("velocity", "m/s"),
    ("acceleration", "m/s^2"),
    ("contact_force", "N"),
    ("contact_pressure", "Pa"),
    ("von_mises", "Pa"),
    ("stress", "Pa"),
    ("step_limit", "s"),
];

/// Compares the frames at equal times: their points and cells, and every array.
pub(super) fn compare(
    comparison: &mut Comparison,
    one: &Path,
    other: &Path,
) -> Result<(), CompareError> {
    let (has_one, has_other) = (one.join(SERIES).exists(), other.join(SERIES).exists());
    if !has_one || !has_other {
        if has_one != has_other {
            comparison.left_out.push("only one has fields".to_owned());
        }
        return Ok(());
    }
    let (frames, others) = (series(one)?, series(other)?);
    let mut found = Found::default();
    let mut alone = 0;
    for (t, file) in &frames {
        let same = |(time, _): &&(f64, String)| (time - t).abs() <= SAME_TIME * t.abs();
        let Some((_, counterpart)) = others.iter().find(same) else {
            alone += 1;
            continue;
        };
        let (frame, other) = (mesh(one, file)?, mesh(other, counterpart)?);
        if frame.points.len() != other.points.len() {
            let (a, b) = (frame.points.len(), other.points.len());
            let reason = format!("fields: {a} and {b} nodes are not those of the same mesh");
            comparison.left_out.push(reason);
            return Ok(());
        }
        found.see(*t, &frame, &other);
    }
    if alone > 0 {
        comparison.left_out.push(format!(
            "fields: {alone} frames of the first have none of the second at their time"
        ));
    }
    found.tell(comparison);
    Ok(())
}

/// Differences of the frames compared so far.
#[derive(Default)]
struct Found {
    /// Largest distance between a point at rest and its counterpart.
    points: Option<Difference>,
    /// The first frame whose cells differ, with the share of different cells.
    cells: Option<Difference>,
    arrays: Vec<OfArray>,
    /// Names of arrays that only one of them has, or whose numbers of components differ.
    alone: Vec<String>,
}

/// The largest difference of an array.
struct OfArray {
    name: String,
    of_points: bool,
    largest: f64,
    t: f64,
    holder: usize,
    /// The largest value in the first result.
    size: f64,
}

/// An array of points or cells.
struct View<'a> {
    name: &'a str,
    of_points: bool,
    components: usize,
    values: Cow<'a, [f64]>,
}

impl Found {
    /// Compares two frames with the same number of points at the time `t` (s).
    fn see(&mut self, t: f64, frame: &Mesh, other: &Mesh) {
        let is_farther = |found: &Difference, known: &Option<Difference>| {
            known
                .as_ref()
                .is_none_or(|known| found.largest > known.largest)
        };
        let apart = places::apart("fields", 0.0, &frame.points, &other.points);
        if let Some(apart) = apart.filter(|apart| is_farther(apart, &self.points)) {
            self.points = Some(Difference { t, ..apart });
        }
        if self.cells.is_none() {
            self.cells = other_cells(frame, other).map(|cells| Difference { t, ..cells });
        }
        let (arrays, others) = (arrays(frame), arrays(other));
        let fits = |a: &View<'_>, b: &View<'_>| {
            (a.name, a.of_points, a.components) == (b.name, b.of_points, b.components)
        };
        for (some, counterparts) in [(&arrays, &others), (&others, &arrays)] {
            let alone = some
                .iter()
                .filter(|a| !counterparts.iter().any(|b| fits(a, b)));
            for View { name, .. } in alone {
                if !self.alone.iter().any(|known| known == name) {
                    self.alone.push((*name).to_owned());
                }
            }
        }
        for array in &arrays {
            if let Some(counterpart) = others.iter().find(|other| fits(array, other)) {
                self.see_array(t, array, &counterpart.values);
            }
        }
    }

    fn see_array(&mut self, t: f64, array: &View<'_>, others: &[f64]) {
        let (name, of_points, components) = (array.name, array.of_points, array.components);
        let known = self
            .arrays
            .iter()
            .position(|known| known.name == name && known.of_points == of_points);
        let place = known.unwrap_or_else(|| {
            self.arrays.push(OfArray {
                name: name.to_owned(),
                of_points,
                largest: 0.0,
                t,
                holder: 0,
                size: 0.0,
            });
            self.arrays.len() - 1
        });
        let found = &mut self.arrays[place];
        let rows = array.values.chunks(components.max(1));
        for (holder, (a, b)) in rows.zip(others.chunks(components.max(1))).enumerate() {
            // Neither do values that are the same and infinite, or missing in both.
            let is_same = |a: f64, b: f64| a == b || (a.is_nan() && b.is_nan());
            let apart = a.iter().zip(b);
            let apart = apart.map(|(a, b)| if is_same(*a, *b) { 0.0 } else { a - b });
            let difference = length(apart);
            let size = length(a.iter().copied());
            if size.is_finite() {
                found.size = found.size.max(size);
            }
            if difference > found.largest || difference.is_nan() {
                (found.largest, found.t, found.holder) = (difference, t, holder);
            }
        }
    }

    fn tell(self, comparison: &mut Comparison) {
        let all = &mut comparison.differences;
        all.extend(self.points);
        all.extend(self.cells);
        all.extend(self.arrays.into_iter().map(|found| {
            let unit = UNITS.iter().find(|(name, _)| *name == found.name);
            Difference {
                of: "fields",
                unit: unit.map_or("", |(_, unit)| unit).to_owned(),
                largest: found.largest,
                relative: relative(found.largest, found.size),
                t: found.t,
                node: found.of_points.then_some(found.holder),
                what: found.name,
            }
        }));
        let alone = self.alone.into_iter();
        let alone = alone.map(|name| {
            format!("fields: `{name}` is in one of them only, or has other components")
        });
        comparison.left_out.extend(alone);
    }
}

/// The share of different cells; `None` if all are the same.
fn other_cells(frame: &Mesh, other: &Mesh) -> Option<Difference> {
    let cells = |mesh: &'_ Mesh| {
        let cells = mesh.cells.iter();
        let cells = cells.flat_map(|block| block.cells().map(|nodes| (block.kind, nodes.to_vec())));
        cells.collect::<Vec<_>>()
    };
    let (some, others) = (cells(frame), cells(other));
    let most = some.len().max(others.len());
    let same = some.iter().zip(&others).filter(|(a, b)| a == b).count();
    (same < most).then(|| Difference {
        of: "fields",
        what: "cells".to_owned(),
        unit: String::new(),
        largest: (most - same) as f64,
        relative: (most - same) as f64 / most as f64,
        t: 0.0,
        node: None,
    })
}

/// All arrays of a frame.
fn arrays(frame: &Mesh) -> Vec<View<'_>> {
    let of_points = frame.point_data.iter().map(|data| View {
        name: &data.name,
        of_points: true,
        components: data.components,
        values: Cow::Borrowed(&data.values),
    });
    let of_cells = frame.cell_data.iter().map(|data| View {
        name: &data.name,
        of_points: false,
        components: data.components,
        values: match &data.blocks[..] {
            [values] => Cow::Borrowed(values),
            blocks => Cow::Owned(blocks.concat()),
        },
    });
    of_points.chain(of_cells).collect()
}

/// Times (s) and files of the frames of a result.
fn series(folder: &Path) -> Result<Vec<(f64, String)>, CompareError> {
    let path = folder.join(SERIES);
    let text = String::from_utf8_lossy(&read(folder, SERIES)?).into_owned();
    let mut frames = Vec::new();
    for line in text.lines().filter(|line| line.starts_with("<DataSet")) {
        let frame = attribute(line, "timestep").and_then(|t| t.parse().ok());
        let frame = frame.zip(attribute(line, "file"));
        let (t, file) = frame.ok_or_else(|| damaged(&path, "expected a time and a file"))?;
        frames.push((t, file.to_owned()));
    }
    Ok(frames)
}

/// A frame, read as a whole.
fn mesh(folder: &Path, name: &str) -> Result<Mesh, CompareError> {
    let (path, bytes) = (folder.join(name), read(folder, name)?);
    if !bytes.trim_ascii_end().ends_with(END) {
        return Err(damaged(&path, "it does not end as a frame does"));
    }
    read_vtu(&bytes).map_err(|error| damaged(&path, error.to_string()))
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let begin = format!(" {name}=\"");
    tag.split(&begin).nth(1)?.split('"').next()
}

//! Differences of fields.

use std::path::Path;

use sinew_core::vectors::norm;
use sinew_mesh::vtu::read_appended_array;

use super::outcome::{CompareError, Comparison, Difference, damaged, read, relative};
use super::places;
use crate::csv::SAME_TIME;
use crate::frames::SERIES;

/// Fields that are compared, with their units.
const FIELDS: [(&str, &str); 2] = [("displacement", "m"), ("velocity", "m/s")];

/// The points of the body at rest.
const POINTS: &str = "Points";

/// Compares the frames at equal times.
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
    let mut found = FIELDS.map(|_| (0.0_f64, 0.0, 0, 0.0_f64));
    let mut alone = 0;
    let mut compared_points = false;
    for (t, file) in &frames {
        let same = |(time, _): &&(f64, String)| (time - t).abs() <= SAME_TIME * t.abs();
        let Some((_, counterpart)) = others.iter().find(same) else {
            alone += 1;
            continue;
        };
        let (path, counterpart) = (one.join(file), other.join(counterpart));
        let (bytes, others) = (read(&path)?, read(&counterpart)?);
        if !compared_points {
            compared_points = true;
            let points = [(&path, &bytes), (&counterpart, &others)];
            let [one, other] = points.map(|(path, bytes)| vectors(path, bytes, POINTS));
            let (one, other) = (one?, other?);
            if one.len() == other.len() {
                comparison
                    .differences
                    .extend(places::apart("fields", &one, &other));
            }
        }
        for ((name, _), (largest, at, node, size)) in FIELDS.iter().zip(&mut found) {
            let (field, others) = (
                vectors(&path, &bytes, name)?,
                vectors(&counterpart, &others, name)?,
            );
            if field.len() != others.len() {
                let (a, b) = (field.len(), others.len());
                let reason = format!("fields: {a} and {b} nodes are not those of the same mesh");
                comparison.left_out.push(reason);
                return Ok(());
            }
            for (number, (a, b)) in field.iter().zip(&others).enumerate() {
                let difference = norm(&[a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
                *size = size.max(norm(a));
                if difference > *largest || difference.is_nan() {
                    (*largest, *at, *node) = (difference, *t, number);
                }
            }
        }
    }
    if alone > 0 {
        comparison.left_out.push(format!(
            "fields: {alone} frames of the first have none of the second at their time"
        ));
    }
    if alone < frames.len() {
        let differences = FIELDS.iter().zip(found);
        comparison.differences.extend(differences.map(
            |((name, unit), (largest, t, node, size))| Difference {
                of: "fields",
                what: (*name).to_owned(),
                unit: (*unit).to_owned(),
                largest,
                relative: relative(largest, size),
                t,
                node: Some(node),
            },
        ));
    }
    Ok(())
}

/// Times (s) and files of the frames of a result.
fn series(folder: &Path) -> Result<Vec<(f64, String)>, CompareError> {
    let path = folder.join(SERIES);
    let text = String::from_utf8_lossy(&read(&path)?).into_owned();
    let mut frames = Vec::new();
    for line in text.lines().filter(|line| line.starts_with("<DataSet")) {
        let frame = attribute(line, "timestep").and_then(|t| t.parse().ok());
        let frame = frame.zip(attribute(line, "file"));
        let (t, file) = frame.ok_or_else(|| damaged(&path, "expected a time and a file"))?;
        frames.push((t, file.to_owned()));
    }
    Ok(frames)
}

/// A field of vectors of a frame.
fn vectors(path: &Path, bytes: &[u8], name: &str) -> Result<Vec<[f64; 3]>, CompareError> {
    let numbers =
        read_appended_array(bytes, name).map_err(|error| damaged(path, error.to_string()))?;
    Ok(numbers.as_chunks::<3>().0.to_vec())
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let begin = format!(" {name}=\"");
    tag.split(&begin).nth(1)?.split('"').next()
}

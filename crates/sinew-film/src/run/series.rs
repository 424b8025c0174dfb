//! The list of a run's frames.

use crate::FilmError;

/// Its file.
pub(super) const SERIES: &str = "fields.pvd";

/// Times (s) and files of the frames that a list names, in the order of time.
pub(super) fn frames_of(bytes: &[u8]) -> Result<Vec<(f64, String)>, FilmError> {
    let text = String::from_utf8_lossy(bytes);
    let mut frames = Vec::new();
    for line in text.lines().map(str::trim_start) {
        if !line.starts_with("<DataSet") {
            continue;
        }
        let t = attribute(line, "timestep").and_then(|t| t.parse::<f64>().ok());
        let frame = t.filter(|t| t.is_finite()).zip(attribute(line, "file"));
        let (t, file) = frame.ok_or_else(|| FilmError::Damaged {
            name: SERIES.to_owned(),
            reason: format!("expected a time and a file, found {line}"),
        })?;
        frames.push((t, file.to_owned()));
    }
    frames.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(frames)
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let begin = format!(" {name}=\"");
    tag.split(&begin).nth(1)?.split('"').next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_files_are_read_and_what_is_damaged_is_shown() {
        let text = "<Collection>\n  <DataSet timestep=\"0.5\" group=\"\" part=\"0\" file=\"b.vtu\"/>\n<DataSet timestep=\"0\" file=\"a.vtu\"/>\n";
        let found = frames_of(text.as_bytes()).ok();
        let expected = [(0.0, "a.vtu".to_owned()), (0.5, "b.vtu".to_owned())];
        assert_eq!(found, Some(expected.to_vec()));
        let damaged = frames_of(b"<DataSet timestep=\"soon\" file=\"a\"/>");
        let said = damaged
            .map_err(|error| error.to_string())
            .expect_err("a word");
        assert!(
            said.starts_with("fields.pvd: expected a time and a file"),
            "{said}"
        );
    }
}

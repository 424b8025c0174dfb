//! A series of .vtu files over time.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::out::escaped;

/// Writes a .pvd file: the time and the .vtu file, relative to the .pvd file, of each frame.
///
/// # Errors
///
/// If the destination fails.
pub fn write_pvd(frames: &[(f64, &str)], to: &mut impl Write) -> io::Result<()> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
         <Collection>\n",
    );
    for (time, file) in frames {
        let file = escaped(file);
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>"
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    to.write_all(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_lists_its_frames() {
        let mut file = Vec::new();
        write_pvd(&[(0.0, "a.vtu"), (0.5, "b & c.vtu")], &mut file).expect("memory takes all");
        let expected = r#"<?xml version="1.0"?>
<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">
<Collection>
<DataSet timestep="0.0" group="" part="0" file="a.vtu"/>
<DataSet timestep="0.5" group="" part="0" file="b &amp; c.vtu"/>
</Collection>
</VTKFile>
"#;
        assert_eq!(String::from_utf8_lossy(&file), expected);
    }
}

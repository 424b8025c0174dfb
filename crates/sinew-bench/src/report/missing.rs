//! The list of missing things, as people read it.

use std::fmt::Write;

use super::markup::escape;
use crate::results::Missing;

/// A number by its format, or what stands in its place.
pub(super) fn shown(x: f64, format: impl Fn(f64) -> String) -> String {
    if x.is_finite() {
        format(x)
    } else {
        format!("n/a ({x})")
    }
}

/// One line each, for terminal and Markdown.
pub(super) fn lines(missing: &[Missing]) -> String {
    let lines = missing.iter().map(|missing| format!("- {missing}\n"));
    lines.collect()
}

/// The section of the page; nothing where nothing is missing.
pub(super) fn section(missing: &[Missing]) -> String {
    if missing.is_empty() {
        return String::new();
    }
    let mut out = String::from(
        "<section>\n<h2 id=\"missing\">Missing</h2>\n<div class=\"wide\"><table>\n\
         <thead><tr><th>where</th><th>what</th><th>why</th></tr></thead>\n<tbody>\n",
    );
    for missing in missing {
        // Writing into a String cannot fail.
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
            escape(&missing.place()),
            escape(&missing.what()),
            escape(&missing.reason)
        );
    }
    out.push_str("</tbody>\n</table></div>\n</section>\n");
    out
}

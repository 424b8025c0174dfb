//! Text broken into lines for a terminal.

/// The widest line (characters).
pub(crate) const WIDTH: usize = 100;

/// A text after a heading, its further lines beneath its own first.
pub(crate) fn hanging(heading: &str, text: &str) -> String {
    let indent = " ".repeat(heading.chars().count());
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        lines.extend(broken(paragraph, WIDTH - indent.len()));
    }
    let lines = lines.iter().enumerate().map(|(number, line)| {
        let before = if number == 0 { heading } else { &indent };
        format!("{before}{line}")
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// A text in lines of at most `width` characters where its words allow that.
fn broken(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split(' ') {
        let longer = line.chars().count() + 1 + word.chars().count();
        if !line.is_empty() && longer > width {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.push(line);
    lines
}

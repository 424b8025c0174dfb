//! Text broken into lines for a terminal.

/// The widest line (characters) of texts for a terminal.
pub const WIDTH: usize = 100;

/// A text in lines of at most [`WIDTH`] characters, if its words allow that: the first after `heading`, those of
/// further paragraphs beneath it, and those that continue a paragraph `hang` characters farther in.
///
/// ```
/// use sinew_scene::output::hanging;
///
/// let text = hanging("held    ", &"a support ".repeat(12), 2);
/// let lines: Vec<&str> = text.lines().collect();
/// assert!(lines[0].starts_with("held    a support") && lines[1].starts_with("          "));
/// assert!(lines.iter().all(|line| line.len() <= 100));
/// ```
#[must_use]
pub fn hanging(heading: &str, text: &str, hang: usize) -> String {
    let heading_width = heading.chars().count();
    let mut lines: Vec<String> = Vec::new();
    for paragraph in text.lines() {
        let mut line = match lines.is_empty() {
            true => heading.to_owned(),
            false => " ".repeat(heading_width),
        };
        let mut is_empty = true;
        for word in paragraph.trim_end().split(' ') {
            let longer = line.chars().count() + usize::from(!is_empty) + word.chars().count();
            if !is_empty && longer > WIDTH {
                let next = " ".repeat(heading_width + hang);
                lines.push(std::mem::replace(&mut line, next));
                is_empty = true;
            }
            if !is_empty {
                line.push(' ');
            }
            line.push_str(word);
            is_empty = false;
        }
        lines.push(line);
    }
    lines.join("\n")
}

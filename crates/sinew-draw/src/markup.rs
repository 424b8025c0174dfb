//! Text inside HTML and SVG, and names of files and anchors.

/// Escapes text for the content and the quoted attributes of HTML and SVG. Control characters,
/// which are invalid in XML, become the replacement character.
#[must_use]
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() => out.push(char::REPLACEMENT_CHARACTER),
            c => out.push(c),
        }
    }
    out
}

/// Escaped text in which the text between two backticks is set as code.
#[must_use]
pub fn prose(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, (code, after))) = rest
        .split_once('`')
        .and_then(|(before, after)| Some((before, after.split_once('`')?)))
    {
        out.push_str(&format!("{}<code>{}</code>", escape(before), escape(code)));
        rest = after;
    }
    out.push_str(&escape(rest));
    out
}

/// An attribute of an HTML element, with a blank before it; nothing if its value is empty.
pub(crate) fn attribute(name: &str, value: &str) -> String {
    if value.is_empty() {
        String::new()
    } else {
        format!(" {name}=\"{}\"", escape(value))
    }
}

/// Names for files and anchors, one per id, all different even on file systems that fold case.
#[must_use]
pub fn slugs(ids: &[&str]) -> Vec<String> {
    let mut slugs: Vec<String> = Vec::with_capacity(ids.len());
    for id in ids {
        let base = slug(id);
        let taken = |name: &str| slugs.iter().any(|s| s.eq_ignore_ascii_case(name));
        let free = (2..)
            .map(|n| format!("{base}-{n}"))
            .find(|name| !taken(name));
        let name = if taken(&base) {
            free.unwrap_or_default()
        } else {
            base
        };
        slugs.push(name);
    }
    slugs
}

fn slug(id: &str) -> String {
    id.chars()
        .map(|c| match c {
            c if c.is_ascii_alphanumeric() || c == '_' || c == '.' => c,
            _ => '-',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_escapes() {
        assert_eq!(
            escape("<b a=\"1\" c='2'>&amp;\u{0}"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;amp;\u{fffd}"
        );
        assert_eq!(escape("µs ≤ 5 %"), "µs ≤ 5 %");
    }

    #[test]
    fn code_stands_between_backticks() {
        assert_eq!(
            prose("`a<b` and `c`: 1 < 2"),
            "<code>a&lt;b</code> and <code>c</code>: 1 &lt; 2"
        );
        assert_eq!(prose("one ` alone"), "one ` alone");
    }

    #[test]
    fn slugs_are_safe_and_different() {
        assert_eq!(
            slugs(&["paper-cube", "a/b", "a b", "../x", "A-B"]),
            ["paper-cube", "a-b", "a-b-2", "..-x", "A-B-3"]
        );
    }
}

//! The list of contents.

use std::fmt::{self, Display};

use crate::markup::{escape, prose};

/// Least number of sections for a list.
const FEWEST: usize = 3;

/// Anchors and headings of a page's sections; a list of links if there are several.
#[derive(Clone, Debug, Default)]
pub(super) struct Contents(Vec<(String, String)>);

impl Contents {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn add(&mut self, anchor: &str, heading: &str) {
        self.0.push((anchor.to_owned(), heading.to_owned()));
    }
}

impl Display for Contents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.len() < FEWEST {
            return Ok(());
        }
        f.write_str("<nav aria-label=\"Contents\">\n<ul>\n")?;
        for (anchor, heading) in &self.0 {
            let (anchor, heading) = (escape(anchor), prose(heading));
            writeln!(f, "<li><a href=\"#{anchor}\">{heading}</a></li>")?;
        }
        f.write_str("</ul>\n</nav>\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_sections_have_a_list_of_links() {
        let mut contents = Contents::default();
        contents.add("a", "First");
        contents.add("b", "Second");
        assert_eq!(contents.to_string(), "");
        contents.add("c", "The `third`");
        let list = contents.to_string();
        assert_eq!(list.matches("<li>").count(), 3);
        assert!(list.contains("<a href=\"#c\">The <code>third</code></a>"));
    }
}

//! HTML pages: one file, nothing from the network, readable without scripts.

mod contents;
mod table;

use crate::markup::{escape, prose};
use contents::Contents;
pub use table::{Cell, Column, Table, TableRow};

/// A page being written: a title, the part before the first section, and sections. Texts are escaped; in those called
/// prose, the text between backticks is set as code.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    style: String,
    lead: String,
    sections: String,
    contents: Contents,
}

impl Page {
    /// A page with that title, which is also its first heading.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            style: String::new(),
            lead: String::new(),
            sections: String::new(),
            contents: Contents::default(),
        }
    }

    /// The page with more rules of style (CSS), which follow the common ones.
    #[must_use]
    pub fn with_style(mut self, css: &str) -> Self {
        self.style.push_str(css);
        self
    }

    /// Begins a section: its anchor, and its heading in prose, which the list of contents names.
    pub fn section(&mut self, anchor: &str, heading: &str) {
        if !self.contents.is_empty() {
            self.sections.push_str("</section>\n");
        }
        self.contents.add(anchor, heading);
        let (anchor, heading) = (escape(anchor), prose(heading));
        self.sections
            .push_str(&format!("<section>\n<h2 id=\"{anchor}\">{heading}</h2>\n"));
    }

    /// A heading within a section, in prose.
    pub fn heading(&mut self, heading: &str) {
        self.put(format_args!("<h3>{}</h3>\n", prose(heading)));
    }

    /// A paragraph of prose.
    pub fn paragraph(&mut self, text: &str) {
        self.put(format_args!("<p>{}</p>\n", prose(text)));
    }

    /// A warning: prose that is highlighted.
    pub fn warning(&mut self, text: &str) {
        self.put(format_args!("<p class=\"warning\">{}</p>\n", prose(text)));
    }

    /// A list of prose.
    pub fn list<T: AsRef<str>>(&mut self, items: impl IntoIterator<Item = T>) {
        self.markup("<ul>\n");
        for item in items {
            self.put(format_args!("<li>{}</li>\n", prose(item.as_ref())));
        }
        self.markup("</ul>\n");
    }

    /// Names and values side by side; empty values are left out.
    pub fn facts<N: AsRef<str>, V: AsRef<str>>(&mut self, facts: impl IntoIterator<Item = (N, V)>) {
        self.markup("<dl>\n");
        for (name, value) in facts {
            let (name, value) = (escape(name.as_ref()), escape(value.as_ref()));
            if !value.is_empty() {
                self.put(format_args!("<dt>{name}</dt><dd>{value}</dd>\n"));
            }
        }
        self.markup("</dl>\n");
    }

    /// A picture (SVG) with a caption in prose, which may be empty.
    pub fn figure(&mut self, svg: &str, caption: &str) {
        self.put(format_args!(
            "<figure>\n<div class=\"wide plot\">\n{svg}</div>\n"
        ));
        if !caption.is_empty() {
            self.put(format_args!(
                "<figcaption>{}</figcaption>\n",
                prose(caption)
            ));
        }
        self.markup("</figure>\n");
    }

    /// A table.
    pub fn table(&mut self, table: &Table) {
        self.put(format_args!("{table}"));
    }

    /// A part that opens when its summary, in prose, is clicked.
    pub fn folded(&mut self, summary: &str, write: impl FnOnce(&mut Self)) {
        let summary = prose(summary);
        self.put(format_args!("<details>\n<summary>{summary}</summary>\n"));
        write(self);
        self.markup("</details>\n");
    }

    /// HTML as given, for content without its own method.
    pub fn markup(&mut self, html: &str) {
        if self.contents.is_empty() {
            self.lead.push_str(html);
        } else {
            self.sections.push_str(html);
        }
    }

    /// The page as a file.
    #[must_use]
    pub fn finish(mut self) -> String {
        if !self.contents.is_empty() {
            self.sections.push_str("</section>\n");
        }
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>\n{common}{own}</style>\n</head>\n<body>\n\
             <header>\n<h1>{title}</h1>\n{lead}</header>\n{contents}{sections}\
             <script>\n{sort}{plots}</script>\n</body>\n</html>\n",
            title = escape(&self.title),
            common = include_str!("page.css"),
            own = self.style,
            lead = self.lead,
            contents = self.contents,
            sections = self.sections,
            sort = include_str!("sort.js"),
            plots = include_str!("plots.js"),
        )
    }

    fn put(&mut self, arguments: std::fmt::Arguments<'_>) {
        self.markup(&arguments.to_string());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVIL: &str = "<script>alert(\"&'\")</script>";

    fn page() -> String {
        let mut page = Page::new(EVIL).with_style("p { color: red; }\n");
        page.facts([(EVIL, EVIL), ("empty", "")]);
        for anchor in ["first", "second", "third"] {
            page.section(anchor, EVIL);
            page.heading(EVIL);
            page.paragraph(EVIL);
            page.warning(EVIL);
            page.list([EVIL]);
            page.figure("<svg></svg>", EVIL);
            page.folded(EVIL, |page| page.paragraph(EVIL));
            page.table(&Table {
                columns: vec![Column::text(EVIL).explained(EVIL)],
                rows: vec![TableRow::new([Cell::text(EVIL).noted(EVIL).titled(EVIL)])],
                ..Table::default()
            });
        }
        page.finish()
    }

    #[test]
    fn no_text_becomes_markup() {
        let page = page();
        assert!(!page.contains("<script>alert") && !page.contains("&'"));
        assert_eq!(page.matches("<script>").count(), 1);
        let escaped = page.matches("&lt;script&gt;alert(&quot;&amp;&#39;&quot;)");
        assert_eq!(escaped.count(), 4 + 3 * 14);
    }

    #[test]
    fn a_page_needs_no_network_and_its_tags_are_closed() {
        let page = page();
        for word in ["http:", "https:", "src=", "@import", "url("] {
            assert!(!page.contains(word), "{word}");
        }
        for tag in [
            "section", "header", "nav", "table", "tr", "td", "th", "ul", "li", "dl", "figure",
            "details", "div",
        ] {
            let open = page.matches(&format!("<{tag}>")).count()
                + page.matches(&format!("<{tag} ")).count();
            let closed = page.matches(&format!("</{tag}>")).count();
            assert_eq!(open, closed, "{tag}");
            assert!(open > 0, "{tag}");
        }
    }

    #[test]
    fn what_has_no_value_is_no_fact() {
        assert!(!page().contains("empty"));
    }
}

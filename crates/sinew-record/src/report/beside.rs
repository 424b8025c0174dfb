//! Figures side by side.

use sinew_draw::Page;

/// Rules that place figures side by side if there is space, and shrink them otherwise.
pub(super) const STYLE: &str = ".beside { display: flex; flex-wrap: wrap; gap: 1rem; }\n\
     .beside figure { flex: 1 1 24rem; margin: 0; max-width: 40rem; }\n\
     .beside .plot svg { min-width: 0; }\n";

/// Places drawings side by side.
pub(super) fn figures<T: AsRef<str>>(page: &mut Page, drawings: &[T]) {
    page.markup("<div class=\"beside\">\n");
    for svg in drawings {
        page.figure(svg.as_ref(), "");
    }
    page.markup("</div>\n");
}

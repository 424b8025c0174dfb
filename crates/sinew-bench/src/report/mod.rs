//! Tables, plots and a page of a bench. No speed stands without its error beside it.
//!
//! The pictures are SVG, written here rather than by a plotting library: the cells of a strip, a
//! shaded surface, marks with hover texts and colours that follow the page's dark mode are not what
//! such libraries draw, and axes are little work compared with them.

mod axis;
mod colour_map;
mod columns;
mod front;
mod heat_map;
mod html;
mod marks;
mod markup;
mod missing;
mod peers;
mod plot;
mod roofline;
pub(crate) mod ruled;
mod strip;
mod style;
mod summary;
mod surface;
mod svg;
mod table;
mod verdict;
mod work_precision;
mod write;

pub use axis::{Axis, Scale};
pub use front::{FrontMember, front_members, modal_sentence, paper_sentence};
pub use heat_map::heat_map;
pub use html::html;
pub use marks::{markdown_marks, terminal_marks};
pub(crate) use markup::escape;
pub use plot::{Plot, Point, Rule, Series};
pub use roofline::{Family, Roofline};
pub use strip::strip;
pub use style::{Colour, Dash, Marker, Style};
pub use surface::Surface;
pub use table::{markdown, markdown_rows, terminal, terminal_rows};
pub use work_precision::work_precision;
pub(crate) use write::file_names;
pub use write::{WriteError, Written, write_all};

pub(crate) use sinew_measure::number::{self, milliseconds, percent, short, three, two};

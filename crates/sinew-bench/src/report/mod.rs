//! Tables, plots and a page of a bench. No speed is shown without its error.

mod brief;
mod case_section;
mod columns;
mod front;
mod heat_map;
mod html;
mod marks;
mod missing;
mod peers;
mod strip;
mod summary;
mod table;
mod verdict;
mod work_precision;
mod write;

pub use brief::{brief, markdown_cheapest};
pub use front::{FrontMember, front_members, modal_sentence, paper_sentence};
pub use heat_map::heat_map;
pub use html::html;
pub use marks::{markdown_marks, terminal_marks};
pub use strip::strip;
pub use table::{markdown, markdown_rows, terminal, terminal_rows};
pub use work_precision::work_precision;
pub(crate) use write::file_names;
pub use write::{WriteError, Written, write_all};

pub(crate) use sinew_measure::number::{self, milliseconds, percent, short, three, two};

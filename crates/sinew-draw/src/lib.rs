//! Plots and pictures as SVG, pages as HTML: data in, text out.
//!
//! [`Plot`] draws series on two axes, [`Sheet`] plots side by side, [`Surface`] a mesh, [`Roofline`] rates beneath
//! their limits;
//! [`svg`] and [`axis`] are their parts. [`Page`] is an HTML page in one file with
//! headings, facts, tables and figures. Everything follows a reader's light or dark colours and needs
//! no network.

pub mod axis;
pub mod colour_map;
pub mod markup;
mod number;
pub mod page;
mod plot;
mod roofline;
mod sheet;
pub mod style;
mod surface;
pub mod svg;

pub use axis::{Axis, Scale};
pub use number::short;
pub use page::Page;
pub use plot::{Plot, Point, Rule, Series};
pub use roofline::{Family, Roofline};
pub use sheet::Sheet;
pub use style::{Colour, Dash, Marker, Style};
pub use surface::Surface;

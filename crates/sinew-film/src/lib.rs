//! Pictures and films of a run, with our own renderer.
//!
//! A [`Run`] reads the frames of a run folder, a [`Film`] shows their surface and the instruments: as tissue, or
//! coloured by a field with the bar of its values. Pictures are PNG ([`Picture::to_png`]). Films are animated PNG
//! ([`Film::animation`]), which browsers play in place of a picture, or single pictures for other programs. The crate
//! takes data and returns bytes; it opens no files. The same run gives the same bytes.
//!
//! ```
//! use std::sync::Arc;
//! use sinew_film::{Clip, Colouring, Film, Frame, Kind, Look, Size, Surface, View};
//!
//! let corners = vec![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
//! let faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
//! let surface = Arc::new(Surface::new(corners, &faces, &[Kind::Tissue(1); 4]));
//! let clip = Clip::new(vec![Frame::new(0.0, surface, Vec::new(), Vec::new())]);
//! let look = Look {
//!     size: Size::new(320, 180)?,
//!     view: View::iso(),
//!     colouring: Colouring::tissue(),
//!     range: None,
//!     title: "A tetrahedron".to_owned(),
//! };
//! let film = Film::new(clip, Vec::new(), &look)?;
//! let png = film.picture(0.0).to_png()?;
//! assert!(sinew_film::is_own_png(&png));
//! # Ok::<(), sinew_film::FilmError>(())
//! ```
//!
//! # Rendering of a picture
//!
//! Each pixel has four points, at which the nearest triangle is found; it is shaded once for every triangle that is
//! seen in it. Normals are smooth across edges of less than 40 degrees. The light comes from one lamp with soft shadows
//! (variance shadow maps), a weak lamp, and from above and below; the floor is dark beneath objects that are on it.
//! Threads share a picture by bands of rows; the bits do not depend on their number.
//!
//! # Libraries that are used, and those that are not
//!
//! * `png` 0.18 (MIT or Apache-2.0), on which `image` is built, writes PNG and animated PNG; with `flate2`, which is
//!   used already, it adds seven crates. `image` would add readers and writers of formats that are not needed.
//! * Animated WebP: `image-webp` 0.2 writes single pictures, and `webp` binds libwebp, which needs a C compiler. GIF
//!   has the same 256 colours and packs them by LZW, which is worse than deflate.
//! * `euc` 0.5 draws triangles by shaders, with one point a pixel, and leaves light, shadows, cameras and clipping to
//!   its user: these are in this crate, next to a rasteriser of a hundred lines. The state after 0.5, which smooths
//!   edges, needed a nightly compiler. `wgpu` needs a driver, even for software rendering, which other computers may
//!   not have, and does not guarantee the same bits. `tiny-skia` (BSD) fills paths in the plane; only labels are drawn
//!   in the plane here.
//! * `ab_glyph` and `fontdue` need a font in the crate, with its licence. Labels are short, and strokes of a pen for a
//!   hundred letters fit in one file.
//! * mp4 needs an encoder, which is too large to write again. Pictures can be piped to `ffmpeg` if it is installed.

mod body;
mod clip;
mod colour_space;
mod error;
mod field;
mod files;
mod film;
mod overlay;
mod picture;
mod range;
mod render;
mod run;
mod size;
mod timing;
mod tool;
mod vector;
mod view;

pub use body::{Kind, Surface};
pub use clip::{Clip, Frame};
pub use error::FilmError;
pub use field::{Colouring, Field};
pub use files::is_own_png;
pub use film::{Film, Look};
pub use picture::Picture;
pub use run::{Files, Run};
pub use size::Size;
pub use timing::Timing;
pub use tool::{Part, PoseAt, Shape, Tool, back_of, blades_of_strokes, poses_of_table};
pub use view::View;

//! A picture as PNG.

use png::{BitDepth, ColorType, Compression, Encoder};

use super::software::SOFTWARE;
use crate::{FilmError, Picture};

/// Bytes at the beginning of a file that are searched for the mark of this crate.
const HEAD: usize = 4096;

/// The first bytes of PNG files.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

impl Picture {
    /// The picture as a PNG file.
    ///
    /// # Errors
    /// [`FilmError::Png`].
    pub fn to_png(&self) -> Result<Vec<u8>, FilmError> {
        let (width, height) = (self.size().width() as u32, self.size().height() as u32);
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Balanced);
        let [keyword, program] = SOFTWARE.map(str::to_owned);
        encoder.add_text_chunk(keyword, program)?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels().as_flattened())?;
        writer.finish()?;
        Ok(file)
    }
}

/// True for the bytes of a PNG file, animated or not, that this crate made.
#[must_use]
pub fn is_own_png(bytes: &[u8]) -> bool {
    let [keyword, program] = SOFTWARE;
    let mark = [keyword.as_bytes(), program.as_bytes()].join(&0);
    let head = &bytes[..bytes.len().min(HEAD)];
    head.starts_with(SIGNATURE) && head.windows(mark.len()).any(|window| window == mark)
}

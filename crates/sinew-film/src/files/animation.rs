//! Films as animated PNG: one table of colours for all pictures, and for each picture the difference from the one
//! before.

use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, Filter, Writer};

use super::colours::Colours;
use super::software::SOFTWARE;
use crate::{FilmError, Picture, Size};

/// The number of a pixel that does not change. It follows the numbers of all colours.
const STAYS: u8 = 255;

/// Largest error of a component, in steps, for which a pixel is not written again.
const SAME: u8 = 2;

/// The least time (s) for which the last picture stays before the film begins again.
const LAST: f64 = 0.7;

/// Number of parts of a second, the unit of delays.
const PARTS: u16 = 1000;

/// A film that is written picture by picture.
pub(crate) struct Animation<'a> {
    writer: Writer<&'a mut Vec<u8>>,
    size: Size,
    colours: Colours,
    /// The numbers of the colours that are shown.
    shown: Vec<u8>,
    /// Number of remaining pictures.
    left: u32,
    /// Time (s) from picture to picture.
    delay: f64,
}

/// A part of a picture: its columns and rows, and the numbers of its colours.
struct Patch {
    at: [u32; 2],
    size: [u32; 2],
    numbers: Vec<u8>,
    blend: BlendOp,
}

impl<'a> Animation<'a> {
    /// A film with a number of pictures and a rate (1/s). It begins again at its end.
    pub(crate) fn new(
        file: &'a mut Vec<u8>,
        (size, colours): (Size, Colours),
        (pictures, fps): (usize, f64),
    ) -> Result<Self, FilmError> {
        let pictures = pictures.max(1) as u32;
        let mut encoder = Encoder::new(file, size.width() as u32, size.height() as u32);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::High);
        encoder.set_filter(Filter::NoFilter);
        let mut table = colours.table().to_vec();
        table.resize(usize::from(STAYS) + 1, [0; 3]);
        encoder.set_palette(table.into_flattened());
        let mut opacity = vec![255; usize::from(STAYS)];
        opacity.push(0);
        encoder.set_trns(opacity);
        let [keyword, program] = SOFTWARE.map(str::to_owned);
        encoder.add_text_chunk(keyword, program)?;
        encoder.set_animated(pictures, 0)?;
        Ok(Self {
            writer: encoder.write_header()?,
            size,
            colours,
            shown: Vec::new(),
            left: pictures,
            delay: 1.0 / fps,
        })
    }

    /// Writes the next picture.
    pub(crate) fn add(&mut self, picture: &Picture) -> Result<(), FilmError> {
        let patch = match self.shown.is_empty() {
            true => self.whole(picture),
            false => self.difference(picture)?,
        };
        self.left = self.left.saturating_sub(1);
        let delay = if self.left == 0 {
            self.delay.max(LAST)
        } else {
            self.delay
        };
        let delay = (delay * f64::from(PARTS))
            .round()
            .clamp(1.0, f64::from(u16::MAX));
        let writer = &mut self.writer;
        writer.set_frame_delay(delay as u16, PARTS)?;
        writer.set_dispose_op(DisposeOp::None)?;
        writer.set_blend_op(patch.blend)?;
        writer.set_frame_position(0, 0)?;
        writer.set_frame_dimension(patch.size[0], patch.size[1])?;
        writer.set_frame_position(patch.at[0], patch.at[1])?;
        writer.write_image_data(&patch.numbers)?;
        Ok(())
    }

    /// Writes the end of the file.
    pub(crate) fn finish(self) -> Result<(), FilmError> {
        Ok(self.writer.finish()?)
    }

    fn whole(&mut self, picture: &Picture) -> Patch {
        let width = self.size.width();
        let pixels = picture.pixels().iter().enumerate();
        let numbers = pixels
            .map(|(place, pixel)| self.colours.number(*pixel, (place % width, place / width)));
        self.shown = numbers.collect();
        Patch {
            at: [0, 0],
            size: [self.size.width() as u32, self.size.height() as u32],
            numbers: self.shown.clone(),
            blend: BlendOp::Source,
        }
    }

    /// The smallest rectangle with all differences from the picture that is shown. Pixels that do not change are written
    /// as [`STAYS`] or with their colours, whichever gives fewer bytes.
    fn difference(&mut self, picture: &Picture) -> Result<Patch, FilmError> {
        let width = self.size.width();
        let table = self.colours.table();
        let mut changes = vec![STAYS; self.shown.len()];
        let [mut left, mut right, mut top, mut bottom] = [width, 0, self.size.height(), 0];
        for (place, (shown, pixel)) in self.shown.iter_mut().zip(picture.pixels()).enumerate() {
            let now = table[usize::from(*shown)];
            if now.iter().zip(pixel).all(|(a, b)| a.abs_diff(*b) <= SAME) {
                continue;
            }
            let (column, row) = (place % width, place / width);
            let number = self.colours.number(*pixel, (column, row));
            if number == *shown {
                continue;
            }
            (*shown, changes[place]) = (number, number);
            (left, right) = (left.min(column), right.max(column + 1));
            (top, bottom) = (top.min(row), bottom.max(row + 1));
        }
        if right == 0 {
            // A picture needs one pixel at least.
            (left, right, top, bottom) = (0, 1, 0, 1);
        }
        let part = |all: &[u8]| -> Vec<u8> {
            let rows = all.chunks(width).skip(top).take(bottom - top);
            rows.flat_map(|row| &row[left..right]).copied().collect()
        };
        let size = [(right - left) as u32, (bottom - top) as u32];
        let [over, anew] = [part(&changes), part(&self.shown)];
        let (of_over, of_anew) = rayon::join(|| deflated(&over, size), || deflated(&anew, size));
        let (numbers, blend) = match of_over? <= of_anew? {
            true => (over, BlendOp::Over),
            false => (anew, BlendOp::Source),
        };
        Ok(Patch {
            at: [left as u32, top as u32],
            size,
            numbers,
            blend,
        })
    }
}

/// Number of bytes of a separate picture with these numbers.
fn deflated(numbers: &[u8], [width, height]: [u32; 2]) -> Result<usize, FilmError> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(numbers)?;
    writer.finish()?;
    Ok(file.len())
}

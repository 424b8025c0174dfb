//! Pictures as rows of pixels.

use crate::Size;

/// A picture: rows from top to bottom, pixels from left to right, red, green and blue of each in sRGB.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    size: Size,
    pub(crate) pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// A picture of one colour.
    #[must_use]
    pub fn new(size: Size, colour: [u8; 3]) -> Self {
        let pixels = vec![colour; size.width() * size.height()];
        Self { size, pixels }
    }

    /// Its width and height.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
    }

    /// Its pixels, row by row.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// The colour at a column and a row; `None` outside the picture.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> Option<[u8; 3]> {
        let is_inside = x < self.size.width();
        let place = (y * self.size.width()) + x;
        self.pixels.get(place).copied().filter(|_| is_inside)
    }

    /// Lays a colour over the share `cover` of a pixel. It has no effect outside the picture.
    pub(crate) fn lay(&mut self, (x, y): (i64, i64), colour: [u8; 3], cover: f32) {
        let (width, height) = (self.size.width() as i64, self.size.height() as i64);
        if x < 0 || y < 0 || x >= width || y >= height || cover <= 0.0 {
            return;
        }
        let pixel = &mut self.pixels[(y * width + x) as usize];
        for (below, above) in pixel.iter_mut().zip(colour) {
            let (under, over) = (f32::from(*below), f32::from(above));
            *below = (under + cover.min(1.0) * (over - under)).round() as u8;
        }
    }
}

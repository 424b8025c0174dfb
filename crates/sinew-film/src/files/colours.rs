//! The colours of a film, limited in number.

use rayon::prelude::*;

use crate::Picture;
use crate::render::BACKGROUND;

/// Number of bits of a component that distinguish colours.
const BITS: u32 = 6;

/// The largest number of colours: one number of 256 is for pixels that do not change.
const MOST: usize = 255;

/// Rounds in which each colour moves to the mean of the samples nearest to it.
const ROUNDS: usize = 5;

/// Steps by which colours are made brighter or darker before they are rounded: B. Bayer's matrix of 1973.
const THRESHOLDS: [[i8; 4]; 4] = [
    [-4, 1, -3, 2],
    [3, -2, 4, -1],
    [-3, 2, -4, 1],
    [4, -1, 3, -2],
];

/// Largest difference between the components of a grey colour: the floor and its shadows, and steel.
const GREY: u8 = 24;

/// Colours, and the nearest of them to any other.
pub(crate) struct Colours {
    table: Vec<[u8; 3]>,
    nearest: Vec<u8>,
}

/// A colour that occurs.
#[derive(Debug, Clone, Copy)]
struct Sample {
    colour: [f32; 3],
    weight: f32,
}

impl Colours {
    /// Colours for pictures similar to these. Boxes of colours are halved along the component in which they differ most
    /// (P. Heckbert's median cut of 1982, with the mean instead of the median). Lloyd's rounds follow.
    pub(crate) fn of<'a>(pictures: impl Iterator<Item = &'a Picture>) -> Self {
        let samples = samples(pictures);
        let mut table = halved(samples.clone());
        for _ in 0..ROUNDS {
            table = moved(&table, &samples);
        }
        let mut table: Vec<[u8; 3]> = table
            .into_iter()
            .map(|colour| colour.map(|component| component.round().clamp(0.0, 255.0) as u8))
            .collect();
        // By their brightness, so that neighbours have like numbers, which deflate well.
        table.sort_by_key(|[r, g, b]| {
            (
                3 * u32::from(*r) + 6 * u32::from(*g) + u32::from(*b),
                *r,
                *g,
            )
        });
        table.dedup();
        table.retain(|colour| *colour != BACKGROUND);
        table.insert(0, BACKGROUND);
        table.truncate(MOST);
        let floats: Vec<[f32; 3]> = table.iter().map(|colour| colour.map(f32::from)).collect();
        let bins = (0..1_usize << (3 * BITS)).into_par_iter();
        let nearest = bins
            .map(|bin| nearest(&floats, middle(bin)) as u8)
            .collect();
        Self { table, nearest }
    }

    /// The colours.
    pub(crate) fn table(&self) -> &[[u8; 3]] {
        &self.table
    }

    /// The number of the colour in the table that is nearest to a colour at a column and a row. A grey is first made
    /// somewhat brighter or darker at this position, so that shadows with few colours look smooth from a distance.
    pub(crate) fn number(&self, colour: [u8; 3], (column, row): (usize, usize)) -> u8 {
        if colour == BACKGROUND {
            return 0;
        }
        let least = colour.iter().copied().fold(u8::MAX, u8::min);
        let most = colour.iter().copied().fold(0, u8::max);
        // What moves has colours, and its grain hides steps: dithered it would take a third more bytes.
        let more = match most - least <= GREY {
            true => THRESHOLDS[row % 4][column % 4],
            false => 0,
        };
        self.nearest[bin(colour.map(|component| component.saturating_add_signed(more)))]
    }
}

fn bin(colour: [u8; 3]) -> usize {
    let [r, g, b] = colour.map(|component| usize::from(component >> (8 - BITS)));
    (r << (2 * BITS)) | (g << BITS) | b
}

fn middle(bin: usize) -> [f32; 3] {
    let mask = (1 << BITS) - 1;
    let half = 0.5 * (1 << (8 - BITS)) as f32;
    [2, 1, 0].map(|place| (((bin >> (place * BITS)) & mask) << (8 - BITS)) as f32 + half - 0.5)
}

/// The colours of pictures. A colour that covers a hundred times as much counts ten times as much, so that small
/// objects keep their colours.
fn samples<'a>(pictures: impl Iterator<Item = &'a Picture>) -> Vec<Sample> {
    let mut sums = vec![([0_u64; 3], 0_u64); 1 << (3 * BITS)];
    for pixel in pictures.flat_map(Picture::pixels) {
        let (sum, count) = &mut sums[bin(*pixel)];
        for (sum, component) in sum.iter_mut().zip(pixel) {
            *sum += u64::from(*component);
        }
        *count += 1;
    }
    let found = sums.into_iter().filter(|(_, count)| *count > 0);
    found
        .map(|(sum, count)| Sample {
            colour: sum.map(|sum| sum as f32 / count as f32),
            weight: (count as f32).sqrt(),
        })
        .collect()
}

/// The means of boxes of samples.
fn halved(samples: Vec<Sample>) -> Vec<[f32; 3]> {
    let mut boxes = vec![(spread(&samples), samples)];
    while boxes.len() < MOST - 1 {
        let widest = boxes
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.0.0.total_cmp(&b.1.0.0));
        let Some((place, ((amount, axis, mean), _))) = widest else {
            break;
        };
        if *amount <= 0.0 {
            break;
        }
        let (axis, mean) = (*axis, *mean);
        let (_, all) = boxes.swap_remove(place);
        let (low, high): (Vec<_>, Vec<_>) = all
            .into_iter()
            .partition(|sample| sample.colour[axis] <= mean);
        boxes.extend([low, high].map(|half| (spread(&half), half)));
    }
    boxes
        .iter()
        .filter_map(|(_, samples)| mean(samples))
        .collect()
}

/// The spread of samples, the component in which they differ most, and their mean there.
fn spread(samples: &[Sample]) -> (f32, usize, f32) {
    let weight: f32 = samples.iter().map(|sample| sample.weight).sum();
    let along = [0, 1, 2].map(|axis| {
        let value = |sample: &Sample| sample.colour[axis];
        let mean = samples
            .iter()
            .map(|sample| sample.weight * value(sample))
            .sum::<f32>()
            / weight;
        let squares = samples
            .iter()
            .map(|sample| sample.weight * (value(sample) - mean).powi(2));
        (squares.sum::<f32>(), axis, mean)
    });
    let all = along.iter().map(|along| along.0).sum();
    let widest = along
        .into_iter()
        .fold(along[0], |a, b| if b.0 > a.0 { b } else { a });
    // One colour cannot be halved, whatever rounding says.
    let is_one = samples.len() < 2 || widest.0 <= 1e-3 * weight;
    (if is_one { 0.0 } else { all }, widest.1, widest.2)
}

fn mean(samples: &[Sample]) -> Option<[f32; 3]> {
    let weight: f32 = samples.iter().map(|sample| sample.weight).sum();
    let sum = |axis: usize| {
        samples
            .iter()
            .map(|sample| sample.weight * sample.colour[axis])
            .sum::<f32>()
    };
    (weight > 0.0).then(|| [0, 1, 2].map(|axis| sum(axis) / weight))
}

/// Each colour in the middle of the samples that are nearest to it.
fn moved(table: &[[f32; 3]], samples: &[Sample]) -> Vec<[f32; 3]> {
    let places: Vec<usize> = samples
        .par_iter()
        .map(|sample| nearest(table, sample.colour))
        .collect();
    let mut own = vec![Vec::new(); table.len()];
    for (place, sample) in places.into_iter().zip(samples) {
        own[place].push(*sample);
    }
    own.iter()
        .zip(table)
        .map(|(samples, before)| mean(samples).unwrap_or(*before))
        .collect()
}

/// The index of the colour nearest to a given one. Green counts more and blue less, as for the eye.
fn nearest(table: &[[f32; 3]], colour: [f32; 3]) -> usize {
    let distance = |other: &[f32; 3]| {
        let [r, g, b] = [0, 1, 2].map(|axis| (other[axis] - colour[axis]).powi(2));
        2.0 * r + 4.0 * g + b
    };
    let mut found = (f32::MAX, 0);
    for (place, other) in table.iter().enumerate() {
        let far = distance(other);
        if far < found.0 {
            found = (far, place);
        }
    }
    found.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Size;

    #[test]
    fn pictures_of_few_colours_keep_them() {
        let size = Size::new(64, 64).expect("a size");
        let mut picture = Picture::new(size, BACKGROUND);
        let few = [
            [200, 30, 40],
            [10, 20, 220],
            [90, 90, 90],
            [0, 0, 0],
            [255, 255, 255],
        ];
        for (place, pixel) in picture.pixels.iter_mut().enumerate().skip(1000) {
            *pixel = few[(place * place / 7) % few.len()];
        }
        let colours = Colours::of([&picture].into_iter());
        for colour in few.into_iter().chain([BACKGROUND]) {
            let found = colours.table()[usize::from(colours.number(colour, (1, 2)))];
            assert_eq!(found, colour);
        }
    }

    #[test]
    fn a_smooth_ramp_is_off_by_a_step_or_two() {
        let size = Size::new(256, 64).expect("a size");
        let mut picture = Picture::new(size, BACKGROUND);
        for (place, pixel) in picture.pixels.iter_mut().enumerate() {
            let level = (place % 256) as u8;
            *pixel = [level, level / 2, 255 - level];
        }
        let colours = Colours::of([&picture].into_iter());
        for pixel in picture.pixels() {
            let found = colours.table()[usize::from(colours.number(*pixel, (1, 0)))];
            let off = found.iter().zip(pixel).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(off <= Some(4), "{pixel:?} became {found:?}");
        }
    }
}

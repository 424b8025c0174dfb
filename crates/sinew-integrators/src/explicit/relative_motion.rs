//! The largest motion of a cell relative to a neighbour.

use sinew_core::{Layers, System};

/// Numbers that are compared at a time: whole cells of any number of layers.
const BLOCK: usize = 24;

/// Measures how far cells moved relative to their neighbours since a state.
#[derive(Debug, Default)]
pub(super) struct RelativeMotion {
    /// The motion (m) of each degree of freedom.
    moved: Vec<f64>,
}

impl RelativeMotion {
    /// The largest motion of a cell relative to a neighbour from the displacement `before` (m) to `now` (m), over its
    /// size; 0 if it is `within` that limit, and for a system whose cells have no size.
    pub(super) fn over_size(
        &mut self,
        system: &dyn System,
        [before, now]: [&[f64]; 2],
        within: f64,
    ) -> f64 {
        let (Some(scales), Some(elastic)) = (system.scales(), system.as_elastic()) else {
            return 0.0;
        };
        self.moved.clear();
        self.moved
            .extend(now.iter().zip(before).map(|(now, before)| now - before));
        let search = Search {
            moved: &self.moved,
            sizes: scales.cell_size,
            within,
            neighbours: |cell| elastic.pattern().neighbours(cell),
        };
        match system.layers() {
            Layers::One => search.largest::<1>(),
            Layers::Three => search.largest::<3>(),
        }
    }
}

/// Motions (m) of cells with these sizes (m), and the neighbours of each.
struct Search<'a, N> {
    moved: &'a [f64],
    sizes: &'a [f64],
    within: f64,
    neighbours: N,
}

impl<'a, N: Fn(usize) -> &'a [u32]> Search<'a, N> {
    fn largest<const L: usize>(&self) -> f64 {
        let [least, most] = extremes::<L>(self.moved);
        let diagonal = least
            .iter()
            .zip(&most)
            .map(|(least, most)| (most - least).powi(2));
        let smallest =
            self.sizes.iter().fold(
                f64::INFINITY,
                |least, size| if *size < least { *size } else { least },
            );
        if diagonal.sum::<f64>() <= (self.within * smallest).powi(2) {
            return 0.0;
        }
        let (cells, _) = self.moved.as_chunks::<L>();
        let mut largest = self.within;
        for ((cell, own), own_size) in cells.iter().enumerate().zip(self.sizes) {
            // No neighbour is farther away than the farthest corner of the box around all motions.
            let farthest: f64 = (0..L)
                .map(|layer| {
                    let own = own[layer];
                    (own - least[layer]).max(most[layer] - own).powi(2)
                })
                .sum();
            if farthest <= (self.within * smallest).powi(2) {
                continue;
            }
            let others = (self.neighbours)(cell).iter();
            // Each pair once: neighbours are in increasing order.
            let others = others.rev().map(|other| *other as usize);
            for other in others.take_while(|other| *other > cell) {
                let apart = own
                    .iter()
                    .zip(&cells[other])
                    .map(|(own, other)| own - other);
                let square: f64 = apart.map(|apart| apart * apart).sum();
                let size = match self.sizes[other] < *own_size {
                    true => self.sizes[other],
                    false => *own_size,
                };
                if square > (largest * size).powi(2) {
                    largest = square.sqrt() / size;
                }
            }
        }
        match largest > self.within {
            true => largest,
            false => 0.0,
        }
    }
}

/// The smallest and the largest motion of all cells, layer by layer.
fn extremes<const L: usize>(moved: &[f64]) -> [[f64; L]; 2] {
    let (mut least, mut most) = ([f64::INFINITY; BLOCK], [f64::NEG_INFINITY; BLOCK]);
    for block in moved.chunks(BLOCK) {
        // Comparisons that vectors do, and that pass over what is not a number.
        for ((moved, least), most) in block.iter().zip(&mut least).zip(&mut most) {
            *least = if *moved < *least { *moved } else { *least };
            *most = if *moved > *most { *moved } else { *most };
        }
    }
    let over = |all: &[f64; BLOCK], of: fn(f64, f64) -> f64| {
        std::array::from_fn(|layer| {
            all[layer + L..]
                .iter()
                .step_by(L)
                .fold(all[layer], |found, other| of(found, *other))
        })
    };
    [over(&least, f64::min), over(&most, f64::max)]
}

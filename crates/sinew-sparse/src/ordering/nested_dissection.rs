//! Nested dissection.

use super::graph::{Graph, NONE};
use super::minimum_degree::minimum_degree;
use super::random::Random;
use super::refinement::SEPARATOR;
use super::separator::separate;
use crate::Pattern;

/// Number of cells below which a part is not divided.
const SMALL: usize = 60;

/// The cells of a pattern in an order of elimination: two parts that are not connected by neighbours, then the cells
/// between them, and the same within the parts (George, SIAM J. Numer. Anal. 10, 1973). Small parts are in minimum
/// degree order. The same pattern gives the same order.
#[must_use]
pub fn nested_dissection(pattern: &Pattern) -> Vec<u32> {
    let mut dissection = Dissection {
        pattern,
        random: Random::new(),
        number: vec![NONE; pattern.cells()],
        order: Vec::with_capacity(pattern.cells()),
    };
    dissection.part((0..pattern.cells() as u32).collect());
    dissection.order
}

struct Dissection<'a> {
    pattern: &'a Pattern,
    random: Random,
    number: Vec<u32>,
    order: Vec<u32>,
}

impl Dissection<'_> {
    /// Adds some cells to the order.
    fn part(&mut self, cells: Vec<u32>) {
        if cells.len() > SMALL {
            let graph = Graph::of_cells(self.pattern, &cells, &mut self.number);
            let places = separate(&graph, &mut self.random).places;
            let [first, second, between] = [0, 1, SEPARATOR].map(|place| {
                let members = cells.iter().zip(&places);
                let members = members.filter(|(_, own)| **own == place);
                members.map(|(cell, _)| *cell).collect::<Vec<u32>>()
            });
            if !first.is_empty() && !second.is_empty() {
                drop((cells, graph, places));
                self.part(first);
                self.part(second);
                self.order.extend(between);
                return;
            }
        }
        minimum_degree(self.pattern, &cells, &mut self.number, &mut self.order);
    }
}

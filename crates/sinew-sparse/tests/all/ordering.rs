//! Orders of elimination of any graph.

use proptest::prelude::*;
use sinew_sparse::Pattern;
use sinew_sparse::ordering::{Elimination, nested_dissection};

fn pattern(cells: usize, edges: &[[u32; 2]]) -> Pattern {
    Pattern::from_elements(cells, edges).unwrap()
}

fn star(cells: u32) -> Vec<[u32; 2]> {
    (1..cells).map(|i| [0, i]).collect()
}

fn clique(cells: u32) -> Vec<[u32; 2]> {
    (0..cells)
        .flat_map(|i| (0..i).map(move |j| [j, i]))
        .collect()
}

fn square(side: u32) -> Vec<[u32; 2]> {
    let rows = (0..side).flat_map(|y| (1..side).map(move |x| [y * side + x - 1, y * side + x]));
    let columns =
        (1..side).flat_map(|y| (0..side).map(move |x| [(y - 1) * side + x, y * side + x]));
    rows.chain(columns).collect()
}

fn holds_each_cell_once(order: &[u32], cells: usize) -> bool {
    let mut sorted = order.to_vec();
    sorted.sort_unstable();
    sorted.into_iter().eq(0..cells as u32)
}

/// Number of blocks of the factor, found by eliminating cell after cell from a dense graph.
fn fill_by_hand(cells: usize, edges: &[[u32; 2]], order: &[u32]) -> u64 {
    let mut joined = vec![vec![false; cells]; cells];
    for [a, b] in edges.iter().map(|edge| edge.map(|cell| cell as usize)) {
        joined[a][b] = true;
        joined[b][a] = true;
    }
    let mut left = vec![true; cells];
    let mut blocks = 0;
    for cell in order.iter().map(|cell| *cell as usize) {
        left[cell] = false;
        let later: Vec<usize> = (0..cells)
            .filter(|i| left[*i] && joined[cell][*i])
            .collect();
        blocks += 1 + later.len() as u64;
        for a in &later {
            for b in &later {
                joined[*a][*b] = true;
            }
        }
    }
    blocks
}

/// Graphs, most of them in several pieces and with single cells.
fn graphs() -> impl Strategy<Value = (usize, Vec<[u32; 2]>)> {
    (1usize..300).prop_flat_map(|cells| {
        let ends = (0..cells as u32, 0..cells as u32);
        let edges = prop::collection::vec(ends.prop_map(|(a, b)| [a, b]), 0..3 * cells);
        (Just(cells), edges)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_graph_gets_an_order_with_each_cell_once_and_its_counted_fill((cells, edges) in graphs()) {
        let edges: Vec<[u32; 2]> = edges.into_iter().filter(|[a, b]| a != b).collect();
        let pattern = pattern(cells, &edges);
        let order = nested_dissection(&pattern);
        prop_assert!(holds_each_cell_once(&order, cells));
        let elimination = Elimination::of(&pattern, &order);
        prop_assert!(holds_each_cell_once(&elimination.order, cells));
        let by_hand = fill_by_hand(cells, &edges, &order);
        prop_assert_eq!(elimination.blocks(), by_hand);
        prop_assert_eq!(fill_by_hand(cells, &edges, &elimination.order), by_hand);
        prop_assert_eq!(nested_dissection(&pattern), order);
    }
}

#[test]
fn stars_fill_nothing_and_a_clique_everything() {
    for (cells, edges, fill) in [
        (0, vec![], 0),
        (1, vec![], 1),
        (400, star(400), 799),
        (90, clique(90), 90 * 91 / 2),
    ] {
        let pattern = pattern(cells, &edges);
        let order = nested_dissection(&pattern);
        assert!(holds_each_cell_once(&order, cells));
        let fill_found = Elimination::of(&pattern, &order).blocks();
        assert_eq!(fill_found, fill, "{cells} cells");
    }
}

/// The entries of George's dissection of a grid of n x n nodes, `31/4 n^2 log2 n` (SIAM J. Numer. Anal. 10, 1973).
#[test]
fn a_square_grid_fills_no_more_than_georges_dissection() {
    let side = 64;
    let pattern = pattern(side * side, &square(side as u32));
    let fill = Elimination::of(&pattern, &nested_dissection(&pattern)).blocks();
    let george = 31.0 / 4.0 * (side * side) as f64 * (side as f64).log2();
    assert!((fill as f64) < george, "{fill} {george}");
}

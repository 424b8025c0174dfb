//! The elimination tree, and quantities that follow from it.

use super::graph::NONE;
use crate::Pattern;

/// An order of elimination with its fill-in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Elimination {
    /// The cells in the order in which they are eliminated, each subtree of the elimination tree in one piece.
    pub order: Vec<u32>,
    /// Blocks in each column of the factor, the diagonal included, in that order.
    pub column_blocks: Vec<u32>,
    /// Parent of each column in the elimination tree: the row of its first block below the diagonal; a number beyond
    /// all columns if there is no such block.
    pub(super) parents: Vec<u32>,
}

impl Elimination {
    /// Sorts an order of elimination by subtrees, which changes no fill, and counts the factor's blocks (Liu, SIAM J. Matrix
    /// Anal. Appl. 11, 1990).
    #[must_use]
    pub fn of(pattern: &Pattern, order: &[u32]) -> Self {
        let position = inverse(order);
        let parents = tree(pattern, order, &position);
        let after = postorder(&parents);
        let order: Vec<u32> = after.iter().map(|i| order[*i as usize]).collect();
        let moved = inverse(&after);
        let mut sorted = vec![NONE; order.len()];
        for (parent, new) in parents.iter().zip(&moved) {
            sorted[*new as usize] = moved.get(*parent as usize).copied().unwrap_or(NONE);
        }
        let position = inverse(&order);
        Self {
            column_blocks: column_blocks(pattern, &order, &position, &sorted),
            parents: sorted,
            order,
        }
    }

    /// Blocks of the factor.
    #[must_use]
    pub fn blocks(&self) -> u64 {
        self.column_blocks.iter().map(|n| u64::from(*n)).sum()
    }

    /// Products of blocks of a factorisation, up to a factor that is the same for all orders.
    #[must_use]
    pub fn products(&self) -> u64 {
        self.column_blocks
            .iter()
            .map(|n| u64::from(*n).pow(2))
            .sum()
    }
}

pub(super) fn inverse(order: &[u32]) -> Vec<u32> {
    let mut position = vec![0; order.len()];
    for (cell, place) in order.iter().zip(0..) {
        position[*cell as usize] = place;
    }
    position
}

/// The parent of each column: the row of the first block below its diagonal.
fn tree(pattern: &Pattern, order: &[u32], position: &[u32]) -> Vec<u32> {
    let mut parents = vec![NONE; order.len()];
    let mut ancestors = vec![NONE; order.len()];
    for (cell, row) in order.iter().zip(0..) {
        for other in pattern.neighbours(*cell as usize) {
            let mut column = position[*other as usize];
            while column < row {
                let up = std::mem::replace(&mut ancestors[column as usize], row);
                if up == NONE {
                    parents[column as usize] = row;
                }
                column = up;
            }
        }
    }
    parents
}

/// The columns, children before parents and each subtree in one piece.
fn postorder(parents: &[u32]) -> Vec<u32> {
    let mut first_child = vec![NONE; parents.len()];
    let mut sibling = vec![NONE; parents.len()];
    let mut roots = Vec::new();
    for (parent, column) in parents.iter().zip(0..parents.len() as u32).rev() {
        match first_child.get_mut(*parent as usize) {
            Some(first) => sibling[column as usize] = std::mem::replace(first, column),
            None => roots.push(column),
        }
    }
    let mut order = Vec::with_capacity(parents.len());
    let mut open: Vec<u32> = roots;
    while let Some(column) = open.last().copied() {
        match std::mem::replace(&mut first_child[column as usize], NONE) {
            NONE => {
                order.push(column);
                open.pop();
            }
            child => {
                first_child[column as usize] = sibling[child as usize];
                open.push(child);
            }
        }
    }
    order
}

fn column_blocks(pattern: &Pattern, order: &[u32], position: &[u32], parents: &[u32]) -> Vec<u32> {
    let mut blocks = vec![1; order.len()];
    let mut seen = vec![NONE; order.len()];
    for (cell, row) in order.iter().zip(0..) {
        seen[row as usize] = row;
        for other in pattern.neighbours(*cell as usize) {
            let mut column = position[*other as usize];
            while column < row && seen[column as usize] != row {
                seen[column as usize] = row;
                blocks[column as usize] += 1;
                column = parents[column as usize];
            }
        }
    }
    blocks
}

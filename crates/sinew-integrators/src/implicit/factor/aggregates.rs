//! Groups of neighbouring cells, which a coarse problem moves as one.

use std::collections::VecDeque;

use sinew_core::Pattern;

/// Numbers groups of connected cells, of about `size` each; returns the group of each cell, and the number of groups.
pub(super) fn aggregates(pattern: &Pattern, size: usize) -> (Vec<u32>, usize) {
    const NONE: u32 = u32::MAX;
    let cells = pattern.cells();
    let mut group_of = vec![NONE; cells];
    let (mut groups, mut queue) = (0_u32, VecDeque::new());
    // Groups begin at the rim of earlier ones, so that few cells are left between them.
    let mut rim = VecDeque::new();
    let mut next = 0;
    loop {
        let begin = loop {
            match rim.pop_front() {
                Some(cell) if group_of[cell as usize] == NONE => break Some(cell),
                Some(_) => {}
                None => break None,
            }
        };
        let begin = begin.or_else(|| {
            next += group_of[next..]
                .iter()
                .take_while(|group| **group != NONE)
                .count();
            (next < cells).then_some(next as u32)
        });
        let Some(begin) = begin else {
            return (group_of, groups as usize);
        };
        queue.clear();
        queue.push_back(begin);
        group_of[begin as usize] = groups;
        let mut taken = 1;
        while let Some(cell) = queue.pop_front() {
            for other in pattern.neighbours(cell as usize) {
                if group_of[*other as usize] != NONE {
                    continue;
                }
                if taken < size {
                    group_of[*other as usize] = groups;
                    taken += 1;
                    queue.push_back(*other);
                } else {
                    rim.push_back(*other);
                }
            }
        }
        groups += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_is_in_one_group_of_limited_size() {
        let springs: Vec<[u32; 2]> = (1..1000)
            .filter(|cell| cell % 300 != 0)
            .map(|cell| [cell - 1, cell])
            .collect();
        let pattern = Pattern::from_elements(1000, &springs).unwrap();
        let (group_of, groups) = aggregates(&pattern, 16);
        let mut sizes = vec![0; groups];
        group_of
            .iter()
            .for_each(|group| sizes[*group as usize] += 1);
        assert_eq!(sizes.iter().sum::<usize>(), 1000);
        assert!(
            sizes.iter().all(|size| (1..=16).contains(size)),
            "{sizes:?}"
        );
        assert!(groups < 80, "{groups}");
    }
}

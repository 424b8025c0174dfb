//! Nodes at the same position.

use std::collections::HashMap;

/// For each node, the first one at its position, or the node itself if there is no other: no coordinate differs by more
/// than `rounding` (m). Nodes that are not `wanted` map to themselves.
pub(crate) fn same_places(points: &[[f64; 3]], wanted: &[bool], rounding: f64) -> Vec<u32> {
    let cell = 4.0 * rounding;
    let mut first: Vec<u32> = (0u32..).take(points.len()).collect();
    let mut in_cell: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (node, point) in (0u32..).zip(points) {
        if !wanted[node as usize] {
            continue;
        }
        let at = |shift: f64| point.map(|x| ((x + shift) / cell).floor() as i64);
        let (low, high) = (at(-rounding), at(rounding));
        let mut found = None;
        // One cell but near its sides.
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let known = in_cell.get(&[x, y, z]).into_iter().flatten();
                    let same = known.filter(|other| {
                        let other = points[**other as usize];
                        (0..3).all(|axis| (other[axis] - point[axis]).abs() <= rounding)
                    });
                    found = same.copied().chain(found).min();
                }
            }
        }
        match found {
            Some(other) => first[node as usize] = first[other as usize],
            None => in_cell.entry(at(0.0)).or_default().push(node),
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::same_places;

    #[test]
    fn places_apart_by_rounding_are_one_on_either_side_of_a_cell() {
        let rounding = 1e-9;
        for shift in [0.0, 1e-10, -3e-10, 0.9e-9] {
            for at in [0.0, 4e-9, -0.1, 0.3] {
                let points = [[at; 3], [at + 1.0, at, at], [at + shift, at, at - shift]];
                let first = same_places(&points, &[true; 3], rounding);
                assert_eq!(first, [0, 1, 0], "{shift} {at}");
                let others = same_places(&points, &[false, true, true], rounding);
                assert_eq!(others, [0, 1, 2]);
            }
        }
        let apart = same_places(&[[0.0; 3], [2.1e-9, 0.0, 0.0]], &[true; 2], rounding);
        assert_eq!(apart, [0, 1]);
    }
}

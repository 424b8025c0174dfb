//! Corners of triangles that share a normal.

use super::kind::Kind;
use crate::vector::{V3, cross, dot, sub, unit};

/// Cosine of the largest angle between the normals of triangles whose edge is drawn smooth: 40 degrees.
const ROUND: f32 = 0.766;

/// Corners of triangles. Triangles about a point share one if the surface is smooth between them; sharp edges stay sharp.
#[derive(Debug, Clone, Default)]
pub(crate) struct Corners {
    /// The point of each.
    pub(crate) points: Vec<u32>,
    /// The three of each triangle.
    pub(crate) of_triangles: Vec<[u32; 3]>,
}

impl Corners {
    /// The corners of a surface with these points (m).
    pub(crate) fn of(rest: &[[f64; 3]], triangles: &[[u32; 3]], kinds: &[Kind]) -> Self {
        let normals: Vec<V3> = triangles
            .iter()
            .map(|triangle| normal(rest, *triangle))
            .collect();
        let around = Around::of(rest.len(), triangles);
        let mut corners = Self {
            points: Vec::new(),
            of_triangles: vec![[0; 3]; triangles.len()],
        };
        let mut waiting = Vec::new();
        for point in 0..rest.len() as u32 {
            let fan = around.of_point(point);
            let mut is_taken = vec![false; fan.len()];
            for first in 0..fan.len() {
                if is_taken[first] {
                    continue;
                }
                let corner = corners.points.len() as u32;
                corners.points.push(point);
                is_taken[first] = true;
                waiting.push(first);
                while let Some(place) = waiting.pop() {
                    let triangle = fan[place] as usize;
                    for (own, at) in corners.of_triangles[triangle]
                        .iter_mut()
                        .zip(triangles[triangle])
                    {
                        if at == point {
                            *own = corner;
                        }
                    }
                    for (other, is_taken) in is_taken.iter_mut().enumerate() {
                        let next = fan[other] as usize;
                        let is_smooth = !*is_taken
                            && share_an_edge(triangles[triangle], triangles[next], point)
                            && is_cut(kinds[triangle]) == is_cut(kinds[next])
                            && dot(normals[triangle], normals[next]) >= ROUND;
                        if is_smooth {
                            *is_taken = true;
                            waiting.push(other);
                        }
                    }
                }
            }
        }
        corners
    }
}

fn is_cut(kind: Kind) -> bool {
    kind == Kind::Cut
}

/// The normal of a triangle.
fn normal(rest: &[[f64; 3]], triangle: [u32; 3]) -> V3 {
    let [a, b, c] = triangle.map(|point| rest[point as usize]);
    let from_a = |p: [f64; 3]| [0, 1, 2].map(|axis| (p[axis] - a[axis]) as f32);
    unit(cross(unit(from_a(b)), unit(sub(from_a(c), [0.0; 3]))))
}

/// True if two triangles at a point have another point in common.
fn share_an_edge(a: [u32; 3], b: [u32; 3], point: u32) -> bool {
    a.iter()
        .any(|corner| *corner != point && b.contains(corner))
}

/// The triangles about each point.
struct Around {
    begins: Vec<usize>,
    triangles: Vec<u32>,
}

impl Around {
    fn of(points: usize, triangles: &[[u32; 3]]) -> Self {
        let mut begins = vec![0; points + 1];
        for point in triangles.iter().flatten() {
            begins[*point as usize + 1] += 1;
        }
        for point in 0..points {
            begins[point + 1] += begins[point];
        }
        let mut next = begins.clone();
        let mut around = vec![0; 3 * triangles.len()];
        for (index, triangle) in triangles.iter().enumerate() {
            for point in triangle {
                around[next[*point as usize]] = index as u32;
                next[*point as usize] += 1;
            }
        }
        Self {
            begins,
            triangles: around,
        }
    }

    fn of_point(&self, point: u32) -> &[u32] {
        let point = point as usize;
        &self.triangles[self.begins[point]..self.begins[point + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles with a common edge along x, folded by an angle (degrees).
    fn folded(degrees: f64) -> Corners {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let rest = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.5, -1.0, 0.0],
            [0.5, cos, sin],
        ];
        let kinds = [Kind::Tissue(1); 2];
        Corners::of(&rest, &[[0, 2, 1], [0, 1, 3]], &kinds)
    }

    #[test]
    fn a_gentle_fold_is_round_and_an_edge_is_sharp() {
        assert_eq!(folded(30.0).points, [0, 1, 2, 3]);
        let sharp = folded(90.0);
        assert_eq!(sharp.points, [0, 0, 1, 1, 2, 3]);
        assert_ne!(sharp.of_triangles[0][0], sharp.of_triangles[1][0]);
    }
}

//! A plane section through a body, with the values of a field.

/// A plane across a coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// The axis: 0, 1 or 2.
    pub(crate) axis: usize,
    /// The coordinate (m).
    pub(crate) at: f64,
}

/// Triangles of a section.
#[derive(Debug, Default)]
pub(crate) struct Section {
    /// Places (m) of their corners, three for each.
    pub(crate) places: Vec<[f32; 3]>,
    /// Values at the corners.
    pub(crate) values: Vec<f32>,
}

/// A corner of a section: its place (m), and its value.
type Corner = ([f64; 3], f32);

impl Section {
    /// Cuts tetrahedra, with places (m) and values at their nodes, by a plane.
    pub(crate) fn cut(
        &mut self,
        tets: &[[u32; 4]],
        place: impl Fn(u32) -> [f64; 3],
        values: &[f32],
        plane: Plane,
    ) {
        self.places.clear();
        self.values.clear();
        for nodes in tets {
            let corners: [Corner; 4] = nodes.map(|node| (place(node), values[node as usize]));
            let above = corners.map(|(place, _)| place[plane.axis] >= plane.at);
            let cut = |[low, high]: [usize; 2]| crossing(corners[low], corners[high], plane);
            // The corners above the plane first.
            let mut order = [0, 1, 2, 3];
            order.sort_by_key(|corner| !above[*corner]);
            let [a, b, c, d] = order;
            match above.iter().filter(|is_above| **is_above).count() {
                1 => self.push([b, c, d].map(|other| cut([a, other]))),
                3 => self.push([a, b, c].map(|other| cut([d, other]))),
                2 => {
                    let [ac, ad, bd, bc] = [[a, c], [a, d], [b, d], [b, c]].map(cut);
                    self.push([ac, ad, bd]);
                    self.push([ac, bd, bc]);
                }
                _ => {}
            }
        }
    }

    fn push(&mut self, corners: [Corner; 3]) {
        for (place, value) in corners {
            self.places.push(place.map(|coordinate| coordinate as f32));
            self.values.push(value);
        }
    }
}

/// The point of an edge in a plane that its ends are on both sides of.
fn crossing((from, a): Corner, (to, b): Corner, plane: Plane) -> Corner {
    let share = (plane.at - from[plane.axis]) / (to[plane.axis] - from[plane.axis]);
    let place = std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]));
    // Values that are not known stay so, and a share of 0 is no product of 0 and infinity.
    let value = match (a.is_finite(), b.is_finite()) {
        (true, true) => a + share as f32 * (b - a),
        (false, _) => a,
        _ => b,
    };
    (place, value)
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, cube};

    use super::*;

    /// The area of triangles.
    fn area(section: &Section) -> f64 {
        let triangles = section.places.as_chunks::<3>().0.iter();
        let areas = triangles.map(|corners| {
            let [a, b, c] = corners.map(|corner| corner.map(f64::from));
            let (u, v): ([f64; 3], [f64; 3]) = (
                std::array::from_fn(|axis| b[axis] - a[axis]),
                std::array::from_fn(|axis| c[axis] - a[axis]),
            );
            let normal = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt()
        });
        areas.sum()
    }

    /// A linear field is exact between nodes, and the areas of a cube's sections are known.
    #[test]
    fn sections_of_a_cube_have_its_area_and_the_values_of_a_linear_field() {
        let mesh = cube(3, 0.1, Split::Kuhn).unwrap();
        let field = |[x, y, z]: [f64; 3]| 10.0 * x - 3.0 * y + 7.0 * z;
        let values: Vec<f32> = mesh
            .points
            .iter()
            .map(|point| field(*point) as f32)
            .collect();
        let place = |node: u32| mesh.points[node as usize];
        let mut section = Section::default();
        for axis in 0..3 {
            for at in [0.013, 0.05, 1.0 / 30.0, 0.0999] {
                section.cut(&mesh.tets, place, &values, Plane { axis, at });
                let found = area(&section);
                assert!((found - 0.01).abs() < 1e-7, "{axis} {at}: {found} m2");
                for (corner, value) in section.places.iter().zip(&section.values) {
                    assert!((f64::from(corner[axis]) - at).abs() < 1e-7);
                    let expected = field(corner.map(f64::from));
                    assert!((f64::from(*value) - expected).abs() < 1e-5);
                }
            }
            for at in [-0.01, 0.11] {
                section.cut(&mesh.tets, place, &values, Plane { axis, at });
                assert!(section.places.is_empty() && section.values.is_empty());
            }
        }
    }

    #[test]
    fn what_is_not_known_stays_so() {
        let tet = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut section = Section::default();
        let plane = Plane { axis: 0, at: 0.5 };
        let values = [f32::NEG_INFINITY, 1.0, 2.0, f32::NAN];
        section.cut(&[[0, 1, 2, 3]], |node| tet[node as usize], &values, plane);
        assert_eq!(section.values.len(), 3);
        let count = |holds: fn(&f32) -> bool| section.values.iter().filter(|it| holds(it)).count();
        assert_eq!(count(|value| value.is_nan()), 1);
        assert_eq!(count(|value| *value == f32::NEG_INFINITY), 1);
        assert_eq!(count(|value| *value == 1.5), 1);
    }
}

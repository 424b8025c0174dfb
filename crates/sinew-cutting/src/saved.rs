//! A cut body as bytes, from which it continues with the same bits.

use crate::body::CuttableBody;
use crate::course::Course;
use crate::incidence::Incidence;
use crate::marks::{Mark, Marks, NodeSide};

/// Bytes that are none of this body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("these bytes are not those of this body after cuts")]
pub struct SavedBodyError;

impl CuttableBody {
    /// Serializes the changes that cuts made to the body.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let counts = [self.points.len(), self.first_places.len(), self.tets.len()];
        for count in counts {
            bytes.extend((count as u64).to_le_bytes());
        }
        let Marks {
            normal,
            heading,
            course,
            ..
        } = self.marks;
        bytes.extend([normal, heading].map(|direction| u8::from(direction.is_some())));
        bytes.extend([course.blade.is_some(), course.is_rimmed, course.is_out].map(u8::from));
        let places = self.points.as_flattened().iter();
        bytes.push(u8::from(!self.marks.places.is_empty()));
        let numbers = places
            .chain(normal.as_slice().as_flattened())
            .chain(heading.as_slice().as_flattened())
            .chain(course.blade.as_slice().as_flattened().as_flattened())
            .chain([&course.back])
            .chain(self.marks.places.as_flattened());
        bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
        let corners = self.tets.as_flattened().iter();
        let names = self.origins.iter().chain(corners);
        let names = names.chain(self.neighbours.as_flattened());
        bytes.extend(names.flat_map(|name| name.to_le_bytes()));
        let flags = self.is_kept.iter().chain(&self.is_removed);
        bytes.extend(flags.map(|flag| u8::from(*flag)));
        let sides = self.marks.sides.iter().chain(&self.marks.passed);
        bytes.extend(sides.map(|side| side.to_byte()));
        for tet in 0..self.tets.len() as u32 {
            bytes.extend(self.marks.of(tet).to_bytes());
        }
        bytes
    }

    /// Becomes the body that [`CuttableBody::to_bytes`] was called on, which was made of the same mesh.
    ///
    /// # Errors
    /// [`SavedBodyError`] for other bytes; nothing is changed then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), SavedBodyError> {
        let mut rest = Bytes(bytes);
        let [nodes, first, tets] = [rest.count()?, rest.count()?, rest.count()?];
        let is_mine = (first, tets) == (self.first_places.len(), self.tets.len());
        // Each tetrahedron has four corners: there are never more nodes.
        if !is_mine || nodes < first || nodes > first + 4 * tets {
            return Err(SavedBodyError);
        }
        let [has_normal, has_heading] = [rest.flag()?, rest.flag()?];
        let [has_blade, is_rimmed, is_out] = [rest.flag()?, rest.flag()?, rest.flag()?];
        let has_places = rest.flag()?;
        let points = rest.vectors(nodes)?;
        let normal = rest.vectors(usize::from(has_normal))?.first().copied();
        let heading = rest.vectors(usize::from(has_heading))?.first().copied();
        let blade = rest.vectors(2 * usize::from(has_blade))?;
        let course = Course {
            blade: blade.first_chunk().copied(),
            is_rimmed,
            is_out,
            back: f64::from_le_bytes(rest.take()?),
        };
        let places = rest.vectors(if has_places { nodes } else { 0 })?;
        let origins = rest.names(nodes)?;
        let corners = rest.names(4 * tets)?;
        let neighbours = rest.names(4 * tets)?;
        let is_kept = rest.flags(nodes)?;
        let is_removed = rest.flags(tets)?;
        let spare = self.points.capacity().saturating_sub(nodes);
        let mut marks = Marks::new(nodes, tets, spare);
        for side in marks.sides.iter_mut().chain(&mut marks.passed) {
            let [byte] = rest.take()?;
            *side = NodeSide::from_byte(byte);
        }
        marks.places.extend(places);
        for tet in 0..tets as u32 {
            let mark = Mark::from_bytes(rest.take()?);
            if mark != Mark::default() {
                marks.set(tet, mark);
            }
        }
        (marks.normal, marks.heading, marks.course) = (normal, heading, course);
        let within =
            |names: &[u32], limit: usize| names.iter().all(|name| (*name as usize) < limit);
        let is_neighbour = |name: &u32| *name == crate::body::NONE || (*name as usize) < tets;
        let is_sound = rest.0.is_empty()
            && within(&origins, first)
            && within(&corners, nodes)
            && neighbours.iter().all(is_neighbour)
            && points.as_flattened().iter().all(|place| place.is_finite());
        if !is_sound {
            return Err(SavedBodyError);
        }
        let corners = corners.as_chunks::<4>().0.to_vec();
        let left = (0..).zip(&corners).zip(&is_removed);
        let left = left.filter(|(_, is_removed)| !**is_removed);
        self.incidence = Incidence::of_some(nodes, left.map(|(tet, _)| tet), tets, spare);
        self.points.clear();
        self.points.extend(points);
        self.origins.clear();
        self.origins.extend(origins);
        self.is_kept.clear();
        self.is_kept.extend(is_kept);
        self.held.clear();
        self.copied_from.clear();
        self.copied_from.extend(0..nodes as u32);
        self.room.is_listed.clear();
        self.room.is_listed.resize(nodes, false);
        self.neighbours = neighbours.as_chunks::<4>().0.to_vec();
        (self.tets, self.is_removed, self.marks) = (corners, is_removed, marks);
        Ok(())
    }
}

/// Bytes that are read from their beginning.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], SavedBodyError> {
        let (first, rest) = self.0.split_first_chunk::<N>().ok_or(SavedBodyError)?;
        self.0 = rest;
        Ok(*first)
    }

    fn count(&mut self) -> Result<usize, SavedBodyError> {
        usize::try_from(u64::from_le_bytes(self.take()?)).map_err(|_| SavedBodyError)
    }

    fn flag(&mut self) -> Result<bool, SavedBodyError> {
        Ok(self.take::<1>()? != [0])
    }

    fn flags(&mut self, count: usize) -> Result<Vec<bool>, SavedBodyError> {
        (0..count).map(|_| self.flag()).collect()
    }

    fn names(&mut self, count: usize) -> Result<Vec<u32>, SavedBodyError> {
        let name = |_| Ok(u32::from_le_bytes(self.take()?));
        (0..count).map(name).collect()
    }

    fn vectors(&mut self, count: usize) -> Result<Vec<[f64; 3]>, SavedBodyError> {
        let mut vectors = Vec::new();
        for _ in 0..count {
            let mut vector = [0.0; 3];
            for value in &mut vector {
                *value = f64::from_le_bytes(self.take()?);
            }
            vectors.push(vector);
        }
        Ok(vectors)
    }
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{self, Split};

    use super::*;
    use crate::{Sheet, TetProperties};

    struct Plain;

    impl TetProperties for Plain {
        fn density(&self, _: usize) -> f64 {
            1000.0
        }

        fn frequency(&self, _: usize, _: &[[f64; 3]; 4]) -> f64 {
            0.0
        }
    }

    fn body() -> (CuttableBody, Vec<[f64; 3]>) {
        let mesh = structured::cube(4, 0.1, Split::Kuhn).unwrap();
        let body = CuttableBody::new(&mesh, Box::new(Plain)).unwrap();
        (body, mesh.points)
    }

    fn sheet(from: f64, to: f64) -> Sheet {
        let blade = |z: f64| [[0.041, -0.01, z], [0.055, 0.11, z + 0.003]];
        Sheet::swept(blade(from), blade(to)).unwrap()
    }

    #[test]
    fn a_body_that_was_saved_in_the_middle_of_a_stroke_is_cut_on_as_if_it_had_not() {
        for snap in [0.0, 0.25] {
            let (mut kept, mut places) = body();
            kept.stroke(&sheet(0.12, 0.063), &mut places, snap).unwrap();
            kept.remove(|place| place[0] < 0.03 && place[2] < 0.03, &mut places)
                .unwrap();
            let mut restored = body().0;
            restored.restore(&kept.to_bytes()).unwrap();
            assert_eq!(restored.to_bytes(), kept.to_bytes());
            let mut others = places.clone();
            let lower = sheet(0.063, -0.02);
            let copied = kept
                .stroke(&lower, &mut places, snap)
                .unwrap()
                .copied
                .clone();
            let theirs = restored.stroke(&lower, &mut others, snap).unwrap();
            assert!(!copied.is_empty());
            assert_eq!(theirs.copied, copied);
            assert_eq!(restored.to_bytes(), kept.to_bytes());
            assert_eq!(others, places);
        }
    }

    #[test]
    fn other_bytes_are_refused_and_change_nothing() {
        let (mut cut, mut places) = body();
        cut.stroke(&sheet(0.12, 0.02), &mut places, 0.0).unwrap();
        let bytes = cut.to_bytes();
        let (mut whole, _) = body();
        let before = whole.to_bytes();
        let mut longer = bytes.clone();
        longer.push(0);
        let mut wrong = bytes.clone();
        // A corner beyond all nodes.
        let corner = 30 + 24 * cut.nodes() + (2 + 2) * 24 + 8 + 24 * cut.nodes() + 4 * cut.nodes();
        wrong[corner..corner + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        let mut huge = bytes.clone();
        huge[..8].copy_from_slice(&u64::MAX.to_le_bytes());
        for bytes in [
            &bytes[..bytes.len() - 1],
            &bytes[..9],
            &[],
            &longer,
            &wrong,
            &huge,
        ] {
            assert_eq!(whole.restore(bytes), Err(SavedBodyError));
            assert_eq!(whole.to_bytes(), before);
        }
    }
}

//! A saved cut body, from which another process continues with the same bits.

use crate::body::CuttableBody;
use crate::incidence::Incidence;
use crate::marks::Marks;

/// The changes that cuts made to a body, and its blade's progress.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SavedBody {
    points: Vec<[f64; 3]>,
    origins: Vec<u32>,
    tets: Vec<[u32; 4]>,
    neighbours: Vec<[u32; 4]>,
    is_kept: Vec<bool>,
    is_removed: Vec<bool>,
    marks: Marks,
}

/// The error for the cuts of another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("these are not the cuts of this body")]
pub struct SavedBodyError;

impl CuttableBody {
    /// Saves the changes that cuts made to the body.
    #[must_use]
    pub fn save(&self) -> SavedBody {
        SavedBody {
            points: self.points.clone(),
            origins: self.origins.clone(),
            tets: self.tets.clone(),
            neighbours: self.neighbours.clone(),
            is_kept: self.is_kept.clone(),
            is_removed: self.is_removed.clone(),
            marks: self.marks.clone(),
        }
    }

    /// Restores the body on which [`CuttableBody::save`] was called; that body was made from the same mesh.
    ///
    /// # Errors
    /// [`SavedBodyError`] for another body; this body is then unchanged.
    pub fn restore(&mut self, saved: &SavedBody) -> Result<(), SavedBodyError> {
        let SavedBody {
            points,
            origins,
            tets,
            neighbours,
            is_kept,
            is_removed,
            marks,
        } = saved;
        let (nodes, first) = (points.len(), self.first_places.len());
        let within =
            |names: &[u32], limit: usize| names.iter().all(|name| (*name as usize) < limit);
        let is_neighbour = |name: &u32| *name == crate::body::NONE || (*name as usize) < tets.len();
        let is_sound = tets.len() == self.tets.len()
            && nodes >= first
            && [origins.len(), is_kept.len()] == [nodes; 2]
            && [neighbours.len(), is_removed.len()] == [tets.len(); 2]
            && marks.are_of(nodes, tets.len())
            && within(origins, first)
            && within(tets.as_flattened(), nodes)
            && neighbours.as_flattened().iter().all(is_neighbour)
            && points.as_flattened().iter().all(|place| place.is_finite());
        if !is_sound {
            return Err(SavedBodyError);
        }
        let spare = self.points.capacity().saturating_sub(nodes);
        let left = (0..).zip(tets).zip(is_removed);
        let left = left.filter(|(_, is_removed)| !**is_removed);
        self.incidence = Incidence::of_some(nodes, left.map(|(tet, _)| tet), tets.len(), spare);
        self.points.clone_from(points);
        self.origins.clone_from(origins);
        self.is_kept.clone_from(is_kept);
        self.held.clear();
        self.copied_from.clear();
        self.copied_from.extend(0..nodes as u32);
        self.room.is_listed.clear();
        self.room.is_listed.resize(nodes, false);
        self.neighbours.clone_from(neighbours);
        self.tets.clone_from(tets);
        self.is_removed.clone_from(is_removed);
        self.marks = marks.with_space(spare);
        self.near.forget();
        Ok(())
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
            restored.restore(&kept.save()).unwrap();
            assert_eq!(restored.save(), kept.save());
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
            assert_eq!(restored.save(), kept.save());
            assert_eq!(others, places);
        }
    }

    #[test]
    fn the_cuts_of_another_body_are_refused_and_change_nothing() {
        let (mut cut, mut places) = body();
        cut.stroke(&sheet(0.12, 0.02), &mut places, 0.0).unwrap();
        let sound = cut.save();
        let (mut whole, _) = body();
        let before = whole.save();
        let spoils: [fn(&mut SavedBody); 9] = [
            |saved| saved.tets[0][3] = u32::MAX,
            |saved| saved.neighbours[5][1] = u32::MAX - 1,
            |saved| saved.origins[0] = u32::MAX,
            |saved| saved.points[0][2] = f64::NAN,
            |saved| saved.points.truncate(7),
            |saved| saved.tets.truncate(7),
            |saved| saved.is_removed.truncate(7),
            |saved| saved.marks.sides.truncate(7),
            |saved| saved.marks.places.truncate(1),
        ];
        for spoil in spoils {
            let mut wrong = sound.clone();
            spoil(&mut wrong);
            assert_ne!(wrong, sound);
            assert_eq!(whole.restore(&wrong), Err(SavedBodyError));
            assert_eq!(whole.save(), before);
        }
        whole.restore(&sound).unwrap();
        assert_eq!(whole.save(), sound);
    }
}

//! Corresponding nodes of two bodies of a scene with different cuts.

use sinew_scene::BodyModel;

use crate::protocol::NONE;

/// For each node of a body a node of another one of the same scene that is the same corner of the same tetrahedron,
/// or [`NONE`] if the other has none of its tetrahedra. If only the other is split there, it is one of the copies.
pub(crate) fn twins(own: &BodyModel, other: &BodyModel) -> Vec<u32> {
    let nodes = own.mesh.points.len();
    if own.cut.is_none() && other.cut.is_none() {
        return (0..nodes as u32).collect();
    }
    let places = other.cut.as_ref().map(|from| {
        let mut places = vec![NONE; from.uncut.tets.len()];
        for (place, tet) in (0..).zip(&from.cut.tets) {
            places[*tet as usize] = place;
        }
        places
    });
    let mut found = vec![NONE; nodes];
    for (tet, corners) in own.mesh.tets.iter().enumerate() {
        let uncut = own
            .cut
            .as_ref()
            .map_or(tet, |from| from.cut.tets[tet] as usize);
        let place = places.as_ref().map_or(uncut as u32, |places| places[uncut]);
        let Some(theirs) = other.mesh.tets.get(place as usize) else {
            continue;
        };
        for (node, twin) in corners.iter().zip(theirs) {
            let first = &mut found[*node as usize];
            if *first == NONE {
                *first = *twin;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use sinew_scene::{Scene, SceneSource};
    use sinew_world::{Command, World};

    use super::*;

    const BLOCK: &str = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 3000.0\n\
        poissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[cutting]\n[run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.001\n";

    fn session() -> World {
        World::new(Scene::parse(SceneSource::new("block.toml", BLOCK)).unwrap()).unwrap()
    }

    fn cut_at(x: f64, depth: f64) -> World {
        let mut session = session();
        let blade = |z: f64| [[x, -0.01, z], [x, 0.11, z]];
        let command = Command::Cut {
            from: blade(0.11),
            to: blade(0.1 - depth),
        };
        session.command(command).unwrap();
        session.step().unwrap();
        session
    }

    /// Pairs of nodes with the positions of both at rest.
    fn pairs(own: &World, other: &World) -> Vec<(usize, usize)> {
        let [own, other] = [own, other].map(|session| session.body().model().body().unwrap());
        let twins = twins(own, other);
        let pairs = twins.iter().enumerate().filter(|(_, twin)| **twin != NONE);
        let pairs: Vec<(usize, usize)> = pairs.map(|(node, twin)| (node, *twin as usize)).collect();
        for (node, twin) in &pairs {
            assert_eq!(own.mesh.points[*node], other.mesh.points[*twin]);
        }
        pairs
    }

    #[test]
    fn whole_bodies_have_the_same_nodes_and_a_split_one_all_copies_of_them() {
        let (whole, split) = (session(), cut_at(0.05, 0.05));
        assert_eq!(split.cuts().unwrap().changes, 1);
        let identity: Vec<(usize, usize)> = (0..27).map(|node| (node, node)).collect();
        assert_eq!(pairs(&whole, &whole), identity);
        assert_eq!(pairs(&whole, &split).len(), 27);
        let nodes = split.body().model().body().unwrap().mesh.points.len();
        assert!(nodes > 27);
        assert_eq!(pairs(&split, &whole).len(), nodes);
        // Each node of a body is its own twin.
        assert!(
            pairs(&split, &split)
                .iter()
                .all(|(node, twin)| node == twin)
        );
    }
}

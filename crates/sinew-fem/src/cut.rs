//! A problem on the mesh of a body that was cut.

use sinew_mesh::{CutMesh, TetMesh};

use crate::cells::supported;
use crate::error::Cause;
use crate::{LoadKind, LoadSpec, On, Problem};

impl Problem {
    /// The problem of a body that was cut. `uncut` is the mesh of this problem.
    ///
    /// Copies of nodes that are fixed or moved are fixed or moved. Tractions and pressures follow their triangles. A
    /// force on nodes stays with its nodes, so that a cut does no work; the share of removed nodes is dropped, and a
    /// load without any node left is removed.
    ///
    /// # Errors
    /// [`Cause`] if a part of the mesh does not exist.
    pub fn after_cuts(&self, uncut: &TetMesh, cut: &CutMesh) -> Result<Self, Cause> {
        let mut problem = self.clone();
        let fixed = problem.fixed.iter_mut().map(|fixed| &mut fixed.on);
        for on in fixed.chain(problem.moves.iter_mut().map(|moving| &mut moving.on)) {
            *on = On::Nodes(cut.with_copies(uncut, &on.nodes(uncut)?));
        }
        problem.fixed.retain(|fixed| !is_nothing(&fixed.on));
        problem.moves.retain(|moving| !is_nothing(&moving.on));
        for load in &mut problem.loads {
            let on = load.on_after_cuts(uncut, cut)?;
            if let (LoadKind::Force(force), On::Nodes(left)) = (&mut load.kind, &on) {
                let all = load.on.nodes(uncut)?;
                if left.len() < all.len() {
                    let bears = self.bears_forces(uncut)?;
                    let count = |nodes: &[u32]| {
                        let of_node = nodes.iter().map(|node| bears[*node as usize]);
                        of_node.filter(|bears| *bears).count()
                    };
                    let origins = left.iter().map(|node| cut.origins[*node as usize]);
                    let (left, all) = (count(&origins.collect::<Vec<_>>()), count(&all));
                    if left < all {
                        let share = left as f64 / all as f64;
                        *force = force.map(|along| share * along);
                    }
                }
            }
            load.on = on;
        }
        problem.loads.retain(|load| !is_nothing(&load.on));
        Ok(problem)
    }

    /// True for each node of the uncut mesh that bears a share of a force: it is not fixed in all three directions.
    fn bears_forces(&self, uncut: &TetMesh) -> Result<Vec<bool>, Cause> {
        let held = supported(uncut, &self.fixed).map_err(|error| error.cause().clone())?;
        let mut bears: Vec<bool> = held.iter().map(|held| *held != [true; 3]).collect();
        for moving in &self.moves {
            for node in moving.on.nodes(uncut)? {
                bears[node as usize] = true;
            }
        }
        Ok(bears)
    }

    /// The places of the loads that [`Problem::after_cuts`] leaves.
    ///
    /// # Errors
    /// Same as [`Problem::after_cuts`].
    pub fn loads_after_cuts(&self, uncut: &TetMesh, cut: &CutMesh) -> Result<Vec<usize>, Cause> {
        let mut left = Vec::new();
        for (place, load) in self.loads.iter().enumerate() {
            if !is_nothing(&load.on_after_cuts(uncut, cut)?) {
                left.push(place);
            }
        }
        Ok(left)
    }
}

impl LoadSpec {
    /// The nodes or triangles that the load is on after cuts.
    fn on_after_cuts(&self, uncut: &TetMesh, cut: &CutMesh) -> Result<On, Cause> {
        Ok(match self.kind {
            LoadKind::Force(_) => On::Nodes(cut.without_copies(uncut, &self.on.nodes(uncut)?)),
            LoadKind::Traction(_) | LoadKind::Pressure(_) | LoadKind::FollowingPressure(_) => {
                On::Triangles(cut.triangles(uncut, &self.on.triangles(uncut)?))
            }
        })
    }
}

fn is_nothing(on: &On) -> bool {
    match on {
        On::Group(_) => false,
        On::Nodes(nodes) => nodes.is_empty(),
        On::Triangles(triangles) => triangles.is_empty(),
    }
}

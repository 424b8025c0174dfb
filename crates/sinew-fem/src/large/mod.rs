//! Regions of hyperelastic tetrahedra: their forces, energy and tangent at any displacement.

mod error;
mod force;
mod gather;
mod matrix;
mod node_blocks;
mod product;
mod region;
mod rest;
mod scratch;
mod stress;

pub(crate) use region::HyperelasticRegion;
pub(crate) use scratch::Scratch;

use std::sync::{Mutex, PoisonError};

use sinew_core::{BlockMatrix, Deformed, EvaluationError, TangentKind};
use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::hyperelastic::Hyperelastic;
use crate::smoothing::Smoothing;
use gather::Gather;

/// Marks a tetrahedron that is in no hyperelastic region.
const NO_PLACE: u32 = u32::MAX;

/// All hyperelastic regions of a body.
#[derive(Debug)]
pub(crate) struct LargeDeformation {
    regions: Vec<HyperelasticRegion>,
    gather: Gather,
    nodes: usize,
    tets: usize,
    /// Place of each tetrahedron of the mesh among those of the regions.
    place_of_tet: Vec<u32>,
    /// Room for evaluations, one for each that goes on at the same time.
    pool: Mutex<Vec<Scratch>>,
}

impl LargeDeformation {
    /// The regions with laws and shares of edges, each with its tetrahedra; `None` where there are none.
    pub(crate) fn new<'a>(
        mesh: &TetMesh,
        smoothing: &Smoothing,
        regions: impl Iterator<Item = ((Hyperelastic, f64), &'a [u32])>,
    ) -> Option<Self> {
        let (mut made, mut tets) = (Vec::new(), 0);
        let mut place_of_tet = vec![NO_PLACE; mesh.tets.len()];
        for (law, members) in regions {
            for (place, tet) in (tets as u32..).zip(members) {
                place_of_tet[*tet as usize] = place;
            }
            made.push(HyperelasticRegion::new(mesh, smoothing, law, members, tets));
            tets += members.len();
        }
        if made.is_empty() {
            return None;
        }
        let nodes = made.iter().flat_map(|region| {
            let rest = &region.rest;
            (0..rest.count()).map(|tet| rest.nodes(tet))
        });
        let nodes: Vec<[u32; 4]> = nodes.collect();
        Some(Self {
            gather: Gather::new(mesh.points.len(), nodes.iter().copied()),
            regions: made,
            nodes: mesh.points.len(),
            tets,
            place_of_tet,
            pool: Mutex::default(),
        })
    }

    /// Does something with room that is used again, and with a field over all nodes in it.
    pub(crate) fn with_scratch<T>(&self, with: impl FnOnce(&mut Scratch) -> T) -> T {
        let pool = || self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        let known = pool().pop();
        let mut scratch =
            known.unwrap_or_else(|| Scratch::new(self.nodes, self.tets, &self.regions));
        let result = with(&mut scratch);
        pool().push(scratch);
        result
    }

    /// Computes the internal forces (N) at the corners for the displacement in the scratch, and what is found on the way;
    /// without the energy unless it is asked for.
    pub(crate) fn evaluate(
        &self,
        scratch: &mut Scratch,
        with_energy: bool,
    ) -> Result<Deformed, EvaluationError> {
        let mut found = Deformed::default();
        for region in &self.regions {
            if with_energy {
                force::evaluate::<true>(region, scratch, &mut found)?;
            } else {
                force::evaluate::<false>(region, scratch, &mut found)?;
            }
        }
        Ok(found)
    }

    /// Computes the tangent at the displacement in the scratch times the change in it, as forces (N) at the corners.
    pub(crate) fn product(
        &self,
        scratch: &mut Scratch,
        kind: TangentKind,
    ) -> Result<(), EvaluationError> {
        let mut regions = self.regions.iter();
        regions.try_for_each(|region| product::product(region, scratch, Some(kind)))
    }

    /// [`LargeDeformation::product`] with the tangent that stiffness damping multiplies: the exact one, so that the rate of a stress is damped,
    /// but with rotations held fast where a law has one, which is semidefinite.
    pub(crate) fn damped_product(&self, scratch: &mut Scratch) -> Result<(), EvaluationError> {
        let mut regions = self.regions.iter();
        regions.try_for_each(|region| product::product(region, scratch, None))
    }

    /// Sums what was computed at the corners: calls `add` with each node and its force (N).
    pub(crate) fn sum(&self, scratch: &Scratch, add: impl FnMut(u32, [f64; 3])) {
        self.gather.sum(&scratch.corners, add);
    }

    /// Adds the tangent at the displacement in the scratch.
    pub(crate) fn add_tangent(
        &self,
        scratch: &mut Scratch,
        kind: TangentKind,
        cells: &Cells,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        let mut regions = self.regions.iter();
        regions.try_for_each(|region| matrix::add(region, scratch, kind, cells, out))
    }

    /// Adds own blocks of the tangent at the displacement in the scratch: calls `add` with each node and its block (N/m).
    pub(crate) fn node_blocks(
        &self,
        scratch: &mut Scratch,
        mut add: impl FnMut(u32, [[f64; 3]; 3]),
    ) -> Result<(), EvaluationError> {
        let mut regions = self.regions.iter();
        regions.try_for_each(|region| node_blocks::add(region, scratch, &mut add))
    }

    /// The Cauchy stress (Pa) of a tetrahedron of the mesh, in the order of [`crate::stress`], with the displacement (m) of each node; `None`
    /// where it is in no hyperelastic region, not a number where its law has no meaning.
    pub(crate) fn stress(
        &self,
        tet: usize,
        displacement: impl Fn(u32) -> [f64; 3],
    ) -> Option<[f64; 6]> {
        let place = *self.place_of_tet.get(tet)?;
        let place = (place != NO_PLACE).then_some(place as usize)?;
        let region = self
            .regions
            .iter()
            .rev()
            .find(|region| region.first <= place)?;
        Some(stress::cauchy(region, place - region.first, displacement))
    }
}

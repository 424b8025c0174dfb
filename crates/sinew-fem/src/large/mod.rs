//! Regions of hyperelastic tetrahedra: their forces, energy and tangent at any displacement.

mod axes;
mod beside;
mod chunks;
mod compiled;
mod defined;
mod error;
mod evaluator;
mod fibres;
mod force;
mod found;
mod gather;
mod kept;
mod last_evaluation;
mod matrix;
mod means;
mod memory;
mod node_blocks;
mod product;
mod region;
mod regions;
mod rest;
mod rooms;
mod schedule;
mod scratch;
mod stiffness;
mod stress;
mod threads;
mod wanted;
mod waves;
mod when;

pub(crate) use compiled::{Compiled, Own, Precision};
pub(crate) use evaluator::Asked;
pub(crate) use memory::Past;
pub(crate) use region::{HyperelasticRegion, RegionLaw};
pub(crate) use scratch::{Scratch, fill};
pub(crate) use threads::SharedForces;
pub(crate) use wanted::Wanted;

use std::sync::{Arc, Mutex, PoisonError};

use sinew_core::{BlockMatrix, Deformed, EvaluationError};
use sinew_mesh::TetMesh;
use sinew_sparse::simd::{InstructionSet, SharedSlice};

use crate::cells::Cells;
use crate::hyperelastic::Tensor;
use crate::smoothing::Smoothing;
use chunks::chunks;
use force::Evaluation;
use gather::Gather;
use matrix::{Sum, Tangents};
use memory::{Relaxing, Remembered};
use node_blocks::Blocks;
use product::Products;
use region::{FirstPlaces, Numbers};
use regions::{Regions, evaluate_alone};
use rest::FirstAlike;
use stress::{Cauchy, SharedStress};
use waves::Waves;

/// Marks a tetrahedron that is in no hyperelastic region.
const NO_PLACE: u32 = u32::MAX;

/// All hyperelastic regions of a body.
#[derive(Debug)]
pub(crate) struct LargeDeformation {
    all: Arc<Regions>,
    /// Data of each region that force loops read.
    numbers: Vec<Numbers<f64>>,
    nodes: usize,
    /// Number of tetrahedra.
    elements: usize,
    /// Number of internal (history) variables.
    variables: usize,
    /// The instruction set of force loops.
    set: InstructionSet,
    /// Place of each tetrahedron of the mesh among those of the regions.
    place_of_tet: Vec<u32>,
    /// Scratch space for evaluations, one for each that runs at the same time.
    pool: Mutex<Vec<Scratch>>,
}

/// Values that the stresses of several tetrahedra share, for each region.
#[derive(Debug)]
pub(crate) struct SharedStresses(Vec<Option<SharedStress>>);

impl LargeDeformation {
    /// The regions, each with its tetrahedra; `None` without any.
    pub(crate) fn new<'a>(
        mesh: &TetMesh,
        smoothing: &Smoothing,
        regions: impl Iterator<Item = (Arc<dyn Compiled>, RegionLaw<'a>, &'a [u32])>,
    ) -> Option<Self> {
        let (mut made, mut laws, mut count) = (Vec::new(), Vec::new(), 0);
        let mut kept = FirstPlaces::default();
        let mut place_of_tet = vec![NO_PLACE; mesh.tets.len()];
        let mut regions = regions.peekable();
        regions.peek()?;
        let alike = FirstAlike::new(mesh);
        for (law, stated, members) in regions {
            let (slots, chunks) = chunks(members, |tet| smoothing.patch_of(tet as usize));
            for (place, slot) in (count as u32..).zip(&slots) {
                if !slot.is_padding {
                    place_of_tet[slot.tet as usize] = place;
                }
            }
            let places = (count, kept);
            let region = HyperelasticRegion::new(
                (mesh, &alike),
                smoothing,
                stated,
                (&slots, chunks),
                places,
            );
            laws.push(law);
            kept = region.next_places();
            made.push(region);
            count += slots.len();
        }
        let nodes = made.iter().flat_map(|region| {
            let rest = &region.rest;
            (0..rest.count()).map(|tet| rest.is_taken(tet).then(|| rest.nodes(tet)))
        });
        let nodes: Vec<_> = nodes.collect();
        let gather = Gather::new(mesh.points.len(), nodes.iter().copied());
        Some(Self {
            numbers: made.iter().map(HyperelasticRegion::numbers).collect(),
            all: Arc::new(Regions::new((made, laws), gather)),
            nodes: mesh.points.len(),
            elements: nodes.iter().flatten().count(),
            variables: kept.variables,
            set: InstructionSet::best(),
            place_of_tet,
            pool: Mutex::default(),
        })
    }

    /// Calls `with` with scratch space that is reused, which holds a field over all nodes.
    pub(crate) fn with_scratch<T>(&self, with: impl FnOnce(&mut Scratch) -> T) -> T {
        let pool = || self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        let known = pool().pop();
        let mut scratch = known.unwrap_or_else(|| {
            let counts = [self.nodes, self.all.gather.nodes().len()];
            Scratch::new(counts, &self.all.regions, self.all.alone().rooms())
        });
        let result = with(&mut scratch);
        pool().push(scratch);
        result
    }

    /// Computes the internal forces (N) at the corners for the displacement in the scratch, and, if requested, the
    /// energy and the other findings.
    pub(crate) fn evaluate(
        &self,
        scratch: &mut Scratch,
        past: Past<'_>,
        with_energy: bool,
    ) -> Result<Deformed, EvaluationError> {
        let has_memory = self.variables > 0;
        if !has_memory {
            let known = scratch.last.at(&scratch.displacement, with_energy);
            if let Some(found) = known {
                return Ok(found);
            }
        }
        let with_energy = with_energy || scratch.last.expects_energy();
        scratch.last.forget();
        let evaluation = Evaluation {
            past,
            remembered: None,
            regions: &self.all.regions,
            numbers: &self.numbers,
            gather: &self.all.gather,
            rooms: self.all.alone().rooms(),
            places: scratch.places(),
            set: self.set,
            with_energy,
        };
        let found = evaluate_alone(self.all.alone(), &self.all.laws, &evaluation)?;
        if !has_memory {
            let found = (found, with_energy);
            scratch.last.take(&scratch.displacement, found);
        }
        Ok(found)
    }

    /// Number of internal variables.
    pub(crate) fn variables(&self) -> usize {
        self.variables
    }

    /// Updates internal variables to the displacement in the scratch, `dt` (s) after that of their current values.
    pub(crate) fn remember(
        &self,
        scratch: &mut Scratch,
        dt: f64,
        internal: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let internal = SharedSlice::of(internal);
        let evaluation = Evaluation {
            past: Past::RELAXED,
            remembered: Some(Remembered { internal, dt }),
            regions: &self.all.regions,
            numbers: &self.numbers,
            gather: &self.all.gather,
            rooms: self.all.alone().rooms(),
            places: scratch.places(),
            set: self.set,
            with_energy: false,
        };
        evaluate_alone(self.all.alone(), &self.all.laws, &evaluation).map(drop)
    }

    /// The forces in double precision, with a chosen instruction set, in `parts` parts that threads compute at the same
    /// time.
    pub(crate) fn in_double(&self, parts: usize, set: InstructionSet) -> SharedForces<f64> {
        SharedForces::new(Arc::clone(&self.all), self.numbers.clone(), parts, set)
    }

    /// Same as [`LargeDeformation::in_double`], in single precision.
    pub(crate) fn in_single(&self, parts: usize, set: InstructionSet) -> SharedForces<f32> {
        let numbers = self.numbers.iter().map(Numbers::rounded).collect();
        SharedForces::new(Arc::clone(&self.all), numbers, parts, set)
    }

    /// The mesh nodes of the regions, in the order in which their forces are completed.
    pub(crate) fn nodes_in_order(&self) -> &[u32] {
        self.all.gather.nodes()
    }

    /// Number of tetrahedra.
    pub(crate) fn elements(&self) -> usize {
        self.elements
    }

    /// Computes the tangent, or the viscosity, at the displacement in the scratch times the change in it, as forces (N) at the nodes.
    pub(crate) fn product(
        &self,
        scratch: &mut Scratch,
        past: Past<'_>,
        wanted: Wanted,
    ) -> Result<(), EvaluationError> {
        let schedule = self.all.alone();
        let rooms = schedule.rooms();
        scratch.product.reserve(&self.all.regions, rooms);
        scratch.last.forget();
        for piece in schedule.passes().iter().flatten().flatten() {
            let region = &self.all.regions[piece.region];
            let mut products = Products {
                region,
                rooms: &rooms.regions[piece.region],
                corners: &rooms.corners,
                gather: &self.all.gather,
                tasks: &piece.tasks,
                scratch,
                relaxing: wanted.relaxing(region, past),
                wanted,
                set: self.set,
            };
            self.all.laws[piece.region].products(&mut products)?;
        }
        Ok(())
    }

    /// Calls `add` with each node of a region and the force (N) that was computed last.
    pub(crate) fn at_nodes(&self, scratch: &Scratch, mut add: impl FnMut(u32, [f64; 3])) {
        for (node, [x, y, z, _]) in self.all.gather.nodes().iter().zip(&scratch.sums) {
            add(*node, [*x, *y, *z]);
        }
    }

    /// Adds `factor` times the tangent, or the viscosity, at the displacement in the scratch.
    pub(crate) fn add_tangent(
        &self,
        scratch: &mut Scratch,
        past: Past<'_>,
        wanted: Wanted,
        (cells, factor, out): (&Cells, f64, &mut BlockMatrix),
    ) -> Result<(), EvaluationError> {
        let mut sum = Sum::new(cells, factor, out);
        self.with_laws().try_for_each(|(region, law)| {
            let mut tangents = Tangents {
                region,
                scratch,
                relaxing: wanted.relaxing(region, past),
                wanted,
                sum: &mut sum,
            };
            tangents.run(law)
        })
    }

    /// Adds own blocks of the tangent, or of the viscosity, at the displacement in the scratch: calls `add` with each node and its block (N/m).
    pub(crate) fn node_blocks(
        &self,
        scratch: &mut Scratch,
        past: Past<'_>,
        wanted: Wanted,
        mut add: impl FnMut(u32, [[f64; 3]; 3]),
    ) -> Result<(), EvaluationError> {
        self.with_laws().try_for_each(|(region, law)| {
            let mut blocks = Blocks {
                region,
                scratch,
                relaxing: wanted.relaxing(region, past),
                wanted,
                set: self.set,
                add: &mut add,
            };
            law.blocks(&mut blocks)
        })
    }

    /// The square (1/s^2) of the largest frequency of plane waves as short as a tetrahedron, at the displacement in the scratch.
    pub(crate) fn fastest_wave(
        &self,
        scratch: &Scratch,
        past: Past<'_>,
    ) -> Result<f64, EvaluationError> {
        let mut fastest = 0.0;
        for (region, law) in self.with_laws() {
            let mut waves = self.waves(region, (scratch, past), fastest);
            law.waves(&mut waves)?;
            fastest = waves.fastest;
        }
        Ok(fastest)
    }

    /// A search for the fastest wave of a region that is faster than `fastest`.
    fn waves<'a>(
        &self,
        region: &'a HyperelasticRegion,
        (scratch, past): (&'a Scratch, Past<'a>),
        fastest: f64,
    ) -> Waves<'a> {
        Waves {
            region,
            scratch,
            relaxing: Wanted::Stiffest.relaxing(region, past),
            set: self.set,
            fastest,
            tet: None,
        }
    }

    /// True if that frequency changes little while strains do.
    pub(crate) fn stiffens_gently(&self) -> bool {
        let mut regions = self.with_laws();
        regions.all(|(region, law)| law.stiffens_gently() && region.fibres.is_empty())
    }

    /// The tetrahedron with that frequency: its square, the tag, and the gradient of the displacement.
    pub(crate) fn fastest_tet(
        &self,
        scratch: &Scratch,
        past: Past<'_>,
    ) -> Result<Option<(f64, u64, Tensor<f64>)>, EvaluationError> {
        let (mut fastest, mut found) = (0.0, None);
        for (region, law) in self.with_laws() {
            let mut waves = self.waves(region, (scratch, past), fastest);
            waves.with_numbers(law)?;
            fastest = waves.fastest;
            if let Some(tet) = waves.tet {
                let gradient = region.rest.gradient_of(tet, &scratch.displacement);
                found = Some((fastest, region.rest.tag(tet), gradient));
            }
        }
        Ok(found)
    }

    /// The Cauchy stress (Pa) of a tetrahedron of the mesh, in the order of [`crate::stress`], with the displacement
    /// (m) of each node; `None` if it is in no hyperelastic region, NaN if its law is not defined. `shared` is filled
    /// with values that other tetrahedra reuse at the same displacement.
    pub(crate) fn stress(
        &self,
        tet: usize,
        past: Past<'_>,
        displacement: impl Fn(u32) -> [f64; 3],
        shared: Option<&mut SharedStresses>,
    ) -> Option<[f64; 6]> {
        let place = *self.place_of_tet.get(tet)?;
        let place = (place != NO_PLACE).then_some(place as usize)?;
        let regions = self.with_laws().enumerate().rev();
        let mut regions = regions.skip_while(|(_, (region, _))| region.first > place);
        let (number, (region, law)) = regions.next()?;
        let cauchy = Cauchy {
            region,
            tet: place - region.first,
            relaxing: Relaxing::of(region.memory.as_ref(), past),
            displacement: &displacement,
            shared: shared.and_then(|shared| shared.0[number].as_mut()),
        };
        Some(cauchy.run(law))
    }

    /// Buffer for values that the stresses of all tetrahedra share at one displacement.
    pub(crate) fn shared_stresses(&self) -> SharedStresses {
        SharedStresses(self.all.regions.iter().map(SharedStress::of).collect())
    }

    /// The regions with their laws.
    fn with_laws(
        &self,
    ) -> impl DoubleEndedIterator<Item = (&HyperelasticRegion, &dyn Compiled)> + ExactSizeIterator
    {
        let laws = self.all.laws.iter().map(|law| &**law);
        self.all.regions.iter().zip(laws)
    }
}

#[cfg(test)]
mod tests {
    use super::schedule::Schedule;
    use super::*;
    use crate::hyperelastic::Hyperelastic;
    use crate::hyperelastic::fibres::{Fibres, Stiffening};
    use crate::hyperelastic::prony::Term;
    use crate::shares::Shares;
    use crate::{Element, FibreFamily, Law, Memory, Moduli, Problem, Region, Tissue, ViscousPart};
    use sinew_core::TangentKind;
    use sinew_mesh::structured::{Split, cube};
    use sinew_sparse::simd::SharedSlice;

    const ELEMENTS: [Element; 5] = [
        Element::P1,
        Element::Fbar { patch: None },
        Element::Fbar { patch: Some(300) },
        Element::FbarEdge {
            edge_share: 0.9,
            patch: None,
        },
        Element::FbarEdge {
            edge_share: 1.0,
            patch: Some(12),
        },
    ];

    /// Tissues without and with fibres and memory.
    fn tissues() -> [Tissue; 5] {
        let exponential = Stiffening::Exponential {
            k1: 1000.0,
            k2: 2.0,
            dispersion: 0.1,
        };
        let fibrous = |stiffening| Tissue {
            fibres: vec![FibreFamily::new(
                Fibres::new(stiffening).unwrap(),
                [1.0, 2.0, -1.0],
            )],
            ..Tissue::default()
        };
        let term = |share, time| Term { share, time };
        let memory = Memory {
            terms: vec![term(0.3, 0.05), term(0.2, 0.5)],
            part: ViscousPart::All,
            moduli: Moduli::Instantaneous,
        };
        [
            Tissue::default(),
            fibrous(Stiffening::Quadratic { eta: 2000.0 }),
            fibrous(exponential),
            Tissue {
                fibres: [[1.0, 2.0, -1.0], [0.0, 1.0, 3.0], [1.0, 0.0, 0.0]]
                    .map(|along| FibreFamily::new(Fibres::new(exponential).unwrap(), along))
                    .into(),
                ..Tissue::default()
            },
            Tissue {
                memory: Some(memory),
                ..Tissue::default()
            },
        ]
    }

    fn region(
        mesh: &TetMesh,
        id: &'static str,
        element: Element,
        tissue: &Tissue,
        is_uneven: bool,
    ) -> LargeDeformation {
        let parameters = Hyperelastic::parameters(id, 3500.0, 0.45).unwrap();
        let law = Hyperelastic::new(id, &parameters).unwrap();
        let problem = Problem::of([Region::new(Law::hyperelastic(id, parameters), 1060.0)
            .with_element(element)
            .with_tissue(tissue.clone())]);
        let smoothing = Smoothing::new(mesh, &problem.elements(), &vec![0; mesh.tets.len()]);
        let tets: Vec<u32> = (0..mesh.tets.len() as u32).collect();
        let uneven = || (0..mesh.tets.len()).map(|tet| (tet as f64 * 1.7).sin());
        let shares: Vec<f64> = uneven().map(|x| 0.6 + 0.4 * x).collect();
        let shares = match is_uneven {
            true => Shares::new(shares.into(), 0..mesh.tets.len()),
            false => Shares::default(),
        };
        let directions: Vec<[f64; 3]> = uneven().map(|x| [x.cos(), 0.0, x.sin()]).collect();
        let region = RegionLaw {
            mu: law.lame().1,
            density: 1060.0,
            edge_share: element.edge_share(),
            tissue,
            shares: &shares,
            directions: &vec![is_uneven.then(|| directions.into()); tissue.fibres.len()],
            axes: None,
        };
        let regions = std::iter::once((law.compiled(), region, tets.as_slice()));
        LargeDeformation::new(mesh, &smoothing, regions).unwrap()
    }

    /// Findings, and the forces at the nodes.
    fn evaluated(
        large: &LargeDeformation,
        field: impl Fn(u32) -> [f64; 3],
    ) -> Result<(Deformed, Vec<[f64; 3]>), EvaluationError> {
        let mut internal: Vec<f64> = (0..large.variables())
            .map(|i| 100.0 * (0.37 * i as f64).sin())
            .collect();
        large.with_scratch(|scratch| {
            fill(&mut scratch.displacement, field);
            scratch.last.forget();
            large.remember(scratch, 0.02, &mut internal)?;
            let past = Past {
                internal: &internal,
                dt: 0.01,
            };
            let found = large.evaluate(scratch, past, true)?;
            let mut forces = vec![[0.0; 3]; large.nodes];
            large.at_nodes(scratch, |node, force| forces[node as usize] = force);
            Ok((found, forces))
        })
    }

    /// Displacement of a node: bent, with strains of some 30 %, and if `is_pushed`, one corner pushed through the body.
    fn displacement(mesh: &TetMesh, is_pushed: bool, node: u32) -> [f64; 3] {
        if is_pushed && node == 0 {
            return [0.12; 3];
        }
        let [x, y, z] = mesh.points[node as usize];
        [
            0.01 * (25.0 * z).sin() - 0.2 * x + 2.0 * y * z,
            0.005 * (31.0 * x + 8.0 * y).cos() - 0.3 * z,
            -0.25 * z + 0.15 * y + 3.0 * x * x + 5.0 * x * y * z,
        ]
    }

    /// Forces, products and energies in any order have the bits of first evaluations.
    #[test]
    fn evaluations_after_others_have_the_bits_of_first_ones() {
        let mesh = cube(3, 0.1, Split::Kuhn).unwrap();
        let element = ELEMENTS[ELEMENTS.len() - 1];
        let large = region(&mesh, "neo-hookean", element, &Tissue::default(), false);
        let forces = |scratch: &Scratch| {
            let mut forces = vec![[0.0; 3]; large.nodes];
            large.at_nodes(scratch, |node, force| forces[node as usize] = force);
            forces
        };
        let scaled = |factor: f64| {
            let mesh = &mesh;
            move |node| displacement(mesh, false, node).map(|u| factor * u)
        };
        let [first, other] = [1.0, 0.7].map(|factor| evaluated(&large, scaled(factor)).unwrap());
        large.with_scratch(|scratch| {
            scratch.last.forget();
            for (factor, (found, expected)) in [(1.0, &first), (0.7, &other), (1.0, &first)] {
                fill(&mut scratch.displacement, scaled(factor));
                for with_energy in [false, true, false, true] {
                    let now = large.evaluate(scratch, Past::RELAXED, with_energy).unwrap();
                    assert_eq!(&forces(scratch), expected, "{factor}, {with_energy}");
                    if with_energy {
                        assert_eq!(&now, found);
                    }
                }
                fill(&mut scratch.change, scaled(0.1));
                let wanted = Wanted::Kind(TangentKind::Exact);
                large.product(scratch, Past::RELAXED, wanted).unwrap();
                assert_ne!(&forces(scratch), expected);
                large.evaluate(scratch, Past::RELAXED, false).unwrap();
                assert_eq!(&forces(scratch), expected, "after a product");
            }
        });
    }

    /// Sizes that leave padding at the end of vectors, chunks and edges.
    #[test]
    fn every_instruction_set_gives_what_plain_numbers_give() {
        for cells in [1, 3, 5] {
            let mesh = cube(cells, 0.1, Split::Kuhn).unwrap();
            let [plain, others @ ..] = tissues();
            let laws = Hyperelastic::IDS.iter().map(|id| (*id, &plain));
            let laws = laws.map(|(id, tissue)| (id, tissue, false));
            let others = [false, true].into_iter().flat_map(|is_uneven| {
                let others = others.iter().chain(is_uneven.then_some(&plain));
                others.map(move |tissue| ("neo-hookean", tissue, is_uneven))
            });
            for ((id, tissue, is_uneven), element) in laws
                .chain(others)
                .flat_map(|of| ELEMENTS.map(|element| (of, element)))
            {
                let mut large = region(&mesh, id, element, tissue, is_uneven);
                for is_pushed in [false, true] {
                    let field = |node| displacement(&mesh, is_pushed, node);
                    large.set = InstructionSet::Portable;
                    let expected = evaluated(&large, field);
                    for set in InstructionSet::available() {
                        large.set = set;
                        let name =
                            format!("{id}, {element}, {cells}, {is_pushed}, {is_uneven}, {set:?}");
                        match (evaluated(&large, field), &expected) {
                            (Ok(found), Ok(expected)) => are_near(&name, &found, expected),
                            (Err(found), Err(expected)) => {
                                assert_eq!(found.element, expected.element, "{name}");
                            }
                            (found, _) => panic!("{name}: {found:?}, not {expected:?}"),
                        }
                    }
                }
            }
        }
    }

    fn are_near(
        name: &str,
        (found, forces): &(Deformed, Vec<[f64; 3]>),
        (expected, expected_forces): &(Deformed, Vec<[f64; 3]>),
    ) {
        let size = expected_forces.as_flattened().iter();
        let size = size.fold(0.0, |size: f64, force| size.max(force.abs()));
        for (found, expected) in forces
            .as_flattened()
            .iter()
            .zip(expected_forces.as_flattened())
        {
            assert!((found - expected).abs() < 1e-11 * size, "{name}");
        }
        assert!(
            (found.energy / expected.energy - 1.0).abs() < 1e-11,
            "{name}"
        );
        let ratio = expected.smallest_volume_ratio;
        assert!(
            (found.smallest_volume_ratio - ratio).abs() < 1e-12,
            "{name}"
        );
        let facts = |found: &Deformed| (found.inverted, found.worst_element);
        assert_eq!(facts(found), facts(expected), "{name}");
    }

    /// The sums at the nodes by the parts of a schedule, in order or backwards in each pass; places that no task has
    /// written are NaN.
    #[allow(
        unsafe_code,
        reason = "the parts of a schedule are done one after the other"
    )]
    fn in_parts(
        large: &LargeDeformation,
        field: &[[f64; 4]],
        parts: usize,
        backwards: bool,
    ) -> Vec<[f64; 4]> {
        let schedule = Schedule::new(&large.all.regions, &large.all.gather, parts);
        let kept = scratch::Kept::filled(&large.all.regions, schedule.rooms(), parts, f64::NAN);
        let mut sums = vec![[f64::NAN; 4]; large.all.gather.nodes().len()];
        let evaluation = Evaluation {
            regions: &large.all.regions,
            numbers: &large.numbers,
            gather: &large.all.gather,
            rooms: schedule.rooms(),
            places: kept.places(field, SharedSlice::of(&mut sums)),
            set: large.set,
            past: Past::RELAXED,
            remembered: None,
            with_energy: false,
        };
        for pass in schedule.passes() {
            assert_eq!(pass.len(), parts);
            let mut order: Vec<usize> = (0..parts).collect();
            if backwards {
                order.reverse();
            }
            for part in order {
                for piece in &pass[part] {
                    // SAFETY: the parts of all passes, one after the other.
                    unsafe { regions::make(&large.all.laws, &evaluation, part, piece) }.unwrap();
                }
            }
        }
        sums
    }

    #[test]
    fn parts_in_any_order_give_the_same_bits() {
        let mesh = cube(7, 0.1, Split::Kuhn).unwrap();
        let tissues = tissues();
        let of = |element: Element| tissues.iter().map(move |tissue| (element, tissue));
        for (element, tissue) in ELEMENTS.into_iter().flat_map(of) {
            let large = region(&mesh, "stable-neo-hookean", element, tissue, true);
            let mut field = vec![[0.0; 4]; mesh.points.len()];
            fill(&mut field, |node| displacement(&mesh, false, node));
            let expected = in_parts(&large, &field, 1, false);
            assert!(
                expected
                    .as_flattened()
                    .iter()
                    .all(|force| force.is_finite())
            );
            for (parts, backwards) in [(2, false), (2, true), (3, true), (7, false), (7, true)] {
                let found = in_parts(&large, &field, parts, backwards);
                assert!(found == expected, "{element}, {parts} parts");
            }
        }
    }
}

//! Random bodies: blocks of tetrahedra that were jittered and renumbered, with one or two materials and random
//! supports.

use proptest::array::uniform3;
use proptest::collection::vec;
use proptest::prelude::*;
use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearSystem, Ramp, State};
use sinew_fem::{
    Fixed, Item, Law, LoadKind, LoadSpec, Model, Problem, Rayleigh, Region, SpringRule,
};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

/// A body with its loads and its initial motion.
#[derive(Clone)]
pub struct Body {
    /// The tetrahedra.
    pub mesh: TetMesh,
    /// Materials, damping, supports and loads.
    pub problem: Problem,
    /// A direction for each node's first displacement and one for its first velocity, components
    /// between -1 and 1.
    pub motion: Vec<[[f64; 3]; 2]>,
}

/// Prints the body without the numbers of its mesh.
impl std::fmt::Debug for Body {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Body")
            .field("nodes", &self.mesh.points.len())
            .field("tets", &self.mesh.tets.len())
            .field("problem", &self.problem)
            .finish_non_exhaustive()
    }
}

impl Body {
    /// The model of the body; bodies made here can be built.
    pub fn model(&self) -> Model {
        Model::build(&self.mesh, &self.problem).unwrap()
    }

    /// The first state: displacements up to `u` and velocities up to `v`, zero in fixed components.
    pub fn state(&self, model: &Model, u: f64, v: f64) -> State {
        let of = |which: usize, size: f64| {
            let nodes = model.nodes().iter().map(|node| *node as usize);
            let values = nodes.flat_map(|node| self.motion[node][which]);
            let held = model.pinned().iter();
            let value = |(value, held): (f64, &bool)| if *held { 0.0 } else { size * value };
            values.zip(held).map(value).collect()
        };
        State::new(of(0, u), of(1, v))
    }

    /// The same body without supports.
    pub fn free(mut self) -> Self {
        self.problem.fixed.clear();
        self
    }

    /// The same body fixed at its bottom and nowhere else, with the loads that still act.
    pub fn on_the_ground(mut self) -> Self {
        self.problem.fixed = vec![Fixed::at("bottom")];
        self.without_what_cannot_be()
    }

    /// The same body without anything that dissipates or supplies energy.
    pub fn conservative(mut self) -> Self {
        self.problem.damping = Rayleigh::default();
        self.problem.loads.clear();
        self.problem.gravity = None;
        self.without_dashpots()
    }

    /// The same body with springs that have no dashpots.
    pub fn without_dashpots(mut self) -> Self {
        for region in &mut self.problem.regions {
            if let Law::Springs { damping_ratio, .. } = &mut region.law {
                *damping_ratio = 0.0;
            }
        }
        self
    }

    /// The same body, with node `order[i]` as node i.
    pub fn renumbered(mut self, order: &[u32]) -> Self {
        self.mesh = renumbered(&self.mesh, order);
        self.motion = picked(&self.motion, order);
        self
    }

    /// Leaves out supports that fix everything and loads on nothing.
    fn without_what_cannot_be(mut self) -> Self {
        while let Err(error) = Model::build(&self.mesh, &self.problem) {
            match error.item() {
                Item::Fixed(_) => drop(self.problem.fixed.pop()),
                Item::Load(load) => drop(self.problem.loads.remove(load)),
                _ => panic!("{error}"),
            }
        }
        self
    }
}

/// 2/omega_max, or the time in which the fastest damping acts if that is shorter (s): the scale
/// of an explicit step.
pub fn fastest_time(model: &Model) -> f64 {
    let spectrum = Spectrum::of(model.operators());
    let damping = spectrum.damping_max + spectrum.mass_damping;
    spectrum.critical_step().min(1.0 / damping)
}

/// Bodies of up to `cells` grid cells along each axis.
pub fn bodies_up_to(cells: usize) -> impl Strategy<Value = Body> {
    let split = prop_oneof![Just(Split::Kuhn), Just(Split::Mirrored)];
    let size = uniform3(0.01..0.04);
    (uniform3(1..=cells), size, split).prop_flat_map(|(cells, spacing, split)| {
        let edges = std::array::from_fn(|axis| cells[axis] as f64 * spacing[axis]);
        let block = structured::block(cells, edges, split).unwrap();
        let meshes = (
            distorted(block.clone(), spacing),
            orders(block.points.len()),
        );
        let motion = vec([direction(), direction()], block.points.len());
        (meshes, problems(&block), motion).prop_map(|((mesh, order), (problem, groups), motion)| {
            let mut mesh = mesh;
            mesh.groups.extend(groups);
            Body {
                mesh,
                problem,
                motion,
            }
            .renumbered(&order)
            .without_what_cannot_be()
        })
    })
}

/// Bodies of up to four grid cells along each axis.
pub fn bodies() -> impl Strategy<Value = Body> {
    bodies_up_to(4)
}

/// All orders of `nodes` nodes.
pub fn orders(nodes: usize) -> impl Strategy<Value = Vec<u32>> {
    Just((0..nodes as u32).collect::<Vec<u32>>()).prop_shuffle()
}

fn direction() -> impl Strategy<Value = [f64; 3]> {
    uniform3(-1.0..1.0)
}

/// The even permutations of four vertices: those that keep the sign of the volume.
const EVEN: [[usize; 4]; 12] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 0, 3, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 0, 1, 3],
    [2, 1, 3, 0],
    [2, 3, 0, 1],
    [3, 0, 2, 1],
    [3, 1, 0, 2],
    [3, 2, 1, 0],
];

/// An even permutation for each of `tets` tetrahedra.
pub fn turns(tets: usize) -> impl Strategy<Value = Vec<usize>> {
    vec(0..EVEN.len(), tets)
}

/// The mesh with the vertices of each tetrahedron permuted.
pub fn turned(mut mesh: TetMesh, turns: &[usize]) -> TetMesh {
    for (tet, turn) in mesh.tets.iter_mut().zip(turns) {
        *tet = EVEN[*turn].map(|vertex| tet[vertex]);
    }
    mesh
}

/// A block whose nodes, including those on the surface, were moved by up to three tenths of the grid's spacing or as
/// far as volumes stay positive, and whose tetrahedra are in another order and permuted.
fn distorted(block: TetMesh, spacing: [f64; 3]) -> impl Strategy<Value = TetMesh> {
    let (nodes, tets) = (block.points.len(), block.tets.len());
    let jitter = (0.0..0.3, vec(direction(), nodes));
    (jitter, orders(tets), turns(tets)).prop_map(
        move |((mut amplitude, directions), order, turns)| {
            let smallest = 0.1 * block.volume(0);
            let mut mesh = block.clone();
            loop {
                for (node, direction) in directions.iter().enumerate() {
                    for axis in 0..3 {
                        mesh.points[node][axis] =
                            block.points[node][axis] + amplitude * spacing[axis] * direction[axis];
                    }
                }
                if mesh
                    .signed_volumes()
                    .iter()
                    .all(|volume| *volume > smallest)
                {
                    break;
                }
                amplitude *= 0.7;
            }
            mesh.tets = picked(&mesh.tets, &order);
            mesh.tet_tags = picked(&mesh.tet_tags, &order);
            turned(mesh, &turns)
        },
    )
}

/// The items at the indices in `order`.
fn picked<T: Clone>(items: &[T], order: &[u32]) -> Vec<T> {
    let item = |place: &u32| items[*place as usize].clone();
    order.iter().map(item).collect()
}

fn renumbered(mesh: &TetMesh, order: &[u32]) -> TetMesh {
    let mut new = vec![0; order.len()];
    for (now, before) in (0..).zip(order) {
        new[*before as usize] = now;
    }
    let now = |node: u32| new[node as usize];
    let members = |members: &GroupMembers| match members {
        GroupMembers::Tets(tets) => GroupMembers::Tets(tets.clone()),
        GroupMembers::Triangles(list) => {
            GroupMembers::Triangles(list.iter().map(|nodes| nodes.map(now)).collect())
        }
        GroupMembers::Lines(list) => {
            GroupMembers::Lines(list.iter().map(|nodes| nodes.map(now)).collect())
        }
        GroupMembers::Nodes(nodes) => {
            GroupMembers::Nodes(nodes.iter().map(|node| now(*node)).collect())
        }
    };
    TetMesh {
        points: picked(&mesh.points, order),
        node_tags: picked(&mesh.node_tags, order),
        tets: mesh.tets.iter().map(|tet| tet.map(now)).collect(),
        groups: mesh
            .groups
            .iter()
            .map(|group| Group {
                members: members(&group.members),
                ..group.clone()
            })
            .collect(),
        ..mesh.clone()
    }
}

/// A modulus [Pa] of soft tissue or of a stiffer material.
fn modulus() -> impl Strategy<Value = f64> {
    (2.0..5.0).prop_map(|power| 10.0_f64.powf(power))
}

fn laws() -> impl Strategy<Value = Law> {
    let linear = (modulus(), -0.5..0.49)
        .prop_map(|(youngs_modulus, poissons_ratio)| Law::linear(youngs_modulus, poissons_ratio));
    let rule = prop_oneof![Just(SpringRule::Lloyd), Just(SpringRule::VanGelder)];
    let dashpots = prop_oneof![Just(0.0), 0.01..1.0];
    let springs = (modulus(), rule, any::<bool>(), dashpots).prop_map(
        |(youngs_modulus, rule, calibrate, damping_ratio)| Law::Springs {
            youngs_modulus,
            rule,
            calibrate,
            damping_ratio,
        },
    );
    prop_oneof![linear, springs]
}

/// One region, or two that share the tetrahedra at random; the groups they need.
fn regions(tets: usize) -> impl Strategy<Value = (Vec<Region>, Vec<Group>)> {
    let region = |group: Option<&str>, density, law| Region {
        group: group.map(Into::into),
        ..Region::new(law, density)
    };
    let one = (500.0..2000.0, laws())
        .prop_map(move |(density, law)| (vec![region(None, density, law)], vec![]));
    let densities = (500.0..2000.0, 500.0..2000.0);
    let two = (densities, laws(), laws(), vec(any::<bool>(), tets)).prop_map(
        move |(densities, first, second, mut is_first)| {
            // No region without tetrahedra.
            (is_first[0], is_first[1]) = (true, false);
            let group = |name: &str, tag, wanted| {
                let mine = (0..).zip(&is_first).filter(|(_, first)| **first == wanted);
                Group {
                    name: name.into(),
                    dim: 3,
                    tag,
                    members: GroupMembers::Tets(mine.map(|(tet, _)| tet).collect()),
                }
            };
            let regions = vec![
                region(Some("first"), densities.0, first),
                region(Some("second"), densities.1, second),
            ];
            let groups = vec![group("first", 11, true), group("second", 12, false)];
            (regions, groups)
        },
    );
    prop_oneof![one, two]
}

/// Supports on faces or on a few nodes, often none; the group of those nodes.
fn supports(nodes: usize) -> impl Strategy<Value = (Vec<Fixed>, Group)> {
    let axes = prop_oneof![
        Just([true; 3]),
        uniform3(any::<bool>()).prop_filter("holds something", |axes| axes.contains(&true)),
    ];
    let some = prop_oneof![Just("pins"), Just("bottom"), Just("top"), Just("sides")];
    let support = (some, axes).prop_map(|(group, axes)| Fixed::at(group).along(axes));
    (vec(support, 0..3), orders(nodes), 1..=nodes.div_ceil(3)).prop_map(
        |(supports, order, count)| {
            let mut members = order[..count].to_vec();
            members.sort_unstable();
            let pins = Group {
                name: "pins".into(),
                dim: 0,
                tag: 21,
                members: GroupMembers::Nodes(members),
            };
            (supports, pins)
        },
    )
}

fn problems(block: &TetMesh) -> impl Strategy<Value = (Problem, Vec<Group>)> + use<> {
    let rate = prop_oneof![Just(0.0), 0.1..100.0];
    let time = prop_oneof![Just(0.0), 1e-5..1e-2];
    let damping = (rate, time).prop_map(|(mass, stiffness)| Rayleigh::new(mass, stiffness));
    let loads = (direction(), direction());
    let parts = (
        regions(block.tets.len()),
        supports(block.points.len()),
        damping,
        loads,
    );
    parts.prop_map(
        |((regions, mut groups), (fixed, pins), damping, (traction, gravity))| {
            groups.push(pins);
            let problem = Problem {
                regions,
                damping,
                fixed,
                moves: Vec::new(),
                loads: vec![
                    LoadSpec::new("top", LoadKind::Traction(traction.map(|part| 100.0 * part)))
                        .with_ramp(Ramp::Sin2 { rise: 0.5 }),
                ],
                gravity: Some(gravity.map(|part| 10.0 * part)),
            };
            (problem, groups)
        },
    )
}

//! The mechanics of the laws: stiffness, stress and springs of tetrahedra.

use std::sync::Arc;

use sinew_core::Hash;
use sinew_mesh::TetMesh;

use crate::by_tet::RegionByTet;
use crate::error::{Cause, FemError, Item};
use crate::frame::{Axes, Frame, UnitVectors};
use crate::graph::Graph;
use crate::hyperelastic::{Hyperelastic, Tensor};
use crate::large::{Compiled, RegionLaw};
use crate::network::Network;
use crate::shares::Shares;
use crate::smoothing::{Average, SmoothedStrain};
use crate::springs::Spring;
use crate::tissue::{FibreFamily, Tissue};
use crate::{Element, Law, Region, SpringRule, springs, stress, tetra};

/// The law of a region ready for computation, calibration included.
#[derive(Clone, Debug)]
pub(crate) struct Material {
    /// The law of the stiffest tetrahedron.
    kind: Kind,
    /// The stiffness of each tetrahedron.
    shares: Shares,
}

#[derive(Clone, Debug)]
enum Kind {
    Continuum {
        /// Lame's constants (Pa).
        lame: (f64, f64),
        element: Element,
    },
    Hyperelastic {
        law: Hyperelastic,
        element: Element,
        tissue: Tissue,
        /// The direction of each family of fibres in each tetrahedron of the mesh; `None` if all have that of
        /// `tissue`.
        directions: Vec<Option<UnitVectors>>,
        /// The axes, if the law has some.
        axes: Option<Axes>,
    },
    Springs {
        youngs_modulus: f64,
        rule: SpringRule,
    },
}

impl Material {
    /// The material of some tetrahedra, of total volume `volume` (m^3), under a law, with their springs if it is a
    /// network. `graph` is that of the mesh.
    pub(crate) fn new(
        region: &Region,
        by_tet: &RegionByTet,
        mesh: &TetMesh,
        graph: &mut Graph<'_>,
        (members, volume): (&[u32], f64),
    ) -> Result<(Self, Option<Network>), FemError> {
        let mut law = region.law.clone();
        let [_, largest] = by_tet.moduli;
        law.scale_stiffness(largest);
        let [law, _] = region.tissue.moduli(&law);
        let shares = by_tet.shares.clone();
        let mut network = None;
        let kind = match law {
            Law::Linear {
                youngs_modulus,
                poissons_ratio,
            } => Kind::Continuum {
                lame: tetra::lame(youngs_modulus, poissons_ratio),
                element: region.element,
            },
            Law::Hyperelastic { id, parameters } => {
                let law = Hyperelastic::new(id, &parameters)
                    .map_err(|error| FemError::new(Item::Mesh, error.into()))?;
                let of_coordinates = || law.has_axes().then(Axes::of_coordinates);
                Kind::Hyperelastic {
                    axes: by_tet.axes.clone().or_else(of_coordinates),
                    law,
                    element: region.element,
                    tissue: region.tissue.clone(),
                    directions: by_tet.directions.clone(),
                }
            }
            Law::Springs {
                youngs_modulus,
                rule,
                calibrate,
                damping_ratio,
            } => {
                let tets = members.iter().map(|tet| {
                    let modulus = youngs_modulus * shares.of(*tet as usize);
                    (&mesh.tets[*tet as usize], modulus)
                });
                let graph = graph.pattern()?;
                let springs = springs::springs_on(graph, &mesh.points, tets, rule)
                    .map_err(|error| FemError::new(Item::Mesh, Cause::Operators(error.into())))?;
                let mut made = Network::new(&mesh.points, springs, volume, damping_ratio);
                let calibration = if calibrate {
                    made.calibrate(youngs_modulus * shares.mean(mesh, members))
                } else {
                    1.0
                };
                network = Some(made);
                Kind::Springs {
                    youngs_modulus: youngs_modulus * calibration,
                    rule,
                }
            }
        };
        Ok((Self { kind, shares }, network))
    }

    /// Its largest stiffness (Pa) against compression, `lambda + 2 mu`, and its least against shear, mu.
    pub(crate) fn compression_and_shear(&self) -> (f64, f64) {
        let (compression, shear) = match &self.kind {
            Kind::Continuum { lame, .. } => p_wave_and_shear(*lame),
            Kind::Hyperelastic { law, tissue, .. } => {
                let (compression, mu) = p_wave_and_shear(law.lame());
                let [shear, largest] = law.shear_moduli();
                let compression = compression + 4.0 / 3.0 * (largest - mu);
                let families = tissue.fibres.iter();
                let along = families.map(|family| modulus_along(family, tissue));
                (compression + along.sum::<f64>(), shear)
            }
            // nu = 1/4 and thus lambda = mu for any springs (Cauchy's relations).
            Kind::Springs { youngs_modulus, .. } => (1.2 * youngs_modulus, 0.4 * youngs_modulus),
        };
        (compression, self.shares.least() * shear)
    }

    /// The element that it is on.
    pub(crate) fn element(&self) -> Element {
        match self.kind {
            Kind::Continuum { element, .. } | Kind::Hyperelastic { element, .. } => element,
            Kind::Springs { .. } => Element::P1,
        }
    }

    /// True if it is of large deformation.
    pub(crate) fn is_hyperelastic(&self) -> bool {
        matches!(self.kind, Kind::Hyperelastic { .. })
    }

    /// Its law and the other constants of force loops, at this density (kg/m^3); `None` unless it is hyperelastic.
    pub(crate) fn hyperelastic(&self, density: f64) -> Option<(Arc<dyn Compiled>, RegionLaw<'_>)> {
        match &self.kind {
            Kind::Hyperelastic {
                law,
                element,
                tissue,
                directions,
                axes,
            } => {
                let stated = RegionLaw {
                    mu: law.lame().1,
                    density,
                    edge_share: element.edge_share(),
                    tissue,
                    shares: &self.shares,
                    directions,
                    axes: axes.as_ref(),
                };
                Some((law.compiled(), stated))
            }
            Kind::Continuum { .. } | Kind::Springs { .. } => None,
        }
    }

    /// Lame's constants (Pa) at small strain, of the stiffest tetrahedron; `None` for a network of springs.
    fn lame(&self) -> Option<(f64, f64)> {
        match &self.kind {
            Kind::Continuum { lame, .. } => Some(*lame),
            Kind::Hyperelastic { law, .. } => Some(law.lame()),
            Kind::Springs { .. } => None,
        }
    }

    /// Lame's constants (Pa) of a single tetrahedron, where a linear law and they are all that its stiffness follows
    /// from.
    pub(crate) fn lame_of_plain(&self, tet: usize) -> Option<[f64; 2]> {
        match self.kind {
            Kind::Continuum {
                lame: (lambda, mu),
                element: Element::P1,
            } => {
                let share = self.shares.of(tet);
                Some([share * lambda, share * mu])
            }
            _ => None,
        }
    }

    /// The stiffness of some of its tetrahedra together over that of the stiffest.
    pub(crate) fn share_of(&self, mesh: &TetMesh, tets: &[u32]) -> f64 {
        self.shares.mean(mesh, tets)
    }

    /// Lame's constants (Pa) that act on the mean strain at an edge of some tetrahedra.
    pub(crate) fn averaged_over_edge(&self, mesh: &TetMesh, tets: &[u32]) -> [f64; 2] {
        let (_, mu) = self.lame().unwrap_or_default();
        let share = self.element().edge_share() * self.share_of(mesh, tets);
        [0.0, share * mu]
    }

    /// Adds to the stiffness of [`Material::averaged_over_edge`] that by which a law with axes differs, of `share` of the
    /// volume.
    pub(crate) fn add_anisotropy_of_edge(
        &self,
        mesh: &TetMesh,
        tets: &[u32],
        (average, share): (&Average, f64),
        matrix: &mut [f64],
    ) {
        if let (
            Kind::Hyperelastic {
                law,
                axes: Some(axes),
                ..
            },
            Some(first),
        ) = (&self.kind, tets.first())
        {
            let share = share * self.element().edge_share() * self.share_of(mesh, tets);
            let law = (law, axes.of(*first as usize));
            add_anisotropy(matrix, (&average.gradients, share * average.volume), law);
        }
    }

    /// Lame's constants (Pa) that act on the mean strain of a patch of some tetrahedra.
    pub(crate) fn averaged_over_patch(&self, mesh: &TetMesh, tets: &[u32]) -> [f64; 2] {
        let (lambda, _) = self.lame().unwrap_or_default();
        let share = if self.element().has_patches() {
            self.share_of(mesh, tets)
        } else {
            0.0
        };
        [share * lambda, 0.0]
    }

    /// Stiffness matrix (N/m) of a single tetrahedron, without terms that act on averages, at small strain: 12 x 12,
    /// row-major and vertex-major; `None` if it is flat.
    pub(crate) fn stiffness(&self, mesh: &TetMesh, tet: usize) -> Option<[f64; 144]> {
        let share = self.shares.of(tet);
        let (points, nodes) = (&mesh.points, &mesh.tets[tet]);
        match &self.kind {
            Kind::Continuum { .. } | Kind::Hyperelastic { .. } => {
                let (lambda, mu) = self.lame().unwrap_or_default();
                let element = self.element();
                let own_lambda = if element.has_patches() {
                    0.0
                } else {
                    share * lambda
                };
                let own_mu = (1.0 - element.edge_share()) * (share * mu);
                let vertices = tetra::vertices(points, *nodes);
                let mut matrix = tetra::stiffness(&vertices, own_lambda, own_mu)?;
                if let Kind::Hyperelastic {
                    law,
                    tissue,
                    directions,
                    axes,
                    ..
                } = &self.kind
                {
                    if let Some(axes) = axes {
                        let gradients = tetra::gradients(&vertices)?;
                        let own = (1.0 - element.edge_share()) * share;
                        let volume = own * tetra::signed_volume(&vertices);
                        let law = (law, axes.of(tet));
                        add_anisotropy(&mut matrix, (&gradients, volume), law);
                    }
                    for (family, directions) in tissue.fibres.iter().zip(directions) {
                        let modulus = modulus_along(family, tissue);
                        let direction = match directions {
                            Some(all) => all[tet],
                            None => family.direction.unit(),
                        };
                        add_fibres(&mut matrix, &vertices, (family, direction), modulus);
                    }
                }
                Some(matrix)
            }
            Kind::Springs {
                youngs_modulus,
                rule,
            } => Some(springs::stiffness(
                points,
                nodes,
                share * youngs_modulus,
                *rule,
            )),
        }
    }

    /// The largest frequency (1/s) at which a tetrahedron with these vertices (m) and this density (kg/m^3) would swing its own mass, at small
    /// strain and without fibres or terms that act on averages; `None` if it is flat.
    pub(crate) fn frequency(
        &self,
        tet: usize,
        vertices: &[[f64; 3]; 4],
        density: f64,
    ) -> Option<f64> {
        let share = self.shares.of(tet);
        match &self.kind {
            Kind::Continuum { .. } | Kind::Hyperelastic { .. } => {
                let (lambda, mu) = self.lame().unwrap_or_default();
                let mu = match &self.kind {
                    Kind::Hyperelastic { law, .. } => law.shear_moduli()[1],
                    _ => mu,
                };
                tetra::largest_frequency(vertices, [share * lambda, share * mu], density)
            }
            Kind::Springs {
                youngs_modulus,
                rule,
            } => springs::largest_frequency(vertices, share * youngs_modulus, *rule, density),
        }
    }

    /// Stress (Pa) at a small strain, in the order of [`crate::stress`]; `None` if the law has none.
    pub(crate) fn stress(&self, strain: &SmoothedStrain) -> Option<[f64; 6]> {
        let SmoothedStrain { shear, dilation } = strain;
        match self.kind {
            Kind::Continuum {
                lame: (lambda, mu), ..
            } => Some(stress::with_dilation(shear, *dilation, lambda, mu)),
            Kind::Hyperelastic { .. } | Kind::Springs { .. } => None,
        }
    }

    /// The springs of some tetrahedra; `None` if the law has none.
    pub(crate) fn springs(
        &self,
        mesh: &TetMesh,
        tets: impl Iterator<Item = usize>,
    ) -> Option<Vec<Spring>> {
        match self.kind {
            Kind::Continuum { .. } | Kind::Hyperelastic { .. } => None,
            Kind::Springs {
                youngs_modulus,
                rule,
            } => {
                let tets = tets.map(|tet| (&mesh.tets[tet], self.shares.of(tet) * youngs_modulus));
                Some(springs::springs_of(&mesh.points, tets, rule))
            }
        }
    }

    /// Adds all that distinguishes it from other materials.
    pub(crate) fn add_to(&self, hash: &mut Hash) {
        hash.add(format!("{:?}", self.kind).as_bytes());
        let mut add = |numbers: &[f64]| numbers.iter().for_each(|x| hash.add(&x.to_le_bytes()));
        add(self.shares.values());
        if let Kind::Hyperelastic {
            directions, axes, ..
        } = &self.kind
        {
            for all in directions.iter().flatten() {
                add(all.as_flattened());
            }
            axes.iter().for_each(|axes| add(axes.values()));
        }
    }
}

/// Stiffness (Pa) that fibres in tension add along themselves.
fn modulus_along(family: &FibreFamily, tissue: &Tissue) -> f64 {
    4.0 * tissue.factor_of_fibres() * family.fibres.modulus_at_rest()
}

/// Adds the stiffness at rest of fibres, as if they were pulled.
fn add_fibres(
    matrix: &mut [f64; 144],
    vertices: &[[f64; 3]; 4],
    (family, direction): (&FibreFamily, [f64; 3]),
    modulus: f64,
) {
    let slope = family.fibres.half_slope_at_rest(direction);
    let gradients = tetra::gradients(vertices).unwrap_or_default();
    let rate: [[f64; 3]; 4] = gradients.map(|gradient| slope.on(gradient));
    let stiffness = modulus * tetra::signed_volume(vertices);
    let rate = rate.as_flattened();
    for (row, of_row) in matrix.chunks_exact_mut(12).zip(rate) {
        for (entry, of_column) in row.iter_mut().zip(rate) {
            *entry += stiffness * of_row * of_column;
        }
    }
}

/// Adds the stiffness at rest, of a volume (m^3) with these gradients (1/m) of the shape functions, by which a law with
/// axes differs from one with its constants (lambda, mu).
fn add_anisotropy(
    matrix: &mut [f64],
    (gradients, volume): (&[[f64; 3]], f64),
    (law, axes): (&Hyperelastic, Frame),
) {
    let (lambda, mu) = law.lame();
    let axes = Tensor(axes);
    let stress = |change: Tensor<f64>| {
        let whole = law
            .tangent(Tensor::zero(), change.in_axes(axes))
            .out_of_axes(axes);
        let isotropic = Tensor::diagonal(lambda * change.trace());
        whole - isotropic.plus(2.0 * mu, change.symmetric())
    };
    let columns = 3 * gradients.len();
    for (b, gradient) in gradients.iter().enumerate() {
        for k in 0..3 {
            let mut moved = [0.0; 3];
            moved[k] = volume;
            let stress = stress(Tensor::outer(moved, *gradient));
            for (a, gradient) in gradients.iter().enumerate() {
                for (i, force) in stress.on(*gradient).into_iter().enumerate() {
                    matrix[(3 * a + i) * columns + 3 * b + k] += force;
                }
            }
        }
    }
}

/// `lambda + 2 mu` and mu (Pa) of Lame's constants.
fn p_wave_and_shear((lambda, mu): (f64, f64)) -> (f64, f64) {
    (lambda + 2.0 * mu, mu)
}

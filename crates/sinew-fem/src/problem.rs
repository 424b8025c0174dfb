//! The problem as a user states it: materials, damping, supports, prescribed motions and loads.

use sinew_core::Ramp;
use sinew_mesh::{TetDataError, TetMesh};

use crate::{Direction, Element, Fixed, FromMesh, Law, Moving, On, Tissue};

/// Materials, damping, supports, prescribed motions and loads of a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// Materials; together they cover every tetrahedron once.
    pub regions: Vec<Region>,
    /// Damping of the whole body, in addition to the dashpots of springs.
    pub damping: Rayleigh,
    /// Supports.
    pub fixed: Vec<Fixed>,
    /// Prescribed motions.
    pub moves: Vec<Moving>,
    /// Loads.
    pub loads: Vec<LoadSpec>,
    /// Acceleration of free fall (m/s^2), acting from t = 0.
    pub gravity: Option<[f64; 3]>,
}

impl Problem {
    /// A free body of these materials, without damping and loads.
    #[must_use]
    pub fn of(regions: impl IntoIterator<Item = Region>) -> Self {
        Self {
            regions: regions.into_iter().collect(),
            ..Self::default()
        }
    }

    /// Adds a support.
    #[must_use]
    pub fn with_fixed(mut self, fixed: Fixed) -> Self {
        self.fixed.push(fixed);
        self
    }

    /// Adds a prescribed motion.
    #[must_use]
    pub fn with_move(mut self, moving: Moving) -> Self {
        self.moves.push(moving);
        self
    }

    /// Adds a load.
    #[must_use]
    pub fn with_load(mut self, load: LoadSpec) -> Self {
        self.loads.push(load);
        self
    }

    /// Sets the damping.
    #[must_use]
    pub fn with_damping(mut self, damping: Rayleigh) -> Self {
        self.damping = damping;
        self
    }

    /// Sets the acceleration of free fall (m/s^2).
    #[must_use]
    pub fn with_gravity(mut self, acceleration: [f64; 3]) -> Self {
        self.gravity = Some(acceleration);
        self
    }

    /// The element of each region.
    pub(crate) fn elements(&self) -> Vec<Element> {
        self.regions.iter().map(|region| region.element).collect()
    }
}

/// A part of the body made of one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// A group of tetrahedra; `None` means the whole mesh.
    pub group: Option<String>,
    /// Mass density (kg/m^3).
    pub density: f64,
    /// Material law.
    pub law: Law,
    /// Element; springs have none but [`Element::P1`].
    pub element: Element,
    /// Additions to an isotropic law: fibres and stress that relaxes.
    pub tissue: Tissue,
    /// Properties that differ from tetrahedron to tetrahedron.
    pub from_mesh: FromMesh,
}

impl Region {
    /// The whole mesh of plain tetrahedra ([`Element::P1`]) of one material: its law and its density (kg/m^3).
    #[must_use]
    pub fn new(law: Law, density: f64) -> Self {
        Self {
            group: None,
            density,
            law,
            element: Element::P1,
            tissue: Tissue::default(),
            from_mesh: FromMesh::default(),
        }
    }

    /// Restricts the region to a group of tetrahedra.
    #[must_use]
    pub fn on(mut self, group: impl Into<String>) -> Self {
        self.group = Some(group.into());
        self
    }

    /// Sets the element.
    #[must_use]
    pub fn with_element(mut self, element: Element) -> Self {
        self.element = element;
        self
    }

    /// Sets the additions to the law.
    #[must_use]
    pub fn with_tissue(mut self, tissue: Tissue) -> Self {
        self.tissue = tissue;
        self
    }

    /// True if any property is taken from the mesh's data.
    #[must_use]
    pub fn takes_data(&self) -> bool {
        !self.from_mesh.is_empty() || self.tissue.takes_data()
    }

    /// The same with the directions that the mesh's data give in a tetrahedron (0-based) in the place of those data.
    ///
    /// # Errors
    /// [`sinew_mesh::TetDataError`] for data that the mesh does not have once.
    pub fn at_tetrahedron(&self, mesh: &TetMesh, tet: usize) -> Result<Self, TetDataError> {
        let mut region = self.clone();
        let tissue = &mut region.tissue;
        let families = tissue.fibres.iter_mut().map(|family| &mut family.direction);
        for direction in families.chain(tissue.axes.iter_mut().flatten()) {
            if let Direction::Data(name) = direction {
                let data = mesh.data(name)?;
                let row = data.rows().nth(tet).unwrap_or_default();
                let [x, y, z] = *row else { continue };
                *direction = Direction::Everywhere([x, y, z]);
            }
        }
        Ok(region)
    }

    /// Sets the properties that come from the mesh's data.
    #[must_use]
    pub fn with_from_mesh(mut self, from_mesh: FromMesh) -> Self {
        self.from_mesh = from_mesh;
        self
    }
}

/// Rayleigh damping, `D = alpha M + beta K`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// alpha (1/s).
    pub mass: f64,
    /// beta (s).
    pub stiffness: f64,
}

impl Rayleigh {
    /// Damping by alpha (1/s) and beta (s).
    #[must_use]
    pub const fn new(mass: f64, stiffness: f64) -> Self {
        Self { mass, stiffness }
    }
}

/// A load: a force on a part of the mesh with a factor over time.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadSpec {
    /// The part of the mesh it acts on.
    pub on: On,
    /// Kind and size.
    pub kind: LoadKind,
    /// Its factor over time.
    pub ramp: Ramp,
}

impl LoadSpec {
    /// A load that acts in full from t = 0 on.
    #[must_use]
    pub fn new(on: impl Into<On>, kind: LoadKind) -> Self {
        Self {
            on: on.into(),
            kind,
            ramp: Ramp::Step,
        }
    }

    /// Sets the factor over time.
    #[must_use]
    pub fn with_ramp(mut self, ramp: Ramp) -> Self {
        self.ramp = ramp;
        self
    }
}

/// A kind of load, with its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadKind {
    /// Force per undeformed area (Pa) on triangles; each vertex gets a third.
    Traction([f64; 3]),
    /// Pressure (Pa) on triangles of the body's surface, against the outward normal before deformation.
    Pressure(f64),
    /// [`LoadKind::Pressure`] that follows the surface of hyperelastic regions as it deforms: against the outward normal then, on the
    /// area then. On other regions, whose shape is that at rest, it is the same as that.
    FollowingPressure(f64),
    /// A total force (N) in equal parts on the nodes that are not fixed in x, y and z.
    Force([f64; 3]),
}

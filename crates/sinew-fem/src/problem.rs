//! The problem as a user states it: materials, damping, supports, prescribed motions and loads.

use sinew_core::Ramp;

use crate::{Element, Fixed, FromMesh, Law, Moving, On, Tissue};

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
    /// The whole mesh of one isotropic material on plain elements, the same everywhere: a law and a mass density
    /// (kg/m^3).
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
}

/// Rayleigh damping, `D = alpha M + beta K`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// alpha (1/s).
    pub mass: f64,
    /// beta (s).
    pub stiffness: f64,
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
    /// A load of this kind on a part of the mesh, with its factor over time.
    #[must_use]
    pub fn new(on: impl Into<On>, kind: LoadKind, ramp: Ramp) -> Self {
        Self {
            on: on.into(),
            kind,
            ramp,
        }
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
    /// A total force (N) in equal parts on the nodes that are not held in x, y and z.
    Force([f64; 3]),
}

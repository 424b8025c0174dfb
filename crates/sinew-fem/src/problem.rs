//! What a user says about a body: materials, damping, supports and loads.

use sinew_core::Ramp;

/// A body made of a mesh: what it is made of, how it is held and what acts on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// Materials; together they cover every tetrahedron once.
    pub regions: Vec<Region>,
    /// Damping of the whole body beside what springs bring themselves.
    pub damping: Rayleigh,
    /// Supports.
    pub fixed: Vec<Fixed>,
    /// Loads.
    pub loads: Vec<LoadSpec>,
    /// Acceleration of free fall (m/s^2), acting from t = 0.
    pub gravity: Option<[f64; 3]>,
}

/// A material and where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// A group of tetrahedra; `None` stands for the whole mesh.
    pub group: Option<String>,
    /// Mass density (kg/m^3).
    pub density: f64,
    /// How it resists deformation.
    pub law: Law,
}

/// How a material resists deformation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Isotropic linear elasticity on 4-node tetrahedra.
    Linear {
        /// Young's modulus (Pa).
        youngs_modulus: f64,
        /// Poisson's ratio, in (-1, 1/2).
        poissons_ratio: f64,
    },
    /// A network of springs along the edges. Its Poisson's ratio is 1/4, whatever the springs.
    Springs {
        /// Young's modulus (Pa) the stiffnesses aim at.
        youngs_modulus: f64,
        /// How stiffness follows from the modulus.
        rule: SpringRule,
        /// Whether stiffnesses are scaled so that the network's Voigt average is the modulus.
        calibrate: bool,
        /// gamma: dashpot of each spring as a share of the pair's critical damping.
        damping_ratio: f64,
    },
}

/// How the stiffness of springs follows from Young's modulus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpringRule {
    /// Lloyd, Szekely and Harders, IEEE TVCG 13(5), 2007: equal stiffness on the six edges of a
    /// tetrahedron, from the regular tetrahedron of the same volume.
    Lloyd,
    /// Van Gelder, J. Graphics Tools 3(2), 1998: stiffness by volume over length squared.
    VanGelder,
}

/// D = alpha M + beta K.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// alpha (1/s).
    pub mass: f64,
    /// beta (s).
    pub stiffness: f64,
}

/// A support: components of displacement that stay zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fixed {
    /// The group held.
    pub group: String,
    /// Which of x, y, z are held.
    pub axes: [bool; 3],
}

/// A load on a group.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadSpec {
    /// The group loaded.
    pub group: String,
    /// What acts.
    pub kind: LoadKind,
    /// Its factor over time.
    pub ramp: Ramp,
}

/// What acts on a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadKind {
    /// Force per undeformed area (Pa) on a group of triangles; each vertex gets a third.
    Traction([f64; 3]),
    /// Pressure (Pa) against the outward normal of the undeformed surface.
    Pressure(f64),
    /// A total force (N) in equal parts on the group's nodes that are not fixed.
    Force([f64; 3]),
}

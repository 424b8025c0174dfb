//! `model` of `[[region]]`: what a material is.

use crate::decode::{Key, Words};

#[derive(Clone, Copy, PartialEq)]
pub(super) enum MaterialModel {
    Springs,
    Linear,
    /// A law of large deformation, by its id.
    Hyperelastic(&'static str),
}

pub(super) const MODEL: Key<Words<MaterialModel>> = Key::required(
    "model",
    "`\"linear\"`: an isotropic elastic solid at small strain and rotation. `\"springs\"`: springs along the edges of the mesh. \
     All others are isotropic solids at any strain and rotation: `\"neo-hookean\"` is the one to begin with; \
     `\"stable-neo-hookean\"` also has a meaning where tetrahedra turn inside out; `\"corotational\"` is linear but for rotations; \
     `\"stvk\"` (Saint Venant and Kirchhoff) collapses under strong compression; `\"mooney-rivlin\"` fits rubber-like tissue better \
     in shear; `\"neo-hookean-log\"`, `\"neo-hookean-iso\"` and `\"stable-neo-hookean-log\"` are there for comparison with other programs.",
    Words(&[
        (SPRINGS_MODEL, MaterialModel::Springs),
        (LINEAR_MODEL, MaterialModel::Linear),
        ("neo-hookean", MaterialModel::Hyperelastic("neo-hookean")),
        (
            "stable-neo-hookean",
            MaterialModel::Hyperelastic("stable-neo-hookean"),
        ),
        ("corotational", MaterialModel::Hyperelastic("corotational")),
        ("stvk", MaterialModel::Hyperelastic("stvk")),
        (MOONEY_RIVLIN, MaterialModel::Hyperelastic(MOONEY_RIVLIN)),
        (
            "neo-hookean-log",
            MaterialModel::Hyperelastic("neo-hookean-log"),
        ),
        (
            "neo-hookean-iso",
            MaterialModel::Hyperelastic("neo-hookean-iso"),
        ),
        (
            "stable-neo-hookean-log",
            MaterialModel::Hyperelastic("stable-neo-hookean-log"),
        ),
    ]),
);

pub(super) const SPRINGS_MODEL: &str = "springs";
pub(super) const LINEAR_MODEL: &str = "linear";
pub(super) const MOONEY_RIVLIN: &str = "mooney-rivlin";

/// The laws of large deformation.
pub(super) const LAWS: &[&str] = &[
    "neo-hookean",
    "stable-neo-hookean",
    "corotational",
    "stvk",
    MOONEY_RIVLIN,
    "neo-hookean-log",
    "neo-hookean-iso",
    "stable-neo-hookean-log",
];

/// The laws that have an isochoric part.
pub(super) const ISOCHORIC: &[&str] = &[MOONEY_RIVLIN, "neo-hookean-iso"];

/// The models that are solids.
pub(super) const SOLIDS: &[&str] = &[
    LINEAR_MODEL,
    "neo-hookean",
    "stable-neo-hookean",
    "corotational",
    "stvk",
    MOONEY_RIVLIN,
    "neo-hookean-log",
    "neo-hookean-iso",
    "stable-neo-hookean-log",
];

#[cfg(test)]
mod tests {
    use sinew_fem::hyperelastic::{Hyperelastic, Parameters};

    use super::*;

    #[test]
    fn every_law_of_large_deformation_is_a_model() {
        let Words(words) = MODEL.values;
        let ids = words.iter().filter_map(|(word, model)| match model {
            MaterialModel::Hyperelastic(id) => Some((*word, *id)),
            MaterialModel::Springs | MaterialModel::Linear => None,
        });
        let ids: Vec<_> = ids.collect();
        let laws: Vec<_> = Hyperelastic::IDS.iter().map(|id| (*id, *id)).collect();
        assert_eq!(ids, laws);
        assert_eq!(LAWS, Hyperelastic::IDS);
        let isochoric = Hyperelastic::IDS.iter().copied().filter(|id| {
            let mut parameters = Parameters::new(1.0, 0.3);
            parameters.c1_over_c2 = (*id == MOONEY_RIVLIN).then_some(1.0);
            let law = Hyperelastic::new(id, &parameters);
            law.unwrap().has_isochoric_part()
        });
        assert_eq!(ISOCHORIC, isochoric.collect::<Vec<_>>());
        assert_eq!(SOLIDS[1..], *LAWS);
    }
}

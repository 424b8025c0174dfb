//! Laws and elements of a body.

use sinew_fem::hyperelastic::{Hyperelastic, KnownLaw, LawParameter, Presence, known_law};

/// A law with an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    law: &'static str,
    element: &'static str,
}

impl Material {
    /// Every law that is defined by Young's modulus, as in the scenes, with every element.
    pub(crate) fn all() -> Vec<Self> {
        let name = LawParameter::YOUNGS_MODULUS.name;
        let is_stated = |id: &&&str| {
            let own = known_law(id).map_or(&[][..], KnownLaw::parameters);
            own.iter().any(|own| own.name == name)
        };
        let laws = Hyperelastic::IDS.iter().filter(is_stated);
        laws.flat_map(|law| ["p1", "fbar", "fbar-edge"].map(|element| Self { law, element }))
            .collect()
    }

    /// The law's id.
    pub(crate) fn law(self) -> &'static str {
        self.law
    }

    /// Description of the material.
    pub(crate) fn words(self) -> String {
        format!("{}, {}", self.law, self.element)
    }

    /// Changes to a scene of one region that give it this material.
    pub(crate) fn values(self) -> Vec<String> {
        let mut values = vec![
            format!("region.1.model={}", self.law),
            format!("region.1.element={}", self.element),
        ];
        // The scenes state the moduli.
        let own = known_law(self.law).map_or(&[][..], KnownLaw::parameters);
        let scene = [LawParameter::YOUNGS_MODULUS, LawParameter::POISSONS_RATIO];
        let is_new = |own: &&LawParameter| {
            own.presence == Presence::Required && scene.iter().all(|known| known.name != own.name)
        };
        for parameter in own.iter().filter(is_new) {
            let value = parameter.written(parameter.example);
            values.push(format!("region.1.{}={value}", parameter.name));
        }
        values
    }
}

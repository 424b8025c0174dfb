//! Laws and elements of a body.

use sinew_fem::hyperelastic::Hyperelastic;

/// The ratio of the two shear constants of laws that leave it open.
const C1_OVER_C2: f64 = 4.0;

/// A law with an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    law: &'static str,
    element: &'static str,
}

impl Material {
    /// Every law with every element.
    pub(crate) fn all() -> Vec<Self> {
        let laws = Hyperelastic::IDS.iter();
        laws.flat_map(|law| ["p1", "fbar", "fbar-edge"].map(|element| Self { law, element }))
            .collect()
    }

    /// The law's id.
    pub(crate) fn law(self) -> &'static str {
        self.law
    }

    /// The material in words.
    pub(crate) fn words(self) -> String {
        format!("{}, {}", self.law, self.element)
    }

    /// Changes to a scene of one region that give it this material.
    pub(crate) fn values(self) -> Vec<String> {
        let mut values = vec![
            format!("region.1.model={}", self.law),
            format!("region.1.element={}", self.element),
        ];
        if self.law.starts_with("mooney") {
            values.push(format!("region.1.c1_over_c2={C1_OVER_C2:?}"));
        }
        values
    }
}

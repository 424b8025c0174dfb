//! Moduli of laws whose stress relaxes.

use crate::element::Element;
use crate::error::{Cause, FemError, Item};
use crate::hyperelastic::{Hyperelastic, prony};
use crate::law::Law;
use crate::tissue::{Direction, Moduli, Tissue, ViscousPart};

impl Tissue {
    /// Refuses additions that do not go with a law on an element.
    pub(crate) fn check_with(
        &self,
        law: &Hyperelastic,
        element: Element,
        item: Item,
    ) -> Result<(), FemError> {
        let part = self.memory.as_ref().map(|memory| memory.part);
        if part == Some(ViscousPart::Deviatoric) && !law.has_isochoric_part() {
            let cause = Cause::NoIsochoricPart { law: law.id() };
            return Err(FemError::new(item, cause));
        }
        let Some(axes) = &self.axes else {
            return Ok(());
        };
        let by_data = axes.iter().any(|axis| matches!(axis, Direction::Data(_)));
        let (has_axes, law) = (law.has_axes(), law.id());
        let cause = match has_axes {
            false => Cause::NeedlessAxes { law },
            true if by_data && element.edge_share() > 0.0 => Cause::AxesOnEdges { law },
            true => return Ok(()),
        };
        Err(FemError::new(item, cause))
    }

    /// The stated law with its instantaneous and with its long-term moduli; twice the same one if nothing relaxes.
    #[must_use]
    pub fn moduli(&self, stated: &Law) -> [Law; 2] {
        let stated = || stated.clone();
        let Some(memory) = &self.memory else {
            return [stated(), stated()];
        };
        let left = 1.0 / prony::instantaneous_over_longterm(&memory.terms);
        let scaled = |factor: f64| {
            let mut law = stated();
            match memory.part {
                ViscousPart::All => law.scale_stiffness(factor),
                ViscousPart::Deviatoric => law.scale_shear(factor),
            }
            law
        };
        match memory.moduli {
            Moduli::Instantaneous => [stated(), scaled(left)],
            Moduli::LongTerm => [scaled(1.0 / left), stated()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::prony::Term;
    use crate::tetra::lame;
    use crate::tissue::Memory;

    fn memory(part: ViscousPart, moduli: Moduli) -> Tissue {
        let term = |share, time| Term { share, time };
        let terms = vec![term(0.3, 0.05), term(0.2, 0.5)];
        Tissue {
            memory: Some(Memory {
                terms,
                part,
                moduli,
            }),
            ..Tissue::default()
        }
    }

    #[test]
    fn stated_moduli_are_the_instantaneous_or_the_long_term_ones() {
        for id in ["neo-hookean-iso", "yeoh"] {
            let parameters = Hyperelastic::parameters(id, 3500.0, 0.45).unwrap();
            let stated = Law::hyperelastic(id, parameters);
            for part in [ViscousPart::All, ViscousPart::Deviatoric] {
                let [at_once, later] = memory(part, Moduli::Instantaneous).moduli(&stated);
                assert_eq!(at_once, stated);
                let of = |law: &Law| [law.youngs_modulus(), law.poissons_ratio().unwrap()];
                let shear = |law: &Law| lame(of(law)[0], of(law)[1]).1;
                let bulk = |law: &Law| of(law)[0] / (3.0 - 6.0 * of(law)[1]);
                assert!((shear(&later) / shear(&at_once) - 0.5).abs() < 1e-14);
                let left = if part == ViscousPart::All { 0.5 } else { 1.0 };
                assert!((bulk(&later) / bulk(&at_once) - left).abs() < 1e-13);
                let [back, same] = memory(part, Moduli::LongTerm).moduli(&later);
                assert_eq!(same, later);
                let [modulus, ratio] = of(&back);
                assert!((modulus / 3500.0 - 1.0).abs() < 1e-13);
                assert!((ratio / 0.45 - 1.0).abs() < 1e-13);
            }
        }
    }
}

//! Checks of a problem's numbers before anything is built.

use crate::error::{Cause, FemError, Item};
use crate::number::{require, require_finite};
use crate::{Element, Law, LoadKind, Problem, motion};

/// Refuses a problem with a number outside its range.
pub(crate) fn numbers(problem: &Problem) -> Result<(), FemError> {
    for (index, region) in problem.regions.iter().enumerate() {
        let item = Item::Region(index);
        let density = region.density;
        let expected = "a finite density above 0 kg/m3";
        require(item, "density", density, expected, density > 0.0)?;
        region.law.check(item)?;
        region.element.check(item)?;
        region.tissue.check(item)?;
        let [at_once, _] = region.tissue.moduli(&region.law);
        match at_once.of_large_deformation() {
            Some(Ok(law)) => region.tissue.check_with(&law, region.element, item)?,
            // The law as it is stated has been checked.
            Some(Err(_)) => {
                let poissons_ratio = at_once.poissons_ratio().unwrap_or(f64::NAN);
                return Err(FemError::new(
                    item,
                    Cause::NoModuliAtOnce { poissons_ratio },
                ));
            }
            None if !region.tissue.is_plain() => {
                return Err(FemError::new(item, Cause::TissueOfSmallStrain));
            }
            None => {}
        }
        if matches!(region.law, Law::Springs { .. }) && region.element != Element::P1 {
            return Err(FemError::new(item, Cause::ElementOnSprings));
        }
    }
    let damping = [
        (
            "mass",
            problem.damping.mass,
            "a finite rate, 0 or above, in 1/s",
        ),
        (
            "stiffness",
            problem.damping.stiffness,
            "a finite time, 0 or above, in s",
        ),
    ];
    for (quantity, found, expected) in damping {
        require(Item::Damping, quantity, found, expected, found >= 0.0)?;
    }
    for (index, moving) in problem.moves.iter().enumerate() {
        motion::check(index, moving)?;
    }
    for (index, load) in problem.loads.iter().enumerate() {
        let item = Item::Load(index);
        match load.kind {
            LoadKind::Traction(value) => require_finite(item, "traction", &value)?,
            LoadKind::Pressure(value) | LoadKind::FollowingPressure(value) => {
                require_finite(item, "pressure", &[value])?;
            }
            LoadKind::Force(value) => require_finite(item, "force", &value)?,
        }
        load.ramp.check().map_err(FemError::at(item))?;
    }
    problem.gravity.map_or(Ok(()), |value| {
        require_finite(Item::Gravity, "gravity", &value)
    })
}

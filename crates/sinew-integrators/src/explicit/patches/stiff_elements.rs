//! The choice of the elements that go into patches.

use sinew_core::spectrum::largest_eigenvalue;
use sinew_core::{
    ElementStiffness, Elements, LinearOperators, LinearSystem, SetupError, StableStep,
    element_omegas_squared,
};

use crate::limits;

/// Largest share of all elements that patches may contain: beyond it a step is no longer an explicit step with
/// exceptions, and a factor of the whole matrix is the better choice.
const LARGEST_SHARE: f64 = 0.05;
/// Number of elements that patches may always contain.
const ALWAYS_ALLOWED: usize = 16;
/// Share of the stable step that a step with patches must stay below.
const MARGIN: f64 = 0.99;
/// Share of the longest possible step up to which elements are added to patches: beyond it, the rest would lengthen the
/// step by less.
const WORTH: f64 = 0.9;

/// The stiffest elements of a system, in order, the stiffest first.
pub(super) struct StiffElements<'a> {
    integrator: &'static str,
    operators: &'a LinearOperators,
    elements: &'a dyn Elements,
    order: Vec<usize>,
    stiffness: Vec<ElementStiffness>,
    plain_limit: f64,
}

impl<'a> StiffElements<'a> {
    pub(super) fn of(
        linear: &'a dyn LinearSystem,
        integrator: &'static str,
    ) -> Result<Self, SetupError> {
        let refused = |reason: &str| SetupError::Unresolved {
            integrator,
            reason: reason.to_owned(),
        };
        let elements = linear.elements().ok_or_else(|| {
            refused(
                "patches = \"auto\" needs a body of elements, and this system has none: leave \
                 `patches` out",
            )
        })?;
        let operators = linear.operators();
        let omegas = element_omegas_squared(elements, operators.mass());
        let mut order: Vec<usize> = (0..omegas.len()).collect();
        order.sort_by(|&a, &b| omegas[b].total_cmp(&omegas[a]));
        let share = (LARGEST_SHARE * order.len() as f64) as usize;
        order.truncate(share.max(ALWAYS_ALLOWED));
        let stiffness = order
            .iter()
            .map(|&element| {
                let mut stiffness = ElementStiffness::default();
                elements.stiffness(element, &mut stiffness);
                stiffness
            })
            .collect();
        let mut stiff = Self {
            integrator,
            operators,
            elements,
            order,
            stiffness,
            plain_limit: f64::INFINITY,
        };
        stiff.plain_limit = stiff.limit(0);
        if stiff.plain_limit.is_infinite() {
            return Err(refused(
                "nothing in this scene limits the step: leave `patches` out",
            ));
        }
        Ok(stiff)
    }

    /// All elements of the system.
    pub(super) fn elements(&self) -> usize {
        self.elements.count()
    }

    /// The stable step (s) without patches.
    pub(super) fn plain_limit(&self) -> f64 {
        self.plain_limit
    }

    /// The first few as matrices.
    pub(super) fn stiffness(&self, count: usize) -> &[ElementStiffness] {
        &self.stiffness[..count]
    }

    /// The names of the first few.
    pub(super) fn names(&self, count: usize) -> Vec<String> {
        let first = self.order[..count].iter();
        first.map(|element| self.elements.name(*element)).collect()
    }

    /// The stable step (s) of the system without the first `count` elements.
    fn limit(&self, count: usize) -> f64 {
        let (operators, mass) = (self.operators, self.operators.mass());
        let multiply = |x: &[f64], out: &mut [f64]| {
            operators.stiffness().multiply(x, out);
            for element in &self.stiffness[..count] {
                element.add_product(-1.0, x, out);
            }
        };
        let w2 = largest_eigenvalue(mass, multiply).max(0.0);
        let damping = operators.damping();
        let d = match &damping.extra {
            None => damping.stiffness * w2,
            Some(extra) => largest_eigenvalue(mass, |x, out| {
                multiply(x, out);
                out.iter_mut()
                    .for_each(|value| *value *= -damping.stiffness);
                extra.subtract_product(x, out);
                out.iter_mut().for_each(|value| *value = -*value);
            }),
        };
        limits::lagged(w2.sqrt(), d)
    }

    /// The fewest elements whose patches allow a step of `dt` (s).
    pub(super) fn fewest_for(&self, dt: f64) -> Result<usize, SetupError> {
        if dt <= MARGIN * self.plain_limit {
            return Ok(0);
        }
        let most = self.order.len();
        let longest = self.limit(most);
        if dt > MARGIN * longest {
            return Err(SetupError::Unresolved {
                integrator: self.integrator,
                reason: format!(
                    "dt = {dt} s is too long for patches: with {most} of {} elements in them the \
                     step may be {:.4e} s; take that, substeps = \"auto\", or a method that is \
                     stable at any step",
                    self.elements(),
                    MARGIN * longest
                ),
            });
        }
        Ok(self.fewest(|limit| dt <= MARGIN * limit))
    }

    /// The longest step for which patches are worth their cost.
    pub(super) fn stable_step(&self) -> StableStep {
        let longest = self.limit(self.order.len());
        let enough = |limit: f64| limit >= WORTH * longest;
        if enough(self.plain_limit) {
            return StableStep::UpTo(self.plain_limit);
        }
        StableStep::UpTo(MARGIN * self.limit(self.fewest(enough)))
    }

    /// The smallest number of elements whose removal makes the limit long enough; the removal of all is known to
    /// suffice, and the removal of none not to. The removal of an element from K never shortens the limit, so bisection
    /// finds the number.
    fn fewest(&self, enough: impl Fn(f64) -> bool) -> usize {
        let (mut too_few, mut count) = (0, self.order.len());
        while count - too_few > 1 {
            let middle = too_few + (count - too_few) / 2;
            if enough(self.limit(middle)) {
                count = middle;
            } else {
                too_few = middle;
            }
        }
        count
    }
}

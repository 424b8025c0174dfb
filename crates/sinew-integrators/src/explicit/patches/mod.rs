//! `patches`: the few stiffest elements solved as small blocks inside an otherwise explicit step.
//!
//! In `P (v+ - v-) = dt (F - K u - D v-)` any symmetric `P > dt/2 D + dt^2/4 K` is stable (see
//! [`crate::cnn::CnnStabilised`]). With `P = M + dt/2 alpha M + (dt/2 beta + dt^2/4) K_patch`, K_patch the
//! sum over some elements, that holds as soon as the step is stable for the elements left. A sum
//! over whole elements knows no rigid motion, so that a patch moves with its surroundings as freely
//! as before, which blocks cut out of K would not.

mod candidates;

use std::sync::Arc;

use sinew_core::{
    BlockMatrix, Damping, ElementStiffness, Fact, Layers, LinearOperators, LinearSystem, Needs,
    OptionError, OptionValue, Options, Pattern, SetupError, StableStep, System,
};

use crate::OptionHelp;
use crate::implicit::factor::{Combination, Factor};
use candidates::Candidates;

const KEY: &str = "patches";

pub(super) const OPTIONS: &[OptionHelp] = &[OptionHelp {
    key: KEY,
    help: "\"auto\": the few elements that forbid dt are solved as small blocks; \"off\" (default)",
    shown_default: None,
}];

/// Elements named in a remark.
const NAMED: usize = 5;

/// Patches chosen anew for each system and step.
#[derive(Debug, Default)]
pub(super) struct AutoPatches {
    made: Option<Box<Patches>>,
    remark: Option<String>,
}

impl AutoPatches {
    /// The option `patches`.
    pub(super) fn from_options(
        options: &Options,
        integrator: &str,
    ) -> Result<Option<Self>, OptionError> {
        match options.get(KEY) {
            None => Ok(None),
            Some(OptionValue::Text(word)) if word == "off" => Ok(None),
            Some(OptionValue::Text(word)) if word == "auto" => Ok(Some(Self::default())),
            Some(found) => Err(OptionError::Value {
                integrator: integrator.into(),
                key: KEY.into(),
                found: found.clone(),
                expected: "\"auto\" or \"off\"",
            }),
        }
    }

    /// The step (s) up to which patches of few elements make the method stable.
    pub(super) fn stable_step(
        &self,
        system: &dyn System,
        integrator: &'static str,
    ) -> Result<StableStep, SetupError> {
        let linear = linear(system, integrator)?;
        Candidates::of(linear, integrator).map(|candidates| candidates.stable_step())
    }

    /// Makes the patches that a step of `dt` (s) needs.
    pub(super) fn prepare(
        &mut self,
        system: &dyn System,
        integrator: &'static str,
        dt: f64,
    ) -> Result<(), SetupError> {
        *self = Self::default();
        let linear = linear(system, integrator)?;
        let candidates = Candidates::of(linear, integrator)?;
        let count = candidates.fewest_for(dt)?;
        if count == 0 {
            self.remark = Some(format!(
                "dt = {dt} s is stable without patches; none are made"
            ));
            return Ok(());
        }
        let elements = candidates.stiffness(count);
        let patches = Patches::new(linear.operators(), elements, dt).map_err(|reason| {
            SetupError::Factorization {
                integrator,
                reason: format!("a patch: {reason}"),
            }
        })?;
        let mut names = candidates.names(count.min(NAMED)).join(", ");
        if count > NAMED {
            names.push_str(" and others");
        }
        self.remark = Some(format!(
            "dt = {dt} s is {:.3} times the stable step without patches, {:.3e} s, which {names} \
             set; {count} of {} elements, on {} cells, are solved in {} small block(s)",
            dt / candidates.plain_limit(),
            candidates.plain_limit(),
            candidates.elements(),
            patches.cells.len(),
            patches.blocks,
        ));
        self.made = Some(Box::new(patches));
        Ok(())
    }

    /// The patches of the step at hand, where it needs any.
    pub(super) fn made(&mut self) -> Option<&mut Patches> {
        self.made.as_deref_mut()
    }

    pub(super) fn facts(&self) -> Vec<Fact> {
        let (elements, cells, blocks) = self.made.as_ref().map_or((0, 0, 0), |patches| {
            (patches.elements, patches.cells.len(), patches.blocks)
        });
        let fact = |name, value: usize| Fact {
            name,
            value: value as f64,
        };
        vec![
            fact("patches", blocks),
            fact("patch_elements", elements),
            fact("patch_cells", cells),
        ]
    }

    pub(super) fn remarks(&self) -> Vec<String> {
        self.remark.iter().cloned().collect()
    }
}

fn linear<'a>(
    system: &'a dyn System,
    integrator: &'static str,
) -> Result<&'a dyn LinearSystem, SetupError> {
    system
        .as_linear()
        .ok_or_else(|| Needs::Matrices.lacking(integrator))
}

/// Cells of some elements, and the factor of `M + c K_patch` on them.
#[derive(Debug)]
pub(super) struct Patches {
    elements: usize,
    /// Cells of the system, increasing.
    cells: Vec<u32>,
    /// Patches that share no cell.
    blocks: usize,
    layers: usize,
    operators: LinearOperators,
    factor: Factor,
    right_side: Vec<f64>,
    velocity: Vec<f64>,
}

impl Patches {
    fn new(
        operators: &LinearOperators,
        elements: &[ElementStiffness],
        dt: f64,
    ) -> Result<Self, String> {
        let mut cells: Vec<u32> = elements
            .iter()
            .flat_map(|element| element.cells.iter().copied())
            .collect();
        cells.sort_unstable();
        cells.dedup();
        let local = |cell: &u32| cells.partition_point(|own| own < cell) as u32;
        let members: Vec<Vec<u32>> = elements
            .iter()
            .map(|element| element.cells.iter().map(local).collect())
            .collect();
        let pattern = Pattern::from_elements(cells.len(), members.iter().map(Vec::as_slice))
            .map_err(|error| error.to_string())?;
        let layers = operators.stiffness().layers();
        let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), layers);
        for (element, members) in elements.iter().zip(&members) {
            stiffness
                .add_element(members, &element.matrix)
                .map_err(|error| error.to_string())?;
        }
        let blocks = connected_parts(cells.len(), &members);
        let mass = dofs_of(&cells, layers)
            .map(|dof| operators.mass()[dof])
            .collect();
        let own = LinearOperators::new(mass, stiffness, Damping::default(), Vec::new())
            .map_err(|error| error.to_string())?;
        let mut factor = Factor::analyse(&own)?;
        let damping = operators.damping();
        // Divided by 1 + alpha dt/2, which mass damping multiplies all of P outside K_patch by.
        let share = dt / 2.0 * (damping.stiffness + dt / 2.0) / (1.0 + damping.mass * dt / 2.0);
        let combination = Combination {
            mass: 1.0,
            stiffness: share,
            extra: 0.0,
        };
        factor.factorise(&own, combination)?;
        Ok(Self {
            elements: elements.len(),
            blocks,
            layers: layers.count(),
            right_side: vec![0.0; own.dofs()],
            velocity: vec![0.0; own.dofs()],
            operators: own,
            factor,
            cells,
        })
    }

    /// Replaces the acceleration `a = M^-1 f` of the patches' cells by `(M + c K_patch)^-1 f`.
    pub(super) fn accelerate(&mut self, a: &mut [f64]) {
        self.right_side.fill(0.0);
        self.solve(a, |a, _| a, |x, _| x);
    }

    /// The same for the start from `v` (m/s), which holds at the displacement's time:
    /// `(M + c K_patch)(a' + alpha v) = M (a + alpha v) - dt/2 K_patch v`, so that a stiff patch
    /// does not set out with a velocity it could not keep.
    pub(super) fn accelerate_start(&mut self, a: &mut [f64], v: &[f64], alpha: f64, dt: f64) {
        for (own, dof) in self
            .velocity
            .iter_mut()
            .zip(dofs_of_layers(&self.cells, self.layers))
        {
            *own = dt / 2.0 * v[dof];
        }
        self.right_side.fill(0.0);
        self.operators
            .stiffness()
            .subtract_product(&self.velocity, &mut self.right_side);
        self.solve(a, |a, dof| a + alpha * v[dof], |x, dof| x - alpha * v[dof]);
    }

    /// Adds `M before(a)` to the right side, solves, and writes `after` of the solution to a.
    fn solve(
        &mut self,
        a: &mut [f64],
        before: impl Fn(f64, usize) -> f64,
        after: impl Fn(f64, usize) -> f64,
    ) {
        let dofs = || dofs_of_layers(&self.cells, self.layers);
        let mass = self.operators.mass();
        for ((own, mass), dof) in self.right_side.iter_mut().zip(mass).zip(dofs()) {
            *own += mass * before(a[dof], dof);
        }
        self.factor.solve(&mut self.right_side);
        for (x, dof) in self.right_side.iter().zip(dofs()) {
            a[dof] = after(*x, dof);
        }
    }
}

fn dofs_of(cells: &[u32], layers: Layers) -> impl Iterator<Item = usize> {
    dofs_of_layers(cells, layers.count())
}

fn dofs_of_layers(cells: &[u32], layers: usize) -> impl Iterator<Item = usize> {
    cells
        .iter()
        .flat_map(move |cell| (0..layers).map(move |layer| *cell as usize * layers + layer))
}

/// Parts of which no element has cells of two.
fn connected_parts(cells: usize, elements: &[Vec<u32>]) -> usize {
    let mut parent: Vec<usize> = (0..cells).collect();
    fn root(parent: &mut [usize], mut cell: usize) -> usize {
        while parent[cell] != cell {
            parent[cell] = parent[parent[cell]];
            cell = parent[cell];
        }
        cell
    }
    let mut parts = cells;
    for element in elements {
        for pair in element.windows(2) {
            let a = root(&mut parent, pair[0] as usize);
            let b = root(&mut parent, pair[1] as usize);
            if a != b {
                parent[a] = b;
                parts -= 1;
            }
        }
    }
    parts
}

//! `patches`: the few stiffest elements solved as small blocks inside an otherwise explicit step.
//!
//! In `P (v+ - v-) = dt (F - K u - D v-)` any symmetric `P > dt/2 D + dt^2/4 K` is stable (see
//! [`crate::cnn::CnnStabilised`]). With `P = M + dt/2 alpha M + (dt/2 beta + dt^2/4) K_patch`, K_patch the sum over
//! some elements, that holds as soon as the step is stable for the remaining elements. A sum over whole elements gives
//! no force for a rigid motion, so that a patch moves with its surroundings as freely as before; blocks cut out of K
//! would not allow this.

mod stiff_elements;

use std::sync::Arc;

use sinew_cnn::Physics;
use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Acceleration, BlockMatrix, DampedAt, Damping, ElementStiffness, Fact, Layers, LinearOperators,
    LoadTime, Needs, OperatorError, OptionError, Options, Pattern, Properties, SetupError,
    StableStep, State, Step, StepError, StepReport, Stepped, System, VelocityTime,
};

use sinew_sparse::AssemblyError;

use super::{CentralDifference, GuardOption};
use crate::implicit::factor::{Combination, Factor};
use crate::implicit::factor_error::FactorError;
use crate::{
    ConservedEnergy, Explicit, Method, OptionDefault, OptionHelp, OptionKind, Scheme, SetUp,
    StepByHand,
};
use stiff_elements::StiffElements;

const KEY: &str = "patches";
const AUTO: &str = "auto";

const PATCHES: OptionHelp = OptionHelp {
    key: KEY,
    help: "\"auto\": the few elements that forbid dt are solved as small blocks",
    expected: "\"auto\" or \"off\"",
    kind: OptionKind::Words(&[AUTO, "off"]),
    default: OptionDefault::Value("\"off\""),
    example: "patches = \"auto\"",
    shown_default: None,
};

/// Elements named in a remark.
const NAMED: usize = 5;

/// [`CentralDifference`] in which the few elements that are unstable at this step are solved as small blocks: stable up
/// to the limit of all others, order 2, the elements named in a remark.
///
/// Without `patches = "auto"` it is central difference.
#[derive(Debug, Default)]
pub struct PatchedCentralDifference {
    auto: bool,
    facts: Vec<Fact>,
    remark: Option<String>,
}

impl Method for PatchedCentralDifference {
    const SUMMARY: &'static str = <CentralDifference as Explicit>::SUMMARY;
    const OPTIONS: &'static [OptionHelp] = &[PATCHES];
    const SUBSTEPS: bool = true;
    const GUARD: GuardOption = <CentralDifference as Explicit>::GUARD;

    const PROGRAMS: bool = true;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let auto = PATCHES.read(options, Self::ID, |value| Some(value.word()? == AUTO))?;
        Ok(Self {
            auto: auto.unwrap_or(false),
            ..Self::default()
        })
    }

    fn conserved_energy(facts: &[Fact]) -> ConservedEnergy {
        <CentralDifference as Method>::conserved_energy(facts)
    }
}

impl Scheme for PatchedCentralDifference {
    const ID: &'static str = <CentralDifference as Explicit>::ID;

    type ByHand = PatchedSteps;

    fn properties(&self) -> Properties {
        let plain = Explicit::properties(&CentralDifference);
        let needs = if self.auto {
            Needs::Matrices
        } else {
            plain.needs
        };
        Properties { needs, ..plain }
    }

    fn lacking(&self) -> SetupError {
        match self.auto {
            true => SetupError::Lacks {
                integrator: Self::ID,
                needs: "the matrices of a linear system for patches = \"auto\", which solves them in blocks (substeps = \"auto\" \
                        cuts the steps of any system)",
            },
            false => self.properties().needs.lacking(Self::ID),
        }
    }

    fn stable_step(
        &self,
        system: &dyn System,
        about: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        if !self.auto {
            return Scheme::stable_step(&CentralDifference, system, about);
        }
        let integrator = Self::ID;
        let linear = system.as_linear().ok_or_else(|| self.lacking())?;
        let stiff = StiffElements::of(linear, integrator)?;
        Ok(stiff.stable_step())
    }

    fn stable_step_of(&self, spectrum: &Spectrum) -> StableStep {
        Explicit::stable_step(&CentralDifference, spectrum)
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        _before: Option<PatchedSteps>,
    ) -> Result<SetUp<PatchedSteps>, SetupError> {
        let plain = || CentralDifference.program(&Physics::of(system), dt);
        if !self.auto {
            return Ok(plain().into());
        }
        let integrator = Self::ID;
        let linear = system.as_linear().ok_or_else(|| self.lacking())?;
        let stiff = StiffElements::of(linear, integrator)?;
        let count = stiff.fewest_for(dt)?;
        if count == 0 {
            self.facts = facts(0, 0, 0);
            self.remark = Some(format!(
                "dt = {dt} s is stable without patches; none are made"
            ));
            return Ok(plain().into());
        }
        let elements = stiff.stiffness(count);
        let patches = Patches::new(linear.operators(), elements, dt).map_err(|error| {
            SetupError::Factorization {
                integrator,
                reason: format!("a patch: {error}"),
            }
        })?;
        let mut names = stiff.names(count.min(NAMED)).join(", ");
        if count > NAMED {
            names.push_str(" and others");
        }
        self.facts = facts(count, patches.cells.len(), patches.blocks);
        self.remark = Some(format!(
            "dt = {dt} s is {:.3} times the stable step without patches, {:.3e} s, which {names} \
             set; {count} of {} elements, on {} cells, are solved in {} small block(s)",
            dt / stiff.plain_limit(),
            stiff.plain_limit(),
            stiff.elements(),
            patches.cells.len(),
            patches.blocks,
        ));
        let steps = PatchedSteps {
            patches,
            a: vec![0.0; system.dofs()],
        };
        Ok(SetUp::by_hand(steps, StepReport::default()))
    }

    fn facts(&self) -> Vec<Fact> {
        self.facts.clone()
    }

    fn remarks(&self) -> Vec<String> {
        self.remark.iter().cloned().collect()
    }
}

fn facts(elements: usize, cells: usize, blocks: usize) -> Vec<Fact> {
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

/// Central difference with patches.
pub struct PatchedSteps {
    patches: Patches,
    a: Vec<f64>,
}

impl StepByHand for PatchedSteps {
    fn without_program(&self) -> &'static str {
        "its patches solve linear equations in each step, with a factor for each patch"
    }

    fn is_staggered(&self) -> bool {
        true
    }

    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError> {
        let (dt, alpha) = (step.dt, step.system.mass_damping());
        let running = state.is_staggered_by(dt);
        let load = LoadTime::around(state.t(), if running { dt } else { 0.0 }, dt);
        step.acceleration(load, state, &mut self.a)?;
        if running {
            self.patches.accelerate(&mut self.a);
        } else {
            self.patches
                .accelerate_start(&mut self.a, &state.v, alpha, dt);
        }
        let implicit = 1.0 / (1.0 + alpha * dt / 2.0);
        let taken = if running { dt } else { dt / 2.0 };
        state.a.resize(state.u.len(), 0.0);
        let moving = state.u.iter_mut().zip(&mut state.v).zip(&mut state.a);
        for (((u, v), kept), a) in moving.zip(&self.a) {
            let change = if running {
                dt * implicit * a
            } else {
                dt / 2.0 * ((a + alpha * *v) * implicit - alpha * *v)
            };
            let before = *v;
            *v += change;
            // Kept so that the velocity at the displacement's time can be had: M^-1 of the force is not
            // the acceleration of a patch.
            *kept = (*v - before) / taken;
            *u += dt * *v;
        }
        Ok(Stepped {
            work: StepReport {
                solves: 1,
                ..StepReport::ONE_FORCE
            },
            velocity: VelocityTime::MiddleOfStep,
            damped: DampedAt::default(),
            acceleration: Acceleration::Kick,
        })
    }
}

/// Reasons for which patches cannot be built.
#[derive(Debug, thiserror::Error)]
enum PatchError {
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    #[error(transparent)]
    Operators(#[from] OperatorError),
    #[error(transparent)]
    Factor(#[from] FactorError),
}

/// Cells of some elements, and the factor of `M + c K_patch` on them.
#[derive(Debug)]
struct Patches {
    /// Cells of the system, increasing.
    cells: Vec<u32>,
    /// Number of patches without common cells.
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
    ) -> Result<Self, PatchError> {
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
        let pattern = Pattern::from_elements(cells.len(), members.iter().map(Vec::as_slice))?;
        let layers = operators.stiffness().layers();
        let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), layers);
        for (element, members) in elements.iter().zip(&members) {
            stiffness.add_element(members, &element.matrix)?;
        }
        let blocks = connected_parts(cells.len(), &members);
        let mass = dofs_of(&cells, layers)
            .map(|dof| operators.mass()[dof])
            .collect();
        let own = LinearOperators::new(mass, stiffness, Damping::default(), Vec::new())?;
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
    fn accelerate(&mut self, a: &mut [f64]) {
        self.right_side.fill(0.0);
        self.solve(a, |a, _| a, |x, _| x);
    }

    /// [`Patches::accelerate`] for the start from `v` (m/s), which holds at the displacement's time:
    /// `(M + c K_patch)(a' + alpha v) = M (a + alpha v) - dt/2 K_patch v`, so that a stiff patch does not start with a
    /// velocity that it could not keep.
    fn accelerate_start(&mut self, a: &mut [f64], v: &[f64], alpha: f64, dt: f64) {
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

/// Number of connected parts; no element has cells in two of them.
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

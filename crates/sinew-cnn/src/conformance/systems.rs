//! Small systems of every kind that a machine may meet.

use std::sync::Arc;

use sinew_core::spectrum::Spectrum;
use sinew_core::{
    BlockMatrix, Damping, Layers, LinearModel, LinearOperators, LinearSystem, Load, LoadOverStep,
    Pattern, Ramp, State,
};

/// Kinds of damping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Damped {
    Not,
    ByMass,
    ByStiffness,
    ByDashpots,
    ByAll,
}

/// Kinds of loads, apart from one that is constant from t = 0 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Changing {
    Not,
    Jumps,
    Kinks,
}

/// Kind of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kind {
    pub(super) layers: Layers,
    pub(super) damped: Damped,
    pub(super) changing: Changing,
    /// True if some components are fixed.
    pub(super) held: bool,
    /// Cells along each axis.
    pub(super) cells: [usize; 3],
}

pub(super) const SMALL: [usize; 3] = [2, 2, 3];
/// More degrees of freedom than a machine is likely to take at a time.
pub(super) const LONG: [usize; 3] = [1, 1, 811];

impl Kind {
    /// Every kind of small system.
    pub(super) fn all() -> Vec<Self> {
        let mut kinds = Vec::new();
        for layers in [Layers::One, Layers::Three] {
            for damped in [
                Damped::Not,
                Damped::ByMass,
                Damped::ByStiffness,
                Damped::ByDashpots,
                Damped::ByAll,
            ] {
                for changing in [Changing::Jumps, Changing::Kinks] {
                    for held in [false, true] {
                        kinds.push(Self {
                            layers,
                            damped,
                            changing,
                            held,
                            cells: SMALL,
                        });
                    }
                }
            }
        }
        kinds
    }
}

/// Numbers between 0 and 1 that look random and are the same in every run (Knuth's linear
/// congruential generator, MMIX).
pub(super) struct Numbers(u64);

impl Numbers {
    pub(super) fn new() -> Self {
        Self(2026)
    }

    pub(super) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }
}

/// A system with a start, for steps of `omega_dt` over its largest angular frequency.
pub(super) struct Case {
    pub(super) system: LinearModel,
    pub(super) start: State,
    /// Step (s).
    pub(super) dt: f64,
}

/// Springs between neighbours of a lattice, some of them to the ground.
pub(super) fn case(kind: Kind, omega_dt: f64, needed: LoadOverStep) -> Case {
    let mut numbers = Numbers::new();
    let [nx, ny, nz] = kind.cells;
    let cell = |x: usize, y: usize, z: usize| (x + nx * (y + ny * z)) as u32;
    let mut springs = Vec::new();
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                for (dx, dy, dz) in [
                    (1, 0, 0),
                    (0, 1, 0),
                    (0, 0, 1),
                    (1, 1, 0),
                    (1, 0, 1),
                    (0, 1, 1),
                ] {
                    if x + dx < nx && y + dy < ny && z + dz < nz {
                        springs.push([cell(x, y, z), cell(x + dx, y + dy, z + dz)]);
                    }
                }
            }
        }
    }
    let count = nx * ny * nz;
    let layers = kind.layers.count();
    let Ok(pattern) = Pattern::from_elements(count, &springs) else {
        unreachable!("springs join cells that exist");
    };
    let pattern = Arc::new(pattern);
    let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), kind.layers);
    let mut dashpots = BlockMatrix::zeros(pattern, kind.layers);
    for (number, spring) in springs.iter().enumerate() {
        let k = numbers.within(50.0, 150.0);
        let direction: Vec<f64> = (0..layers).map(|_| numbers.within(-1.0, 1.0)).collect();
        add_spring(&mut stiffness, spring, k, &direction);
        if number % 3 == 0 {
            add_spring(&mut dashpots, spring, k, &direction);
        }
    }
    let mut ground = vec![0.0; layers * layers];
    for layer in 0..layers {
        ground[layer * (layers + 1)] = 20.0;
    }
    for cell in 0..count as u32 {
        if let Err(error) = stiffness.add_block(cell, cell, &ground) {
            unreachable!("cells have blocks of their own: {error}");
        }
    }
    let dofs = count * layers;
    let pinned: Vec<bool> = (0..dofs).map(|dof| kind.held && dof % 7 == 3).collect();
    stiffness.clear_pinned(&pinned);
    dashpots.clear_pinned(&pinned);
    let mass: Vec<f64> = (0..dofs).map(|_| numbers.within(0.5, 2.0)).collect();

    let Ok(undamped) = LinearOperators::new(
        mass.clone(),
        stiffness.clone(),
        Damping::default(),
        Vec::new(),
    ) else {
        unreachable!("sizes fit");
    };
    let omega = Spectrum::of(&undamped).omega_max;
    let dt = omega_dt / omega;
    let scale = vec![0.1 / omega; dofs];
    dashpots.scale_rows(&scale);
    let has = |damped| kind.damped == damped || kind.damped == Damped::ByAll;
    let damping = Damping {
        mass: if has(Damped::ByMass) {
            0.1 * omega
        } else {
            0.0
        },
        stiffness: if has(Damped::ByStiffness) {
            0.1 / omega
        } else {
            0.0
        },
        extra: has(Damped::ByDashpots).then(|| Arc::new(dashpots)),
    };
    let free = |dof: &usize| !pinned[*dof];
    let some: Vec<usize> = (0..dofs).filter(free).step_by(5).collect();
    let mut entries = |size: f64| -> Vec<(u32, f64)> {
        let force = |dof: &usize| (*dof as u32, numbers.within(-size, size));
        some.iter().map(force).collect()
    };
    let mut loads = vec![Load {
        ramp: Ramp::Step,
        entries: entries(5.0),
    }];
    // Jumps and kinks between steps where a method takes them.
    let off = if needed == LoadOverStep::Any {
        0.3
    } else {
        0.0
    };
    match kind.changing {
        Changing::Not => {}
        Changing::Jumps => {
            let (from, to) = ((13.0 + off) * dt, (37.0 + 2.0 * off) * dt);
            loads.push(Load {
                ramp: Ramp::Pulse { from, to },
                entries: entries(40.0),
            });
        }
        Changing::Kinks => {
            loads.push(Load {
                ramp: Ramp::Table {
                    times: [5.0 + off, 30.0, 55.0 + off].map(|step| step * dt).into(),
                    values: vec![0.0, 1.0, -0.5],
                },
                entries: entries(40.0),
            });
            loads.push(Load {
                ramp: Ramp::Sin2 {
                    rise: (40.0 + off) * dt,
                },
                entries: entries(40.0),
            });
        }
    }
    let Ok(operators) = LinearOperators::new(mass, stiffness, damping, loads) else {
        unreachable!("sizes fit");
    };
    let mut start = State::at_rest(dofs);
    for dof in (0..dofs).filter(free) {
        start.u[dof] = numbers.within(-0.1, 0.1);
        start.v[dof] = numbers.within(-0.1, 0.1) * omega;
    }
    Case {
        system: LinearModel::new(operators),
        start,
        dt,
    }
}

/// `k n n'` between two cells.
fn add_spring(matrix: &mut BlockMatrix, cells: &[u32; 2], k: f64, direction: &[f64]) {
    let layers = direction.len();
    let size = 2 * layers;
    let mut element = vec![0.0; size * size];
    for i in 0..size {
        for j in 0..size {
            let sign = if i / layers == j / layers { k } else { -k };
            element[i * size + j] = sign * direction[i % layers] * direction[j % layers];
        }
    }
    if let Err(error) = matrix.add_element(cells, &element) {
        unreachable!("springs join neighbours: {error}");
    }
}

/// True if the loads of a case meet the condition of a method.
pub(super) fn takes(needed: LoadOverStep, changing: Changing) -> bool {
    match changing {
        Changing::Not | Changing::Jumps => true,
        Changing::Kinks => needed != LoadOverStep::Constant && needed != LoadOverStep::Linear,
    }
}

/// Constant forces of a case (N).
pub(super) fn constant_force(system: &LinearModel) -> Vec<f64> {
    let mut force = vec![0.0; system.operators().dofs()];
    for load in system.operators().loads() {
        for (dof, value) in &load.entries {
            force[*dof as usize] += value;
        }
    }
    force
}

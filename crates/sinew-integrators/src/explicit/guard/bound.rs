//! How fast a cell can move: the limits of `saturation = "auto"`.
//!
//! The motion of a linear system is that of its start without loads and that of its loads from
//! rest, added up; so is the limit, `Q_i = Q_i(loads) + Q_i(start)`.
//!
//! *Loads.* `Q_i = min(sqrt(2 E/m_i), 3 max(2 p/(rho c), sqrt(2 W/m)))`. W bounds the energy that the
//! loads can have put into the body at any time (`load_work.rs`), m is its mass and m_i the cell's; E is
//! ten times W, for what methods make of it (see [`DISCRETE`]). A pressure p put on a surface moves it at
//! p/(rho c) at once, and at twice that where the wave comes back; three times as much is room for
//! the third dimension. That is enough for what is as long as thick. What is slender, or swings in
//! step with its load, gets faster than the waves alone would make it: by the speed that all of W
//! would give to the body as a whole.
//!
//! *Start.* `Q_i = min(sqrt(2 E/m_i), 3 (s + sqrt(2 W/m)))` with the energy W at the start and s the
//! largest speed of a cell that turns all elastic energy about it into motion of its own: the strain times c
//! in a plane wave, the speed itself in a body that moves as a whole.
//!
//! Where a system has no sizes only the energies count.

use sinew_core::{LinearOperators, Needs, SetupError, Start, State, System};

use super::load_work::load_work;

/// The energy of a velocity that a method computes, over that of the exact motion: a leapfrog
/// velocity in the fastest mode is too large by up to `1/sqrt(1 - (dt/dt_c)^2)`, dt_c being the critical step,
/// and symplectic Euler's by `1/sqrt(1 - dt/dt_c)`: sqrt 10 at nine tenths of it.
const DISCRETE: f64 = 10.0;

/// Room for three dimensions in the speeds of plane waves.
const ROOM: f64 = 3.0;

/// What bounds the velocities in a system.
#[derive(Debug)]
pub(super) struct Bound {
    /// Mass of each cell (kg).
    mass: Vec<f64>,
    /// Size of each cell (m); empty where the system has none.
    size: Vec<f64>,
    /// Square root of the mass of all (kg^1/2).
    root_mass: f64,
    /// sqrt(2 W) of the loads (J^1/2).
    load_strength: f64,
    /// The speed (m/s) of waves and of the body as a whole under the loads; infinite where the system
    /// has no sizes.
    load_speed: f64,
}

impl Bound {
    pub(super) fn new(integrator: &'static str, system: &dyn System) -> Result<Self, SetupError> {
        let linear = system
            .as_linear()
            .ok_or_else(|| Needs::Matrices.lacking(integrator))?;
        let operators = linear.operators();
        let load_strength = (2.0 * load_work(operators)).sqrt();
        if !load_strength.is_finite() {
            return Err(SetupError::Lacks {
                integrator,
                needs: "a body held against its loads for saturation = \"auto\" (give a number instead)",
            });
        }
        let layers = system.layers().count();
        let components = operators.mass().chunks_exact(layers);
        let lightest = |cell: &[f64]| cell.iter().copied().fold(f64::INFINITY, f64::min);
        let mass: Vec<f64> = components.map(lightest).collect();
        let root_mass = mass.iter().sum::<f64>().sqrt();
        let scales = system.scales();
        let load_speed = scales.map_or(f64::INFINITY, |scales| {
            let wave = 2.0 * scales.pressure / scales.impedance;
            wave.max(load_strength / root_mass)
        });
        Ok(Self {
            mass,
            size: scales.map_or_else(Vec::new, |scales| scales.cell_size.to_vec()),
            root_mass,
            load_strength,
            load_speed,
        })
    }

    /// Writes the limit of each cell (m/s); returns the largest limit over the cell's size (1/s).
    pub(super) fn limits(&self, start: Option<Start>, out: &mut [f64]) -> f64 {
        let start_strength = start.map_or(0.0, |start| (2.0 * start.energy).sqrt());
        let start_speed = match start {
            Some(start) if !self.size.is_empty() => start.speed + start_strength / self.root_mass,
            _ => f64::INFINITY,
        };
        for (limit, mass) in out.iter_mut().zip(&self.mass) {
            let of = |strength: f64, speed: f64| {
                (DISCRETE.sqrt() * strength / mass.sqrt()).min(ROOM * speed)
            };
            *limit = of(self.load_strength, self.load_speed) + of(start_strength, start_speed);
        }
        let rates = out.iter().zip(&self.size).map(|(limit, size)| limit / size);
        rates.fold(0.0, f64::max)
    }
}

/// What a motion from this state begins with; `None` where the system shows no matrices.
pub(super) fn start(system: &dyn System, state: &State) -> Option<Start> {
    let operators = system.as_linear()?.operators();
    let (mut energy, mut fastest) = (0.0_f64, 0.0_f64);
    let layers = operators.stiffness().layers().count();
    for cell in 0..operators.stiffness().pattern().cells() {
        let components = cell * layers..(cell + 1) * layers;
        let mass = &operators.mass()[components.clone()];
        let kinetic = mass.iter().zip(&state.v[components]);
        let kinetic: f64 = kinetic.map(|(mass, v)| 0.5 * mass * v * v).sum();
        let (elastic, size) = elastic_energy(operators, &state.u, cell);
        energy += kinetic + elastic;
        let lightest = mass.iter().copied().fold(f64::INFINITY, f64::min);
        fastest = fastest.max(2.0 * (kinetic + size) / lightest);
    }
    Some(Start {
        system: system.revision(),
        energy: energy.max(0.0),
        speed: fastest.sqrt(),
    })
}

/// A cell's share of the elastic energy (J), and the same with all its parts taken as positive: with
/// `R_i` the sum of the blocks of row i,
/// `u'Ku/2 = sum_i (u_i' R_i u_i/2 - sum_j (u_i - u_j)' K_ij (u_i - u_j)/4)`, where all parts of a spring
/// network are energies of its springs.
fn elastic_energy(operators: &LinearOperators, u: &[f64], cell: usize) -> (f64, f64) {
    let stiffness = operators.stiffness();
    let layers = stiffness.layers().count();
    let at = |cell: usize, layer: usize| u[cell * layers + layer];
    let form = |block: &[f64], x: &[f64; 3]| -> f64 {
        let entries = block.iter().enumerate();
        entries
            .map(|(k, entry)| x[k / layers] * entry * x[k % layers])
            .sum()
    };
    let mut row_sum = [0.0; 9];
    let (mut energy, mut size) = (0.0, 0.0);
    let mut add = |part: f64| {
        energy += part;
        size += part.abs();
    };
    for (column, block) in stiffness.row_blocks(cell) {
        for (sum, entry) in row_sum.iter_mut().zip(block) {
            *sum += entry;
        }
        if column != cell {
            let mut apart = [0.0; 3];
            for (layer, apart) in apart.iter_mut().enumerate().take(layers) {
                *apart = at(cell, layer) - at(column, layer);
            }
            add(-form(block, &apart) / 4.0);
        }
    }
    let mut own = [0.0; 3];
    for (layer, own) in own.iter_mut().enumerate().take(layers) {
        *own = at(cell, layer);
    }
    add(form(&row_sum[..layers * layers], &own) / 2.0);
    (energy, size)
}

//! Memory that a program moves.

use sinew_core::Layers;

use super::{Clamp, Forces, Program, Quotient, Register, Sweep, When};

/// Memory that a step transfers for each cell, with constant loads and in a step that is not the last of a batch.
///
/// Counted for a machine that passes once over the cells in each sweep: every register (and the mass, if used) that the
/// pass reads counts as one vector read, every one that it writes as one vector written, for any number of accesses; q
/// and the values that neighbours read again stay in cache. A product transfers each block of the matrix once, with the
/// number of its column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Vectors read, one value for each layer of a cell.
    pub read: usize,
    /// Vectors written.
    pub written: usize,
    /// Products with K or with the dashpots.
    pub products: usize,
    /// Sweeps that read one block of P^-1 for each cell.
    pub own_blocks: usize,
}

/// Bytes of a number.
const NUMBER: f64 = 8.0;

/// Bytes of the number of a block's column.
const COLUMN: f64 = 4.0;

impl Traffic {
    /// Bytes of vectors for each cell.
    #[must_use]
    pub fn vector_bytes(&self, layers: Layers) -> f64 {
        NUMBER * (layers.count() * (self.read + self.written)) as f64
    }

    /// Bytes of blocks for each cell of a matrix with `blocks_a_row` blocks a row.
    #[must_use]
    pub fn block_bytes(&self, layers: Layers, blocks_a_row: f64) -> f64 {
        let block = NUMBER * (layers.count() * layers.count()) as f64;
        self.products as f64 * blocks_a_row * (block + COLUMN) + self.own_blocks as f64 * block
    }
}

impl Program {
    /// Memory traffic of a step of the caller.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        let always = self.step.iter().filter(|sweep| sweep.when == When::Always);
        let mut sum = Traffic::default();
        for sweep in always {
            let one = of_sweep(sweep);
            sum.read += one.read;
            sum.written += one.written;
            sum.products += one.products;
            sum.own_blocks += one.own_blocks;
        }
        let repeats = self.repeats as usize;
        Traffic {
            read: repeats * sum.read,
            written: repeats * sum.written,
            products: repeats * sum.products,
            own_blocks: repeats * sum.own_blocks,
        }
    }
}

fn of_sweep(sweep: &Sweep) -> Traffic {
    let mut read: Vec<Register> = Vec::new();
    let mut written: Vec<Register> = Vec::new();
    let mut mass = sweep.quotient == Quotient::Mass;
    let mut products = 0;
    // What the pass wrote before is still in cache.
    let see = |register: Register, written: &[Register], read: &mut Vec<Register>| {
        if !written.contains(&register) && !read.contains(&register) {
            read.push(register);
        }
    };
    match sweep.forces {
        Forces::Products {
            stiffness,
            dashpots,
        } => {
            for product in [stiffness, dashpots].into_iter().flatten() {
                see(product.source, &written, &mut read);
                products += 1;
            }
        }
        Forces::Internal { u, v } => {
            see(u, &written, &mut read);
            see(v, &written, &mut read);
        }
    }
    for term in &sweep.own {
        see(term.register, &written, &mut read);
        mass |= term.per_mass != 0.0;
    }
    for update in sweep.updates.iter().filter(|update| !update.last_only) {
        for term in &update.terms {
            see(term.register, &written, &mut read);
        }
        if let Some(Clamp::Vector {
            from: Some(from), ..
        }) = update.clamp
        {
            see(from, &written, &mut read);
        }
        if !written.contains(&update.target) {
            written.push(update.target);
        }
    }
    Traffic {
        read: read.len() + usize::from(mass),
        written: written.len(),
        products,
        own_blocks: usize::from(sweep.quotient == Quotient::Blocks),
    }
}

#[cfg(test)]
mod tests {
    use sinew_core::VelocityTime;

    use super::*;
    use crate::{LoadAt, Physics};

    #[test]
    fn a_leapfrog_reads_u_v_and_the_mass_and_writes_u_and_v() {
        let (u, v) = (Register::U, Register::V);
        let mut program = Program::new(VelocityTime::Same);
        let force = program.net_force(&Physics::undamped(), u, v, LoadAt::StartOf);
        program
            .step
            .push(force.then(v.plus_q(0.1)).then(u.plus(0.1, v)));
        let expected = Traffic {
            read: 3,
            written: 2,
            products: 1,
            own_blocks: 0,
        };
        assert_eq!(program.traffic(), expected);
        assert_eq!(expected.vector_bytes(Layers::Three), 120.0);
        assert_eq!(expected.block_bytes(Layers::Three, 15.0), 15.0 * 76.0);
        assert_eq!(program.repeated(3).traffic().read, 9);
    }
}

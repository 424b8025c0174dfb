//! Work of each cell on the result of a sweep.

use std::ops::Range;

use sinew_core::{State, clamp_vector};

use super::combine::{Bound, Follower, MOST, combine};
use super::host::FollowedLoad;
use crate::program::{Clamp, OwnTerm, Program, Quotient, Register, Sweep, Update};

/// Degrees of freedom over which a cell's map runs at a time, so that they stay in the first cache;
/// whole cells of one and of three layers.
const CHUNK: usize = 768;

/// The registers of all cells.
pub(super) struct Registers<'a> {
    pub(super) state: &'a mut State,
    /// All registers except those of the state.
    pub(super) own: &'a mut [Vec<f64>],
}

impl Registers<'_> {
    pub(super) fn get(&self, register: Register) -> &[f64] {
        match register {
            Register::U => &self.state.u,
            Register::V => &self.state.v,
            Register::A => &self.state.a,
            own => &self.own[own.index() - 3],
        }
    }

    fn get_mut(&mut self, register: Register) -> &mut Vec<f64> {
        match register {
            Register::U => &mut self.state.u,
            Register::V => &mut self.state.v,
            Register::A => &mut self.state.a,
            own => &mut self.own[own.index() - 3],
        }
    }

    /// Takes a register out, so that others can be read while it is written.
    fn take(&mut self, register: Register) -> Vec<f64> {
        std::mem::take(self.get_mut(register))
    }

    fn put(&mut self, register: Register, values: Vec<f64>) {
        *self.get_mut(register) = values;
    }
}

/// All cells after a sweep.
pub(super) struct Cells<'a> {
    pub(super) program: &'a Program,
    pub(super) registers: Registers<'a>,
    /// rho before it is completed, then q.
    pub(super) q: &'a mut [f64],
    pub(super) mass: &'a [f64],
    pub(super) layers: usize,
    /// The load that weights follow.
    pub(super) followed: &'a FollowedLoad,
}

/// The degrees of freedom of a chunk at which a clamp was reached.
struct Reached {
    any: bool,
    /// 0 or 1 for each degree of freedom.
    dofs: [u64; CHUNK],
}

impl Reached {
    /// Returns their number and unmarks them.
    fn take(&mut self) -> u64 {
        if !std::mem::take(&mut self.any) {
            return 0;
        }
        let count = self.dofs.iter().sum();
        self.dofs.fill(0);
        count
    }
}

impl Cells<'_> {
    /// Completes rho, computes q from it and then executes the updates; returns the number of degrees of freedom at
    /// which a clamp was reached.
    pub(super) fn finish(&mut self, sweep: &Sweep, is_last: bool) -> u64 {
        let mut saturated = 0;
        let mut reached = Reached {
            any: false,
            dofs: [0; CHUNK],
        };
        for from in (0..self.q.len()).step_by(CHUNK) {
            let range = from..(from + CHUNK).min(self.q.len());
            self.finish_rho(sweep, range.clone());
            let made = |update: &&Update| is_last || !update.last_only;
            self.update(sweep.updates.iter().filter(made), range, &mut reached);
            saturated += reached.take();
        }
        saturated
    }

    /// Executes updates that neither need q nor have clamps.
    pub(super) fn enter(&mut self, updates: &[Update]) {
        let mut reached = Reached {
            any: false,
            dofs: [0; CHUNK],
        };
        let dofs = self.registers.state.u.len();
        self.update(updates.iter(), 0..dofs, &mut reached);
    }

    /// Completes rho with the cell's own terms and computes q from it.
    fn finish_rho(&mut self, sweep: &Sweep, range: Range<usize>) {
        let (q, mass) = (&mut self.q[range.clone()], &self.mass[range.clone()]);
        // The last term and the division share a pass.
        let (with_quotient, own) = match sweep.own.split_last() {
            Some((last, own)) if sweep.quotient == Quotient::Mass => (Some(last), own),
            _ => (None, &sweep.own[..]),
        };
        let registers = &self.registers;
        let each = |term: &OwnTerm| registers.get(term.register)[range.clone()].iter();
        for term in own {
            for ((q, m), r) in q.iter_mut().zip(mass).zip(each(term)) {
                *q += (term.plain + term.per_mass * m) * r;
            }
        }
        match (sweep.quotient, with_quotient, &self.program.blocks) {
            (Quotient::Mass, Some(term), _) => {
                for ((q, m), r) in q.iter_mut().zip(mass).zip(each(term)) {
                    *q = (*q + (term.plain + term.per_mass * m) * r) / m;
                }
            }
            (Quotient::Mass, None, _) => q.iter_mut().zip(mass).for_each(|(q, m)| *q /= m),
            (Quotient::Blocks, _, Some(blocks)) => {
                blocks.multiply_in_place(range.start / self.layers, q);
            }
            (Quotient::Plain | Quotient::Blocks, _, _) => {}
        }
    }

    /// Executes updates on a range of degrees of freedom, two in a pass if the second allows it.
    fn update<'u>(
        &mut self,
        updates: impl Iterator<Item = &'u Update>,
        range: Range<usize>,
        reached: &mut Reached,
    ) {
        let mut updates = updates.peekable();
        while let Some(update) = updates.next() {
            let next = updates.next_if(|next| next.follows(update));
            self.pass(update, next, range.clone(), reached);
            if let Some(Clamp::Vector { from, factor }) = update.clamp {
                self.clamp(update.target, from, factor, range.clone(), reached);
            }
        }
    }

    /// Executes an update, and one that follows it, in one pass.
    fn pass(
        &mut self,
        update: &Update,
        next: Option<&Update>,
        range: Range<usize>,
        reached: &mut Reached,
    ) {
        let mut target = self.registers.take(update.target);
        let mut moved = next.map_or(Vec::new(), |next| self.registers.take(next.target));
        let out = &mut target[range.clone()];
        // What the target itself weighs has to be known before it is written for the first time.
        let mut own = update.weight_of(update.target, self.followed);
        let mut parts: [(f64, &[f64]); MOST] = [(0.0, &[]); MOST];
        let mut count = 0;
        let others = update.terms.iter();
        let others = others.filter(|term| term.register != update.target);
        let others = others.map(|term| {
            let values = self.registers.get(term.register);
            (self.followed.weight(term.weight), &values[range.clone()])
        });
        let of_q = (update.of_q != 0.0).then(|| (update.of_q, &self.q[range.clone()]));
        for part in others.chain(of_q) {
            if count == MOST {
                combine(out, own, &parts, None, None);
                (own, count) = (Some(1.0), 0);
            }
            parts[count] = part;
            count += 1;
        }
        let bound = match update.clamp {
            Some(Clamp::Component(limit)) => Some(Bound {
                limit,
                reached: &mut reached.dofs,
            }),
            _ => None,
        };
        let follower = next.map(|next| {
            let weight = |register| next.weight_of(register, self.followed).unwrap_or(0.0);
            Follower {
                out: &mut moved[range.clone()],
                own: weight(next.target),
                weight: weight(update.target),
            }
        });
        reached.any |= combine(out, own, &parts[..count], bound, follower);
        self.registers.put(update.target, target);
        if let Some(next) = next {
            self.registers.put(next.target, moved);
        }
    }

    /// Bounds the vectors of a range of cells, measured from a register or from 0, to `factor` times
    /// their limits.
    fn clamp(
        &mut self,
        target: Register,
        from: Option<Register>,
        factor: f64,
        range: Range<usize>,
        reached: &mut Reached,
    ) {
        let Some(limits) = &self.program.limits else {
            return;
        };
        let layers = self.layers;
        let mut values = self.registers.take(target);
        let from = from.map(|from| self.registers.get(from));
        let cells = range.start / layers..range.end / layers;
        for (cell, dofs) in cells.zip(reached.dofs.chunks_exact_mut(layers)) {
            let at = cell * layers..(cell + 1) * layers;
            let from = from.map(|from| &from[at.clone()]);
            if clamp_vector(&mut values[at], from, factor * limits[cell]) {
                dofs.fill(1);
                reached.any = true;
            }
        }
        self.registers.put(target, values);
    }
}

impl Update {
    /// The weight of a register, if it is read.
    fn weight_of(&self, register: Register, followed: &FollowedLoad) -> Option<f64> {
        let terms = self.terms.iter();
        let terms = terms.filter(|term| term.register == register);
        terms
            .map(|term| followed.weight(term.weight))
            .reduce(|a, b| a + b)
    }

    /// True if this update is `next <- own next + weight target` after an update `target <- ..` that does not read
    /// `next`, so that one pass can execute both.
    fn follows(&self, before: &Self) -> bool {
        let reads = |register| before.terms.iter().any(|term| term.register == register);
        let [own, of_before] = &self.terms[..] else {
            return false;
        };
        own.register == self.target
            && of_before.register == before.target
            && self.target != before.target
            && self.of_q == 0.0
            && self.clamp.is_none()
            && !matches!(before.clamp, Some(Clamp::Vector { .. }))
            && !reads(self.target)
    }
}

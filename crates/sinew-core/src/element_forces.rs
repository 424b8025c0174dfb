//! Element forces, for machines that store a motion in a format of their own.

use std::fmt::Debug;
use std::ops::Range;

use sinew_sparse::simd::InstructionSet;
use sinew_sparse::sweep::{Fields, Numbering, Precision};

use crate::evaluation_error::EvaluationError;
use crate::load_time::LoadTime;
use crate::operators::LinearOperators;

/// The part of a force law that machines with threads and vectors compute: element forces, in addition to matrices.
///
/// The law's net force is `f_ext - K u - (alpha M + E) v - f(u)`: M, K, alpha, the dashpots E and the loads are those of
/// [`ElementForces::operators`], which has no stiffness damping, and f is the sum over the elements.
pub trait ElementForces: Send + Sync {
    /// The matrices and loads, and so the cells.
    fn operators(&self) -> &LinearOperators;

    /// All cells, in the order in which their forces are completed.
    fn order(&self) -> Vec<u32>;

    /// Number of elements.
    fn elements(&self) -> usize;

    /// The sweep in double precision.
    fn in_double(&self, shape: SweepShape<'_>) -> Box<dyn ElementSweep<f64>>;

    /// The sweep in single precision.
    fn in_single(&self, shape: SweepShape<'_>) -> Box<dyn ElementSweep<f32>>;
}

/// Requirements of a machine for a sweep over elements.
#[derive(Clone, Copy, Debug)]
pub struct SweepShape<'a> {
    /// The position of each cell in the machine's vectors.
    pub numbering: &'a Numbering,
    /// The instructions.
    pub set: InstructionSet,
    /// Parts that threads may compute at the same time.
    pub parts: usize,
}

/// A sweep over elements, with its buffers: displacements are read, forces computed pass by pass, and then written.
/// The bits do not depend on the number of parts.
///
/// # Safety
/// Each of the three unsafe functions is called by several threads, each for disjoint positions or parts, and none
/// begins before the one before has finished on all threads; no other code uses the memory that they read or write
/// meanwhile.
#[allow(unsafe_code, reason = "one contract for all methods stands above")]
pub trait ElementSweep<T>: Debug + Send + Sync {
    /// Number of passes.
    fn passes(&self) -> usize;

    /// Number of parts of a pass.
    fn parts(&self, pass: usize) -> usize;

    /// Begins a sweep at a time.
    ///
    /// # Errors
    /// [`EvaluationError`] if a support follows an input that is missing from the inputs of the time.
    fn begin(&mut self, when: LoadTime<'_>) -> Result<(), EvaluationError>;

    /// Reads the displacement (m) at some positions from a vector.
    ///
    /// # Safety
    /// See [`ElementSweep`].
    unsafe fn take(&self, fields: &Fields<T>, source: usize, positions: Range<usize>);

    /// Computes a part of a pass; returns false if the law is undefined for one of its elements.
    ///
    /// # Safety
    /// See [`ElementSweep`].
    unsafe fn make(&self, pass: usize, part: usize) -> bool;

    /// Writes the forces (N) at some positions to a vector.
    ///
    /// # Safety
    /// See [`ElementSweep`].
    unsafe fn give(&self, fields: &Fields<T>, out: usize, positions: Range<usize>);

    /// The error for displacements that the law is not defined for: the same for any number of parts.
    fn refusal(&mut self) -> EvaluationError;
}

/// Makes a whole sweep by the calling thread: from the displacement in one vector to the forces in another.
///
/// # Errors
/// [`EvaluationError`] if the law is not defined for the displacement.
#[allow(unsafe_code, reason = "nobody else uses what is borrowed")]
pub fn sweep_alone<T: ElementPrecision>(
    sweep: &mut dyn ElementSweep<T>,
    fields: &mut Fields<T>,
    [source, out]: [usize; 2],
    when: LoadTime<'_>,
) -> Result<(), EvaluationError> {
    sweep.begin(when)?;
    let all = 0..fields.positions();
    // SAFETY: both are borrowed for this call alone, and everything is done in its order.
    unsafe {
        sweep.take(fields, source, all.clone());
        for pass in 0..sweep.passes() {
            for part in 0..sweep.parts(pass) {
                if !sweep.make(pass, part) {
                    return Err(sweep.refusal());
                }
            }
        }
        sweep.give(fields, out, all);
    }
    Ok(())
}

/// Precisions that forces of elements are computed in.
pub trait ElementPrecision: Precision {
    /// The sweep in this precision.
    fn sweep_of(forces: &dyn ElementForces, shape: SweepShape<'_>) -> Box<dyn ElementSweep<Self>>;
}

impl ElementPrecision for f64 {
    fn sweep_of(forces: &dyn ElementForces, shape: SweepShape<'_>) -> Box<dyn ElementSweep<Self>> {
        forces.in_double(shape)
    }
}

impl ElementPrecision for f32 {
    fn sweep_of(forces: &dyn ElementForces, shape: SweepShape<'_>) -> Box<dyn ElementSweep<Self>> {
        forces.in_single(shape)
    }
}

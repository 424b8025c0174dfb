//! Progress of a run and its extremes so far.

use serde::{Deserialize, Serialize};
use sinew_core::StepReport;
use sinew_fem::{DeformedTet, stress};
use sinew_scene::Overlap;

use crate::balance::Sums;
use crate::seal::Seal;
use crate::taken_energy::Taken;
use crate::tool_rows::Received;

/// Progress of a run and its extremes so far: all data that cannot be computed from later steps.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Progress {
    /// Steps taken.
    pub(crate) steps: usize,
    /// Frames of fields written.
    pub(crate) frames: usize,
    pub(crate) work: Work,
    pub(crate) seals: Seals,
    pub(crate) energy: Sums,
    pub(crate) seen: Seen,
    /// Kinetic energy (J), the largest and the last.
    pub(crate) kinetic: [f64; 2],
    /// The largest sum of kinetic and elastic energy (J), and the largest remainder of the balance.
    pub(crate) balance: [f64; 2],
    #[serde(default)]
    pub(crate) crept: Crept,
    #[serde(default)]
    pub(crate) taken: Taken,
    /// Impulses that tools had received at their last row.
    #[serde(default)]
    pub(crate) received: Received,
}

/// Energy (J) that accumulates slowly, measured by the remainder of the balance while loads and supports stay constant:
/// the work of changing loads is computed from the mean of two rows, and wrong by some per cent if these are far apart.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Crept {
    /// Rows since a load or a support changed.
    rows: u32,
    /// The largest remainder in the first rows: the energy of a leapfrog oscillates from step to step.
    first: f64,
    /// Mean remainder over the last rows.
    mean: f64,
    /// The largest excess of that mean over the first rows.
    pub(crate) most: f64,
}

impl Crept {
    /// Number of rows that count as the first.
    const FIRST: u32 = 4;

    /// Number of rows of the mean.
    const MEAN: f64 = 8.0;

    /// Adds a row; `has_changed` is true if loads or supports changed before it.
    pub(crate) fn see(&mut self, remainder: f64, has_changed: bool) {
        if has_changed || self.rows == 0 {
            (self.rows, self.first, self.mean) = (1, remainder, remainder);
            return;
        }
        self.mean += (remainder - self.mean) / Self::MEAN;
        if self.rows < Self::FIRST {
            self.first = self.first.max(remainder);
        }
        self.rows = self.rows.saturating_add(1);
        self.most = self.most.max(self.mean - self.first);
    }
}

/// Seals of the files that a run has written.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Seals {
    pub(crate) probes: Seal,
    pub(crate) energy: Seal,
    pub(crate) reactions: Seal,
    pub(crate) tools: Seal,
    /// Seals of the frames of fields, one each.
    pub(crate) frames: Vec<Seal>,
}

/// Extremes of the motion at the instants of the fields.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Seen {
    pub(crate) displacement: Largest,
    pub(crate) strain: Largest,
    /// The rotation (rad).
    pub(crate) rotation: Largest,
    /// The strain in linear regions, where it must be small.
    pub(crate) linear_strain: Largest,
    /// The rotation (rad) in linear regions.
    pub(crate) linear_rotation: Largest,
    /// Largest number of tetrahedra with a volume of 0 or below at an instant.
    pub(crate) inverted: usize,
    /// Deepest overlap of the body with itself.
    #[serde(default)]
    pub(crate) overlap: Option<SeenOverlap>,
}

/// An [`Overlap`] in the format of a checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct SeenOverlap {
    depth: f64,
    t: f64,
    at: [f64; 3],
    node: u64,
    parts: [String; 2],
}

impl Seen {
    /// Records the deformation of a tetrahedron at the time `t` (s), apart from inversion.
    pub(crate) fn see_tet(&mut self, t: f64, tet: &DeformedTet, tag: impl Fn() -> u64 + Copy) {
        see_strain(&mut self.strain, t, &tet.strain, tag);
        self.rotation.see(tet.rotation, t, tag);
        if !tet.is_hyperelastic {
            self.see_linear_tet(t, (&tet.strain, tet.rotation), tag);
        }
    }

    /// Updates the extremes of linear regions by the strain and the rotation (rad) of a tetrahedron.
    pub(crate) fn see_linear_tet(
        &mut self,
        t: f64,
        (strain, rotation): (&[f64; 6], f64),
        tag: impl Fn() -> u64 + Copy,
    ) {
        see_strain(&mut self.linear_strain, t, strain, tag);
        self.linear_rotation.see(rotation, t, tag);
    }

    /// Stores an overlap if it is deeper than the deepest so far.
    pub(crate) fn see_overlap(&mut self, overlap: Option<&Overlap>) {
        let known = self.overlap.as_ref().map_or(0.0, |known| known.depth);
        if let Some(overlap) = overlap.filter(|overlap| overlap.depth > known) {
            let Overlap {
                depth,
                t,
                at,
                node,
                parts,
            } = overlap.clone();
            self.overlap = Some(SeenOverlap {
                depth,
                t,
                at,
                node,
                parts,
            });
        }
    }

    /// The deepest overlap.
    pub(crate) fn overlap(&self) -> Option<Overlap> {
        let SeenOverlap {
            depth,
            t,
            at,
            node,
            parts,
        } = self.overlap.clone()?;
        Some(Overlap {
            depth,
            t,
            at,
            node,
            parts,
        })
    }
}

/// Updates a largest principal strain by that of a tetrahedron.
fn see_strain(largest: &mut Largest, t: f64, strain: &[f64; 6], tag: impl Fn() -> u64) {
    let [xx, yy, zz, xy, yz, zx] = *strain;
    // No principal strain is larger than this norm.
    let norm = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx);
    if norm > largest.value.powi(2) {
        largest.see(stress::largest_principal(strain), t, tag);
    }
}

/// A largest value with its time (s) and the tag of its node or tetrahedron.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Largest {
    pub(crate) value: f64,
    pub(crate) t: f64,
    pub(crate) at: u64,
}

impl Largest {
    /// Stores a value if it is larger than the largest so far.
    pub(crate) fn see(&mut self, value: f64, t: f64, at: impl FnOnce() -> u64) {
        if value > self.value {
            *self = Self { value, t, at: at() };
        }
    }
}

/// Work of all steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Work {
    pub(crate) sweeps: u64,
    pub(crate) force_evaluations: u64,
    pub(crate) solves: u64,
    pub(crate) factorizations: u64,
    pub(crate) saturated: u64,
    #[serde(default)]
    pub(crate) newton_iterations: u64,
    #[serde(default)]
    pub(crate) projected_solves: u64,
    #[serde(default)]
    pub(crate) backtracks: u64,
    #[serde(default)]
    pub(crate) limiter_hits: u64,
    #[serde(default)]
    pub(crate) fallbacks: u64,
    #[serde(default)]
    pub(crate) retaken: u64,
}

impl Work {
    /// Share of the velocities of `steps` steps that were saturated.
    pub(crate) fn saturated_share(&self, steps: usize, dofs: usize) -> f64 {
        self.saturated as f64 / (steps * dofs).max(1) as f64
    }

    pub(crate) fn add(&mut self, of: StepReport) {
        self.sweeps += of.sweeps;
        self.force_evaluations += of.force_evaluations;
        self.solves += of.solves;
        self.factorizations += of.factorizations;
        self.saturated += of.saturated;
        self.newton_iterations += of.newton_iterations;
        self.projected_solves += of.projected_solves;
        self.backtracks += of.backtracks;
        self.limiter_hits += of.limiter_hits;
        self.fallbacks += of.fallbacks;
        self.retaken += of.retaken;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest energy that accumulated over rows of remainders; in the first `moved` rows supports move.
    fn most(moved: usize, remainders: impl IntoIterator<Item = f64>) -> f64 {
        let mut crept = Crept::default();
        for (row, remainder) in remainders.into_iter().enumerate() {
            crept.see(remainder, row < moved);
        }
        crept.most
    }

    #[test]
    fn energy_that_creeps_in_while_supports_rest_is_told() {
        let grown = (0..100).map(|row| 0.02 * f64::from((row - 40).max(0)) / 60.0);
        let found = most(30, grown);
        assert!((0.015..0.02).contains(&found), "{found}");
    }

    #[test]
    fn neither_swings_of_a_leapfrog_nor_means_over_a_motion_count() {
        let swings = (0..100).map(|row| 0.02 * f64::from(row).sin());
        assert!(most(0, swings) < 0.001);
        let off = (0..100).map(|row| 0.03 * (f64::from(row) / 10.0).min(1.0));
        assert_eq!(most(11, off), 0.0);
    }
}

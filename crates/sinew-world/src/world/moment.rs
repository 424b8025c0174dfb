//! Moments of a motion, to which it can go back.

use super::{Saved, World};
use crate::error::RestoreError;
#[cfg(doc)]
use crate::log::Log;
use crate::log::Mark;

/// A moment of the motion of one world.
#[derive(Clone, Debug)]
pub struct Moment {
    /// The motion without its log.
    saved: Saved,
    mark: Mark,
}

impl Moment {
    /// Number of bytes of its fields over the body, which are most of what it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.saved.bytes()
    }
}

impl World {
    /// The present moment of its motion, for [`World::go_back`]. In contrast to a result of [`World::save`] it belongs to
    /// this world alone, and does not copy the log, which may be long.
    #[must_use]
    pub fn moment(&self) -> Moment {
        Moment {
            saved: self.saved_with(Vec::new()),
            mark: self.log.mark(),
        }
    }

    /// Goes back to a moment. The commands after it leave the log, so that a replay gives the motion that was kept;
    /// [`Log::went_back`] says so. A motion that has failed since then continues.
    ///
    /// # Errors
    /// [`RestoreError`]: [`RestoreError::OtherPast`] for a moment of another world, and for one that this world left by
    /// going back beyond it; the world is then unchanged.
    pub fn go_back(&mut self, to: &Moment) -> Result<(), RestoreError> {
        if !self.log.has(&to.mark) {
            return Err(RestoreError::OtherPast);
        }
        self.restore_without_log(&to.saved)?;
        self.log.shorten(&to.mark, self.state.t());
        Ok(())
    }
}

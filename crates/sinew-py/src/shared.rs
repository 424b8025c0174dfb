//! The world of a session, which its tools and loads share.

use std::ops::{Deref, DerefMut};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, TryLockError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use sinew::cli::memory_of;
use sinew_integrators::Memory;
use sinew_world::{Command, World};

use crate::errors::of_command;
use crate::guard::{guarded, guarded_here, unusable};

/// A world that threads of Python take turns with.
pub(crate) struct Shared {
    world: Mutex<World>,
    /// Memory limit of factors.
    memory: Memory,
    /// The thread that has its turn, or 0.
    owner: AtomicUsize,
}

/// The turn of a thread.
struct Turn<'s> {
    world: MutexGuard<'s, World>,
    owner: &'s AtomicUsize,
}

impl Shared {
    pub(crate) fn new(world: World) -> Self {
        Self {
            memory: memory_of(world.scene().scene()),
            world: Mutex::new(world),
            owner: AtomicUsize::new(0),
        }
    }

    /// Runs a short query on the world.
    pub(crate) fn with<T>(
        &self,
        py: Python<'_>,
        ask: impl FnOnce(&mut World) -> PyResult<T>,
    ) -> PyResult<T> {
        self.check_owner()?;
        loop {
            match self.world.try_lock() {
                Ok(world) => {
                    let mut turn = self.turn(world);
                    return guarded_here(|| ask(&mut turn));
                }
                Err(TryLockError::Poisoned(_)) => return Err(unusable()),
                // Another thread takes steps, and needs the interpreter to look for signals.
                Err(TryLockError::WouldBlock) => py.detach(|| drop(self.world.lock())),
            }
        }
    }

    /// Lets the world work while other threads of Python run.
    pub(crate) fn work<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut World) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        self.check_owner()?;
        py.detach(|| {
            guarded(|| {
                let world = self.world.lock().map_err(|_| unusable())?;
                self.memory.within(|| act(&mut self.turn(world)))
            })
        })
    }

    /// Gives the world a command.
    pub(crate) fn command(&self, py: Python<'_>, command: Command) -> PyResult<()> {
        self.work(py, |world| world.command(command).map_err(of_command))
    }

    fn turn<'s>(&'s self, world: MutexGuard<'s, World>) -> Turn<'s> {
        self.owner.store(this_thread(), Ordering::Relaxed);
        let owner = &self.owner;
        Turn { world, owner }
    }

    /// Refuses a handler of a signal that came while this thread has its turn: it would wait for itself.
    fn check_owner(&self) -> PyResult<()> {
        match self.owner.load(Ordering::Relaxed) == this_thread() {
            false => Ok(()),
            true => Err(PyRuntimeError::new_err(
                "this session is at work in this thread: a handler of a signal cannot use it",
            )),
        }
    }
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.owner.store(0, Ordering::Relaxed);
    }
}

impl Deref for Turn<'_> {
    type Target = World;

    fn deref(&self) -> &World {
        &self.world
    }
}

impl DerefMut for Turn<'_> {
    fn deref_mut(&mut self) -> &mut World {
        &mut self.world
    }
}

/// A number that no other living thread has; not 0.
fn this_thread() -> usize {
    thread_local!(static PLACE: u8 = const { 0 });
    PLACE.with(|place| std::ptr::from_ref(place).addr())
}

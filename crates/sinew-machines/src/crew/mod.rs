//! Threads that share the chunks of a sweep.

mod patience;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::thread::{self, Thread};
use std::time::Instant;

use sinew_sparse::sweep::Outcome;

pub(crate) use patience::Patience;

/// Chunks that are taken at a time, where each thread has as many.
const BLOCK: usize = 4;

/// Checks for work, or for its end, before a thread lets others run: some tens of microseconds.
const SPINS: u32 = 4_000;

/// Times that the host lets others run before it sleeps.
const YIELDS: u32 = 20;

/// Threads that take part in sweeps for as long as a batch lasts. Every chunk is computed by one thread, whichever;
/// each begins with its own share, so that its rows stay in its cache, and then takes what others have left. So a
/// thread that gets no processor delays none but the chunks it is at. Where others cost more time than they save, the
/// host continues alone ([`Patience`]).
pub(crate) struct Crew<'a> {
    work: &'a (dyn Fn(Range<usize>) -> Outcome + Sync),
    /// Chunks of the present sweep.
    chunks: AtomicUsize,
    /// Chunks that are taken at a time.
    block: AtomicUsize,
    /// Remaining chunks of each thread's share.
    left: Vec<Left>,
    /// Chunks that are done.
    done: AtomicUsize,
    /// Number of the sweep.
    turn: AtomicUsize,
    closed: AtomicBool,
    /// One flag per worker: true while it sleeps.
    asleep: Vec<AtomicBool>,
    host: Thread,
    /// True while the host sleeps until all chunks are done.
    host_asleep: AtomicBool,
    saturated: AtomicU64,
    exceeded: AtomicBool,
}

/// The thread that hands out sweeps.
pub(crate) struct Host<'a> {
    work: &'a (dyn Fn(Range<usize>) -> Outcome + Sync),
    /// `None` where the host is alone.
    crew: Option<&'a Crew<'a>>,
    workers: Vec<Thread>,
    patience: &'a mut Patience,
}

/// Time since a moment (s).
fn since(moment: Instant) -> f64 {
    moment.elapsed().as_secs_f64()
}

impl<'a> Crew<'a> {
    /// Runs `body` with `threads` threads, the host included, for sweeps whose chunks are made by `work`.
    pub(crate) fn gather<R>(
        (threads, patience): (usize, &mut Patience),
        work: &'a (dyn Fn(Range<usize>) -> Outcome + Sync),
        body: impl FnOnce(&mut Host<'_>) -> R,
    ) -> R {
        if threads <= 1 {
            return body(&mut Host {
                work,
                crew: None,
                workers: Vec::new(),
                patience,
            });
        }
        let begun = Instant::now();
        let crew = Crew {
            work,
            chunks: AtomicUsize::new(0),
            block: AtomicUsize::new(BLOCK),
            left: (0..threads).map(|_| Left::none()).collect(),
            done: AtomicUsize::new(0),
            turn: AtomicUsize::new(0),
            closed: AtomicBool::new(false),
            asleep: (1..threads).map(|_| AtomicBool::new(false)).collect(),
            host: thread::current(),
            host_asleep: AtomicBool::new(false),
            saturated: AtomicU64::new(0),
            exceeded: AtomicBool::new(false),
        };
        let (result, ended) = thread::scope(|scope| {
            let workers = (1..threads).map_while(|worker| {
                let crew = &crew;
                let spawned =
                    thread::Builder::new().spawn_scoped(scope, move || crew.serve(worker));
                // Fewer threads do the same.
                Some(spawned.ok()?.thread().clone())
            });
            let mut host = Host {
                work,
                crew: Some(&crew),
                workers: workers.collect(),
                patience: &mut *patience,
            };
            host.patience.note_gathering(since(begun));
            // Also where `body` panics, so that no worker waits for ever.
            struct Close<'c>(&'c Crew<'c>, Vec<Thread>);
            impl Drop for Close<'_> {
                fn drop(&mut self) {
                    self.0.closed.store(true, Ordering::Release);
                    self.0.turn.fetch_add(1, Ordering::Release);
                    self.1.iter().for_each(Thread::unpark);
                }
            }
            let _close = Close(&crew, host.workers.clone());
            (body(&mut host), Instant::now())
        });
        patience.note_gathering(since(ended));
        result
    }

    /// Makes chunks of the present sweep until none is left.
    fn take_part(&self, thread: usize) {
        let threads = self.left.len();
        for other in (0..threads).map(|step| (thread + step) % threads) {
            while let Some(chunks) = self.left[other].take(self.block.load(Ordering::Relaxed)) {
                // Also where the work panics, so that the host does not wait for ever.
                let _done = Done(self, chunks.len());
                let outcome = (self.work)(chunks);
                self.saturated
                    .fetch_add(outcome.saturated, Ordering::Relaxed);
                self.exceeded.fetch_or(outcome.exceeded, Ordering::Relaxed);
            }
        }
    }

    /// Takes part in sweeps until the crew is closed.
    fn serve(&self, worker: usize) {
        let mut seen = 0;
        let mut spins = 0;
        while !self.closed.load(Ordering::Acquire) {
            let turn = self.turn.load(Ordering::Acquire);
            if turn != seen {
                (seen, spins) = (turn, 0);
                self.take_part(worker);
            } else if spins < SPINS {
                spins += 1;
                std::hint::spin_loop();
            } else {
                let asleep = &self.asleep[worker - 1];
                asleep.store(true, Ordering::SeqCst);
                if self.turn.load(Ordering::SeqCst) == seen {
                    thread::park();
                }
                asleep.store(false, Ordering::SeqCst);
                spins = 0;
            }
        }
    }
}

/// Remaining chunks of a share: the next chunk, and the end in the upper half of the same word, so that a thread that
/// comes late from the sweep before never takes the beginning of one share for that of another.
struct Left(AtomicU64);

impl Left {
    fn none() -> Self {
        Self(AtomicU64::new(0))
    }

    fn set(&self, share: Range<usize>) {
        let word = (share.end as u64) << 32 | share.start as u64;
        self.0.store(word, Ordering::Release);
    }

    /// Takes the next chunks, a block of them.
    fn take(&self, block: usize) -> Option<Range<usize>> {
        let mut word = self.0.load(Ordering::Acquire);
        loop {
            let (first, end) = ((word & u64::from(u32::MAX)) as usize, (word >> 32) as usize);
            if first >= end {
                return None;
            }
            let next = (first + block).min(end);
            let after = (end as u64) << 32 | next as u64;
            let exchange =
                self.0
                    .compare_exchange_weak(word, after, Ordering::AcqRel, Ordering::Acquire);
            match exchange {
                Ok(_) => return Some(first..next),
                Err(present) => word = present,
            }
        }
    }
}

/// A number of chunks that are done as soon as this is dropped.
struct Done<'a>(&'a Crew<'a>, usize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        let crew = self.0;
        let done = crew.done.fetch_add(self.1, Ordering::SeqCst) + self.1;
        if done == crew.chunks.load(Ordering::SeqCst) && crew.host_asleep.load(Ordering::SeqCst) {
            crew.host.unpark();
        }
    }
}

impl Host<'_> {
    /// Makes a prepared sweep over `chunks` chunks. Sweeps of a kind take about the same time a chunk.
    pub(crate) fn sweep(&mut self, kind: usize, chunks: usize) -> Outcome {
        let crew = self.crew.filter(|_| !self.patience.is_alone(kind));
        if crew.is_none() && !self.patience.is_alone(kind) {
            return (self.work)(0..chunks);
        }
        let begun = Instant::now();
        let outcome = match crew {
            Some(crew) => self.share(crew, chunks),
            None => (self.work)(0..chunks),
        };
        match crew {
            Some(_) => self.patience.note_shared(kind, chunks, since(begun)),
            None => self.patience.note_alone(kind, chunks, since(begun)),
        }
        outcome
    }

    fn share(&self, crew: &Crew<'_>, chunks: usize) -> Outcome {
        crew.saturated.store(0, Ordering::Relaxed);
        crew.exceeded.store(false, Ordering::Relaxed);
        crew.done.store(0, Ordering::Relaxed);
        crew.chunks.store(chunks, Ordering::SeqCst);
        let threads = crew.left.len();
        // Where there are few, each is worth a thread of its own.
        let block = if chunks > threads * BLOCK { BLOCK } else { 1 };
        crew.block.store(block, Ordering::Relaxed);
        for (thread, left) in crew.left.iter().enumerate() {
            left.set(chunks * thread / threads..chunks * (thread + 1) / threads);
        }
        crew.turn.fetch_add(1, Ordering::SeqCst);
        for (asleep, worker) in crew.asleep.iter().zip(&self.workers) {
            if asleep.load(Ordering::SeqCst) {
                worker.unpark();
            }
        }
        crew.take_part(0);
        wait(crew, chunks);
        Outcome {
            saturated: crew.saturated.load(Ordering::Relaxed),
            exceeded: crew.exceeded.load(Ordering::Relaxed),
        }
    }
}

/// Waits for the chunks that others are at.
fn wait(crew: &Crew<'_>, chunks: usize) {
    let mut looks = 0;
    while crew.done.load(Ordering::Acquire) < chunks {
        looks += 1;
        if looks <= SPINS {
            std::hint::spin_loop();
        } else if looks <= SPINS + YIELDS {
            thread::yield_now();
        } else {
            crew.host_asleep.store(true, Ordering::SeqCst);
            if crew.done.load(Ordering::SeqCst) < chunks {
                thread::park();
            }
            crew.host_asleep.store(false, Ordering::SeqCst);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU32;
    use std::time::Duration;

    use super::*;

    /// Sweeps of different lengths, since a worker may come late from the one before.
    #[test]
    fn every_chunk_of_every_sweep_is_made_once_whatever_the_number_of_threads() {
        for threads in [1, 2, 3, 8] {
            let made: Vec<AtomicU32> = (0..37).map(|_| AtomicU32::new(0)).collect();
            let work = |range: Range<usize>| {
                let mut outcome = Outcome::default();
                for chunk in range {
                    made[chunk].fetch_add(1, Ordering::Relaxed);
                    outcome += Outcome {
                        saturated: chunk as u64,
                        exceeded: chunk == 5,
                    };
                }
                outcome
            };
            Crew::gather((threads, &mut Patience::default()), &work, |host| {
                let mut expected = [0; 37];
                for sweep in 1..=3000 {
                    let chunks = [37, 2, 13][sweep % 3];
                    *host.patience = Patience::trusting();
                    let outcome = host.sweep(0, chunks);
                    let sum = chunks as u64 * (chunks as u64 - 1) / 2;
                    assert_eq!((outcome.saturated, outcome.exceeded), (sum, chunks > 5));
                    expected[..chunks].iter_mut().for_each(|count| *count += 1);
                    for (made, expected) in made.iter().zip(expected) {
                        let made = made.load(Ordering::Relaxed);
                        assert_eq!(made, expected, "{threads} threads, sweep {sweep}");
                    }
                }
            });
        }
    }

    /// Chunks of which each takes a while that a worker sleeps through: the host finds out, and makes the rest itself.
    #[test]
    fn sleeping_workers_are_not_waited_for_in_every_sweep() {
        let host = thread::current().id();
        let by_others = AtomicUsize::new(0);
        let work = |range: Range<usize>| {
            if thread::current().id() != host {
                by_others.fetch_add(range.len(), Ordering::Relaxed);
                thread::sleep(Duration::from_millis(5));
            } else {
                thread::sleep(Duration::from_micros(20));
            }
            Outcome::default()
        };
        let mut patience = Patience::default();
        let sweeps = 300;
        for _ in 0..10 {
            Crew::gather((2, &mut patience), &work, |host| {
                for _ in 0..sweeps / 10 {
                    host.sweep(0, 8);
                }
            });
        }
        // One sweep shows it: what it lost is fifty times as long as all others.
        assert!(by_others.load(Ordering::Relaxed) <= 8, "{by_others:?}");
    }
}

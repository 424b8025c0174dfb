//! Threads that share the chunks of a sweep.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::thread::{self, Thread};

use sinew_sparse::sweep::Outcome;

/// Chunks that are taken at a time.
const BLOCK: usize = 4;

/// Looks for work, or for its end, before a thread lets others run: some tens of microseconds.
const SPINS: u32 = 4_000;

/// Times that the host lets others run before it sleeps.
const YIELDS: u32 = 20;

/// Sweeps after which late workers are counted.
const WATCHED: u32 = 32;

/// Late sweeps of those for which the host goes on alone.
const MOST_LATE: u32 = 4;

/// Most sweeps that it goes on alone.
const LONGEST_ALONE: u32 = 4096;

/// Threads that take part in sweeps for as long as a batch lasts. Every chunk is computed by one thread,
/// whichever; each begins with its own share, so that its rows stay in its cache, and then takes what
/// others have left. So a thread that gets no processor delays none but the chunks it is at. Where
/// that happens often, the host goes on alone for a while, longer each time.
pub(crate) struct Crew<'a> {
    work: &'a (dyn Fn(Range<usize>) -> Outcome + Sync),
    chunks: usize,
    /// The next chunk of each thread's share.
    next: Vec<AtomicUsize>,
    /// Chunks that are done.
    done: AtomicUsize,
    /// Number of the sweep.
    turn: AtomicUsize,
    closed: AtomicBool,
    /// Whether each worker sleeps.
    asleep: Vec<AtomicBool>,
    host: Thread,
    /// Whether the host sleeps until all chunks are done.
    host_asleep: AtomicBool,
    saturated: AtomicU64,
    exceeded: AtomicBool,
}

/// The thread that hands out sweeps.
pub(crate) struct Host<'a> {
    work: &'a (dyn Fn(Range<usize>) -> Outcome + Sync),
    chunks: usize,
    /// `None` where the host is alone.
    crew: Option<&'a Crew<'a>>,
    workers: Vec<Thread>,
    watched: u32,
    late: u32,
    /// Sweeps that are still made alone, and how many the next time.
    alone: u32,
    next_alone: u32,
}

impl<'a> Crew<'a> {
    /// Runs `body` with so many threads, itself included, for sweeps over `chunks` chunks, each made by `work`.
    pub(crate) fn gather<R>(
        threads: usize,
        chunks: usize,
        work: &'a (dyn Fn(Range<usize>) -> Outcome + Sync),
        body: impl FnOnce(&mut Host<'_>) -> R,
    ) -> R {
        let mut host = Host {
            work,
            chunks,
            crew: None,
            workers: Vec::new(),
            watched: 0,
            late: 0,
            alone: 0,
            next_alone: WATCHED,
        };
        if threads <= 1 {
            return body(&mut host);
        }
        let crew = Crew {
            work,
            chunks,
            next: (0..threads)
                .map(|_| AtomicUsize::new(usize::MAX / 2))
                .collect(),
            done: AtomicUsize::new(0),
            turn: AtomicUsize::new(0),
            closed: AtomicBool::new(false),
            asleep: (1..threads).map(|_| AtomicBool::new(false)).collect(),
            host: thread::current(),
            host_asleep: AtomicBool::new(false),
            saturated: AtomicU64::new(0),
            exceeded: AtomicBool::new(false),
        };
        thread::scope(|scope| {
            let workers = (1..threads).map_while(|worker| {
                let crew = &crew;
                let spawned =
                    thread::Builder::new().spawn_scoped(scope, move || crew.serve(worker));
                // Fewer threads do the same.
                Some(spawned.ok()?.thread().clone())
            });
            let mut host = Host {
                crew: Some(&crew),
                workers: workers.collect(),
                ..host
            };
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
            body(&mut host)
        })
    }

    /// The chunks with which a thread begins.
    fn share(&self, thread: usize) -> Range<usize> {
        let of = |thread| self.chunks * thread / self.next.len();
        of(thread)..of(thread + 1)
    }

    /// Makes chunks of the present sweep until none is left.
    fn take_part(&self, thread: usize) {
        let threads = self.next.len();
        for other in (0..threads).map(|step| (thread + step) % threads) {
            let end = self.share(other).end;
            loop {
                let first = self.next[other].fetch_add(BLOCK, Ordering::AcqRel);
                if first >= end {
                    break;
                }
                let chunks = first..(first + BLOCK).min(end);
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

/// A number of chunks that are done as soon as this is dropped.
struct Done<'a>(&'a Crew<'a>, usize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        let crew = self.0;
        let done = crew.done.fetch_add(self.1, Ordering::SeqCst) + self.1;
        if done == crew.chunks && crew.host_asleep.load(Ordering::SeqCst) {
            crew.host.unpark();
        }
    }
}

impl Host<'_> {
    /// Makes a sweep that has been prepared.
    pub(crate) fn sweep(&mut self) -> Outcome {
        let crew = match self.crew {
            Some(crew) if self.alone == 0 => crew,
            _ => {
                self.alone = self.alone.saturating_sub(1);
                return (self.work)(0..self.chunks);
            }
        };
        crew.saturated.store(0, Ordering::Relaxed);
        crew.exceeded.store(false, Ordering::Relaxed);
        crew.done.store(0, Ordering::Relaxed);
        for (thread, next) in crew.next.iter().enumerate() {
            next.store(crew.share(thread).start, Ordering::Release);
        }
        crew.turn.fetch_add(1, Ordering::SeqCst);
        for (asleep, worker) in crew.asleep.iter().zip(&self.workers) {
            if asleep.load(Ordering::SeqCst) {
                worker.unpark();
            }
        }
        crew.take_part(0);
        self.wait(crew);
        Outcome {
            saturated: crew.saturated.load(Ordering::Relaxed),
            exceeded: crew.exceeded.load(Ordering::Relaxed),
        }
    }

    /// Waits for the chunks that others are at.
    fn wait(&mut self, crew: &Crew<'_>) {
        let mut looks = 0;
        while crew.done.load(Ordering::Acquire) < crew.chunks {
            looks += 1;
            if looks <= SPINS {
                std::hint::spin_loop();
            } else if looks <= SPINS + YIELDS {
                thread::yield_now();
            } else {
                crew.host_asleep.store(true, Ordering::SeqCst);
                if crew.done.load(Ordering::SeqCst) < crew.chunks {
                    thread::park();
                }
                crew.host_asleep.store(false, Ordering::SeqCst);
            }
        }
        self.watched += 1;
        self.late += u32::from(looks > SPINS);
        if self.late > MOST_LATE {
            self.alone = self.next_alone;
            self.next_alone = (2 * self.next_alone).min(LONGEST_ALONE);
            (self.watched, self.late) = (0, 0);
        } else if self.watched == WATCHED {
            (self.watched, self.late) = (0, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU32;

    use super::*;

    #[test]
    fn every_chunk_of_every_sweep_is_made_once_whatever_the_number_of_threads() {
        for threads in [1, 2, 3, 8] {
            let chunks = 37;
            let made: Vec<AtomicU32> = (0..chunks).map(|_| AtomicU32::new(0)).collect();
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
            Crew::gather(threads, chunks, &work, |host| {
                for sweep in 1..=2000 {
                    let outcome = host.sweep();
                    assert_eq!((outcome.saturated, outcome.exceeded), (36 * 37 / 2, true));
                    let all = made
                        .iter()
                        .all(|count| count.load(Ordering::Relaxed) == sweep);
                    assert!(all, "{threads} threads, sweep {sweep}");
                }
            });
        }
    }
}

//! Threads that share the chunks of a sweep.

mod patience;

use std::any::Any;
use std::fmt::{self, Debug};
use std::ops::Range;
use std::panic::{self, AssertUnwindSafe};
use std::ptr;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Thread};
use std::time::Instant;

use sinew_sparse::sweep::Outcome;

pub(crate) use patience::Patience;

/// Chunks that are taken at a time, if each thread has as many.
const BLOCK: usize = 4;

/// Checks for work, or for its end, before a thread lets others run: some tens of microseconds.
const SPINS: u32 = 4_000;

/// Times that the host lets others run before it sleeps.
const YIELDS: u32 = 20;

/// The chunks of sweeps, each of which any thread can compute.
pub(crate) trait Chunks: Send + Sync {
    /// Computes some chunks of the current sweep.
    fn make(&self, chunks: Range<usize>) -> Outcome;
}

/// Threads of a machine that take part in sweeps. They are started for the first batch that needs them, and sleep
/// between batches, so that a step starts none. Any thread may compute a chunk; each begins with its own share, so that
/// its rows stay in its cache, and then takes chunks that others have left. So a thread that gets no processor delays
/// only its current chunks. If the other threads cost more time than they save, the host continues alone
/// ([`Patience`]).
#[derive(Debug, Default)]
pub(crate) struct Crew {
    team: Option<Arc<Team>>,
    workers: Vec<Thread>,
    pub(crate) patience: Patience,
}

/// State that the threads of a crew share.
struct Team {
    work: Arc<dyn Chunks>,
    /// Threads that take part, the host included.
    threads: AtomicUsize,
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
    host: Mutex<Thread>,
    /// True while the host sleeps until all chunks are done.
    host_asleep: AtomicBool,
    saturated: AtomicU64,
    exceeded: AtomicBool,
    /// The panic of a worker, for the host.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

impl Debug for Team {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Team")
            .field("threads", &self.threads)
            .finish_non_exhaustive()
    }
}

/// The thread that hands out sweeps.
pub(crate) struct Host<'a> {
    work: &'a dyn Chunks,
    /// `None` if the host is alone.
    team: Option<(&'a Team, &'a [Thread])>,
    patience: &'a mut Patience,
}

/// Time since a moment (s).
fn since(moment: Instant) -> f64 {
    moment.elapsed().as_secs_f64()
}

impl Crew {
    /// A host with `threads` threads, itself included, for sweeps of `work`; fewer if no more can be started.
    pub(crate) fn gather<'a>(&'a mut self, threads: usize, work: &'a Arc<dyn Chunks>) -> Host<'a> {
        let begun = Instant::now();
        if threads > 1 && !self.is_ready(threads, work) {
            self.dismiss();
            self.start(threads, work);
        }
        let team = self.team.as_deref().filter(|_| threads > 1);
        if let Some(team) = team {
            team.threads
                .store(threads.min(1 + self.workers.len()), Ordering::Relaxed);
            *lock(&team.host) = thread::current();
            self.patience.note_gathering(since(begun));
        }
        Host {
            work: &**work,
            team: team.map(|team| (team, &*self.workers)),
            patience: &mut self.patience,
        }
    }

    fn is_ready(&self, threads: usize, work: &Arc<dyn Chunks>) -> bool {
        self.team.as_ref().is_some_and(|team| {
            ptr::addr_eq(Arc::as_ptr(&team.work), Arc::as_ptr(work)) && threads <= team.left.len()
        })
    }

    fn start(&mut self, threads: usize, work: &Arc<dyn Chunks>) {
        let team = Arc::new(Team {
            work: Arc::clone(work),
            threads: AtomicUsize::new(threads),
            chunks: AtomicUsize::new(0),
            block: AtomicUsize::new(BLOCK),
            left: (0..threads).map(|_| Left::none()).collect(),
            done: AtomicUsize::new(0),
            turn: AtomicUsize::new(0),
            closed: AtomicBool::new(false),
            asleep: (1..threads).map(|_| AtomicBool::new(false)).collect(),
            host: Mutex::new(thread::current()),
            host_asleep: AtomicBool::new(false),
            saturated: AtomicU64::new(0),
            exceeded: AtomicBool::new(false),
            panic: Mutex::new(None),
        });
        let workers = (1..threads).map_while(|worker| {
            let team = Arc::clone(&team);
            let started = thread::Builder::new().spawn(move || team.serve(worker));
            // Fewer threads do the same.
            Some(started.ok()?.thread().clone())
        });
        self.workers = workers.collect();
        self.team = Some(team);
    }

    /// Ends the threads without waiting for them: in a forked process they do not exist.
    fn dismiss(&mut self) {
        if let Some(team) = self.team.take() {
            team.closed.store(true, Ordering::Release);
            team.turn.fetch_add(1, Ordering::Release);
            self.workers.drain(..).for_each(|worker| worker.unpark());
        }
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        self.dismiss();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Team {
    /// Computes chunks of the present sweep until none is left.
    fn take_part(&self, thread: usize) {
        let threads = self.threads.load(Ordering::Relaxed);
        if thread >= threads {
            return;
        }
        for other in (0..threads).map(|step| (thread + step) % threads) {
            while let Some(chunks) = self.left[other].take(self.block.load(Ordering::Relaxed)) {
                // Also where the work panics, so that the host does not wait for ever.
                let _done = Done(self, chunks.len());
                let outcome = self.work.make(chunks);
                self.saturated
                    .fetch_add(outcome.saturated, Ordering::Relaxed);
                self.exceeded.fetch_or(outcome.exceeded, Ordering::Relaxed);
            }
        }
    }

    /// Takes part in sweeps until the crew is dismissed.
    fn serve(&self, worker: usize) {
        let mut seen = 0;
        let mut spins = 0;
        while !self.closed.load(Ordering::Acquire) {
            let turn = self.turn.load(Ordering::Acquire);
            if turn != seen {
                (seen, spins) = (turn, 0);
                let made = panic::catch_unwind(AssertUnwindSafe(|| self.take_part(worker)));
                if let Err(reason) = made {
                    lock(&self.panic).get_or_insert(reason);
                }
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
/// is late from the previous sweep never mistakes the beginning of one share for that of another.
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
struct Done<'a>(&'a Team, usize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        let team = self.0;
        let done = team.done.fetch_add(self.1, Ordering::SeqCst) + self.1;
        if done == team.chunks.load(Ordering::SeqCst) && team.host_asleep.load(Ordering::SeqCst) {
            lock(&team.host).unpark();
        }
    }
}

impl Host<'_> {
    /// Runs a prepared sweep over `chunks` chunks. Sweeps of one kind take about the same time per chunk.
    pub(crate) fn sweep(&mut self, kind: usize, chunks: usize) -> Outcome {
        let team = self.team.filter(|_| !self.patience.is_alone(kind));
        if team.is_none() && !self.patience.is_alone(kind) {
            return self.work.make(0..chunks);
        }
        let begun = Instant::now();
        match team {
            Some((team, workers)) => {
                let outcome = team.share(workers, chunks);
                self.patience.note_shared(kind, chunks, since(begun));
                outcome
            }
            None => {
                let outcome = self.work.make(0..chunks);
                self.patience.note_alone(kind, chunks, since(begun));
                outcome
            }
        }
    }
}

impl Team {
    /// Runs a sweep with the workers. Resumes the panic of a worker on this thread.
    fn share(&self, workers: &[Thread], chunks: usize) -> Outcome {
        self.saturated.store(0, Ordering::Relaxed);
        self.exceeded.store(false, Ordering::Relaxed);
        self.done.store(0, Ordering::Relaxed);
        self.chunks.store(chunks, Ordering::SeqCst);
        let threads = self.threads.load(Ordering::Relaxed);
        // Where there are few, each is worth a thread of its own.
        let block = if chunks > threads * BLOCK { BLOCK } else { 1 };
        self.block.store(block, Ordering::Relaxed);
        for (thread, left) in self.left[..threads].iter().enumerate() {
            left.set(chunks * thread / threads..chunks * (thread + 1) / threads);
        }
        self.turn.fetch_add(1, Ordering::SeqCst);
        for (asleep, worker) in self.asleep.iter().zip(workers).take(threads - 1) {
            if asleep.load(Ordering::SeqCst) {
                worker.unpark();
            }
        }
        self.take_part(0);
        self.wait(chunks);
        if let Some(reason) = lock(&self.panic).take() {
            panic::resume_unwind(reason);
        }
        Outcome {
            saturated: self.saturated.load(Ordering::Relaxed),
            exceeded: self.exceeded.load(Ordering::Relaxed),
        }
    }

    /// Waits for the chunks that other threads compute.
    fn wait(&self, chunks: usize) {
        let mut looks = 0;
        while self.done.load(Ordering::Acquire) < chunks {
            looks += 1;
            if looks <= SPINS {
                std::hint::spin_loop();
            } else if looks <= SPINS + YIELDS {
                thread::yield_now();
            } else {
                self.host_asleep.store(true, Ordering::SeqCst);
                if self.done.load(Ordering::SeqCst) < chunks {
                    thread::park();
                }
                self.host_asleep.store(false, Ordering::SeqCst);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU32;
    use std::time::Duration;

    use super::*;

    /// Work of a test.
    struct Work<F>(F);

    impl<F: Fn(Range<usize>) -> Outcome + Send + Sync> Chunks for Work<F> {
        fn make(&self, chunks: Range<usize>) -> Outcome {
            (self.0)(chunks)
        }
    }

    fn work(of: impl Fn(Range<usize>) -> Outcome + Send + Sync + 'static) -> Arc<dyn Chunks> {
        Arc::new(Work(of))
    }

    /// Sweeps of different lengths, since a worker may be late from the previous one, in batches of one sweep and more
    /// with different threads.
    #[test]
    fn every_chunk_of_every_sweep_is_made_once_whatever_the_number_of_threads() {
        for most in [1, 2, 3, 8] {
            let made: Arc<Vec<AtomicU32>> = Arc::new((0..37).map(|_| AtomicU32::new(0)).collect());
            let counted = Arc::clone(&made);
            let work = work(move |range| {
                let mut outcome = Outcome::default();
                for chunk in range {
                    counted[chunk].fetch_add(1, Ordering::Relaxed);
                    outcome += Outcome {
                        saturated: chunk as u64,
                        exceeded: chunk == 5,
                    };
                }
                outcome
            });
            let mut expected = [0; 37];
            let mut crew = Crew::default();
            for batch in 1..=1000 {
                let threads = 1 + (batch + most - 1) % most;
                let mut host = crew.gather(threads, &work);
                for sweep in 0..batch % 7 {
                    let chunks = [37, 2, 13][sweep % 3];
                    *host.patience = Patience::trusting();
                    let outcome = host.sweep(0, chunks);
                    let sum = chunks as u64 * (chunks as u64 - 1) / 2;
                    assert_eq!((outcome.saturated, outcome.exceeded), (sum, chunks > 5));
                    expected[..chunks].iter_mut().for_each(|count| *count += 1);
                    for (made, expected) in made.iter().zip(expected) {
                        let made = made.load(Ordering::Relaxed);
                        assert_eq!(made, expected, "{threads} threads, batch {batch}");
                    }
                }
            }
        }
    }

    /// A crew takes new threads for other work; these receive no reference to the earlier work.
    #[test]
    fn a_crew_is_started_again_for_other_work() {
        let mut crew = Crew::default();
        for made in 1..20 {
            let work = work(move |range| Outcome {
                saturated: (made * range.len()) as u64,
                exceeded: false,
            });
            let mut host = crew.gather(2, &work);
            *host.patience = Patience::trusting();
            assert_eq!(host.sweep(0, 30).saturated, 30 * made as u64);
        }
    }

    #[test]
    fn a_panic_of_a_worker_reaches_the_host_and_later_sweeps_are_made() {
        let host = thread::current().id();
        let panics = Arc::new(AtomicBool::new(true));
        let fails = Arc::clone(&panics);
        let work = work(move |_| {
            if thread::current().id() == host {
                thread::sleep(Duration::from_millis(1));
            } else if fails.load(Ordering::Relaxed) {
                panic::resume_unwind(Box::new("a worker's"));
            }
            Outcome::default()
        });
        let mut crew = Crew::default();
        let mut host = crew.gather(2, &work);
        *host.patience = Patience::trusting();
        let made = panic::catch_unwind(AssertUnwindSafe(|| {
            (0..100).for_each(|_| _ = host.sweep(0, 8));
        }));
        let reason = made.expect_err("a worker panics");
        assert_eq!(reason.downcast_ref(), Some(&"a worker's"));
        panics.store(false, Ordering::Relaxed);
        host.sweep(0, 8);
    }

    /// Each chunk takes a while, during which a worker sleeps: the host notices this, and computes the rest itself.
    #[test]
    fn sleeping_workers_are_not_waited_for_in_every_sweep() {
        let host = thread::current().id();
        let by_others = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&by_others);
        let work = work(move |range| {
            if thread::current().id() != host {
                counted.fetch_add(range.len(), Ordering::Relaxed);
                thread::sleep(Duration::from_millis(5));
            } else {
                thread::sleep(Duration::from_micros(20));
            }
            Outcome::default()
        });
        let mut crew = Crew::default();
        let sweeps = 300;
        for _ in 0..10 {
            let mut host = crew.gather(2, &work);
            for _ in 0..sweeps / 10 {
                host.sweep(0, 8);
            }
        }
        // One sweep shows it: what it lost is fifty times as long as all others.
        assert!(by_others.load(Ordering::Relaxed) <= 8, "{by_others:?}");
    }
}

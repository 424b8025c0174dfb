//! CPU time and memory of building models of a large cube.
//!
//! `cargo bench -p sinew-fem` builds models of a structured cube of a million tetrahedra, given as a mesh, of each kind
//! of material. Time is CPU time of all threads (s); memory is that in use beyond the mesh: the peak while a model is
//! built, and the amount after that (bytes per tetrahedron). The fingerprint tells whether two programs build the same
//! matrices, to the bit. Numbers after `--` are the hexahedra along an edge of the cube and the number of times each
//! model is built; a word is a part of the names of the materials to build.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    unsafe_code,
    reason = "a benchmark ends in a panic and prints; the allocator that counts must be unsafe"
)]

use std::alloc::{GlobalAlloc, Layout, System as SystemAllocator};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use sinew_core::System;
use sinew_fem::{Fixed, Law, LoadKind, LoadSpec, Model, Problem, Region, SpringRule};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

/// The system's allocator, with a count of the bytes in use.
struct Counting;

static IN_USE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn add(bytes: usize) {
    let in_use = IN_USE.fetch_add(bytes, Ordering::Relaxed) + bytes;
    PEAK.fetch_max(in_use, Ordering::Relaxed);
}

// SAFETY: everything is passed on to the system's allocator as it comes.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        // SAFETY: the caller's promises are passed on.
        unsafe { SystemAllocator.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        // SAFETY: the caller's promises are passed on.
        unsafe { SystemAllocator.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        IN_USE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promises are passed on.
        unsafe { SystemAllocator.dealloc(block, layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        add(size);
        IN_USE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promises are passed on.
        unsafe { SystemAllocator.realloc(block, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    // Cargo's own.
    arguments.retain(|argument| argument != "--bench");
    let mut numbers = arguments
        .iter()
        .filter_map(|argument| argument.parse().ok());
    let (cells, repeats) = (numbers.next().unwrap_or(55), numbers.next().unwrap_or(5));
    let word = arguments
        .iter()
        .find(|argument| argument.parse::<usize>().is_err());
    let before = cpu_time();
    let mesh = cube(cells, 0.1, Split::Kuhn).expect("the mesh is small enough");
    let seconds = (cpu_time() - before).as_secs_f64();
    let (nodes, tets) = (mesh.points.len(), mesh.tets.len());
    println!("{tets} tetrahedra, {nodes} nodes; the mesh itself took {seconds:.3} s of CPU");
    let linear = Law::linear(3500.0, 0.45);
    let springs = |rule, damping_ratio| Law::Springs {
        youngs_modulus: 3500.0,
        rule,
        calibrate: true,
        damping_ratio,
    };
    for (name, law) in [
        ("linear", linear),
        ("Lloyd, calibrated", springs(SpringRule::Lloyd, 0.0)),
        (
            "van Gelder, calibrated",
            springs(SpringRule::VanGelder, 0.0),
        ),
        ("Lloyd with dashpots", springs(SpringRule::Lloyd, 0.1)),
    ] {
        if word.is_none_or(|word| name.contains(word.as_str())) {
            measure(name, &mesh, &problem(law), repeats);
        }
    }
}

/// A cube on its bottom, pressed from above.
fn problem(law: Law) -> Problem {
    Problem::of([Region::new(law, 1060.0)])
        .with_fixed(Fixed::at("bottom"))
        .with_load(LoadSpec::new("top", LoadKind::Pressure(100.0)))
}

fn measure(name: &str, mesh: &TetMesh, problem: &Problem, repeats: usize) {
    let (mut cpu, mut wall) = (Vec::new(), Vec::new());
    let (mut most, mut kept, mut fingerprint) = (0, 0, 0);
    for _ in 0..repeats {
        let before = IN_USE.load(Ordering::Relaxed);
        PEAK.store(before, Ordering::Relaxed);
        let (start, wall_start) = (cpu_time(), Instant::now());
        let model = Model::build(mesh, problem).expect("it can be built");
        wall.push(wall_start.elapsed());
        cpu.push(cpu_time() - start);
        most = PEAK.load(Ordering::Relaxed) - before;
        kept = IN_USE.load(Ordering::Relaxed) - before;
        fingerprint = (&model as &dyn System).fingerprint();
    }
    let per_tet = |bytes: usize| bytes as f64 / mesh.tets.len() as f64;
    println!(
        "{name}: {:.3} s of CPU, {:.3} s by the clock (medians of {repeats}); at most {:.1} bytes a tetrahedron, {:.1} \
         once it is built; fingerprint {fingerprint:016x}",
        median(cpu),
        median(wall),
        per_tet(most),
        per_tet(kept),
    );
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    times
        .get(times.len() / 2)
        .map_or(0.0, Duration::as_secs_f64)
}

/// CPU time of all threads since some fixed instant.
#[cfg(unix)]
fn cpu_time() -> Duration {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec.unsigned_abs() as u32)
}

/// Wall time, for platforms that have no such clock.
#[cfg(not(unix))]
fn cpu_time() -> Duration {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

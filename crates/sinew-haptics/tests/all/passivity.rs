//! Energy that a device takes out of couplings and of simulations that are late or wrong, in simulated time.
//! Simulations that are on time and correct are part of the verification.

use std::f64::consts::TAU;

use sinew_haptics::{Coupling, Device, Lockstep, Published, RigidWall, Simulated, SoftwareDevice};

/// Energy (J) that a device may take out: 0, with a margin for motion that its encoder does not resolve.
const MOST: f64 = 1e-6;

/// Peak force (N) and energy (J) in a run, from the view of the hand.
#[derive(Debug, Default)]
struct Felt {
    peak: f64,
    most_taken_out: f64,
}

fn size(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The path of a hand that presses, releases and moves aside, in and out of an obstacle at a height (m).
fn path(height: f64, depth: f64) -> impl Fn(f64) -> [f64; 3] + Send + 'static {
    move |t| {
        [
            0.03 + 0.004 * (TAU * 0.37 * t).sin(),
            0.03 + 0.003 * (TAU * 0.23 * t).sin(),
            height + 0.25 * depth + 1.25 * depth * (TAU * 0.6 * t).cos(),
        ]
    }
}

fn run<S: Simulated>(
    simulation: S,
    coupling: Coupling,
    device: &mut SoftwareDevice,
    seconds: u32,
    mut each: impl FnMut(u32, &mut Lockstep<S>),
) -> Felt
where
    S::Error: std::fmt::Debug,
{
    let mut lockstep = Lockstep::new(simulation, coupling, device).unwrap();
    let mut felt = Felt::default();
    for tick in 0..1000 * seconds {
        lockstep.tick(device).unwrap();
        each(tick, &mut lockstep);
        felt.peak = felt.peak.max(size(lockstep.forces().force()));
    }
    felt.most_taken_out = device.most_energy_taken_out();
    felt
}

/// A generator of Lehmer (MINSTD): pseudo-random numbers from 0 to 1, the same in each run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0
    }
}

#[test]
fn steps_that_come_late_or_not_at_all_give_no_energy() {
    for stiffness in [200.0, 1000.0] {
        let mut device = SoftwareDevice::in_a_hand(path(0.0, 0.012));
        let coupling = Coupling::of(stiffness, &device.limits());
        let wall = RigidWall::new(coupling, 0.05, 0.01, device.true_position());
        let (mut random, mut latest) = (Random(7), 0);
        let felt = run(wall, coupling, &mut device, 60, |tick, lockstep| {
            latest = latest.max(lockstep.forces().late());
            if tick % 10 == 5 && lockstep.forces().late() == 0 && random.next() < 0.1 {
                lockstep.hold_back((200.0 * random.next()) as u64);
            }
            if tick == 30_000 {
                lockstep.hold_back(5000);
            }
        });
        assert!(latest >= 5000, "{latest}");
        assert!(felt.most_taken_out <= MOST, "{stiffness}: {felt:?}");
        assert!(felt.peak > 0.5, "{stiffness}: {felt:?}");
    }
}

/// A simulation that publishes random data.
struct Nonsense(Random);

impl Simulated for Nonsense {
    type Error = std::convert::Infallible;

    fn dt(&self) -> f64 {
        0.01
    }

    fn step(&mut self, device: &sinew_haptics::DeviceMotion) -> Result<Published, Self::Error> {
        let Self(random) = self;
        let mut around = |size: f64| [(); 3].map(|()| size * (2.0 * random.next() - 1.0));
        let (place, force, row) = (around(0.02), around(5.0), around(40.0));
        let mut published = Published {
            dt: 0.01,
            force,
            // Neither symmetric nor positive.
            stiffness: row.map(|a| place.map(|b| 500.0 * a * b)),
            may_pull: place[0] > 0.0,
            ..Published::free_at([0, 1, 2].map(|axis| device.position[axis] + place[axis]))
        };
        published.steps = 1;
        Ok(published)
    }
}

#[test]
fn nothing_that_a_simulation_says_gives_energy() {
    for seed in 1..6 {
        let mut device = SoftwareDevice::in_a_hand(path(0.0, 0.012));
        let coupling = Coupling::of(1000.0, &device.limits());
        let felt = run(Nonsense(Random(seed)), coupling, &mut device, 20, |_, _| {});
        // Forces jump by a newton, and the encoder misses half a step, 12 uJ.
        assert!(felt.most_taken_out <= 12e-6, "{seed}: {felt:?}");
        assert!(felt.peak > 0.0, "{seed}: {felt:?}");
    }
}

/// The energy (J) that a device takes out of a coupling to a tool that is extrapolated from its last position and
/// velocity, without regard to energy: the method that the loop of this crate does not use.
fn taken_out_of_a_plain_coupling<S: Simulated>(
    mut simulation: S,
    coupling: Coupling,
    device: &mut SoftwareDevice,
) -> f64
where
    S::Error: std::fmt::Debug,
{
    let ticks = (simulation.dt() / 1e-3).round() as u32;
    let mut tool = Published::free_at(device.true_position());
    let (mut pending, mut since, mut last) = (tool, 0.0, device.true_position());
    for tick in 0..2000 {
        let position = device.position();
        let velocity = [0, 1, 2].map(|axis| 1e3 * (position[axis] - last[axis]));
        last = position;
        if tick % ticks == 0 {
            (tool, since) = (pending, 0.0);
            let motion = sinew_haptics::DeviceMotion {
                velocity: [0.0; 3],
                ..sinew_haptics::DeviceMotion::at(position)
            };
            pending = simulation.step(&motion).unwrap();
        }
        device.render([0, 1, 2].map(|axis| {
            let now = tool.position[axis] + since * tool.velocity[axis];
            let rate = tool.velocity[axis] - velocity[axis];
            coupling.stiffness * (now - position[axis]) + coupling.damping * rate
        }));
        since += 1e-3;
    }
    device.most_energy_taken_out()
}

#[test]
fn a_plain_coupling_to_the_last_step_drives_the_hand() {
    let mut device = SoftwareDevice::in_a_hand(path(0.0, 0.012));
    let coupling = Coupling::of(1000.0, &device.limits());
    let wall = RigidWall::new(coupling, 0.05, 0.01, device.true_position());
    let taken_out = taken_out_of_a_plain_coupling(wall, coupling, &mut device);
    assert!(taken_out > 1000.0 * MOST, "{taken_out}");
}

//! Strokes through bodies that move and deform while they are cut.
use crate::common::{body, topology};
use sinew_cutting::{CuttableBody, Sheet};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

/// Numbers from -1 to 1, by the constants of Knuth's generator MMIX.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.next())
    }
}

fn add(a: [f64; 3], b: [f64; 3], factor: f64) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + factor * b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// A motion of a cube of 0.1 m: how far it goes in the whole stroke (m), per strain, and by waves.
struct Motion {
    drift: [f64; 3],
    gradient: [[f64; 3]; 3],
    wave: [f64; 3],
    along: [f64; 3],
    turns: f64,
    opening: f64,
}

const MIDDLE: [f64; 3] = [0.05; 3];

impl Motion {
    fn at(&self, place: [f64; 3], share: f64) -> [f64; 3] {
        let from = add(place, MIDDLE, -1.0);
        let strained = self.gradient.map(|row| share * dot(row, from));
        let phase = dot(self.along, from) / 0.05 + self.turns * share;
        add(add(add(place, strained, 1.0), self.drift, share), self.wave, phase.sin())
    }
}

/// Where the blade comes from, and what it cuts.
struct Way {
    normal: [f64; 3],
    across: [f64; 3],
    ahead: [f64; 3],
    through: [f64; 3],
}

impl Way {
    fn blade(&self, share: f64) -> [[f64; 3]; 2] {
        let middle = add(self.through, self.ahead, 0.36 * (share - 0.5));
        [-0.2, 0.2].map(|end| add(middle, self.across, end))
    }
}

/// Cuts a moving body through; the number of pieces.
fn cut_through(mesh: &TetMesh, way: &Way, motion: &Motion, steps: u32, snap: f64) -> (usize, CuttableBody) {
    let mut body = body(mesh, 0.45);
    let mut positions = mesh.points.clone();
    for step in 0..steps {
        let share = |step: u32| f64::from(step) / f64::from(steps);
        let front = 0.36 * (share(step) - 0.5);
        // Lips part behind the blade.
        let parted: Vec<f64> = (0..body.nodes() as u32)
            .map(|node| {
                let tets = body.tets_at(node);
                let sides = tets.iter().map(|tet| {
                    let nodes = mesh.tets[*tet as usize];
                    let middle = nodes.into_iter().fold([0.0; 3], |sum, node| add(sum, mesh.points[node as usize], 0.25));
                    dot(way.normal, add(middle, way.through, -1.0)).signum()
                });
                sides.sum::<f64>() / tets.len() as f64
            })
            .collect();
        for (node, place) in positions.iter_mut().enumerate() {
            let at_rest = body.points()[node];
            let behind = (front - dot(way.ahead, add(at_rest, way.through, -1.0))).clamp(0.0, 0.1) / 0.1;
            *place = add(motion.at(at_rest, share(step)), way.normal, motion.opening * parted[node] * behind);
        }
        let sheet = Sheet::swept(way.blade(share(step)), way.blade(share(step + 1))).unwrap();
        body.stroke(&sheet, &mut positions, snap).unwrap();
    }
    (body.pieces().count, body)
}

#[test]
fn full_strokes_through_moving_bodies_leave_two_pieces() {
    let mut random = Random(7);
    let (mut wrong, mut all) = (Vec::new(), 0);
    let runs: u32 = std::env::var("RUNS").map_or(100, |runs| runs.parse().unwrap());
    let size: f64 = std::env::var("SIZE").map_or(1.0, |runs| runs.parse().unwrap());
    for run in 0..runs {
        let only: Option<u32> = std::env::var("ONLY").ok().map(|x| x.parse().unwrap());
        let split = if run % 2 == 0 { Split::Kuhn } else { Split::Mirrored };
        let mesh = structured::cube(4 + 2 * (run as usize % 2), 0.1, split).unwrap();
        let normal = match run % 4 {
            0 => [1.0, 0.0, 0.0],
            1 => unit(add([1.0, 0.0, 0.0], random.vector(), 0.1)),
            _ => unit(random.vector()),
        };
        let across = unit(cross(normal, if run % 4 == 0 { [0.0, 0.0, 1.0] } else { random.vector() }));
        let ahead = cross(across, normal);
        let through = if run % 4 == 0 { MIDDLE } else { add(MIDDLE, random.vector(), 0.02) };
        let way = Way { normal, across, ahead, through };
        let motion = Motion {
            drift: random.vector().map(|x| 0.03 * size * x),
            gradient: [0; 3].map(|_| random.vector().map(|x| 0.15 * size * x)),
            wave: random.vector().map(|x| 0.004 * size * x),
            along: random.vector(),
            turns: 20.0 * random.next(),
            opening: 0.005 * size * (1.0 + random.next()),
        };
        if only.is_some_and(|o| o != run) { continue; }
        let steps = [3, 12, 60, 200][run as usize / 4 % 4];
        let snap = if run % 3 == 0 { 0.0 } else { 0.25 };
        let (pieces, body) = cut_through(&mesh, &way, &motion, steps, snap);
        topology::check(&body, &mesh);
        if std::env::var("ONLY").is_ok() { body.debug_left(); }
        all += 1;
        if pieces != 2 {
            wrong.push((run, pieces, steps, snap));
        }
    }
    assert!(wrong.is_empty(), "{} of {all}: {wrong:?}", wrong.len());
}

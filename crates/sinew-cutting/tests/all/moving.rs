//! Strokes through bodies that move and deform while they are cut.
use crate::common::{body, topology};
use sinew_cutting::{CuttableBody, Sheet};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};
use sinew_mesh::vector::{cross, dot};

/// Numbers from -1 to 1, by the constants of Knuth's generator MMIX.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.next())
    }
}

fn add(a: [f64; 3], b: [f64; 3], factor: f64) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + factor * b[axis])
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// A motion of a cube of 0.1 m: the displacement in the whole stroke (m), the strain, and the waves.
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
        add(
            add(add(place, strained, 1.0), self.drift, share),
            self.wave,
            phase.sin(),
        )
    }
}

/// Direction of the blade, and the point that it cuts through.
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

/// Cuts through a moving body; returns the number of pieces.
fn cut_through(
    mesh: &TetMesh,
    way: &Way,
    motion: &Motion,
    steps: u32,
    snap: f64,
) -> (usize, CuttableBody) {
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
                    let middle = nodes.into_iter().fold([0.0; 3], |sum, node| {
                        add(sum, mesh.points[node as usize], 0.25)
                    });
                    dot(way.normal, add(middle, way.through, -1.0)).signum()
                });
                sides.sum::<f64>() / tets.len() as f64
            })
            .collect();
        for (node, place) in positions.iter_mut().enumerate() {
            let at_rest = body.points()[node];
            let behind =
                (front - dot(way.ahead, add(at_rest, way.through, -1.0))).clamp(0.0, 0.1) / 0.1;
            *place = add(
                motion.at(at_rest, share(step)),
                way.normal,
                motion.opening * parted[node] * behind,
            );
        }
        let sheet = Sheet::swept(way.blade(share(step)), way.blade(share(step + 1))).unwrap();
        body.stroke(&sheet, &mut positions, snap).unwrap();
    }
    (body.pieces().count, body)
}

/// A stroke through a moving cube, by its number: along planes of nodes, near them and anywhere, in few steps and in
/// many.
fn case(number: u32, random: &mut Random) -> (TetMesh, Way, Motion, u32, f64) {
    let split = [Split::Kuhn, Split::Mirrored][number as usize % 2];
    let mesh = structured::cube(4, 0.1, split).unwrap();
    let normal = match number % 4 {
        0 => [1.0, 0.0, 0.0],
        1 => unit(add([1.0, 0.0, 0.0], random.vector(), 0.1)),
        _ => unit(random.vector()),
    };
    let helper = match number % 4 {
        0 => [0.0, 0.0, 1.0],
        _ => random.vector(),
    };
    let across = unit(cross(normal, helper));
    let through = match number % 4 {
        0 => MIDDLE,
        _ => add(MIDDLE, random.vector(), 0.02),
    };
    let way = Way {
        normal,
        across,
        ahead: cross(across, normal),
        through,
    };
    let motion = Motion {
        drift: random.vector().map(|x| 0.03 * x),
        gradient: [0; 3].map(|_| random.vector().map(|x| 0.15 * x)),
        wave: random.vector().map(|x| 0.004 * x),
        along: random.vector(),
        turns: 20.0 * random.next(),
        opening: 0.005 * (1.0 + random.next()),
    };
    let steps = [3, 12, 40][number as usize / 4 % 3];
    let snap = [0.0, 0.25, 0.25][number as usize % 3];
    (mesh, way, motion, steps, snap)
}

#[test]
fn full_strokes_through_moving_bodies_leave_two_pieces_and_nothing_uncut() {
    let mut random = Random(7);
    for number in 0..48 {
        let (mesh, way, motion, steps, snap) = case(number, &mut random);
        let (pieces, mut body) = cut_through(&mesh, &way, &motion, steps, snap);
        assert_eq!(pieces, 2, "{number}");
        assert_eq!(body.uncut(), None, "{number}");
        assert_eq!(body.lift(), None, "{number}");
        topology::check(&body, &mesh);
    }
}

#[test]
fn tissue_that_swings_through_a_resting_blade_is_cut() {
    for split in [Split::Kuhn, Split::Mirrored] {
        let mesh = structured::cube(4, 0.1, split).unwrap();
        // Straight along the blade's plane, and across a plane of nodes and back on another way.
        for sideways in [0.0, 0.013] {
            let mut body = body(&mesh, 0.45);
            let mut positions = mesh.points.clone();
            let blade = [[0.05, -0.02, 0.12], [0.05, 0.12, 0.12]];
            let mut faces = 0;
            for step in 0..=40 {
                let share = f64::from(step) / 40.0;
                let aside = sideways * (4.0 * share).sin();
                for (place, rest) in positions.iter_mut().zip(body.points()) {
                    *place = add(*rest, [aside, 0.0, 0.14 * share], 1.0);
                }
                let stroke = body.follow([blade, blade], &mut positions, 0.25).unwrap();
                faces += stroke.faces.len();
            }
            assert_eq!(body.pieces().count, 2, "{sideways}");
            assert_eq!(body.uncut(), None);
            if sideways == 0.0 {
                assert_eq!(faces, 32);
            }
            topology::check(&body, &mesh);
        }
    }
}

#[test]
fn a_blade_that_tissue_carries_cuts_nothing() {
    let mesh = structured::cube(4, 0.1, Split::Kuhn).unwrap();
    let (mut body, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
    let blade = |carried: f64| [-0.02, 0.12].map(|y| [0.052, y, 0.06 - carried]);
    body.follow([blade(-0.06), blade(0.0)], &mut positions, 0.0)
        .unwrap();
    let cut = body.nodes();
    for step in 1..=20 {
        let carried = 0.003 * f64::from(step);
        for (place, rest) in positions.iter_mut().zip(body.points()) {
            *place = add(*rest, [0.0, 0.0, -carried], 1.0);
        }
        let poses = [blade(carried - 0.003), blade(carried)];
        let stroke = body.follow(poses, &mut positions, 0.0).unwrap();
        assert!(stroke.is_empty());
    }
    assert!(cut > mesh.points.len());
    assert_eq!(body.nodes(), cut);
}

#[test]
fn a_stroke_through_moving_tissue_goes_on_from_saved_bytes_with_the_same_bits() {
    let mut random = Random(11);
    let (mesh, way, motion, ..) = case(2, &mut random);
    let (mut kept, mut restored) = (body(&mesh, 0.45), body(&mesh, 0.45));
    let (mut places, mut others) = (mesh.points.clone(), Vec::new());
    let steps = 20;
    for step in 0..steps {
        let share = |step: u32| f64::from(step) / f64::from(steps);
        let poses = [way.blade(share(step)), way.blade(share(step + 1))];
        for (place, rest) in places.iter_mut().zip(kept.points()) {
            *place = motion.at(*rest, share(step));
        }
        if step >= 9 {
            if step == 9 {
                restored.restore(&kept.save()).unwrap();
            }
            others.clone_from(&places);
            restored.follow(poses, &mut others, 0.25).unwrap();
        }
        kept.follow(poses, &mut places, 0.25).unwrap();
    }
    assert_eq!(kept.pieces().count, 2);
    assert_eq!(others, places);
    assert_eq!(restored.save(), kept.save());
}

#[test]
fn what_a_blade_leaves_of_a_body_that_it_came_through_is_told() {
    let mesh = structured::cube(4, 0.1, Split::Kuhn).unwrap();
    let blade = |z: f64| [[0.05, -0.02, z], [0.05, 0.12, z]];
    let stroke = |ways: &[(f64, f64)]| {
        let (mut body, mut positions) = (body(&mesh, 0.45), mesh.points.clone());
        for (from, to) in ways {
            body.follow([blade(*from), blade(*to)], &mut positions, 0.0)
                .unwrap();
        }
        (body.pieces().count, body.lift())
    };
    assert_eq!(stroke(&[(0.12, -0.02)]), (2, None));
    // The blade is in the body, has gone back, or began within: its rim lies within.
    assert_eq!(stroke(&[(0.12, 0.03)]), (1, None));
    assert_eq!(stroke(&[(0.12, 0.03), (0.03, 0.12)]), (1, None));
    assert_eq!(stroke(&[(0.06, -0.02)]), (1, None));
    // It leapt over a bridge.
    let (pieces, left) = stroke(&[(0.12, 0.07), (0.03, -0.02)]);
    let left = left.unwrap();
    assert_eq!(pieces, 1);
    assert!((left.area - 0.005).abs() < 1e-12, "{left:?}");
    assert!(
        left.place.iter().all(|x| (x - 0.05).abs() < 1e-12),
        "{left:?}"
    );
}

//! Full strokes through bodies that are stretched, or free and deforming.

use std::sync::Arc;

use sinew_core::{Inputs, Options, Ramp, State, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Course, CutModel, Element, Law, Model, Moving, On, Problem};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block, cube};

use crate::bodies::{YOUNGS_MODULUS, body, held};
use crate::error::LabError;
use crate::pressed::method;

type Vector = [f64; 3];

/// Step (s), a half of the stable one or less.
const DT: f64 = 5e-4;

const LAWS: usize = 3;

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

    fn vector(&mut self) -> Vector {
        std::array::from_fn(|_| self.next())
    }
}

fn along(a: Vector, b: Vector, factor: f64) -> Vector {
    std::array::from_fn(|axis| a[axis] + factor * b[axis])
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn unit(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A free body of one of three laws.
fn of_law(law: usize, poissons_ratio: f64) -> Problem {
    let mut problem = body(YOUNGS_MODULUS, poissons_ratio, Element::P1);
    let id = ["linear", "stvk", "neo-hookean"][law % LAWS];
    if id != "linear" {
        for region in &mut problem.regions {
            let parameters = Parameters::new(YOUNGS_MODULUS, poissons_ratio);
            region.law = Law::hyperelastic(id, parameters);
        }
    }
    problem
}

/// A blade: its middle at the start, its half length as a vector, and its path through the body.
struct Blade {
    begins: Vector,
    half: Vector,
    way: Vector,
}

impl Blade {
    fn at(&self, share: f64) -> [Vector; 2] {
        let middle = along(self.begins, self.way, share);
        [-1.0, 1.0].map(|side| along(middle, self.half, side))
    }
}

/// Result of a full stroke: true if the body is in two pieces, and the area (m^2) reported as uncut.
fn after_stroke(
    cut: &mut CutModel,
    state: &mut State,
    blade: &Blade,
    steps: u32,
) -> Result<(bool, f64), LabError> {
    let mut method = method("central-difference", &Options::new())?;
    let share = |step: u32| f64::from(step) / f64::from(steps);
    for step in 0..steps {
        let poses = [blade.at(share(step)), blade.at(share(step + 1))];
        cut.follow(poses, state, Inputs::none())?;
        method.step(cut.model(), state, DT)?;
    }
    let uncut = cut.lift().map_or(0.0, |uncut| uncut.area);
    Ok((cut.body().pieces().count == 2, uncut))
}

/// Counts of defects of strokes.
#[derive(Default)]
struct Left {
    not_two: f64,
    uncut: f64,
}

impl Left {
    fn see(&mut self, (is_two, uncut): (bool, f64)) {
        self.not_two += f64::from(u8::from(!is_two));
        self.uncut += uncut;
    }
}

/// A state with a displacement and a velocity at each position of a mesh.
fn state_of(
    model: &Model,
    mesh: &TetMesh,
    displacement: impl Fn(Vector) -> Vector,
    velocity: impl Fn(Vector) -> Vector,
) -> Result<State, LabError> {
    let mut state = State::at_rest(model.dofs());
    let field = |of: &dyn Fn(Vector) -> Vector| -> Vec<Vector> {
        mesh.points.iter().map(|place| of(*place)).collect()
    };
    model.to_dofs(&field(&displacement), &mut state.u)?;
    model.to_dofs(&field(&velocity), &mut state.v)?;
    Ok(state)
}

/// 20 sheets through a strip under a constant stretch of 0 to 30 %, each with three laws: strokes that do not leave two
/// pieces, and area reported as uncut.
pub(super) fn under_tension() -> Result<Vec<f64>, LabError> {
    let size = [0.08, 0.04, 0.01];
    let mut left = Left::default();
    for sheet in 0..20_u32 {
        let split = [Split::Kuhn, Split::Mirrored][sheet as usize % 2];
        let mesh = Arc::new(block([8, 4, 2], size, split)?);
        let strain = 0.3 * f64::from(sheet) / 19.0;
        let end = |holds: &dyn Fn(Vector) -> bool| {
            let nodes = (0..).zip(&mesh.points);
            On::Nodes(
                nodes
                    .filter(|(_, place)| holds(**place))
                    .map(|(node, _)| node)
                    .collect(),
            )
        };
        let mut random = Random(u64::from(sheet));
        let middle = (0.04 + 0.006 * random.next()) * (1.0 + strain);
        let tilt = if sheet < 5 { 0.0 } else { 0.2 };
        let blade = Blade {
            begins: [middle, -0.01, 0.005],
            half: [0.02 * tilt * random.next(), 0.0, 0.02],
            way: [0.06 * tilt * random.next(), 0.06, 0.0],
        };
        for law in 0..LAWS {
            let mut problem = Problem {
                fixed: vec![held(end(&|place| place[0] < 1e-9), [true; 3])],
                moves: vec![Moving::new(
                    end(&|place| place[0] > size[0] - 1e-9),
                    [Course::new([strain * size[0], 0.0, 0.0], Ramp::Step)],
                )],
                ..of_law(law, 0.0)
            };
            problem.damping.mass = 40.0;
            let snap = [0.25, 0.0][sheet as usize / 2 % 2];
            let mut cut = CutModel::new(Arc::clone(&mesh), problem, snap)?;
            let stretched = |place: Vector| [strain * place[0], 0.0, 0.0];
            let mut state = state_of(cut.model(), &mesh, stretched, |_| [0.0; 3])?;
            let steps = [40, 200, 600][(sheet as usize + law) % 3];
            left.see(after_stroke(&mut cut, &mut state, &blade, steps)?);
        }
    }
    Ok(vec![left.not_two, left.uncut])
}

/// 100 strokes along 20 sheets through a free cube that begins at strains of 0 to 30 % with random velocities, by three
/// laws: strokes that do not leave two pieces, and area reported as uncut.
pub(super) fn free() -> Result<Vec<f64>, LabError> {
    let mut left = Left::default();
    let middle = [0.05; 3];
    for run in 0..100_u32 {
        let sheet = run % 20;
        let split = [Split::Kuhn, Split::Mirrored][run as usize % 2];
        let mesh = Arc::new(cube(4, 0.1, split)?);
        let mut random = Random(u64::from(sheet));
        // The first ones along planes of nodes.
        let (normal, helper, aside) = match sheet {
            0..5 => ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], 0.0),
            _ => (unit(random.vector()), random.vector(), 0.02),
        };
        let across = unit(cross(normal, helper));
        let ahead = cross(across, normal);
        let through = along(middle, random.vector(), aside);
        let blade = Blade {
            begins: along(through, ahead, -0.2),
            half: across.map(|x| 0.3 * x),
            way: ahead.map(|x| 0.4 * x),
        };
        let mut random = Random(u64::from(1000 + run));
        let strain = 0.3 * f64::from(run) / 99.0;
        let axis = unit(random.vector());
        let stretched = |place: Vector| {
            let apart = dot(axis, along(place, middle, -1.0));
            axis.map(|x| strain * apart * x)
        };
        let drift = random.vector().map(|x| 0.3 * x);
        let gradient = [0; 3].map(|_| random.vector().map(|x| 5.0 * x));
        let wave = random.vector().map(|x| 0.2 * x);
        let wave_along = random.vector().map(|x| 60.0 * x);
        let velocity = |place: Vector| {
            let apart = along(place, middle, -1.0);
            let strained = gradient.map(|row| dot(row, apart));
            let affine = along(drift, strained, 1.0);
            along(affine, wave, dot(wave_along, apart).sin())
        };
        let snap = [0.25, 0.0][run as usize / 20 % 2];
        let problem = of_law(run as usize, [0.3, 0.4][run as usize / 3 % 2]);
        let mut cut = CutModel::new(Arc::clone(&mesh), problem, snap)?;
        let mut state = state_of(cut.model(), &mesh, stretched, velocity)?;
        let steps = [3, 12, 60][run as usize / 20 % 3];
        left.see(after_stroke(&mut cut, &mut state, &blade, steps)?);
    }
    Ok(vec![left.not_two, left.uncut])
}

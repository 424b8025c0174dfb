//! Tests that the matrix P that replaces M is above the matrix that a step needs, for any network, damping and step.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use sinew_cnn::{Blend, DampingShare, GammaRule, Inner, Majorant, Stabiliser};
use sinew_core::spectrum::critical_step;
use sinew_core::{LinearOperators, LinearSystem, System};
use sinew_fem::{Fixed, Law, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_testkit::body::{Body, bodies_up_to};
use sinew_testkit::dense::{dense, dense_damping};

/// Rounding of a dense decomposition, relative to eigenvalues near 1.
const DENSE: f64 = 1e-9;

fn matrix(rows: Vec<Vec<f64>>) -> DMatrix<f64> {
    let n = rows.len();
    DMatrix::from_row_iterator(n, n, rows.into_iter().flatten())
}

fn mass(operators: &LinearOperators) -> DMatrix<f64> {
    DMatrix::from_diagonal(&DVector::from_row_slice(operators.mass()))
}

fn stiffness(operators: &LinearOperators) -> DMatrix<f64> {
    matrix(dense(operators.stiffness()))
}

fn damping(operators: &LinearOperators) -> DMatrix<f64> {
    matrix(dense_damping(operators))
}

/// D - alpha M.
fn other_damping(operators: &LinearOperators) -> DMatrix<f64> {
    damping(operators) - mass(operators) * operators.damping().mass
}

/// (1 + alpha dt/2) M.
fn mass_with_damping(operators: &LinearOperators, dt: f64) -> DMatrix<f64> {
    mass(operators) * (1.0 + dt / 2.0 * operators.damping().mass)
}

/// Matrix that a majorant adds to [`mass_with_damping`].
fn added(operators: &LinearOperators, dt: f64, majorant: &Majorant) -> DMatrix<f64> {
    other_damping(operators) * (majorant.damping_share() * dt / 2.0)
        + stiffness(operators) * (majorant.s() * dt * dt / 4.0)
}

/// The largest eigenvalue of `M^-1 (dt/2 D' + dt^2/4 K)` by dense arithmetic.
fn dense_need(operators: &LinearOperators, dt: f64) -> f64 {
    let root = mass(operators).map(|m| if m > 0.0 { m.sqrt().recip() } else { 0.0 });
    let need = other_damping(operators) * (dt / 2.0) + stiffness(operators) * (dt * dt / 4.0);
    extremes(&(&root * need * &root)).1
}

/// The part of a matrix within cells of three.
fn blockdiag(full: &DMatrix<f64>) -> DMatrix<f64> {
    let n = full.nrows();
    DMatrix::from_fn(n, n, |i, j| if i / 3 == j / 3 { full[(i, j)] } else { 0.0 })
}

/// The least and the largest eigenvalue of a symmetric matrix.
fn extremes(symmetric: &DMatrix<f64>) -> (f64, f64) {
    let symmetric = (symmetric + symmetric.transpose()) * 0.5;
    let eigenvalues = symmetric.symmetric_eigenvalues();
    (eigenvalues.min(), eigenvalues.max())
}

/// The matrix of a function, column by column from the unit vectors.
fn columns(n: usize, mut apply: impl FnMut(&[f64], &mut [f64])) -> DMatrix<f64> {
    let mut full = DMatrix::zeros(n, n);
    let (mut unit, mut column) = (vec![0.0; n], vec![0.0; n]);
    for j in 0..n {
        unit.fill(0.0);
        unit[j] = 1.0;
        apply(&unit, &mut column);
        full.set_column(j, &DVector::from_row_slice(&column));
    }
    full
}

/// The eigenvalues of `inverse(P) S` for a symmetric positive definite inverse.
fn of_pencil(inverse: &DMatrix<f64>, s: &DMatrix<f64>) -> (f64, f64) {
    let symmetric = (inverse + inverse.transpose()) * 0.5;
    let root = symmetric.cholesky().expect("positive definite").l();
    extremes(&(root.transpose() * s * root))
}

/// The largest eigenvalue of `blockdiag(S)^-1 S` on the directions in which a cell has stiffness.
fn tight_gamma(s: &DMatrix<f64>) -> f64 {
    let n = s.nrows();
    let mut root = DMatrix::zeros(n, n);
    for cell in 0..n / 3 {
        let block = s.view((3 * cell, 3 * cell), (3, 3)).into_owned();
        let eigen = block.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let inverse = |value: f64| {
            if value > 1e-9 * largest {
                value.sqrt().recip()
            } else {
                0.0
            }
        };
        let diagonal = DMatrix::from_diagonal(&eigen.eigenvalues.map(inverse));
        let block = &eigen.eigenvectors * diagonal * eigen.eigenvectors.transpose();
        root.view_mut((3 * cell, 3 * cell), (3, 3))
            .copy_from(&block);
    }
    extremes(&(&root * s * &root)).1
}

/// 2/omega_max by dense arithmetic.
fn dense_critical_step(operators: &LinearOperators) -> f64 {
    let root = mass(operators).map(|m| if m > 0.0 { m.sqrt().recip() } else { 0.0 });
    2.0 / extremes(&(&root * stiffness(operators) * &root)).1.sqrt()
}

/// The step at which `dt/2 D' + dt^2/4 K` reaches M, by dense arithmetic.
fn damped_limit(operators: &LinearOperators) -> f64 {
    let (mut low, mut high) = (0.0, dense_critical_step(operators));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if dense_need(operators, middle) < 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Each kind with its number of sweeps.
fn inners(sweeps: [u32; 3]) -> [Inner; 4] {
    [
        Inner::Block,
        Inner::Jacobi { sweeps: sweeps[0] },
        Inner::Chebyshev { sweeps: sweeps[1] },
        Inner::GaussSeidel { sweeps: sweeps[2] },
    ]
}

/// Damping of a body.
#[derive(Clone, Copy, Debug)]
struct Damped {
    mass: bool,
    stiffness: bool,
    dashpots: bool,
    /// Share of the critical damping of the fastest motion.
    ratio: f64,
}

fn damped() -> impl Strategy<Value = Damped> {
    let kinds = prop_oneof![
        Just([false; 3]),
        Just([true, false, false]),
        Just([false, true, false]),
        Just([false, false, true]),
        Just([true; 3]),
    ];
    (kinds, -2.0..1.0).prop_map(|([mass, stiffness, dashpots], power)| Damped {
        mass,
        stiffness,
        dashpots,
        ratio: 10.0_f64.powf(power),
    })
}

impl Damped {
    /// The body with this damping only.
    fn model(self, mut body: Body) -> Model {
        let law = Law::Springs {
            youngs_modulus: 3500.0,
            rule: SpringRule::Lloyd,
            calibrate: false,
            damping_ratio: self.ratio,
        };
        if self.dashpots {
            body.problem.regions[0].law = law;
        } else {
            body = body.without_dashpots();
        }
        body.problem.damping.mass = 0.0;
        body.problem.damping.stiffness = 0.0;
        let omega = 2.0 / critical_step(body.model().operators());
        if self.mass {
            body.problem.damping.mass = 2.0 * self.ratio * omega;
        }
        if self.stiffness {
            body.problem.damping.stiffness = 2.0 * self.ratio / omega;
        }
        body.model()
    }
}

fn rules() -> impl Strategy<Value = GammaRule> {
    prop_oneof![Just(GammaRule::Power), Just(GammaRule::Gershgorin)]
}

fn blends() -> impl Strategy<Value = Blend> {
    prop_oneof![Just(Blend::Auto), Just(Blend::Full)]
}

fn damping_shares() -> impl Strategy<Value = DampingShare> {
    prop_oneof![Just(DampingShare::AsStiffness), Just(DampingShare::Whole)]
}

/// Shares from .1 to 1000 times the critical step.
fn shares() -> impl Strategy<Value = f64> {
    (-1.0..3.0).prop_map(|power| 10.0_f64.powf(power))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn p_is_symmetric_above_a_and_certified(
        body in bodies_up_to(2),
        damped in damped(),
        of_damped in any::<bool>(),
        share in shares(),
        rule in rules(),
        blend in blends(),
        sweeps in [1..=6_u32, 1..=6_u32, 1..=6_u32],
    ) {
        let model = damped.model(body);
        let operators = model.operators();
        // Steps about the limit under this damping matter as much as those about the undamped one.
        let undamped = critical_step(operators);
        let dt = share * if of_damped { damped_limit(operators) } else { undamped };
        let n = operators.dofs();
        let (k, d) = (stiffness(operators), damping(operators));
        let required = &d * (dt / 2.0) + &k * (dt * dt / 4.0);
        for inner in inners(sweeps) {
            let p = Stabiliser::new(operators, dt, rule, blend, inner);
            let mut a = mass_with_damping(operators, dt);
            if !p.majorant().mass_suffices() {
                a += added(operators, dt, p.majorant());
            }
            let inverse = columns(n, |x, out| p.solve(x, out));
            let asymmetry = (&inverse - inverse.transpose()).amax() / inverse.amax();
            prop_assert!(asymmetry <= 1e-10, "{inner:?}: {asymmetry:e}");
            let (least, largest) = of_pencil(&inverse, &a);
            prop_assert!(least > 0.0, "{inner:?}: {least:e}");
            prop_assert!(largest <= 1.0 + DENSE, "{inner:?}: P^-1 A up to 1 + {:e}", largest - 1.0);
            let (certificate, expected) = (p.certificate(), of_pencil(&inverse, &required).1);
            prop_assert!(certificate < 1.0, "{inner:?}: 1 + {:e}", certificate - 1.0);
            prop_assert!(
                (certificate / expected - 1.0).abs() <= 1e-6,
                "{inner:?}: {certificate} {expected}"
            );
        }
    }

    /// The block majorant itself, computed in full.
    #[test]
    fn one_block_per_cell_is_the_sum_it_says(
        body in bodies_up_to(2),
        damped in damped(),
        share in shares(),
        rule in rules(),
        blend in blends(),
        of_damping in damping_shares(),
    ) {
        let model = damped.model(body);
        let operators = model.operators();
        let (n, dt) = (operators.dofs(), share * critical_step(operators));
        let majorant = Majorant::new(operators, dt, rule, blend, of_damping);
        let p = mass_with_damping(operators, dt)
            + blockdiag(&added(operators, dt, &majorant)) * majorant.gamma();
        let inverse = columns(n, |x, out| {
            out.copy_from_slice(x);
            majorant.inverse().multiply_in_place(0, out);
        });
        let off = (inverse * &p - DMatrix::identity(n, n)).amax();
        prop_assert!(off <= 1e-8, "{off:e}");
        let least = extremes(&(mass(operators) - &p * majorant.floor())).0;
        prop_assert!(least >= -1e-9 * p.amax() * majorant.floor(), "{least:e}");
        prop_assert_eq!(majorant.gamma() == 0.0, majorant.mass_suffices());
    }

    /// The eigenvalue from the iteration is raised by a thousandth, so that it may exceed the circles by as much.
    #[test]
    fn circles_bound_the_iteration_and_both_bound_the_eigenvalue(
        body in bodies_up_to(2),
        damped in damped(),
        of_damping in damping_shares(),
    ) {
        let model = damped.model(body);
        let operators = model.operators();
        let dt = 2.0 * critical_step(operators);
        let of = |rule| Majorant::new(operators, dt, rule, Blend::Auto, of_damping);
        let (power, circles) = (of(GammaRule::Power), of(GammaRule::Gershgorin));
        let tight = tight_gamma(&added(operators, dt, &power)).max(1.0);
        let (power, circles) = (power.gamma(), circles.gamma());
        prop_assert!(power >= tight, "{power} {tight}");
        prop_assert!(power <= 1.0011 * tight, "{power} {tight}");
        prop_assert!(circles >= tight * (1.0 - 1e-12), "{circles} {tight}");
        prop_assert!(circles * 1.001 >= power * (1.0 - 1e-9), "{circles} {power}");
    }

    #[test]
    fn springs_obey_two_times_their_blocks(body in bodies_up_to(2), damped in damped()) {
        let mut body = body;
        for region in &mut body.problem.regions {
            region.law = Law::Springs {
                youngs_modulus: 3500.0,
                rule: SpringRule::VanGelder,
                calibrate: false,
                damping_ratio: 0.0,
            };
        }
        let k = stiffness(damped.model(body).operators());
        let least = extremes(&(blockdiag(&k) * 2.0 - &k)).0;
        prop_assert!(least >= -1e-12 * k.amax(), "{least:e}");
    }

    #[test]
    fn tetrahedra_obey_four_times_their_blocks(
        body in bodies_up_to(2),
        poissons_ratio in -0.5..0.499,
    ) {
        let mut body = body;
        for region in &mut body.problem.regions {
            region.law = Law::linear(3500.0, poissons_ratio);
        }
        let k = stiffness(body.model().operators());
        let least = extremes(&(blockdiag(&k) * 4.0 - &k)).0;
        prop_assert!(least >= -1e-12 * k.amax(), "{least:e}");
    }

    #[test]
    fn nothing_is_added_below_99_hundredths_of_the_limit(
        body in bodies_up_to(2),
        damped in damped(),
        share in shares(),
    ) {
        let model = damped.model(body);
        let operators = model.operators();
        let limit = damped_limit(operators);
        let of = |dt, damping| Majorant::new(operators, dt, GammaRule::Power, Blend::Auto, damping);
        let block = |dt| of(dt, DampingShare::AsStiffness);
        // At .99 of the limit dt/2 D' needs .99, dt^2/4 K .99^2 of M.
        prop_assert!(block(0.98 * limit).adds_nothing());
        prop_assert!(!block(0.9901 * limit).adds_nothing());
        let dt = share * limit;
        let expected = (1.0 - 0.99 * 0.99 / dense_need(operators, dt)).max(0.0);
        prop_assert!((block(dt).s() - expected).abs() <= 1e-6, "{expected}");
        prop_assert_eq!(block(dt).damping_share(), block(dt).s());
        let whole = of(dt, DampingShare::Whole);
        prop_assert_eq!(whole.mass_suffices(), block(dt).mass_suffices());
        let undamped = dense_critical_step(operators);
        let expected = (1.0 - (0.99 * undamped / dt).powi(2)).max(0.0);
        prop_assert!((whole.s() - expected).abs() <= 1e-6, "{expected}");
        prop_assert_eq!(whole.damping_share(), 1.0);
        for damping in [DampingShare::AsStiffness, DampingShare::Whole] {
            let full = Majorant::new(operators, dt, GammaRule::Power, Blend::Full, damping);
            prop_assert_eq!((full.s(), full.damping_share()), (1.0, 1.0));
            prop_assert!(!full.mass_suffices());
        }
    }
}

fn cube(cells: usize, law: Law, axes: [bool; 3]) -> Model {
    let mesh = structured::cube(cells, 0.1, Split::Kuhn).unwrap();
    let problem =
        Problem::of([Region::new(law, 1060.0)]).with_fixed(Fixed::at("sides").along(axes));
    Model::build(&mesh, &problem).unwrap()
}

fn springs(rule: SpringRule) -> Law {
    Law::Springs {
        youngs_modulus: 3500.0,
        rule,
        calibrate: false,
        damping_ratio: 0.0,
    }
}

#[test]
fn gamma_of_the_paper_s_cube() {
    let linear = |poissons_ratio| Law::linear(3500.0, poissons_ratio);
    for (law, expected) in [
        (springs(SpringRule::Lloyd), 1.974),
        (springs(SpringRule::VanGelder), 1.984),
        (linear(0.45), 2.635),
        (linear(0.49), 2.862),
    ] {
        let model = cube(10, law, [true; 3]);
        let of = |rule| {
            let damping = DampingShare::AsStiffness;
            Majorant::new(model.operators(), 0.02, rule, Blend::Full, damping).gamma()
        };
        let power = of(GammaRule::Power);
        assert!(
            (power / 1.001 - expected).abs() <= 1e-3,
            "{power} {expected}"
        );
        assert!(of(GammaRule::Gershgorin) >= power);
    }
}

/// A cell with fixed components keeps them separate from the rest.
#[test]
fn what_is_held_neither_gives_nor_takes() {
    let model = cube(2, springs(SpringRule::Lloyd), [false, false, true]);
    let held: Vec<usize> = (0..model.dofs())
        .filter(|dof| model.pinned()[*dof])
        .collect();
    assert!(!held.is_empty() && held.len() < model.dofs() / 2);
    let dt = 20.0 * critical_step(model.operators());
    for inner in inners([3, 4, 2]) {
        for rule in [GammaRule::Power, GammaRule::Gershgorin] {
            let p = Stabiliser::new(model.operators(), dt, rule, Blend::Auto, inner);
            let inverse = columns(model.dofs(), |x, out| p.solve(x, out));
            for dof in &held {
                for other in (0..model.dofs()).filter(|other| other != dof) {
                    assert_eq!(inverse[(*dof, other)], 0.0, "{inner:?}");
                    assert_eq!(inverse[(other, *dof)], 0.0, "{inner:?}");
                }
                assert!(inverse[(*dof, *dof)] > 0.0, "{inner:?}");
            }
            assert!(p.certificate() < 1.0, "{inner:?}");
        }
    }
}

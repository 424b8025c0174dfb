//! Comparison of curves with closed forms and independent solutions.

use super::*;
use crate::hyperelastic::fibres::{Fibres, Stiffening};
use crate::hyperelastic::{Deformation, Hyperelastic, Parameters, Tensor};
use crate::{FibreFamily, Law, Region};

const X: [f64; 3] = [1.0, 0.0, 0.0];

fn region(id: &'static str, parameters: Parameters) -> Region {
    Region::new(Law::hyperelastic(id, parameters), 1060.0)
}

fn curve_of(region: &Region, load: Load, along: [f64; 3], between: [f64; 2]) -> Curve {
    let axes = Axes::along(along).unwrap();
    Solid::of(region).unwrap().curve(load, &axes, between, &[])
}

/// The largest difference of the nominal stress from a formula, over the largest stress of the formula.
fn error(curve: &Curve, formula: impl Fn(f64) -> f64) -> f64 {
    let pairs = curve.states.iter();
    let pairs = pairs.map(|state| (state.nominal, formula(state.amount)));
    let largest = |size: fn((f64, f64)) -> f64| pairs.clone().map(size).fold(0.0, f64::max);
    largest(|(found, expected)| (found - expected).abs()) / largest(|(_, expected)| expected.abs())
}

fn with_fibres(mut region: Region, kind: Stiffening, direction: [f64; 3]) -> Region {
    let fibres = Fibres::new(kind).unwrap();
    region.tissue.fibres = vec![FibreFamily::new(fibres, direction)];
    region
}

/// Treloar, The Physics of Rubber Elasticity (1975), chapter 5; the difference is compressibility, some mu/lambda.
#[test]
fn a_nearly_incompressible_neo_hookean_body_has_the_curves_of_rubber() {
    let (mu, nu) = (1000.0, 0.499_999_9);
    let region = region(
        "neo-hookean-iso",
        Parameters::new(2.0 * mu * (1.0 + nu), nu),
    );
    let uniaxial = |l: f64| mu * (l - l.powi(-2));
    let equibiaxial = |l: f64| mu * (l - l.powi(-5));
    let planar = |l: f64| mu * (l - l.powi(-3));
    for (load, formula) in [
        (Load::Uniaxial, &uniaxial as &dyn Fn(f64) -> f64),
        (Load::Equibiaxial, &equibiaxial),
        (Load::Planar, &planar),
    ] {
        for along in [X, [0.0, 0.0, 1.0], [1.0, -2.0, 0.5]] {
            let curve = curve_of(&region, load, along, [0.4, 3.0]);
            assert_eq!(curve.ends, [End::default(); 2], "{load}");
            let error = error(&curve, formula);
            assert!(error < 1e-5, "{load}: {error}");
            for state in &curve.states {
                let cauchy = state.nominal * state.amount;
                assert!(
                    (state.cauchy - cauchy).abs() < 1e-5 * cauchy.abs().max(mu),
                    "{load}"
                );
            }
        }
    }
    let shear = curve_of(&region, Load::SimpleShear, X, [-1.0, 2.0]);
    assert!(error(&shear, |g| mu * g) < 1e-12);
}

/// One equation for the stretch across, solved by halving.
fn neo_hookean_across(lame: (f64, f64), volume: impl Fn(f64) -> f64) -> f64 {
    let (lambda, mu) = lame;
    let (mut low, mut high) = (1e-3_f64, 1e3_f64);
    for _ in 0..200 {
        let c = 0.5 * (low + high);
        let j = volume(c);
        // mu (c^2 - 1) + lambda J (J - 1), of one sign on each side of its root.
        if mu * (c * c - 1.0) + lambda * j * (j - 1.0) < 0.0 {
            low = c;
        } else {
            high = c;
        }
    }
    0.5 * (low + high)
}

#[test]
fn a_compressible_neo_hookean_body_has_the_stretch_across_of_its_own_equation() {
    let region = region("neo-hookean", Parameters::new(3500.0, 0.3));
    let (lambda, mu) = Solid::of(&region).unwrap().lame();
    // Nominal stress along by J = l j, j the part of the other two stretches.
    let stress = |l: f64, j: f64| mu * (l - 1.0 / l) + lambda * (l * j - 1.0) * j;
    let uniaxial = |l: f64| {
        let c = neo_hookean_across((lambda, mu), |c| l * c * c);
        stress(l, c * c)
    };
    let equibiaxial = |l: f64| {
        let c = neo_hookean_across((lambda, mu), |c| l * l * c);
        stress(l, l * c)
    };
    let planar = |l: f64| {
        let c = neo_hookean_across((lambda, mu), |c| l * c);
        stress(l, c)
    };
    for (load, formula) in [
        (Load::Uniaxial, &uniaxial as &dyn Fn(f64) -> f64),
        (Load::Equibiaxial, &equibiaxial),
        (Load::Planar, &planar),
    ] {
        let error = error(&curve_of(&region, load, X, [0.3, 3.0]), formula);
        assert!(error < 1e-9, "{load}: {error}");
    }
    let planar = curve_of(&region, Load::Planar, X, [0.3, 3.0]);
    for state in planar.states {
        let c = state.volume_ratio / state.amount;
        let across = lambda * (state.volume_ratio - 1.0) * state.amount * c;
        assert!((state.nominal_across - across).abs() < 1e-8 * 3500.0);
    }
}

#[test]
fn a_linear_law_has_straight_lines() {
    let (e, nu) = (3500.0, 0.45);
    let region = Region::new(Law::linear(e, nu), 1060.0);
    for (load, stiffness) in [
        (Load::Uniaxial, e),
        (Load::Equibiaxial, e / (1.0 - nu)),
        (Load::Planar, e / (1.0 - nu * nu)),
        (Load::SimpleShear, e / (2.0 * (1.0 + nu))),
    ] {
        let curve = curve_of(&region, load, [1.0, 1.0, 0.0], [0.5, 2.0]);
        assert!(
            error(&curve, |x| stiffness * (x - load.rest())) < 1e-12,
            "{load}"
        );
        assert_eq!(curve.ends, [End::default(); 2]);
        assert!(
            curve
                .states
                .iter()
                .all(|state| state.cauchy == state.nominal)
        );
    }
}

/// With nu = 0 nothing moves across: tau = E/2 (l^4 - l^2) turns at l^2 = 1/2, the nominal stress E/2 (l^3 - l) at l^2
/// = 1/3.
#[test]
fn a_bar_of_saint_venant_and_kirchhoff_gives_way_where_its_stress_turns() {
    let region = region("stvk", Parameters::new(2000.0, 0.0));
    let axes = Axes::along(X).unwrap();
    let solid = Solid::of(&region).unwrap();
    let curve = solid.curve(Load::Uniaxial, &axes, [0.3, 1.5], &[]);
    let [pressed, pulled] = curve.ends;
    let limit = pressed.limit.unwrap();
    assert!((limit - 0.5_f64.sqrt()).abs() < 1e-9, "{limit}");
    let falls = pressed.falls_from.unwrap();
    assert!((falls - 3.0_f64.sqrt().recip()).abs() < 1e-6, "{falls}");
    assert_eq!(pulled, End::default());
    assert_eq!(curve.stable()[0], limit);
    assert_eq!(curve.stable()[1], 1.5);
    let beyond = curve.states.iter().filter(|state| !state.is_stable);
    assert!(beyond.clone().count() > 100 && beyond.clone().all(|state| state.amount < limit));
}

/// Incompressible, `tau = 2 (l^2 - 1/l) W'` with W' = c1 + 2 c2 (I1 - 3) turns where
/// `(2 l^2 + 1/l) W' + 4 c2 (l^2 - 1/l)^2 = 0`.
#[test]
fn a_yeoh_law_that_softens_is_stable_up_to_its_turning_point() {
    let (c1, c2) = (500.0, -20.0);
    let parameters = Parameters::default()
        .with("c", &[c1, c2])
        .with("poissons_ratio", &[0.499_999]);
    let curve = curve_of(&region("yeoh", parameters), Load::Uniaxial, X, [0.8, 3.0]);
    let turning = |l: f64| {
        let slope = c1 + 2.0 * c2 * (l * l + 2.0 / l - 3.0);
        (2.0 * l * l + 1.0 / l) * slope + 4.0 * c2 * (l * l - 1.0 / l).powi(2)
    };
    let (mut low, mut high) = (1.0, 3.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if turning(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let limit = curve.ends[1].limit.unwrap();
    assert!((limit / low - 1.0).abs() < 1e-4, "{limit} {low}");
    // tau = l T turns beyond T.
    let falls = curve.ends[1].falls_from.unwrap();
    assert!(falls < limit && falls > 2.0, "{falls}");
    assert_eq!(curve.ends[0], End::default());
}

/// With both constants above 0 the energy is convex in logarithmic strains.
#[test]
fn a_mooney_rivlin_law_is_stable_in_every_load() {
    let parameters = Parameters::new(3000.0, 0.4999).with("c1_over_c2", &[1.0]);
    let (mu, c) = (3000.0 / (2.0 * 1.4999), 3000.0 / (2.0 * 1.4999) / 4.0);
    for load in Load::ALL {
        let curve = curve_of(
            &region("mooney-rivlin", parameters.clone()),
            load,
            X,
            [0.4, 3.0],
        );
        assert_eq!(curve.ends, [End::default(); 2], "{load}");
        // Rivlin's curves of an incompressible body: (l^2 - m^2) (2 C1 + 2 C2 n^2)/l.
        let formula = |l: f64| match load {
            Load::Uniaxial => 2.0 * (l - l.powi(-2)) * (c + c / l),
            Load::Equibiaxial => 2.0 * (l - l.powi(-5)) * (c + c * l * l),
            Load::Planar => 2.0 * (l - l.powi(-3)) * (c + c),
            Load::SimpleShear => mu * l,
        };
        let error = error(&curve, formula);
        assert!(error < 5e-3, "{load}: {error}");
    }
}

#[test]
fn fibres_along_the_pull_add_their_own_stress_in_tension() {
    let eta = 2000.0;
    let plain = region("neo-hookean", Parameters::new(3500.0, 0.4));
    let along = [0.3, 0.4, -1.2];
    let fibred = with_fibres(plain.clone(), Stiffening::Quadratic { eta }, along);
    let [plain, fibred] =
        [plain, fibred].map(|region| curve_of(&region, Load::Uniaxial, along, [0.6, 1.8]));
    for (plain, fibred) in plain.states.iter().zip(&fibred.states) {
        let l = plain.amount;
        let own = 2.0 * eta * (l * l - 1.0).max(0.0) * l;
        let difference = fibred.nominal - plain.nominal - own;
        assert!(
            difference.abs() < 1e-9 * (3500.0 + own),
            "{l}: {difference}"
        );
    }
}

/// With a0 = (c, s, 0): F a0 = (c + g s, s, 0), and P a shear of `mu g + 2 eta X (c + g s) s`.
#[test]
fn fibres_across_a_shear_stretch_one_way() {
    let (eta, degrees) = (2000.0, 35.0_f64);
    let (s, c) = degrees.to_radians().sin_cos();
    let plain = region("neo-hookean", Parameters::new(3500.0, 0.4));
    let (_, mu) = Solid::of(&plain).unwrap().lame();
    let region = with_fibres(plain, Stiffening::Quadratic { eta }, [c, s, 0.0]);
    let curve = curve_of(&region, Load::SimpleShear, X, [-1.0, 1.0]);
    let formula = |g: f64| {
        let x = ((c + g * s).powi(2) + s * s - 1.0).max(0.0);
        mu * g + 2.0 * eta * x * (c + g * s) * s
    };
    assert!(error(&curve, formula) < 1e-12);
}

/// Free and fixed components do no work, so the nominal stress is the slope of the energy of all states.
#[test]
fn oblique_fibres_are_pulled_at_the_least_energy() {
    let kind = Stiffening::Exponential {
        k1: 1500.0,
        k2: 0.8,
        dispersion: 0.1,
    };
    let direction = [1.0, 0.7, -0.4];
    let parameters = Parameters::new(3500.0, 0.45);
    let law = Hyperelastic::new("neo-hookean", &parameters).unwrap();
    let region = with_fibres(region("neo-hookean", parameters), kind, direction);
    let solid = Solid::of(&region).unwrap();
    let axes = Axes::along([0.0, 1.0, 0.2]).unwrap();
    let family = &region.tissue.fibres[0];
    let unit = family.direction.unit();
    let energy = |loaded: &equilibrium::Loaded<'_>, amount: f64| {
        let mut free = loaded.at_rest();
        for step in 1..=20 {
            let way = loaded.load.rest() + f64::from(step) / 20.0 * (amount - loaded.load.rest());
            free = loaded.solve(way, &free).unwrap();
        }
        let h: Tensor<f64> = loaded.gradient(amount, &free);
        let at = family.fibres.at(&Deformation::of(h), unit);
        law.energy(h) + family.fibres.energy(&at)
    };
    for load in Load::ALL {
        let loaded = equilibrium::Loaded {
            solid: &solid,
            axes: &axes,
            load,
        };
        let curve = solid.curve(load, &axes, [load.rest() - 0.4, load.rest() + 0.6], &[]);
        assert_eq!(curve.ends.map(|end| end.lost), [None; 2]);
        // A sheet that is stretched alike along two axes does work along both.
        for state in curve.states.iter().step_by(5) {
            let step = 1e-5;
            let slope = energy(&loaded, state.amount + step) - energy(&loaded, state.amount - step);
            let slope = slope / (2.0 * step);
            let found = match load {
                Load::Equibiaxial => state.nominal + state.nominal_across,
                _ => state.nominal,
            };
            assert!(
                (found - slope).abs() < 1e-4 * 3500.0,
                "{load} {}: {found} {slope}",
                state.amount
            );
        }
    }
}

#[test]
fn a_curve_ends_where_there_is_no_state() {
    let region = region("neo-hookean", Parameters::new(3500.0, 0.3));
    let curve = curve_of(&region, Load::Uniaxial, X, [-0.5, 1.5]);
    let [pressed, pulled] = curve.ends;
    let lost = pressed.lost.unwrap();
    assert!(lost > 0.0 && lost < 0.1, "{lost}");
    assert_eq!(curve.states[0].amount, lost);
    assert_eq!((pulled.lost, curve.asked), (None, [-0.5, 1.5]));
    assert_eq!(curve.at(-0.3), None);
}

/// Free thickness c of a sheet: `c^2 = 1 - 2 nu/(1 - nu) (l^2 - 1)`, which vanishes at `l^2 = 1 + (1 - nu)/(2 nu)`.
#[test]
fn a_sheet_of_saint_venant_and_kirchhoff_thins_to_nothing() {
    let nu = 0.45_f64;
    let region = region("stvk", Parameters::new(2000.0, nu));
    let curve = curve_of(&region, Load::Equibiaxial, X, [0.9, 1.6]);
    let expected = (1.0 + (1.0 - nu) / (2.0 * nu)).sqrt();
    let lost = curve.ends[1].lost.unwrap();
    assert!(
        lost < expected && lost > expected - 0.011,
        "{lost} {expected}"
    );
    for state in &curve.states {
        let l = state.amount;
        let c = (1.0 - 2.0 * nu / (1.0 - nu) * (l * l - 1.0)).sqrt();
        let found = state.volume_ratio / (l * l);
        assert!((found - c).abs() < 1e-6, "{l}: {found} {c}");
    }
}

#[test]
fn springs_have_no_curve() {
    let law = Law::Springs {
        youngs_modulus: 1000.0,
        rule: crate::SpringRule::Lloyd,
        calibrate: false,
        damping_ratio: 0.0,
    };
    let refused = Solid::of(&Region::new(law, 1000.0)).unwrap_err();
    assert_eq!(refused, HomogeneousError::Springs);
}

/// The axes of the material turned together with the pull: the curves stay the same.
#[test]
fn a_material_with_axes_is_pulled_along_them() {
    let b = [0.9, 0.6, 0.3, 0.06, -0.03, 0.09, 0.24, 0.18, 0.21];
    let parameters = Parameters::default()
        .with("c", &[4000.0])
        .with("b", &b)
        .with("bulk_modulus", &[3e4]);
    let straight = region("fung", parameters);
    let mut turned = straight.clone();
    turned.tissue.axes = Some([[0.0, 2.0, 0.0], [0.0, 0.0, 1.0]].map(Into::into));
    let of = |region: &Region, along| {
        let axes = Axes::along(along).unwrap();
        let solid = Solid::of(region).unwrap();
        assert!(solid.has_directions());
        Load::ALL.map(|load| solid.curve(load, &axes, [load.rest() - 0.2, load.rest() + 0.3], &[]))
    };
    let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let [expected, found, other] =
        [(&straight, x), (&turned, y), (&straight, y)].map(|(region, along)| of(region, along));
    let last = |curves: &[Curve; 4]| {
        curves
            .each_ref()
            .map(|curve| curve.states.last().unwrap().nominal)
    };
    let [expected, found, other] = [&expected, &found, &other].map(last);
    for ((expected, found), other) in expected.iter().zip(&found).zip(&other) {
        assert!((found / expected - 1.0).abs() < 1e-9);
        assert!((other / expected - 1.0).abs() > 1e-3);
    }
}

/// Constants of Yeoh's law whose stiffness dips below 0 within a few per cent of stretch.
#[test]
fn no_verdict_depends_on_the_range_that_is_drawn() {
    for c2 in [-320.0, -308.0] {
        let constants = Parameters::default()
            .with("c", &[600.0, c2, 90.0])
            .with("poissons_ratio", &[0.49]);
        let region = region("yeoh", constants);
        for load in Load::ALL {
            let shift = load.rest() - 1.0;
            let limits = [2.0, 5.0, 20.0, 100.0].map(|to| {
                let curve = curve_of(&region, load, X, [0.7 + shift, to + shift]);
                curve.ends[1].limit
            });
            let [first, others @ ..] = limits;
            for other in others {
                let same = match (first, other) {
                    (Some(first), Some(other)) => (first - other).abs() < 1e-6,
                    (None, None) => true,
                    _ => false,
                };
                assert!(same, "{c2} {load}: {limits:?}");
            }
        }
    }
    let narrow = Parameters::default()
        .with("c", &[600.0, -320.0, 90.0])
        .with("poissons_ratio", &[0.49]);
    let curve = curve_of(&region("yeoh", narrow), Load::Uniaxial, X, [0.7, 100.0]);
    let limit = curve.ends[1].limit.unwrap();
    assert!((limit - 1.508).abs() < 5e-4, "{limit}");
    let beyond = curve.states.iter().find(|state| state.amount > 1.6);
    assert!(beyond.is_some_and(|state| !state.is_stable));
}

/// Its least eigenvalue is that of volume, 3 kappa; the others are at least 1e17 times as large.
#[test]
fn a_law_that_stiffens_by_many_powers_of_ten_is_stable() {
    let skin = Parameters::default()
        .with("c1", &[4.0])
        .with("c2", &[300.0])
        .with("poissons_ratio", &[0.49]);
    let region = region("veronda-westmann", skin);
    let curve = curve_of(&region, Load::SimpleShear, X, [-0.3, 0.7]);
    assert_eq!(curve.ends.map(|end| end.limit), [None; 2]);
}

#[test]
fn amounts_that_are_asked_for_are_states() {
    let region = region("neo-hookean-iso", Parameters::new(3000.0, 0.45));
    let axes = Axes::along(X).unwrap();
    let solid = Solid::of(&region).unwrap();
    let at = |to: f64, amounts: &[f64]| {
        let curve = solid.curve(Load::Uniaxial, &axes, [0.7, to], amounts);
        assert!(
            curve
                .states
                .windows(2)
                .all(|pair| pair[0].amount < pair[1].amount)
        );
        curve.at(1.2401).unwrap()
    };
    let exact = at(2.0, &[1.2401]);
    assert!((at(100.0, &[0.8, 1.2401, 200.0, 1.2401]) / exact - 1.0).abs() < 1e-9);
    assert!((at(100.0, &[]) / exact - 1.0).abs() < 1e-4);
}

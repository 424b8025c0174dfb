//! The first contact of moving points, compared with a march along their path.

use crate::common::{add, dot, is_inside, length, scaled, shapes, size, sub, vectors};
use proptest::prelude::*;
use sinew_tools::{Convex, Touch};

/// A shape and the two ends of a path in its neighbourhood.
fn ways() -> impl Strategy<Value = (Convex, [f64; 3], [f64; 3])> {
    // A long way from anywhere, one next to a long thin shape, one along an axis.
    let aims = (shapes(), vectors(), vectors(), 0.5..4.0_f64, 0..5_usize);
    aims.prop_map(|(convex, from, aim, far, kind)| {
        let unit = size(&convex);
        let from = scaled(from, 2.0 * unit);
        let target = convex.nearest(scaled(aim, unit)).point;
        let mut motion = scaled(sub(target, from), far);
        if kind < 3 {
            motion = [0, 1, 2].map(|axis| if axis == kind { motion[axis] } else { 0.0 });
        }
        (convex, from, add(from, motion))
    })
}

/// A path that begins on the surface.
fn ways_from_the_surface() -> impl Strategy<Value = (Convex, [f64; 3], [f64; 3])> {
    (shapes(), vectors(), vectors(), -3.0..1.0_f64).prop_map(|(convex, from, motion, power)| {
        let unit = size(&convex);
        let from = convex.nearest(scaled(from, 2.0 * unit)).point;
        let motion = scaled(motion, unit * 10.0_f64.powf(power));
        (convex, from, add(from, motion))
    })
}

fn at(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    add(from, scaled(sub(to, from), share))
}

/// First share at which the point is more than `margin` inside, by a march in equal steps.
fn march(convex: &Convex, from: [f64; 3], to: [f64; 3], margin: f64) -> Option<f64> {
    let shares = (0..=2000).map(|step| f64::from(step) / 2000.0);
    let mut shares = shares.into_iter();
    shares.find(|share| is_inside(convex, at(from, to, *share), margin))
}

/// Checks properties of any contact of a point that begins outside.
fn is_an_entry(
    convex: &Convex,
    from: [f64; 3],
    to: [f64; 3],
    touch: &Touch,
) -> Result<(), TestCaseError> {
    let unit = size(convex);
    prop_assert!((0.0..=1.0).contains(&touch.share));
    prop_assert!((length(touch.normal) - 1.0).abs() < 1e-15);
    prop_assert!(
        length(sub(at(from, to, touch.share), touch.point)) < 1e-11 * unit,
        "{touch:?}"
    );
    prop_assert!(convex.nearest(touch.point).distance.abs() < 1e-14 * unit);
    prop_assert!(dot(touch.normal, sub(to, from)) < 0.0);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_march_along_the_way_finds_the_same((convex, from, to) in ways()) {
        let unit = size(&convex);
        let touch = convex.first_contact(from, to);
        let marched = march(&convex, from, to, 1e-10 * unit);
        let Some(touch) = touch else {
            prop_assert_eq!(marched, None);
            return Ok(());
        };
        if is_inside(&convex, from, 0.0) {
            let nearest = convex.nearest(from);
            prop_assert_eq!(touch, Touch { share: 0.0, point: nearest.point, normal: nearest.normal });
            return Ok(());
        }
        is_an_entry(&convex, from, to, &touch)?;
        // Nothing was inside before, and what the march found came after.
        prop_assert!(marched.is_none_or(|marched| touch.share <= marched));
        let before = at(from, to, touch.share * (1.0 - 1e-9));
        prop_assert!(!is_inside(&convex, before, 1e-11 * unit));
        let first_step = (touch.share * 2000.0).ceil() + 1.0;
        let motion = length(sub(to, from));
        // A way that goes in steeply and far is inside at the march's next step.
        let inwards = -dot(touch.normal, sub(to, from)) / motion;
        let thin = match convex {
            Convex::Sphere { radius, .. } | Convex::Capsule { radius, .. } => radius,
            Convex::Cuboid { .. } => 0.0,
            _ => f64::INFINITY,
        };
        if inwards > 0.3 && motion / 1000.0 < 0.3 * thin && first_step < 2000.0 {
            prop_assert!(marched.is_some_and(|marched| marched <= first_step / 2000.0));
        }
    }

    #[test]
    fn what_is_above_the_tangent_plane_is_outside((convex, from, to) in ways(), other in vectors()) {
        let Some(touch) = convex.first_contact(from, to) else {
            return Ok(());
        };
        let unit = size(&convex);
        let other = scaled(other, 2.0 * unit);
        let height = dot(touch.normal, sub(other, touch.point)).min(0.0);
        let lifted = sub(other, scaled(touch.normal, height));
        prop_assert!(convex.nearest(lifted).distance >= -1e-12 * unit);
    }

    /// Each step of a lasting contact begins on the surface.
    #[test]
    fn a_point_that_is_pushed_in_from_the_surface_is_found((convex, from, to) in ways_from_the_surface()) {
        let unit = size(&convex);
        let way = length(sub(to, from));
        if march(&convex, from, to, 1e-11 * unit).is_none() {
            return Ok(());
        }
        let touch = convex.first_contact(from, to);
        prop_assert!(touch.is_some());
        // Its rounding, or an edge that was cut, lies at the beginning.
        let touch = touch.unwrap();
        prop_assert!(touch.share * way < 1e-6 * unit, "{touch:?}");
    }

    #[test]
    fn a_point_that_leaves_the_surface_is_free((convex, from, to) in ways_from_the_surface()) {
        // Outside by a little, so that rounding has not put it inside.
        let unit = size(&convex);
        let normal = convex.nearest(from).normal;
        let lifted = add(from, scaled(normal, 1e-11 * unit));
        let motion = sub(to, from);
        let normal = convex.nearest(lifted).normal;
        let motion = if dot(motion, normal) < 0.0 {
            scaled(motion, -1.0)
        } else {
            motion
        };
        prop_assume!(dot(motion, normal) > 0.0);
        prop_assert_eq!(convex.first_contact(lifted, add(lifted, motion)), None);
    }

    /// A point that a projection moved onto the surface, with its rounding.
    #[test]
    fn rounding_at_the_surface_loses_no_contact(
        (convex, from, _) in ways_from_the_surface(),
        off in -1e-13..1e-13_f64,
        power in -12.0..0.0_f64,
    ) {
        let unit = size(&convex);
        let normal = convex.nearest(from).normal;
        let start = add(from, scaled(normal, off * unit));
        let depth = unit * 10.0_f64.powf(power);
        let end = sub(from, scaled(normal, depth));
        // Straight down from an edge is along a face.
        if !is_inside(&convex, end, 0.0) {
            return Ok(());
        }
        let touch = convex.first_contact(start, end);
        prop_assert!(touch.is_some());
        prop_assert!(touch.unwrap().share * depth <= 1e-12 * unit);
    }
}

#[test]
fn a_line_that_only_touches_is_no_contact() {
    let sphere = Convex::sphere(0.5).unwrap();
    assert_eq!(
        sphere.first_contact([0.5, -1.0, 0.0], [0.5, 1.0, 0.0]),
        None
    );
    let capsule = Convex::capsule(0.5, 2.0).unwrap();
    assert_eq!(
        capsule.first_contact([0.5, 0.0, -4.0], [0.5, 0.0, 4.0]),
        None
    );
    let cuboid = Convex::cuboid([1.0, 1.0, 1.0]).unwrap();
    assert_eq!(
        cuboid.first_contact([0.5, -1.0, 0.0], [0.5, 1.0, 0.0]),
        None
    );
    assert_eq!(cuboid.first_contact([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), None);
    assert_eq!(Convex::Plane.first_contact([0.0; 3], [1.0, 0.0, 0.0]), None);
}

#[test]
fn a_way_that_ends_before_the_surface_is_no_contact_and_one_that_ends_on_it_is() {
    for (convex, top) in [
        (Convex::sphere(0.5).unwrap(), 0.5),
        (Convex::capsule(0.5, 2.0).unwrap(), 1.5),
        (Convex::Plane, 0.0),
        (Convex::cuboid([1.0, 1.0, 3.0]).unwrap(), 1.5),
    ] {
        let from = [0.0, 0.0, top + 1.0];
        let before = convex.first_contact(from, [0.0, 0.0, top + 1e-9]);
        assert_eq!(before, None, "{convex:?}");
        let share = convex.first_contact(from, [0.0, 0.0, top]).unwrap().share;
        assert_eq!(share, 1.0, "{convex:?}");
    }
}

/// A path at a very small angle to the surface is a contact if it goes inwards.
#[test]
fn the_flattest_way_in_from_the_surface_is_a_contact_at_once() {
    for (convex, top) in [
        (Convex::sphere(0.5).unwrap(), 0.5),
        (Convex::capsule(0.5, 2.0).unwrap(), 1.5),
        (Convex::cuboid([1.0, 1.0, 3.0]).unwrap(), 1.5),
    ] {
        let from = [0.0, 0.0, top * (1.0 + 1e-13)];
        let inwards = convex.first_contact(from, [0.1, 0.0, from[2] - 1e-14]);
        assert_eq!(inwards.unwrap().share, 0.0, "{convex:?}");
        for up in [0.0, 1e-14] {
            let away = convex.first_contact(from, [0.1, 0.0, from[2] + up]);
            assert_eq!(away, None, "{convex:?}");
            let on_it = convex.first_contact([0.0, 0.0, top], [0.1, 0.0, top + up]);
            assert_eq!(on_it, None, "{convex:?}");
        }
    }
}

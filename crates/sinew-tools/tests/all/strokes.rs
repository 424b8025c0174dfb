//! Tools that move and turn over steps: no node passes through them, and the frame of the world does not matter.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use crate::common::{add, bounded_shapes, dot, length, poses, scaled, shapes, size, sub, vectors};
use proptest::prelude::*;
use sinew_core::Inputs;
use sinew_tools::{Convex, Motion, Part, Pose, Shape, Stroke, swept_box};

fn part(convex: Convex) -> Part {
    let pose = Pose::identity();
    Part { convex, pose }
}

fn upright(position: [f64; 3]) -> Pose {
    Pose::new(position, [0.0; 3])
}

/// A pose displaced and rotated from another.
fn moved(pose: &Pose, by: [f64; 3], turn: [f64; 3]) -> Pose {
    let turned = Pose::new([0.0; 3], turn).then(&Pose::new([0.0; 3], pose.rotation_vector()));
    Pose::new(add(pose.position(), by), turned.rotation_vector())
}

proptest! {
    /// Nodes from the side of the tool to well inside it, so that each is hit and not only grazed.
    #[test]
    fn a_scene_that_is_turned_as_a_whole_has_the_same_contacts(
        (convex, inner, before) in (shapes(), poses(), poses()),
        (way, turn) in (vectors(), vectors()),
        direction in vectors(),
        world in poses(),
    ) {
        prop_assume!(length(direction) > 0.1);
        let unit = size(&convex);
        let in_units = |pose: Pose| Pose::new(scaled(pose.position(), unit), pose.rotation_vector());
        let (inner, before, world) = (in_units(inner), in_units(before), in_units(world));
        let after = moved(&before, scaled(way, unit), scaled(turn, 0.2));
        let pose = inner;
        let part = Part { convex, pose };
        let stroke = Stroke::new(&part, before, after);
        let same = Stroke::new(&part, world.then(&before), world.then(&after));
        prop_assert_eq!(stroke.passes(), same.passes());

        let mut from = scaled(direction, 3.0 * unit / length(direction));
        let mut to = [0.0; 3];
        if convex == Convex::Plane {
            (from[2], to[2]) = (from[2].abs(), -0.1);
        }
        let from = stroke.pose_at(0.0).to_world(from);
        let to = stroke.pose_at(1.0).to_world(to);
        let found = stroke.first_contact(from, to).unwrap();
        let other = same.first_contact(world.to_world(from), world.to_world(to)).unwrap();
        // A place is rounded to some 1e-15 of all sizes, and a share by that over the speed across the surface.
        let own = |share: f64| stroke.pose_at(share).to_own(add(from, scaled(sub(to, from), share)));
        let speed = dot(found.normal, sub(own(found.share), own(found.share + 1e-6))) / 1e-6;
        let tolerance = 1e-12 + 2e-14 * unit / speed.abs();
        prop_assert!((found.share - other.share).abs() < tolerance, "{found:?} {other:?}");
    }

    #[test]
    fn the_box_holds_the_tool_during_the_whole_step(
        (first, second) in (bounded_shapes(), bounded_shapes()),
        (inner, other_inner) in (poses(), poses()),
        (before, way, turn) in (poses(), vectors(), vectors()),
        share in 0.0..1.0_f64,
        aim in vectors(),
    ) {
        let after = moved(&before, way, scaled(turn, 1.5));
        let parts = [(first, inner), (second, other_inner)];
        let parts = parts.map(|(convex, pose)| Part { convex, pose });
        let shape = Shape::several(parts.to_vec()).unwrap();
        let [low, high] = swept_box(&shape, &before, &after).unwrap();
        for part in parts {
            let stroke = Stroke::new(&part, before, after);
            prop_assert_eq!(stroke.pose_at(0.0), before.then(&part.pose));
            prop_assert_eq!(stroke.pose_at(1.0), after.then(&part.pose));
            let pose = stroke.pose_at(share);
            let unit = size(&part.convex);
            let corners = [aim, [1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [0.0, 0.0, -1.0]];
            for corner in corners {
                let point = pose.to_world(part.convex.nearest(scaled(corner, unit)).point);
                let is_held = |axis: usize| {
                    low[axis] - 1e-14 <= point[axis] && point[axis] <= high[axis] + 1e-14
                };
                prop_assert!((0..3).all(is_held), "{point:?} {low:?} {high:?}");
            }
        }
    }

    #[test]
    fn a_node_whose_way_stays_outside_the_box_is_not_met(
        convex in bounded_shapes(),
        (inner, before) in (poses(), poses()),
        (way, turn) in (vectors(), vectors()),
        (from, to) in (vectors(), vectors()),
    ) {
        let unit = size(&convex);
        let pose = Pose::new(scaled(inner.position(), unit), inner.rotation_vector());
        let after = moved(&before, scaled(way, unit), scaled(turn, 0.5));
        let stroke = Stroke::new(&Part { convex, pose }, before, after);
        let [low, high] = stroke.bounds().unwrap();
        let near = |point: [f64; 3]| stroke.pose_at(0.5).to_world(scaled(point, 3.0 * unit));
        let (from, to) = (near(from), near(to));
        let is_beside = |axis: usize| {
            from[axis].max(to[axis]) < low[axis] || from[axis].min(to[axis]) > high[axis]
        };
        if (0..3).any(is_beside) {
            prop_assert_eq!(stroke.first_contact(from, to), None);
        }
    }
}

#[test]
fn the_box_of_a_tool_that_does_not_turn_fits_it() {
    // A capsule of .2 m from tip to tip, leant over by 60 degrees from z to x, that moves along y.
    let needle = Shape::of(Convex::capsule(0.01, 0.18).unwrap());
    let turn = [0.0, std::f64::consts::FRAC_PI_3, 0.0];
    let (before, after) = (Pose::new([0.0; 3], turn), Pose::new([0.0, 0.3, 0.0], turn));
    let [low, high] = swept_box(&needle, &before, &after).unwrap();
    let half = [0.09 * 0.75_f64.sqrt() + 0.01, 0.01, 0.045 + 0.01];
    assert!(length(sub(low, scaled(half, -1.0))) < 1e-15, "{low:?}");
    assert!(
        length(sub(high, add(half, [0.0, 0.3, 0.0]))) < 1e-15,
        "{high:?}"
    );

    let with_a_plane = [Convex::Plane, Convex::sphere(0.1).unwrap()].map(part);
    let shape = Shape::several(with_a_plane.to_vec()).unwrap();
    assert_eq!(swept_box(&shape, &before, &after), None);
}

/// Steps in which a sphere crosses a node at rest: two flags, true if any step finds it from the whole stroke, and from
/// its end alone.
fn crossing(velocity: f64, dt: f64, offset: [f64; 2], phase: f64) -> (bool, bool) {
    let convex = Convex::sphere(0.005).unwrap();
    let start = upright([-0.006 - phase * velocity * dt, 0.0, 0.0]);
    let motion = Motion::Steady {
        start,
        velocity: [velocity, 0.0, 0.0],
    };
    let node = [0.0, offset[0], offset[1]];
    let (mut is_met, mut is_seen) = (false, false);
    let mut before = motion.at(0.0, Inputs::none());
    let mut step = 0;
    while before.position()[0] < 0.006 {
        step += 1;
        let after = motion.at(f64::from(step) * dt, Inputs::none());
        let touch = Stroke::new(&part(convex), before, after).first_contact(node, node);
        is_met |= touch.is_some();
        is_seen |= convex.nearest(after.to_own(node)).distance < 0.0;
        before = after;
    }
    (is_met, is_seen)
}

#[test]
fn no_node_passes_through_a_tool_however_fast_it_is() {
    let mut missed_by_ends = 0;
    for velocity in [1.0, 2.0, 5.0, 10.0, 20.0, 50.0] {
        for dt in [0.0001, 0.001, 0.005] {
            for place in 0..100 {
                // Golden ratios spread offsets over a disc of .999 radii, and where the first step begins.
                let turns = f64::from(place) * 0.618_033_988_749_895;
                let far = 0.005 * 0.999 * (f64::from(place) / 99.0).sqrt();
                let angle = turns * std::f64::consts::TAU;
                let offset = [far * angle.cos(), far * angle.sin()];
                let (is_met, is_seen) = crossing(velocity, dt, offset, (turns * 7.0).fract());
                assert!(is_met, "{velocity} m/s, {dt} s, {offset:?}");
                missed_by_ends += u32::from(!is_seen);
            }
        }
    }
    // Looking at ends of steps alone does not do: the test sees what it should.
    assert!(missed_by_ends > 100, "{missed_by_ends}");
}

#[test]
fn passes_are_counted_by_way_and_by_turn() {
    let ball = part(Convex::sphere(0.005).unwrap());
    let passes = |part: &Part, by: [f64; 3], turn: [f64; 3]| {
        Stroke::new(part, upright([0.0; 3]), Pose::new(by, turn)).passes()
    };
    assert_eq!(passes(&ball, [0.0; 3], [0.0; 3]), 1);
    assert_eq!(passes(&ball, [0.0024, 0.0, 0.0], [0.0; 3]), 1);
    assert_eq!(passes(&ball, [0.0026, 0.0, 0.0], [0.0; 3]), 2);
    assert_eq!(passes(&ball, [0.0, 0.0, 0.024], [0.0; 3]), 10);
    assert_eq!(passes(&ball, [0.0, 9.0, 0.0], [0.0; 3]), 1000);
    // A tip at the end of a shaft of .1 m moves 1 mm when the tool turns by .01.
    let tip = Part {
        convex: Convex::sphere(0.0005).unwrap(),
        pose: upright([0.1, 0.0, 0.0]),
    };
    assert_eq!(passes(&tip, [0.0; 3], [0.0, 0.0, 0.01]), 5);
    // Flat faces have no radius: only turns count.
    let board = part(Convex::cuboid([0.1, 0.1, 0.01]).unwrap());
    assert_eq!(passes(&board, [1.0, 0.0, 0.0], [0.0; 3]), 1);
    assert_eq!(passes(&board, [0.0; 3], [0.0, 0.29, 0.0]), 3);
    assert_eq!(
        passes(&part(Convex::Plane), [1.0, 0.0, 0.0], [0.0, 0.29, 0.0]),
        3
    );
}

#[test]
fn a_bar_that_swings_meets_a_node_where_its_face_arrives() {
    // Along x, its lower face at y = -.01, swinging about the origin by a quarter turn; a node at 45 degrees and .3 m.
    let bar = Part {
        convex: Convex::cuboid([0.4, 0.02, 0.02]).unwrap(),
        pose: upright([0.2, 0.0, 0.0]),
    };
    let stroke = Stroke::new(
        &bar,
        upright([0.0; 3]),
        Pose::new([0.0; 3], [0.0, 0.0, FRAC_PI_2]),
    );
    let node = [0.3 * FRAC_PI_4.cos(), 0.3 * FRAC_PI_4.sin(), 0.0];
    let touch = stroke.first_contact(node, node).unwrap();
    let expected = (FRAC_PI_4 - (0.01_f64 / 0.3).asin()) / FRAC_PI_2;
    assert_eq!(stroke.passes(), 16);
    // The chord of a sixteenth leaves the arc by (.098)^2/8 of .3 m at most.
    assert!(
        (touch.share - expected).abs() < 2e-3,
        "{touch:?} {expected}"
    );
    assert_eq!(touch.normal, [0.0, 1.0, 0.0]);
    let normal = stroke.pose_at(touch.share).turned(touch.normal);
    let ahead = [
        -(FRAC_PI_2 * touch.share).sin(),
        (FRAC_PI_2 * touch.share).cos(),
        0.0,
    ];
    assert!(length(sub(normal, ahead)) < 1e-14);
}

#[test]
fn a_node_that_flees_as_fast_as_the_tool_comes_is_not_met() {
    let ball = part(Convex::sphere(0.005).unwrap());
    let by = [0.3, 0.1, 0.0];
    let stroke = Stroke::new(&ball, upright([0.0; 3]), upright(by));
    let node = [0.006, 0.0, 0.0];
    assert_eq!(stroke.first_contact(node, add(node, by)), None);
    let slower = add(node, scaled(by, 0.99));
    assert!(stroke.first_contact(node, slower).is_some());
}

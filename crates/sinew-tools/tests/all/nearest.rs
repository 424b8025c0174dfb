//! The nearest point of a surface, compared with points spread over it.

use std::f64::consts::{PI, TAU};

use crate::common::{bounded_shapes, dot, is_inside, length, scaled, shapes, size, sub, vectors};
use proptest::prelude::*;
use sinew_tools::Convex;

/// Points along each parameter of a surface.
const FINE: usize = 80;

fn steps(from: f64, to: f64) -> impl Iterator<Item = f64> + Clone {
    (0..=FINE).map(move |step| from + (to - from) * step as f64 / FINE as f64)
}

fn on_sphere(radius: f64, latitude: f64, longitude: f64) -> [f64; 3] {
    let across = radius * latitude.cos();
    [
        across * longitude.cos(),
        across * longitude.sin(),
        radius * latitude.sin(),
    ]
}

/// Points spread over the whole surface of a bounded shape, and an upper bound of the distance of any surface point
/// from the nearest of them.
fn surface(convex: &Convex) -> (Vec<[f64; 3]>, f64) {
    let latitudes = steps(-PI / 2.0, PI / 2.0);
    let globe = latitudes.flat_map(|latitude| steps(0.0, TAU).map(move |l| (latitude, l)));
    match *convex {
        Convex::Sphere { radius, .. } => {
            let points = globe.map(|(latitude, l)| on_sphere(radius, latitude, l));
            (points.collect(), radius * TAU / FINE as f64)
        }
        Convex::Capsule { radius, length, .. } => {
            let ends = globe.map(|(latitude, l)| {
                let [x, y, z] = on_sphere(radius, latitude, l);
                [x, y, z + (length / 2.0).copysign(latitude)]
            });
            let heights = steps(-length / 2.0, length / 2.0);
            let side = heights.flat_map(|z| {
                steps(0.0, TAU).map(move |l| [radius * l.cos(), radius * l.sin(), z])
            });
            let spacing = radius * TAU / FINE as f64 + length / FINE as f64;
            (ends.chain(side).collect(), spacing)
        }
        Convex::Cuboid { size, .. } => {
            let half = scaled(size, 0.5);
            let mut points = Vec::new();
            for axis in 0..3 {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                for a in steps(-half[u], half[u]) {
                    for b in steps(-half[v], half[v]) {
                        for side in [-half[axis], half[axis]] {
                            let mut point = [side; 3];
                            (point[u], point[v]) = (a, b);
                            points.push(point);
                        }
                    }
                }
            }
            (points, size.iter().sum::<f64>() / FINE as f64)
        }
        _ => (Vec::new(), 0.0),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_point_of_the_surface_is_nearer_and_one_is_as_near(
        convex in bounded_shapes(),
        direction in vectors(),
        far in 0.0..2.0_f64,
    ) {
        let point = scaled(direction, far * size(&convex));
        let nearest = convex.nearest(point);
        let (surface, spacing) = surface(&convex);
        let distances = surface.into_iter().map(|other| length(sub(other, point)));
        let smallest = distances.fold(f64::INFINITY, f64::min);
        let distance = nearest.distance.abs();
        prop_assert!(distance <= smallest + 1e-14 * size(&convex), "{nearest:?} {smallest}");
        prop_assert!(smallest <= distance + spacing, "{nearest:?} {smallest}");
    }
}

proptest! {
    #[test]
    fn the_answer_fits_together(convex in shapes(), direction in vectors(), far in 0.0..2.0_f64) {
        let point = scaled(direction, far * size(&convex));
        let nearest = convex.nearest(point);
        let tiny = 1e-14 * size(&convex);
        prop_assert!((length(nearest.normal) - 1.0).abs() < 1e-15);
        // The point is on the surface, and the way to it is along the normal.
        prop_assert!(convex.nearest(nearest.point).distance.abs() <= tiny);
        let way = sub(point, nearest.point);
        prop_assert!(length(sub(way, scaled(nearest.normal, nearest.distance))) <= tiny);
        // Which side it is on is told by the shape's definition.
        prop_assert!(!is_inside(&convex, point, tiny) || nearest.distance < 0.0);
        prop_assert!(nearest.distance >= 0.0 || is_inside(&convex, point, -tiny));
    }

    /// The tangent half-space at the nearest point contains no inner point.
    #[test]
    fn what_is_above_the_tangent_plane_is_outside(
        convex in shapes(),
        direction in vectors(),
        far in 0.0..2.0_f64,
        other in vectors(),
    ) {
        let unit = size(&convex);
        let nearest = convex.nearest(scaled(direction, far * unit));
        let other = scaled(other, 2.0 * unit);
        let height = dot(nearest.normal, sub(other, nearest.point)).min(0.0);
        let lifted = sub(other, scaled(nearest.normal, height));
        prop_assert!(convex.nearest(lifted).distance >= -1e-14 * unit);
    }
}

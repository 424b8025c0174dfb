//! Pixels covered by shapes.

use std::f64::consts::PI;

use sinew_film::{Colouring, Picture};

use crate::common::{film, look, of_square, picture, sphere, square, still};

/// Number of pixels that are not background, with pixels at an edge counted as half, in the rows between the labels.
fn covered(picture: &Picture) -> f64 {
    let (width, height) = (picture.size().width(), picture.size().height());
    let background = picture.at(0, height / 2).expect("a pixel");
    let is_covered = |x: usize, y: usize| picture.at(x, y) != Some(background);
    let mut sum = 0.0;
    for y in height / 10..height * 9 / 10 {
        for x in 1..width - 1 {
            if is_covered(x, y) {
                let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
                let is_inside = beside.iter().all(|(x, y)| is_covered(*x, *y));
                sum += if is_inside { 1.0 } else { 0.5 };
            }
        }
    }
    sum
}

#[test]
fn the_silhouette_of_a_sphere_has_the_area_of_a_circle() {
    for radius in [0.03, 20.0] {
        let (points, triangles) = sphere(radius, 160);
        let look = look("front", (800, 600), Colouring::tissue());
        let film = film(still(points, &triangles, Vec::new()), &look);
        let expected = PI * (radius * film.pixels_per_metre()).powi(2);
        assert!(expected > 100_000.0, "it fills the picture: {expected}");
        let found = covered(&film.picture(0.0));
        assert!(
            (found / expected - 1.0).abs() < 0.01,
            "{found} pixels, expected {expected}"
        );
    }
}

#[test]
fn a_sphere_far_from_the_origin_is_drawn_as_one_about_it() {
    let (points, triangles) = sphere(0.05, 64);
    let far: Vec<[f64; 3]> = points
        .iter()
        .map(|[x, y, z]| [x + 7000.0, *y, z - 300.0])
        .collect();
    let look = look("iso", (320, 240), Colouring::tissue());
    let near = picture(still(points, &triangles, Vec::new()), &look);
    let far = picture(still(far, &triangles, Vec::new()), &look);
    let pixels = near.pixels().iter().zip(far.pixels());
    let other = pixels
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 8))
        .count();
    assert!(other < 100, "{other} pixels differ");
}

#[test]
fn what_is_nearer_hides_what_is_farther_whatever_the_order() {
    for view in ["front", "0,0", "20,15"] {
        let look = look(view, (200, 160), Colouring::of_values("depth", ""));
        let stack = |depths: [f64; 3]| {
            let points = depths.iter().flat_map(|y| square(*y, 0.1)).collect();
            let triangles = [0, 4, 8].map(of_square);
            // The value says how far away a square is.
            let values = depths.iter().flat_map(|y| [*y as f32; 4]).collect();
            picture(still(points, triangles.as_flattened(), values), &look)
        };
        let expected = stack([0.0, 0.05, 0.1]);
        assert_eq!(
            stack([0.1, 0.05, 0.0]).pixels(),
            expected.pixels(),
            "{view}"
        );
        assert_eq!(
            stack([0.05, 0.0, 0.1]).pixels(),
            expected.pixels(),
            "{view}"
        );
        // The nearest has the least value, whose colour is dark and not yellow.
        let [red, green, _] = expected.at(70, 80).expect("a pixel");
        assert!(red < 130 && green < 60, "{view}: {red} {green}");
    }
}

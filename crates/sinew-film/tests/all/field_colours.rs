//! Colours of fields and the bar that explains them.

use sinew_film::{Colouring, Film, FilmError, Look, Picture};

use crate::common::{look, of_square, picture, square, still};

fn field(range: Option<[f64; 2]>) -> Look {
    Look {
        range,
        ..look("front", (400, 240), Colouring::of_values("stress", "Pa"))
    }
}

/// A square whose values increase from the first on the left to the second on the right.
fn slope(left: f32, right: f32, range: Option<[f64; 2]>) -> Picture {
    let values = vec![left, right, right, left];
    picture(
        still(square(0.0, 0.1), &of_square(0), values),
        &field(range),
    )
}

/// The colours next to the left and the right edge of the square.
fn ends(picture: &Picture) -> [[u8; 3]; 2] {
    let row = 120;
    let background = picture.at(0, row).expect("a pixel");
    let columns: Vec<usize> = (0..320)
        .filter(|x| picture.at(*x, row) != Some(background))
        .collect();
    let (first, last) = (columns[0], columns[columns.len() - 1]);
    [first + 2, last - 2].map(|x| picture.at(x, row).expect("a pixel"))
}

#[test]
fn colours_follow_the_ends_of_the_range() {
    let [low, high] = ends(&slope(0.0, 100.0, Some([0.0, 100.0])));
    let near = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 8);
    // Dark blue and violet at the lower end, yellow at the upper one.
    assert!(low[2] > low[1] && low[1] < 60, "{low:?}");
    assert!(high[0] > 180 && high[1] > 180 && high[2] < 120, "{high:?}");
    // What lies at an end, or beyond it, has the colour of the end everywhere.
    for (value, end) in [(0.0, low), (-50.0, low), (100.0, high), (900.0, high)] {
        let [left, right] = ends(&slope(value, value, Some([0.0, 100.0])));
        assert!(
            near(left, end) && near(right, end),
            "{value}: {left:?} {right:?} {end:?}"
        );
    }
    let [left, right] = ends(&slope(0.0, 100.0, Some([0.0, 200.0])));
    assert!(near(left, low) && !near(right, high), "{left:?} {right:?}");
}

#[test]
fn the_bar_has_the_ends_written_and_nothing_else_depends_on_them() {
    let square = |most: f32| {
        let values = vec![0.0, most, most, 0.0];
        let clip = still(square(0.0, 0.1), &of_square(0), values);
        let look = field(Some([0.0, f64::from(most)]));
        Film::new(clip, Vec::new(), &look).expect("a film")
    };
    let [thin, thick] = [square(700.0), square(14_000.0)];
    assert_eq!(thin.marks(), Some(&["0", "350", "700"].map(str::to_owned)));
    assert_eq!(thick.marks(), Some(&["0", "7", "14"].map(str::to_owned)));
    let [thin, thick] = [thin, thick].map(|film| film.picture(0.0));
    let mut rows = Vec::new();
    for (place, (a, b)) in thin.pixels().iter().zip(thick.pixels()).enumerate() {
        if a != b {
            assert!(place % 400 > 340, "only marks and the unit are others");
            rows.push(place / 400);
        }
    }
    // The mark at the upper end, and that in the middle.
    assert!(rows.iter().any(|row| (50..66).contains(row)), "{rows:?}");
    assert!(rows.iter().any(|row| (112..128).contains(row)), "{rows:?}");
}

#[test]
fn a_range_is_that_of_a_field_and_leads_upwards() {
    let refused = |look: &Look| {
        let clip = still(square(0.0, 0.1), &of_square(0), vec![1.0; 4]);
        Film::new(clip, Vec::new(), look).err()
    };
    let tissue = Look {
        range: Some([0.0, 1.0]),
        ..look("front", (100, 100), Colouring::tissue())
    };
    assert!(matches!(refused(&tissue), Some(FilmError::RangeOfTissue)));
    assert!(matches!(
        refused(&field(Some([2.0, 2.0]))),
        Some(FilmError::Range { .. })
    ));
    assert!(refused(&field(None)).is_none());
}

//! Files of pictures and films, read by another program's reader.

use std::io::Cursor;

use png::{BlendOp, ColorType, Decoder, DisposeOp, Transformations};
use sinew_film::{
    Colouring, Film, FilmError, Look, Part, Picture, PoseAt, Shape, Timing, Tool, is_own_png,
};

use crate::common::{film, look, sheared_cube};

/// A cube that is sheared under a ball.
fn cube(look: &Look) -> Film {
    let pose = |t: f64, z: f64| PoseAt {
        t,
        position: [0.05, 0.05, z],
        rotation: [0.0; 3],
    };
    let part = Part {
        shape: Shape::Sphere { radius: 0.02 },
        at: [0.0; 3],
        rotation: [0.0; 3],
    };
    let ball = Tool::new(vec![part], vec![pose(0.0, 0.14), pose(1.0, 0.12)]);
    Film::new(sheared_cube(0.1), vec![ball], look).expect("a film")
}

fn small() -> Look {
    Look {
        title: "A cube".to_owned(),
        ..look("iso", (240, 160), Colouring::tissue())
    }
}

fn timing(film: &Film, fps: f64, seconds: f64) -> Timing {
    Timing::new(film.span(), fps, Some(seconds)).expect("a length")
}

fn bytes(film: &Film, timing: Timing) -> Vec<u8> {
    film.animation(timing, &mut |_| true).expect("a film")
}

/// A picture of a film from a reader, and its duration in milliseconds.
struct Shown {
    pixels: Vec<[u8; 3]>,
    delay: u16,
}

/// All pictures of a film, each drawn over the one before, according to the standard.
fn pictures(file: &[u8]) -> Vec<Shown> {
    let mut decoder = Decoder::new(Cursor::new(file));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a header");
    let info = reader.info();
    assert_eq!(info.color_type, ColorType::Indexed);
    let width = info.width as usize;
    let count = info.animation_control().expect("an animation").num_frames;
    let mut canvas = vec![[0_u8; 3]; width * info.height as usize];
    let mut shown = Vec::new();
    for _ in 0..count {
        let mut buffer = vec![0; reader.output_buffer_size().expect("a size")];
        let frame = reader.next_frame(&mut buffer).expect("a picture");
        assert_eq!(frame.color_type, ColorType::Rgba);
        let control = *reader.info().frame_control().expect("a frame's place");
        assert_eq!(control.dispose_op, DisposeOp::None);
        let part = control.width as usize;
        for (place, pixel) in buffer[..frame.buffer_size()].chunks(4).enumerate() {
            let (x, y) = (
                control.x_offset as usize + place % part,
                control.y_offset as usize + place / part,
            );
            if pixel[3] == 255 || control.blend_op == BlendOp::Source {
                canvas[y * width + x] = [pixel[0], pixel[1], pixel[2]];
            }
        }
        let delay = u32::from(control.delay_num) * 1000 / u32::from(control.delay_den);
        shown.push(Shown {
            pixels: canvas.clone(),
            delay: delay as u16,
        });
    }
    shown
}

#[test]
fn a_picture_comes_back_from_its_file_pixel_by_pixel() {
    let picture = cube(&small()).picture(0.5);
    let file = picture.to_png().expect("a file");
    assert!(is_own_png(&file));
    let mut reader = Decoder::new(Cursor::new(&file))
        .read_info()
        .expect("a header");
    let mut buffer = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut buffer).expect("a picture");
    assert_eq!((info.width, info.height), (240, 160));
    assert_eq!(buffer, picture.pixels().as_flattened());
}

#[test]
fn a_film_shows_its_pictures_in_a_few_colours_and_ends_with_a_rest() {
    let film = cube(&small());
    let timing = timing(&film, 10.0, 2.0);
    let shown = pictures(&bytes(&film, timing));
    assert_eq!(shown.len(), 20);
    assert!(shown[..19].iter().all(|picture| picture.delay == 100));
    assert!(shown[19].delay >= 500);
    for (t, shown) in timing.instants(film.span()).into_iter().zip(&shown) {
        let picture = film.picture(t);
        let off = shown.pixels.iter().zip(picture.pixels()).map(|(a, b)| {
            a.iter()
                .zip(b)
                .map(|(a, b)| a.abs_diff(*b))
                .max()
                .unwrap_or(0)
        });
        let off: Vec<u8> = off.collect();
        let mean = off.iter().map(|off| f64::from(*off)).sum::<f64>() / off.len() as f64;
        let far = off.iter().filter(|off| **off > 24).count();
        assert!(
            mean < 2.0 && far < off.len() / 500,
            "t = {t}: {mean} in the mean, {far} far"
        );
    }
    let mut colours: Vec<[u8; 3]> = shown
        .iter()
        .flat_map(|shown| shown.pixels.clone())
        .collect();
    colours.sort_unstable();
    colours.dedup();
    assert!(colours.len() <= 255, "{}", colours.len());
}

#[test]
fn the_same_run_gives_the_same_bytes_with_any_number_of_threads() {
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            let film = cube(&small());
            bytes(&film, timing(&film, 5.0, 1.0))
        })
    };
    let one = by(1);
    assert!(is_own_png(&one));
    assert_eq!(by(1), one);
    assert_eq!(by(3), one);
}

#[test]
fn time_and_title_are_written_on_the_picture() {
    let written = |title: &str, t: f64| {
        let look = Look {
            title: title.to_owned(),
            ..small()
        };
        // A body at rest: nothing else may differ.
        film(sheared_cube(0.0), &look).picture(t)
    };
    let differs = |a: &Picture, b: &Picture, rows: std::ops::Range<usize>| {
        rows.flat_map(|y| (0..120).map(move |x| (x, y)))
            .any(|(x, y)| a.at(x, y) != b.at(x, y))
    };
    let [one, other] = ["A cube", "Another"].map(|title| written(title, 0.0));
    assert!(differs(&one, &other, 0..25) && !differs(&one, &other, 135..160));
    let later = written("A cube", 1.0);
    assert!(differs(&one, &later, 140..160) && !differs(&one, &later, 0..17));
}

#[test]
fn an_instrument_is_seen_where_it_is() {
    let look = look("front", (300, 300), Colouring::tissue());
    let film = cube(&look);
    let without = Film::new(sheared_cube(0.1), Vec::new(), &look).expect("a film");
    // Grey above red: in the column of its middle.
    let is_grey = |[r, g, b]: [u8; 3]| r.abs_diff(g) < 14 && g.abs_diff(b) < 24 && r < 225;
    let grey = |picture: &Picture| {
        let column = (0..250).filter(|y| picture.at(150, *y).is_some_and(is_grey));
        column.collect::<Vec<usize>>()
    };
    let [before, after] = [0.0, 1.0].map(|t| grey(&film.picture(t)));
    assert!(
        before.len() > 30 && after.len() > 20,
        "{before:?} {after:?}"
    );
    assert!(
        after[0] > before[0] + 10,
        "it comes down: {before:?} {after:?}"
    );
    assert!(grey(&without.picture(0.0)).len() < 10);
}

#[test]
fn a_film_can_be_stopped_and_an_instant_must_be_one_of_the_run() {
    let film = cube(&small());
    let mut seen = Vec::new();
    let stopped = film.animation(timing(&film, 5.0, 2.0), &mut |done| {
        seen.push(done);
        done < 3
    });
    assert!(matches!(stopped, Err(FilmError::Stopped)));
    assert_eq!(seen, [1, 2, 3]);
    assert!(film.picture_at(1.0).is_ok());
    let said = film
        .picture_at(1.5)
        .map_err(|error| error.to_string())
        .expect_err("too late");
    assert_eq!(said, "--at 1.5: the frames lie between t = 0 s and t = 1 s");
}

//! Frames in the folder of a run.

use std::collections::HashMap;
use std::io;

use sinew_film::{Clip, Colouring, Film, FilmError, Run};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::vtu::{Array, Grid, VtuEncoding, write_pvd, write_vtu_grid};
use sinew_mesh::{CellType, TetMesh};

use crate::common::look;

type Folder = HashMap<String, Vec<u8>>;

fn read(folder: &Folder, name: &str) -> io::Result<Vec<u8>> {
    folder
        .get(name)
        .cloned()
        .ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))
}

fn clip(folder: &Folder, colour: &str) -> Result<Clip, FilmError> {
    let files = |name: &str| read(folder, name);
    let run = Run::open(&files)?;
    run.clip(&run.colouring(colour)?)
}

fn said(folder: &Folder, colour: &str) -> String {
    clip(folder, colour)
        .map_err(|error| error.to_string())
        .expect_err("nothing to show")
}

/// A folder with frames of these bodies at t = 0, 1, and so on, each displaced by `apart` (m) along x from the one
/// before.
fn folder(bodies: &[TetMesh], apart: f64) -> Folder {
    folder_of(bodies, |frame, _| [apart * frame as f64, 0.0, 0.0])
}

/// A folder with frames of these bodies, with the displacement (m) of each position (m).
fn folder_of(bodies: &[TetMesh], u: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> Folder {
    let mut folder = Folder::new();
    let mut series = Vec::new();
    let names: Vec<String> = (0..bodies.len())
        .map(|frame| format!("fields/frame-{frame:05}.vtu"))
        .collect();
    for (frame, (mesh, name)) in bodies.iter().zip(&names).enumerate() {
        let u: Vec<[f64; 3]> = mesh.points.iter().map(|place| u(frame, *place)).collect();
        let of_tets: Vec<f64> = (0..mesh.tets.len()).map(|tet| tet as f64).collect();
        let grid = Grid {
            point_data: vec![Array::of_vectors("displacement", &u)],
            cell_data: vec![Array::of_scalars("von_mises", &of_tets)],
            ..Grid::of(mesh)
        };
        let mut file = Vec::new();
        write_vtu_grid(&grid, VtuEncoding::RawAppended, &mut file).expect("a frame");
        folder.insert(name.clone(), file);
        series.push((frame as f64, name.as_str()));
    }
    let mut list = Vec::new();
    write_pvd(&series, &mut list).expect("a list");
    folder.insert("fields.pvd".to_owned(), list);
    folder
}

fn cube() -> TetMesh {
    structured::cube(2, 0.1, Split::Kuhn).expect("a mesh")
}

#[test]
fn the_frames_of_a_run_become_a_clip() {
    let folder = folder(&[cube(), cube()], 1.0);
    let files = |name: &str| read(&folder, name);
    let run = Run::open(&files).expect("a run");
    let names: Vec<&str> = run
        .fields()
        .iter()
        .map(|field| field.name.as_str())
        .collect();
    assert_eq!(names, ["displacement", "von_mises"]);
    let clip = run.clip(&Colouring::tissue()).expect("a clip");
    assert_eq!(clip.span(), Some([0.0, 1.0]));
    let film = Film::new(
        clip,
        Vec::new(),
        &look("front", (200, 100), Colouring::tissue()),
    )
    .expect("a film");
    // It has moved by ten times its size, and both places are in the picture.
    let columns = |t: f64| {
        let picture = film.picture(t);
        let background = picture.at(100, 20);
        let seen: Vec<usize> = (0..200)
            .filter(|x| picture.at(*x, 47) != background)
            .collect();
        (seen[0], seen.len())
    };
    let (begins, size) = columns(0.0);
    let (ends, same) = columns(1.0);
    assert!(size > 10 && same.abs_diff(size) <= 1, "{size} {same}");
    assert!(
        (ends - begins).abs_diff(10 * size) < 12,
        "{begins} {ends} {size}"
    );
}

#[test]
fn a_body_that_was_displaced_looks_like_one_that_rests_there() {
    let bent = |[x, y, z]: [f64; 3]| [x + 4.0 * z * z, y - 0.5 * x, z + 0.3 * y];
    let u = |_, place: [f64; 3]| {
        let there = bent(place);
        [0, 1, 2].map(|axis| there[axis] - place[axis])
    };
    let displaced = folder_of(&[cube()], u);
    let mut there = cube();
    there.points = there.points.into_iter().map(bent).collect();
    let resting = folder_of(&[there], |_, _| [0.0; 3]);
    let [displaced, resting] = [displaced, resting].map(|folder| {
        let files = |name: &str| read(&folder, name);
        let run = Run::open(&files).expect("a run");
        let colouring = run.colouring("von_mises").expect("a colour");
        let clip = run.clip(&colouring).expect("a clip");
        let look = look("iso", (300, 200), colouring);
        Film::new(clip, Vec::new(), &look)
            .expect("a film")
            .picture(0.0)
    });
    let pixels = displaced.pixels().iter().zip(resting.pixels());
    let off = |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 6);
    let other = pixels.filter(off).count();
    assert!(other < 300, "{other} pixels differ");
}

#[test]
fn a_film_of_a_field_has_the_range_of_its_values() {
    let folder = folder(&[cube(), cube()], 1.0);
    let files = |name: &str| read(&folder, name);
    let run = Run::open(&files).expect("a run");
    for (colour, top) in [("displacement", "1"), ("displacement.x", "1")] {
        let colouring = run.colouring(colour).expect("a colour");
        let clip = run.clip(&colouring).expect("a clip");
        let film =
            Film::new(clip, Vec::new(), &look("iso", (200, 100), colouring)).expect("a film");
        let marks = film.marks().expect("a bar");
        assert_eq!([&marks[0], &marks[2]], ["0", top], "{colour}");
    }
}

#[test]
fn faces_that_were_cut_have_a_colour_of_their_own() {
    let whole = cube();
    // Half of the cube is taken away: what was inside before comes to light.
    let middle = |tet: &[u32; 4]| {
        tet.iter()
            .map(|node| whole.points[*node as usize][1])
            .sum::<f64>()
            / 4.0
    };
    let half = TetMesh::new(
        whole.points.clone(),
        whole
            .tets
            .iter()
            .copied()
            .filter(|tet| middle(tet) > 0.05)
            .collect(),
    )
    .expect("a mesh");
    let colour = |bodies: &[TetMesh]| {
        let clip = clip(&folder(bodies, 0.0), "tissue").expect("a clip");
        let [_, last] = clip.span().expect("frames");
        let film = Film::new(
            clip,
            Vec::new(),
            &look("front", (200, 160), Colouring::tissue()),
        )
        .expect("a film");
        film.picture(last).at(100, 78).expect("a pixel")
    };
    let [red, green, _] = colour(&[whole.clone(), half.clone()]);
    let [_, of_flesh, _] = colour(&[whole.clone(), whole.clone()]);
    assert!(
        of_flesh > 60 && green < 45 && red > 60,
        "{red} {green} {of_flesh}"
    );
    // Without the whole one before it is a body like any other.
    let [_, alone, _] = colour(&[half.clone(), half]);
    assert!(alone > 60, "{alone}");
}

#[test]
fn frames_of_the_surface_alone_look_like_those_of_the_whole_body() {
    let mesh = cube();
    let boundary = mesh.boundary_surface();
    let rest = vec![[0.0; 3]; boundary.points.len()];
    let grid = Grid {
        points: &boundary.points,
        cells: vec![(CellType::Triangle, boundary.triangles.as_flattened())],
        point_data: vec![Array::of_vectors("displacement", &rest)],
        cell_data: Vec::new(),
    };
    let mut whole = folder(std::slice::from_ref(&mesh), 0.0);
    let look = look("iso", (200, 160), Colouring::tissue());
    let seen = |folder: &Folder| {
        let clip = clip(folder, "tissue").expect("a clip");
        Film::new(clip, Vec::new(), &look)
            .expect("a film")
            .picture(0.0)
    };
    let expected = seen(&whole);
    let mut file = Vec::new();
    write_vtu_grid(&grid, VtuEncoding::RawAppended, &mut file).expect("a frame");
    whole.insert("fields/frame-00000.vtu".to_owned(), file);
    assert!(seen(&whole) == expected);
}

#[test]
fn a_run_beyond_all_bounds_still_has_pictures() {
    for apart in [1e30, f64::INFINITY, f64::NAN] {
        let clip = clip(&folder(&[cube(), cube()], apart), "tissue").expect("a clip");
        for view in ["iso", "front"] {
            let look = look(view, (100, 80), Colouring::tissue());
            let film = Film::new(clip.clone(), Vec::new(), &look).expect("a film");
            let [first, last] = [0.0, 1.0].map(|t| film.picture(t));
            assert_eq!(first.size(), last.size());
        }
    }
}

#[test]
fn what_a_folder_lacks_is_said_with_what_to_do() {
    let missing = said(&Folder::new(), "tissue");
    assert!(
        missing.starts_with("no frames to show: fields.pvd is not there"),
        "{missing}"
    );
    let empty = Folder::from([(
        "fields.pvd".to_owned(),
        b"<Collection>\n</Collection>".to_vec(),
    )]);
    assert!(said(&empty, "tissue").contains("fields.pvd names none; `fields = { frames = 50 }`"));
    let mut cut_off = folder(&[cube(), cube()], 1.0);
    if let Some(frame) = cut_off.get_mut("fields/frame-00001.vtu") {
        frame.truncate(frame.len() / 2);
    }
    let cut_off = said(&cut_off, "tissue");
    assert!(
        cut_off.starts_with("fields/frame-00001.vtu: it does not end as a frame does;"),
        "{cut_off}"
    );
    let mut lost = folder(&[cube(), cube()], 1.0);
    lost.remove("fields/frame-00001.vtu");
    assert!(said(&lost, "tissue").starts_with("cannot read fields/frame-00001.vtu: "));
    let unknown = said(&folder(&[cube()], 1.0), "temperature");
    assert!(
        unknown.contains("it has tissue, displacement, displacement.x to .z, von_mises"),
        "{unknown}"
    );
}

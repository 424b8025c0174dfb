//! meshio and pyvista read what is written.
//!
//! Both are installed with pip into a virtual environment under the target directory, once. Where that is not possible
//! the test is skipped and says so; `SINEW_PYTHON=0` skips it in any case.

#![allow(
    clippy::expect_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use sinew_mesh::structured::{Split, cube};
use sinew_mesh::vtu::{VtuEncoding, write_pvd, write_vtu};
use sinew_mesh::{CellData, Mesh, MshEncoding, MshVersion, PointData, write_msh};

/// Prints to the terminal, past the test harness.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// The Python that has meshio and pyvista, or why there is none.
fn python() -> Result<PathBuf, String> {
    if std::env::var_os("SINEW_PYTHON").is_some_and(|value| value == "0") {
        return Err("SINEW_PYTHON is 0".to_owned());
    }
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python");
    let python = dir.join("bin").join("python");
    let marker = dir.join("complete");
    if marker.exists() {
        return Ok(python);
    }
    let _ = fs::remove_dir_all(&dir);
    run(Command::new("python3").args(["-m", "venv"]).arg(&dir))?;
    let pip = [
        "-m",
        "pip",
        "install",
        "--quiet",
        "--timeout",
        "5",
        "--retries",
        "1",
    ];
    let packages = ["meshio==5.3.5", "pyvista", "numpy"];
    run(Command::new(&python).args(pip).args(packages))?;
    fs::write(&marker, "").map_err(|error| error.to_string())?;
    Ok(python)
}

fn run(command: &mut Command) -> Result<String, String> {
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("{command:?}: {error}"))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() {
        return Ok(text(&output.stdout));
    }
    let message = text(&output.stderr);
    Err(message.lines().last().unwrap_or("it failed").to_owned())
}

const SCRIPT: &str = r#"
import sys
import numpy as np, meshio, pyvista

def show(label, values):
    print(label, " ".join(repr(float(x)) for x in np.asarray(values).ravel()))

def dump(mesh, groups):
    show("points", mesh.points)
    for kind in ["triangle", "tetra"]:
        show(kind, mesh.cells_dict[kind])
        for name in ["gmsh:physical", "energy"]:
            show(kind + " " + name, mesh.cell_data_dict[name][kind])
    for name in ["temperature", "displacement"]:
        show(name, mesh.point_data[name])
    if groups:
        for name in sorted(mesh.field_data):
            show("group " + name, mesh.field_data[name])

def dump_pyvista(grid):
    show("points", grid.points)
    kinds = {"triangle": 5, "tetra": 10}
    for kind, number in kinds.items():
        show(kind, grid.cells_dict[number])
        for name in ["gmsh:physical", "energy"]:
            show(kind + " " + name, grid.cell_data[name][grid.celltypes == number])
    for name in ["temperature", "displacement"]:
        show(name, grid.point_data[name])

# meshio splits the data of version 2.2 by the wrong lengths; this mends it.
import meshio.gmsh._gmsh22 as gmsh22
split = gmsh22.cell_data_from_raw
gmsh22.cell_data_from_raw = lambda cells, raw: split([meshio.CellBlock(t, d) for t, d in cells], raw)

directory = sys.argv[1]
for file in ["22-text.msh", "22-binary.msh", "41-text.msh", "41-binary.msh"]:
    print("file", file)
    dump(meshio.gmsh.read(directory + "/" + file), True)
for file in ["raw.vtu", "base64.vtu"]:
    print("file", file)
    dump(meshio.read(directory + "/" + file), False)
    print("file", file, "pyvista")
    dump_pyvista(pyvista.read(directory + "/" + file))
reader = pyvista.get_reader(directory + "/series.pvd")
print("times", reader.time_values)
reader.set_active_time_value(0.5)
print("cells", reader.read()[0].n_cells)
"#;

fn mesh() -> Mesh {
    let mut mesh = cube(2, 0.1, Split::Mirrored).expect("valid").to_mesh();
    // meshio joins blocks of version 2.2 and takes tags for ordinals.
    let mut next = 1;
    for block in &mut mesh.cells {
        block.element_tags = (next..).take(block.len()).collect();
        next += block.len() as u64;
    }
    let points = mesh.points.clone();
    mesh.point_data = vec![
        PointData {
            name: "temperature".to_owned(),
            step: 0,
            time: 0.5,
            components: 1,
            values: points.iter().map(|p| p[0] / 3.0 - 1e-30).collect(),
        },
        PointData {
            name: "displacement".to_owned(),
            step: 0,
            time: 0.5,
            components: 3,
            values: points.iter().flatten().map(|x| x / 7.0).collect(),
        },
    ];
    let mut value = 0.0;
    let energies = mesh.cells.iter().map(|block| {
        let values = (0..block.len()).map(|_| {
            value += 0.1;
            value
        });
        values.collect()
    });
    mesh.cell_data = vec![CellData {
        name: "energy".to_owned(),
        step: 0,
        time: 0.5,
        components: 1,
        blocks: energies.collect(),
    }];
    mesh
}

fn show(out: &mut String, label: &str, values: impl Iterator<Item = f64>) {
    out.push_str(label);
    for value in values {
        // As Python shows it, read back and shown by Rust when compared.
        write!(out, " {value:?}").expect("a string takes all");
    }
    out.push('\n');
}

fn expected(mesh: &Mesh, has_groups: bool) -> String {
    let mut out = String::new();
    show(&mut out, "points", mesh.points.iter().flatten().copied());
    for kind in ["triangle", "tetra"] {
        let blocks = || (0..mesh.cells.len()).filter(|&b| mesh.cells[b].kind.name() == kind);
        let nodes = blocks().flat_map(|b| mesh.cells[b].connectivity.iter().map(|&n| f64::from(n)));
        show(&mut out, kind, nodes);
        let groups = blocks().flat_map(|b| {
            let block = &mesh.cells[b];
            (0..block.len()).map(|cell| f64::from(block.physical.first_of(cell)))
        });
        show(&mut out, &format!("{kind} gmsh:physical"), groups);
        let energies = blocks().flat_map(|b| mesh.cell_data[0].blocks[b].iter().copied());
        show(&mut out, &format!("{kind} energy"), energies);
    }
    for data in &mesh.point_data {
        show(&mut out, &data.name, data.values.iter().copied());
    }
    if has_groups {
        let mut groups = mesh.field_data();
        groups.sort_unstable();
        for (name, tag, dim) in groups {
            let label = format!("group {name}");
            show(
                &mut out,
                &label,
                [f64::from(tag), f64::from(dim)].into_iter(),
            );
        }
    }
    out
}

/// Numbers as Rust shows them, whoever wrote them.
fn normalised(text: &str) -> String {
    let word = |word: &str| match word.parse::<f64>() {
        Ok(number) => format!("{number:?}"),
        Err(_) => word.to_owned(),
    };
    let line = |line: &str| line.split(' ').map(word).collect::<Vec<_>>().join(" ");
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

#[test]
fn meshio_and_pyvista_read_what_is_written() {
    let python = match python() {
        Ok(python) => python,
        Err(reason) => {
            say(&format!(
                "SKIPPED meshio_and_pyvista_read_what_is_written: {reason}"
            ));
            return;
        }
    };
    let dir = tempfile::tempdir().expect("a directory for the test");
    let mesh = mesh();
    let mut lines = String::new();
    for (file, version, encoding) in [
        ("22-text.msh", MshVersion::V22, MshEncoding::Text),
        ("22-binary.msh", MshVersion::V22, MshEncoding::Binary),
        ("41-text.msh", MshVersion::V41, MshEncoding::Text),
        ("41-binary.msh", MshVersion::V41, MshEncoding::Binary),
    ] {
        let mut bytes = Vec::new();
        write_msh(&mesh, version, encoding, &mut bytes).expect("it can be written");
        fs::write(dir.path().join(file), bytes).expect("it can be written");
        lines.push_str(&format!("file {file}\n{}", expected(&mesh, true)));
    }
    for (file, encoding) in [
        ("raw.vtu", VtuEncoding::RawAppended),
        ("base64.vtu", VtuEncoding::Base64),
    ] {
        let mut bytes = Vec::new();
        write_vtu(&mesh, encoding, &mut bytes).expect("it can be written");
        fs::write(dir.path().join(file), bytes).expect("it can be written");
        let arrays = expected(&mesh, false);
        lines.push_str(&format!(
            "file {file}\n{arrays}file {file} pyvista\n{arrays}"
        ));
    }
    let mut series = Vec::new();
    write_pvd(&[(0.0, "raw.vtu"), (0.5, "base64.vtu")], &mut series).expect("memory takes all");
    fs::write(dir.path().join("series.pvd"), series).expect("it can be written");
    let cells: usize = mesh.cells.iter().map(sinew_mesh::CellBlock::len).sum();
    lines.push_str(&format!("times [0.0, 0.5]\ncells {cells}\n"));

    let read = run(Command::new(&python).args(["-c", SCRIPT]).arg(dir.path()));
    let read = read.unwrap_or_else(|error| panic!("{error}"));
    let (read, lines) = (normalised(&read), normalised(&lines));
    for (read, expected) in read.lines().zip(lines.lines()) {
        assert_eq!(read, expected);
    }
    assert_eq!(read.lines().count(), lines.lines().count());
}

"""Meshes: from arrays, meshio and pyvista, in files, pickled, and in scenes."""

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest
from conftest import READY, cube

import sinew_sim as sn

meshio = pytest.importorskip("meshio")


def example():
    """A mesh of a cube with groups of every dimension and data."""
    mesh = sn.Scene.from_dict(cube(2)).mesh
    middles = mesh.points[mesh.tets].mean(1)
    left = np.flatnonzero(middles[:, 0] < 0.05)
    right = np.flatnonzero(middles[:, 0] >= 0.05)
    groups = {
        "left": left,
        "right": right,
        "top": mesh.groups["top"].members,
        "bottom": mesh.groups["bottom"].members,
        "edge": sn.Group(1, [[0, 1], [1, 2]]),
        "corner": sn.Group(0, [0]),
    }
    return sn.Mesh(mesh.points, mesh.tets, groups, {"stiffness": 1000.0 + 1e5 * middles[:, 2], "along": middles})


def same(a, b, ordered=True):
    assert np.array_equal(a.points, b.points)
    rows = (lambda t: t) if ordered else (lambda t: t[np.lexsort(t.T)])
    assert np.array_equal(rows(a.tets), rows(b.tets))
    assert a.groups.keys() == b.groups.keys()
    for name, group in a.groups.items():
        other = b.groups[name]
        assert group.dim == other.dim
        if ordered or group.dim != 3:
            key = np.sort if group.members.ndim == 1 else lambda m: m[np.lexsort(m.T)]
            assert np.array_equal(key(group.members), key(other.members)), name
        else:
            mine, theirs = (np.sort(mesh.tets[g.members], axis=1) for mesh, g in ((a, group), (b, other)))
            assert np.array_equal(rows(mine), rows(theirs))
    assert a.data.keys() == b.data.keys()
    if ordered:
        for name, values in a.data.items():
            assert np.array_equal(values, b.data[name])


def small_scene(mesh, **tables):
    fixed = [{"where": {"below": {"z": 0.0}}}]
    return cube(mesh=mesh, fixed=fixed, probe=[{"name": "top", "point": [0.1, 0.1, 0.1]}], **tables)


def test_arrays_come_back_as_they_went_in():
    mesh = example()
    again = sn.Mesh(mesh.points.tolist(), mesh.tets.astype(np.int64).tolist(), mesh.groups, mesh.data)
    same(mesh, again)
    assert mesh.points.dtype == np.float64 and mesh.tets.dtype == np.uint32
    assert mesh.volume == pytest.approx(0.001, rel=1e-12)
    assert {name: group.dim for name, group in mesh.groups.items()} == {
        "left": 3, "right": 3, "top": 2, "bottom": 2, "edge": 1, "corner": 0,
    }  # fmt: skip
    assert "left" in repr(mesh) and f"{len(mesh.tets)} tetrahedra" in repr(mesh)


def test_order_and_dtype_and_layout_of_arrays_do_not_matter():
    mesh = example()
    order = np.random.default_rng(2).permutation(len(mesh.tets))
    shuffled = sn.Mesh(np.asfortranarray(mesh.points), mesh.tets[order].astype(np.int16)[:, :])
    assert np.array_equal(shuffled.tets, mesh.tets[order])
    strided = sn.Mesh(np.repeat(mesh.points, 2, axis=0)[::2], np.repeat(mesh.tets, 2, axis=0)[::2])
    same(sn.Mesh(mesh.points, mesh.tets), strided)
    single = sn.Mesh(mesh.points.astype(np.float32), mesh.tets)
    assert np.array_equal(single.points, mesh.points.astype(np.float32).astype(float))


def test_tetrahedra_of_either_orientation_are_accepted():
    mesh = example()
    turned = mesh.tets[:, [0, 2, 1, 3]]
    turned[::3] = mesh.tets[::3]
    other = sn.Mesh(mesh.points, turned)
    assert np.array_equal(np.sort(other.tets, axis=1), np.sort(mesh.tets, axis=1))
    edges = other.points[other.tets[:, 1:]] - other.points[other.tets[:, :1]]
    assert (np.linalg.det(edges) > 0).all()
    assert other.volume == pytest.approx(mesh.volume, rel=1e-12)
    results = [sn.Scene.from_dict(small_scene(m)).run() for m in (mesh, other)]
    assert np.allclose(results[0].probes["top"], results[1].probes["top"], rtol=1e-9, atol=1e-15)
    assert abs(results[0].probes["top"]).max() > 1e-4


@pytest.mark.parametrize("ending", ["msh", "vtu"])
def test_a_saved_mesh_reads_back(ending, tmp_path):
    mesh = example()
    mesh.save(tmp_path / f"mesh.{ending}")
    assert [file.name for file in tmp_path.iterdir()] == [f"mesh.{ending}"]
    same(mesh, sn.Mesh.read(tmp_path / f"mesh.{ending}"), ordered=False)
    # Over itself, and by a text.
    mesh.save(str(tmp_path / f"mesh.{ending}"))
    same(mesh, sn.Mesh.read(str(tmp_path / f"mesh.{ending}")), ordered=False)


@pytest.mark.parametrize("ending", ["msh", "vtu"])
def test_meshio_reads_what_was_saved(ending, tmp_path):
    mesh = example()
    # In binary .msh files meshio reads data of all cells alone.
    mesh = sn.Mesh(mesh.points, mesh.tets, mesh.groups, mesh.data if ending == "vtu" else {})
    mesh.save(tmp_path / f"mesh.{ending}")
    other = meshio.read(tmp_path / f"mesh.{ending}")
    assert np.array_equal(other.points, mesh.points)
    assert sum(len(block.data) for block in other.cells if block.type == "tetra") == len(mesh.tets)


def test_a_mesh_of_meshio_with_cell_sets():
    mesh = example()
    blocks = [("tetra", mesh.tets[:10]), ("triangle", mesh.groups["top"].members), ("tetra", mesh.tets[10:])]
    empty = np.zeros(0, int)
    given = meshio.Mesh(
        mesh.points,
        blocks,
        cell_sets={
            "part": [np.array([1, 2]), empty, np.array([0, 5])],
            "lid": [empty, np.arange(len(blocks[1][1])), empty],
        },
        cell_data={"stiffness": [np.arange(10.0), np.zeros(len(blocks[1][1])), np.arange(10.0, len(mesh.tets))]},
    )
    scene = sn.Scene.from_dict(small_scene(given))
    own = scene.mesh
    assert np.array_equal(own.tets, mesh.tets) and np.array_equal(own.points, mesh.points)
    assert own.groups["part"].dim == 3 and list(np.sort(own.groups["part"].members)) == [1, 2, 10, 15]
    assert own.groups["lid"].dim == 2 and len(own.groups["lid"].members) == len(blocks[1][1])
    assert np.array_equal(own.data["stiffness"], np.arange(float(len(mesh.tets))))


def test_gmsh_files_of_meshio_are_read_alike_by_both(tmp_path):
    mesh = example()
    left, right, top = (mesh.groups[name].members for name in ("left", "right", "top"))
    tets = mesh.tets[np.concatenate([left, right])].astype(int)
    tags = [np.r_[np.full(len(left), 1), np.full(len(right), 2)], np.full(len(top), 7)]
    written = meshio.Mesh(
        mesh.points,
        [("tetra", tets), ("triangle", top.astype(int))],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"left": np.array([1, 3]), "right": np.array([2, 3]), "lid": np.array([7, 2])},
    )
    path = tmp_path / "mesh.msh"
    meshio.write(path, written, file_format="gmsh22", binary=False)
    by_meshio = sn.Scene.from_dict(small_scene(meshio.read(path))).mesh
    by_us = sn.Mesh.read(path)
    assert set(by_us.groups) == {"left", "right", "lid"} <= set(by_meshio.groups)
    for own in (by_us, by_meshio):
        assert np.array_equal(own.points, mesh.points)
        for name, group in (("left", left), ("right", right)):
            found = np.sort(own.tets[own.groups[name].members], axis=1)
            assert np.array_equal(found[np.lexsort(found.T)], (e := np.sort(mesh.tets[group], axis=1))[np.lexsort(e.T)])
        assert len(own.groups["lid"].members) == len(top)
    hung = {"fixed": [{"group": "lid"}], "probe": [{"name": "low", "point": [0.0, 0.0, 0.0]}]}
    runs = [sn.Scene.from_dict(small_scene(own) | hung).run().probes["low"] for own in (by_us, by_meshio)]
    assert np.array_equal(*runs) and abs(runs[0]).max() > 1e-4


def test_other_cells_of_meshio_are_refused():
    given = meshio.Mesh(np.zeros((8, 3)), [("hexahedron", [list(range(8))])])
    with pytest.raises(ValueError, match="hexahedron.*tetra"):
        sn.Scene.from_dict(small_scene(given))


def test_a_grid_of_pyvista():
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.ImageData(dimensions=(3, 3, 3), spacing=(0.05, 0.05, 0.05)).to_tetrahedra(tetra_per_cell=5)
    grid.cell_data["stiffness"] = np.arange(float(grid.n_cells))
    own = sn.Scene.from_dict(small_scene(grid)).mesh
    assert np.allclose(own.points, grid.points)
    assert np.array_equal(np.sort(own.tets, axis=1), np.sort(grid.cells_dict[10], axis=1))
    assert np.array_equal(own.data["stiffness"], grid.cell_data["stiffness"])
    assert own.volume == pytest.approx(0.001)
    with pytest.raises(ValueError, match="tetrahedra"):
        sn.Scene.from_dict(small_scene(pyvista.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid()))


def test_frames_are_grids_of_pyvista(tmp_path):
    pytest.importorskip("pyvista")
    scene = sn.Scene.from_dict(cube())
    result = scene.run(tmp_path / "run")
    grid, frame = result.frames.to_pyvista(), result.frames.frame(-1)
    assert grid.n_cells == len(scene.mesh.tets)
    assert np.allclose(grid.points, scene.mesh.points + frame["displacement"], atol=1e-6)
    assert np.allclose(grid.cell_data["von_mises"], frame["von_mises"])


def test_a_mesh_pickles_and_copies():
    mesh = example()
    for again in (pickle.loads(pickle.dumps(mesh)), copy.deepcopy(mesh), copy.copy(mesh)):
        same(mesh, again)


def test_a_mesh_in_memory_gives_the_run_of_its_file(tmp_path):
    mesh = sn.Mesh.read(READY.parents[1] / "meshes" / "muscle.msh")
    path, values = READY / "muscle.toml", {"run.duration": 0.002}
    of_file = sn.Scene.load(path, set=values)
    tables = of_file.as_dict() | {"mesh": mesh}
    of_memory = sn.Scene.from_dict(tables)
    assert np.array_equal(of_file.run().probes["insertion"], of_memory.run().probes["insertion"])


def test_scale_and_rotation_act_on_a_mesh_in_memory():
    mesh = example()
    table = {"file": mesh, "scale": 2.0, "rotate": {"axis": [0, 0, 1], "degrees": 90}}
    scene = sn.Scene.from_dict(small_scene(table))
    x, y, z = 2.0 * mesh.points.T
    assert np.allclose(scene.mesh.points, np.stack([-y, x, z], 1), atol=1e-16)
    assert scene.mesh.volume == pytest.approx(8 * mesh.volume)
    again = sn.Scene.from_dict(scene.as_dict())
    assert np.array_equal(again.mesh.points, scene.mesh.points)


def _probe(scene):
    return scene.run(threads=1).probes["top"]


def test_scenes_with_meshes_in_memory_pickle_and_run_elsewhere(tmp_path, monkeypatch):
    scene = sn.Scene.from_dict(small_scene(example()))
    expected = scene.run().probes["top"]
    again = pickle.loads(pickle.dumps(scene))
    assert np.array_equal(again.run().probes["top"], expected)
    saved = scene.session()
    saved.step(5)
    other = again.session()
    other.restore(saved.save())  # it is the same scene
    assert other.steps == 5
    monkeypatch.chdir(tmp_path)
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert np.array_equal(pool.submit(_probe, scene).result(timeout=60), expected)


def test_a_scene_of_files_pickles_with_them(tmp_path, monkeypatch):
    mesh = example()
    mesh.save(tmp_path / "mesh.msh")
    (tmp_path / "factor.csv").write_text("t_s,factor\n0.0,0.0\n0.05,1.0\n")
    load = {"name": "pull", "group": "top", "traction": [10.0, 0.0, 0.0], "ramp": {"table": "factor.csv"}}
    scene = sn.Scene.from_dict(small_scene({"file": "mesh.msh"}, load=[load]), folder=tmp_path)
    expected, pickled = scene.run().probes["top"], pickle.dumps(scene)
    (tmp_path / "mesh.msh").unlink()
    (tmp_path / "factor.csv").unlink()
    monkeypatch.chdir("/")
    assert np.array_equal(pickle.loads(pickled).run().probes["top"], expected)


def test_names_and_folders_may_have_any_letters(tmp_path, monkeypatch):
    folder = tmp_path / "Gewebe α 肝 'a b'"
    folder.mkdir()
    mesh = example()
    mesh.save(folder / "Männchen.vtu")
    same(mesh, sn.Mesh.read(folder / "Männchen.vtu"), ordered=False)
    scene = sn.Scene.from_dict(small_scene({"file": "Männchen.vtu"}, title="Π"), folder=folder)
    monkeypatch.chdir(folder)
    result = scene.run("Lauf ü")
    assert (folder / "Lauf ü" / "summary.json").is_file() and result.summary["title"] == "Π"
    relative = sn.Scene.from_dict(small_scene({"file": "Männchen.vtu"}, title="Π"))
    assert np.array_equal(relative.run().probes["top"], result.probes["top"])
    opened = sn.open("Lauf ü")
    assert np.array_equal(opened.t, result.t)
    monkeypatch.chdir("/")
    for own in (opened, result, pickle.loads(pickle.dumps(result))):
        assert own.frames.frame(-1)["displacement"].shape == mesh.points.shape

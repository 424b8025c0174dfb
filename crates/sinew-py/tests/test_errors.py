"""Wrong uses are refused in words, and leave a session as it was."""

import math
import os

import numpy as np
import pytest
from conftest import READY, block_to_cut, cube, oscillator, probed, soft

import sinew_sim as sn

NAN, INF = math.nan, math.inf
POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
TETS = [[0, 1, 2, 3], [1, 2, 3, 4]]


def said(error):
    """The words of an exception, with the notes that name arguments."""
    return " ".join([str(error), *getattr(error, "__notes__", [])])


def refused(kind, words, call):
    """The call raises an exception of just this kind whose words have these words in their order."""
    with pytest.raises(kind) as caught:
        call()
    assert type(caught.value) is kind, repr(caught.value)
    text, at = said(caught.value), 0
    for word in words.split(" ... "):
        found = text.find(word, at)
        assert found >= 0, f"{word!r} is not in {text!r}"
        at = found + len(word)
    return caught.value


def of(values, **set_):
    return sn.Scene.from_dict(values, set=set_ or None)


def region(**values):
    return [{"density": 1000.0, "model": "linear", "youngs_modulus": 5000.0, "poissons_ratio": 0.3} | values]


def run(**values):
    return {"duration": 0.1, "integrator": "newmark", "dt": 0.01} | values


SCENES = {
    "a path that is not there": (sn.SceneError, "nothere.toml: cannot read", lambda: sn.Scene.load("nothere.toml")),
    "a folder": (sn.SceneError, "/tmp: ... expected a file", lambda: sn.Scene.load("/tmp")),
    "a number as a path": (TypeError, "int ... 'path'", lambda: sn.Scene.load(3)),
    "None as a path": (TypeError, "None ... 'path'", lambda: sn.Scene.load(None)),
    "a number as a text": (TypeError, "int ... 'text'", lambda: sn.Scene.parse(3)),
    "an empty text": (sn.SceneError, "exactly one of `mesh`, `oscillator`, found none", lambda: sn.Scene.parse("")),
    "no TOML": (sn.SceneError, ":1: not TOML", lambda: sn.Scene.parse("a = = 3")),
    "deep TOML": (sn.SceneError, "not TOML: ... recur", lambda: sn.Scene.parse("a = " + "[" * 5000)),
    "None as values": (TypeError, "values: expected a dictionary ... NoneType", lambda: of(None)),
    "a list as values": (TypeError, "values: expected a dictionary ... list", lambda: of([1])),
    "an unknown table": (sn.SceneError, "unknown key `foo`", lambda: of(cube(foo=1))),
    "an unknown key": (sn.SceneError, "`yongs_modulus`", lambda: of(cube(region=region(yongs_modulus=1.0)))),
    "None as a value": (sn.SceneError, "load: None: expected a value", lambda: of(cube(load=None))),
    "an object": (sn.SceneError, "title: object: expected", lambda: of(cube(title=object()))),
    "a huge number": (sn.SceneError, "gravity[3]: 12089 ... 64 bits", lambda: of(cube(gravity=[0, 0, 2**80]))),
    "nan": (sn.SceneError, "gravity = [0, 0, nan]: expected ... finite", lambda: of(cube(gravity=[0, 0, NAN]))),
    "too few numbers": (sn.SceneError, "gravity = [0, 0]", lambda: of(cube(gravity=[0, 0]))),
    "a negative density": (sn.SceneError, "density = -1.0: expected", lambda: of(cube(region=region(density=-1.0)))),
    "Poisson's ratio of 1/2": (sn.SceneError, "poissons_ratio", lambda: of(cube(region=region(poissons_ratio=0.5)))),
    "a key that is no text": (sn.SceneError, "damping: the key 3: expected", lambda: of(cube(damping={3: 1.0}))),
    "a number as a mesh": (TypeError, "mesh: expected ... got int", lambda: of(cube(mesh=3))),
    "a text as a mesh": (TypeError, "mesh: expected ... got str", lambda: of(cube(mesh="organ.msh"))),
    "a file that is not there": (sn.SceneError, "no.msh: No such", lambda: of(cube(mesh={"file": "no.msh"})).session()),
    "an unknown group": (sn.SceneError, 'named "floor"; the groups are', lambda: of(cube(fixed=[{"group": "floor"}])).session()),
    "an unknown method": (sn.SceneError, "`eulr`; there are", lambda: of(cube(run=run(integrator="eulr")))),
    "a step of 0": (sn.SceneError, "dt = 0.0: expected", lambda: of(cube(run=run(dt=0.0)))),
    "a text as a step": (sn.SceneError, 'dt = "fast": expected', lambda: of(cube(run=run(dt="fast")))),
    "an option of another method": (sn.SceneError, "patches", lambda: of(cube(run=run(patches="auto")))),
    "set of an unknown key": (sn.SceneError, "`youngs`", lambda: of(cube(), **{"region.1.youngs": 1.0})),
    "set of a region that is not there": (sn.SceneError, "region[2]", lambda: of(cube(), **{"region.2.density": 1.0})),
    "set of number 0": (sn.SceneError, "region.0.density ... from 1", lambda: of(cube(), **{"region.0.density": 1.0})),
    "set of None": (sn.SceneError, "region.1.density: None", lambda: of(cube(), **{"region.1.density": None})),
    "set of a text": (sn.SceneError, "density = ... stiff", lambda: of(cube(), **{"region.1.density": "stiff"})),
    "set by a list": (TypeError, "list ... 'set'", lambda: sn.Scene.from_dict(cube(), set=["a=1"])),
    "a list within itself": (sn.SceneError, "gravity", lambda: of(cube(gravity=(own := [1], own.append(own))[0]))),
    "another folder's file": (sn.SceneError, "tool.csv", lambda: of(cube(move=[{"group": "top", "table": "tool.csv"}])).session()),
}  # fmt: skip

MESHES = {
    "a node too high": (ValueError, "tets: 5 is no node ... from 0 to 4", lambda: sn.Mesh(POINTS, [[0, 1, 2, 5]])),
    "a negative node": (ValueError, "tets: -1 is no node", lambda: sn.Mesh(POINTS, [[0, 1, 2, -1]])),
    "triangles": (ValueError, "tets: ... (n, 4)", lambda: sn.Mesh(POINTS, [[0, 1, 2]])),
    "real numbers": (ValueError, "tets: ... float64 of shape (2, 4)", lambda: sn.Mesh(POINTS, np.array(TETS) * 1.0)),
    "huge numbers": (ValueError, "tets: ", lambda: sn.Mesh(POINTS, [[0, 1, 2, 2**70]])),
    "points in a plane": (ValueError, "points: ... (n, 3), got ... (5, 2)", lambda: sn.Mesh(POINTS[:, :2], TETS)),
    "points at nan": (ValueError, "points: node 0", lambda: sn.Mesh(POINTS * NAN, TETS)),
    "a text": (ValueError, "points: ... str", lambda: sn.Mesh("points", TETS)),
    "no tetrahedra": (ValueError, "tets: ", lambda: sn.Mesh(POINTS, np.zeros((0, 4), int))),
    "a group beyond": (ValueError, 'groups["a"]: 2 is no tetrahedron', lambda: sn.Mesh(POINTS, TETS, {"a": [2]})),
    "a group of reals": (ValueError, 'groups["a"]: ... whole numbers', lambda: sn.Mesh(POINTS, TETS, {"a": [0.5]})),
    "an empty group": (ValueError, 'groups["a"]: ', lambda: sn.Mesh(POINTS, TETS, {"a": []})),
    "groups by a text": (TypeError, "str ... 'groups'", lambda: sn.Mesh(POINTS, TETS, "a")),
    "a dimension of 5": (ValueError, "dim: 5: expected", lambda: sn.Group(5, [1])),
    "data of one": (ValueError, 'data["e"]: ... 2 tetrahedra, got (1,)', lambda: sn.Mesh(POINTS, TETS, {}, {"e": [1.0]})),
    "no such file": (sn.SceneError, "nothere.msh", lambda: sn.Mesh.read("nothere.msh")),
    "a folder": (sn.SceneError, "/tmp: is a directory", lambda: sn.Mesh.read("/tmp")),
    "an unknown ending": (ValueError, "path: x.stl: expected ... .msh", lambda: sn.Mesh(POINTS, TETS).save("x.stl")),
}

RUNS = {
    "a number as a folder": (ValueError, "out: expected the path of a folder", lambda s: s.run(3)),
    "a folder in no folder": (OSError, "/proc/x/y", lambda s: s.run("/proc/x/y")),
    "0 threads": (ValueError, "threads: expected a whole number from 1", lambda s: s.run(threads=0)),
    "many threads": (ValueError, "threads: expected", lambda s: s.run(threads="many")),
    "half a thread": (ValueError, "threads: expected", lambda s: s.run(threads=1.5)),
    "no function": (TypeError, "progress: expected a function ... int", lambda s: s.run(progress=3)),
    "no tolerance": (ValueError, "tolerance: ... -1", lambda s: s.plan(tolerance=-1)),
    "a tolerance of nan": (ValueError, "tolerance: ... NaN", lambda s: s.plan(tolerance=NAN)),
    "no budget": (ValueError, "budget: ... 0", lambda s: s.plan(budget=0)),
    "no seconds": (ValueError, "seconds: -1", lambda s: s.plan(tolerance=0.1, seconds=-1)),
    "no log": (ValueError, "log:1: expected", lambda s: s.replay("hello")),
    "an empty log": (ValueError, "log:1: expected", lambda s: s.replay("")),
    "a number as a log": (TypeError, "int ... 'log'", lambda s: s.replay(3)),
    "another scene's log": (ValueError, "log: ... another scene", lambda s: s.replay(of(cube(2)).session().log)),
    "a folder that is not there": (FileNotFoundError, "nothere", lambda s: sn.open("nothere")),
    "a folder of no run": (FileNotFoundError, "/tmp: no run", lambda s: sn.open("/tmp")),
    "a session by itself": (TypeError, "Session", lambda s: sn.Session()),
}  # fmt: skip

SESSIONS = {
    "step(-1)": (ValueError, "n: -1: expected", lambda s: s.step(-1)),
    "step(1.5)": (TypeError, "float ... 'n'", lambda s: s.step(1.5)),
    "step of a text": (TypeError, "str ... 'n'", lambda s: s.step("2")),
    "step(None)": (TypeError, "None ... 'n'", lambda s: s.step(None)),
    "a huge step": (ValueError, "n: 1208925819614629174706176: expected", lambda s: s.step(2**80)),
    "advance(-1)": (ValueError, "by: -1: expected a finite time", lambda s: s.advance(-1)),
    "advance(nan)": (ValueError, "by: NaN: expected", lambda s: s.advance(NAN)),
    "advance(inf)": (ValueError, "by: inf: expected", lambda s: s.advance(INF)),
    "advance of a text": (TypeError, "str ... 'by'", lambda s: s.advance("x")),
    "advance()": (TypeError, "'by'", lambda s: s.advance()),
    "no tool": (KeyError, 'no tool is named "x"; there are "ball"', lambda s: s.tool("x")),
    "no load": (KeyError, 'no load is named "x"; there are "gravity"', lambda s: s.load("x")),
    "a number as a tool": (TypeError, "int ... 'name'", lambda s: s.tool(3)),
    "two numbers": (ValueError, "position: expected 3 numbers (m), got list of length 2", lambda s: s.tool("ball").move_to([1, 2])),
    "a position of nan": (ValueError, '"ball": NaN: expected finite', lambda s: s.tool("ball").move_to([NAN, 0, 0])),
    "far away": (ValueError, '"ball": ... at most 1e6', lambda s: s.tool("ball").move_to([1e9, 0, 0])),
    "texts": (ValueError, "position: expected 3 numbers", lambda s: s.tool("ball").move_to(["a", "b", "c"])),
    "rows": (ValueError, "position: ... (1, 3)", lambda s: s.tool("ball").move_to(np.zeros((1, 3)))),
    "a rotation of two": (ValueError, "rotation_vector: expected 3", lambda s: s.tool("ball").move_to([0, 0, 1], [0, 0])),
    "a factor of nan": (ValueError, 'factor of "gravity": NaN', lambda s: setattr(s.load("gravity"), "factor", NAN)),
    "a factor of a text": (TypeError, "str ... 'factor'", lambda s: setattr(s.load("gravity"), "factor", "x")),
    "a node beyond": (ValueError, "nodes: 125 is no node ... to 124", lambda s: s.force([125], [0, 0, 1])),
    "a node below": (ValueError, "nodes: -1 is no node", lambda s: s.force([-1], [0, 0, 1])),
    "a mask": (ValueError, "nodes: ... bool", lambda s: s.force(np.ones(125, bool), [0, 0, 1])),
    "a row too few": (ValueError, "forces: ... 2 nodes, got 1", lambda s: s.force([0, 1], [[0, 0, 1]])),
    "two components": (ValueError, "forces: ... (n, 3)", lambda s: s.force([0], [[0, 0]])),
    "a force of nan": (ValueError, "NaN: expected finite", lambda s: s.force([0], [NAN, 0, 0])),
    "no forces": (ValueError, "forces: ... NoneType", lambda s: s.force([0], None)),
    "an unknown method": (ValueError, "`x`; there are", lambda s: s.switch("x")),
    "None as a method": (TypeError, "None ... 'integrator'", lambda s: s.switch(None)),
    "an unknown option": (ValueError, "no option `bta`; it takes", lambda s: s.switch("newmark", bta=0.3)),
    "an option out of bounds": (ValueError, "beta = 7: expected", lambda s: s.switch("newmark", beta=7)),
    "an option of None": (sn.SceneError, "beta: None", lambda s: s.switch("newmark", beta=None)),
    "a method for other scenes": (ValueError, "`newmark`: this method does not support tools", lambda s: s.switch("newmark")),
    "a step of 0 of a method": (ValueError, "dt = 0", lambda s: s.switch("symplectic-euler", dt=0.0)),
    "a negative step": (ValueError, "dt = -1", lambda s: s.switch("symplectic-euler", dt=-1)),
    "a step of nan": (ValueError, "dt = NaN", lambda s: s.switch("symplectic-euler", dt=NAN)),
    "an infinite step": (ValueError, "dt = inf", lambda s: s.switch("symplectic-euler", dt=INF)),
    "a text as a step": (TypeError, "str ... 'dt'", lambda s: s.switch("symplectic-euler", dt="auto")),
    "a whole body": (ValueError, "[cutting]", lambda s: s.cut([[0, 0, 0], [0, 0, 1]], [[1, 0, 0], [1, 0, 1]])),
    "one end of a blade": (ValueError, "before: ... (2, 3), got (1, 3)", lambda s: s.cut([[0, 0, 0]], [[1, 0, 0], [1, 0, 1]])),
    "no blade": (ValueError, "after: ... NoneType", lambda s: s.cut([[0, 0, 0], [0, 0, 1]], None)),
    "restore(None)": (ValueError, "saved: ... NoneType", lambda s: s.restore(None)),
    "restore of a text": (ValueError, "saved: ... str", lambda s: s.restore("x")),
    "no bytes": (ValueError, "saved: ... cut off: 0", lambda s: s.restore(b"")),
    "other bytes": (ValueError, "saved: these bytes are no saved world", lambda s: s.restore(b"x" * 1000)),
    "bytes cut off": (ValueError, "saved: ... cut off", lambda s: s.restore(s.save()[:-1])),
    "bytes too many": (ValueError, "saved: something follows", lambda s: s.restore(s.save() + b"x")),
    "bytes of another scene": (ValueError, "saved: ... another scene", lambda s: s.restore(of(cube()).session().save())),
    "a shape of out": (ValueError, "out: ... (384, 6), got float64 of shape (2, 2)", lambda s: s.stress(out=np.zeros((2, 2)))),
    "a dtype of out": (ValueError, "out: ... got float32", lambda s: s.strain(out=np.zeros((384, 6), np.float32))),
    "a list as out": (ValueError, "out: ... got list", lambda s: s.von_mises(out=[1.0])),
    "a slice as out": (ValueError, "out: ... not C-contiguous", lambda s: s.contact_force(out=np.zeros((250, 3))[::2])),
    "columns as out": (ValueError, "out: ... C-contiguous", lambda s: s.stress(out=np.zeros((384, 6), order="F"))),
    "a transposed out": (ValueError, "out: ... C-contiguous", lambda s: s.contact_force(out=np.zeros((3, 125)).T)),
    "columns to read into": (ValueError, "C-contiguous", lambda s: s.read_into(velocity=np.zeros((125, 3), order="F"))),
    "big ends first": (ValueError, "out: ... got >f8", lambda s: s.stress(out=np.zeros((384, 6), ">f8"))),
    "an out that is locked": (ValueError, "out: expected a writeable", lambda s: s.stress(out=np.broadcast_to(0.0, (384, 6)))),
    "an array of out by place": (TypeError, "positional", lambda s: s.read_into(np.zeros((125, 3)))),
    "a shape to read into": (ValueError, "(125, 3)", lambda s: s.read_into(velocity=np.zeros((125, 2)))),
    "a time that is set": (AttributeError, "'t'", lambda s: setattr(s, "t", 0.0)),
    "a new attribute": (AttributeError, "'foo'", lambda s: setattr(s, "foo", 0.0)),
}  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_scenes(name):
    refused(*SCENES[name])


@pytest.mark.parametrize("name", MESHES)
def test_meshes(name):
    refused(*MESHES[name])


@pytest.mark.parametrize("name", RUNS)
def test_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    kind, words, call = RUNS[name]
    scene = of(cube())
    refused(kind, words, lambda: call(scene))
    assert not list(tmp_path.iterdir())
    assert scene.run().outcome == "finished"


@pytest.fixture(scope="module")
def pressing():
    """A session in mid-motion, and one like it that nobody uses wrongly."""

    def begun():
        sim = of(probed()).session()
        for k in range(12):
            sim.tool("ball").move_to([0.05, 0.05, 0.13 - 0.0006 * k])
            sim.step()
        return sim

    return begun(), begun()


@pytest.mark.parametrize("name", SESSIONS)
def test_sessions(name, pressing):
    kind, words, call = SESSIONS[name]
    sim, other = pressing
    log = sim.log
    refused(kind, words, lambda: call(sim))
    assert sim.log == log
    for own in (sim, other):
        own.step()
    assert sim.save() == other.save()


def test_each_flipped_bit_of_a_state_is_noticed(pressing):
    sim, _ = pressing
    saved = sim.save()
    rng = np.random.default_rng(0)
    for at in rng.integers(0, len(saved), 100):
        flipped = bytearray(saved)
        flipped[at] ^= 1 << int(rng.integers(8))
        refused(ValueError, "saved: ", lambda: sim.restore(bytes(flipped)))
    assert sim.save() == saved


def test_a_scene_error_names_the_place(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text((READY / "press.toml").read_text().replace("friction", "fricton"))
    error = refused(sn.SceneError, "fricton", lambda: sn.Scene.load(path))
    assert error.file == str(path)
    line = path.read_text().splitlines()[error.line - 1]
    assert line[error.column - 1 :].startswith("fricton")
    assert "`friction`" in error.hint or "`friction`" in str(error)
    assert isinstance(error, ValueError)
    error = refused(sn.SceneError, "load: None", lambda: of(cube(load=None)))
    assert (error.file, error.line, error.column, error.hint) == (None,) * 4


def test_motion_that_diverges_says_when_and_where():
    scene = of(cube(run={"duration": 10.0, "integrator": "central-difference", "dt": 0.01}))
    assert scene.stable_step() < 0.01
    sim = scene.session()
    begun = sim.save()
    with pytest.raises(sn.Diverged, match="diverged") as caught:
        sim.step(1000)
    error = caught.value
    assert isinstance(error, RuntimeError)
    assert 0 < error.t < 10 and error.t == sim.t and "node" in error.place
    for call in (lambda: sim.step(), lambda: sim.step(3), lambda: sim.advance(0.1)):
        with pytest.raises(RuntimeError, match="failed|diverged"):
            call()
    for again in (sim.reset, lambda: sim.restore(begun)):
        again()
        assert sim.t == 0.0
        sim.step(2)
        assert np.isfinite(sim.positions).all()
    with pytest.raises(sn.Diverged) as one:
        while True:
            sim.step()
    assert one.value.t == error.t and one.value.place == error.place
    result = scene.run()
    assert result.outcome == "diverged" and result.summary["diverged"]["t_s"] == pytest.approx(error.t)


def test_a_state_that_a_law_refuses_says_when_and_where():
    law = {"density": 1000.0, "model": "gent", "shear_modulus": 2000.0, "limit": 0.05, "poissons_ratio": 0.4}
    load = {"name": "pull", "group": "top", "traction": [3000.0, 0.0, 0.0]}
    run = {"duration": 0.5, "integrator": "central-difference", "dt": 0.0005}
    scene = of(soft(region=[law], load=[load], run=run, gravity=[0.0, 0.0, 0.0]))
    sim = scene.session()
    with pytest.raises(sn.Refused) as caught:
        sim.step(1000)
    error = caught.value
    assert isinstance(error, RuntimeError) and not isinstance(error, sn.Diverged)
    assert 0 < error.t < 0.5 and "tetrahedron" in error.place
    sim.reset()
    sim.load("pull").factor = 0.0
    sim.step(10)
    assert scene.run().outcome == "refused"


def test_oscillators_have_no_fields():
    sim = of(oscillator()).session()
    sim.step(3)
    for call in (sim.stress, sim.von_mises, sim.strain, sim.contact_force, lambda: sim.positions):
        refused(ValueError, "oscillator", call)
    assert sim.displacement.shape == sim.velocity.shape == (1, 1)
    refused(ValueError, "", lambda: sim.force([0], [1.0, 0.0, 0.0]))
    sim.step()


def test_arrays_of_a_mesh_that_was_cut_do_not_fit_any_more():
    sim = of(block_to_cut()).session()
    out, node = np.zeros_like(sim.positions), len(sim.positions)
    refused(ValueError, "nodes: 105 is no node", lambda: sim.force([node], [0.0, 0.0, 0.0]))
    sim.cut([[0.031, -0.01, -0.01], [0.031, -0.01, 0.03]], [[0.031, 0.021, -0.01], [0.031, 0.021, 0.03]])
    sim.step()
    refused(ValueError, "(111, 3), got float64 of shape (105, 3)", lambda: sim.contact_force(out))
    sim.force([node], [0.0, 0.0, 0.0])


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_may_not_be_written_into(tmp_path):
    tmp_path.chmod(0o500)
    refused(OSError, str(tmp_path), lambda: of(cube()).run(tmp_path / "run"))


def test_folders_of_others_are_left_alone(tmp_path):
    (tmp_path / "mine.txt").write_text("x")
    error = refused(OSError, "mine.txt", lambda: of(cube()).run(tmp_path))
    assert "new folder" in str(error)
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]
    refused(OSError, "it is not a folder", lambda: of(cube()).run(tmp_path / "mine.txt"))
    assert (tmp_path / "mine.txt").read_text() == "x"


def test_no_call_ends_in_an_internal_error():
    """Every method and attribute with odd arguments: none panics."""
    odd = [None, -1, 0, 2**31, 2**64, NAN, INF, "", "x", b"", [], {}, [[]], np.zeros(0), np.zeros((2, 2, 2)), object()]
    sim = of(probed(2)).session()
    tool, load = sim.tool("ball"), sim.load("gravity")
    for owner in (sim, sim.scene, sim.mesh, tool, load, sn.Mesh, sn.Group, sn.Scene):
        for name in dir(owner):
            if name.startswith("_") or name in ("step", "advance", "run", "plan", "save"):
                continue
            method = getattr(owner, name)
            if not callable(method):
                continue
            for arguments in [(a,) for a in odd] + [(a, b) for a in odd for b in odd]:
                try:
                    method(*arguments)
                except sn.InternalError as error:
                    pytest.fail(f"{owner}.{name}{arguments}: {error}")
                except Exception:
                    pass
    sim.reset()
    sim.step(3)
    other = of(probed(2)).session()
    other.step(3)
    assert sim.save() == other.save()

"""Runs, sessions and the command give the same bits."""

import re

import numpy as np
import pytest
from conftest import READY, command, oscillator

import sinew_sim as sn

# Times of runs (s), short where the whole would take long; all are multiples of the step.
DURATIONS = {
    "artery": 0.02,
    "beam": 1.0,
    "creep": 8.0,
    "handle": 0.2,
    "held-cube": 1.0,
    "incision": 1.0,
    "inclusion": 0.1,
    "layers": 0.1,
    "muscle": 0.02,
    "needle-push": 0.1,
    "needle": 0.2,
    "organ-fibres": 0.004,
    "organ-pressed": 0.004,
    "organ": 0.2,
    "press": 0.1,
    "retract": 0.2,
    "slit": 0.6,
    "slivers": 0.02,
    "twisted-column": 0.1,
    "vessel": 0.1,
}


def table(text):
    """Names and numbers of a table."""
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return lines[0].split(","), np.array([line.split(",") for line in lines[1:]], float)


def assert_same_probes(result, text):
    names, rows = table(text)
    assert np.array_equal(result.t, rows[:, 0])
    assert len(rows) > 1
    column = 1
    for name, values in result.probes.items():
        values = values.reshape(len(values), -1)
        width = values.shape[1]
        assert all(own.startswith(f"{name}_") for own in names[column : column + width])
        assert np.array_equal(values, rows[:, column : column + width]), name
        column += width
    assert column == len(names)


def test_every_ready_scene_is_here():
    assert {path.stem for path in READY.glob("*.toml")} == set(DURATIONS)


@pytest.mark.parametrize("name", DURATIONS)
def test_run_and_session_have_the_bits_of_the_command(name, tmp_path):
    path, duration = READY / f"{name}.toml", DURATIONS[name]
    folder = tmp_path / "run"
    said = command("run", path, "--set", f"run.duration={duration}", "--out", folder)
    assert said.returncode == 0, said.stderr
    scene = sn.Scene.load(path, set={"run.duration": duration})
    result = scene.run()
    assert result.outcome == "finished" and result.folder is None
    assert_same_probes(result, (folder / "probes.csv").read_text())

    # All tables, not the probes alone.
    by_command = sn.open(folder)
    for own, other in ((result.energy, by_command.energy), (result.reactions, by_command.reactions)):
        assert own.keys() == other.keys()
    for key, values in by_command.energy.items():
        assert np.array_equal(result.energy[key], values), key
    for tool, columns in by_command.tools.items():
        for key, values in columns.items():
            assert np.array_equal(result.tools[tool][key], values), key

    session = scene.session()
    while session.t < duration - session.dt / 2:
        session.step()
    comments = [line for line in (folder / "probes.csv").read_text().splitlines() if line.startswith("#")]
    nodes = [re.match(r"# (\S+): node (\d+) at", line).groups() for line in comments]
    assert nodes
    # Tags of nodes in files may begin at 1, so the place at rest tells the node.
    rest = scene.mesh.points
    for (probe, _), line in zip(nodes, comments):
        place = [float(x) for x in re.search(r" at (\S+) (\S+) (\S+) m", line).groups()]
        node = np.flatnonzero((rest == place).all(1))
        assert len(node) == 1
        assert np.array_equal(session.displacement[node[0]], result.probes[probe][-1]), probe


@pytest.mark.parametrize("name", ["held-cube", "creep", "handle", "incision"])
def test_a_folder_of_python_is_that_of_the_command(name, tmp_path):
    path, duration = READY / f"{name}.toml", DURATIONS[name]
    said = command("run", path, "--set", f"run.duration={duration}", "--out", tmp_path / "a")
    assert said.returncode == 0, said.stderr
    result = sn.Scene.load(path, set={"run.duration": duration}).run(tmp_path / "b")
    files = {file.relative_to(tmp_path / "a") for file in (tmp_path / "a").rglob("*") if file.is_file()}
    assert files == {file.relative_to(tmp_path / "b") for file in (tmp_path / "b").rglob("*") if file.is_file()}
    differ = {str(f) for f in files if (tmp_path / "a" / f).read_bytes() != (tmp_path / "b" / f).read_bytes()}
    # Wall times are in these.
    assert differ <= {"summary.json", "report.html", "run.json", "scene.toml"}
    assert len(result.frames) == len(list((tmp_path / "b" / "fields").iterdir()))
    last = result.frames.frame(-1)
    assert last["displacement"].shape == last["points"].shape


def test_standard_output_and_file_are_the_same_probes(tmp_path):
    path = READY / "held-cube.toml"
    said = command("run", path, "--probes", "-")
    assert said.returncode == 0
    assert command("run", path, "--probes", tmp_path / "probes.csv").returncode == 0
    assert_same_probes(sn.Scene.load(path).run(), said.stdout)
    assert_same_probes(sn.Scene.load(path).run(threads=2), (tmp_path / "probes.csv").read_text())


def test_an_oscillator_is_that_of_the_command(tmp_path):
    scene = sn.Scene.from_dict(oscillator())
    (tmp_path / "scene.toml").write_text(scene.text)
    said = command("run", tmp_path / "scene.toml", "--probes", "-")
    result = scene.run()
    assert result.probes["mass"].shape == result.t.shape
    assert_same_probes(result, said.stdout)


def test_a_log_replays_by_the_command(tmp_path):
    path = READY / "held-cube.toml"
    sim = sn.Scene.load(path).session()
    sim.load("load 1").factor = 0.5
    sim.step(40)
    sim.switch("newmark", dt=0.005)
    sim.step(20)
    (tmp_path / "session.log").write_text(sim.log)
    said = command("run", path, "--replay", tmp_path / "session.log", "--probes", "-")
    assert said.returncode == 0, said.stderr
    _, rows = table(said.stdout)
    top = np.argmin(np.abs(sim.mesh.points - [0.1, 0.1, 0.2]).sum(1))
    assert rows[-1, 0] == sim.t
    assert np.array_equal(rows[-1, 1:4], sim.displacement[top])


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--help"], 0, "Usage: sinew-sim <COMMAND>"),
        (["--version"], 0, sn.__version__),
        (["integrators"], 0, "central-difference"),
        (["mesh", "info", READY.parents[1] / "meshes" / "organ.msh"], 0, "parenchyma"),
        (["plan", READY / "held-cube.toml"], 0, "stable"),
        (["scene-reference"], 0, "[run]"),
        ([], 2, "Usage"),
        (["frobnicate"], 2, "frobnicate"),
        (["run"], 2, "<SCENE>"),
        (["run", "nothere.toml"], 2, "nothere.toml: cannot read the scene"),
        (["run", READY / "slit.toml", "--dt", "-1"], 2, "dt = -1"),
        (["run", READY / "slit.toml", "--set", "run.duraton=1"], 2, "duraton"),
        (["run", READY / "slit.toml", "--out", "/proc/x"], 2, "cannot write /proc/x"),
        (["resume", "nothere"], 2, "nothere"),
        (["integrators", "nosuch"], 2, "nosuch"),
    ],
)
def test_exit_codes_and_words(arguments, code, words, tmp_path):
    said = command(*arguments, cwd=tmp_path)
    assert said.returncode == code, said.stderr
    assert words in (said.stdout if code == 0 else said.stderr)
    assert "panicked" not in said.stderr and "Traceback" not in said.stderr
    assert not list(tmp_path.iterdir())


def test_a_diverged_run_has_an_exit_code_of_its_own(tmp_path):
    path, values = READY / "held-cube.toml", ["--set", "run.dt=0.02", "--set", "run.duration=20.0"]
    said = command("run", path, *values, "--out", tmp_path / "run")
    assert said.returncode == 1, said.stderr
    assert "diverged at t = " in said.stderr
    by_command = sn.open(tmp_path / "run")
    result = sn.Scene.load(path, set={"run.dt": 0.02, "run.duration": 20.0}).run()
    assert by_command.outcome == result.outcome == "diverged"
    assert np.array_equal(by_command.t, result.t)

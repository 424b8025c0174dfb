"""Memory does not grow: resets, restores, steps with arrays, sessions that come and go."""

import gc
import os
import threading

import numpy as np
import pytest
from conftest import block_to_cut, cube, probed, soft

import sinew_sim as sn

if not os.path.exists("/proc/self/statm"):
    pytest.skip("no /proc here", allow_module_level=True)


def resident():
    """Memory of this process (bytes)."""
    gc.collect()
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def growth(call, warm, times):
    """How much memory (MB) grows in so many calls after some that warm up."""
    for _ in range(warm):
        call()
    before = resident()
    for _ in range(times):
        call()
    grown = (resident() - before) / 1e6
    print(f"{times} calls: {grown:+.2f} MB")
    return grown


def pressed(sim):
    sim.tool("ball").move_to([0.05, 0.05, 0.125])
    sim.step(3)


def test_1000_resets():
    sim = sn.Scene.from_dict(probed(5)).session()

    def act():
        sim.reset()
        pressed(sim)

    assert growth(act, 100, 1000) < 5


def test_1000_restores():
    sim = sn.Scene.from_dict(probed(5)).session()
    pressed(sim)
    saved = sim.save()

    def act():
        sim.restore(saved)
        pressed(sim)
        assert len(sim.save()) > 1000

    assert growth(act, 100, 1000) < 5


def test_1000_resets_of_cuts():
    sim = sn.Scene.from_dict(block_to_cut()).session()

    def act():
        sim.cut([[0.031, -0.01, -0.01], [0.031, -0.01, 0.03]], [[0.031, 0.021, -0.01], [0.031, 0.021, 0.03]])
        sim.step()
        assert sim.stress().shape[0] == len(sim.mesh.tets)
        sim.reset()

    assert growth(act, 100, 500) < 5


def test_10000_steps_with_arrays():
    sim = sn.Scene.from_dict(cube(5)).session()
    out = np.zeros_like(sim.stress())

    def act():
        sim.step()
        sim.positions, sim.displacement, sim.velocity, sim.stress(), sim.von_mises(), sim.contact_force()
        sim.stress(out), sim.energy(), sim.reactions(), sim.t

    assert growth(act, 500, 10_000) < 5


def test_sessions_that_come_and_go():
    scene = sn.Scene.from_dict(soft(6))

    def act():
        sim = scene.session()
        sim.step(2)
        assert sim.mesh.tets.shape[1] == 4

    assert growth(act, 30, 200) < 5


def test_scenes_and_runs_that_come_and_go():
    def act():
        scene = sn.Scene.from_dict(cube(5, duration=0.01))
        assert scene.run().outcome == "finished"
        scene.matrices(), scene.mesh.groups, scene.as_dict()

    assert growth(act, 20, 60) < 5


def test_refusals_hold_nothing():
    sim = sn.Scene.from_dict(probed(5)).session()
    saved = sim.save()

    def act():
        for call in (lambda: sim.restore(saved[:-1]), lambda: sim.stress(out=np.zeros(3)), lambda: sim.switch("newmark", dt=0.01)):
            with pytest.raises((ValueError, sn.Refused)):
                call()

    assert growth(act, 100, 500) < 5


def test_runs_leave_no_files_and_no_threads(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    scene = sn.Scene.from_dict(cube(5, duration=0.01))
    scene.run()
    files, threads = len(os.listdir("/proc/self/fd")), threading.active_count()
    for _ in range(20):
        scene.run()
    with pytest.raises(ZeroDivisionError):
        sn.Scene.from_dict(soft(8, run={"duration": 1000.0, "integrator": "central-difference", "dt": "auto"})).run(
            progress=lambda t, duration: 1 / 0
        )
    assert len(os.listdir("/proc/self/fd")) == files and threading.active_count() == threads
    assert not list(tmp_path.iterdir())

"""What the way through Python costs. Bounds are wide, for computers with other work; figures are printed."""

import time

import numpy as np
from conftest import cube, oscillator, python

import sinew_sim as sn


def shortest(call, times, tries=15):
    """Time (us) of a call: the shortest mean of several tries."""
    found = []
    for _ in range(tries):
        begun = time.perf_counter()
        for _ in range(times):
            call()
        found.append((time.perf_counter() - begun) / times)
    return 1e6 * min(found)


def test_a_step_through_python():
    sim = sn.Scene.from_dict(oscillator(10.0)).session()
    single = shortest(sim.step, 2000)
    many = shortest(lambda: sim.step(20_000), 1) / 20_000
    print(f"a step through Python: {single:.2f} us, within step(n): {many:.2f} us")
    assert single - many < 6.0


def test_a_step_of_a_body():
    run = {"duration": 1.0, "integrator": "central-difference", "dt": 0.001, "threads": 1}
    sim = sn.Scene.from_dict(cube(10, run=run)).session()
    assert len(sim.positions) == 1331
    single = shortest(sim.step, 100)
    many = shortest(lambda: sim.step(100), 1) / 100
    print(f"1331 nodes, a step through Python: {single:.2f} us, within step(n): {many:.2f} us")
    # What a call begins with is done once in step(n); the library takes the difference, not Python.
    assert single < 4 * many


def test_positions_of_1331_nodes():
    sim = sn.Scene.from_dict(cube(10)).session()
    sim.step(5)
    out = np.zeros((1331, 3))
    new = shortest(lambda: sim.positions, 300)
    kept = shortest(lambda: sim.read_into(positions=out), 300)
    print(f"positions of 1331 nodes: {new:.2f} us, into an array: {kept:.2f} us, t: {shortest(lambda: sim.t, 1000):.2f} us")
    assert new < 15.0 and kept < 15.0


def test_resets_of_2000_nodes():
    sim = sn.Scene.from_dict(cube(12)).session()
    sim.step(5)
    saved = sim.save()
    reset, restore = shortest(sim.reset, 5), shortest(lambda: sim.restore(saved), 5)
    print(f"{len(sim.positions)} nodes: reset {reset:.0f} us, restore {restore:.0f} us, {len(saved)} bytes")
    assert reset < 5000 and restore < 10_000


def test_import():
    said = python("""
import time, numpy
begun = time.perf_counter()
import sinew_sim
print(time.perf_counter() - begun)
import sys
print(*[name for name in ("scipy", "pyvista", "meshio", "gymnasium", "matplotlib") if name in sys.modules])
""")
    took, others = (said.stdout + "\n").splitlines()[:2]
    print(f"import beside numpy: {1e3 * float(took):.0f} ms")
    assert float(took) < 1.0
    assert others == ""

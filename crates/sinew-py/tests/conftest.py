"""What the tests share: small scenes, the ready ones, and processes beside this one."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import sinew_sim as sn

READY = Path(__file__).resolve().parents[3] / "scenes" / "ready"


def cube(cells=3, duration=0.1, **tables):
    """The values of a linear cube of 0.1 m that stands on its bottom; tables take the place of those here."""
    values = {
        "gravity": [0.0, 0.0, -9.81],
        "mesh": {"cube": {"cells": cells, "edge": 0.1}},
        "region": [{"density": 1000.0, "model": "linear", "youngs_modulus": 5000.0, "poissons_ratio": 0.3}],
        "fixed": [{"group": "bottom"}],
        "damping": {"mass": 5.0},
        "probe": [{"name": "top", "point": [0.1, 0.1, 0.1]}],
        "run": {"duration": duration, "integrator": "central-difference", "dt": 0.001},
    }
    return values | tables


def soft(cells=3, **tables):
    """The cube as tissue of large deformation."""
    region = {"density": 1000.0, "model": "neo-hookean", "youngs_modulus": 5000.0, "poissons_ratio": 0.4}
    run = {"duration": 0.1, "integrator": "central-difference", "dt": "auto"}
    return cube(cells, region=[region]) | {"run": run} | tables


def probed(cells=4, **tables):
    """The soft cube under a ball that is steered."""
    tool = {"name": "ball", "shape": {"sphere": {"radius": 0.03}}, "start": [0.05, 0.05, 0.131], "hold": True}
    return soft(cells, tool=[tool]) | tables


def block_to_cut(**tables):
    """A soft block that may be cut."""
    return soft(**{"mesh": {"block": {"cells": [6, 4, 2], "size": [0.06, 0.04, 0.02]}}, "cutting": {}} | tables)


def oscillator(duration=1.0, **run):
    """A mass on a spring."""
    run = {"duration": duration, "integrator": "central-difference", "dt": 0.01} | run
    return {"oscillator": {"mass": 0.1, "stiffness": 100.0, "damping": 1.0, "velocity": -5.0}, "run": run}


def command(*arguments, cwd=None, timeout=120):
    """`python -m sinew_sim` with these arguments."""
    line = [sys.executable, "-m", "sinew_sim", *map(str, arguments)]
    return subprocess.run(line, cwd=cwd, timeout=timeout, capture_output=True, text=True)


def python(text, *arguments, cwd=None, timeout=120):
    """Another Python that runs a text; conftest is at hand there."""
    path = os.pathsep.join([str(Path(__file__).parent), str(Path(sn.__file__).parents[1])])
    return subprocess.run(
        [sys.executable, "-c", text, *map(str, arguments)],
        cwd=cwd,
        timeout=timeout,
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": path},
    )


@pytest.fixture
def session():
    """A session of a small linear cube."""
    return sn.Scene.from_dict(cube()).session()


@pytest.fixture(scope="session")
def pictures() -> None:
    """Skips what draws in three dimensions where this computer cannot: without a display VTK needs libEGL and Mesa, or
    libOSMesa. It is tried in a process of its own, since VTK ends one in which it fails."""
    pytest.importorskip("pyvista", reason="pyvista is not installed: pip install 'sinew-sim[plot]'")
    draw = "import pyvista as p; q = p.Plotter(off_screen=True); q.add_mesh(p.Sphere()); q.screenshot(None, return_img=True)"
    tried = subprocess.run([sys.executable, "-c", draw], capture_output=True, text=True, timeout=300)
    if tried.returncode != 0:
        pytest.skip("no picture can be drawn without a display: install libegl1 and libgl1-mesa-dri")

"""Soft-tissue dynamics for surgical simulation.

A scene (`Scene`) is run as a whole (`Scene.run`) or step by step (`Scene.session`). Results are arrays of numpy in SI
units: positions, stresses, contact forces, reactions, forces on tools. `sinew_sim.gym` has tasks for learners, `sweep`
runs a scene with many values.

>>> import sinew_sim as sn
>>> scene = sn.Scene.from_dict({
...     "oscillator": {"mass": 0.1, "stiffness": 100.0, "damping": 1.0, "velocity": -5.0},
...     "run": {"duration": 1.0, "integrator": "central-difference", "dt": 0.01}})
>>> scene.run().outcome
'finished'
"""

import os as _os

from ._core import (
    Advanced,
    Diverged,
    Group,
    InternalError,
    Load,
    Matrices,
    Mesh,
    Refused,
    Scene,
    SceneError,
    Session,
    Tool,
    Warning,
    __version__,
    _forked,
)
from ._plan import Plan
from ._result import Frames, Result, open
from ._sweep import Lost, sweep

# A child of a fork has none of its parent's threads.
if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(after_in_child=_forked)

__all__ = [
    "Advanced",
    "Diverged",
    "Frames",
    "Group",
    "InternalError",
    "Load",
    "Lost",
    "Matrices",
    "Mesh",
    "Plan",
    "Refused",
    "Result",
    "Scene",
    "SceneError",
    "Session",
    "Tool",
    "Warning",
    "__version__",
    "open",
    "sweep",
]

"""The task of freeing a layer."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._hand import Floats, Hand
from ._parts import joins
from ._task import Task

#: Heights between which the tissue joins the layer above to that below, at rest (m).
JOIN = (0.003, 0.006)

#: Share of the other tissue that may be burnt.
HARM = 0.05

#: The force on the jaw that is still free (N).
GENTLE = 0.5

#: The distance that costs 1 a control step (m).
FAR = 0.05


class Dissect(Task):
    """A burner takes away the soft tissue that joins a layer to what lies below, while a jaw holds the layer.

    The tissue, 30 x 24 x 12 mm, is held at its bottom: 3 mm with Young's modulus 6 kPa, 3 mm of joining tissue with 2 kPa, and
    the layer, 6 mm with 6 kPa. The burner is a rod along y, 22 mm long with round ends of radius 1.5 mm, which takes away each
    tetrahedron whose middle is inside it, and touches nothing. Pieces that nothing holds are gone, so the jaw, a ball, must
    hold the layer.

    Reward of a control step: -j - 10 h - a / 50 mm - max(0, F / 0.5 N - 1), with the share j of the joining tetrahedra that
    are left, the share h of all other tetrahedra that are gone, the distance a from the jaw to its mark on the layer, and the
    force F on the jaw.

    Success: no path of tetrahedra joins the layer to the bottom, h is at most .05, and the jaw holds tissue, in 10 control
    steps in a row.

    The observation ends with j, h, and the way from the burner to the middle of the nearest joining tetrahedron that is left
    (3, zeros if there is none).
    """

    HANDS = (
        Hand("burner", 0.1, (-0.01, 0.0, 0.0), (0.04, 0.024, 0.03), jaws=False),
        Hand("jaw", 0.1, (0.0, 0.0, 0.0145), (0.03, 0.024, 0.04)),
    )
    MARKS = {"spot": (0.015, 0.012, 0.012), "near": (0.0, 0.012, 0.012), "far": (0.03, 0.012, 0.012)}
    STEPS = 200
    VARIED = {
        "region.1.youngs_modulus": (1000.0, 4000.0),
        "region.2.youngs_modulus": (3000.0, 12000.0),
        "tool.1.start": ((-0.008, 0.008, 0.003), (-0.004, 0.016, 0.008)),
        "tool.2.start": ((0.01, 0.008, 0.018), (0.02, 0.016, 0.026)),
    }
    EXTRA = ("left", "harm", "to_join_x_m", "to_join_y_m", "to_join_z_m")

    def scene_values(self) -> dict[str, Any]:
        tissue = {"density": 1060.0, "model": "neo-hookean", "poissons_ratio": 0.45, "element": "fbar-edge"}
        return {
            "title": "A layer, freed by a burner",
            "gravity": [0.0, 0.0, -9.81],
            "mesh": {"block": {"cells": [10, 8, 4], "size": [0.03, 0.024, 0.012], "split": "kuhn"}},
            "region": [
                {"where": {"box": [[0.0, 0.0, JOIN[0]], [0.03, 0.024, JOIN[1]]]}, "youngs_modulus": 2000.0, **tissue},
                {"where": "rest", "youngs_modulus": 6000.0, **tissue},
            ],
            "damping": {"mass": 20.0},
            "fixed": [{"group": "bottom"}],
            "cutting": {"remove": {"tool": "burner"}, "pieces": "remove"},
            "tool": [
                {
                    "name": "burner",
                    "shape": {"capsule": {"radius": 0.0015, "length": 0.022}, "rotation": [np.pi / 2, 0.0, 0.0]},
                    "start": [-0.005, 0.012, 0.0045],
                    "hold": True,
                },
                {
                    "name": "jaw",
                    "shape": {"sphere": {"radius": 0.005}},
                    "start": [0.015, 0.012, 0.022],
                    "hold": True,
                },
            ],
            "run": {"duration": 3.0, "integrator": "central-difference", "dt": "auto"},
        }

    def begun(self) -> None:
        self._look()
        self._joining, self._other = len(self._joins), self._others

    def evaluate(self) -> tuple[float, bool]:
        if self.sim.topology_epoch != self._epoch:
            self._look()
        left, harm = self.shares()
        approach = float(np.linalg.norm(self.hands.places[1] - self.mark("spot")))
        excess = max(0.0, self.force(1) / GENTLE - 1.0)
        is_met = self._is_free and harm <= HARM and self.holds(1)
        return -left - 10.0 * harm - approach / FAR - excess, is_met

    def shares(self) -> tuple[float, float]:
        """The share of the joining tetrahedra that are left, and that of all others that are gone."""
        return len(self._joins) / self._joining, 1.0 - self._others / self._other

    def extra(self) -> Floats:
        way = np.zeros(3)
        if len(self._joins):
            middles = self.sim.positions[self._joins].mean(axis=1)
            ways = middles - self.hands.places[0]
            way = ways[(ways**2).sum(axis=1).argmin()]
        return np.concatenate([self.shares(), way])

    def _look(self) -> None:
        """Looks at the mesh as it is now."""
        self._epoch = self.sim.topology_epoch
        mesh = self.sim.mesh
        assert mesh is not None
        height = mesh.points[:, 2]
        middles = height[mesh.tets].mean(axis=1)
        is_joining = (middles > JOIN[0]) & (middles < JOIN[1])
        self._joins = mesh.tets[is_joining]
        self._others = int((~is_joining).sum())
        self._is_free = not joins(mesh.tets, np.flatnonzero(height <= 0.0), np.flatnonzero(height >= JOIN[1]))

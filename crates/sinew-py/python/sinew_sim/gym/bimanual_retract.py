"""The task of opening an incision with two jaws."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._hand import Floats, Hand
from ._slit import slit_block
from ._task import Task

#: The incision: its place along x, and half the distance between marks on its lips at the start (m).
MIDDLE = 0.036

#: How far each lip is to move aside (m).
OPENING = 0.006

#: How near each mark must come to its goal (m).
NEAR = 0.002

#: The force on a jaw that is still free (N).
GENTLE = 0.5

#: The distance that costs 1 a control step (m).
FAR = 0.05

#: Places that the jaws seize at rest, and goals of them (m): left, right.
SPOTS = {"left_lip": (MIDDLE - 0.006, 0.024, 0.02), "right_lip": (MIDDLE + 0.006, 0.024, 0.02)}
GOALS = np.array([(MIDDLE - 0.006 - OPENING, 0.024, 0.02), (MIDDLE + 0.006 + OPENING, 0.024, 0.02)])


class BimanualRetract(Task):
    """Two jaws seize the lips of an incision and draw them apart.

    The tissue, 72 x 48 x 20 mm with Young's modulus 4 kPa, is held at its bottom; the incision, 32 mm long and 15 mm deep,
    runs along y in its middle. A mark on each side is 6 mm from the incision. The jaws are rods along y with round ends.

    Reward of a control step: -(a + g) / 50 mm - max(0, F / 0.5 N - 1), with the mean a of the distances of the jaws to their
    marks, the mean g of the distances of the marks to their goals, which are 6 mm further aside, and the larger force F on a
    jaw.

    Success: both marks less than 2 mm from their goals while both jaws hold tissue, in 10 control steps in a row.

    The observation ends with the ways from the marks to their goals (3 each).
    """

    HANDS = (
        Hand("left", 0.1, (0.01, 0.0, 0.0215), (MIDDLE - 0.005, 0.048, 0.05)),
        Hand("right", 0.1, (MIDDLE + 0.005, 0.0, 0.0215), (0.062, 0.048, 0.05)),
    )
    MARKS = SPOTS
    STEPS = 200
    VARIED = {
        "region.1.youngs_modulus": (2000.0, 8000.0),
        "tool.1.start": ((0.016, 0.014, 0.028), (0.03, 0.034, 0.04)),
        "tool.2.start": ((0.042, 0.014, 0.028), (0.056, 0.034, 0.04)),
    }
    EXTRA = tuple(f"{side}_to_goal_{axis}_m" for side in ("left", "right") for axis in "xyz")

    def scene_values(self) -> dict[str, Any]:
        rod = {"capsule": {"radius": 0.005, "length": 0.01}, "rotation": [np.pi / 2, 0.0, 0.0]}
        return {
            "title": "An incision, opened by two jaws",
            "gravity": [0.0, 0.0, -9.81],
            "mesh": slit_block((12, 8, 4), (0.072, 0.048, 0.02), MIDDLE, (0.006, 0.042), 0.005),
            "region": [
                {
                    "density": 1060.0,
                    "model": "neo-hookean",
                    "youngs_modulus": 4000.0,
                    "poissons_ratio": 0.45,
                    "element": "fbar-edge",
                }
            ],
            "damping": {"mass": 20.0},
            "fixed": [{"where": {"below": {"z": 0.0}}}],
            "tool": [
                {"name": "left", "shape": rod, "start": [MIDDLE - 0.006, 0.024, 0.035], "hold": True},
                {"name": "right", "shape": rod, "start": [MIDDLE + 0.006, 0.024, 0.035], "hold": True},
            ],
            "run": {"duration": 2.0, "integrator": "central-difference", "dt": "auto"},
        }

    def goals(self) -> Floats:
        return GOALS

    def evaluate(self) -> tuple[float, bool]:
        marks = np.array([self.mark("left_lip"), self.mark("right_lip")])
        approach = float(np.linalg.norm(self.hands.places - marks, axis=1).mean())
        ways = np.linalg.norm(GOALS - marks, axis=1)
        excess = max(0.0, max(self.force(0), self.force(1)) / GENTLE - 1.0)
        is_met = bool((ways < NEAR).all()) and self.holds(0) and self.holds(1)
        return -(approach + float(ways.mean())) / FAR - excess, is_met

    def extra(self) -> Floats:
        ways: Floats = GOALS - [self.mark("left_lip"), self.mark("right_lip")]
        return ways.ravel()

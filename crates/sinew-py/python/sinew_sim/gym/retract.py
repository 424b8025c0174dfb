"""The task of drawing back a flap."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._hand import Floats, Hand
from ._task import Task

#: Where the mark is to go (m).
GOAL = np.array([0.028, 0.02, 0.03])

#: How near the mark must come (m).
NEAR = 0.004

#: The force on the jaw that is still free (N).
GENTLE = 0.5

#: The distance that costs 1 a control step (m).
FAR = 0.05


class Retract(Task):
    """A flap of tissue is seized near its free end and drawn back, so that its bed lies open.

    The flap, 60 x 40 x 9 mm with Young's modulus 4 kPa, lies on a flat bed under gravity and is held at x = 0. The jaw is a
    rod along y with round ends. The mark is on the flap's upper side, 10 mm from its free end.

    Reward of a control step: -(a + g) / 50 mm - max(0, F / 0.5 N - 1), with the distance a from the jaw to the mark, the
    distance g from the mark to its goal (28, 20, 30) mm, and the force F on the jaw.

    Success: g < 4 mm while the jaw holds tissue, in 10 control steps in a row.

    The observation ends with the way from the mark to the goal (3).
    """

    HANDS = (Hand("jaw", 0.1, (0.0, 0.0, 0.0105), (0.07, 0.04, 0.06)),)
    MARKS = {"mark": (0.05, 0.02, 0.009), "end": (0.06, 0.02, 0.009), "middle": (0.03, 0.02, 0.009)}
    STEPS = 200
    VARIED = {
        "region.1.youngs_modulus": (2000.0, 8000.0),
        "tool.1.start": ((0.035, 0.01, 0.02), (0.065, 0.03, 0.03)),
    }
    EXTRA = ("to_goal_x_m", "to_goal_y_m", "to_goal_z_m")

    def scene_values(self) -> dict[str, Any]:
        return {
            "title": "A flap, drawn back",
            "gravity": [0.0, 0.0, -9.81],
            "mesh": {"block": {"cells": [12, 8, 3], "size": [0.06, 0.04, 0.009], "split": "kuhn"}},
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
            "fixed": [{"where": {"below": {"x": 0.0}}}],
            "tool": [
                {
                    "name": "jaw",
                    "shape": {"capsule": {"radius": 0.005, "length": 0.01}, "rotation": [np.pi / 2, 0.0, 0.0]},
                    "start": [0.05, 0.02, 0.025],
                    "hold": True,
                },
                {"name": "bed", "shape": {"plane": {}}, "start": [0.0, 0.0, 0.0], "hold": True},
            ],
            "run": {"duration": 2.0, "integrator": "central-difference", "dt": "auto"},
        }

    def goals(self) -> Floats:
        return GOAL[None]

    def evaluate(self) -> tuple[float, bool]:
        approach = float(np.linalg.norm(self.hands.places[0] - self.mark("mark")))
        way = float(np.linalg.norm(self.extra()))
        excess = max(0.0, self.force() / GENTLE - 1.0)
        return -(approach + way) / FAR - excess, way < NEAR and self.holds()

    def extra(self) -> Floats:
        way: Floats = GOAL - self.mark("mark")
        return way

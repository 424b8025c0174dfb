"""The task of lifting a loose piece of tissue."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._hand import Floats, Hand
from ._task import Task

#: Where the middle of the piece is to go (m).
GOAL = np.array([0.036, 0.012, 0.026])

#: How near it must come (m).
NEAR = 0.004

#: The force on the jaw that is still free (N).
GENTLE = 0.5

#: The distance that costs 1 a control step (m).
FAR = 0.05


class GraspLift(Task):
    """A loose piece of tissue is seized, lifted from its bed and held in the air.

    The piece, 40 x 24 x 12 mm with Young's modulus 5 kPa, weighs 0.12 N and lies on a flat bed with friction 0.5. The jaw is
    a rod along y with round ends. The mark is in the middle of the piece, the other mark in the middle of its upper side.

    Reward of a control step: -(a + g) / 50 mm - max(0, F / 0.5 N - 1), with the distance a from the jaw to the upper mark,
    the distance g from the middle of the piece to its goal (36, 12, 26) mm, and the force F on the jaw.

    Success: g < 4 mm while the jaw holds tissue, in 10 control steps in a row.

    The observation ends with the way from the middle of the piece to the goal (3).
    """

    HANDS = (Hand("jaw", 0.1, (-0.01, 0.0, 0.0135), (0.06, 0.024, 0.06)),)
    MARKS = {"middle": (0.02, 0.012, 0.006), "top": (0.02, 0.012, 0.012)}
    STEPS = 200
    VARIED = {
        "region.1.youngs_modulus": (2500.0, 10000.0),
        "tool.1.start": ((0.01, 0.004, 0.02), (0.03, 0.02, 0.03)),
    }
    EXTRA = ("to_goal_x_m", "to_goal_y_m", "to_goal_z_m")

    def scene_values(self) -> dict[str, Any]:
        return {
            "title": "A loose piece of tissue, lifted",
            "gravity": [0.0, 0.0, -9.81],
            "mesh": {"block": {"cells": [12, 8, 4], "size": [0.04, 0.024, 0.012], "split": "kuhn"}},
            "region": [
                {
                    "density": 1060.0,
                    "model": "neo-hookean",
                    "youngs_modulus": 5000.0,
                    "poissons_ratio": 0.45,
                    "element": "fbar-edge",
                }
            ],
            "damping": {"mass": 20.0},
            "tool": [
                {
                    "name": "jaw",
                    "shape": {"capsule": {"radius": 0.005, "length": 0.01}, "rotation": [np.pi / 2, 0.0, 0.0]},
                    "start": [0.02, 0.012, 0.025],
                    "hold": True,
                },
                {"name": "bed", "shape": {"plane": {}}, "start": [0.0, 0.0, 0.0], "friction": 0.5, "hold": True},
            ],
            "run": {"duration": 2.0, "integrator": "central-difference", "dt": "auto", "free_flight": True},
        }

    def goals(self) -> Floats:
        return GOAL[None]

    def evaluate(self) -> tuple[float, bool]:
        approach = float(np.linalg.norm(self.hands.places[0] - self.mark("top")))
        way = float(np.linalg.norm(self.extra()))
        excess = max(0.0, self.force() / GENTLE - 1.0)
        return -(approach + way) / FAR - excess, way < NEAR and self.holds()

    def extra(self) -> Floats:
        way: Floats = GOAL - self.mark("middle")
        return way

"""Tools as a learner steers them, and one control step of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import Session, Tool

#: Length of a control step (s).
CONTROL_STEP = 0.01

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Hand:
    """A tool that the actions of a task steer.

    name: its name in the scene.
    speed: the largest speed along each axis (m/s).
    lower, upper: corners of the box (m) that the origin of the tool does not leave.
    jaws: whether it has jaws to open and close.
    """

    name: str
    speed: float
    lower: tuple[float, float, float]
    upper: tuple[float, float, float]
    jaws: bool = True


@dataclass(frozen=True)
class Command:
    """What hands do in one control step: each one's place at its end (m), and whether its jaws are closed."""

    places: Floats
    closed: tuple[bool, ...]


class Hands:
    """The hands of a session: where they are, and whether they are closed."""

    def __init__(self, sim: Session, hands: Sequence[Hand]) -> None:
        self._sim = sim
        self.tools: list[Tool] = [sim.tool(hand.name) for hand in hands]
        self.begin()

    def begin(self) -> None:
        """Takes the places of the tools at the beginning of a motion."""
        self.places: Floats = np.array([tool.position for tool in self.tools])
        self.closed = (False,) * len(self.tools)

    def follow(self, command: Command, steps: int) -> None:
        """Takes a control step, in equal steps of the session, in which tools move in straight lines."""
        for tool, closes, is_closed in zip(self.tools, command.closed, self.closed):
            if closes and not is_closed:
                tool.grasp()
            elif is_closed and not closes:
                tool.release()
        self.closed = command.closed
        way = command.places - self.places
        for step in range(1, steps + 1):
            for tool, place in zip(self.tools, self.places + way * (step / steps)):
                tool.move_to(place)
            self._sim.step()
        self.places = command.places

"""Policies for the tasks: a scripted one for each, and a random one.

A policy is called with an observation and returns an action. It is made for one episode of a task:

>>> import gymnasium, sinew_sim.gym
>>> from sinew_sim.gym import policies
>>> env = gymnasium.make("sinew/Retract-v0")
>>> observation, _ = env.reset(seed=1)
>>> policy = policies.scripted(env.unwrapped)
>>> action = policy(observation)
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ._hand import CONTROL_STEP, Floats
from ._task import Task
from .bimanual_retract import BimanualRetract
from .dissect import Dissect
from .grasp_lift import GraspLift
from .retract import Retract

Policy = Callable[[Floats], NDArray[np.float32]]

#: Share of the way to a goal that a scripted tool goes in a control step.
GAIN = 0.2

#: Speed with which a scripted tool draws tissue (m/s).
GENTLY = 0.06

#: Speed of the scripted burner (m/s).
BURNING = 0.08

#: Speed with which a scripted jaw goes aside (m/s).
QUICKLY = 0.1

#: Speed with which a scripted jaw goes down (m/s).
DOWN = 0.05

#: How near a scripted jaw must be above its mark before it goes down (m).
NEAR = 0.002

#: Force on a jaw (N) from which on it is on the tissue.
TOUCH = 0.03


def random(task: Task, seed: int | None = None) -> Policy:
    """A policy that draws each action anew, alike over the space of actions."""
    task.action_space.seed(seed)
    return lambda observation: task.action_space.sample()


def scripted(task: Task) -> Policy:
    """The scripted policy of a task, for one episode."""
    if isinstance(task, Retract):
        return Scripted(task, [Jaw("jaw", "mark", draw("to_goal"))])
    if isinstance(task, BimanualRetract):
        return Scripted(task, [Jaw(side, f"{side}_lip", draw(f"{side}_to_goal")) for side in ("left", "right")])
    if isinstance(task, GraspLift):
        return Scripted(task, [Jaw("jaw", "top", draw("to_goal"))])
    if isinstance(task, Dissect):
        return Scripted(task, [burn, Jaw("jaw", "spot", raise_layer)])
    raise TypeError(f"task: expected one of the tasks of sinew_sim.gym, got {type(task).__name__}")


class Reading:
    """The entries of an observation by name."""

    def __init__(self, names: tuple[str, ...], observation: Floats) -> None:
        self._values = dict(zip(names, observation))

    def number(self, name: str) -> float:
        return float(self._values[name])

    def vector(self, name: str, unit: str = "m") -> Floats:
        return np.array([self._values[f"{name}_{axis}_{unit}"] for axis in "xyz"])


#: What one hand does: its part of the action.
Part = Callable[[Reading], list[float]]


class Scripted:
    """A policy whose hands follow a part each."""

    def __init__(self, task: Task, parts: list[Part]) -> None:
        self._names = task.names
        self._parts = parts

    def __call__(self, observation: Floats) -> NDArray[np.float32]:
        reading = Reading(self._names, observation)
        return np.array([number for part in self._parts for number in part(reading)], np.float32)


#: Where a jaw that holds is to go, as a way (m), by what is observed and the place where it closed.
Way = Callable[[Reading, Floats], Floats]


def draw(way: str) -> Way:
    """Along a way of the observation, from a mark to its goal."""
    return lambda reading, seized: reading.vector(way)


def raise_layer(reading: Reading, seized: Floats) -> Floats:
    """Up from where the jaw closed, and further when little tissue joins the layer to what lies below."""
    lift = 0.004 + 0.006 * max(0.0, 1.0 - 2.5 * reading.number("left"))
    way: Floats = seized + np.array([0.0, 0.0, lift]) - reading.vector("jaw")
    return way


class Jaw:
    """A jaw that goes above a mark, down until it touches, closes, and goes along a way while it holds."""

    def __init__(self, name: str, mark: str, way: Way) -> None:
        self._name, self._mark, self._way = name, mark, way
        self._seized: Floats | None = None

    def __call__(self, reading: Reading) -> list[float]:
        place = reading.vector(self._name)
        if reading.number(f"{self._name}_holds"):
            if self._seized is None:
                self._seized = place
            return [*_towards(self._way(reading, self._seized), GENTLY), 1.0]
        has_touched = float(np.linalg.norm(reading.vector(f"{self._name}_force", "N"))) > TOUCH
        aside = reading.vector(self._mark) - place
        aside[2] = 0.0
        if has_touched or np.linalg.norm(aside) < NEAR:
            return [*_towards(aside, QUICKLY)[:2], -DOWN, 1.0 if has_touched else -1.0]
        return [*_towards(aside, QUICKLY), -1.0]


def burn(reading: Reading) -> list[float]:
    """The burner waits in the middle of the width until the jaw holds, then goes to the nearest joining tissue that is left."""
    if reading.number("left") == 1.0:
        aside = (reading.vector("spot") - reading.vector("burner")) * (0.0, 1.0, 0.0)
        if not reading.number("jaw_holds") or np.linalg.norm(aside) > NEAR / 4.0:
            return list(_towards(aside, QUICKLY))
    # Less along y: what is left aside is nearest later.
    way = reading.vector("to_join") * (1.0, 0.3, 1.0)
    return list(BURNING * way / max(float(np.linalg.norm(way)), 1e-9))


def _towards(way: Floats, fastest: float) -> Floats:
    """A velocity along a way, slower near its end."""
    velocity = GAIN / CONTROL_STEP * way
    speed = float(np.linalg.norm(velocity))
    return velocity * min(1.0, fastest / speed) if speed > 0.0 else velocity

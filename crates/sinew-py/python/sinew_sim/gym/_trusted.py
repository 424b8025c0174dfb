"""The error of an episode: how far it is from a run with shorter steps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import Diverged, Refused, Scene, Session
from ._hand import CONTROL_STEP, Command, Hand, Hands

#: How many steps the trusted run takes for each one of the episode.
REFINEMENT = 4


def error_of(sim: Session, scene: Scene, hands: Sequence[Hand], commands: Sequence[Command], steps: int) -> float:
    """The relative error of the displacements of a session after some commands.

    The commands are followed once more by a session with steps that are `REFINEMENT` times as short. The result is
    |u - u*| / |u*|, with the displacements u of the session and u* of the trusted run, over all nodes that both have (a cut
    may take away other nodes, or double them); inf where the trusted run does not get to the end.
    """
    finer = steps * REFINEMENT
    trusted = scene.with_values({"run.dt": CONTROL_STEP / finer}).session()
    moved = Hands(trusted, hands)
    try:
        for command in commands:
            moved.follow(command, finer)
    except (Diverged, Refused):
        return float("inf")
    places, own = _places(sim)
    exact_places, exact = _places(trusted)
    _, first, second = np.intersect1d(places, exact_places, return_indices=True)
    size = float(np.linalg.norm(exact[second]))
    difference = float(np.linalg.norm(own[first] - exact[second]))
    return difference / size if size > 0.0 else difference


def _places(sim: Session) -> tuple[NDArray[Any], NDArray[np.float64]]:
    """The places at rest of nodes, each one as one value, and their displacements; without nodes that share a place."""
    assert sim.mesh is not None
    points = np.ascontiguousarray(sim.mesh.points)
    keys = points.view([("x", float), ("y", float), ("z", float)]).ravel()
    found, first, counts = np.unique(keys, return_index=True, return_counts=True)
    single = counts == 1
    return found[single], sim.displacement[first[single]]

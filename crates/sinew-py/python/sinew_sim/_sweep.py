"""Runs of a scene with many values, by any executor."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from typing import Any

from ._core import Scene
from ._result import Result


class Lost:
    """A run of which no result came: outcome is "refused" where the scene cannot be run with these values, and "lost" where
    its process ended; values are those of the run, reason says why."""

    def __init__(self, values: dict[str, Any], outcome: str, reason: str) -> None:
        self.values, self.outcome, self.reason = values, outcome, reason

    def __repr__(self) -> str:
        return f"Lost({self.outcome}, {self.values}: {self.reason})"


def sweep(
    scene: Scene,
    values: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]],
    *,
    executor: Executor | None = None,
    workers: int | None = None,
) -> list[Result | Lost]:
    """Runs a scene once for each set of values, and returns the results in their order.

    values: lists of equal length by key, such as {"region.1.youngs_modulus": [2000.0, 8000.0]}, or a list of dictionaries.
    executor: any of concurrent.futures, such as Client.get_executor() of Dask or MPIPoolExecutor of mpi4py; without one,
    workers processes of this computer, each computing on one thread. Each result has the attribute values. A run of which
    none came is named by a Lost in its place, and the others are kept.
    """
    sets = _sets(values)
    if executor is not None:
        return _collect(executor, scene, sets)
    # A process that is begun anew shares no threads and no locks with this one.
    begun = multiprocessing.get_context("spawn")
    count = workers or len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else workers
    results: list[Result | Lost] = []
    todo = list(enumerate(sets))
    found: dict[int, Result | Lost] = {}
    # A process that is killed takes the pool with it: what is left goes on in another one, the run at fault alone.
    with ProcessPoolExecutor(count, mp_context=begun) as pool:
        for (number, _), result in zip(todo, _collect(pool, scene, sets)):
            found[number] = result
    for number, own in todo:
        result = found[number]
        if isinstance(result, Lost) and result.outcome == "lost":
            with ProcessPoolExecutor(1, mp_context=begun) as pool:
                result = _collect(pool, scene, [own])[0]
        results.append(result)
    return results


def _sets(values: Any) -> list[dict[str, Any]]:
    if isinstance(values, Mapping):
        for key, own in values.items():
            if isinstance(own, str) or not hasattr(own, "__iter__"):
                raise TypeError(f"values[{key!r}]: expected a list of values, one for each run, got {type(own).__name__}")
        lists = {key: list(own) for key, own in values.items()}
        lengths = {key: len(own) for key, own in lists.items()}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"values: lists of different lengths: {lengths}")
        return [dict(zip(lists, own)) for own in zip(*lists.values())]
    if isinstance(values, str) or not hasattr(values, "__iter__"):
        raise TypeError(f"values: expected lists by key, or a list of dictionaries, got {type(values).__name__}")
    sets = list(values)
    for number, own in enumerate(sets):
        if not isinstance(own, Mapping):
            raise TypeError(f"values[{number}]: expected a dictionary of values by key, got {type(own).__name__}")
    return [dict(own) for own in sets]


def _collect(executor: Executor, scene: Scene, sets: list[dict[str, Any]]) -> list[Result | Lost]:
    waiting: list[Any] = []
    for own in sets:
        try:
            waiting.append(executor.submit(_run, scene, own))
        except Exception as error:  # a pool that a killed process broke takes no more
            waiting.append(error)
    results: list[Result | Lost] = []
    for own, future in zip(sets, waiting):
        try:
            if isinstance(future, Exception):
                raise future
            result = future.result()
        except Exception as error:
            result = Lost(own, "lost", f"{type(error).__name__}: {error}")
        results.append(result)
    return results


def _run(scene: Scene, values: dict[str, Any]) -> Result | Lost:
    """A run in a process of an executor. What the scene is at fault for is a value: exceptions may not pickle."""
    try:
        result = scene.with_values(values).run(threads=1)
    except Exception as error:
        return Lost(values, "refused", f"{type(error).__name__}: {error}")
    result.values = values
    return result

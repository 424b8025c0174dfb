"""Random values of keys of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .._core import Scene, SceneError


class Ranges:
    """Ranges from which values of a scene are drawn, alike over each range.

    A range is a pair (lowest, highest) of two numbers, or of two lists of the same length for keys that hold lists, such as
    the start of a tool.
    """

    def __init__(self, ranges: Mapping[str, Any] | None, scene: Scene) -> None:
        self._ranges = {key: _range(key, pair) for key, pair in (ranges or {}).items()}
        for end in (0, 1):
            for key, pair in self._ranges.items():
                checked(scene, {key: _plain(pair[end])}, "randomise")

    def corners(self) -> list[dict[str, Any]]:
        """All keys at their lowest values, and all at their highest."""
        return [{key: _plain(pair[end]) for key, pair in self._ranges.items()} for end in (0, 1)]

    def draw(self, random: np.random.Generator) -> dict[str, Any]:
        """A value for each key."""
        return {key: _plain(random.uniform(low, high)) for key, (low, high) in self._ranges.items()}


def checked(scene: Scene, values: Mapping[str, Any], argument: str) -> Scene:
    """The scene with values set; a ValueError that names the argument and the keys if the scene does not take them."""
    try:
        return scene.with_values(values)
    except SceneError as error:
        raise ValueError(f"{argument}: {', '.join(values)}: {error}") from error


def _plain(value: Any) -> Any:
    return np.asarray(value, float).tolist()


def _range(key: Any, pair: Any) -> tuple[Any, Any]:
    expected = "expected a pair (lowest, highest) of numbers, or of lists of the same length"
    if not isinstance(key, str):
        raise ValueError(f"randomise: {key!r}: expected the key of a scene as text, such as 'region.1.youngs_modulus'")
    try:
        low, high = (np.asarray(end, float) for end in pair)
    except (TypeError, ValueError):
        raise ValueError(f"randomise: {key}: {expected}, got {pair!r}") from None
    if low.shape != high.shape or low.ndim > 1:
        raise ValueError(f"randomise: {key}: {expected}, got {pair!r}")
    if not (np.isfinite(low).all() and np.isfinite(high).all() and (low <= high).all()):
        raise ValueError(f"randomise: {key}: expected finite ends, the lowest first, got {pair!r}")
    return low, high

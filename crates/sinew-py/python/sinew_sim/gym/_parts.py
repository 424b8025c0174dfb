"""Which parts of a mesh hang together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def joins(tets: NDArray[np.uint32], first: NDArray[np.intp], second: NDArray[np.intp]) -> bool:
    """Whether a path of tetrahedra leads from one of the first nodes to one of the second."""
    is_reached = np.zeros(int(tets.max(initial=0)) + 1, bool)
    is_reached[first[first < len(is_reached)]] = True
    goals = second[second < len(is_reached)]
    while not is_reached[goals].any():
        touched = tets[is_reached[tets].any(axis=1)]
        before = np.count_nonzero(is_reached)
        is_reached[touched] = True
        if np.count_nonzero(is_reached) == before:
            return False
    return True

"""Meshes with a slit."""

from __future__ import annotations

import numpy as np

from .._core import Mesh, Scene


def slit_block(
    cells: tuple[int, int, int], size: tuple[float, float, float], x: float, ends: tuple[float, float], floor: float
) -> Mesh:
    """A block of equal cells with a slit at x, between two ends along y, from the top down to a height (m).

    x, ends and floor are on planes of the grid. Nodes in the slit, without those of its rim in the tissue, are there twice:
    the second ones belong to the tetrahedra beyond x.
    """
    block = Scene.from_dict(
        {
            "mesh": {"block": {"cells": list(cells), "size": list(size), "split": "kuhn"}},
            "region": [{"density": 1.0, "model": "linear", "youngs_modulus": 1.0, "poissons_ratio": 0.0}],
            "run": {"duration": 1.0, "integrator": "central-difference", "dt": "auto"},
        }
    ).mesh
    assert block is not None
    points, tets = block.points, block.tets.copy()
    small = 1e-9
    is_inside = (points[:, 1] > ends[0] + small) & (points[:, 1] < ends[1] - small) & (points[:, 2] > floor + small)
    lips = np.flatnonzero((np.abs(points[:, 0] - x) < small) & is_inside)
    twin = np.arange(len(points), dtype=tets.dtype)
    twin[lips] = len(points) + np.arange(len(lips))
    is_beyond = points[tets, 0].mean(axis=1) > x
    tets[is_beyond] = twin[tets[is_beyond]]
    return Mesh(np.concatenate([points, points[lips]]), tets)

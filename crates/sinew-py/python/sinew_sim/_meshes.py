"""Meshes of meshio and pyvista."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _core

_TETRA, _TRIANGLE = 10, 5  # cell types of VTK


def to_mesh(value: Any, name: str) -> _core.Mesh:
    """A mesh of this package, of meshio (with cell sets, or gmsh's physical groups) or a grid of pyvista."""
    if isinstance(value, _core.Mesh):
        return value
    if hasattr(value, "cells_dict") and hasattr(value, "points") and hasattr(value, "cell_sets"):
        return _of_meshio(value)
    if hasattr(value, "celltypes") and hasattr(value, "cells_dict"):
        return _of_pyvista(value)
    kind = type(value).__name__
    files = "" if "." in name else ', or a dictionary such as {"file": "organ.msh"}'
    raise TypeError(f"{name}: expected a Mesh, a meshio.Mesh or a grid of pyvista{files}, got {kind}")


def _of_meshio(mesh: Any) -> _core.Mesh:
    kinds = [block.type for block in mesh.cells]
    other = sorted({kind for kind in kinds if kind not in ("tetra", "triangle", "line", "vertex")})
    if other:
        raise ValueError(f"mesh: cells of the kinds {', '.join(other)}: expected tetrahedra with four nodes (tetra)")
    of_blocks = [np.asarray(block.data) for block in mesh.cells if block.type == "tetra"]
    tets = np.concatenate(of_blocks) if of_blocks else np.zeros((0, 4), int)
    groups: dict[str, Any] = {}
    # Indices of a set count within their block.
    before = np.cumsum([0] + [len(block.data) if block.type == "tetra" else 0 for block in mesh.cells])
    for name, blocks in mesh.cell_sets.items():
        if name.startswith("gmsh:"):
            continue
        members = [None if block is None else np.asarray(block, int) for block in blocks]
        _add(groups, name, mesh, members, before)
    physical = mesh.cell_data.get("gmsh:physical")
    if physical is not None:
        for name, (tag, dim) in mesh.field_data.items():
            dims = {"tetra": 3, "triangle": 2, "line": 1, "vertex": 0}
            members = [
                np.flatnonzero(np.asarray(tags) == tag) if dims[block.type] == dim else None
                for block, tags in zip(mesh.cells, physical)
            ]
            if name not in groups:
                _add(groups, name, mesh, members, before)
    data = {}
    for name, values in mesh.cell_data.items():
        of_tets = [np.asarray(v) for block, v in zip(mesh.cells, values) if block.type == "tetra"]
        if of_tets and not name.startswith("gmsh:"):
            data[name] = np.concatenate(of_tets).astype(float)
    points = np.asarray(mesh.points, float)
    if points.ndim == 2 and points.shape[1] == 2:
        raise ValueError("mesh: points have two coordinates: expected three")
    return _core.Mesh(points, tets, groups, data)


def _add(groups: dict[str, Any], name: str, mesh: Any, members: list[Any], before: Any) -> None:
    """Adds the members of a set: tetrahedra if it has any, else triangles, lines or nodes."""
    parts: dict[str, list[Any]] = {}
    for number, (block, own) in enumerate(zip(mesh.cells, members)):
        if own is None or len(own) == 0:
            continue
        part = before[number] + own if block.type == "tetra" else np.asarray(block.data)[own]
        parts.setdefault(block.type, []).append(part)
    for dim, kind in ((3, "tetra"), (2, "triangle"), (1, "line"), (0, "vertex")):
        if kind in parts:
            found = np.concatenate(parts[kind])
            found = found if dim in (1, 2) else found.reshape(-1)
            groups[name] = _core.Group(dim, found.astype(np.uint32))
            return


def _of_pyvista(grid: Any) -> _core.Mesh:
    cells = {int(kind): np.asarray(members) for kind, members in grid.cells_dict.items()}
    other = sorted(kind for kind in cells if kind not in (_TETRA, _TRIANGLE, 1, 3))
    if other or _TETRA not in cells:
        raise ValueError(f"mesh: cells of VTK's kinds {sorted(cells)}: expected tetrahedra with four nodes (kind 10)")
    is_tet = np.asarray(grid.celltypes) == _TETRA
    data = {}
    for name in grid.cell_data.keys():
        values = np.asarray(grid.cell_data[name])
        if values.dtype.kind in "iuf" and len(values) == len(is_tet):
            data[name] = values[is_tet].astype(float)
    return _core.Mesh(np.asarray(grid.points, float), cells[_TETRA], {}, data)


def to_grid(points: Any, tets: Any, triangles: Any = None) -> Any:
    """Tetrahedra, or the triangles of a surface, as a grid of pyvista."""
    import pyvista

    if len(tets) or triangles is None:
        return pyvista.UnstructuredGrid({_TETRA: np.asarray(tets)}, np.asarray(points))
    return pyvista.UnstructuredGrid({_TRIANGLE: np.asarray(triangles)}, np.asarray(points))

"""Values of Python as those of scenes: without arrays, numbers of numpy, paths and meshes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _core
from ._meshes import to_mesh

#: Name of a mesh in memory, where a scene names a file.
MESH_NAME = "mesh-in-memory"


#: Tables and lists within each other, beyond which they are taken for one that holds itself.
_DEEPEST = 50


def plain(value: Any, path: str = "", depth: int = 0) -> Any:
    """The value as dictionaries, lists, numbers, texts and truth values; `path` names it in messages."""
    if depth > _DEEPEST:
        raise _error(path[:40], f"more than {_DEEPEST} dictionaries or lists within each other: expected a scene's tables")
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        number = int(value)
        if not -(2**63) <= number < 2**63:
            raise _error(path, f"{number}: expected a whole number of at most 64 bits")
        return number
    if isinstance(value, (float, np.floating)):
        return float(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        dot = "." if path else ""
        for key in value:
            if not isinstance(key, str):
                raise _error(path, f"the key {key!r}: expected keys that are texts")
        return {key: plain(item, f"{path}{dot}{key}", depth + 1) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist(), path, depth)
    if isinstance(value, (list, tuple)):
        return [plain(item, f"{path}[{number}]", depth + 1) for number, item in enumerate(value, 1)]
    if value is None:
        raise _error(path, "None: expected a value; leave the key out if there is none")
    kind = type(value).__name__
    raise _error(path, f"{kind}: expected a number, a text, a list, an array or a dictionary of these")


def scene(values: Any) -> tuple[dict[str, Any], _core.Mesh | None]:
    """The plain values of a scene, and the mesh in memory that stands among them."""
    if not isinstance(values, Mapping):
        raise TypeError(f"values: expected a dictionary of the scene's tables, got {type(values).__name__}")
    values = dict(values)
    table = values.get("mesh")
    if table is None and "mesh" not in values:
        return plain(values), None
    mesh = None
    if isinstance(table, Mapping):
        table = dict(table)
        if not isinstance(table.get("file", ""), (str, os.PathLike)):
            mesh = to_mesh(table["file"], "mesh.file")
            table["file"] = MESH_NAME
    elif table is not None:
        mesh = to_mesh(table, "mesh")
        table = {"file": MESH_NAME}
    values["mesh"] = table
    return plain(values), mesh


def _error(path: str, text: str) -> Exception:
    error = _core.SceneError(f"{path or 'the scene'}: {text}")
    for name in ("file", "line", "column", "hint"):
        setattr(error, name, None)
    return error

"""Results of runs: tables and fields as arrays."""

from __future__ import annotations

import json
import os
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._meshes import to_grid

Array = np.ndarray[Any, np.dtype[np.float64]]
_MOTION = "motion"


class Result:
    """A run of a scene. Arrays are float64, times in s.

    outcome: "finished", "diverged", "refused" or "interrupted".
    t: times of the rows of probes and tools, (rows,).
    probes: by the name of each probe, (rows, 3) displacements (m) or velocities (m/s), (rows, 7) stresses (Pa: xx, yy, zz,
        xy, yz, zx, von Mises), (rows,) of an oscillator.
    energy: columns of energy.csv by name, such as "kinetic_J", with its own times "t_s".
    reactions: columns of reactions.csv by the name of each support: {"force_N": (rows, 3), "moment_Nm": (rows, 3)}, and "t_s".
    tools: by the name of each tool, {"position_m": (rows, 3), "force_N": (rows, 3), "torque_Nm": (rows, 3), ..}.
    summary: the object of summary.json.
    warnings: a list of Warning, about the scene and about the motion (of kind "motion"; of a folder that is opened all are).
    frames: fields of a run that has a folder, else None.
    folder: the path of the folder, else None.
    values: what a sweep set in the scene, else None.
    """

    values: dict[str, Any] | None = None

    def __init__(self, folder: str | os.PathLike[str], keeps_folder: bool = True) -> None:
        path = Path(folder).absolute()  # or it would be another one in another working directory
        summary = path / "summary.json"
        if not summary.is_file():
            hint = "its run has not come to an end" if (path / "run.json").is_file() else "no run wrote into it"
            raise FileNotFoundError(f"{path}: {hint}: expected a folder of Scene.run(out=..) or `sinew-sim run --out`")
        self.summary: dict[str, Any] = json.loads(summary.read_text())
        self.outcome: str = self.summary["outcome"]
        rows = _table(path / "probes.csv")
        self.t: Array = rows.pop("t_s")
        self.probes: dict[str, Array] = _probes(rows)
        self.energy: dict[str, Array] = _table(path / "energy.csv")
        self.reactions: dict[str, Any] = _reactions(_table(path / "reactions.csv"))
        self.tools: dict[str, dict[str, Array]] = _tools(_table(path / "tools.csv"))
        self.warnings: list[_core.Warning] = [
            _core.Warning(_MOTION, text, {}) for text in self.summary.get("warnings", [])
        ]
        self.folder: Path | None = path if keeps_folder else None
        has_frames = keeps_folder and (path / "fields.pvd").is_file()
        self.frames: Frames | None = Frames(path) if has_frames else None

    def __repr__(self) -> str:
        last = self.t[-1] if len(self.t) else 0.0
        return f"Result({self.outcome}, t={last} s, {len(self.t)} rows, probes {list(self.probes)})"


class Frames:
    """Fields of a run at the times `times` (s); `frames.frame(i)` reads one, `len(frames)` counts them."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        sets = ElementTree.parse(folder / "fields.pvd").iter("DataSet")
        found = [(float(entry.attrib["timestep"]), entry.attrib["file"]) for entry in sets]
        self.times: Array = np.array([t for t, _ in found])
        self._files = [file for _, file in found]

    def __len__(self) -> int:
        return len(self._files)

    def frame(self, i: int) -> dict[str, Array]:
        """A frame: "points" (n, 3) at rest (m), "tets" (m, 4), "displacement" (n, 3), "velocity" (n, 3), "stress" (m, 6),
        "von_mises" (m,) and what else docs/run-folder.md names; read in single precision."""
        count = len(self._files)
        if not -count <= i < count:
            raise IndexError(f"frame {i}: there are {count}, from 0 to {count - 1}")
        return _core._read_frame(self._folder / self._files[i])

    def __getitem__(self, i: int) -> dict[str, Array]:
        return self.frame(i)

    def __iter__(self) -> Iterator[dict[str, Array]]:
        return (self.frame(i) for i in range(len(self)))

    def to_pyvista(self, i: int = -1) -> Any:
        """A frame as a grid of pyvista, at its deformed places."""
        frame = self.frame(i)
        points, tets, triangles = (frame.pop(name) for name in ("points", "tets", "triangles"))
        grid = to_grid(points + frame["displacement"], tets, triangles)
        for name, values in frame.items():
            if len(values) == len(points):
                grid.point_data[name] = values
            elif len(values) == grid.n_cells:
                grid.cell_data[name] = values
        return grid


def open(folder: str | os.PathLike[str]) -> Result:
    """Reads the folder of a run that `Scene.run(out=..)` or the command left."""
    return Result(folder)


def _of_run(folder: str, keeps_folder: bool, warnings: list[_core.Warning]) -> Result:
    """The result of a run of which the warnings about the scene are known with their kinds."""
    result = Result(folder, keeps_folder)
    known = {warning.text: warning for warning in warnings}
    result.warnings = [known.get(warning.text, warning) for warning in result.warnings]
    return result


def _progress(progress: Any) -> Callable[[float, float], Any] | None:
    """The function that a run tells of its progress."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _line
    if not callable(progress):
        raise TypeError(f"progress: expected a function of time and duration (s), True or None, got {type(progress).__name__}")
    return progress  # type: ignore[no-any-return]


def _line(t: float, duration: float) -> None:
    end = "\n" if t >= duration else ""
    print(f"\rt = {t:.4f} of {duration} s", end=end, file=sys.stderr, flush=True)


def _table(path: Path) -> dict[str, Array]:
    """The columns of a table by name; none of a file that is not there."""
    if not path.is_file():
        return {}
    with path.open(encoding="utf-8") as file:
        header = next(line for line in file if not line.startswith("#"))
        names = header.rstrip("\n").split(",")
        rows = [line.split(",") for line in file if line.strip()]
    values = np.array(rows, dtype=float).reshape(len(rows), len(names))
    return {name: np.ascontiguousarray(values[:, column]) for column, name in enumerate(names)}


_ENDS = {
    "_u_x_m": 0, "_u_y_m": 1, "_u_z_m": 2,
    "_v_x_m_per_s": 0, "_v_y_m_per_s": 1, "_v_z_m_per_s": 2,
    "_s_xx_Pa": 0, "_s_yy_Pa": 1, "_s_zz_Pa": 2, "_s_xy_Pa": 3, "_s_yz_Pa": 4, "_s_zx_Pa": 5, "_s_von_mises_Pa": 6,
    "_u_m": 0,
}  # fmt: skip


def _probes(rows: dict[str, Array]) -> dict[str, Array]:
    columns: dict[str, dict[int, Array]] = {}
    for name, values in rows.items():
        end = next(end for end in _ENDS if name.endswith(end))
        columns.setdefault(name.removesuffix(end), {})[_ENDS[end]] = values
    return {name: own[0] if len(own) == 1 else np.stack([own[i] for i in sorted(own)], axis=1) for name, own in columns.items()}


def _vectors(rows: dict[str, Array], ends: dict[str, tuple[str, str, str]]) -> dict[str, dict[str, Array]]:
    """Columns of vectors by the beginnings of their names."""
    found: dict[str, dict[str, Array]] = {}
    for what, (x, y, z) in ends.items():
        for name in [name for name in rows if name.endswith(x)]:
            own = name.removesuffix(x)
            parts = [rows.get(own + end) for end in (x, y, z)]
            if all(part is not None for part in parts):
                found.setdefault(own, {})[what] = np.stack([part for part in parts if part is not None], axis=1)
    return found


def _reactions(rows: dict[str, Array]) -> dict[str, Any]:
    if not rows:
        return {}
    ends = {"force_N": ("_f_x_N", "_f_y_N", "_f_z_N"), "moment_Nm": ("_m_x_Nm", "_m_y_Nm", "_m_z_Nm")}
    return {"t_s": rows["t_s"], **_vectors(rows, ends)}


def _tools(rows: dict[str, Array]) -> dict[str, dict[str, Array]]:
    ends = {
        "force_N": ("_force_x_N", "_force_y_N", "_force_z_N"),
        "torque_Nm": ("_torque_x_Nm", "_torque_y_Nm", "_torque_z_Nm"),
        "rotation_vector_rad": ("_rx_rad", "_ry_rad", "_rz_rad"),
        "position_m": ("_x_m", "_y_m", "_z_m"),
    }
    tools = _vectors(rows, ends)
    for name in tools:
        for column in ("work_J", "contacts", "gap_m", "passes", "hand_work_J", "energy_J", "residual"):
            if f"{name}_{column}" in rows:
                tools[name][column] = rows[f"{name}_{column}"]
    return tools

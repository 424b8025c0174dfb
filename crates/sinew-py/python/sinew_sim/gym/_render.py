"""Pictures of a session, by pyvista without a screen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray

from .._core import Scene, Session, Tool
from ._hand import Hand

#: Width and height (pixels).
SIZE = (640, 480)

_STEEL, _BED, _BACK = "#b8c4d0", "#d9d4cc", "white"


class Painter:
    """Draws the surface of tissue, coloured by von Mises stress, and the tools."""

    def __init__(self, hands: Sequence[Hand], stress: float) -> None:
        try:
            import pyvista
        except ImportError as missing:
            raise DependencyNotInstalled(
                "render_mode='rgb_array' needs pyvista: pip install 'sinew-sim[plot]'"
            ) from missing
        self._pyvista: Any = pyvista
        self._hands = hands
        self._stress = stress
        self._plotter: Any = None

    def picture(self, scene: Scene, sim: Session) -> NDArray[np.uint8]:
        """The present moment, (height, width, 3)."""
        if self._plotter is None:
            self._plotter = self._begun(scene)
        plotter = self._plotter
        plotter.add_mesh(
            self._tissue(sim),
            scalars="von Mises stress (Pa)",
            clim=(0.0, self._stress),
            cmap="viridis",
            show_edges=True,
            edge_color="#404040",
            line_width=0.5,
            name="tissue",
            scalar_bar_args={"vertical": True, "position_x": 0.87, "position_y": 0.2, "height": 0.6, "color": "black"},
        )
        for table in scene.as_dict()["tool"]:
            tool = sim.tool(table["name"])
            shapes = table.get("shapes", [table["shape"]] if "shape" in table else [])
            for number, shape in enumerate(shapes):
                is_bed = "plane" in shape
                solid = self._solid(shape, scene).transform(_matrix(tool), inplace=False)
                color = _BED if is_bed else _STEEL
                plotter.add_mesh(solid, color=color, smooth_shading=not is_bed, name=f"{table['name']} {number}")
        plotter.render()
        image: NDArray[np.uint8] = np.asarray(plotter.screenshot(return_img=True), np.uint8)
        return image

    def close(self) -> None:
        """Frees what draws."""
        if self._plotter is not None:
            self._plotter.close()
            self._plotter = None

    def _begun(self, scene: Scene) -> Any:
        """A plotter whose camera looks at the body from the front, above and aside."""
        plotter = self._pyvista.Plotter(off_screen=True, window_size=SIZE)
        plotter.set_background(_BACK)
        assert scene.mesh is not None
        points = scene.mesh.points
        low, high = points.min(axis=0), points.max(axis=0)
        middle = (low + high) / 2.0
        middle[2] = high[2]
        size = float(np.linalg.norm(high - low))
        plotter.camera.focal_point = middle
        plotter.camera.position = middle + size * np.array([0.9, -1.6, 1.0])
        plotter.camera.up = (0.0, 0.0, 1.0)
        plotter.camera.clipping_range = (0.01 * size, 10.0 * size)
        return plotter

    def _tissue(self, sim: Session) -> Any:
        assert sim.mesh is not None
        grid = self._pyvista.UnstructuredGrid({self._pyvista.CellType.TETRA: sim.mesh.tets}, sim.positions)
        grid.cell_data["von Mises stress (Pa)"] = sim.von_mises()
        return grid.extract_surface()

    def _solid(self, shape: dict[str, Any], scene: Scene) -> Any:
        """A shape in the frame of its tool."""
        kind = next(kind for kind in ("sphere", "capsule", "plane", "box", "blade") if kind in shape)
        sizes = shape[kind]
        if kind == "sphere":
            solid = self._pyvista.Sphere(radius=sizes["radius"])
        elif kind == "capsule":
            solid = self._pyvista.Capsule(
                radius=sizes["radius"], cylinder_length=sizes["length"], direction=(0.0, 0.0, 1.0), resolution=24
            )
        elif kind == "box":
            solid = self._pyvista.Cube(
                x_length=sizes["size"][0], y_length=sizes["size"][1], z_length=sizes["size"][2]
            )
        elif kind == "blade":
            half = sizes["length"] / 2.0
            solid = self._pyvista.Tube(pointa=(0.0, 0.0, -half), pointb=(0.0, 0.0, half), radius=half / 20.0)
        else:
            assert scene.mesh is not None
            low, high = scene.mesh.points.min(axis=0), scene.mesh.points.max(axis=0)
            middle, size = (low + high) / 2.0, 1.6 * (high - low)
            solid = self._pyvista.Plane(center=(middle[0], middle[1], 0.0), i_size=size[0], j_size=size[1])
        turned = _rigid(shape.get("rotation", [0.0] * 3), shape.get("at", [0.0] * 3))
        return solid.transform(turned, inplace=False)


def _matrix(tool: Tool) -> NDArray[np.float64]:
    return _rigid(tool.rotation_vector, tool.position)


def _rigid(rotation_vector: Any, place: Any) -> NDArray[np.float64]:
    """The matrix (4, 4) of a rotation and a place, by Rodrigues' formula."""
    x, y, z = vector = np.asarray(rotation_vector, float)
    angle = float(np.linalg.norm(vector))
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.eye(4)
    if angle > 0.0:
        matrix[:3, :3] += np.sin(angle) / angle * cross + (1.0 - np.cos(angle)) / angle**2 * cross @ cross
    matrix[:3, 3] = place
    return matrix

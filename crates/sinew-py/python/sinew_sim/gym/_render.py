"""Pictures of a session, by pyvista without a screen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray

from .._core import Scene, Session, Tool
from ._hand import Floats, Hand

#: Width and height (pixels).
SIZE = (640, 480)

_STEEL, _BED, _GOAL, _BACK = "#9fb2c4", "#dfe6ea", "#1b9e4b", "white"

#: Title of the scale of colours.
_STRESS = "von Mises (kPa)"

_BAR = {
    "vertical": True,
    "position_x": 0.84,
    "position_y": 0.25,
    "height": 0.5,
    "width": 0.05,
    "color": "black",
    "fmt": "%.0f",
    "n_labels": 4,
    "title_font_size": 14,
    "label_font_size": 14,
}

#: The faces of a tetrahedron.
_FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]

#: Radius of the ball at a goal, as a share of the size of the body.
_BALL = 0.015


class Painter:
    """Draws the surface of tissue, coloured by von Mises stress, and the tools."""

    def __init__(self, hands: Sequence[Hand], goals: Floats, stress: float) -> None:
        try:
            import pyvista
        except ImportError as missing:
            raise DependencyNotInstalled(
                "render_mode='rgb_array' needs pyvista: pip install 'sinew-sim[plot]'"
            ) from missing
        self._pyvista: Any = pyvista
        self._hands = hands
        self._goals = goals
        self._stress = stress
        self._plotter: Any = None

    def picture(self, scene: Scene, sim: Session) -> NDArray[np.uint8]:
        """The present moment, (height, width, 3)."""
        if self._plotter is None:
            self._plotter = self._begun(scene)
        plotter = self._plotter
        plotter.add_mesh(
            self._tissue(sim),
            scalars=_STRESS,
            clim=(0.0, self._stress / 1e3),
            cmap="YlOrRd",
            show_edges=True,
            edge_color="#805040",
            edge_opacity=0.4,
            ambient=0.25,
            name="tissue",
            scalar_bar_args=_BAR,
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
        """A plotter whose camera sees the body, the starts of hands and the goals, from the front, above and aside."""
        plotter = self._pyvista.Plotter(off_screen=True, window_size=SIZE)
        plotter.set_background(_BACK)
        plotter.enable_anti_aliasing("ssaa")
        assert scene.mesh is not None
        names = [hand.name for hand in self._hands]
        starts = [tool["start"] for tool in scene.as_dict()["tool"] if tool["name"] in names]
        # Tissue that gets to a goal reaches beyond it.
        reach = 0.3 * np.ptp(scene.mesh.points, axis=0)
        points = np.concatenate([scene.mesh.points, starts, self._goals - reach, self._goals + reach])
        low, high = points.min(axis=0), points.max(axis=0)
        size = float(np.linalg.norm(high - low))
        for number, goal in enumerate(self._goals):
            ball = self._pyvista.Sphere(radius=_BALL * size, center=goal)
            plotter.add_mesh(ball, color=_GOAL, name=f"goal {number}")
        middle = (low + high) / 2.0
        plotter.camera.focal_point = middle + size * np.array([0.15, 0.08, 0.0])
        plotter.camera.position = middle + size * np.array([0.95, -1.5, 1.0])
        plotter.camera.up = (0.0, 0.0, 1.0)
        plotter.camera.clipping_range = (0.01 * size, 10.0 * size)
        return plotter

    def _tissue(self, sim: Session) -> Any:
        """The surface: the faces that one tetrahedron alone has, with its stress."""
        assert sim.mesh is not None
        faces = sim.mesh.tets[:, _FACES].reshape(-1, 3)
        _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        outer = first[counts == 1]
        surface = self._pyvista.PolyData.from_regular_faces(sim.positions, faces[outer])
        surface.cell_data[_STRESS] = sim.von_mises()[outer // len(_FACES)] / 1e3
        return surface

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

"""A rigid sphere pressed into a large soft block: force over depth beside Hertz's law.

    python hertz.py            # writes hertz.png where matplotlib is installed
    python hertz.py --quick    # a coarse mesh only, no picture

Hertz (1882): F = 4/3 E/(1 - nu^2) R^(1/2) d^(3/2), for a half-space and a contact that is small beside the sphere.
A quarter of the block is meshed, with symmetric sides. Cells grow by 30 % each beyond the contact.
"""

import argparse
import math

import numpy as np
from numpy.typing import NDArray

import sinew_sim as sn

Floats = NDArray[np.float64]

E, NU, DENSITY = 5000.0, 0.3, 1000.0  # Pa, 1, kg/m3
RADIUS, DEPTH, DURATION = 0.04, 4e-4, 1.0  # m, m, s
CONTACT = math.sqrt(RADIUS * DEPTH)  # radius of the contact at the end (m)


def planes(cells: int, size: float) -> Floats:
    """Distances of planes of nodes from the middle (m): `cells` on the radius of contact, growing ones beyond 1.5 of it."""
    length = CONTACT / cells
    at = [length * number for number in range(math.ceil(1.5 * cells) + 1)]
    while at[-1] < size:
        length *= 1.3
        at.append(at[-1] + length)
    return np.array(at) * size / at[-1]


def block(cells: int, size: float) -> sn.Mesh:
    """A quarter of a block of 2 size x 2 size x size (m), with the contact at the origin."""
    at = planes(cells, size)
    count = len(at) - 1
    even = sn.Scene.from_dict({
        "mesh": {"block": {"cells": [count] * 3, "size": [float(count)] * 3}},
        "region": [{"density": 1.0, "model": "linear", "youngs_modulus": 1.0, "poissons_ratio": 0.3}],
        "run": {"duration": 1.0, "integrator": "central-difference", "dt": 1.0},
    }).mesh  # fmt: skip
    assert even is not None
    number = np.rint(even.points).astype(int)
    return sn.Mesh(np.column_stack([at[number[:, 0]], at[number[:, 1]], -at[count - number[:, 2]]]), even.tets)


def press(cells: int, size: float) -> tuple[Floats, Floats]:
    """Depths (m) and forces (N) of the whole block, as the sphere comes down slowly."""
    scene = sn.Scene.from_dict({
        "mesh": block(cells, size),
        "region": [{"density": DENSITY, "model": "linear", "youngs_modulus": E, "poissons_ratio": NU}],
        "fixed": [
            {"where": {"below": {"z": -0.999 * size}}},
            {"where": {"below": {"x": 0.0}}, "axes": "x"},
            {"where": {"below": {"y": 0.0}}, "axes": "y"},
        ],
        "tool": [{
            "name": "ball",
            "shape": {"sphere": {"radius": RADIUS}},
            "start": [0.0, 0.0, RADIUS],
            "velocity": [0.0, 0.0, -DEPTH / DURATION],
        }],
        "damping": {"mass": 20.0},
        "run": {"duration": DURATION, "integrator": "central-difference", "dt": "auto"},
        "output": {"probes": {"every": DURATION / 40}},
    })  # fmt: skip
    ball = scene.run(threads=1).tools["ball"]
    # A row has the mean force since the row before, so it belongs to the depth in the middle.
    depth = RADIUS - ball["position_m"][:, 2]
    return 0.5 * (depth[1:] + depth[:-1]), 4.0 * ball["force_N"][1:, 2]


def hertz(depth: Floats) -> Floats:
    force: Floats = 4.0 / 3.0 * E / (1.0 - NU**2) * math.sqrt(RADIUS) * depth**1.5
    return force


def plot(curves: dict[str, tuple[Floats, Floats]], path: str) -> None:
    try:
        from matplotlib.figure import Figure
    except ImportError:
        print("no picture: matplotlib is not installed")
        return
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    depth = np.linspace(0.0, DEPTH, 200)
    axes.plot(1e3 * depth, 1e3 * hertz(depth), color="black", label="Hertz: half-space, small contact")
    for (label, (depth, force)), mark in zip(curves.items(), ("o", "s", "^")):
        axes.plot(1e3 * depth, 1e3 * force, mark, markersize=4, label=label)
    axes.set(xlabel="depth (mm)", ylabel="force on the sphere (mN)", xlim=(0.0, None), ylim=(0.0, None))
    axes.set_title("A rigid sphere of 40 mm on a block of 5 kPa")
    axes.legend(frameon=False)
    figure.savefig(path, dpi=150)
    print(f"wrote {path}")


def main() -> None:
    parser = argparse.ArgumentParser(description="Force over depth of a sphere on a soft block, beside Hertz's law.")
    parser.add_argument("--quick", action="store_true", help="a coarse mesh only, and no picture")
    parser.add_argument("--plot", default="hertz.png", help="the picture to write")
    asked = parser.parse_args()
    curves: dict[str, tuple[Floats, Floats]] = {}
    errors: list[float] = []
    for cells, size in [(2, 20)] if asked.quick else [(2, 20), (4, 20), (2, 40)]:
        depth, force = press(cells, size * CONTACT)
        deep = depth > 0.5 * DEPTH
        errors.append(100.0 * float(np.mean(force[deep] / hertz(depth[deep]) - 1.0)))
        label = f"{cells} cells on the contact radius a, block {size} a deep"
        curves[label] = depth, force
        print(f"{label}: {1e3 * force[-1]:.2f} mN at {1e3 * depth[-1]:.3f} mm, {errors[-1]:+.1f} % of Hertz (mean of the deeper half)")
    print("The force is too large, because contact acts at nodes, tetrahedra are stiff, and a block is stiffer than a half-space:")
    if asked.quick:
        print("run without --quick to see how much each of them takes.")
        return
    coarse, fine, deep_block = errors
    print(f"cells half as long take {coarse - fine:.1f} % of it away, a block twice as deep {coarse - deep_block:.1f} %.")
    plot(curves, asked.plot)


if __name__ == "__main__":
    main()

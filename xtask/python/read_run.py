"""Reads the folder of a run with meshio and pyvista and compares its fields with its table of probes.

Usage: read_run.py FOLDER. Prints the number of frames and the largest relative difference.
"""

import csv
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import meshio
import numpy
import pyvista

SINGLE = 1e-6
"""Rounding of single precision, with some room."""


def rows(path):
    """The place of the first probe (m), and the rows of a table with comments."""
    lines = path.read_text().splitlines()
    comment = lines[0].split(" at ")[1].split(" m,")[0]
    table = csv.DictReader(line for line in lines if not line.startswith("#"))
    return [float(x) for x in comment.split()], list(table)


def main(folder):
    place, probes = rows(folder / "probes.csv")
    times = [float(row["t_s"]) for row in probes]
    series = xml.parse(folder / "fields.pvd").getroot().iter("DataSet")
    reader = pyvista.get_reader(str(folder / "fields.pvd"))
    frames, largest = 0, 0.0
    size = max(abs(float(row["top_u_z_m"])) for row in probes)
    for number, entry in enumerate(series):
        time = float(entry.get("timestep"))
        row = probes[int(numpy.argmin([abs(t - time) for t in times]))]
        assert abs(float(row["t_s"]) - time) < 1e-12, (row["t_s"], time)
        expected = numpy.array([float(row[f"top_u_{axis}_m"]) for axis in "xyz"])
        grid = meshio.read(folder / entry.get("file"))
        node = int(numpy.argmin(numpy.linalg.norm(grid.points - place, axis=1)))
        assert numpy.linalg.norm(grid.points[node] - place) == 0.0
        reader.set_active_time_point(number)
        (shown,) = reader.read()
        names = {"displacement", "velocity", "acceleration"}
        assert names <= set(grid.point_data) and names <= set(shown.point_data.keys())
        cells = {"region", "inverted", "strain", "von_mises", "stress", "step_limit"}
        assert cells <= set(grid.cell_data) and cells <= set(shown.cell_data.keys())
        assert (grid.points == shown.points).all()
        for name in names:
            assert (grid.point_data[name] == shown.point_data[name]).all(), name
        for name in cells:
            read = numpy.concatenate(grid.cell_data[name])
            # meshio gives single numbers a second axis of length 1.
            assert (read.reshape(shown.cell_data[name].shape) == shown.cell_data[name]).all(), name
        difference = abs(grid.point_data["displacement"][node] - expected).max() / size
        largest, frames = max(largest, float(difference)), frames + 1
    assert frames == 6 and largest <= SINGLE, (frames, largest)
    surface = meshio.read(folder / "surface.vtu")
    assert surface.cell_data["top"][0].sum() == 32, "two triangles on each of sixteen squares"
    print(f"{frames} frames, off by at most {largest:.1e} of the probe's largest displacement")


main(Path(sys.argv[1]))

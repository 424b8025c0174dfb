"""What meshio and pyvista read from the files that `cargo xtask compare` wrote.

    python read_meshes.py DIRECTORY

Prints a line for each file and each array: a label, then the numbers.
"""

import sys

import meshio
import meshio.gmsh._gmsh22 as gmsh22
import numpy as np
import pyvista


def show(label, values):
    print(label, " ".join(repr(float(x)) for x in np.asarray(values).ravel()))


def dump(mesh, groups):
    show("points", mesh.points)
    for kind in ["triangle", "tetra"]:
        show(kind, mesh.cells_dict[kind])
        for name in ["gmsh:physical", "energy"]:
            show(kind + " " + name, mesh.cell_data_dict[name][kind])
    for name in ["temperature", "displacement"]:
        show(name, mesh.point_data[name])
    if groups:
        for name in sorted(mesh.field_data):
            show("group " + name, mesh.field_data[name])


def dump_pyvista(grid):
    show("points", grid.points)
    for kind, number in {"triangle": 5, "tetra": 10}.items():
        show(kind, grid.cells_dict[number])
        for name in ["gmsh:physical", "energy"]:
            show(kind + " " + name, grid.cell_data[name][grid.celltypes == number])
    for name in ["temperature", "displacement"]:
        show(name, grid.point_data[name])


# meshio splits the data of version 2.2 by the wrong lengths; this mends it.
split = gmsh22.cell_data_from_raw
gmsh22.cell_data_from_raw = lambda cells, raw: split([meshio.CellBlock(t, d) for t, d in cells], raw)

directory = sys.argv[1]
for file in ["22-text.msh", "22-binary.msh", "41-text.msh", "41-binary.msh"]:
    print("file", file)
    dump(meshio.gmsh.read(directory + "/" + file), True)
for file in ["raw.vtu", "compressed.vtu", "base64.vtu"]:
    print("file", file)
    dump(meshio.read(directory + "/" + file), False)
    print("file", file, "pyvista")
    dump_pyvista(pyvista.read(directory + "/" + file))
for file in ["overlapping-text.msh", "overlapping-binary.msh"]:
    print("file", file)
    mesh = meshio.gmsh.read(directory + "/" + file)
    first = np.cumsum([0] + [len(block.data) for block in mesh.cells])
    for name in sorted(set(mesh.cell_sets) - {"gmsh:bounding_entities"}):
        show("set " + name, np.concatenate([start + cells for start, cells in zip(first, mesh.cell_sets[name])]))
print("file overlapping.vtu")
grid = pyvista.read(directory + "/overlapping.vtu")
for name in sorted(name for name in grid.cell_data.keys() if name.startswith("group ")):
    show("set " + name.removeprefix("group "), np.flatnonzero(grid.cell_data[name]))
print("file grid.vtu")
grid = pyvista.read(directory + "/grid.vtu")
show("points", grid.points)
show("tetra", grid.cells_dict[10])
show("node", grid.point_data["node"])
show("region", grid.cell_data["region"])
print(grid.point_data["node"].dtype, grid.cell_data["region"].dtype)
reader = pyvista.get_reader(directory + "/series.pvd")
print("times", reader.time_values)
reader.set_active_time_value(0.5)
print("cells", reader.read()[0].n_cells)

#!/usr/bin/env python3
"""Writes the meshes of other formats that the tests of sinew-mesh read.

VTK (pip, 9.7) and meshio (pip, 5.3.5) write one small mesh in each encoding into crates/sinew-mesh/tests/data/formats, where the
tests state by hand what it holds. `cae.inp` and `flat.inp` beside them are written by hand. Run it from anywhere:

    python3 meshes/formats.py
"""

import os
from pathlib import Path

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
TETRAHEDRA = [[0, 1, 2, 3], [1, 2, 3, 4]]
TRIANGLES = [[0, 2, 1]]
LABELS = np.array([1, 2, 7], np.int32)
YOUNG = np.array([1000, 2500.5, 0.5])
FIBRES = np.array([[1, 0, 0], [0, 0.5, 0], [0, 0, -2]], np.float32)
IDS = np.array([1, 1, 2, 2, 3], np.uint8)


def grid():
    grid = vtk.vtkUnstructuredGrid()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(POINTS, deep=1))
    grid.SetPoints(points)
    for row in TETRAHEDRA:
        grid.InsertNextCell(vtk.VTK_TETRA, 4, row)
    for row in TRIANGLES:
        grid.InsertNextCell(vtk.VTK_TRIANGLE, 3, row)
    for name, values, data in [
        ("labels", LABELS, grid.GetCellData()),
        ("young", YOUNG, grid.GetCellData()),
        ("fibre axis", FIBRES, grid.GetCellData()),
        ("ids", IDS, grid.GetPointData()),
    ]:
        array = numpy_to_vtk(values, deep=1)
        array.SetName(name)
        data.AddArray(array)
    return grid


def write_vtu(name, mode, compressor, header_bits, order, id_bits=64):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid())
    writer.SetFileName(name)
    {"text": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary}.get(mode, writer.SetDataModeToAppended)()
    writer.SetEncodeAppendedData(mode == "base64")
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    getattr(writer, f"SetHeaderTypeToUInt{header_bits}")()
    getattr(writer, f"SetByteOrderTo{order}Endian")()
    getattr(writer, f"SetIdTypeToInt{id_bits}")()
    writer.Write()


def write_vtk(name, version, is_binary):
    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetInputData(grid())
    writer.SetFileName(name)
    writer.SetFileVersion(version)
    writer.SetFileType(vtk.VTK_BINARY if is_binary else vtk.VTK_ASCII)
    writer.Write()


def in_blocks(values):
    return [values[:2], values[2:]]


def write_by_meshio():
    cells = [("tetra", TETRAHEDRA), ("triangle", TRIANGLES)]
    data = {"labels": in_blocks(LABELS), "young": in_blocks(YOUNG), "fibre axis": in_blocks(FIBRES)}
    mesh = meshio.Mesh(POINTS, cells, point_data={"ids": IDS}, cell_data=data)
    meshio.vtu.write("meshio-ascii.vtu", mesh, binary=False)
    meshio.vtu.write("meshio-zlib.vtu", mesh, compression="zlib")
    references = {"medit:ref": in_blocks(LABELS.astype(int))}
    points = {"medit:ref": IDS.astype(int)}
    meshio.write("meshio.mesh", meshio.Mesh(POINTS, cells, point_data=points, cell_data=references))


def main():
    os.chdir(Path(__file__).parents[1] / "crates/sinew-mesh/tests/data/formats")
    write_vtu("vtk-ascii.vtu", "text", "ZLib", 32, "Little")
    write_vtu("vtk-binary-big.vtu", "binary", "None", 32, "Big")
    write_vtu("vtk-binary-zlib.vtu", "binary", "ZLib", 64, "Little", 32)
    write_vtu("vtk-raw.vtu", "raw", "None", 64, "Little")
    write_vtu("vtk-raw-zlib-big.vtu", "raw", "ZLib", 32, "Big")
    write_vtu("vtk-base64-zlib.vtu", "base64", "ZLib", 64, "Little")
    write_vtu("vtk-base64.vtu", "base64", "None", 32, "Little", 32)
    write_vtu("vtk-raw-lz4.vtu", "raw", "LZ4", 32, "Little")
    for version in [42, 51]:
        for is_binary in [False, True]:
            encoding = "bytes" if is_binary else "text"
            write_vtk(f"vtk-{version // 10}.{version % 10}-{encoding}.vtk", version, is_binary)
    write_by_meshio()


main()

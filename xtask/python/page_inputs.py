"""Writes what the reader of docs/to-a-scene.md has: a surface, images of labels and a mesh of hexahedra.

Also one small mesh in each format whose extension is given, by meshio, as `formats/EXTENSION/body.lb8.EXTENSION`.
"""

import pathlib
import sys

import gmsh
import meshio
import numpy as np
import pyvista as pv
import SimpleITK as sitk


def write_surface():
    pv.Cylinder(radius=30, height=50, direction=(0, 0, 1), resolution=40).triangulate().save("skin.stl")


def write_images():
    """A cylinder of label 1 with a smaller one of label 2 in it, in millimetres, with axes that are not those of the scanner."""
    z, y, x = np.mgrid[:24, :26, :26]
    radius = np.hypot(x - 12.5, y - 12.5)
    labels = np.zeros(z.shape, np.uint8)
    labels[(radius < 12) & (z < 20)] = 1
    labels[(radius < 5) & (z > 5) & (z < 15)] = 2
    image = sitk.GetImageFromArray(labels)
    image.SetSpacing((1.5, 1.5, 2))
    image.SetOrigin((20, 20, 10))
    image.SetDirection((-1, 0, 0, 0, -1, 0, 0, 0, 1))
    for extension in ("nii.gz", "nrrd", "mha"):
        sitk.WriteImage(image, "labels." + extension)


def write_bricks():
    """Hexahedra with a group of quadrilaterals on the whole surface."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    geo = gmsh.model.geo
    corners = [geo.addPoint(*xy, 0) for xy in ((0, 0), (0.1, 0), (0.13, 0.1), (0, 0.1))]
    sides = [geo.addLine(one, two) for one, two in zip(corners, corners[1:] + corners[:1])]
    base = geo.addPlaneSurface([geo.addCurveLoop(sides)])
    for side in sides:
        geo.mesh.setTransfiniteCurve(side, 5)
    geo.mesh.setTransfiniteSurface(base)
    geo.mesh.setRecombine(2, base)
    geo.extrude([(2, base)], 0, 0, 0.1, [3], recombine=True)
    geo.synchronize()
    for dim, name in ((3, "tissue"), (2, "skin")):
        gmsh.model.addPhysicalGroup(dim, [tag for _, tag in gmsh.model.getEntities(dim)], name=name)
    gmsh.model.mesh.generate(3)
    gmsh.write("bricks.msh")


def write_formats(extensions):
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]
    mesh = meshio.Mesh(np.array(points, float), [("tetra", [[0, 1, 2, 3], [1, 2, 3, 4]])])
    for extension in extensions:
        folder = pathlib.Path("formats") / extension
        folder.mkdir(parents=True)
        # `lb8` tells meshio that a .ugrid file has bytes; with NumPy 2 it cannot read the text that it writes.
        meshio.write(folder / f"body.lb8.{extension}", mesh)
    # The format that meshio takes for this name is that of Fluent.
    meshio.write("formats/fluent.msh", mesh)


write_surface()
write_images()
write_bricks()
write_formats(sys.argv[1:])

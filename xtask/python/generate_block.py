"""Writes a block that gmsh meshes with tetrahedra of one size: `python generate_block.py FILE`.

100 x 80 x 60 mm with a hole, about 50,000 tetrahedra; groups "tissue", "bottom", "top".
"""

import sys

import gmsh

WIDTH, DEPTH, HEIGHT = 0.1, 0.08, 0.06
RADIUS = 0.015
SIZE = 0.00345  # m, of an edge

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("General.NumThreads", 1)
block = (3, gmsh.model.occ.addBox(0, 0, 0, WIDTH, DEPTH, HEIGHT))
hole = (3, gmsh.model.occ.addCylinder(0.5 * WIDTH, 0, 0.5 * HEIGHT, 0, DEPTH, 0, RADIUS))
[tissue], _ = gmsh.model.occ.cut([block], [hole])
gmsh.model.occ.synchronize()
faces = gmsh.model.getBoundary([tissue], combined=True, oriented=False)


def flat_at(height):
    bounds = {face: gmsh.model.getBoundingBox(*face) for face in faces}
    return [face[1] for face, box in bounds.items() if abs(box[2] - height) < 1e-5 and abs(box[5] - height) < 1e-5]


gmsh.model.addPhysicalGroup(3, [tissue[1]], 1, "tissue")
gmsh.model.addPhysicalGroup(2, flat_at(0.0), 2, "bottom")
gmsh.model.addPhysicalGroup(2, flat_at(HEIGHT), 3, "top")
gmsh.option.setNumber("Mesh.MeshSizeMin", SIZE)
gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE)
gmsh.model.mesh.generate(3)
gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
gmsh.write(sys.argv[1])
gmsh.finalize()

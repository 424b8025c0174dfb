#!/usr/bin/env python3
"""Makes the meshes of this directory with gmsh (pip install gmsh; 4.15 was used) and lists them in README.md.

    python3 meshes/generate.py            # from anywhere; the same gmsh gives the same meshes

All lengths are metres. Files are version 4.1, binary, except the paper's cubes, which are text to be read by people.
`paper-cube.msh` is not made here, only listed.
"""

import math
import os
import re
import tempfile
from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np

HERE = Path(__file__).resolve().parent
MEGABYTE = 1_000_000
ROWS = []


@contextmanager
def model(name):
    gmsh.initialize(["gmsh"], readConfigFiles=False)
    try:
        for option, value in {
            "General.Verbosity": 1,
            "General.NumThreads": 1,
            "Mesh.MshFileVersion": 4.1,
            "Mesh.Binary": 1,
            "Mesh.RandomSeed": 1,
            "Mesh.Algorithm3D": 1,
        }.items():
            gmsh.option.setNumber(option, value)
        gmsh.model.add(name)
        yield
    finally:
        gmsh.finalize()


def sizes(least, greatest):
    gmsh.option.setNumber("Mesh.MeshSizeMin", least)
    gmsh.option.setNumber("Mesh.MeshSizeMax", greatest)


def group(dim, entities, name):
    gmsh.model.addPhysicalGroup(dim, entities, name=name)


def surfaces(where):
    """Surfaces whose box (six numbers) satisfies a condition."""
    found = [tag for _, tag in gmsh.model.getEntities(2) if where(gmsh.model.getBoundingBox(2, tag))]
    assert found
    return found


def near(a, b):
    return abs(a - b) < 1e-6


def tetrahedra():
    tags, points, _ = gmsh.model.mesh.getNodes()
    index = {int(tag): i for i, tag in enumerate(tags)}
    _, nodes = gmsh.model.mesh.getElementsByType(4)
    nodes = np.array([index[int(tag)] for tag in nodes]).reshape(-1, 4)
    return points.reshape(-1, 3), nodes


def worst_dihedral(points, tets):
    """The least angle between two faces of a tetrahedron, in degrees."""
    p = points[tets]
    least = 180.0
    for a, b, c, d in [(0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)]:
        edge = p[:, b] - p[:, a]
        n = np.cross(edge, p[:, c] - p[:, a])
        m = np.cross(edge, p[:, d] - p[:, a])
        sine = np.linalg.norm(np.cross(n, m), axis=1)
        least = min(least, np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", n, m))).min())
    return least


def edge_ratio(points, tets):
    p = points[tets]
    lengths = [np.linalg.norm(p[:, i] - p[:, j], axis=1) for i in range(4) for j in range(i)]
    return np.max(lengths) / np.min(lengths)


def save(name, purpose, text=False):
    gmsh.option.setNumber("Mesh.Binary", 0 if text else 1)
    path = HERE / f"{name}.msh"
    gmsh.write(str(path))
    points, tets = tetrahedra()
    record(name, path, points, tets, purpose)


def record(name, path, points, tets, purpose):
    p = points[tets]
    volumes = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0]) / 6
    assert (volumes > 0).all(), f"{name}: inverted tetrahedra"
    size = path.stat().st_size
    assert size < MEGABYTE, f"{name}: {size} bytes"
    names = [gmsh.model.getPhysicalName(*g) for g in gmsh.model.getPhysicalGroups()]
    ROWS.append(
        f"| `{name}.msh` | {len(points)} | {len(tets)} | {worst_dihedral(points, tets):.3g}° | "
        f"{edge_ratio(points, tets):.3g} | {size / 1000:.0f} | {', '.join(f'`{n}`' for n in names)} | {purpose} |"
    )
    print(ROWS[-1])


def discrete(points, blocks):
    """A model of nothing but a mesh: blocks are (dim, gmsh type, rows from 0, name)."""
    volume = gmsh.model.addDiscreteEntity(3)
    gmsh.model.mesh.addNodes(3, volume, list(range(1, len(points) + 1)), np.asarray(points, float).ravel())
    next_tag = 1
    for dim, kind, rows, name in blocks:
        entity = volume if dim == 3 and next_tag == 1 else gmsh.model.addDiscreteEntity(dim)
        tags = list(range(next_tag, next_tag + len(rows)))
        gmsh.model.mesh.addElementsByType(entity, kind, tags, (np.asarray(rows) + 1).ravel())
        next_tag += len(rows)
        group(dim, [entity], name)


def cube(cells, edge, mirrored):
    """The structured cube of the paper: six tetrahedra about a diagonal of each hexahedron."""
    n = cells + 1
    axis = np.array([i * edge / cells for i in range(n)])
    points = [[axis[i], axis[j], axis[k]] for k in range(n) for j in range(n) for i in range(n)]
    paths = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]
    tets = []
    for k in range(cells):
        for j in range(cells):
            for i in range(cells):
                flip = [mirrored and x % 2 == 1 for x in (i, j, k)]
                for number, path in enumerate(paths):
                    steps = [False] * 3
                    row = []
                    for axis_ in [None, *path]:
                        if axis_ is not None:
                            steps[axis_] = True
                        at = [c + (s != f) for c, s, f in zip((i, j, k), steps, flip)]
                        row.append(at[0] + n * (at[1] + n * at[2]))
                    if (number >= 3) != (sum(flip) % 2 == 1):
                        row[1], row[2] = row[2], row[1]
                    tets.append(row)
    return np.array(points), np.array(tets)


def boundary(tets):
    """Faces of one tetrahedron only, turned outwards."""
    faces = {}
    for a, b, c, d in tets:
        for face in [(b, c, d), (a, d, c), (a, b, d), (a, c, b)]:
            faces.setdefault(tuple(sorted(face)), []).append(face)
    return np.array([found[0] for found in faces.values() if len(found) == 1])


def paper_cube(name, mirrored, purpose):
    with model(name):
        points, tets = cube(10, 0.2, mirrored)
        faces = boundary(tets)
        on = lambda axis, value: (np.abs(points[faces][:, :, axis] - value) < 1e-9).all(axis=1)
        sides = on(0, 0) | on(0, 0.2) | on(1, 0) | on(1, 0.2)
        discrete(
            points,
            [
                (3, 4, tets, "tissue"),
                (2, 2, faces[sides], "sides"),
                (2, 2, faces[on(2, 0.2)], "top"),
                (2, 2, faces[on(2, 0)], "bottom"),
            ],
        )
        save(name, purpose, text=True)


def kept(name, purpose):
    """A mesh that is there already: `sinew_mesh::structured` made it, and it is only listed."""
    with model(name):
        path = HERE / f"{name}.msh"
        gmsh.merge(str(path))
        points, tets = tetrahedra()
        record(name, path, points, tets, purpose)


def beam():
    with model("beam"):
        box = gmsh.model.occ.addBox(0, 0, 0, 0.2, 0.01, 0.01)
        gmsh.model.occ.synchronize()
        sizes(0.004, 0.004)
        group(3, [box], "beam")
        group(2, surfaces(lambda b: near(b[3], 0)), "clamped")
        group(2, surfaces(lambda b: near(b[0], 0.2)), "tip")
        gmsh.model.mesh.generate(3)
        save("beam", "a slender beam, 20 : 1 : 1: bending, locking, cantilever formulas")


def vessel():
    with model("vessel"):
        occ = gmsh.model.occ
        outer = occ.addCylinder(0, 0, 0, 0, 0, 0.03, 0.003)
        inner = occ.addCylinder(0, 0, 0, 0, 0, 0.03, 0.0025)
        wall, _ = occ.cut([(3, outer)], [(3, inner)])
        occ.synchronize()
        sizes(0.0006, 0.0006)
        group(3, [tag for _, tag in wall], "wall")
        tube = lambda radius: surfaces(lambda b: near(b[3], radius) and near(b[5] - b[2], 0.03))
        group(2, tube(0.003), "outside")
        group(2, tube(0.0025), "lumen")
        group(2, surfaces(lambda b: near(b[5], 0) or near(b[2], 0.03)), "ends")
        gmsh.model.mesh.generate(3)
        save("vessel", "a thin tube wall, 0.5 mm on 6 mm: pressure in the lumen, one or two tetrahedra through the wall")


def organ():
    with model("organ"):
        occ = gmsh.model.occ
        main = occ.addSphere(0, 0, 0, 0.05)
        occ.dilate([(3, main)], 0, 0, 0, 1.4, 1.0, 0.7)
        lobe = occ.addSphere(0.045, 0.02, 0.01, 0.03)
        body, _ = occ.fuse([(3, main)], [(3, lobe)])
        tumour = occ.addSphere(-0.02, 0.005, 0.005, 0.012)
        _, parts = occ.fragment(body, [(3, tumour)])
        occ.synchronize()
        inside = [tag for _, tag in parts[1]]
        outside = [tag for _, tag in gmsh.model.getEntities(3) if tag not in inside]
        group(3, outside, "parenchyma")
        group(3, inside, "tumour")
        skin = gmsh.model.getBoundary([(3, tag) for tag in outside + inside], oriented=False)
        group(2, [tag for _, tag in skin], "capsule")
        sizes(0.004, 0.009)
        gmsh.model.mesh.generate(3)
        save("organ", "an organ-like blob with an embedded stiff inclusion: two materials, no flat face")


def slab():
    with model("slab"):
        occ = gmsh.model.occ
        layers, z = [("muscle", 0.02), ("fat", 0.01), ("skin", 0.002)], 0.0
        boxes = []
        for _, thickness in layers:
            boxes.append((3, occ.addBox(0, 0, z, 0.08, 0.08, thickness)))
            z += thickness
        occ.fragment(boxes, [])
        occ.synchronize()
        for (name, _), (_, tag) in zip(layers, boxes):
            group(3, [tag], name)
        group(2, surfaces(lambda b: near(b[5], 0)), "bottom")
        group(2, surfaces(lambda b: near(b[2], z)), "top")
        sides = surfaces(
            lambda b: near(b[3], 0) or near(b[0], 0.08) or near(b[4], 0) or near(b[1], 0.08)
        )
        group(2, sides, "sides")
        sizes(0.003, 0.007)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
        skin = boxes[2][1]
        around = gmsh.model.getBoundary([(3, skin)], oriented=False, recursive=True)
        gmsh.model.mesh.setSize([e for e in around if e[0] == 0], 0.003)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.optimize("Netgen")
        save("slab", "skin, fat and muscle in layers of 2, 10 and 20 mm: contrasts of stiffness, thin layers")


def slivers():
    with model("slivers"):
        points, tets = cube(6, 0.06, True)
        rng = np.random.default_rng(5)
        faces = boundary(tets)
        inner = np.setdiff1d(np.arange(len(points)), np.unique(faces))
        # Move inner nodes nearly into the plane of an opposite face, never through it.
        owners = {}
        for number, row in enumerate(tets):
            for node in row:
                owners.setdefault(node, []).append(number)

        def volumes(rows):
            p = points[tets[rows]]
            return np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0])

        for node in rng.permutation(inner)[:40]:
            rows = owners[node]
            number = rows[rng.integers(len(rows))]
            others = [n for n in tets[number] if n != node]
            a, b, c = points[others]
            normal = np.cross(b - a, c - a)
            normal /= np.linalg.norm(normal)
            height = np.dot(points[node] - a, normal)
            start = points[node].copy()
            points[node] = start - normal * height * (1 - 1e-3)
            around = points[np.unique(tets[rows])]
            distances = np.linalg.norm(around - points[node], axis=1)
            # Flat, not small: the edges keep their length.
            if (volumes(rows) <= 0).any() or (np.sort(distances)[1] < 0.004):
                points[node] = start
        discrete(points, [(3, 4, tets, "tissue"), (2, 2, faces, "surface")])
        save("slivers", "a block with slivers, dihedral angles below 0.1 degrees: stable steps, conditioning, the mesh check")


def needle():
    with model("needle"):
        occ = gmsh.model.occ
        block = occ.addBox(-0.03, -0.03, 0, 0.06, 0.06, 0.05)
        track = occ.addCylinder(0, 0, 0.01, 0, 0, 0.04, 0.0004)
        occ.cut([(3, block)], [(3, track)])
        occ.synchronize()
        volume = [tag for _, tag in gmsh.model.getEntities(3)]
        wall = surfaces(lambda b: b[3] - b[0] < 0.001 and b[4] - b[1] < 0.001)
        group(3, volume, "tissue")
        group(2, wall, "track")
        group(2, surfaces(lambda b: near(b[5], 0)), "bottom")
        field = gmsh.model.mesh.field
        distance = field.add("Distance")
        field.setNumbers(distance, "SurfacesList", wall)
        field.setNumber(distance, "Sampling", 60)
        threshold = field.add("Threshold")
        for option, value in {
            "InField": distance,
            "SizeMin": 0.0005,
            "SizeMax": 0.011,
            "DistMin": 0.0,
            "DistMax": 0.022,
        }.items():
            field.setNumber(threshold, option, value)
        field.setAsBackgroundMesh(threshold)
        for option in ["MeshSizeFromPoints", "MeshSizeFromCurvature", "MeshSizeExtendFromBoundary"]:
            gmsh.option.setNumber(f"Mesh.{option}", 0)
        gmsh.model.mesh.generate(3)
        save("needle", "a block round a needle track 0.8 mm thin: many scales, a few elements set the stable step")


def incision():
    with model("incision"):
        cells = [16, 10, 6]
        points, tets = [], []
        n = [c + 1 for c in cells]
        for k in range(n[2]):
            for j in range(n[1]):
                for i in range(n[0]):
                    points.append([i * 0.004, j * 0.004, k * 0.004])
        unit = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]
        for k in range(cells[2]):
            for j in range(cells[1]):
                for i in range(cells[0]):
                    for number, path in enumerate(unit):
                        at, row = [i, j, k], []
                        for axis in [None, *path]:
                            if axis is not None:
                                at[axis] += 1
                            row.append(at[0] + n[0] * (at[1] + n[1] * at[2]))
                        if number >= 3:
                            row[1], row[2] = row[2], row[1]
                        tets.append(row)
        points, tets = np.array(points), np.array(tets)
        # The cut: the plane y = 20 mm, from x = 12 to 52 mm, down from the top by 12 mm. Its nodes are doubled for
        # the tetrahedra on the far side, except those on its edge inside the tissue.
        eps = 1e-9
        x, y, z = points.T
        on_cut = (np.abs(y - 0.02) < eps) & (x > 0.012 + eps) & (x < 0.052 - eps) & (z > 0.012 + eps)
        double = {node: len(points) + i for i, node in enumerate(np.flatnonzero(on_cut))}
        beyond = points[tets][:, :, 1].mean(axis=1) > 0.02
        faces_near, faces_far = [], []
        low = (points[tets][:, :, 1] <= 0.02 + eps).all(axis=1)
        inside = lambda f: (
            (np.abs(points[f][:, 1] - 0.02) < eps).all()
            and (points[f][:, 0] > 0.012 - eps).all()
            and (points[f][:, 0] < 0.052 + eps).all()
            and (points[f][:, 2] > 0.012 - eps).all()
        )
        for row, far in zip(tets, beyond):
            a, b, c, d = row
            for face in [(b, c, d), (a, d, c), (a, b, d), (a, c, b)]:
                # A face in a corner of the cut, all of whose nodes stay single, does not open.
                if inside(list(face)) and any(node in double for node in face):
                    (faces_far if far else faces_near).append(face)
        assert len(faces_near) == len(faces_far) and low.any()
        faces_far = [[double.get(node, node) for node in face] for face in faces_far]
        points = np.vstack([points, points[list(double)]])
        tets = np.array([[double.get(n_, n_) for n_ in row] if far else list(row) for row, far in zip(tets, beyond)])
        outer = boundary(tets)
        on = lambda axis, value: (np.abs(points[outer][:, :, axis] - value) < eps).all(axis=1)
        sides = on(0, 0) | on(0, 0.064) | on(1, 0) | on(1, 0.04)
        discrete(
            points,
            [
                (3, 4, tets, "tissue"),
                (2, 2, faces_near, "near lip"),
                (2, 2, faces_far, "far lip"),
                (2, 2, outer[on(2, 0)], "bottom"),
                (2, 2, outer[sides], "sides"),
            ],
        )
        save("incision", f"a cut of {len(double)} doubled nodes, never to be merged: it opens under load")


README = """# Meshes

Made by `python3 meshes/generate.py` with pip's gmsh; lengths in metres. `worst` is the least angle between two faces of a
tetrahedron, `edges` the longest edge over the shortest, `kB` the size of the file.

| file | nodes | tetrahedra | worst | edges | kB | groups | what it is for |
| --- | ---: | ---: | ---: | ---: | ---: | --- | --- |
{rows}

`python3 meshes/reference.py` makes the files that the tests of `sinew-mesh` are compared on; they are not kept here.
"""


def main():
    os.chdir(tempfile.gettempdir())
    kept("paper-cube", "the paper's cube, all diagonals one way")
    paper_cube("paper-cube-mirrored", True, "the paper's cube, diagonals mirrored: no direction preferred")
    beam()
    vessel()
    organ()
    slab()
    slivers()
    needle()
    incision()
    text = README.format(rows="\n".join(ROWS))
    (HERE / "README.md").write_text(re.sub(r"[ \t]+\n", "\n", text))


if __name__ == "__main__":
    main()

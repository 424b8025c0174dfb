#!/usr/bin/env python3
"""Makes the files that the tests of sinew-mesh are compared on.

gmsh (pip, 4.15) and meshio (pip, 5.3.5) write small .msh files; what meshio reads from each is stored beside it as
plain text. The results are the packs under crates/sinew-mesh/tests/data; some of the files also go to
crates/sinew-mesh/fuzz/seeds. Run it from anywhere:

    python3 meshes/reference.py

A pack is a sequence of `file NAME BYTES` or `expect NAME BYTES` lines, each followed by that many bytes and a line break.
"""

import contextlib
import io
import math
import os
import re
import sys
import tempfile
from pathlib import Path

import gmsh
import meshio
import numpy as np
from meshio._common import num_nodes_per_cell
from meshio.gmsh.common import _gmsh_to_meshio_type

# meshio has the node orders of these, but not their dimension, and so cannot hold them.
meshio._mesh.topological_dimension.update({"wedge15": 3, "pyramid13": 3})


def mesh_without_incomplete_groups(points, cells, cell_data, **rest):
    """meshio leaves out blocks without a group, and then refuses its own array."""
    if len(cell_data.get("gmsh:physical", cells)) != len(cells):
        del cell_data["gmsh:physical"]
    return meshio.Mesh(points, cells, cell_data=cell_data, **rest)


meshio.gmsh._gmsh40.Mesh = meshio.gmsh._gmsh41.Mesh = mesh_without_incomplete_groups

DATA = Path(__file__).resolve().parent.parent / "crates" / "sinew-mesh" / "tests" / "data"


SEEDS = DATA.parent.parent / "fuzz" / "seeds"


def is_seed(pack, name, content):
    """Small files of every kind, to start fuzzing from."""
    kind = name.split("-")[0]
    if pack == "cell-types":
        return kind in ("tetra", "tetra10")
    if pack == "gmsh":
        return len(content) < 9000 and kind in ("boxes", "parametric", "partitioned", "pyramid", "reversed")
    if pack == "version-1":
        return kind == "boxes"
    return True


class Pack:
    def __init__(self, name):
        self.name = name
        self.out = io.BytesIO()
        self.unread = []

    def add(self, name, content, expected=None):
        """A file, and what meshio reads from it (or from `expected`, a file with the same mesh)."""
        self.entry("file", name, content)
        if isinstance(expected, meshio.Mesh):
            self.entry("expect", name, dump(expected).encode())
            return
        try:
            self.entry("expect", name, dump(read(content if expected is None else expected)).encode())
        except (Exception, SystemExit) as error:  # noqa: BLE001: meshio raises all kinds
            self.unread.append(f"{name}: {type(error).__name__} {error}")

    def entry(self, kind, name, content):
        if kind == "file" and is_seed(self.name, name, content):
            (SEEDS / f"{name}.msh").write_bytes(content)
        self.out.write(f"{kind} {name} {len(content)}\n".encode())
        self.out.write(content)
        self.out.write(b"\n")

    def save(self):
        DATA.mkdir(exist_ok=True)
        path = DATA / f"{self.name}.pack"
        path.write_bytes(self.out.getvalue())
        print(f"{path.name}: {path.stat().st_size} bytes")
        for line in self.unread:
            print(f"  meshio does not read {line}")


def read(content):
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "mesh.msh"
        path.write_bytes(content)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            return meshio.gmsh.read(path)


def number(x):
    if isinstance(x, (int, np.integer)):
        return str(int(x))
    return "nan" if math.isnan(x) else repr(float(x))


def row(values):
    return " ".join(number(x) for x in np.atleast_1d(values))


def dump(mesh):
    """meshio's arrays as lines of words; names come last on their line."""
    lines = [f"points {len(mesh.points)}"]
    lines += [row(p) for p in mesh.points]
    for block in mesh.cells:
        lines.append(f"cells {block.type} {len(block.data)}")
        lines += [row(c) for c in block.data]
    for name, (tag, dim) in mesh.field_data.items():
        lines.append(f"field {tag} {dim} {name}")
    for name, data in mesh.point_data.items():
        lines.append(f"point_data {len(data)} {name}")
        lines += [row(v) for v in data]
    for name, blocks in mesh.cell_data.items():
        lines.append(f"cell_data {len(blocks)} {name}")
        for block in blocks:
            lines.append(f"block {len(block)}")
            lines += [row(v) for v in block]
    for name, blocks in mesh.cell_sets.items():
        if name == "gmsh:bounding_entities":
            continue
        lines.append(f"cell_set {len(blocks)} {name}")
        lines += [" ".join(["set", *(str(int(i)) for i in block)]) for block in blocks]
    for dim, (slave, master), affine, pairs in mesh.gmsh_periodic or []:
        affine = [] if affine is None else list(affine)
        lines.append(f"periodic {len(pairs)} {dim} {slave} {master} {row(affine) if affine else ''}".rstrip())
        lines += [row(p) for p in pairs]
    return "\n".join(lines) + "\n"


def meshio_bytes(mesh, version, binary):
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "mesh.msh"
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            meshio.gmsh.write(path, mesh, fmt_version=version, binary=binary, float_fmt=".16e" if binary else ".6g")
        return path.read_bytes()


def cell_types():
    """Every cell type that meshio can hold, two cells each, in every version and encoding that meshio writes."""
    pack = Pack("cell-types")
    rng = np.random.default_rng(7)
    for kind in _gmsh_to_meshio_type.values():
        if kind not in num_nodes_per_cell:
            continue
        nodes = num_nodes_per_cell[kind]
        points = rng.integers(-8, 8, (nodes + 1, 3)) / 8
        cells = [("%s" % kind, np.array([rng.permutation(nodes + 1)[:nodes] for _ in range(2)]))]
        data = [np.array([5, 5]) if nodes > 100 else np.array([5, 6])]
        mesh = meshio.Mesh(points, cells, cell_data={"gmsh:physical": data, "gmsh:geometrical": data})
        bare = meshio.Mesh(points, cells)
        for version in ["2.2", "4.0", "4.1"]:
            for binary in [False, True]:
                # The large ones differ in nothing but their size.
                if nodes > 30 and (version, binary) not in [("2.2", False), ("4.1", True)]:
                    continue
                if nodes > 100 and (version, binary) != ("2.2", True):
                    continue
                if nodes > 400:
                    continue
                name = f"{kind}-{version}-{'binary' if binary else 'ascii'}"
                pack.add(name, meshio_bytes(mesh if version == "2.2" else bare, version, binary))
    pack.save()


def meshio_data():
    """Groups, entities and data as meshio writes them."""
    pack = Pack("meshio-data")
    # meshio's 4.1 writer sorts points by entity, and its reader takes data in file order: the two agree if sorted here.
    points = np.array([[5, 5, 5], [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.25]])
    cells = [("triangle", np.array([[1, 3, 2]])), ("tetra", np.array([[1, 2, 3, 4], [2, 3, 4, 5]]))]
    dim_tags = np.array([[0, 1], [2, 4], [2, 4], [2, 4], [3, 9], [3, 9]])
    mesh = meshio.Mesh(
        points,
        cells,
        point_data={
            "temperature": np.array([0.0, 1.5, -2.25, 1e-30, 4.0, 5.0]),
            "displacement": np.arange(18.0).reshape(6, 3) / 8,
            "gmsh:dim_tags": dim_tags,
        },
        cell_data={
            "gmsh:physical": [np.array([2]), np.array([7, 7])],
            "gmsh:geometrical": [np.array([4]), np.array([9, 9])],
            "stiffness": [np.array([1.0]), np.array([2.0, 3.0])],
            "stress": [np.arange(9.0).reshape(1, 9), np.arange(18.0).reshape(2, 9)],
        },
        field_data={"skin": np.array([2, 2]), "fat and muscle": np.array([7, 3]), "unused": np.array([8, 3])},
        gmsh_periodic=[[2, (4, 5), None, np.array([[0, 1]])], [1, (1, 2), np.arange(16.0), np.array([[2, 3], [1, 0]])]],
    )
    for version in ["2.2", "4.0", "4.1"]:
        for binary in [False, True]:
            if version == "4.0":
                # Its writer takes the entities for data, and its reader does not read its writer's links.
                mesh.gmsh_periodic = None
                entities = mesh.point_data.pop("gmsh:dim_tags")
            else:
                mesh.gmsh_periodic = [
                    [2, (4, 5), None, np.array([[0, 1]])],
                    [1, (1, 2), np.arange(16.0), np.array([[2, 3], [1, 0]])],
                ]
            content = meshio_bytes(mesh, version, binary)
            if version == "4.0":
                mesh.point_data["gmsh:dim_tags"] = entities
            # NumPy 2 shows its numbers as np.float64(0.5), which meshio then cannot read itself.
            plain = content
            if not binary:
                plain = re.sub(rb"np\.\w+\(([^)]*)\)", rb"\1", content)
            name = f"data-{version}-{'binary' if binary else 'ascii'}"
            # meshio cannot split the data of its own 2.2 files into blocks: they hold what was written.
            expected = None
            if version == "2.2":
                expected = mesh.copy()
                del expected.point_data["gmsh:dim_tags"]
            pack.add(name, plain, expected)
            if plain != content:
                pack.add(f"{name}-repr", content, expected or plain)
    pack.save()


@contextlib.contextmanager
def model(name):
    gmsh.initialize(["gmsh", "-v", "1"], readConfigFiles=False)
    try:
        gmsh.option.setNumber("General.Verbosity", 1)
        gmsh.model.add(name)
        yield
    finally:
        gmsh.finalize()


def gmsh_bytes(version, binary, views=(), **options):
    with tempfile.TemporaryDirectory() as directory:
        path = str(Path(directory) / "mesh.msh")
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        for key, value in options.items():
            gmsh.option.setNumber(f"Mesh.{key}", value)
        gmsh.write(path)
        # Appending a view repeats $MeshFormat, and the mesh if it may.
        gmsh.option.setNumber("PostProcessing.SaveMesh", 0)
        for view in views:
            gmsh.view.write(view, path, append=True)
        for key in options:
            gmsh.option.setNumber(f"Mesh.{key}", 0)
        return Path(path).read_bytes()


def encodings(version):
    """gmsh writes version 4.0 as text only."""
    return [0] if version == 4.0 else [0, 1]


VERSIONS = [(2.0, "2.0"), (2.1, "2.1"), (2.2, "2.2"), (4.0, "4"), (4.1, "4.1")]


def readable(content):
    """The same file under a version that meshio takes for what it is."""
    return content.replace(b"$MeshFormat\n4 ", b"$MeshFormat\n4.0 ", 1)


def two_boxes(size):
    a = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    b = gmsh.model.occ.addBox(1, 0, 0, 0.5, 1, 1)
    gmsh.model.occ.fragment([(3, a)], [(3, b)])
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [a], 1, "soft tissue")
    gmsh.model.addPhysicalGroup(3, [b], 7, "stiff \u00e4")
    gmsh.model.addPhysicalGroup(3, [a, b], 12, "all")
    gmsh.model.addPhysicalGroup(2, [1], 1, "fixed")
    gmsh.model.addPhysicalGroup(2, [6], 3)
    gmsh.model.addPhysicalGroup(0, [1], 2, "probe")
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)


def gmsh_files():
    pack = Pack("gmsh")

    def everywhere(name, views=(), versions=VERSIONS, **options):
        for number_, label in versions:
            for binary in encodings(number_):
                content = gmsh_bytes(number_, binary, views, **options)
                pack.add(f"{name}-{label}-{'binary' if binary else 'ascii'}", content, readable(content))

    with model("boxes"):
        two_boxes(1.0)
        gmsh.model.mesh.generate(3)
        everywhere("boxes")
        everywhere("boxes-all", versions=VERSIONS[2:], SaveAll=1)
        # The same mesh with parametric coordinates, which meshio does not read.
        for number_, label in VERSIONS[2:]:
            for binary in encodings(number_):
                plain = gmsh_bytes(number_, binary)
                content = gmsh_bytes(number_, binary, SaveParametric=1)
                expected = readable(plain) if number_ != 2.2 else plain
                pack.add(f"parametric-{label}-{'binary' if binary else 'ascii'}", content, expected)
        # Data on all and on some nodes and elements.
        tags, _, _ = gmsh.model.mesh.getNodes()
        types, elements, _ = gmsh.model.mesh.getElements(3)
        full = gmsh.view.add("pressure")
        gmsh.view.addModelData(full, 0, "boxes", "NodeData", tags, [[float(t) / 4] for t in tags], time=0.5)
        vector = gmsh.view.add("flow")
        gmsh.view.addModelData(vector, 3, "boxes", "NodeData", tags[:3], [[1.0, 2.0, float(t)] for t in tags[:3]])
        cells = gmsh.view.add("energy")
        gmsh.view.addModelData(
            cells, 1, "boxes", "ElementData", elements[0], [[float(t) / 8] for t in elements[0]], time=1.5
        )
        corners = gmsh.view.add("corner values")
        gmsh.view.addModelData(
            corners,
            2,
            "boxes",
            "ElementNodeData",
            elements[0][:5],
            [[float(t) + i / 4 for i in range(4)] for t in elements[0][:5]],
        )
        for number_, label in VERSIONS[2:]:
            for binary in encodings(number_):
                content = gmsh_bytes(number_, binary, [full, vector, cells, corners])
                plain = gmsh_bytes(number_, binary)
                pack.add(f"views-{label}-{'binary' if binary else 'ascii'}", content, readable(plain))
        # Partitions, with ghosts.
        gmsh.option.setNumber("Mesh.PartitionCreateTopology", 1)
        gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 1)
        gmsh.model.mesh.partition(2)
        for number_, label in VERSIONS[2:]:
            for binary in encodings(number_):
                content = gmsh_bytes(number_, binary)
                pack.entry("file", f"partitioned-{label}-{'binary' if binary else 'ascii'}", content)

    for incomplete in [0, 1]:
        label = "incomplete" if incomplete else "complete"
        with model("second order"):
            gmsh.option.setNumber("Mesh.ElementOrder", 2)
            gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
            two_boxes(2.0)
            gmsh.model.mesh.generate(3)
            everywhere(f"tetra10-{label}", versions=VERSIONS[2:])
        for shape in ["hexahedron", "wedge"]:
            with model(shape):
                gmsh.option.setNumber("Mesh.ElementOrder", 2)
                gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
                square = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
                gmsh.model.occ.extrude([(2, square)], 0, 0, 2, [2], recombine=True)
                gmsh.model.occ.synchronize()
                if shape == "hexahedron":
                    for curve in gmsh.model.getEntities(1):
                        gmsh.model.mesh.setTransfiniteCurve(curve[1], 2)
                    gmsh.model.mesh.setTransfiniteSurface(square)
                    gmsh.model.mesh.setRecombine(2, square)
                gmsh.option.setNumber("Mesh.MeshSizeMin", 2)
                gmsh.model.mesh.generate(3)
                gmsh.model.addPhysicalGroup(3, [1], 4, "block")
                everywhere(f"{shape}-{label}", versions=VERSIONS[2:], SaveAll=1)
        with model("pyramid"):
            entity = gmsh.model.addDiscreteEntity(3)
            corners = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 2]]
            gmsh.model.mesh.addNodes(3, entity, [1, 2, 3, 4, 5], [x for p in corners for x in p])
            gmsh.model.mesh.addElementsByType(entity, 7, [1], [1, 2, 3, 4, 5])
            gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
            gmsh.model.mesh.setOrder(2)
            gmsh.model.addPhysicalGroup(3, [entity], 4, "block")
            everywhere(f"pyramid-{label}", versions=VERSIONS[2:])

    with model("periodic"):
        box = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        shift = [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        gmsh.model.mesh.setPeriodic(2, [2], [1], shift)
        gmsh.model.addPhysicalGroup(3, [box], 1, "box")
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0.7)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.7)
        gmsh.model.mesh.generate(3)
        everywhere("periodic", versions=VERSIONS[2:], SaveAll=1)

    with model("reversed"):
        # A negative entity in a group: the group is entered with the opposite orientation.
        square = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [-square], 3, "down")
        gmsh.model.addPhysicalGroup(1, [1, -2], 5, "edge")
        gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
        gmsh.model.mesh.generate(2)
        everywhere("reversed", versions=VERSIONS[2:])
    pack.save()


def without_names(content):
    return re.sub(rb"\$PhysicalNames\n.*?\$EndPhysicalNames\n", b"", content, flags=re.S)


def version_1():
    """Version 1 of gmsh, which meshio does not read: the same mesh as in version 2.2, without names."""
    pack = Pack("version-1")

    def add(name, **options):
        content = gmsh_bytes(1.0, 0, **options)
        pack.add(f"{name}-1-ascii", content, without_names(gmsh_bytes(2.2, 0, **options)))

    with model("boxes"):
        two_boxes(1.0)
        gmsh.model.mesh.generate(3)
        add("boxes")
        add("boxes-all", SaveAll=1)
    with model("second order"):
        gmsh.option.setNumber("Mesh.ElementOrder", 2)
        two_boxes(2.0)
        gmsh.model.mesh.generate(3)
        add("tetra10")
    with model("reversed"):
        square = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [-square], 3, "down")
        gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
        gmsh.model.mesh.generate(2)
        add("reversed")
    pack.save()


if __name__ == "__main__":
    os.chdir(tempfile.gettempdir())
    SEEDS.mkdir(parents=True, exist_ok=True)
    cell_types()
    meshio_data()
    gmsh_files()
    version_1()
    sys.stdout.flush()

"""Makes the meshes of this folder with gmsh: `python generate.py [NAME ...]`, all of them by default.

Every function in the section "The meshes" builds one file. Its decorator says what the mesh is for, how large it must
be and what else it promises. All files are then read back with meshio and checked; the table in README.md is made
of what was read.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from pathlib import Path

import gmsh
import meshio
import numpy as np

HERE = Path(__file__).resolve().parent
README = HERE / "README.md"
TABLE_BEGIN, TABLE_END = "<!-- table: written by generate.py -->\n", "<!-- end -->"
LARGEST_FILE = 1_000_000  # bytes
DIGITS = 9  # coordinates are rounded to a nanometre: short files, no noise in the last digits
MM = 1e-3
TRIANGLE, TETRAHEDRON = 2, 4  # gmsh's numbers for the types of cells
OUTWARD_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
EDGES = np.array(list(combinations(range(4), 2)))


def no_node_is_doubled(mesh):
    return mesh.doubled_nodes == 0


@dataclass
class Entry:
    """What is known of a file before it is read."""

    purpose: str
    volume: float  # cm3
    promise: Callable = no_node_is_doubled
    build: Callable | None = None  # None: another program writes the file


COLLECTION = {
    "paper-cube": Entry("the paper's cube, all diagonals one way; written by `cargo xtask meshes`", 8000),
    "sliver-20": Entry("one element 20 times thinner than the others; written by `cargo xtask meshes`", 1000),
    "sliver-100": Entry("one element 100 times thinner than the others; written by `cargo xtask meshes`", 1000),
    "sliver-1000": Entry("one element 1000 times thinner than the others; written by `cargo xtask meshes`", 1000),
    "inclusion": Entry("a cube with a core of its own; written by `cargo xtask meshes`", 1000),
}


def in_collection(name, purpose, volume, promise=no_node_is_doubled):
    """Registers the function that builds `name`.msh."""

    def register(build):
        COLLECTION[name] = Entry(purpose, volume, promise, build)
        return build

    return register


# ---------------------------------------------------------------------------------------------------------------------
# Geometry: millimetres in calls, metres in the model, z upwards


def box(low, high):
    low, high = np.multiply(low, MM), np.multiply(high, MM)
    return (3, gmsh.model.occ.addBox(*low, *(high - low)))


def cylinder(base, axis, radius, angle=2 * np.pi):
    base, axis = np.multiply(base, MM), np.multiply(axis, MM)
    return (3, gmsh.model.occ.addCylinder(*base, *axis, radius * MM, angle=angle))


def ellipsoid(centre, radii):
    centre, radii = np.multiply(centre, MM), np.multiply(radii, MM)
    solid = (3, gmsh.model.occ.addSphere(*centre, radii[0]))
    gmsh.model.occ.dilate([solid], *centre, *(radii / radii[0]))
    return solid


def upright_ellipse(centre, radii):
    """An elliptic disc in a plane of constant x; radii along y and z."""
    centre, radii = np.multiply(centre, MM), np.multiply(radii, MM)
    disc = (2, gmsh.model.occ.addDisk(*centre, *radii))
    for axis in [(1, 0, 0), (0, 0, 1)]:
        gmsh.model.occ.rotate([disc], *centre, *axis, np.pi / 2)
    return disc


def union(*shapes):
    [whole], _ = gmsh.model.occ.fuse(shapes[:1], shapes[1:])
    return whole


def difference(shape, *tools):
    [rest], _ = gmsh.model.occ.cut([shape], tools)
    return rest


def common_part(shape, tool):
    """What the shape has in common with the tool, which is kept."""
    [part], _ = gmsh.model.occ.intersect([shape], [tool], removeTool=False)
    return part


def joined(*shapes):
    """Completes the geometry, with common faces where shapes touch; for each shape its pieces."""
    pieces = [list(shapes)]
    if len(shapes) > 1:
        _, pieces = gmsh.model.occ.fragment(shapes[:1], shapes[1:])
    gmsh.model.occ.synchronize()
    return pieces


def boundary(entities):
    """The outer faces of volumes, or the curves round faces."""
    return gmsh.model.getBoundary(entities, combined=True, oriented=False)


def flat(entities, axis, value):
    """Those of the entities on which the coordinate `axis` (0, 1, 2) has the value."""

    def has_value(entity):
        bounds = gmsh.model.getBoundingBox(*entity)
        return np.allclose([bounds[axis], bounds[axis + 3]], value * MM, atol=0.01 * MM)

    return [entity for entity in entities if has_value(entity)]


def without(entities, others):
    return [entity for entity in entities if entity not in others]


def group(name, entities):
    """Adds a physical group. Tags count on over all dimensions, so that no two groups share one."""
    [dim] = {dim for dim, _ in entities}
    tag = len(gmsh.model.getPhysicalGroups()) + 1
    return gmsh.model.addPhysicalGroup(dim, [tag for _, tag in entities], tag, name)


# ---------------------------------------------------------------------------------------------------------------------
# Meshing


def mesh_evenly(size):
    gmsh.option.setNumber("Mesh.MeshSizeMin", size * MM)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size * MM)
    gmsh.model.mesh.generate(3)


def mesh_finer_near(faces, fine, coarse, reach):
    """Edges grow from `fine` at the faces to `coarse` at the distance `reach`."""

    def field(kind, **options):
        tag = gmsh.model.mesh.field.add(kind)
        for option, value in options.items():
            gmsh.model.mesh.field.setNumber(tag, option, value)
        return tag

    distance = field("Distance", Sampling=100)
    gmsh.model.mesh.field.setNumbers(distance, "SurfacesList", [tag for _, tag in faces])
    size = field("Threshold", InField=distance, SizeMin=fine * MM, SizeMax=coarse * MM, DistMin=0, DistMax=reach * MM)
    gmsh.model.mesh.field.setAsBackgroundMesh(size)
    for other_source in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{other_source}", 0)
    gmsh.model.mesh.generate(3)


def mesh_in_layers(cells_along):
    """Cuts six-sided volumes into layers; `cells_along` gives the cells along a curve from its length in mm."""
    for _, curve in gmsh.model.getEntities(1):
        cells = cells_along(gmsh.model.occ.getMass(1, curve) / MM)
        gmsh.model.mesh.setTransfiniteCurve(curve, cells + 1)
    for _, face in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(face)
    for _, volume in gmsh.model.getEntities(3):
        gmsh.model.mesh.setTransfiniteVolume(volume)
    gmsh.model.mesh.generate(3)


def add_cells(name, cells, nodes=()):
    """Adds nodes (tags from 1) and triangles or tetrahedra without any geometry, and makes them a group."""
    dim = cells.shape[1] - 1
    tag = gmsh.model.addDiscreteEntity(dim)
    gmsh.model.mesh.addNodes(dim, tag, range(1, len(nodes) + 1), np.ravel(nodes))
    gmsh.model.mesh.addElementsByType(tag, TRIANGLE if dim == 2 else TETRAHEDRON, [], cells.ravel())
    group(name, [(dim, tag)])


def flatten_tets(count, flatness):
    """Makes slivers: moves inner nodes across an edge of the opposite face, almost into its plane.

    A flattened tetrahedron keeps the fraction `flatness` of its height; the others round the node keep at least a
    tenth of their volume. No two moved nodes are in one tetrahedron.
    """
    points, tets = points_and_tets()
    inner = gmsh.model.mesh.getNodes(3)[0]
    touched = set()
    for tet in tets:
        for node in np.intersect1d(tet, inner):
            star = tets[(tets == node).any(axis=1)]
            if count == 0 or touched & set(star.flat):
                continue
            foot, weights = projection(points[node], points[tet[tet != node]])
            moved = points.copy()
            moved[node] = foot + flatness * (points[node] - foot)
            others = star[(star != tet).any(axis=1)]
            least, second, _ = np.sort(weights)
            if least < -0.1 and second > 0.1 and np.all(volumes(moved, others) > 0.1 * volumes(points, others)):
                points = moved
                gmsh.model.mesh.setNode(node, points[node], [])
                touched |= set(star.flat)
                count -= 1
    assert count == 0, f"{count} slivers are missing"


def points_and_tets():
    """The coordinates of the nodes by tag (row 0 stands for none), and the tags of each tetrahedron."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = np.zeros((int(tags.max()) + 1, 3))
    points[tags] = coordinates.reshape(-1, 3)
    _, tets = gmsh.model.mesh.getElementsByType(TETRAHEDRON)
    return points, tets.reshape(-1, 4)


def projection(point, triangle):
    """The foot of the point in the plane of the triangle, and its barycentric coordinates."""
    sides = np.transpose(triangle[1:] - triangle[0])
    (s, t), *_ = np.linalg.lstsq(sides, point - triangle[0], rcond=None)
    return triangle[0] + sides @ (s, t), (1 - s - t, s, t)


def open_cut(cut, mouth, names):
    """Doubles the nodes of a face inside the volume, on its mouth too but not on the rest of its rim."""
    lip = group(names[0], cut)
    opening = gmsh.model.addPhysicalGroup(1, [tag for _, tag in mouth])
    options = {"Dimension": 2, "PhysicalGroup": lip, "NewPhysicalGroup": lip + 1, "OpenBoundaryPhysicalGroup": opening}
    for option, value in options.items():
        gmsh.plugin.setNumber("Crack", option, value)
    gmsh.plugin.run("Crack")
    gmsh.model.removePhysicalGroups([(1, opening)])
    gmsh.model.setPhysicalName(2, lip + 1, names[1])


def add_data(name, values_at):
    """Adds a view with the values of each cell by its middle (m), to four significant digits.

    Nothing but tetrahedra needs them, but meshio reads no data that some cells lack.
    """
    points, _ = points_and_tets()
    tags, rows = [], []
    for kind, corners in [(TRIANGLE, 3), (TETRAHEDRON, 4)]:
        of_kind, nodes = gmsh.model.mesh.getElementsByType(kind)
        values = [np.atleast_1d(values_at(*middle)) for middle in points[nodes.reshape(-1, corners)].mean(axis=1)]
        tags.extend(of_kind)
        rows += [[float(f"{value:.4g}") for value in row] for row in values]
    view = gmsh.view.add(name)
    gmsh.view.addModelData(view, 0, gmsh.model.getCurrent(), "ElementData", tags, rows, numComponents=len(rows[0]))


# ---------------------------------------------------------------------------------------------------------------------
# The meshes


@in_collection("beam", "bending: a slender cantilever, 100 x 10 x 10 mm", 10)
def beam():
    [[tissue]] = joined(box((0, 0, 0), (100, 10, 10)))
    surface = boundary([tissue])
    clamped, tip = flat(surface, 0, 0), flat(surface, 0, 100)
    group("tissue", [tissue])
    group("clamped", clamped)
    group("tip", tip)
    group("sides", without(surface, clamped + tip))
    mesh_evenly(2.5)


def cantilever(edge):
    """A beam of 1 x 0.1 x 0.1 m along x."""
    [[tissue]] = joined(box((0, 0, 0), (1000, 100, 100)))
    surface = boundary([tissue])
    clamped, tip = flat(surface, 0, 0), flat(surface, 0, 1000)
    group("tissue", [tissue])
    group("clamped", clamped)
    group("tip", tip)
    group("sides", without(surface, clamped + tip))
    mesh_evenly(edge)


@in_collection("cantilever-2", "verification: a beam of 1 x 0.1 x 0.1 m, two edges over the thickness", 1e4)
def cantilever_2():
    cantilever(50)


@in_collection("cantilever-4", "verification: the same with four edges over the thickness", 1e4)
def cantilever_4():
    cantilever(25)


def even_cube(edge):
    """A cube of 1 m."""
    [[tissue]] = joined(box((0, 0, 0), (1000, 1000, 1000)))
    group("tissue", [tissue])
    group("surface", boundary([tissue]))
    mesh_evenly(edge)


@in_collection("cube-4", "verification: a cube of 1 m, edges of 250 mm", 1e6)
def cube_4():
    even_cube(250)


@in_collection("cube-8", "verification: a cube of 1 m, edges of 125 mm", 1e6)
def cube_8():
    even_cube(125)


@in_collection("cube-12", "verification: a cube of 1 m, edges of 85 mm", 1e6)
def cube_12():
    even_cube(85)


@in_collection("vessel", "a thin wall under pressure: a tube 60 mm long, inner radius 10 mm, wall 1.5 mm", 6.08)
def vessel():
    def quarter_rod(radius):
        return cylinder((0, 0, 0), (0, 0, 60), radius, angle=np.pi / 2)

    quarters = [difference(quarter_rod(11.5), quarter_rod(10))]
    for turn in (1, 2, 3):
        quarters += gmsh.model.occ.copy(quarters[:1])
        gmsh.model.occ.rotate(quarters[-1:], 0, 0, 0, 0, 0, 1, turn * np.pi / 2)
    wall = sum(joined(*quarters), [])
    surface = boundary(wall)
    ends = flat(surface, 2, 0) + flat(surface, 2, 60)
    bore = np.multiply([-10.1, -10.1, -0.1, 10.1, 10.1, 60.1], MM)
    inner = gmsh.model.getEntitiesInBoundingBox(*bore, 2)
    group("wall", wall)
    group("inner", inner)
    group("outer", without(surface, ends + inner))
    group("ends", ends)
    mesh_in_layers(lambda length: 2 if length < 2 else 10 if length < 20 else 30)


@in_collection(
    "organ",
    "an organ of two materials: liver-like, 210 mm wide, with a stiff tumour inside and a flat base to hold",
    1019,
    lambda mesh: no_node_is_doubled(mesh) and mesh.has_boundary("inclusion", "inclusion-surface"),
)
def organ():
    right_lobe = ellipsoid((-35, 0, 35), (65, 60, 50))
    left_lobe = ellipsoid((45, 12, 24), (65, 42, 30))
    body = difference(union(right_lobe, left_lobe), box((-200, -200, -200), (200, 200, 0)))
    pieces, inclusion = joined(body, ellipsoid((-45, -10, 50), (18, 14, 14)))
    capsule = boundary(pieces)
    group("parenchyma", without(pieces, inclusion))
    group("inclusion", inclusion)
    group("capsule", capsule)
    group("attachment", flat(capsule, 2, 0))
    group("inclusion-surface", boundary(inclusion))
    mesh_finer_near(boundary(inclusion), 4, 11, 40)


@in_collection("layers", "layers of unlike stiffness: skin 2 mm, fat 8 mm, muscle 20 mm, a slab of 60 x 60 mm", 108)
def layers():
    heights = [(28, 30), (20, 28), (0, 20)]
    slabs = joined(*(box((0, 0, low), (60, 60, high)) for low, high in heights))
    surface = boundary(sum(slabs, []))
    top, bottom = flat(surface, 2, 30), flat(surface, 2, 0)
    for name, slab in zip(["skin", "fat", "muscle"], slabs):
        group(name, slab)
    group("top", top)
    group("bottom", bottom)
    group("sides", without(surface, top + bottom))
    mesh_finer_near(top, 2.5, 6, 30)


@in_collection(
    "slivers",
    "bad elements: 16 tetrahedra flattened until a dihedral angle is below 0.1 degrees, all still positive",
    32,
    lambda mesh: no_node_is_doubled(mesh) and np.sum(mesh.dihedrals.min(axis=1) < 0.1) == 16,
)
def slivers():
    [[tissue]] = joined(box((0, 0, 0), (40, 40, 20)))
    group("tissue", [tissue])
    group("bottom", flat(boundary([tissue]), 2, 0))
    group("top", flat(boundary([tissue]), 2, 20))
    mesh_evenly(3)
    flatten_tets(16, flatness=5e-4)


@in_collection(
    "needle",
    "many scales: the track of a needle 1.2 mm thick, 20 mm deep into a block of 60 x 60 x 40 mm",
    144,
    lambda mesh: no_node_is_doubled(mesh) and 50 <= mesh.edges.max() / mesh.edges.min() < 60,
)
def needle():
    shaft = cylinder((0, 0, 20.6), (0, 0, 19.4), 0.6)
    round_tip = ellipsoid((0, 0, 20.6), (0.6, 0.6, 0.6))
    [[tissue]] = joined(difference(box((-30, -30, 0), (30, 30, 40)), shaft, round_tip))
    surface = boundary([tissue])
    bottom, top = flat(surface, 2, 0), flat(surface, 2, 40)
    sides = [side for axis in (0, 1) for end in (-30, 30) for side in flat(surface, axis, end)]
    track = without(surface, bottom + top + sides)
    group("tissue", [tissue])
    group("track", track)
    group("bottom", bottom)
    group("top", top)
    mesh_finer_near(track, 0.4, 7, 20)


@in_collection(
    "incision",
    "a cut that can open: doubled nodes on its lips, 40 mm long, 8 mm deep in a block of 60 x 60 x 20 mm",
    72,
    lambda mesh: mesh.is_cut_between("lip-left", "lip-right"),
)
def incision():
    block = box((-30, -30, 0), (30, 30, 20))
    cut = common_part(upright_ellipse((0, 0, 20), (20, 8)), block)
    tissue, cut = joined(block, cut)
    mouth = flat(boundary(cut), 2, 20)
    group("tissue", tissue)
    group("bottom", flat(boundary(tissue), 2, 0))
    mesh_finer_near(cut, 2, 7, 30)
    open_cut(cut, mouth, ["lip-left", "lip-right"])


@in_collection(
    "muscle",
    "properties by element: a muscle 100 mm long, stiffer towards its tendons, with fibres along its curved outline",
    54.32,
    lambda mesh: no_node_is_doubled(mesh) and mesh.has_data(stiffness=1, along=3),
)
def muscle():
    [[belly]] = joined(common_part(ellipsoid((0, 0, 0), (60, 15, 15)), box((-50, -20, -20), (50, 20, 20))))
    gmsh.model.occ.remove(without(gmsh.model.occ.getEntities(3), [belly]), recursive=True)
    gmsh.model.occ.synchronize()
    surface = boundary([belly])
    origin, insertion = flat(surface, 0, -50), flat(surface, 0, 50)
    group("belly", [belly])
    group("origin", origin)
    group("insertion", insertion)
    group("fascia", without(surface, origin + insertion))
    mesh_evenly(6)
    # Pa, at the distance x from the middle.
    add_data("stiffness", lambda x, y, z: 20e3 + 180e3 * (x / 0.05) ** 4)
    # The ellipsoids of one middle and half axis along x that are narrower in proportion keep y and z over sqrt(.06^2 - x^2).
    add_data("along", lambda x, y, z: np.divide([0.06**2 - x**2, -x * y, -x * z], 0.06**2 - x**2))


@in_collection(
    "artery",
    "fibres of two families: a ring of the media of a carotid artery, inner radius 0.71 mm, wall 0.26 mm, 0.39 mm long",
    np.pi * (0.97**2 - 0.71**2) * 0.39 * 1e-3,
    lambda mesh: no_node_is_doubled(mesh) and mesh.has_data(left=3, right=3),
)
def artery(around=32, through=3, along=4, angle=29):
    """A grid of hexahedra in polar coordinates, six tetrahedra each; `angle` is that of the fibres to the circumference, in degrees."""
    ring, layer, height = np.indices((around, through + 1, along + 1)).reshape(3, -1)
    turn, radius = 2 * np.pi * ring / around, 0.71 + 0.26 * layer / through
    nodes = MM * np.column_stack([radius * np.cos(turn), radius * np.sin(turn), 0.39 * height / along])
    paths = np.eye(3, dtype=int)[[[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]]]
    steps = np.concatenate([np.zeros((6, 1, 3), int), paths.cumsum(axis=1)], axis=1)
    first = np.column_stack([ring, layer, height])
    first = first[(layer < through) & (height < along)][:, None, None]
    corners = (first + (steps ^ (first % 2))).reshape(-1, 4, 3)
    corners[..., 0] %= around
    tets = corners @ [(through + 1) * (along + 1), along + 1, 1]
    inverted = volumes(nodes, tets) < 0
    tets[inverted] = tets[inverted][:, [0, 2, 1, 3]]

    def faces_where(axis, *places):
        faces = tets[:, OUTWARD_FACES].reshape(-1, 3)
        grid = np.column_stack([ring, layer, height])[:, axis]
        return 1 + faces[np.any([(grid[faces] == place).all(axis=1) for place in places], axis=0)]

    add_cells("media", 1 + tets, nodes)
    add_cells("inner", faces_where(1, 0))
    add_cells("outer", faces_where(1, through))
    add_cells("ends", faces_where(2, 0, along))

    def at(side):
        rise = np.tan(np.radians(angle))
        return lambda x, y, z: np.divide([-y, x, side * rise * np.hypot(x, y)], np.hypot(x, y))

    add_data("left", at(1))
    add_data("right", at(-1))


@in_collection("paper-cube-mirrored", "the paper's cube with neighbouring cells mirrored: no preferred direction", 8000)
def paper_cube_mirrored(cells=10, edge=0.2):
    """Node (i, j, k) has the tag 1 + i + 11 (j + 11 k); cell (i, j, k) is reflected in x, y, z where i, j, k is odd."""
    k, j, i = np.indices((cells + 1,) * 3).reshape(3, -1)
    grid = np.column_stack([i, j, k])
    nodes = grid * edge / cells
    paths = np.eye(3, dtype=int)[[[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]]]
    steps = np.concatenate([np.zeros((6, 1, 3), int), paths.cumsum(axis=1)], axis=1)
    corners = grid[(grid < cells).all(axis=1)][:, None, None]
    tets = ((corners + (steps ^ (corners % 2))) @ [1, cells + 1, (cells + 1) ** 2]).reshape(-1, 4)
    inverted = volumes(nodes, tets) < 0
    tets[inverted] = tets[inverted][:, [0, 2, 1, 3]]

    def faces_where(on_surface):
        faces = tets[:, OUTWARD_FACES].reshape(-1, 3)
        return 1 + faces[on_surface(grid[faces])]

    def at_end(positions, axis, end):
        return (positions[..., axis] == end).all(axis=1)

    add_cells("tissue", 1 + tets, nodes)
    add_cells("sides", faces_where(lambda at: np.any([at_end(at, a, e) for a in (0, 1) for e in (0, cells)], axis=0)))
    add_cells("top", faces_where(lambda at: at_end(at, 2, cells)))
    add_cells("bottom", faces_where(lambda at: at_end(at, 2, 0)))


# ---------------------------------------------------------------------------------------------------------------------
# Writing and reading back


def write(name):
    """Builds a mesh in a gmsh of its own, so that the others do not influence it."""
    gmsh.initialize([], readConfigFiles=False)
    options = {"General.Verbosity": 2, "General.NumThreads": 1, "Mesh.RandomSeed": 1, "Mesh.MshFileVersion": 4.1}
    for option, value in options.items():
        gmsh.option.setNumber(option, value)
    COLLECTION[name].build()
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    for tag, point in zip(tags, coordinates.reshape(-1, 3).round(DIGITS) + 0.0):
        gmsh.model.mesh.setNode(tag, point, [])
    path = str(HERE / f"{name}.msh")
    gmsh.write(path)
    gmsh.option.setNumber("PostProcessing.SaveMesh", 0)
    for view in gmsh.view.getTags():
        gmsh.view.write(view, path, append=True)
    gmsh.finalize()


class Mesh:
    """A file as meshio reads it."""

    def __init__(self, name):
        self.path = HERE / f"{name}.msh"
        file = meshio.read(self.path, file_format="gmsh")
        self.points = file.points
        self.cell_types = set(file.cells_dict)
        self.tets = file.cells_dict["tetra"]
        self.data = file.cell_data_dict
        self.groups = {
            name: file.cells_dict[kind][members]
            for name in sorted(file.field_data, key=lambda name: file.field_data[name][0])
            for kind, members in file.cell_sets_dict[name].items()
        }

    @cached_property
    def dihedrals(self):
        """The six dihedral angles of each tetrahedron in degrees."""
        corners = self.points[self.tets][:, OUTWARD_FACES]
        normals = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
        a, b = np.moveaxis(normals[:, EDGES], 2, 0)
        sine = np.linalg.norm(np.cross(a, b), axis=-1)
        return np.degrees(np.arctan2(sine, -np.sum(a * b, axis=-1)))

    @cached_property
    def edges(self):
        """The lengths of all edges."""
        a, b = np.moveaxis(self.points[self.tets[:, EDGES]], 2, 0)
        return np.linalg.norm(a - b, axis=-1)

    @property
    def doubled_nodes(self):
        return len(self.points) - len(np.unique(self.points, axis=0))

    def has_data(self, **components):
        """Whether all tetrahedra have values of these names, with so many components each, and there are no others."""
        named = {name: np.reshape(of["tetra"], (len(self.tets), -1)) for name, of in self.data.items() if ":" not in name}
        return (
            {name: values.shape[1] for name, values in named.items()} == components
            and all(np.isfinite(values).all() for values in named.values())
        )

    def has_boundary(self, volume, surface):
        """Whether the outer faces of a group of tetrahedra are the triangles of another group."""
        faces = face_counts(self.groups[volume])
        return {face for face, count in faces.items() if count == 1} == set(face_counts(self.groups[surface]))

    def is_cut_between(self, left, right):
        """Whether the mesh is cut at x = 0, with lips that match node by node and touch at their common rim only."""
        lips = [np.unique(self.groups[lip]) for lip in (left, right)]
        rim = np.intersect1d(*lips)
        left_only, right_only = (np.setdiff1d(lip, rim) for lip in lips)
        matching = [self.points[self.groups[lip]].mean(axis=1).round(DIGITS) for lip in (left, right)]
        centres = self.points[self.tets].mean(axis=1)[:, 0]
        return (
            0 < len(left_only) == len(right_only) == self.doubled_nodes
            and np.array_equal(*(np.unique(triangles, axis=0) for triangles in matching))
            and np.all(self.points[np.concatenate(lips), 0] == 0)
            and np.all(centres[np.isin(self.tets, left_only).any(axis=1)] < 0)
            and np.all(centres[np.isin(self.tets, right_only).any(axis=1)] > 0)
        )


def volumes(points, tets):
    a, b, c, d = np.moveaxis(points[tets], 1, 0)
    return np.linalg.det(np.stack([b - a, c - a, d - a], axis=1)) / 6


def face_counts(cells):
    """How many of the tetrahedra or triangles have a face, by its nodes in ascending order."""
    faces = cells[:, OUTWARD_FACES].reshape(-1, 3) if cells.shape[1] == 4 else cells
    unique, counts = np.unique(np.sort(faces, axis=1), axis=0, return_counts=True)
    return dict(zip(map(tuple, unique.tolist()), counts.tolist()))


def check(mesh, entry):
    assert mesh.path.stat().st_size < LARGEST_FILE, "the file is too large"
    assert mesh.cell_types == {"tetra", "triangle"}, f"unexpected cells: {mesh.cell_types}"
    assert np.array_equal(np.unique(mesh.tets), np.arange(len(mesh.points))), "a node is in no tetrahedron"
    each = volumes(mesh.points, mesh.tets)
    assert each.min() > 0, "a tetrahedron is flat or inverted"
    assert np.isclose(each.sum() * 1e6, entry.volume, rtol=0.02), f"{each.sum() * 1e6} cm3 are not {entry.volume}"
    faces = face_counts(mesh.tets)
    assert max(faces.values()) == 2, "a face has more than two tetrahedra"
    for name, cells in mesh.groups.items():
        assert len(cells) > 0, f"group {name} is empty"
        assert cells.shape[1] == 4 or set(face_counts(cells)) <= set(faces), f"{name} has triangles that are no faces"
    in_groups = np.concatenate([cells for cells in mesh.groups.values() if cells.shape[1] == 4])
    assert sorted(map(tuple, in_groups)) == sorted(map(tuple, mesh.tets)), "the volumes are not the tetrahedra"
    assert entry.promise(mesh), "the promise is broken"


def row(name):
    mesh, entry = Mesh(name), COLLECTION[name]
    try:
        check(mesh, entry)
    except AssertionError as broken:
        raise AssertionError(f"{mesh.path.name}: {broken}") from broken
    numbers = [len(mesh.points), len(mesh.tets), f"{mesh.dihedrals.min():.2g}"]
    ratio = f"1 : {mesh.edges.max() / mesh.edges.min():.3g}"
    return [f"`{mesh.path.name}`", *numbers, ratio, ", ".join(mesh.groups), entry.purpose]


def table(rows):
    heads = ["file", "nodes", "tetrahedra", "worst dihedral angle [°]", "shortest : longest edge", "groups", "what for"]
    alignment = ["---", "---:", "---:", "---:", "---:", "---", "---"]
    return "".join(f"| {' | '.join(map(str, cells))} |\n" for cells in [heads, alignment, *rows])


def main(names):
    ours = [name for name, entry in COLLECTION.items() if entry.build]
    unknown = set(names) - set(ours)
    if unknown:
        sys.exit(f"unknown: {', '.join(sorted(unknown))}; the meshes are {', '.join(ours)}")
    for name in names or ours:
        write(name)
    text = table([row(name) for name in COLLECTION])
    print(text, end="")
    before, rest = README.read_text().split(TABLE_BEGIN)
    _, after = rest.split(TABLE_END)
    README.write_text(before + TABLE_BEGIN + text + TABLE_END + after)


if __name__ == "__main__":
    main(sys.argv[1:])

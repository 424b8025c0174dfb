"""Makes the meshes of this folder with gmsh: `python generate.py [NAME ...]`, all of them by default.

Every function in the section "The meshes" builds one file. It names the groups, and its decorator says what the mesh
is for and what it promises. The files are read back with meshio and checked; the table in README.md is made of
what was read.
"""

import sys
from pathlib import Path

import gmsh
import meshio
import numpy as np

HERE = Path(__file__).resolve().parent
README = HERE / "README.md"
TABLE_MARKS = ("<!-- table: written by generate.py -->\n", "<!-- end -->")
LARGEST_FILE = 1_000_000  # bytes
DIGITS = 9  # coordinates are rounded to a nanometre: short files, and no noise in the last digits
MM = 1e-3

COLLECTION = {}


def in_collection(name, purpose, promise=lambda mesh: mesh.coincident == 0):
    """Registers the function that builds `name`.msh; `promise` must hold of the mesh that is read back."""

    def register(build):
        COLLECTION[name] = (build, purpose, promise)
        return build

    return register


# ---------------------------------------------------------------------------------------------------------------------
# Geometry: lengths in metres, z upwards


def box(low_mm, high_mm):
    low, high = np.multiply(low_mm, MM), np.multiply(high_mm, MM)
    return (3, gmsh.model.occ.addBox(*low, *(high - low)))


def cylinder(base_mm, axis_mm, radius_mm, **options):
    base, axis = np.multiply(base_mm, MM), np.multiply(axis_mm, MM)
    return (3, gmsh.model.occ.addCylinder(*base, *axis, radius_mm * MM, **options))


def ellipsoid(centre_mm, radii_mm):
    centre, radii = np.multiply(centre_mm, MM), np.multiply(radii_mm, MM)
    solid = (3, gmsh.model.occ.addSphere(*centre, radii[0]))
    gmsh.model.occ.dilate([solid], *centre, *(radii / radii[0]))
    return solid


def difference(solid, *tools):
    """What is left of the solid without the tools."""
    [rest], _ = gmsh.model.occ.cut([solid], tools)
    return rest


def joined(*parts):
    """The parts with common faces where they touch, and for each part its pieces."""
    _, pieces = gmsh.model.occ.fragment(parts[:1], parts[1:])
    gmsh.model.occ.synchronize()
    return pieces


def surface_of(volumes):
    """The outer faces of the volumes together."""
    faces = gmsh.model.getBoundary(volumes, combined=True, oriented=False)
    return sorted(faces)


def flat(faces, axis, value_mm):
    """Those of the faces that lie in the plane where the coordinate `axis` (0, 1, 2) has the value."""

    def lies_there(face):
        bounds = gmsh.model.getBoundingBox(*face)
        return np.allclose([bounds[axis], bounds[axis + 3]], value_mm * MM, atol=1e-6)

    return [face for face in faces if lies_there(face)]


def without(faces, *others):
    return [face for face in faces if not any(face in other for other in others)]


def group(name, entities):
    """Adds a physical group; tags count up over all dimensions, so that no two groups share one."""
    [dim] = {dim for dim, _ in entities}
    tag = len(gmsh.model.getPhysicalGroups()) + 1
    return gmsh.model.addPhysicalGroup(dim, [tag for _, tag in entities], tag, name)


# ---------------------------------------------------------------------------------------------------------------------
# Meshing


def mesh_evenly(size_mm):
    gmsh.option.setNumber("Mesh.MeshSizeMin", size_mm * MM)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size_mm * MM)
    gmsh.model.mesh.generate(3)


def mesh_finer_near(faces, fine_mm, coarse_mm, reach_mm):
    """Edges grow from `fine` on the faces to `coarse` at the distance `reach`."""
    distance = gmsh.model.mesh.field.add("Distance")
    gmsh.model.mesh.field.setNumbers(distance, "SurfacesList", [tag for _, tag in faces])
    gmsh.model.mesh.field.setNumber(distance, "Sampling", 100)
    size = gmsh.model.mesh.field.add("Threshold")
    options = {"InField": distance, "SizeMin": fine_mm * MM, "SizeMax": coarse_mm * MM, "DistMin": 0, "DistMax": reach_mm * MM}
    for option, value in options.items():
        gmsh.model.mesh.field.setNumber(size, option, value)
    gmsh.model.mesh.field.setAsBackgroundMesh(size)
    for other_source in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{other_source}", 0)
    gmsh.model.mesh.generate(3)


def mesh_in_layers(cells_along):
    """A grid of tetrahedra in volumes with six faces; `cells_along` gives the cells on a curve of a length (m)."""
    for _, curve in gmsh.model.getEntities(1):
        cells = cells_along(gmsh.model.occ.getMass(1, curve))
        gmsh.model.mesh.setTransfiniteCurve(curve, cells + 1)
    for _, face in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(face)
    for _, volume in gmsh.model.getEntities(3):
        gmsh.model.mesh.setTransfiniteVolume(volume)
    gmsh.model.mesh.generate(3)


def points_and_tets():
    """Node coordinates and tetrahedra of the current mesh, both by tag (row 0 of the points is unused)."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = np.zeros((int(tags.max()) + 1, 3))
    points[tags] = coordinates.reshape(-1, 3)
    _, tets = gmsh.model.mesh.getElementsByType(4)
    return points, tets.reshape(-1, 4).astype(int)


def move(node, point):
    gmsh.model.mesh.setNode(node, point, [])


def flatten_tets(count, flatness):
    """Makes slivers: moves inner nodes across an edge almost into the plane of their opposite face.

    Of its height the tetrahedron keeps the fraction `flatness`; the others round the node lose at most 90 % of
    their volume. No two moved nodes share a tetrahedron.
    """
    points, tets = points_and_tets()
    inner = set(gmsh.model.mesh.getNodes(3)[0])
    flattened, touched = 0, set()
    for tet in tets:
        for corner in set(tet) & inner:
            star = tets[(tets == corner).any(axis=1)]
            face = points[[node for node in tet if node != corner]]
            foot, weights = projection(points[corner], face)
            across_an_edge = np.sort(weights)[0] < -0.1 and np.sort(weights)[1] > 0.1
            if flattened == count or touched & set(star.flat) or not across_an_edge:
                continue
            moved = points.copy()
            moved[corner] = foot + flatness * (points[corner] - foot)
            others = star[(star != tet).any(axis=1)]
            if np.all(volumes(moved, others) > 0.1 * volumes(points, others)):
                points = moved
                move(corner, points[corner])
                touched |= set(star.flat)
                flattened += 1
    assert flattened == count, f"only {flattened} of {count} slivers could be made"


def projection(point, triangle):
    """The foot of the point in the plane of the triangle, and the foot's barycentric coordinates."""
    edges = np.transpose(triangle[1:] - triangle[0])
    (s, t), *_ = np.linalg.lstsq(edges, point - triangle[0], rcond=None)
    return triangle[0] + edges @ (s, t), np.array([1 - s - t, s, t])


def open_crack(face_group, new_group, mouth_group):
    """Doubles the nodes of a face inside the volume, its mouth included and the rest of its rim not."""
    options = {
        "Dimension": 2,
        "PhysicalGroup": face_group,
        "NewPhysicalGroup": new_group,
        "OpenBoundaryPhysicalGroup": mouth_group,
    }
    for option, value in options.items():
        gmsh.plugin.setNumber("Crack", option, value)
    gmsh.plugin.run("Crack")


# ---------------------------------------------------------------------------------------------------------------------
# The meshes


@in_collection("beam", "bending: a slender cantilever, 100 x 10 x 10 mm")
def beam():
    tissue = box((0, 0, 0), (100, 10, 10))
    gmsh.model.occ.synchronize()
    faces = surface_of([tissue])
    clamped, tip = flat(faces, 0, 0), flat(faces, 0, 100)
    group("tissue", [tissue])
    group("clamped", clamped)
    group("tip", tip)
    group("sides", without(faces, clamped, tip))
    mesh_evenly(2.5)


@in_collection("vessel", "a thin wall under pressure: a tube 60 mm long, inner radius 10 mm, wall 1.5 mm")
def vessel():
    quarters = [difference(quarter_rod(11.5), quarter_rod(10))]
    for _ in range(3):
        [quarter] = gmsh.model.occ.copy(quarters[-1:])
        gmsh.model.occ.rotate([quarter], 0, 0, 0, 0, 0, 1, np.pi / 2)
        quarters.append(quarter)
    joined(*quarters)
    faces = surface_of(quarters)
    ends = flat(faces, 2, 0) + flat(faces, 2, 60)
    inner = [face for face in without(faces, ends) if gmsh.model.occ.getMass(*face) < 1000 * MM**2]
    group("wall", quarters)
    group("inner", inner)
    group("outer", without(faces, ends, inner))
    group("ends", ends)
    mesh_in_layers(lambda length: 2 if length < 2 * MM else 30 if length > 59 * MM else 10)


def quarter_rod(radius_mm):
    return cylinder((0, 0, 0), (0, 0, 60), radius_mm, angle=np.pi / 2)


@in_collection("organ", "a liver-like organ, 210 mm wide, that lies on its attachment, with a stiff tumour inside")
def organ():
    right_lobe = ellipsoid((-35, 0, 35), (65, 60, 50))
    left_lobe = ellipsoid((45, 12, 24), (65, 42, 30))
    [both], _ = gmsh.model.occ.fuse([right_lobe], [left_lobe])
    body = difference(both, box((-200, -200, -200), (200, 200, 0)))
    tumour = ellipsoid((-45, -10, 50), (18, 14, 14))
    pieces, inclusion = joined(body, tumour)
    capsule = surface_of(pieces)
    group("parenchyma", without(pieces, inclusion))
    group("inclusion", inclusion)
    group("capsule", capsule)
    group("attachment", flat(capsule, 2, 0))
    group("inclusion-surface", surface_of(inclusion))
    mesh_finer_near(surface_of(inclusion), 4, 11, 40)


@in_collection("layers", "layered tissue: skin 2 mm, fat 8 mm, muscle 20 mm, a slab of 60 x 60 mm")
def layers():
    heights = {"muscle": (0, 20), "fat": (20, 28), "skin": (28, 30)}
    slabs = joined(*(box((0, 0, low), (60, 60, high)) for low, high in heights.values()))
    faces = surface_of(sum(slabs, []))
    top, bottom = flat(faces, 2, 30), flat(faces, 2, 0)
    for name, slab in reversed(list(zip(heights, slabs))):
        group(name, slab)
    group("top", top)
    group("bottom", bottom)
    group("sides", without(faces, top, bottom))
    mesh_finer_near(top, 2.5, 6, 30)


@in_collection(
    "slivers",
    "bad elements: 16 tetrahedra flattened below 0.1 degrees, all positive",
    lambda mesh: mesh.coincident == 0 and np.sum(mesh.least_dihedrals < 0.1) == 16,
)
def slivers():
    tissue = box((0, 0, 0), (40, 40, 20))
    gmsh.model.occ.synchronize()
    faces = surface_of([tissue])
    group("tissue", [tissue])
    group("bottom", flat(faces, 2, 0))
    group("top", flat(faces, 2, 20))
    mesh_evenly(4)
    flatten_tets(16, 5e-4)


@in_collection(
    "needle",
    "many scales: the track of a needle 0.8 mm thick, 20 mm deep in a block of 60 x 60 x 40 mm",
    lambda mesh: mesh.coincident == 0 and mesh.edge_ratio >= 50,
)
def needle():
    block = box((-30, -30, 0), (30, 30, 40))
    shaft = cylinder((0, 0, 22), (0, 0, 18), 0.4)
    point = (3, gmsh.model.occ.addCone(0, 0, 20 * MM, 0, 0, 2 * MM, 0, 0.4 * MM))
    tissue = difference(block, shaft, point)
    gmsh.model.occ.synchronize()
    faces = surface_of([tissue])
    bottom, top = flat(faces, 2, 0), flat(faces, 2, 40)
    sides = [side for axis in (0, 1) for end in (-30, 30) for side in flat(faces, axis, end)]
    track = without(faces, bottom, top, sides)
    group("tissue", [tissue])
    group("track", track)
    group("bottom", bottom)
    group("top", top)
    mesh_finer_near(track, 0.3, 15, 30)


@in_collection(
    "incision",
    "a cut that can open: doubled nodes on both lips, 40 mm long, 8 mm deep in a block of 60 x 60 x 20 mm",
    lambda mesh: mesh.is_slit_between("lip-left", "lip-right"),
)
def incision():
    block = box((-30, -30, 0), (30, 30, 20))
    blade = (2, gmsh.model.occ.addDisk(0, 0, 20 * MM, 20 * MM, 8 * MM))
    gmsh.model.occ.rotate([blade], 0, 0, 20 * MM, 1, 0, 0, np.pi / 2)
    gmsh.model.occ.rotate([blade], 0, 0, 20 * MM, 0, 0, 1, np.pi / 2)
    [cut], _ = gmsh.model.occ.intersect([blade], [block], removeTool=False)
    [block], [cut] = joined(block, cut)
    mouth = [(dim, abs(tag)) for dim, tag in gmsh.model.getBoundary([cut]) if flat([(dim, abs(tag))], 2, 20)]
    group("tissue", [block])
    left = group("lip-left", [cut])
    right = left + 1
    bottom = flat(surface_of([block]), 2, 0)
    mesh_finer_near([cut], 2, 7, 30)
    mouth_group = gmsh.model.addPhysicalGroup(1, [tag for _, tag in mouth])
    open_crack(left, right, mouth_group)
    gmsh.model.removePhysicalGroups([(1, mouth_group)])
    gmsh.model.setPhysicalName(2, right, "lip-right")
    group("bottom", bottom)


@in_collection("paper-cube-mirrored", "the paper's cube with the cells mirrored: no direction is stiffer than its mirror image")
def paper_cube_mirrored(cells=10, edge=0.2):
    ticks = np.arange(cells + 1)
    k, j, i = (axis.ravel() for axis in np.meshgrid(ticks, ticks, ticks, indexing="ij"))
    grid = np.column_stack([i, j, k])
    cell_tets = [kuhn_tets(cell) for cell in grid[(grid < cells).all(axis=1)]]
    corners = np.concatenate(cell_tets)
    tets = 1 + corners @ [1, cells + 1, (cells + 1) ** 2]
    ...


if __name__ == "__main__":
    pass

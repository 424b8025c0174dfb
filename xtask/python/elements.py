"""Computes figures of the elements p1, fbar and fbar-edge a second time, on the meshes that gmsh made:

    pip install meshio==5.3.5 numpy scipy
    python xtask/python/elements.py

Rows of `cargo xtask verify` hold the library to what this prints. It shares no code with the library: patches are grown by
the rule as it is documented, energies are summed over sets of tetrahedra, and SciPy does the rest.
"""

from itertools import combinations
from pathlib import Path

import meshio
import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

MESHES = Path(__file__).resolve().parents[2] / "meshes"
SMALLEST_PATCH = 8
DENSITY = 1060
# Name, share of shear that is averaged over edges, whether the change of volume is averaged over patches.
ELEMENTS = [("p1", 0, False), ("fbar", 0, True), ("fbar-edge 1", 1, True), ("fbar-edge .9", 0.9, True)]


class Body:
    def __init__(self, name):
        file = meshio.read(MESHES / f"{name}.msh", file_format="gmsh")
        self.points, self.tets = file.points, file.cells_dict["tetra"]
        sides = self.points[self.tets[:, 1:]] - self.points[self.tets[:, :1]]
        self.volumes = np.linalg.det(sides) / 6
        slopes = np.linalg.inv(sides).transpose(0, 2, 1)
        self.slopes = np.concatenate([-slopes.sum(axis=1, keepdims=True), slopes], axis=1)
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        self.on_surface = (np.isclose(self.points, low) | np.isclose(self.points, high)).any(axis=1)
        self.masses = np.zeros(len(self.points))
        np.add.at(self.masses, self.tets, DENSITY * self.volumes[:, None] / 4)

    def edges(self):
        """The tetrahedra at each edge."""
        edges = {}
        for tet, nodes in enumerate(self.tets):
            for ends in combinations(sorted(nodes), 2):
                edges.setdefault(ends, []).append(tet)
        return list(edges.values())

    def patches(self, size):
        """Seeds in order; the face neighbour that shares most nodes with the patch, the first of them; small ones join."""
        faces = {}
        for tet, nodes in enumerate(self.tets):
            for face in combinations(sorted(nodes), 3):
                faces.setdefault(face, []).append(tet)
        neighbours = [set() for _ in self.tets]
        for pair in faces.values():
            if len(pair) == 2:
                neighbours[pair[0]].add(pair[1])
                neighbours[pair[1]].add(pair[0])
        patch_of, patches = np.full(len(self.tets), -1), []
        for seed in range(len(self.tets)):
            if patch_of[seed] >= 0:
                continue
            members, nodes, candidates = [], set(), {seed}
            while candidates and len(members) < size:
                tet = min(candidates, key=lambda tet: (-len(nodes & set(self.tets[tet])), tet))
                patch_of[tet] = len(patches)
                members.append(tet)
                nodes |= set(self.tets[tet])
                candidates = {tet for member in members for tet in neighbours[member] if patch_of[tet] < 0}
            patches.append(members)
        for number, members in enumerate(patches):
            shared = [patch_of[tet] for member in members for tet in neighbours[member] if patch_of[tet] != number]
            if len(members) < SMALLEST_PATCH and shared:
                other = min(set(shared), key=lambda patch: (-shared.count(patch), patch))
                patch_of[members] = other
                patches[other] = patches[other] + members
                patches[number] = []
        return [members for members in patches if members]

    def stiffness(self, sets, share, lame):
        """The sum over sets of tetrahedra of `V/2 (lambda tr^2 eps + 2 mu eps:eps)` of their mean strain, as a matrix."""
        rows, columns, entries = [], [], []
        for members in sets:
            volumes = share * self.volumes[members]
            nodes, places = np.unique(self.tets[members], return_inverse=True)
            slopes = np.zeros((len(nodes), 3))
            np.add.at(slopes, places.reshape(-1, 4), volumes[:, None, None] * self.slopes[members] / volumes.sum())
            block = lame[0] * np.einsum("ai,bj->aibj", slopes, slopes)
            block += lame[1] * np.einsum("aj,bi->aibj", slopes, slopes)
            block += lame[1] * np.einsum("ab,ij->aibj", slopes @ slopes.T, np.eye(3))
            dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
            rows.append(np.repeat(dofs, len(dofs)))
            columns.append(np.tile(dofs, len(dofs)))
            entries.append(volumes.sum() * block.ravel())
        places = np.concatenate(rows), np.concatenate(columns)
        return sparse.csr_matrix((np.concatenate(entries), places), shape=(3 * len(self.points),) * 2)

    def matrix(self, element, patches, young, nu):
        _, edge_share, has_patches = element
        lam, mu = lame(young, nu)
        each = [[tet] for tet in range(len(self.tets))]
        if not has_patches:
            return self.stiffness(each, 1, (lam, mu))
        matrix = self.stiffness(patches, 1, (lam, 0))
        if edge_share < 1:
            matrix += self.stiffness(each, 1, (0, (1 - edge_share) * mu))
        if edge_share > 0:
            matrix += self.stiffness(self.edges(), 1 / 6, (0, edge_share * mu))
        return matrix


def lame(young, nu):
    mu = young / (2 * (1 + nu))
    return 2 * mu * nu / (1 - 2 * nu), mu


def blocks(name, size):
    """Blocks in the row of a node none of whose tetrahedra is at the surface."""
    body = Body(name)
    outer = np.zeros(len(body.points), bool)
    outer[body.tets[body.on_surface[body.tets].any(axis=1)]] = True
    for element in ELEMENTS[:3]:
        matrix = body.matrix(element, body.patches(size), 1, 0.45).tobsr((3, 3))
        print(f"{name}, patches of {size}, {element[0]}: {np.diff(matrix.indptr)[~outer].mean():.2f} blocks of an inner row")


def steps(name, size):
    """The stable step of leapfrog over that of p1."""
    body = Body(name)
    scale = sparse.diags(np.repeat(body.masses, 3) ** -0.5)
    for nu in (0.3, 0.45, 0.499):
        def largest(element):
            matrix = scale @ body.matrix(element, body.patches(size), 3500, nu) @ scale
            return linalg.eigsh(matrix, k=1, which="LA", tol=1e-10, return_eigenvectors=False)[0]

        plain = largest(ELEMENTS[0])
        ratios = ", ".join(f"{element[0]} {np.sqrt(plain / largest(element)):.4f}" for element in ELEMENTS[1:])
        print(f"{name}, patches of {size}, nu {nu}, stable step over p1's: {ratios}")


def cantilever(name, size):
    """Work of a shear traction on the tip of a beam of 1 x 0.1 x 0.1 m along x, over that of Timoshenko's."""
    body, young, thickness = Body(name), 3500, 0.1
    free = np.repeat(body.points[:, 0] > 1e-9, 3)
    force = np.zeros(body.points.shape)
    corners = [list(face) for nodes in body.tets for face in combinations(nodes, 3)]
    for face in corners:
        places = body.points[face]
        if np.isclose(places[:, 0], 1).all():
            force[face, 2] += np.linalg.norm(np.cross(places[1] - places[0], places[2] - places[0])) / 6
    total, patches = force.sum(), body.patches(size)
    for nu in (0.3, 0.45, 0.49, 0.499):
        bending, shear = young * thickness**4 / 4, 5 / 6 * lame(young, nu)[1] * thickness**2
        ratios = []
        for element in ELEMENTS:
            matrix = body.matrix(element, patches, young, nu)[free][:, free]
            u = linalg.splu(matrix.tocsc()).solve(force.ravel()[free])
            ratio = u @ force.ravel()[free] / total**2 / (1 / bending + 1 / shear)
            ratios.append(f"{element[0]} {ratio:.4f}")
        print(f"{name}, patches of {size}, nu {nu}, deflection over Timoshenko's: {', '.join(ratios)}")


# Barycentric points and weights of degree 5 (Walkington, Quadrature on simplices of arbitrary dimension, 2000).
A, B, C = 0.31088591926330060980, 0.092735250310891226402, 0.045503704125649649492
POINTS = [np.insert([a] * 3, k, 1 - 3 * a) for a in (A, B) for k in range(4)]
POINTS += [np.where(np.isin(range(4), pair), C, 0.5 - C) for pair in combinations(range(4), 2)]
WEIGHTS = np.array([0.11268792571801585080] * 4 + [0.073493043116361949544] * 4 + [0.042546020777081466438] * 6)


def displacement(places):
    x, y, z = places.T
    hump, slope = lambda t: np.sin(np.pi * t) ** 2, lambda t: np.pi * np.sin(2 * np.pi * t)
    return np.stack([hump(x) * slope(y) * hump(z), -slope(x) * hump(y) * hump(z), 0 * x], axis=1)


def pressure(places):
    return 10 * np.cos(np.pi * places).prod(axis=1)


def body_force(places, mu, h=1e-3):
    """-mu div grad u + grad p by differences of fourth order."""
    force = np.zeros(places.shape)
    for axis in np.eye(3):
        u = [displacement(places + k * h * axis) for k in (-2, -1, 0, 1, 2)]
        force -= mu * (-u[0] + 16 * u[1] - 30 * u[2] + 16 * u[3] - u[4]) / (12 * h * h)
        p = [pressure(places + k * h * axis) for k in (-2, -1, 1, 2)]
        force += np.outer((p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * h), axis)
    return force


def manufactured(name, size):
    """Errors of the manufactured solution: of u at the nodes, of p at the centroids."""
    body, nu = Body(name), 0.4999
    lam, mu = lame(1, nu)
    load = np.zeros(body.points.shape)
    for point, weight in zip(POINTS, WEIGHTS / WEIGHTS.sum()):
        force = body_force(np.einsum("k,tki->ti", point, body.points[body.tets]), mu)
        for corner in range(4):
            share = weight * point[corner] * body.volumes
            np.add.at(load, body.tets[:, corner], share[:, None] * force)
    free = np.repeat(~body.on_surface, 3)
    exact = displacement(body.points).ravel()
    patches = body.patches(size)
    for element in ELEMENTS:
        matrix = body.matrix(element, patches, 1, nu)[free][:, free]
        u = np.zeros(exact.shape)
        u[free] = linalg.splu(matrix.tocsc()).solve(load.ravel()[free])
        dilation = np.einsum("tai,tai->t", body.slopes, u.reshape(-1, 3)[body.tets])
        for members in patches if element[2] else []:
            dilation[members] = np.average(dilation[members], weights=body.volumes[members])
        true = pressure(body.points[body.tets].mean(axis=1))
        of_p = np.sqrt((body.volumes * (-lam * dilation - true) ** 2).sum() / (body.volumes * true**2).sum())
        of_u = np.linalg.norm(u - exact) / np.linalg.norm(exact)
        print(f"{name}, patches of {size}, {element[0]}: error of u {of_u:.4f}, of p {of_p:.4f}")


if __name__ == "__main__":
    for mesh in ("cantilever-2", "cantilever-4"):
        cantilever(mesh, 8)
    for patch in (8, 12):
        blocks("cube-8", patch)
    for patch in (8, 12):
        steps("cube-8", patch)
    for patch in (8, 12):
        manufactured("cube-12", patch)

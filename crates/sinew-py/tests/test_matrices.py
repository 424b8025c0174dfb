"""Matrices of scenes are those of scikit-fem."""

import numpy as np
import pytest
from conftest import cube, oscillator

import sinew_sim as sn

skfem = pytest.importorskip("skfem")
scipy_spatial = pytest.importorskip("scipy.spatial")

SOFT, STIFF = (1060.0, 4000.0, 0.41), (1900.0, 50.0e3, 0.27)  # density, Young's modulus, Poisson's ratio


def distorted_mesh():
    """An unstructured mesh of tetrahedra of many shapes, with two regions and the triangles of its top."""
    rng = np.random.default_rng(3)
    box = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, 4)] * 3, indexing="ij"), -1).reshape(-1, 3)
    inner = (box > 0.0).all(1) & (box < 1.0).all(1)
    box[inner] += rng.uniform(-0.1, 0.1, (inner.sum(), 3))
    points = box * [0.07, 0.05, 0.04] + 0.003 * np.sin(20 * box[:, [1, 2, 0]])
    tets = scipy_spatial.Delaunay(points).simplices.astype(np.uint32)
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    tets = tets[abs(np.linalg.det(edges)) / 6 > 1e-9]
    used, tets = np.unique(tets, return_inverse=True)
    points, tets = points[used], tets.reshape(-1, 4)
    middles = points[tets].mean(1)
    stiff = np.flatnonzero(middles[:, 0] > 0.03)
    soft = np.flatnonzero(middles[:, 0] <= 0.03)
    faces = np.sort(tets[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3))
    faces, counts = np.unique(faces, axis=0, return_counts=True)
    outer = faces[counts == 1]
    top = outer[(points[outer][:, :, 2] > 0.032).all(1)]
    assert len(soft) > 20 and len(stiff) > 20 and len(top) > 4
    return sn.Mesh(points, tets, {"soft": soft, "stiff": stiff, "top": top})


def region(group, material):
    density, youngs_modulus, poissons_ratio = material
    law = {"model": "linear", "youngs_modulus": youngs_modulus, "poissons_ratio": poissons_ratio}
    return {"group": group, "density": density} | law


def scene_of(mesh, **tables):
    values = {
        "mesh": mesh,
        "region": [region("soft", SOFT), region("stiff", STIFF)],
        "damping": {"mass": 7.0, "stiffness": 3e-4},
        "run": {"duration": 0.1, "integrator": "newmark", "dt": 0.01},
    }
    return sn.Scene.from_dict(values | tables)


def assembled(mesh):
    """K by scikit-fem, and the lumped M, over all degrees of freedom of all nodes."""
    from skfem.helpers import ddot, eye, sym_grad, trace

    basis = skfem.Basis(
        skfem.MeshTet(mesh.points.T.copy(), mesh.tets.T.astype(int).copy(), validate=False, sort_t=False),
        skfem.ElementVector(skfem.ElementTetP1()),
    )
    mass, stiffness = np.zeros(len(mesh.points)), 0.0
    for name, (density, youngs_modulus, nu) in (("soft", SOFT), ("stiff", STIFF)):
        mu, lam = youngs_modulus / (2 * (1 + nu)), youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu))

        @skfem.BilinearForm
        def energy(u, v, w, mu=mu, lam=lam):
            strain = sym_grad(u)
            return ddot(2 * mu * strain + lam * eye(trace(strain), 3), sym_grad(v))

        own = mesh.groups[name].members
        stiffness = stiffness + energy.assemble(basis.with_elements(own))
        edges = mesh.points[mesh.tets[own, 1:]] - mesh.points[mesh.tets[own, :1]]
        for corner in range(4):
            np.add.at(mass, mesh.tets[own, corner], density * abs(np.linalg.det(edges)) / 24)
    dofs = basis.nodal_dofs.T.ravel()  # node by node: x, y, z
    return stiffness.tocsr()[dofs][:, dofs], np.repeat(mass, 3)


def close(a, b):
    a, b = (m.toarray() if hasattr(m, "toarray") else np.asarray(m) for m in (a, b))
    return a.shape == b.shape and abs(a - b).max() <= 1e-12 * abs(b).max()


def test_matrices_of_a_distorted_mesh():
    mesh = distorted_mesh()
    fixed = {"where": {"below": {"x": 0.001}}}
    matrices = scene_of(mesh, fixed=[fixed]).matrices()
    free = np.flatnonzero(mesh.points[:, 0] > 0.001)
    assert 0 < len(free) < len(mesh.points)
    stiffness, mass = assembled(mesh)
    assert sorted(set(matrices.nodes)) == list(free)
    dofs = 3 * matrices.nodes.astype(int) + matrices.axes
    assert len(set(dofs)) == 3 * len(free) and not matrices.held.any()
    stiffness, mass = stiffness[dofs][:, dofs], mass[dofs]
    assert close(matrices.K, stiffness)
    assert close(matrices.M, mass)
    assert close(matrices.D, 7.0 * np.diag(mass) + 3e-4 * stiffness.toarray())
    assert not matrices.F.any()


def test_matrices_of_a_free_body_have_no_strain_in_rigid_motions():
    mesh = distorted_mesh()
    matrices = scene_of(mesh).matrices()
    assert matrices.K.shape == (3 * len(mesh.points),) * 2
    at = mesh.points[matrices.nodes]
    for turn in np.eye(3):
        moves = (turn[matrices.axes], np.cross(turn, at)[np.arange(len(at)), matrices.axes])
        for move in moves:
            size = abs(matrices.K).max() * abs(move).max()
            assert abs(matrices.K @ move).max() < 1e-11 * size
    stiffness, mass = assembled(mesh)
    total = sum(matrices.M[matrices.axes == 0])
    assert total == pytest.approx(mass[::3].sum(), rel=1e-12)


def test_forces_of_gravity_and_traction():
    mesh = distorted_mesh()
    load = {"name": "push", "group": "top", "traction": [3.0, -5.0, 11.0]}
    matrices = scene_of(mesh, gravity=[0.3, 0.0, -9.81], load=[load]).matrices()
    _, mass = assembled(mesh)
    force = mass.reshape(-1, 3) * [0.3, 0.0, -9.81]
    for triangle in mesh.groups["top"].members:
        a, b, c = mesh.points[triangle]
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a))
        force[triangle] += area / 3 * np.array([3.0, -5.0, 11.0])
    assert close(matrices.F, force[matrices.nodes, matrices.axes])


def test_force_of_a_pressure_is_against_the_normal():
    mesh = distorted_mesh()
    matrices = scene_of(mesh, load=[{"group": "top", "pressure": 13.0}]).matrices()
    force = np.zeros_like(mesh.points)
    for triangle in mesh.groups["top"].members:
        a, b, c = mesh.points[triangle]
        (tet,) = np.flatnonzero(np.isin(mesh.tets, triangle).sum(1) == 3)
        inside = mesh.points[mesh.tets[tet]].mean(0)
        normal = 0.5 * np.cross(b - a, c - a)
        normal *= np.sign(normal @ (a - inside))
        force[triangle] -= 13.0 / 3 * normal
    assert close(matrices.F, force[matrices.nodes, matrices.axes])


def test_a_support_in_one_axis_holds_components():
    mesh = distorted_mesh()
    fixed = [{"where": {"below": {"x": 0.001}}}, {"group": "top", "axes": "z"}]
    matrices = scene_of(mesh, fixed=fixed, gravity=[0.0, 0.0, -9.81]).matrices()
    top = np.unique(mesh.groups["top"].members)
    slides = np.isin(matrices.nodes, top) & (matrices.axes == 2)
    assert slides.any()
    assert np.array_equal(matrices.held, slides)
    k, d = matrices.K.toarray(), matrices.D.toarray()
    assert not k[slides].any() and not k[:, slides].any() and not matrices.F[slides].any()
    moves = ~slides
    dofs = (3 * matrices.nodes.astype(int) + matrices.axes)[moves]
    stiffness, mass = assembled(mesh)
    stiffness, mass = stiffness[dofs][:, dofs].toarray(), mass[dofs]
    assert close(k[np.ix_(moves, moves)], stiffness)
    assert close(matrices.M[moves], mass)
    assert close(d[np.ix_(moves, moves)], 7.0 * np.diag(mass) + 3e-4 * stiffness)


def test_motion_by_the_matrices_is_that_of_a_session():
    """Central difference with mass damping, written down here."""
    mesh = distorted_mesh()
    fixed = [{"where": {"below": {"x": 0.001}}}]
    run = {"duration": 0.1, "integrator": "central-difference", "dt": 3e-5}
    scene = scene_of(mesh, fixed=fixed, gravity=[0.0, 0.0, -9.81], damping={"mass": 7.0}, run=run)
    matrices, sim = scene.matrices(), scene.session()
    assert sim.stable_step > 3e-5
    dt, half = sim.dt, 0.5 * sim.dt * 7.0
    # The first step is the method's own.
    before = sim.displacement[matrices.nodes, matrices.axes]
    assert not before.any()
    sim.step()
    u = sim.displacement[matrices.nodes, matrices.axes]
    assert np.allclose(u, 0.5 * dt**2 * matrices.F / matrices.M, rtol=2 * half, atol=1e-20)
    for _ in range(300):
        net = (matrices.F - matrices.K @ u) / matrices.M
        before, u = u, (2 * u - before * (1 - half) + dt**2 * net) / (1 + half)
    sim.step(300)
    own = sim.displacement[matrices.nodes, matrices.axes]
    assert abs(own - u).max() < 1e-11 * abs(u).max()


def test_largest_stable_step_is_that_of_the_matrices():
    scene = sn.Scene.from_dict(cube(damping={"mass": 0.0}))
    matrices = scene.matrices()
    values = np.linalg.eigvalsh(matrices.K.toarray() / np.sqrt(np.outer(matrices.M, matrices.M)))
    assert scene.stable_step() == pytest.approx(2 / np.sqrt(values.max()), rel=1e-2)


def test_an_oscillator_has_matrices_of_one():
    matrices = sn.Scene.from_dict(oscillator()).matrices()
    assert matrices.K.toarray() == 100.0 and matrices.D.toarray() == 1.0
    assert matrices.M == 0.1 and matrices.F == 0.0


def test_without_scipy_the_blocks_come_as_they_are(monkeypatch):
    scene = sn.Scene.from_dict(cube())
    whole = scene.matrices().K
    monkeypatch.setitem(__import__("sys").modules, "scipy.sparse", None)
    ends, columns, blocks = scene.matrices().K
    assert np.array_equal(blocks, whole.data)
    assert np.array_equal(columns, whole.indices) and np.array_equal(ends, whole.indptr)

"""Motion of soft bodies beside elements and steps that are written down here, in numpy alone."""

import numpy as np
import pytest
from conftest import cube

import sinew_sim as sn

E, NU, DENSITY, DAMPING, DT = 6000.0, 0.4, 1050.0, 12.0, 2e-4
MU, LAM = E / (2 * (1 + NU)), E * NU / ((1 + NU) * (1 - 2 * NU))
GRAVITY = np.array([1.0, -2.0, -9.81])


class Body:
    """Linear tetrahedra of a neo-Hookean law: mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2."""

    def __init__(self, points, tets):
        self.points, self.tets = points, tets
        edges = (points[tets[:, 1:]] - points[tets[:, :1]]).transpose(0, 2, 1)
        self.volumes = np.linalg.det(edges) / 6
        assert (self.volumes > 0).all()
        slopes = np.linalg.inv(edges)  # gradients of the last three shape functions, as rows
        self.slopes = np.concatenate([-slopes.sum(1, keepdims=True), slopes], axis=1)
        self.mass = np.zeros(len(points))
        np.add.at(self.mass, tets, np.repeat(DENSITY * self.volumes[:, None] / 4, 4, 1))

    def gradient(self, now):
        return np.einsum("tai,taj->tij", now[self.tets], self.slopes)

    def piola(self, f):
        j = np.linalg.det(f)[:, None, None]
        inverse = np.linalg.inv(f).transpose(0, 2, 1)
        return MU * (f - inverse) + LAM * (j - 1) * j * inverse

    def forces(self, now):
        nodal = -self.volumes[:, None, None] * np.einsum("tij,taj->tai", self.piola(self.gradient(now)), self.slopes)
        total = np.zeros_like(now)
        np.add.at(total, self.tets, nodal)
        return total

    def energy(self, now):
        f = self.gradient(now)
        j = np.linalg.det(f)
        density = MU / 2 * ((f**2).sum((1, 2)) - 3) - MU * np.log(j) + LAM / 2 * (j - 1) ** 2
        return (self.volumes * density).sum()

    def cauchy(self, now):
        f = self.gradient(now)
        stress = self.piola(f) @ f.transpose(0, 2, 1) / np.linalg.det(f)[:, None, None]
        return stress[:, [0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]


def scene(model="neo-hookean"):
    block = sn.Scene.from_dict(cube(mesh={"block": {"cells": [5, 3, 3], "size": [90.0, 50.0, 40.0]}})).mesh
    points = block.points + 3.0 * np.sin(block.points[:, [2, 0, 1]])  # mm, distorted
    mesh = sn.Mesh(points, block.tets, {"end": sn.Group(0, np.flatnonzero(block.points[:, 0] == 0.0))})
    region = {"density": DENSITY, "model": model, "youngs_modulus": E, "poissons_ratio": NU}
    return sn.Scene.from_dict({
        "gravity": GRAVITY,
        "mesh": {"file": mesh, "scale": 0.001, "rotate": {"axis": [1.0, 2.0, 3.0], "degrees": 40.0}},
        "region": [region],
        "fixed": [{"group": "end"}],
        "damping": {"mass": DAMPING},
        "run": {"duration": 0.2, "integrator": "central-difference", "dt": DT},
    })  # fmt: skip


def test_a_soft_body_moves_as_numpy_says():
    sim = scene().session()
    assert sim.dt == DT and sim.stable_step > DT
    body = Body(sim.mesh.points, sim.mesh.tets)
    held = np.isin(np.arange(len(body.points)), sim.mesh.groups["end"].members)
    assert 0 < held.sum() < len(held)
    tip = np.argmax(body.points @ (body.points[~held].mean(0) - body.points[held].mean(0)))
    pull = np.array([0.3, -0.2, 0.25])
    sim.force([tip], pull)
    outer = body.mass[:, None] * GRAVITY
    outer[tip] += pull
    # The first step from rest is the method's own.
    before = body.points
    sim.step()
    now, half = sim.positions.copy(), 0.5 * DT * DAMPING
    for _ in range(499):
        net = (body.forces(now) + outer) / body.mass[:, None]
        after = (2 * now - before * (1 - half) + DT**2 * net) / (1 + half)
        after[held] = body.points[held]
        before, now = now, after
    sim.step(499)
    moved = abs(sim.displacement).max()
    assert moved > 0.01
    assert abs(sim.positions - now).max() < 1e-9 * moved
    assert np.array_equal(sim.positions[held], body.points[held])
    assert sim.energy()["elastic_J"] == pytest.approx(body.energy(now), rel=1e-9)
    stress = body.cauchy(now)
    assert abs(sim.stress() - stress).max() < 1e-9 * abs(stress).max()


def test_a_soft_body_at_rest_under_forces_is_in_equilibrium():
    sim = scene().session()
    body = Body(sim.mesh.points, sim.mesh.tets)
    free = np.setdiff1d(np.arange(len(body.points)), sim.mesh.groups["end"].members)
    sim.switch("newmark", dt=0.02, beta=0.49, gamma=0.9, newton_tolerance=1e-10)
    forces = np.zeros((len(free), 3))
    forces[:, 1] = 2e-3
    sim.force(free, forces)
    sim.step(200)
    assert abs(sim.velocity).max() < 1e-8
    outer = body.mass[:, None] * GRAVITY
    outer[free] += forces
    inner = body.forces(sim.positions)
    assert abs((inner + outer)[free]).max() < 1e-7 * abs(inner).max()
    (force, _), = sim.reactions().values()
    assert np.allclose(force, -outer.sum(0), rtol=1e-6, atol=1e-8)


def test_energy_is_kept_without_damping():
    sim = scene().with_values({"damping.mass": 0.0, "gravity": [0.0, 0.0, 0.0]}).session()
    nodes = np.arange(len(sim.positions))
    sim.force(nodes, np.outer(sim.mesh.points[:, 0] > 0.02, [0.0, 0.004, 0.0]))
    sim.step(200)
    sim.force([], [])
    sim.step()
    before = sum(sim.energy()[key] for key in ("kinetic_J", "elastic_J"))
    found = []
    for _ in range(20):
        sim.step(50)
        found.append(sum(sim.energy()[key] for key in ("kinetic_J", "elastic_J")))
    assert before > 1e-6
    assert max(abs(np.array(found) / before - 1)) < 0.02

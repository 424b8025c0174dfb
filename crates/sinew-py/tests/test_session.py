"""Sessions: states are values, commands do what they say, and numbers agree with numpy."""

import gc

import numpy as np
import pytest
from conftest import block_to_cut, cube, oscillator, probed, python, soft

import sinew_sim as sn


def state(sim):
    """All that tells one state from another."""
    if sim.mesh is None:
        return [sim.t, sim.steps, sim.dt, *sim.energy().values()]
    fields = [sim.positions, sim.velocity, sim.stress(), sim.contact_force()]
    return [sim.t, sim.steps, sim.dt, sim.integrator, sim.log, *(field.tobytes() for field in fields)]


def pressed(sim, steps=20, from_step=0):
    """Moves the ball into the cube."""
    for k in range(from_step, from_step + steps):
        sim.tool("ball").move_to([0.05, 0.05, 0.131 - 0.0006 * k])
        sim.step()


SCENES = {
    "linear": cube(),
    "soft": soft(),
    "implicit": soft(run={"duration": 0.1, "integrator": "newmark", "dt": 0.005}),
    "single": cube(run={"duration": 0.1, "integrator": "central-difference", "dt": 0.001, "precision": "f32"}),
    "saturated": soft(run={"duration": 0.1, "integrator": "central-difference", "dt": 0.002, "saturation": 0.3}),
    "modal": cube(run={"duration": 0.1, "integrator": "modal", "dt": 0.005}),
    "network": cube(run={"duration": 0.1, "integrator": "cnn-stabilised", "dt": 0.005}),
    "polynomial": cube(run={"duration": 0.1, "integrator": "propagator", "dt": 0.01}),
    "relaxing": soft(
        region=[
            {"density": 1000.0, "model": "neo-hookean", "youngs_modulus": 5000.0, "poissons_ratio": 0.4}
            | {"prony": [[0.5, 0.05]]}
        ]
    ),
    "oscillator": oscillator(),
}


@pytest.mark.parametrize("name", SCENES)
def test_save_and_restore_in_mid_run_have_the_same_bits(name):
    scene = sn.Scene.from_dict(SCENES[name])
    sim = scene.session()
    sim.step(7)
    saved = sim.save()
    assert isinstance(saved, bytes)
    sim.step(9)
    sim.advance(0.3 * sim.dt)
    end = state(sim)
    sim.restore(saved)
    assert sim.steps == 7
    assert sim.save() == saved
    sim.step(9)
    sim.advance(0.3 * sim.dt)
    assert state(sim) == end
    # A session that has seen none of it.
    other = scene.session()
    other.restore(saved)
    other.step(9)
    other.advance(0.3 * other.dt)
    assert state(other) == end
    assert end != state(scene.session())


def test_a_state_goes_on_in_another_process():
    sim = sn.Scene.from_dict(probed()).session()
    pressed(sim, 10)
    saved = sim.save()
    pressed(sim, 15, from_step=10)
    text = """
import sys
from conftest import probed
from test_session import pressed, state
import sinew_sim as sn
sim = sn.Scene.from_dict(probed()).session()
sim.restore(sys.stdin.buffer.read() if len(sys.argv) < 2 else bytes.fromhex(open(sys.argv[1]).read()))
pressed(sim, 15, from_step=10)
print(sim.save().hex())
"""
    import tempfile

    with tempfile.NamedTemporaryFile("w", suffix=".hex") as file:
        file.write(saved.hex())
        file.flush()
        said = python(text, file.name)
    assert said.returncode == 0, said.stderr
    assert said.stdout.strip() == sim.save().hex()


@pytest.mark.parametrize("name", SCENES)
def test_reset_is_a_new_session(name):
    scene = sn.Scene.from_dict(SCENES[name])
    sim, new = scene.session(), scene.session()
    sim.step(5)
    sim.advance(2.5 * sim.dt)
    sim.reset()
    assert (sim.t, sim.steps) == (0.0, 0)
    assert state(sim) == state(new)
    sim.step(6), new.step(6)
    assert state(sim) == state(new)
    assert sim.log == new.log


def test_a_log_replays_with_the_same_bits():
    tool = {"name": "ball", "shape": {"sphere": {"radius": 0.03}}, "start": [0.05, 0.05, 0.131], "hold": True}
    scene = sn.Scene.from_dict(cube(4, tool=[tool]))
    sim = scene.session()
    pressed(sim, 10)
    sim.load("gravity").factor = 0.25
    sim.advance(0.0123)
    sim.force([3, 70], [[0.1, 0.0, 0.2], [0.0, -0.1, 0.0]])
    sim.tool("ball").grasp()
    pressed(sim, 5, from_step=10)
    sim.tool("ball").release()
    sim.switch("symplectic-euler", dt=0.0007)
    sim.step(11)
    again = scene.replay(sim.log)
    assert state(again) == state(sim)
    assert again.energy() == sim.energy()
    # It is a session that goes on.
    pressed(sim, 5, from_step=15), pressed(again, 5, from_step=15)
    assert state(again) == state(sim)
    again.reset()
    assert state(again) == state(scene.session())


def test_a_log_of_a_restored_session_replays():
    scene = sn.Scene.from_dict(probed())
    sim = scene.session()
    pressed(sim, 8)
    saved = sim.save()
    pressed(sim, 8)
    sim.restore(saved)
    pressed(sim, 3, from_step=8)
    assert state(scene.replay(sim.log)) == state(sim)


def test_advance_covers_a_time_by_steps_of_one_length(session):
    sim = session
    said = sim.advance(0.0105)
    assert (said.steps, said.shortened) == (11, pytest.approx(0.0105 / 11))
    assert sim.t == 0.0105 and sim.dt == 0.001
    said = sim.advance(by=0.0005)
    assert (said.steps, said.shortened) == (1, pytest.approx(0.0005))
    said = sim.advance(0.0)
    assert (said.steps, said.shortened) == (0, None)
    whole = session.scene.session()
    assert (whole.advance(0.02).steps, whole.advance(0.03).shortened) == (20, None)
    assert whole.steps == 50
    assert whole.t == pytest.approx(0.05, rel=1e-12)
    by_steps = session.scene.session()
    by_steps.step(20), by_steps.step(30)
    assert state(whole) == state(by_steps)


def test_advance_adds_up_to_the_time_asked_for(session):
    for k in range(1, 101):
        session.advance(by=0.0033)
    assert session.t == pytest.approx(0.33, abs=1e-14)


@pytest.mark.parametrize("integrator", ["newmark", "symplectic-euler", "rk4", "generalized-alpha", "cnn-stabilised"])
def test_a_switch_keeps_the_state(integrator, session):
    session.step(20)
    before, velocity = session.positions.copy(), session.velocity.copy()
    session.switch(integrator)
    assert session.integrator == integrator and session.dt == 0.001
    assert np.array_equal(session.positions, before)
    assert np.allclose(session.velocity, velocity, rtol=0, atol=0.02 * abs(velocity).max())
    session.step(30)
    other = session.scene.session()
    other.step(50)
    # All are approximations of one motion.
    scale = abs(other.displacement).max()
    assert abs(session.displacement - other.displacement).max() < 0.03 * scale
    session.switch("central-difference", dt=0.0005)
    assert session.dt == 0.0005
    session.step()


def test_a_switch_takes_options(session):
    session.switch("newmark", dt=0.01, beta=0.3025, gamma=0.6)
    session.step(100)
    plain = session.scene.session()
    plain.switch("newmark", dt=0.01)
    plain.step(100)
    assert session.energy()["kinetic_J"] < plain.energy()["kinetic_J"]


def test_factors_of_loads():
    load = {"name": "pull", "group": "top", "traction": [30.0, 0.0, 0.0]}
    scene = sn.Scene.from_dict(cube(load=[load], gravity=[0.0, 0.0, 0.0]))
    half = scene.with_values({"load.1.traction": [15.0, 0.0, 0.0]}).session()
    sim = scene.session()
    pull = sim.load("pull")
    assert sim.loads == ["pull", "gravity"] and pull.name == "pull" and pull.factor == 1.0
    pull.factor = 0.5
    assert sim.load("pull").factor == 0.5
    sim.step(50), half.step(50)
    assert np.array_equal(sim.positions, half.positions)
    pull.factor = 0.0
    before = sim.displacement.copy()
    sim.step(20)
    assert not np.array_equal(sim.displacement, before)
    sim.reset()
    assert pull.factor == 1.0


def test_forces_on_nodes_are_those_of_a_load():
    loads = [{"where": {"box": [[0.099, 0.099, 0.099], [0.101, 0.101, 0.101]]}, "force": [0.01, -0.02, 0.03]}]
    loaded = sn.Scene.from_dict(cube(load=loads)).session()
    sim = sn.Scene.from_dict(cube()).session()
    corner = len(sim.positions) - 1
    assert np.allclose(sim.positions[corner], 0.1)
    sim.force([corner], [0.01, -0.02, 0.03])
    sim.step(50), loaded.step(50)
    scale = abs(loaded.displacement).max()
    assert abs(sim.displacement - loaded.displacement).max() < 1e-12 * scale
    sim.force([], [])
    loaded.load("load 1").factor = 0.0
    sim.step(50), loaded.step(50)
    assert abs(sim.displacement - loaded.displacement).max() < 1e-12 * scale


def test_forces_are_in_equilibrium_with_reactions():
    sim = sn.Scene.from_dict(cube(gravity=[0.0, 0.0, 0.0])).session()
    rng = np.random.default_rng(1)
    points = sim.mesh.points
    nodes = np.flatnonzero(points[:, 2] > 0.05)
    forces = rng.normal(size=(len(nodes), 3)) * 1e-3
    sim.force(nodes, forces)
    sim.switch("newmark", dt=0.05, gamma=0.9, beta=0.49)
    sim.step(600)
    assert sim.energy()["kinetic_J"] < 1e-20
    force, moment = sim.reactions()["fixed_1_bottom"]
    assert np.allclose(force, -forces.sum(0), rtol=0, atol=1e-9)
    # About the middle of the bottom.
    about = points[points[:, 2] == 0.0].mean(0)
    assert np.allclose(moment, -np.cross(sim.mesh.points[nodes] - about, forces).sum(0), rtol=0, atol=1e-10)
    u = sim.displacement[nodes]
    assert sim.energy()["elastic_J"] == pytest.approx(0.5 * (forces * u).sum(), rel=1e-6)


def test_weight_is_held_by_the_support():
    sim = sn.Scene.from_dict(cube(initial=[{"static": ["gravity"]}])).session()
    sim.step(3)
    force, _ = sim.reactions()["fixed_1_bottom"]
    assert force[2] == pytest.approx(1000.0 * 0.001 * 9.81, rel=1e-9)
    assert sim.velocity == pytest.approx(0.0, abs=1e-12)


def test_forces_of_a_tool_and_of_nodes_are_in_balance():
    sim = sn.Scene.from_dict(probed()).session()
    tool = sim.tool("ball")
    assert sim.tools == ["ball"] and tool.contacts == 0 and tool.gap == pytest.approx(0.001)
    impulse, seen, dt = np.zeros(3), 0, sim.dt
    for k in range(40):
        place = [0.05 + 0.0001 * k, 0.05, 0.131 - 0.0008 * k]
        tool.move_to(place)
        sim.step()
        assert np.array_equal(tool.position, place)
        total = sim.contact_force().sum(0)
        assert np.allclose(total, -tool.force, rtol=1e-12, atol=1e-15)
        seen += tool.contacts > 0
        impulse += tool.force * dt
        # No node is inside, but for what rounding leaves.
        assert np.linalg.norm(sim.positions - place, axis=1).min() > 0.03 - 1e-6
    assert seen > 20 and tool.force[2] > 0.1
    assert np.allclose(tool.impulse, impulse, rtol=1e-12)
    assert tool.work == pytest.approx(sim.energy()["work_of_tools_J"]) and tool.work > 0
    assert abs(tool.gap) < 2e-5


def test_a_tool_turns():
    sim = sn.Scene.from_dict(probed()).session()
    tool = sim.tool("ball")
    tool.move_to([0.05, 0.05, 0.2], [0.0, 0.3, 0.0])
    sim.step()
    assert np.allclose(tool.rotation_vector, [0.0, 0.3, 0.0])
    tool.move_to([0.05, 0.05, 0.21])
    sim.step()
    assert np.allclose(tool.rotation_vector, [0.0, 0.3, 0.0])
    assert np.array_equal(tool.position, [0.05, 0.05, 0.21])


def test_jaws_hold_and_let_go():
    sim = sn.Scene.from_dict(probed(gravity=[0.0, 0.0, 0.0])).session()
    tool = sim.tool("ball")
    top = np.flatnonzero((abs(sim.mesh.points - [0.05, 0.05, 0.1]) < 1e-9).all(1))[0]
    tool.grasp()
    for k in range(10):
        tool.move_to([0.05, 0.05, 0.131 - 0.0005 * k])
        sim.step()
    for k in range(40):
        tool.move_to([0.05, 0.05, 0.1265 + 0.0005 * k])
        sim.step()
    assert sim.displacement[top][2] > 0.01
    assert tool.force[2] < 0.0 and tool.contacts > 0
    assert np.allclose(sim.contact_force().sum(0), -tool.force, atol=1e-15)
    tool.release()
    sim.step(300)
    assert tool.contacts == 0
    assert sim.displacement[top][2] < 0.005


def test_a_cut_changes_the_mesh_and_keeps_the_volume():
    sim = sn.Scene.from_dict(block_to_cut()).session()
    mesh = sim.mesh
    assert sim.topology_epoch == 0
    sim.step(2)
    sim.cut([[0.031, -0.01, -0.01], [0.031, -0.01, 0.03]], [[0.031, 0.021, -0.01], [0.031, 0.021, 0.03]])
    sim.step()
    assert sim.topology_epoch == 1
    assert len(sim.mesh.points) > len(mesh.points) and len(sim.mesh.tets) == len(mesh.tets)
    assert sim.mesh.volume == pytest.approx(mesh.volume, rel=1e-12)
    assert len(mesh.points) == 105  # the one that was taken before is as it was
    assert sim.positions.shape == sim.velocity.shape == sim.contact_force().shape == sim.mesh.points.shape
    assert sim.stress().shape == (len(sim.mesh.tets), 6)
    sim.step(20)
    saved, end = sim.save(), None
    sim.step(10)
    end = state(sim)
    for other in (sim, sim.scene.session()):
        epoch = other.topology_epoch
        other.restore(saved)
        assert other.topology_epoch > epoch
        other.step(10)
        assert state(other) == end
    assert state(sim.scene.replay(sim.log)) == end
    sim.reset()
    assert sim.positions.shape == mesh.points.shape and np.array_equal(sim.mesh.tets, mesh.tets)


def test_arrays_are_read_only(session):
    session.step()
    mesh = session.mesh
    for array in (session.positions, session.displacement, session.velocity, mesh.points, mesh.tets):
        assert not array.flags.writeable and array.flags.c_contiguous
        with pytest.raises(ValueError):
            array[0] = 0
    assert session.positions.dtype == np.float64 and mesh.tets.dtype == np.uint32


def test_arrays_are_of_the_moment_when_they_were_taken(session):
    session.step(3)
    before = session.positions
    copy = before.copy()
    session.step(3)
    assert np.array_equal(before, copy)
    assert not np.array_equal(session.positions, before)


def test_out_is_written_and_returned(session):
    session.step(5)
    nodes, tets = len(session.positions), len(session.mesh.tets)
    for ask, shape in (
        (session.stress, (tets, 6)),
        (session.strain, (tets, 6)),
        (session.von_mises, (tets,)),
        (session.contact_force, (nodes, 3)),
    ):
        out = np.full(shape, np.nan)
        assert ask(out=out) is out and ask(out) is out
        assert np.array_equal(out, ask())
    positions, displacement, velocity = (np.full((nodes, 3), np.nan) for _ in range(3))
    assert session.read_into(positions=positions, displacement=displacement, velocity=velocity) is None
    assert np.array_equal(positions, session.positions)
    assert np.array_equal(displacement, session.displacement)
    assert np.array_equal(velocity, session.velocity)
    assert np.allclose(positions - session.mesh.points, displacement, rtol=0, atol=1e-16)


def test_arrays_outlive_the_session():
    sim = sn.Scene.from_dict(probed()).session()
    pressed(sim, 10)
    mesh, tool, load = sim.mesh, sim.tool("ball"), sim.load("gravity")
    arrays = [sim.positions, sim.velocity, sim.stress(), sim.contact_force(), mesh.points, mesh.tets, mesh.groups["top"].members]
    force, moment = sim.reactions()["fixed_1_bottom"]
    arrays += [force, moment, tool.force, tool.position]
    copies = [array.copy() for array in arrays]
    del sim, mesh
    gc.collect()
    rubbish = [np.random.default_rng(k).random(100_000) for k in range(20)]
    for array, copy in zip(arrays, copies):
        assert np.array_equal(array, copy)
    assert len(rubbish) == 20
    # Tools and loads keep their session.
    tool.move_to([0.05, 0.05, 0.2])
    load.factor = 2.0
    assert load.factor == 2.0 and np.array_equal(tool.force, copies[-2])


def test_energies_are_those_of_numpy():
    scene = sn.Scene.from_dict(cube())
    matrices, sim = scene.matrices(), scene.session()
    sim.step(40)
    u = sim.displacement[matrices.nodes, matrices.axes]
    v = sim.velocity[matrices.nodes, matrices.axes]
    energy = sim.energy()
    assert energy["kinetic_J"] == pytest.approx(0.5 * v @ (matrices.M * v), rel=1e-9)
    assert energy["elastic_J"] == pytest.approx(0.5 * u @ (matrices.K @ u), rel=1e-9)
    assert energy["kinetic_J"] > 0 and energy["elastic_J"] > 0
    assert energy["work_of_tools_J"] == 0.0


def test_von_mises_is_that_of_numpy():
    sim = sn.Scene.from_dict(probed()).session()
    pressed(sim, 30)
    xx, yy, zz, xy, yz, zx = sim.stress().T
    squares = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + zx**2)
    assert np.allclose(sim.von_mises(), np.sqrt(squares), rtol=1e-12)
    assert sim.von_mises().max() > 100.0


def test_stress_and_strain_of_a_linear_body_are_those_of_numpy():
    sim = sn.Scene.from_dict(cube()).session()
    sim.step(40)
    points, tets, u = sim.mesh.points, sim.mesh.tets, sim.displacement
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    moved = u[tets[:, 1:]] - u[tets[:, :1]]
    gradient = np.linalg.solve(edges, moved)  # (tets, from x, of u)
    strain = 0.5 * (gradient + gradient.transpose(0, 2, 1))
    mu, lam = 5000.0 / 2.6, 5000.0 * 0.3 / (1.3 * 0.4)
    stress = 2 * mu * strain + lam * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    order = ([0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0])
    assert np.allclose(sim.strain(), strain[:, *order], rtol=0, atol=1e-12)
    assert np.allclose(sim.stress(), stress[:, *order], rtol=0, atol=1e-9 * abs(stress).max())


def test_stress_and_strain_of_a_soft_body_are_those_of_numpy():
    """Cauchy's stress of mu (b - 1) / J + lambda (J - 1) and its kin is symmetric; Green's strain is (F^T F - 1) / 2."""
    sim = sn.Scene.from_dict(probed()).session()
    pressed(sim, 30)
    points, tets, now = sim.mesh.points, sim.mesh.tets, sim.positions
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    moved = now[tets[:, 1:]] - now[tets[:, :1]]
    f = np.linalg.solve(edges, moved).transpose(0, 2, 1)
    strain = 0.5 * (f.transpose(0, 2, 1) @ f - np.eye(3))
    order = ([0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0])
    assert np.allclose(sim.strain(), strain[:, *order], rtol=0, atol=1e-12)


def test_an_oscillator_is_a_session():
    sim = sn.Scene.from_dict(oscillator()).session()
    sim.step(10)
    assert sim.mesh is None and sim.tools == [] and sim.reactions() == {}
    assert set(sim.energy()) == {"kinetic_J", "elastic_J", "work_of_tools_J"}
    with pytest.raises(ValueError, match="oscillator"):
        sim.positions


@pytest.mark.parametrize("values", [cube(5), soft(5)], ids=["linear", "soft"])
def test_no_other_scene_changes_a_session(values):
    """The memory that one scene may take is that of this scene: others go on with the same bits."""
    ends = []
    for memory in (None, 1e-3):
        sim = sn.Scene.from_dict(values).session()
        sim.step(3)
        if memory:
            run = {"duration": 0.1, "integrator": "central-difference", "dt": 0.001, "memory": memory}
            assert sn.Scene.from_dict(cube(2, run=run)).session().step() is None
        sim.switch("newmark", dt=0.01)
        sim.step(3)
        ends.append(sim.save())
    assert ends[0] == ends[1]

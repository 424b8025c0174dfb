"""Tests of sinew_sim.gym."""

from __future__ import annotations

import subprocess
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed: pip install 'sinew-sim[gym]'")

import sinew_sim as sn  # noqa: E402
import sinew_sim.gym  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402
from sinew_sim.gym import TASKS, policies  # noqa: E402
from sinew_sim.gym._parts import joins  # noqa: E402

ids = pytest.mark.parametrize("name", TASKS)
MANY_NODES = {"mesh.block.cells": [20, 13, 6]}


def run(env: Any, steps: int, seed: int = 3) -> list[Any]:
    """Observations and rewards of some steps of the scripted policy."""
    observation, _ = env.reset(seed=seed)
    policy = policies.scripted(env.unwrapped)
    found = [observation.tobytes()]
    for _ in range(steps):
        observation, reward, terminated, truncated, _ = env.step(policy(observation))
        found.append((observation.tobytes(), reward))
        if terminated or truncated:
            break
    return found


def test_the_package_alone_does_not_import_gymnasium() -> None:
    code = "import sys, sinew_sim; sys.exit('gymnasium' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


@ids
def test_gymnasium_finds_nothing_wrong(name: str) -> None:
    env = gymnasium.make(name).unwrapped
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # Velocities are in m/s and a place has no bounds: the checker would like actions in -1 to 1.
        warnings.filterwarnings("ignore", message=".*normalized space.*")
        warnings.filterwarnings("ignore", message=".*minimum value is -infinity.*")
        warnings.filterwarnings("ignore", message=".*maximum value is infinity.*")
        check_env(env, skip_render_check=True)


@ids
def test_the_same_seed_and_actions_give_the_same_bits(name: str) -> None:
    env = gymnasium.make(name, randomise=TASKS[name].VARIED)
    first = run(env, 22)
    assert run(env, 1, seed=4) != first[:2]
    assert run(env, 22) == first


@ids
def test_a_reset_without_random_values_gives_the_bits_of_a_new_session(name: str) -> None:
    env = gymnasium.make(name)
    task: Any = env.unwrapped
    first = run(env, 24)
    sim = task.sim
    assert run(env, 24) == first
    assert task.sim is sim
    assert run(gymnasium.make(name), 24) == first


@ids
def test_the_log_replays_with_the_same_bits(name: str) -> None:
    env = gymnasium.make(name)
    run(env, 24)
    task: Any = env.unwrapped
    replayed = task.scene.replay(task.sim.log)
    assert replayed.t == task.sim.t > 0.2
    assert replayed.positions.tobytes() == task.sim.positions.tobytes()
    for hand in task.HANDS:
        assert replayed.tool(hand.name).force.tobytes() == task.sim.tool(hand.name).force.tobytes()


def test_random_values_follow_the_seed_and_are_in_their_ranges() -> None:
    ranges = {"region.1.youngs_modulus": (2000.0, 8000.0), "tool.1.start": ([0.04, 0.02, 0.02], [0.05, 0.02, 0.03])}
    env = gymnasium.make("sinew/Retract-v0", randomise=ranges)
    task: Any = env.unwrapped
    found = []
    for seed in (1, 2, None, None, 1):
        _, info = env.reset(seed=seed)
        values = info["values"]
        assert 2000.0 <= values["region.1.youngs_modulus"] <= 8000.0
        assert 0.04 <= values["tool.1.start"][0] <= 0.05 and values["tool.1.start"][1] == 0.02
        scene = task.scene.as_dict()
        assert scene["region"][0]["youngs_modulus"] == values["region.1.youngs_modulus"]
        assert task.sim.tool("jaw").position.tolist() == values["tool.1.start"]
        found.append(values["region.1.youngs_modulus"])
    assert found[0] == found[4]
    assert len(set(found)) == 4


def test_values_by_hand_come_over_random_ones_for_one_episode() -> None:
    env = gymnasium.make("sinew/Retract-v0", randomise={"region.1.youngs_modulus": (2000.0, 3000.0)})
    _, info = env.reset(seed=1, options={"values": {"region.1.youngs_modulus": 7000.0}})
    assert info["values"] == {"region.1.youngs_modulus": 7000.0}
    assert env.unwrapped.scene.as_dict()["region"][0]["youngs_modulus"] == 7000.0  # type: ignore[attr-defined]
    _, info = env.reset(seed=1)
    assert 2000.0 <= info["values"]["region.1.youngs_modulus"] <= 3000.0


def test_a_session_is_built_only_where_values_change() -> None:
    env = gymnasium.make("sinew/Retract-v0")
    task: Any = env.unwrapped
    values = {"values": {"region.1.youngs_modulus": 7000.0}}
    env.reset(options=values)
    sim = task.sim
    env.reset(options=values)
    assert task.sim is sim
    env.reset()
    assert task.sim is not sim


@ids
def test_the_observation_has_the_marks_poses_forces_and_stress(name: str) -> None:
    env = gymnasium.make(name)
    run(env, 30)
    task: Any = env.unwrapped
    keep_closed = np.where(env.action_space.high == 1.0, 1.0, 0.0).astype(np.float32)  # type: ignore[attr-defined]
    observation = env.step(keep_closed)[0]
    value = dict(zip(task.names, observation))
    assert len(value) == len(task.names) == len(observation)
    size = 0.0
    for hand in task.HANDS:
        tool = task.sim.tool(hand.name)
        for number, axis in enumerate("xyz"):
            assert value[f"{hand.name}_force_{axis}_N"] == tool.force[number]
            assert value[f"{hand.name}_{axis}_m"] == tool.position[number]
            assert value[f"{hand.name}_r_{axis}_rad"] == tool.rotation_vector[number]
        size += float(np.abs(tool.force).sum())
    assert size > 1e-3
    assert value["von_mises_Pa"] == task.sim.von_mises().max() > 100.0
    rest = task.sim.mesh.points
    for mark, place in task.MARKS.items():
        node = ((rest - place) ** 2).sum(axis=1).argmin()
        assert [value[f"{mark}_{axis}_m"] for axis in "xyz"] == task.sim.positions[node].tolist()


def test_an_action_is_a_velocity_within_its_bounds_and_its_box() -> None:
    env = gymnasium.make("sinew/Retract-v0")
    env.reset()
    jaw = env.unwrapped.sim.tool("jaw")  # type: ignore[attr-defined]
    start = jaw.position
    env.step(np.array([0.05, -0.02, 0.0, -1.0], np.float32))
    assert jaw.position - start == pytest.approx([5e-4, -2e-4, 0.0], abs=1e-9)
    env.step(np.array([9.0, 0.0, 0.0, -1.0], np.float32))
    assert jaw.position[0] - start[0] == pytest.approx(1.5e-3, abs=1e-9)
    for _ in range(20):
        env.step(np.array([0.1, 0.0, 0.0, -1.0], np.float32))
    assert jaw.position[0] == 0.07


def test_the_lifted_piece_weighs_on_the_jaw() -> None:
    env = gymnasium.make("sinew/GraspLift-v0", steps=400)
    observation, _ = env.reset()
    task: Any = env.unwrapped
    policy = policies.scripted(task)
    over = False
    while not over:
        observation, _, terminated, truncated, info = env.step(policy(observation))
        over = terminated or truncated
    assert info["is_success"]
    jaw = task.sim.tool("jaw")
    for _ in range(3000):
        task.sim.step()
    weight = 1060.0 * task.scene.mesh.volume * 9.81
    assert jaw.force == pytest.approx([0.0, 0.0, -weight], abs=0.02 * weight)


@ids
def test_the_scripted_policy_succeeds(name: str) -> None:
    env = gymnasium.make(name, randomise=TASKS[name].VARIED)
    # One core, 90 s for all tests: examples/gym_policies.py takes 100 of each.
    episodes = {"sinew/Retract-v0": 6, "sinew/Dissect-v0": 1}.get(name, 10)
    successes = 0
    for seed in range(episodes):
        observation, _ = env.reset(seed=seed)
        policy = policies.scripted(env.unwrapped)  # type: ignore[arg-type]
        over = False
        while not over:
            observation, _, terminated, truncated, info = env.step(policy(observation))
            over = terminated or truncated
        assert terminated == info["is_success"] and info["outcome"] == "finished"
        successes += info["is_success"]
    assert successes == episodes


def test_doing_nothing_does_not_succeed_and_ends_after_the_steps() -> None:
    env = gymnasium.make("sinew/Retract-v0", steps=12)
    env.reset()
    still = np.zeros(4, np.float32)
    ends = [env.step(still)[2:4] for _ in range(12)]
    assert ends == [(False, False)] * 11 + [(False, True)]
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.unwrapped.step(still)


def test_the_error_is_that_of_steps_a_quarter_as_long() -> None:
    env = gymnasium.make("sinew/Retract-v0", error=True, steps=22)
    observation, _ = env.reset()
    task: Any = env.unwrapped
    policy = policies.scripted(task)
    errors = []
    for _ in range(22):
        observation, _, _, truncated, info = env.step(policy(observation))
        errors.append(info["error"])
    assert truncated and errors[:-1] == [None] * 21
    finer = task.scene.with_values({"run.dt": task.sim.dt / 4}).session()
    jaw, place, closed = finer.tool("jaw"), finer.tool("jaw").position, False
    for command in task._commands:
        if command.closed[0] != closed:
            closed = command.closed[0]
            (jaw.grasp if closed else jaw.release)()
        way = command.places[0] - place
        for step in range(1, 4 * task.substeps + 1):
            jaw.move_to(place + way * (step / (4 * task.substeps)))
            finer.step()
        place = command.places[0]
    difference = np.linalg.norm(task.sim.displacement - finer.displacement)
    assert errors[-1] == pytest.approx(difference / np.linalg.norm(finer.displacement), rel=1e-9)
    assert 0.0 < errors[-1] < 0.02
    assert task.trusted_error() == errors[-1]


def test_the_error_is_none_for_those_who_do_not_ask() -> None:
    env = gymnasium.make("sinew/Retract-v0", steps=1)
    _, info = env.reset()
    assert info["error"] is None and info["outcome"] == "running" and info["is_success"] is False
    info = env.step(np.zeros(4, np.float32))[4]
    assert info["error"] is None and info["outcome"] == "finished"
    assert 0.0 < float(info["pace"]) < 1e3


def test_the_error_takes_a_cut_body() -> None:
    env = gymnasium.make("sinew/Dissect-v0", steps=200)
    run(env, 36)
    task: Any = env.unwrapped
    assert len(task.sim.mesh.tets) < len(task.scene.mesh.tets)
    assert 0.0 < task.trusted_error() < 0.5


def test_a_motion_that_is_not_followed_ends_the_episode() -> None:
    env = gymnasium.make("sinew/Retract-v0", steps=20)
    # A step several times as long as the stable one.
    env.reset(options={"values": {"run.dt": 0.0025}})
    left = 20
    for _ in range(20):
        observation, reward, terminated, truncated, info = env.step(np.array([0.0, 0.0, -0.1, 1.0], np.float32))
        if terminated:
            break
        left -= 1
    assert terminated and not truncated
    assert info["outcome"] in ("diverged", "refused") and info["failure"] and not info["is_success"]
    assert reward == -2.0 * left
    assert np.isfinite(observation).all()
    observation, info = env.reset()
    assert info["outcome"] == "running"
    assert env.step(np.zeros(4, np.float32))[4]["outcome"] == "running"


def test_the_burner_frees_the_layer() -> None:
    env = gymnasium.make("sinew/Dissect-v0")
    observation, _ = env.reset()
    assert dict(zip(env.unwrapped.names, observation))["left"] == 1.0  # type: ignore[attr-defined]
    before = env.unwrapped.sim.mesh  # type: ignore[attr-defined]
    run(env, 45)
    task: Any = env.unwrapped
    left, harm = task.shares()
    assert 0.0 < left < 0.9 and harm < 0.05
    heights = task.sim.mesh.points[task.sim.mesh.tets, 2].mean(axis=1)
    old = before.points[before.tets, 2].mean(axis=1)
    inside = (heights > 0.003) & (heights < 0.006)
    assert left == inside.sum() / ((old > 0.003) & (old < 0.006)).sum()


def test_paths_of_tetrahedra() -> None:
    tets = np.array([[0, 1, 2, 3], [3, 4, 5, 6], [7, 8, 9, 10]], np.uint32)
    assert joins(tets, np.array([0]), np.array([6]))
    assert not joins(tets, np.array([0]), np.array([8]))
    assert not joins(tets, np.array([0]), np.array([99]))


def test_a_reset_takes_less_than_a_millisecond_at_2000_nodes() -> None:
    env = gymnasium.make("sinew/Retract-v0")
    options = {"values": MANY_NODES}
    env.reset(options=options)
    task: Any = env.unwrapped
    nodes = len(task.scene.mesh.points)
    assert 1900 <= nodes <= 2200
    times, whole = [], []
    for _ in range(20):
        env.step(np.array([0.0, 0.0, -0.1, -1.0], np.float32))
        begun = time.perf_counter()
        task.sim.reset()
        times.append(time.perf_counter() - begun)
        begun = time.perf_counter()
        env.reset(options=options)
        whole.append(time.perf_counter() - begun)
    print(f"reset at {nodes} nodes: session {1e3 * min(times):.2f} ms, environment {1e3 * min(whole):.2f} ms at best")
    assert np.median(times) < 5e-3
    assert np.median(whole) < 5e-3


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the memory in use is read from /proc, which is not here")
def test_memory_stays_flat_over_1000_resets() -> None:
    def resident() -> float:
        return int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 1e6

    env = gymnasium.make("sinew/Retract-v0")
    action = np.array([0.0, 0.0, -0.1, 1.0], np.float32)

    def resets(count: int) -> None:
        for _ in range(count):
            env.reset()
            env.step(action)

    resets(50)
    before = resident()
    resets(1000)
    assert resident() - before < 10.0


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"randomise": {"region.1.young": (1.0, 2.0)}}, "randomise: region.1.young: .*youngs_modulus"),
        ({"randomise": {"tool.9.start": ([0, 0, 0], [1, 1, 1])}}, "randomise: tool.9.start"),
        ({"randomise": {"region.1.youngs_modulus": (8000.0, 2000.0)}}, "the lowest first"),
        ({"randomise": {"region.1.youngs_modulus": (2000.0, np.inf)}}, "finite ends"),
        ({"randomise": {"region.1.youngs_modulus": 2000.0}}, "expected a pair"),
        ({"randomise": {"region.1.youngs_modulus": (1.0, 2.0, 3.0)}}, "expected a pair"),
        ({"randomise": {"tool.1.start": ([0.0, 0.0], [0.0, 0.0, 0.1])}}, "same length"),
        ({"randomise": {"region.1.youngs_modulus": (-1.0, 2000.0)}}, "youngs_modulus"),
        ({"randomise": {3: (1.0, 2.0)}}, "expected the key of a scene"),
        ({"randomise": {"tool.1.start": ([0.0, 0.0, 0.02], [0.5, 0.04, 0.03])}}, "the tool jaw starts at"),
        ({"steps": 0}, "steps: 0"),
        ({"render_mode": "human"}, "render_mode"),
    ],
)
def test_wrong_arguments_are_named(arguments: dict[str, Any], text: str) -> None:
    with pytest.raises(ValueError, match=text):
        sinew_sim.gym.Retract(**arguments)


def test_wrong_options_and_actions_are_named() -> None:
    task = sinew_sim.gym.Retract()
    with pytest.raises(gymnasium.error.ResetNeeded):
        task.step(np.zeros(4, np.float32))
    with pytest.raises(ValueError, match="options: unknown goal"):
        task.reset(options={"goal": 1})
    with pytest.raises(ValueError, match="expected a dictionary"):
        task.reset(options={"values": 3})
    with pytest.raises(ValueError, match="values: region.1.young"):
        task.reset(options={"values": {"region.1.young": 1.0}})
    with pytest.raises(ValueError, match="whole part of a control step"):
        task.reset(options={"values": {"run.dt": 0.0003}})
    task.reset()
    with pytest.raises(ValueError, match=r"action: expected the shape \(4,\), got \(3,\)"):
        task.step(np.zeros(3, np.float32))
    with pytest.raises(ValueError, match="finite"):
        task.step(np.array([0.0, np.nan, 0.0, 0.0], np.float32))
    assert task.step(np.zeros(4, np.float32))[4]["outcome"] == "running"


@ids
@pytest.mark.usefixtures("pictures")
def test_a_picture_shows_something(name: str) -> None:
    env = gymnasium.make(name, render_mode="rgb_array")
    env.reset()
    first: Any = env.render()
    assert first.dtype == np.uint8 and first.shape == (480, 640, 3)
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 50
    run(env, 5)
    second: Any = env.render()
    assert (first != second).any()
    env.close()


def test_pictures_without_pyvista_say_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(gymnasium.error.DependencyNotInstalled, match="sinew-sim\\[plot\\]"):
        gymnasium.make("sinew/Retract-v0", render_mode="rgb_array")


def test_an_episode_goes_on_as_a_session_of_its_scene() -> None:
    task = sinew_sim.gym.Retract()
    task.reset()
    assert isinstance(task.scene, sn.Scene) and isinstance(task.sim, sn.Session)
    assert task.sim.t == 0.0 and task.sim.dt * task.substeps == pytest.approx(0.01)

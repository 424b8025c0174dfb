"""Measures the policies of sinew_sim.gym: success, speed and error, for each task.

    python gym_policies.py --episodes 100

Episodes are randomised by `Task.VARIED`: half to twice the stiffness, and the starts of the tools. Speed is control steps of
10 ms for each second that the processor works, on one core, resets and trusted runs not counted. The error is that of
`info["error"]`: the displacements at the end of an episode against the same commands with steps a quarter as long.
"""

from __future__ import annotations

import argparse
import sys
import time
from typing import Any

import gymnasium
import numpy as np

import sinew_sim.gym
from sinew_sim.gym import Task, policies


def measure(name: str, is_scripted: bool, episodes: int, with_error: int, first: int) -> dict[str, Any]:
    """Successes, outcomes, control steps, seconds of the processor and errors of some episodes."""
    env = gymnasium.make(name, randomise=sinew_sim.gym.TASKS[name].VARIED)
    task = env.unwrapped
    assert isinstance(task, Task)
    successes, steps, seconds, failed = 0, 0, 0.0, 0
    errors: list[float] = []
    for episode in range(first, first + episodes):
        observation, info = env.reset(seed=episode)
        policy = policies.scripted(task) if is_scripted else policies.random(task, seed=episode)
        began, is_over = time.process_time(), False
        while not is_over:
            observation, _, terminated, truncated, info = env.step(policy(observation))
            steps += 1
            is_over = terminated or truncated
        seconds += time.process_time() - began
        successes += info["is_success"]
        print(f"\r{name}: {successes} of {episode + 1 - first}", end="", file=sys.stderr, flush=True)
        failed += info["outcome"] != "finished"
        if not info["is_success"] and is_scripted:
            print(f"    episode {episode}: no success, {info['outcome']}, {info['values']}", flush=True)
        if info["outcome"] == "finished" and len(errors) < with_error:
            errors.append(task.trusted_error())
    print(file=sys.stderr)
    assert task.scene.mesh is not None
    return {
        "nodes": len(task.scene.mesh.points),
        "successes": successes,
        "episodes": episodes,
        "failed": failed,
        "steps": steps / episodes,
        "speed": steps / seconds,
        "errors": errors,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tasks", nargs="*", default=list(sinew_sim.gym.TASKS), help="ids of tasks (default: all)")
    parser.add_argument("--episodes", type=int, default=100, help="episodes of the scripted policy")
    parser.add_argument("--random", type=int, default=20, help="episodes of the random policy")
    parser.add_argument("--errors", type=int, default=10, help="episodes, of each policy, of which the error is computed")
    parser.add_argument("--first", type=int, default=0, help="seed of the first episode")
    given = parser.parse_args()
    print("| task | nodes | policy | success | steps an episode | not followed | control steps / s / core | error: median, largest |")
    print("|---|---|---|---|---|---|---|---|")
    for name in given.tasks:
        for is_scripted in (True, False):
            count = given.episodes if is_scripted else given.random
            if not count:
                continue
            found = measure(name, is_scripted, count, given.errors, given.first)
            errors = found["errors"]
            error = f"{np.median(errors):.1e}, {np.max(errors):.1e} of {len(errors)}" if errors else "-"
            print(
                f"| `{name}` | {found['nodes']} | {'scripted' if is_scripted else 'random'} "
                f"| {found['successes']} of {found['episodes']} | {found['steps']:.0f} | {found['failed']} "
                f"| {found['speed']:.0f} | {error} |",
                flush=True,
            )


if __name__ == "__main__":
    main()

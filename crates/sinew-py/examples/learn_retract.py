"""Learns to draw back a flap, sinew/Retract-v0, by the cross-entropy method: numpy alone, a few minutes on two cores.

    python learn_retract.py             # some 6 minutes
    python learn_retract.py --quick     # a check that it works, not a result

A policy has 16 weights: the velocity along each axis is tanh of a weighted sum of the way from the jaw to the mark along that
axis, while the jaw holds nothing, the way from the mark to its goal, while it holds, and a constant for each of both cases;
the jaw does the same with the lengths of these ways. Each generation draws policies about a mean, lets each one act in an
episode with random stiffness and start, and takes mean and spread of the best ones. What was reached is then measured on
other episodes, and the curve goes to learn_retract.png.
"""

from __future__ import annotations

import argparse
import functools
import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from sinew_sim.gym import Retract

Floats = NDArray[np.float64]

#: Shape of the weights: entries of an action, features of each.
SHAPE = (4, 4)

#: Length (m) that counts as 1 in the features.
SCALE = 0.02


@functools.cache
def environment(steps: int) -> Any:
    """The environment of this process."""
    return gymnasium.make("sinew/Retract-v0", randomise=Retract.VARIED, steps=steps)


def features(task: Retract, observation: Floats) -> Floats:
    """The features of each entry of an action, (4, 4)."""
    value = dict(zip(task.names, observation))
    holds = value["jaw_holds"]
    approach = np.array([value[f"mark_{axis}_m"] - value[f"jaw_{axis}_m"] for axis in "xyz"]) / SCALE
    way = np.array([value[f"to_goal_{axis}_m"] for axis in "xyz"]) / SCALE
    ways = [(1.0 - holds) * np.append(approach, np.linalg.norm(approach)), holds * np.append(way, np.linalg.norm(way))]
    return np.stack([*ways, np.full(4, 1.0 - holds), np.full(4, holds)], axis=1)


def episode(weights: Floats, seed: int, steps: int) -> tuple[float, bool]:
    """The sum of the rewards of an episode, and whether it succeeded."""
    env = environment(steps)
    task = env.unwrapped
    observation, info = env.reset(seed=seed)
    total, is_over = 0.0, False
    while not is_over:
        action = task.action_space.high * np.tanh((weights * features(task, observation)).sum(axis=1))
        observation, reward, terminated, truncated, info = env.step(action.astype(np.float32))
        total += reward
        is_over = terminated or truncated
    return total, info["is_success"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="two small generations of short episodes")
    parser.add_argument("--cores", type=int, default=2, help="processes")
    parser.add_argument("--minutes", type=float, default=8.0, help="no generation begins after this time")
    parser.add_argument("--out", default="learn_retract.png", help="picture of the curve")
    given = parser.parse_args()
    generations, population, elite, steps, trials = (2, 6, 2, 30, 2) if given.quick else (24, 20, 5, 100, 20)

    began = time.perf_counter()
    random = np.random.default_rng(1)
    mean, spread = np.zeros(SHAPE), np.ones(SHAPE)
    curve: list[tuple[float, float, float]] = []
    with ProcessPoolExecutor(given.cores, mp_context=multiprocessing.get_context("spawn")) as pool:

        def act(policies: list[Floats], seeds: list[int]) -> tuple[Floats, Floats]:
            found = list(pool.map(episode, policies, seeds, [steps] * len(seeds)))
            return np.array([total for total, _ in found]), np.array([float(success) for _, success in found])

        for generation in range(generations):
            if time.perf_counter() - began > 60.0 * given.minutes:
                break
            drawn = [mean + spread * random.standard_normal(SHAPE) for _ in range(population)]
            totals, successes = act(drawn, [generation] * population)
            best = np.array([drawn[number] for number in np.argsort(totals)[-elite:]])
            mean, spread = best.mean(axis=0), best.std(axis=0) + 0.3 * 0.8**generation
            curve.append((float(totals.mean()), float(totals.max()), float(successes.mean())))
            print(
                f"generation {generation}: sum of rewards {totals.mean():.1f} in the mean, {totals.max():.1f} at best; "
                f"success {successes.mean():.0%}, after {time.perf_counter() - began:.0f} s",
                flush=True,
            )
        seeds = [1000 + number for number in range(trials)]
        totals, successes = act([mean] * trials, seeds)
        nothing, _ = act([np.zeros(SHAPE)] * trials, seeds)
    print(
        f"learned: success in {int(successes.sum())} of {trials} other episodes, sum of rewards {totals.mean():.1f} "
        f"(doing nothing: {nothing.mean():.1f}), in {time.perf_counter() - began:.0f} s on {given.cores} cores"
    )
    draw(np.array(curve), given.out)


def draw(curve: Floats, path: str) -> None:
    """Draws the sums of rewards and the successes of each generation."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (above, below) = pyplot.subplots(2, 1, sharex=True, figsize=(6.0, 5.0), layout="constrained")
    above.plot(curve[:, 0], label="mean of the generation")
    above.plot(curve[:, 1], label="best")
    above.set_ylabel("sum of rewards")
    above.legend()
    below.plot(100.0 * curve[:, 2], color="tab:green")
    below.set_ylabel("success (%)")
    below.set_ylim(0.0, 100.0)
    below.set_xlabel("generation")
    figure.suptitle("sinew/Retract-v0, cross-entropy method")
    figure.savefig(path, dpi=120)
    print(f"wrote {path}")


if __name__ == "__main__":
    main()

"""A sweep as an array job of Slurm, which needs nothing but a shared folder.

    sbatch sweep_slurm.sh                            # each task: python sweep_slurm.py run sweep-results
    python sweep_slurm.py gather sweep-results       # a table of all runs, and of those that are missing
    python sweep_slurm.py run sweep-results          # without Slurm: all runs, one after the other

A task writes a folder for each of its runs. Folders of finished runs are kept, so the job can be submitted again after a
failure. --quick takes fewer and smaller runs; give it to both commands.
"""

import argparse
import os
import sys
from pathlib import Path

import sinew_sim as sn


def sweep(quick: bool) -> tuple[sn.Scene, list[dict[str, float]]]:
    """The scene, and the values of each run: the same for all tasks."""
    cells, runs = (4, 4) if quick else (8, 32)
    scene = sn.Scene.from_dict({
        "mesh": {"cube": {"cells": cells, "edge": 0.1}},
        "region": [{"density": 1060.0, "model": "neo-hookean", "youngs_modulus": 3500.0, "poissons_ratio": 0.45}],
        "fixed": [{"group": "bottom"}],
        "gravity": [0.0, 0.0, -9.81],
        "damping": {"mass": 20.0},
        "probe": [{"name": "top", "point": [0.05, 0.05, 0.1]}],
        "run": {"duration": 0.5, "integrator": "central-difference", "dt": "auto"},
        "output": {"fields": {"frames": 1}},
    })  # fmt: skip
    return scene, [{"region.1.youngs_modulus": 3000.0 + 6000.0 * run / (runs - 1)} for run in range(runs)]


def result(folder: Path) -> sn.Result | None:
    """The result in a folder; None if its run has not ended."""
    try:
        return sn.open(folder)
    except FileNotFoundError:
        return None


def run(folder: Path, quick: bool) -> None:
    """Runs this task's part of the sweep."""
    task, tasks = int(os.environ.get("SLURM_ARRAY_TASK_ID", 0)), int(os.environ.get("SLURM_ARRAY_TASK_COUNT", 1))
    scene, sets = sweep(quick)
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(task, len(sets), tasks):
        own = folder / f"run-{number:04}"
        if result(own) is not None:
            print(f"{own}: kept")
            continue
        try:
            # again: what a killed task left of this run is replaced.
            ended = scene.with_values(sets[number]).run(own, threads=1, again=True)
            print(f"{own}: {ended.outcome}")
        except ValueError as error:
            print(f"{own}: refused: {error}", file=sys.stderr)


def gather(folder: Path, quick: bool) -> int:
    """Prints a table of all runs, and returns how many are missing."""
    _, sets = sweep(quick)
    missing = 0
    print("run,youngs_modulus_Pa,outcome,top_u_z_m")
    for number, values in enumerate(sets):
        found = result(folder / f"run-{number:04}")
        outcome, sinks = ("missing", "") if found is None else (found.outcome, f"{found.probes['top'][-1, 2]:.6f}")
        missing += found is None
        print(f"{number},{values['region.1.youngs_modulus']:.1f},{outcome},{sinks}")
    return missing


def main() -> None:
    parser = argparse.ArgumentParser(description="A sweep as an array job of Slurm.")
    parser.add_argument("command", choices=["run", "gather"])
    parser.add_argument("folder", type=Path, help="a folder that all tasks see")
    parser.add_argument("--quick", action="store_true", help="fewer and smaller runs")
    asked = parser.parse_args()
    if asked.command == "run":
        run(asked.folder, asked.quick)
    elif missing := gather(asked.folder, asked.quick):
        sys.exit(f"{missing} runs are missing: submit the job again")


if __name__ == "__main__":
    main()

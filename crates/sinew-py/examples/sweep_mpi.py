"""A sweep on all nodes of an MPI job.

    mpiexec -n 5 python -m mpi4py.futures sweep_mpi.py

Rank 0 gives out the runs, and the other ranks compute them: -n 5 computes four runs at a time. Needs mpi4py.
"""

import sys
import time

from mpi4py.futures import MPIPoolExecutor  # type: ignore[import-not-found, unused-ignore]

import sinew_sim as sn

QUICK = "--quick" in sys.argv
CELLS, RUNS = (4, 4) if QUICK else (8, 16)

if __name__ == "__main__":
    scene = sn.Scene.from_dict({
        "mesh": {"cube": {"cells": CELLS, "edge": 0.1}},
        "region": [{"density": 1060.0, "model": "neo-hookean", "youngs_modulus": 3500.0, "poissons_ratio": 0.45}],
        "fixed": [{"group": "bottom"}],
        "gravity": [0.0, 0.0, -9.81],
        "damping": {"mass": 20.0},
        "probe": [{"name": "top", "point": [0.05, 0.05, 0.1]}],
        "run": {"duration": 0.5, "integrator": "central-difference", "dt": "auto"},
    })  # fmt: skip
    moduli = [3000.0 + 6000.0 * run / (RUNS - 1) for run in range(RUNS)]
    begun = time.perf_counter()
    with MPIPoolExecutor() as executor:
        results = sn.sweep(scene, {"region.1.youngs_modulus": moduli}, executor=executor)
    for modulus, result in zip(moduli, results):
        if isinstance(result, sn.Lost):
            print(f"{modulus:7.0f} Pa: {result.outcome}: {result.reason}")
        else:
            print(f"{modulus:7.0f} Pa: the top sinks by {-1e3 * result.probes['top'][-1, 2]:.2f} mm")
    print(f"{RUNS} runs in {time.perf_counter() - begun:.1f} s")

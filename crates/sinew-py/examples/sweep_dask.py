"""A sweep on a Dask cluster: here two processes of this computer, elsewhere any cluster that Dask has a client for.

    python sweep_dask.py [--quick]

Needs dask and distributed. One thread for each worker: a run takes one core.
"""

import sys
import time

from dask.distributed import Client, LocalCluster  # type: ignore[import-not-found, unused-ignore]

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
    # On a cluster: Client("tcp://scheduler:8786"), or dask_jobqueue.SLURMCluster in place of LocalCluster.
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0")  # type: ignore[no-untyped-call, unused-ignore]
    client = Client(cluster)  # type: ignore[no-untyped-call, unused-ignore]
    with cluster, client:
        begun = time.perf_counter()
        results = sn.sweep(scene, {"region.1.youngs_modulus": moduli}, executor=client.get_executor())  # type: ignore[no-untyped-call, unused-ignore]
        took = time.perf_counter() - begun
    for modulus, result in zip(moduli, results):
        if isinstance(result, sn.Lost):
            print(f"{modulus:7.0f} Pa: {result.outcome}: {result.reason}")
        else:
            print(f"{modulus:7.0f} Pa: the top sinks by {-1e3 * result.probes['top'][-1, 2]:.2f} mm")
    print(f"{RUNS} runs in {took:.1f} s")

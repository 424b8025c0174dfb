"""Sweeps: order, refused values, lost processes and executors."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import pathlib
import pickle
import shutil
import signal
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest

import sinew_sim as sn
from sinew_sim import _sweep

KEY = "region.1.youngs_modulus"
MODULI = [2000.0, 4000.0, 8000.0, 3000.0, 5000.0]
LONG = 1e5  # s of simulated time: no run of a test comes to its end


@pytest.fixture(scope="module")
def scene() -> sn.Scene:
    return sn.Scene.from_dict({
        "mesh": {"cube": {"cells": 3, "edge": 0.1}},
        "region": [{"density": 1060.0, "model": "neo-hookean", "youngs_modulus": 3500.0, "poissons_ratio": 0.4}],
        "fixed": [{"group": "bottom"}],
        "damping": {"mass": 20.0},
        "gravity": [0.0, 0.0, -9.81],
        "probe": [{"name": "top", "point": [0.05, 0.05, 0.1]}],
        "run": {"duration": 0.1, "integrator": "central-difference", "dt": 0.002},
    })  # fmt: skip


@pytest.fixture(scope="module")
def direct(scene: sn.Scene) -> list[sn.Result]:
    return [scene.with_values({KEY: modulus}).run() for modulus in MODULI]


def check(results: list[sn.Result | sn.Lost], direct: list[sn.Result]) -> None:
    """Results in the order of the values, with the bits of direct runs."""
    assert [result.outcome for result in results] == ["finished"] * len(MODULI)
    assert [result.values for result in results] == [{KEY: modulus} for modulus in MODULI]
    for result, own in zip(results, direct):
        assert isinstance(result, sn.Result)
        assert result.t.tobytes() == own.t.tobytes()
        assert result.probes["top"].tobytes() == own.probes["top"].tobytes()
        assert result.energy["elastic_J"].tobytes() == own.energy["elastic_J"].tobytes()


def exit_at_4000(scene_bytes: bytes, values: dict[str, Any]) -> Any:
    """A run whose process ends in mid-run for one value."""
    if values[KEY] == 4000.0:
        scene = pickle.loads(scene_bytes).with_values({"run.duration": LONG})
        scene.run(progress=lambda t, _: os._exit(3) if t > 0.0 else None)
    return _sweep._run(scene_bytes, values)


class Exiting(_sweep._Processes):
    def submit(self, call: Any, /, *args: Any, **kwargs: Any) -> Any:
        return super().submit(exit_at_4000, *args)


def test_processes_give_the_bits_of_direct_runs_in_order(scene: sn.Scene, direct: list[sn.Result]) -> None:
    check(sn.sweep(scene, {KEY: MODULI}, workers=2), direct)
    check(sn.sweep(scene, [{KEY: modulus} for modulus in MODULI]), direct)


def test_values_come_as_arrays_generators_and_several_keys(scene: sn.Scene, direct: list[sn.Result]) -> None:
    first, second = sn.sweep(scene, {KEY: np.array(MODULI[:2]), "gravity": np.array([[0.0, 0.0, -9.81]] * 2)}, workers=1)
    assert isinstance(first, sn.Result) and isinstance(second, sn.Result)
    assert second.probes["top"].tobytes() == direct[1].probes["top"].tobytes()
    (third,) = sn.sweep(scene, ({KEY: modulus} for modulus in MODULI[2:3]), workers=1)
    assert isinstance(third, sn.Result)
    assert third.probes["top"].tobytes() == direct[2].probes["top"].tobytes()


def test_any_executor_runs_a_sweep(scene: sn.Scene, direct: list[sn.Result]) -> None:
    with concurrent.futures.ThreadPoolExecutor(2) as threads:
        check(sn.sweep(scene, {KEY: MODULI}, executor=threads), direct)
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as processes:
        check(sn.sweep(scene, {KEY: MODULI}, executor=processes), direct)


def test_dask(scene: sn.Scene, direct: list[sn.Result], tmp_path: pathlib.Path) -> None:
    distributed = pytest.importorskip("dask.distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=":0", local_directory=tmp_path
    )
    with cluster, distributed.Client(cluster) as client:
        check(sn.sweep(scene, {KEY: MODULI}, executor=client.get_executor()), direct)
        lost = sn.sweep(scene, {KEY: [-1.0]}, executor=client.get_executor())
        assert lost[0].outcome == "refused"


def test_mpi(scene: sn.Scene, direct: list[sn.Result], tmp_path: pathlib.Path) -> None:
    pytest.importorskip("mpi4py")
    beside = os.path.dirname(sys.executable) + os.pathsep + os.environ["PATH"]
    mpiexec = shutil.which("mpiexec", path=beside)
    if mpiexec is None:
        pytest.skip("mpi4py is there, and mpiexec is not")
    script, asked, out = tmp_path / "sweep.py", tmp_path / "asked", tmp_path / "results"
    script.write_text(
        "import pathlib, pickle, sys, sinew_sim as sn\n"
        "from mpi4py.futures import MPIPoolExecutor\n"
        "if __name__ == '__main__':\n"
        "    asked, out = map(pathlib.Path, sys.argv[1:])\n"
        "    scene, values = pickle.loads(asked.read_bytes())\n"
        "    with MPIPoolExecutor() as executor:\n"
        "        out.write_bytes(pickle.dumps(sn.sweep(scene, values, executor=executor)))\n"
    )
    asked.write_bytes(pickle.dumps((scene, {KEY: MODULI})))
    # Open MPI refuses more ranks than cores, and the superuser, unless it is told.
    allowed = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    allowed |= {"PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    command = [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", *map(str, (script, asked, out))]
    ended = subprocess.run(command, env=os.environ | allowed, capture_output=True, timeout=60)
    assert ended.returncode == 0, ended.stderr.decode()
    check(pickle.loads(out.read_bytes()), direct)


def test_refused_values_are_named_with_the_reason(scene: sn.Scene) -> None:
    good, bad, unknown = sn.sweep(scene, [{KEY: 4000.0}, {KEY: -1.0}, {"region.1.colour": 1.0}], workers=1)
    assert good.outcome == "finished"
    for lost, word in ((bad, "youngs_modulus = -1"), (unknown, "colour")):
        assert isinstance(lost, sn.Lost)
        assert lost.outcome == "refused"
        assert word in lost.reason and lost.reason.startswith("SceneError: ")
    assert bad.values == {KEY: -1.0}


def test_a_process_that_ends_in_mid_run_costs_its_run_alone(scene: sn.Scene, direct: list[sn.Result]) -> None:
    with Exiting(2) as executor:
        results = sn.sweep(scene, {KEY: MODULI}, executor=executor)
    lost = results[1]
    assert isinstance(lost, sn.Lost)
    assert (lost.outcome, lost.values) == ("lost", {KEY: 4000.0})
    assert "exit code 3" in lost.reason
    for number in (0, 2, 3, 4):
        result = results[number]
        assert isinstance(result, sn.Result)
        assert result.probes["top"].tobytes() == direct[number].probes["top"].tobytes()


def test_a_killed_process_costs_its_run_alone(scene: sn.Scene) -> None:
    values = {"run.duration": [0.1, LONG, 0.1, 0.1]}
    with _sweep._Processes(2) as executor:
        threading.Thread(target=kill_the_last, args=(executor,)).start()
        results = sn.sweep(scene, values, executor=executor)
    assert [result.outcome for result in results] == ["finished", "lost", "finished", "finished"]
    assert results[1].values == {"run.duration": LONG}
    assert isinstance(results[1], sn.Lost) and "SIGKILL" in results[1].reason


def kill_the_last(executor: _sweep._Processes) -> None:
    """Kills the process that still computes once the other one has been idle for a second."""

    def ticks(process: Any) -> int:
        stat = pathlib.Path(f"/proc/{process.pid}/stat").read_text()
        return int(stat.rsplit(")", 1)[1].split()[11])

    before, since = [0, 0], time.monotonic()
    while time.monotonic() < since + 1.0:
        time.sleep(0.1)
        if len(executor._all) < 2 or executor._idle.qsize() != 1:
            since = time.monotonic()
        else:
            before = before if since < time.monotonic() - 0.5 else [ticks(process) for process in executor._all]
    grown = [ticks(process) - own for process, own in zip(executor._all, before)]
    os.kill(executor._all[grown.index(max(grown))].pid, signal.SIGKILL)


def test_a_broken_pool_of_the_caller_names_what_it_lost(scene: sn.Scene) -> None:
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as processes:
        for number in range(2):  # the second sweep meets a pool that takes nothing more
            if number == 0:
                processes.submit(os._exit, 3)
            results = sn.sweep(scene, {KEY: MODULI}, executor=processes)
            assert [result.values for result in results] == [{KEY: modulus} for modulus in MODULI]
            assert all(isinstance(lost, sn.Lost) and "BrokenProcessPool" in lost.reason for lost in results)


def test_ctrl_c_ends_all_processes(scene: sn.Scene, tmp_path: pathlib.Path) -> None:
    code = (
        "import pickle, sys, sinew_sim as sn\n"
        "scene = pickle.load(sys.stdin.buffer)\n"
        "print('begun', flush=True)\n"
        f"sn.sweep(scene, {{'run.duration': [{LONG}] * 4}}, workers=2)\n"
    )
    script = tmp_path / "sweep.py"
    script.write_text(code)
    sweep = subprocess.Popen(
        [sys.executable, str(script)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert sweep.stdin is not None and sweep.stdout is not None
    sweep.stdin.write(pickle.dumps(scene))
    sweep.stdin.close()
    sweep.stdin = None
    assert sweep.stdout.readline() == b"begun\n"
    tasks = pathlib.Path(f"/proc/{sweep.pid}/task")
    children: list[str] = []
    while len(children) < 2:
        time.sleep(0.1)
        children = [child for task in tasks.iterdir() for child in (task / "children").read_text().split()]
    time.sleep(1.0)
    sweep.send_signal(signal.SIGINT)
    started = time.monotonic()
    _, errors = sweep.communicate(timeout=10)
    assert time.monotonic() - started < 2.0
    assert b"KeyboardInterrupt" in errors
    assert not any(os.path.exists(f"/proc/{child}") for child in children)


@pytest.mark.parametrize(
    ("values", "error", "text"),
    [
        ({KEY: 2000.0}, TypeError, "values['region.1.youngs_modulus']: expected a list with a value for each run, got float"),
        ({KEY: "2000"}, TypeError, "expected a list with a value for each run, got str"),
        ({KEY: [1.0, 2.0], "gravity": [[0.0, 0.0, 0.0]]}, ValueError, "lists of equal length"),
        ([{KEY: 1.0}, 2.0], TypeError, "values[1]: expected a dictionary of values by key, got float"),
        (2000.0, TypeError, "values: expected a dictionary of lists, or a list of dictionaries, got float"),
    ],
)
def test_wrong_values_are_named_before_a_run(scene: sn.Scene, values: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error) as raised:
        sn.sweep(scene, values)
    assert text in str(raised.value)


def test_wrong_arguments_are_named(scene: sn.Scene) -> None:
    with pytest.raises(TypeError, match="scene: expected a Scene, got str"):
        sn.sweep("organ.toml", {KEY: [1.0]})  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="workers: 0"):
        sn.sweep(scene, {KEY: [1.0]}, workers=0)
    with concurrent.futures.ThreadPoolExecutor(1) as threads, pytest.raises(ValueError, match="workers: not with executor"):
        sn.sweep(scene, {KEY: [1.0]}, executor=threads, workers=2)


def test_no_values_are_no_runs(scene: sn.Scene) -> None:
    assert sn.sweep(scene, {KEY: []}) == []
    assert sn.sweep(scene, []) == []


def test_scenes_and_results_pickle(scene: sn.Scene, direct: list[sn.Result]) -> None:
    again = pickle.loads(pickle.dumps(scene)).run()
    result = pickle.loads(pickle.dumps(again))
    assert scene.run().probes["top"].tobytes() == result.probes["top"].tobytes()
    assert result.summary == again.summary
    lost = pickle.loads(pickle.dumps(sn.Lost({KEY: 1.0}, "lost", "why")))
    assert (lost.values, lost.outcome, lost.reason) == ({KEY: 1.0}, "lost", "why")

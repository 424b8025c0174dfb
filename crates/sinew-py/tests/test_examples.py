"""Every example runs, quickly, and prints what it is for."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def run(folder: Path, *arguments: str, **environment: str) -> str:
    command = [sys.executable, str(EXAMPLES / arguments[0]), *arguments[1:]]
    ended = subprocess.run(command, cwd=folder, env=os.environ | environment, capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


def test_twelve_lines(tmp_path: Path) -> None:
    force, stress = run(tmp_path, "twelve_lines.py").split("] ")
    # The hand's last move is made within one step, so that the force goes by that step; automatic steps move it by less than this.
    assert float(force.split()[-1]) == pytest.approx(1.296, rel=2e-3)
    assert float(stress) == pytest.approx(2110, rel=2e-3)


def test_hertz(tmp_path: Path) -> None:
    # A coarse mesh is too stiff by a tenth; the verification has finer ones.
    out = run(tmp_path, "hertz.py", "--quick")
    error = float(out.split(" % of Hertz")[0].rsplit(" ", 1)[1])
    assert 5.0 < error < 15.0


def test_sweep_dask(tmp_path: Path) -> None:
    if importlib.util.find_spec("distributed") is None:
        pytest.skip("without dask.distributed")
    assert run(tmp_path, "sweep_dask.py", "--quick").count("the top sinks by") == 4


def test_sweep_mpi(tmp_path: Path) -> None:
    mpiexec = shutil.which("mpiexec", path=os.path.dirname(sys.executable) + os.pathsep + os.environ["PATH"])
    if importlib.util.find_spec("mpi4py") is None or mpiexec is None:
        pytest.skip("without mpi4py and mpiexec")
    # Open MPI refuses more ranks than cores, and the superuser, unless it is told.
    allowed = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    allowed |= {"PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    command = [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", str(EXAMPLES / "sweep_mpi.py"), "--quick"]
    ended = subprocess.run(command, cwd=tmp_path, env=os.environ | allowed, capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.count("the top sinks by") == 4


def test_sweep_slurm(tmp_path: Path) -> None:
    """Two tasks of an array, of which the first comes late, and all of them once more."""
    run(tmp_path, "sweep_slurm.py", "run", "results", "--quick", SLURM_ARRAY_TASK_ID="1", SLURM_ARRAY_TASK_COUNT="2")
    command = [sys.executable, str(EXAMPLES / "sweep_slurm.py"), "gather", "results", "--quick"]
    part = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert part.returncode == 1 and "2 runs are missing" in part.stderr
    assert part.stdout.count(",missing,") == 2 and part.stdout.count(",finished,") == 2
    run(tmp_path, "sweep_slurm.py", "run", "results", "--quick", SLURM_ARRAY_TASK_ID="0", SLURM_ARRAY_TASK_COUNT="2")
    again = run(tmp_path, "sweep_slurm.py", "run", "results", "--quick")
    assert again.count(": kept") == 4
    assert run(tmp_path, "sweep_slurm.py", "gather", "results", "--quick").count(",finished,") == 4

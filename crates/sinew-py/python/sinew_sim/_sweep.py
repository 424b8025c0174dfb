"""Runs of a scene with many values, by any executor."""

from __future__ import annotations

import functools
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from typing import Any

from ._core import Scene
from ._result import Result


class Lost:
    """A run without a result. outcome: "refused" if the scene cannot be run with these values, "lost" if the process of the
    run ended or failed. values: those of the run. reason: the error."""

    def __init__(self, values: dict[str, Any], outcome: str, reason: str) -> None:
        self.values, self.outcome, self.reason = values, outcome, reason

    def __repr__(self) -> str:
        return f"Lost({self.outcome}, {self.values}: {self.reason})"


def sweep(
    scene: Scene,
    values: Mapping[str, Iterable[Any]] | Iterable[Mapping[str, Any]],
    *,
    executor: Executor | None = None,
    workers: int | None = None,
) -> list[Result | Lost]:
    """Runs a scene once for each set of values, and returns the results in their order.

    values: lists of equal length by key, such as {"region.1.youngs_modulus": [2000.0, 8000.0]}, or dictionaries, one for each
    run. executor: one of concurrent.futures, such as Client.get_executor() of Dask or MPIPoolExecutor of mpi4py. If absent,
    `workers` processes of this computer are started (default: one for each core), and a process that ends is replaced.
    Every run takes one thread. Each result has the attribute values. A run without a result is a Lost in its place.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: expected a Scene, got {type(scene).__name__}")
    sets = _sets(values)
    if executor is not None:
        if workers is not None:
            raise ValueError("workers: not with executor, which has workers of its own")
        return _collect(executor, scene, sets)
    if workers is None:
        affinity = getattr(os, "sched_getaffinity", None)
        workers = len(affinity(0)) if affinity else os.cpu_count() or 1
    elif workers < 1:
        raise ValueError(f"workers: {workers}: expected a number of processes, 1 or above")
    with _Processes(min(workers, len(sets) or 1)) as pool:
        return _collect(pool, scene, sets)


def _sets(values: Any) -> list[dict[str, Any]]:
    """The values of each run."""
    if not isinstance(values, Mapping):
        sets = _list(values, "values", "a dictionary of lists, or a list of dictionaries")
        for number, own in enumerate(sets):
            if not isinstance(own, Mapping):
                raise TypeError(f"values[{number}]: expected a dictionary of values by key, got {type(own).__name__}")
        return [dict(own) for own in sets]
    lists = {key: _list(own, f"values[{key!r}]", "a list with a value for each run") for key, own in values.items()}
    lengths = {key: len(own) for key, own in lists.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"values: expected lists of equal length, got {lengths}")
    return [dict(zip(lists, own)) for own in zip(*lists.values())]


def _list(values: Any, name: str, expected: str) -> list[Any]:
    try:
        if not isinstance(values, (str, bytes, Mapping)):
            return list(values)
    except TypeError:
        pass
    raise TypeError(f"{name}: expected {expected}, got {type(values).__name__}")


def _collect(executor: Executor, scene: Scene, sets: list[dict[str, Any]]) -> list[Result | Lost]:
    scene_bytes = pickle.dumps(scene)  # once, so that all runs read the same files
    futures: list[Future[Result | Lost]] = []
    results: list[Result | Lost] = []
    try:
        for own in sets:
            futures.append(_submit(executor, scene_bytes, own))
        for own, future in zip(sets, futures):
            try:
                results.append(future.result())
            except Exception as error:
                results.append(Lost(own, "lost", _reason(error)))
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    return results


def _submit(executor: Executor, scene_bytes: bytes, values: dict[str, Any]) -> Future[Result | Lost]:
    try:
        return executor.submit(_run, scene_bytes, values)
    except Exception as error:  # such as a process pool that a killed process broke
        failed: Future[Result | Lost] = Future()
        failed.set_exception(error)
        return failed


def _run(scene_bytes: bytes, values: dict[str, Any]) -> Result | Lost:
    """A run in a process of an executor. Errors are returned as values, since not all exceptions pickle."""
    try:
        result = _unpickled(scene_bytes).with_values(values).run(threads=1)
    except Exception as error:
        outcome = "refused" if isinstance(error, ValueError) else "lost"
        return Lost(values, outcome, _reason(error))
    result.values = values
    return result


@functools.lru_cache(maxsize=1)
def _unpickled(scene_bytes: bytes) -> Scene:
    scene: Scene = pickle.loads(scene_bytes)
    return scene


def _reason(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}"


class _ProcessEnded(RuntimeError):
    """The process of a run ended before its result."""


class _Processes(Executor):
    """Processes of this computer, each with a thread here that feeds it. A process that ends costs the call that it had, and
    is replaced. They do not import the caller's main module, so a script needs no `if __name__ == "__main__":`."""

    def __init__(self, count: int) -> None:
        self._threads = ThreadPoolExecutor(count)
        self._idle: queue.SimpleQueue[subprocess.Popen[bytes]] = queue.SimpleQueue()
        self._all: list[subprocess.Popen[bytes]] = []
        self._lock, self._is_ended = threading.Lock(), False

    def submit(self, call: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        return self._threads.submit(self._call, pickle.dumps((call, args, kwargs)))

    def _call(self, request: bytes) -> Any:
        process = self._process()
        assert process.stdin is not None and process.stdout is not None
        try:
            process.stdin.write(request)
            process.stdin.flush()
            is_result, value = pickle.load(process.stdout)
        except (OSError, EOFError, pickle.UnpicklingError):
            process.kill()
            code = process.wait()
            end = f"by {signal.Signals(-code).name}" if code < 0 else f"with exit code {code}"
            raise _ProcessEnded(f"the process of the run ended {end}") from None
        self._idle.put(process)
        if is_result:
            return value
        raise value

    def _process(self) -> subprocess.Popen[bytes]:
        """An idle process, or a new one."""
        with self._lock:
            if self._is_ended:
                raise _ProcessEnded("the sweep ended")
            try:
                return self._idle.get_nowait()
            except queue.Empty:
                self._all.append(_started())
                return self._all[-1]

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Ends all processes, with what they compute."""
        self._threads.shutdown(wait=False, cancel_futures=True)
        with self._lock:
            self._is_ended = True
            for process in self._all:
                process.kill()
        self._threads.shutdown(wait=wait)
        for process in self._all:
            process.communicate()


def _started() -> subprocess.Popen[bytes]:
    code = f"import sys; sys.path[:] = {sys.path!r}; from sinew_sim._sweep import _serve; _serve()"
    return subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE)


def _serve() -> None:
    """Answers calls on standard input until it ends; its caller handles Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what is printed goes to standard error
    while True:
        try:
            call, args, kwargs = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        try:
            answer = pickle.dumps((True, call(*args, **kwargs)))
        except Exception as error:
            answer = pickle.dumps((False, RuntimeError(_reason(error))))
        answers.write(answer)
        answers.flush()

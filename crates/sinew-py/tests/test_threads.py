"""Threads, processes and Ctrl-C."""

import hashlib
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from conftest import cube, oscillator, probed, python, soft

import sinew_sim as sn

#: A run that takes minutes if nobody ends it.
LONG = soft(8, run={"duration": 1000.0, "integrator": "central-difference", "dt": "auto"})


def side_by_side(pool, act):
    """How much faster two threads do something than one, and how many processors they have at that; the best of five."""
    found = []
    for _ in range(5):
        begun = time.perf_counter()
        act(0), act(1)
        one = time.perf_counter() - begun
        begun, cpu = time.perf_counter(), time.process_time()
        list(pool.map(act, [0, 1]))
        two, cpu = time.perf_counter() - begun, time.process_time() - cpu
        found.append((cpu / two, one / two))
    return max(found)


def test_two_sessions_run_side_by_side():
    values = soft(8, run={"duration": 1.0, "integrator": "central-difference", "dt": 0.001, "threads": 1})
    scene = sn.Scene.from_dict(values)
    sims = [scene.session(), scene.session()]
    data = bytes(30_000_000)
    with ThreadPoolExecutor(2) as pool:
        # What this computer has left for two threads without locks.
        free, _ = side_by_side(pool, lambda _: hashlib.sha256(data).digest())
        busy, ratio = side_by_side(pool, lambda number: sims[number].step(600))
    print(f"two sessions in two threads: {busy:.2f} processors of {free:.2f} that are free, {ratio:.2f} times one thread")
    assert sims[0].save() == sims[1].save()
    if free < 1.8:
        pytest.skip(f"other work leaves {free:.2f} processors: two threads cannot be timed")
    assert busy > 1.5


def test_sessions_go_on_while_another_takes_steps():
    """As many steps in one thread as in another, however busy the computer is: none waits for the other's call to end."""
    scene = sn.Scene.from_dict(soft(8, run={"duration": 1.0, "integrator": "central-difference", "dt": 0.001, "threads": 1}))
    sim, other = scene.session(), scene.session()
    thread = threading.Thread(target=sim.step, args=(4000,))
    thread.start()
    while thread.is_alive():
        other.step(20)
    thread.join()
    print(f"{other.steps} steps beside 4000")
    assert sim.steps == 4000 and other.steps > 1000


def test_a_single_step_lets_other_threads_run():
    sim, counted, ends, most = sn.Scene.from_dict(soft(16)).session(), 0, False, 0

    def count():
        nonlocal counted
        while not ends:
            counted += 1
            time.sleep(0.0001)

    thread = threading.Thread(target=count)
    thread.start()
    for _ in range(40):
        before = counted
        sim.step()
        most = max(most, counted - before)
    ends = True
    thread.join()
    assert most > 5


def test_a_session_that_threads_share_stays_whole():
    """Each step is whole, whoever takes it; readers see whole states; nothing waits for ever."""
    scene = sn.Scene.from_dict(probed(4))
    sim, steps, faults = scene.session(), 60, []
    shape, tets = sim.positions.shape, len(sim.mesh.tets)

    def act(number):
        try:
            for _ in range(steps):
                sim.step()
                place, moved = sim.positions, sim.displacement
                assert place.shape == moved.shape == shape and np.isfinite(place).all()
                assert sim.stress().shape == (tets, 6)
                if number == 0:
                    sim.load("gravity").factor = 1.0
                if number == 1:
                    saved = sim.save()
                    assert isinstance(saved, bytes) and len(sim.log) > 0
                sim.energy(), sim.reactions(), sim.tool("ball").force, repr(sim)
        except BaseException as error:
            faults.append(error)

    threads = [threading.Thread(target=act, args=(number,), daemon=True) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
        assert not thread.is_alive()
    assert not faults
    assert sim.steps == 4 * steps
    assert scene.replay(sim.log).save() == sim.save()


def test_reading_waits_for_a_long_step_of_another_thread():
    sim = sn.Scene.from_dict(soft(6)).session()
    thread = threading.Thread(target=sim.step, args=(300,))
    thread.start()
    while sim.steps == 0 and thread.is_alive():
        time.sleep(0.001)
    assert sim.steps == 300  # the whole of step(300), not a part of it
    thread.join(timeout=30)
    assert not thread.is_alive()


def test_threads_share_a_scene():
    scene = sn.Scene.from_dict(soft(3))
    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda _: scene.run().probes["top"], range(8)))
    assert all(np.array_equal(results[0], other) for other in results)
    with ThreadPoolExecutor(4) as pool:
        whole = list(pool.map(lambda _: scene.matrices().M.sum(), range(8)))
    assert len(set(whole)) == 1


def _many(scene):
    return scene.run(threads="auto").probes["top"]


def _session(scene):
    sim = scene.session()
    sim.step(20)
    return sim.displacement[-1]


@pytest.mark.parametrize("way", ["fork", "spawn", "forkserver"])
def test_pools_of_processes(way):
    if way not in multiprocessing.get_all_start_methods():
        pytest.skip(f"{way} is not here")
    scenes = [
        sn.Scene.from_dict(soft(8, run={"duration": 0.02, "integrator": "central-difference", "dt": "auto", "threads": "auto"})),
        sn.Scene.from_dict(cube(8, run={"duration": 0.05, "integrator": "newmark", "dt": 0.005})),
    ]
    # The parent has used its threads: a forked child has none of them.
    expected = [(_many(scene), _session(scene)) for scene in scenes]
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(way)) as pool:
        for scene, (run, moved) in zip(scenes, expected):
            runs = [pool.submit(_many, scene) for _ in range(2)]
            ends = [pool.submit(_session, scene) for _ in range(2)]
            for found in runs:
                assert np.array_equal(found.result(timeout=60), run)
            for found in ends:
                assert np.array_equal(found.result(timeout=60), moved)


def test_a_forked_child_goes_on_with_the_session_of_its_parent():
    sim = sn.Scene.from_dict(soft(8)).session()
    sim.step(20)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        try:
            sim.step(20)
            os.write(write, str(hash(sim.save())).encode())
        finally:
            os._exit(0)
    os.close(write)
    sim.step(20)
    said = os.read(read, 100)
    os.waitpid(child, 0)
    assert said == str(hash(sim.save())).encode()


@pytest.fixture(scope="module")
def large():
    """A scene and a session whose products of matrices have taken threads in this process."""
    scene = sn.Scene.from_dict(cube(24, run={"duration": 0.002, "integrator": "central-difference", "dt": 5e-4}))
    sim = scene.session()
    sim.step()
    assert sim.stable_step > 0 and sim.energy()["kinetic_J"] > 0
    return scene, sim


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.parametrize("what", ["run", "stable_step", "step", "energy", "velocity"])
def test_a_forked_child_asks_a_large_body(what, large):
    """A child has none of the threads of its parent, and must not wait for them."""
    scene, sim = large
    ask = {
        "run": scene.run,
        "stable_step": scene.stable_step,
        "step": sim.step,
        "energy": sim.energy,
        "velocity": lambda: sim.velocity,
    }[what]
    child = os.fork()
    if child == 0:
        signal.alarm(20)
        try:
            ask()
            os._exit(7)
        finally:
            os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7


def test_a_sweep_keeps_order_and_names_what_was_lost():
    scene = sn.Scene.from_dict(cube())
    moduli = [4000.0, -1.0, 8000.0]
    results = sn.sweep(scene, {"region.1.youngs_modulus": moduli}, workers=2)
    assert [result.values["region.1.youngs_modulus"] for result in results] == moduli
    assert [result.outcome for result in results] == ["finished", "refused", "finished"]
    assert "youngs_modulus" in results[1].reason
    for result in (results[0], results[2]):
        alone = scene.with_values(result.values).run()
        assert np.array_equal(result.probes["top"], alone.probes["top"])


def test_a_sweep_by_threads():
    scene = sn.Scene.from_dict(cube())
    for wrong in (None, 3, "run.dt", [1], {"run.dt": 0.1}, {"title": "abc"}):
        with pytest.raises(TypeError, match="^values"):
            sn.sweep(scene, wrong)
    with pytest.raises(ValueError, match="equal length"):
        sn.sweep(scene, {"run.dt": [0.1], "run.duration": [1.0, 2.0]})
    with ThreadPoolExecutor(2) as pool:
        results = sn.sweep(scene, [{"run.dt": 0.002}, {"run.dt": 0.001}], executor=pool)
    assert [len(result.t) for result in results] == [51, 101]


def interrupted(call, after=0.3):
    """The time (s) that a call goes on after Ctrl-C."""
    at = []

    def press():
        time.sleep(after)
        at.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=press)
    thread.start()
    with pytest.raises(KeyboardInterrupt) as caught:
        call()
        time.sleep(5)
    ended = time.perf_counter()
    thread.join()
    return ended - at[0], caught.value


@pytest.mark.parametrize("values", [LONG, oscillator(1e6), cube(8, 1e4)], ids=["soft", "oscillator", "linear"])
def test_ctrl_c_ends_steps(values):
    sim = sn.Scene.from_dict(values).session()
    took, _ = interrupted(lambda: sim.step(100_000_000))
    print(f"step(n) ended {1e3 * took:.0f} ms after Ctrl-C")
    assert took < 0.3
    steps, t = sim.steps, sim.t
    assert steps > 10
    sim.step()
    assert sim.steps == steps + 1 and sim.t > t
    # The bits are those of so many steps.
    if steps < 5000:
        other = sim.scene.session()
        other.step(steps + 1)
        assert other.save() == sim.save()
    took, _ = interrupted(lambda: sim.advance(1e9 * sim.dt))
    assert took < 0.3
    sim.reset()
    sim.step(3)


@pytest.mark.parametrize("has_folder", [False, True])
def test_ctrl_c_ends_a_run_with_what_is_there(has_folder, tmp_path):
    scene = sn.Scene.from_dict(LONG)
    out = tmp_path / "run" if has_folder else None
    took, error = interrupted(lambda: scene.run(out), after=1.0)
    print(f"run ended {1e3 * took:.0f} ms after Ctrl-C")
    result = error.result
    assert result.outcome == "interrupted" and result.t[0] == 0.0
    assert 0 < result.summary["t_s"] < 1000.0
    assert took < (1.0 if has_folder else 0.3)  # a folder has its last frame and a report
    if has_folder:
        assert np.array_equal(sn.open(out).t, result.t)
    assert scene.session().step() is None


def test_ctrl_c_ends_a_plan():
    scene = sn.Scene.from_dict(soft(6, run={"duration": 100.0, "integrator": "central-difference", "dt": "auto"}))
    took, _ = interrupted(lambda: scene.plan(tolerance=1e-2, seconds=30.0))
    print(f"plan ended {1e3 * took:.0f} ms after Ctrl-C")
    assert took < 0.3


def test_ctrl_c_of_a_terminal_ends_the_script():
    text = """
import sys
from test_threads import LONG
import sinew_sim as sn
sim = sn.Scene.from_dict(LONG).session()
print("ready", flush=True)
sim.step(100_000_000)
"""
    path = os.pathsep.join([str(Path(__file__).parent), str(Path(sn.__file__).parents[1])])
    other = subprocess.Popen(
        [sys.executable, "-c", text],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": path},
    )
    assert other.stdout.readline() == "ready\n"
    time.sleep(0.5)
    begun = time.perf_counter()
    other.send_signal(signal.SIGINT)
    _, words = other.communicate(timeout=20)
    assert time.perf_counter() - begun < 1.0
    assert other.returncode in (1, 130, -signal.SIGINT) and "KeyboardInterrupt" in words


def test_progress_is_told_and_may_end_a_run():
    told = []
    scene = sn.Scene.from_dict(LONG)

    def progress(t, duration):
        told.append((t, duration))
        return len(told) < 3

    result = scene.run(progress=progress)
    assert result.outcome == "interrupted" and len(told) == 3
    assert all(duration == 1000.0 for _, duration in told) and told[0][0] < told[-1][0]


def test_what_progress_raises_ends_the_run():
    scene = sn.Scene.from_dict(LONG)

    def progress(t, duration):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough") as caught:
        scene.run(progress=progress)
    assert caught.value.result.outcome == "interrupted"


def test_progress_may_use_the_scene():
    scene, seen = sn.Scene.from_dict(LONG), []

    def progress(t, duration):
        sim = scene.session()
        sim.step(2)
        seen.append((scene.with_values({"run.duration": 0.01}).run().outcome, sim.steps, scene.stable_step() > 0))
        return len(seen) < 2

    assert scene.run(progress=progress).outcome == "interrupted"
    assert seen == [("finished", 2, True)] * 2


def test_other_signals_are_heard_in_steps():
    """A handler of Python runs while steps are taken, and may read the session's clock by another one."""
    sim, heard = sn.Scene.from_dict(LONG).session(), []

    def handler(number, frame):
        heard.append(number)
        raise TimeoutError("time is up")

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(TimeoutError, match="time is up"):
            sim.step(100_000_000)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert heard and sim.steps > 0


@pytest.mark.parametrize("what", ["t", "step"])
def test_a_handler_of_a_signal_may_ask_the_session(what):
    """In steps the handler runs in the thread that takes them: the session answers or refuses, and does not wait for itself."""
    said = python(
        """
import signal, sys
from test_threads import LONG
from conftest import probed
import sinew_sim as sn
sim = sn.Scene.from_dict(probed(4)).session()
tool = sim.tool("ball")
ask = {"t": lambda: sim.t, "positions": lambda: sim.positions, "step": sim.step, "tool": lambda: tool.force}[sys.argv[1]]
def handler(number, frame):
    try:
        ask()
        print("answered")
    except RuntimeError as error:
        print("refused", error)
    raise TimeoutError
signal.signal(signal.SIGALRM, handler)
signal.setitimer(signal.ITIMER_REAL, 0.3)
try:
    sim.step(100_000_000)
except TimeoutError:
    sim.step()
    print("goes on")
""",
        what,
        timeout=10,
    )
    assert said.returncode == 0, said.stderr
    assert said.stdout.splitlines()[0].split()[0] in ("answered", "refused") and "goes on" in said.stdout


def test_a_process_ends_while_threads_step():
    """The interpreter may end while another thread is within a long step."""
    said = python("""
import threading, time
from test_threads import LONG
import sinew_sim as sn
sim = sn.Scene.from_dict(LONG).session()
threading.Thread(target=sim.step, args=(100_000_000,), daemon=True).start()
time.sleep(0.3)
print("end", flush=True)
""", timeout=30)  # fmt: skip
    assert said.stdout == "end\n" and said.returncode == 0, said.stderr

"""What the tasks share."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from .._core import Diverged, Refused, Scene, Session
from ._hand import CONTROL_STEP, Command, Floats, Hand, Hands
from ._randomise import Ranges, checked
from ._render import Painter
from ._trusted import error_of

#: The step of a session is at most this share of the stable step at rest: tissue gets stiffer as it is pressed.
STABLE_SHARE = 0.6

#: Control steps in a row for which the goal must be met.
STEADY = 10


class Pace(float):
    """Simulated seconds for each second of the clock on the wall.

    Any two of them count as equal: a reading of a clock is no part of the motion, and Gymnasium compares the `info` of equal
    steps. Compare `float(pace)` for numbers.
    """

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Pace) or float(self) == other

    def __hash__(self) -> int:
        return hash(Pace)


class Task(gymnasium.Env[Floats, NDArray[np.float32]]):
    """A task of surgery: tools that are steered, tissue that they move, and a goal.

    **Time.** A control step is 10 ms. Within it the session takes `substeps` equal steps, each at most .6 of the stable step
    of the tissue at rest.

    **Action**, float32: for each hand, in the order of `HANDS`, the velocity of its tool (3, m/s, each component at most
    `Hand.speed`; beyond that it is cut off), and for a hand with jaws one number from -1 to 1: above 0 closes them, else they
    open. Closed jaws hold every node that they push. A tool does not leave the box of its hand.

    **Observation**, float64, SI units, of the same length also after cuts; `names` has a name for each entry: the places of
    the marks, each (3); for each hand the place of its tool (3), its rotation vector (3), the force on it (3, as
    `sim.tool(..).force`), and for hands with jaws whether they are closed and whether they hold tissue (0 or 1); the largest
    von Mises stress (1); what the task adds.

    **End.** Success ends an episode (`terminated`): the goal must be met in 10 control steps in a row. `steps` control steps
    end it as well (`truncated`). So does a motion that the solver cannot follow (`terminated`): the reward is then -2 for
    each control step that was left, so that it never pays, and the observation is the last good one.

    **info.** `is_success`: bool. `outcome`: "running", "finished", "diverged" or "refused". `pace`: simulated seconds for
    each second of the clock. `values`: what is set in the scene. `error`: with `error=True`, at the end of an episode, the
    relative error |u - u*| / |u*| of the displacements of all nodes, u* being those of the same commands run again with
    steps a quarter as long; None before, and for those who did not ask. It takes four times as long as the episode;
    `trusted_error()` computes it at any time. It is some 1e-4 to 1e-2 while jaws seize the same nodes in both runs, and may be
    1e-1 where they seize one more or less. `failure`: what the solver said, where it could not follow.

    Arguments of `gymnasium.make`:

    randomise: ranges of keys of the scene, such as {"region.1.youngs_modulus": (2000, 8000)}; each reset draws from them.
    error: whether the error is computed at the end of an episode.
    steps: control steps after which an episode ends; None for those of the task.
    render_mode: None or "rgb_array".

    `reset(options={"values": {..}})` sets values of the scene by hand, for that episode, over those that are drawn. `scene`
    and `sim` are the scene and the session of the episode; `sim.log` replays it bit for bit.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": round(1.0 / CONTROL_STEP)}

    HANDS: ClassVar[tuple[Hand, ...]]
    #: Places in the body at rest (m); the nodes nearest to them are followed, also after a cut.
    MARKS: ClassVar[dict[str, tuple[float, float, float]]]
    #: Control steps of an episode.
    STEPS: ClassVar[int]
    #: Ranges for `randomise` with which the figures of the README are measured: half to twice the stiffness, and starts.
    VARIED: ClassVar[dict[str, tuple[Any, Any]]]
    #: Names of what the task adds to the observation.
    EXTRA: ClassVar[tuple[str, ...]] = ()
    #: Stress (Pa) at the end of the scale of colours.
    STRESS: ClassVar[float] = 3000.0

    def __init__(
        self,
        randomise: Mapping[str, Any] | None = None,
        error: bool = False,
        steps: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        if steps is not None and steps < 1:
            raise ValueError(f"steps: {steps}: expected a number of control steps above 0")
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f'render_mode: {render_mode!r}: expected None or "rgb_array"')
        self.render_mode = render_mode
        self._base = Scene.from_dict(self.scene_values())
        self._ranges = Ranges(randomise, self._base)
        for corner in self._ranges.corners():
            self._check_starts(checked(self._base, corner, "randomise"), "randomise")
        self._asks_error = error
        self._limit = self.STEPS if steps is None else steps
        self._steady = 0
        self._painter: Painter | None = Painter(self.HANDS, self.goals(), self.STRESS) if render_mode else None
        self.names = self._names()
        self._bounds = self._largest()
        self.action_space = spaces.Box(-self._bounds, self._bounds, dtype=np.float32)
        self.observation_space = spaces.Box(-np.inf, np.inf, (len(self.names),), np.float64)
        self._build({})
        self._begin()
        self._over = True

    # What a task says.

    def scene_values(self) -> dict[str, Any]:
        """The scene, as `Scene.from_dict` takes it, with the step "auto"."""
        raise NotImplementedError

    def evaluate(self) -> tuple[float, bool]:
        """The reward of the present moment, without those of an end, and whether the goal is met."""
        raise NotImplementedError

    def extra(self) -> Floats:
        """What the task adds to the observation."""
        return np.empty(0)

    def goals(self) -> Floats:
        """Places that pictures mark as goals (m), (k, 3)."""
        return np.empty((0, 3))

    def begun(self) -> None:
        """Called as an episode begins."""

    # What Gymnasium asks.

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        super().reset(seed=seed)
        drawn = self._ranges.draw(self.np_random)
        values = {**drawn, **_values_of(options)}
        if values != self.values:
            self._build(values)
        else:
            self.sim.reset()
        self._begin()
        return self._observe(), self._info(Pace(0.0))

    def step(self, action: NDArray[np.float32]) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        if self._over:
            raise gymnasium.error.ResetNeeded("the episode is over, or none has begun: call reset()")
        command = self._command(action)
        began = time.perf_counter()
        self._commands.append(command)
        try:
            self.hands.follow(command, self.substeps)
        except (Diverged, Refused) as failure:
            return self._failed(failure)
        pace = Pace(CONTROL_STEP / (time.perf_counter() - began))
        self._find_marks()
        self._stress = float(self.sim.von_mises().max())
        reward, is_met = self.evaluate()
        self._steady = self._steady + 1 if is_met else 0
        self.is_success = self._steady >= STEADY
        truncated = not self.is_success and len(self._commands) >= self._limit
        if self.is_success or truncated:
            self._end("finished")
        self._last = self._observe()
        return self._last.copy(), reward, self.is_success, truncated, self._info(pace)

    def render(self) -> Any:
        """A picture of the present moment, (height, width, 3) uint8, with `render_mode="rgb_array"`; else None."""
        if self._painter is None:
            return None
        return self._painter.picture(self.scene, self.sim)

    def close(self) -> None:
        if self._painter is not None:
            self._painter.close()

    # What users ask.

    def trusted_error(self) -> float:
        """The relative error of the present moment against a run of the same commands with steps a quarter as long."""
        return error_of(self.sim, self.scene, self.HANDS, self._commands, self.substeps)

    def mark(self, name: str) -> Floats:
        """The place of a mark (m)."""
        position: Floats = self.sim.positions[self._nodes[name]]
        return position

    def holds(self, hand: int = 0) -> bool:
        """Whether the jaws of a hand are closed and hold tissue."""
        return self.hands.closed[hand] and self.hands.tools[hand].contacts > 0

    def force(self, hand: int = 0) -> float:
        """The size of the force on the tool of a hand (N)."""
        return float(np.linalg.norm(self.hands.tools[hand].force))

    # Parts.

    def _build(self, values: dict[str, Any]) -> None:
        """A new scene and session."""
        scene = checked(self._base, values, "values")
        self._check_starts(scene, "values")
        if "run.dt" in values:
            self.substeps = _substeps(values["run.dt"])
        else:
            self.substeps = int(np.ceil(CONTROL_STEP / (STABLE_SHARE * scene.stable_step())))
        self.scene: Scene = scene.with_values({"run.dt": CONTROL_STEP / self.substeps})
        self.sim: Session = self.scene.session()
        self.values = values
        self.hands = Hands(self.sim, self.HANDS)
        self._first_stress = float(self.sim.von_mises().max())
        self._epoch_of_marks = -1

    def _begin(self) -> None:
        self.hands.begin()
        self._find_marks()
        self._commands: list[Command] = []
        self._steady = 0
        self._stress = self._first_stress
        self._outcome = "running"
        self._error: float | None = None
        self._over = False
        self.is_success = False
        self.begun()
        self._last = self._observe()

    def _find_marks(self) -> None:
        """Finds the nodes of the marks in the mesh: other ones after a cut."""
        if self.sim.topology_epoch == self._epoch_of_marks:
            return
        self._epoch_of_marks = self.sim.topology_epoch
        assert self.sim.mesh is not None
        points = self.sim.mesh.points
        self._nodes = {name: int(((points - place) ** 2).sum(axis=1).argmin()) for name, place in self.MARKS.items()}

    def _end(self, outcome: str) -> None:
        self._outcome = outcome
        self._over = True
        if self._asks_error:
            self._error = self.trusted_error() if outcome == "finished" else float("inf")

    def _failed(self, failure: Diverged | Refused) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        self._end("diverged" if isinstance(failure, Diverged) else "refused")
        left = self._limit - len(self._commands) + 1
        return self._last.copy(), -2.0 * left, True, False, {**self._info(Pace(0.0)), "failure": str(failure)}

    def _observe(self) -> Floats:
        positions = self.sim.positions
        parts: list[Any] = [positions[node] for node in self._nodes.values()]
        for number, (hand, tool) in enumerate(zip(self.HANDS, self.hands.tools)):
            parts += [tool.position, tool.rotation_vector, tool.force]
            if hand.jaws:
                parts.append([float(self.hands.closed[number]), float(self.holds(number))])
        parts += [[self._stress], self.extra()]
        return np.concatenate(parts)

    def _names(self) -> tuple[str, ...]:
        """Names of the entries of the observation."""
        names = [f"{mark}_{axis}_m" for mark in self.MARKS for axis in "xyz"]
        for hand in self.HANDS:
            for what, unit in (("", "_m"), ("_r", "_rad"), ("_force", "_N")):
                names += [f"{hand.name}{what}_{axis}{unit}" for axis in "xyz"]
            if hand.jaws:
                names += [f"{hand.name}_closed", f"{hand.name}_holds"]
        return (*names, "von_mises_Pa", *self.EXTRA)

    def _info(self, pace: Pace) -> dict[str, Any]:
        return {
            "is_success": self.is_success,
            "outcome": self._outcome,
            "pace": pace,
            "error": self._error,
            "values": dict(self.values),
        }

    def _largest(self) -> NDArray[np.float32]:
        """The largest value of each entry of an action."""
        bounds: list[float] = []
        for hand in self.HANDS:
            bounds += [hand.speed] * 3 + [1.0] * hand.jaws
        return np.array(bounds, np.float32)

    def _command(self, action: Any) -> Command:
        given = np.asarray(action, float)
        if given.shape != self._bounds.shape:
            raise ValueError(f"action: expected the shape {self._bounds.shape}, got {given.shape}")
        if not np.isfinite(given).all():
            raise ValueError(f"action: expected finite numbers, got {given}")
        rest = np.clip(given, -self._bounds, self._bounds)
        places = self.hands.places.copy()
        closed = []
        for number, hand in enumerate(self.HANDS):
            velocity, rest = rest[:3], rest[3:]
            places[number] = np.clip(places[number] + CONTROL_STEP * velocity, hand.lower, hand.upper)
            closed.append(hand.jaws and bool(rest[0] > 0.0))
            rest = rest[1:] if hand.jaws else rest
        return Command(places, tuple(closed))

    def _check_starts(self, scene: Scene, argument: str) -> None:
        """Refuses starts outside the box of a hand, into which the tool would jump."""
        starts = {tool["name"]: tool["start"] for tool in scene.as_dict()["tool"]}
        for hand in self.HANDS:
            start = np.asarray(starts[hand.name])
            if (start < hand.lower).any() or (start > hand.upper).any():
                box = f"{list(hand.lower)} to {list(hand.upper)}"
                raise ValueError(f"{argument}: the tool {hand.name} starts at {start.tolist()} m: expected a place in {box}")


def _values_of(options: dict[str, Any] | None) -> dict[str, Any]:
    """The values that the options of a reset set."""
    options = options or {}
    other = sorted(set(options) - {"values"})
    if other:
        raise ValueError(f"options: unknown {', '.join(other)}: expected {{'values': {{key of the scene: value}}}}")
    values = options.get("values", {})
    if not isinstance(values, Mapping):
        raise ValueError(f"options: values: expected a dictionary of keys of the scene, got {type(values).__name__}")
    return dict(values)


def _substeps(dt: Any) -> int:
    """How many steps dt a control step has."""
    if not isinstance(dt, (int, float)) or not 0.0 < dt <= CONTROL_STEP:
        raise ValueError(f"values: run.dt: {dt!r}: expected a step (s) above 0, of at most a control step of {CONTROL_STEP} s")
    count = round(CONTROL_STEP / dt)
    if abs(count * dt - CONTROL_STEP) > 1e-9 * CONTROL_STEP:
        raise ValueError(f"values: run.dt: {dt} s: expected a whole part of a control step of {CONTROL_STEP} s")
    return count

"""Plans of scenes."""

from __future__ import annotations

from typing import Any


class Plan:
    """The method and step that a scene should take, with the error and the cost that were measured.

    Without a question (no tolerance and no budget) the integrator and step are the scene's own and nothing was measured.
    Attributes:

    integrator: name of the method; None where nothing keeps to what was asked.
    options: its options that differ from the defaults.
    dt: its step (s).
    error: relative error that was measured, beside a trusted solution; None if nothing was.
    cost: CPU seconds a simulated second; None if nothing was measured.
    met: True where the error keeps to the tolerance over the whole scene.
    met_until: time (s) up to which it does; None if it never does.
    """

    def __init__(self, values: dict[str, Any]) -> None:
        self._values = values
        self._row: dict[str, Any] = (values.get("advised") or {}).get("row") or {}
        is_asked = "met" in values
        own: dict[str, Any] = {} if is_asked else values
        self.integrator: str | None = self._row.get("integrator", own.get("integrator"))
        self.options: dict[str, Any] = dict(self._row.get("options", {}))
        self.dt: float | None = self._row.get("dt", own.get("dt_s"))
        self.error: float | None = self._row.get("error")
        self.cost: float | None = self._row.get("cpu_s_per_s")
        self.met: bool = bool(values.get("met", False))
        self.met_until: float | None = values.get("met_until_s")

    def as_dict(self) -> dict[str, Any]:
        """All that is known, as `sinew plan --json` prints it."""
        return self._values

    def values(self) -> dict[str, Any]:
        """The advised method and step, for `Scene.with_values`."""
        if self.integrator is None:
            return {}
        advised = {"run.integrator": self.integrator, "run.dt": self.dt}
        return advised | {f"run.{key}": value for key, value in self.options.items()}

    def __repr__(self) -> str:
        error = "not measured" if self.error is None else f"{self.error:.3g}"
        cost = "not measured" if self.cost is None else f"{self.cost:.3g} CPU s/s"
        return f"Plan({self.integrator}, dt={self.dt} s, error {error}, cost {cost}, met={self.met})"

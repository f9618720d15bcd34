"""Runs of laws that jump: each switch instant is located, and the run goes on anew after it.

Between two switches the jumping values are held, so the integrator sees a smooth field. Where a
switching surface attracts from both sides the solution would slide along it (Filippov): such a
motion is no longer the law's own, and the run is refused there with the instant and the remedy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any, final

import casadi as ca
import numpy as np

from ..closed_loop import ClosedLoop
from ..lowering.jumps import split_jumps
from ..types import Array
from .phases import Phase, phase_field
from .trajectory import Segment

LOOKS = 8
"""Instants of each step at which the jumping values are looked at."""
MOST_SWITCHES = 2000
"""Switches of a whole run: each restarts the integrator, so this bounds the work."""
REMEDY = "give the law a dead band or a hysteresis, or let it decide at sample times"


class SlidingError(RuntimeError):
    """A run that switches back at once, or without end."""


@lru_cache(maxsize=64)
def jumping_functions(loop: ClosedLoop, degree: int) -> tuple[Any, Any] | None:
    """CasADi functions of a loop that jumps; None if it does not.

    The first: (tau, state, coefficients, parameters, body) -> jumping values (m,). The second: the same
    and the held values -> state rate (n,), the values' sources (m,), the sources' rates (m,).
    """
    split = split_jumps(phase_field(loop, degree))
    if split is None:
        return None
    tau, state = split.arguments[:2]
    slopes = ca.jtimes(split.sources, state, split.result) + ca.jtimes(split.sources, tau, ca.SX(1))
    values = ca.Function("jumping_values", list(split.arguments), [split.values])
    results = [split.result, split.sources, slopes]
    held = ca.Function("held_field", [*split.arguments, split.held], results)
    return values, held


@final
@dataclass
class Switching:
    """The integration of one run of a law that jumps.

    Attributes
    ----------
    functions : of `jumping_functions`
    degree : of the signals
    parameters, body : the loop's numbers
    switches, evaluations : counted so far
    """

    functions: tuple[Any, Any]
    degree: int
    parameters: Array
    body: Array
    switches: int = 0
    evaluations: int = 0

    def through(self, phase: Phase, state: Array, rtol: float, atol: Array | float) -> list[Segment]:
        """Segments of one phase, one between each two switches.

        Raises
        ------
        SlidingError
            Where the run would slide along a switching surface, or switches more than it may.
        FloatingPointError
            If the step size vanishes or a state is no longer a number.
        """
        coefficients = phase.coefficient_array(self.degree)
        origin, end = float(phase.origin), float(phase.end)

        def arguments(t: float, x: Array) -> tuple[Any, ...]:
            return (t - origin, x, coefficients, self.parameters, self.body)

        def values(t: float, x: Array) -> Array:
            return np.asarray(self.functions[0](*arguments(t, x)), dtype=float).ravel()

        def motion(t: float, x: Array, held: Array) -> list[Array]:
            self.evaluations += 1
            return [np.asarray(r, dtype=float).ravel() for r in self.functions[1](*arguments(t, x), held)]

        segments: list[Segment] = []
        t, held = float(phase.start), values(float(phase.start), state)
        while t < end:
            part = _until_switch(motion, values, held, (t, end), state, (rtol, atol))
            first = replace(phase, start=Fraction(t), end=Fraction(part.times[-1])) if segments else phase
            segments.append(Segment(first, part.times, part.states, part.dense))
            t, state = float(part.times[-1]), part.states[:, -1]
            if part.switched is None:
                break
            segments[-1] = replace(segments[-1], phase=replace(segments[-1].phase, end=Fraction(t)))
            self._pass(t, motion(t, state, held), motion(t, state, part.switched), held != part.switched)
            held = part.switched
        segments[-1] = replace(segments[-1], phase=replace(segments[-1].phase, end=phase.end))
        return segments

    def _pass(self, t: float, before: list[Array], after: list[Array], changed: Any) -> None:
        """Count a switch; refuse one after which the run is driven back across the surface."""
        self.switches += 1
        if bool(np.any(before[2][changed] * after[2][changed] < 0)):
            raise SlidingError(
                f"the run stopped at t = {t:.6g} s: the law switches there and is driven back at once (its "
                f"switching surface attracts from both sides: a sliding motion, or chattering): {REMEDY}"
            )
        if self.switches > MOST_SWITCHES:
            raise SlidingError(
                f"the run stopped at t = {t:.6g} s: the law has switched {self.switches} times by then "
                f"(a run may {MOST_SWITCHES} times): {REMEDY}, or coarser steps of the torque"
            )


@final
@dataclass(frozen=True, eq=False)
class _Part:
    times: Array
    states: Array
    dense: Callable[[Array], Array]
    switched: Array | None


def _until_switch(
    motion: Callable[[float, Array, Array], list[Array]], values: Callable[[float, Array], Array],
    held: Array, span: tuple[float, float], state: Array, tolerances: tuple[float, Array | float],
) -> _Part:  # fmt: skip
    """Integrate with the jumping values held, to the end or to just after the first switch."""
    from scipy.integrate import DOP853, OdeSolution

    solver = DOP853(
        lambda t, x: motion(t, x, held)[0], span[0], state, span[1], rtol=tolerances[0], atol=tolerances[1]
    )
    times, states, pieces = [span[0]], [state], []
    switched = None
    while solver.status == "running" and switched is None:
        solver.step()
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            raise FloatingPointError(f"the run stopped at t = {solver.t:.6g} s: the step size vanished")
        piece = solver.dense_output()
        t, x, switched = _first_switch(piece, values, held, times[-1], solver.t)
        pieces.append(piece)
        times.append(t)
        states.append(x if switched is not None else solver.y)
    return _Part(np.array(times), np.stack(states, axis=1), OdeSolution(times, pieces), switched)


def _first_switch(
    piece: Any, values: Callable[[float, Array], Array], held: Array, start: float, end: float
) -> tuple[float, Array, Array | None]:
    """First instant after which a jumping value differs, by bisection to the spacing of times."""
    low = start
    for high in np.linspace(start, end, LOOKS + 1)[1:].tolist():
        if np.array_equal(values(high, piece(high)), held):
            low = high
            continue
        while low < (middle := (low + high) / 2) < high:
            same = np.array_equal(values(middle, piece(middle)), held)
            low, high = (middle, high) if same else (low, middle)
        return high, piece(high), values(high, piece(high))
    return end, piece(end), None

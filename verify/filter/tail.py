"""Periodic schedules: a flowpipe over one period that repeats for ever.

On [t1, t1 + T] a flowpipe whose lower bounds end no lower than they began and whose upper bounds
end no higher holds again over each later period, with the same functions. Components that enter
their inequalities linearly, or with terms that only help when small, are scaled down together:
if they end at most theta times where they began, the n-th period holds with theta^n times them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import exp, nextafter
from typing import final

from ...models.schedule import Schedule
from ..flow.stepping import CannotProceedError, ComparisonSystem, Modes, Step, Stepper

ATTEMPTS = 4
"""How often the start of a periodic component is moved to its loose side."""
SLOWEST = 0.003
"""Least share of its start that a periodic component is taken to forget over a period."""
MAX_RATIO = 0.998
"""A decay per period slower than this does not count as a decay."""


class PeriodicSystem(ComparisonSystem):
    """A comparison system fit for a tail.

    `decaying` groups components that scale down together; components in `free` may end
    anywhere; every other component must return to where it began or beyond, on its safe side.
    `decay`, 1/s, is how fast those forget where they began (a guess; a filter's lambda).
    """

    decaying: tuple[tuple[str, ...], ...]
    free: tuple[str, ...] = ()
    decay: Fraction = Fraction(0)

    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """One form of the inequalities, unless the system has several to choose from."""
        del state, peak, length
        return ((),)

    def limits(
        self, start: Mapping[str, float], end: Mapping[str, float], ratios: Mapping[str, float]
    ) -> dict[str, float]:
        """Bounds over all later time of the components in `free` that have one."""
        del start, end, ratios
        return {}

    def contraction(self, period: float) -> float:
        """Factor by which the periodic components forget their start over one period (a guess)."""
        return exp(-float(self.decay) * period)


@final
@dataclass(frozen=True)
class Tail:
    """A witness for all t >= start.

    Attributes
    ----------
    start : Fraction
        Its beginning t1, s.
    steps : tuple of Step
        The first period; the n-th repeats it with the decaying components times ratio^n.
    ratios : mapping
        Component name to its ratio per period, < 1; components not listed repeat unchanged.
    limits : mapping
        Component name to its bound over all later time, where it neither decays nor repeats.
    given_up : tuple of str
        Components that hold over the first period only, and are not needed.
    """

    start: Fraction
    steps: tuple[Step, ...]
    ratios: Mapping[str, float]
    limits: Mapping[str, float]
    given_up: tuple[str, ...] = ()


def find_tail(
    system: PeriodicSystem, schedule: Schedule, start: Fraction, state: Sequence[float], stepper: Stepper
) -> Tail | None:
    """Prove a tail from this state on, or return None where none was found."""
    assert schedule.period is not None
    values = list(state)
    for _ in range(ATTEMPTS):
        try:
            steps = stepper.run(schedule, start, start + schedule.period, values)
        except CannotProceedError:
            return None
        end = steps[-1].end_state()
        ratios = decay_ratios(system, values, end)
        if ratios is None:
            return None
        moved = _loosened(system, values, end, system.contraction(float(schedule.period)))
        if moved is None:
            first = dict(zip(system.names, values, strict=True))
            limits = system.limits(first, end, ratios)
            given_up = tuple(name for name in system.free if name not in limits)
            return Tail(start, tuple(steps), ratios, limits, given_up)
        values = moved
    return None


def decay_ratios(
    system: PeriodicSystem, start: Sequence[float], end: Mapping[str, float]
) -> dict[str, float] | None:
    """Ratio per period of each decaying component; None unless every group decays."""
    first = dict(zip(system.names, start, strict=True))
    ratios: dict[str, float] = {}
    for group in system.decaying:
        theta = 0.0
        for name in group:
            if first[name] > 0:
                theta = max(theta, nextafter(end[name] / first[name], 2.0))
            elif end[name] > 0:
                return None
        if theta > MAX_RATIO:
            return None
        ratios |= dict.fromkeys(group, theta)
    return ratios


def _loosened(
    system: PeriodicSystem, start: Sequence[float], end: Mapping[str, float], contraction: float
) -> list[float] | None:
    """Return a looser start where a periodic component does not come back to it, or None if all do."""
    values, changed = list(start), False
    settled = {*system.free, *(name for group in system.decaying for name in group)}
    for i, (name, sign) in enumerate(zip(system.names, system.signs, strict=True)):
        if name in settled or sign * (end[name] - values[i]) <= 0:
            continue
        drift = (end[name] - values[i]) / max(1.0 - contraction, SLOWEST)
        values[i] += 1.02 * drift + sign * 1e-6 * abs(values[i])
        changed = True
    return values if changed else None

"""Steps of a proof by comparison: polynomials of the components, and their differential inequalities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from .bernstein import Form
from .comparison import Bounds, Comparison
from .exact_numbers import MAX_COUNT, MAX_EXPONENT, require, show
from .reading import Node
from .schedules import Profile


@dataclass(frozen=True)
class FloorStep:
    """One step: its interval, the forms used, and the polynomial of each component."""

    start: Fraction
    stop: Fraction
    modes: list[str]
    x: dict[str, Form]
    ends: dict[str, tuple[Fraction, Fraction]]


def read_steps(place: Node, start: Fraction, sides: Mapping[str, int]) -> list[FloorStep]:
    """Read steps that follow each other from `start`, every bound jumping to its loose side only."""
    steps: list[FloorStep] = []
    for node in place.items():
        stop = node["until"].number()
        require(stop > start, f"{node.path}: a step must end after it begins")
        x, ends = {}, {}
        for name in sides:
            numbers = node["bounds"][name].vector()
            require(all(v.denominator == 1 for v in numbers), f"{node.path}: expected integers for {name}")
            exponent, *mantissas = (int(v) for v in numbers)
            require(
                abs(exponent) <= MAX_EXPONENT and 0 < len(mantissas) <= MAX_COUNT,
                f"{node.path}: the polynomial of {name} is out of range",
            )
            unit = Fraction(2) ** exponent
            x[name] = Form.of([m * unit for m in mantissas])
            ends[name] = (mantissas[0] * unit, mantissas[-1] * unit)
        modes = [mode.text() for mode in node["forms"].items()]
        steps.append(FloorStep(start, stop, modes, x, ends))
        if len(steps) > 1:
            require_loose(sides, {n: e[1] for n, e in steps[-2].ends.items()}, steps[-1], node.path)
        start = stop
    require(bool(steps), f"{place.path}: there are no steps")
    return steps


def require_loose(sides: Mapping[str, int], before: Bounds, step: FloorStep, path: str) -> None:
    """Check that a step begins no tighter than what is known."""
    for name, side in sides.items():
        if name in before:
            gap = side * (step.ends[name][0] - before[name])
            require(gap >= 0, f"{path}: the bound {name} begins tighter than is known")


def check_step(system: Comparison, profile: Profile, step: FloorStep, *, tail: bool) -> None:
    """Check every differential inequality on a step."""
    g = profile.gain(step.start, step.stop)
    per_second = 1 / (step.stop - step.start)
    dx = {name: p.derivative().times(per_second) for name, p in step.x.items()}
    for name, condition in system.conditions(g * g, step.x, dx, step.modes, tail=tail):
        where = f"on [{show(step.start)}, {show(step.stop)}] s"
        require(condition.is_nonnegative(), f"{name} is not proved {where}")

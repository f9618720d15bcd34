"""Proved sub- and supersolutions of differential inequalities driven by a schedule.

A *witness* is a sequence of steps. On each step every component of a comparison system is a
polynomial; steps meet with equal values, or a bound jumps to its loose side. Floating-point
collocation proposes a step with a small slack in the safe direction; the system's differential
inequalities are then polynomial inequalities on the step, proved by Bernstein coefficients in
exact rationals. A step that cannot be proved is halved. What is returned is therefore true as
it stands, whatever proposed it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from typing import final

import numpy as np

from ...models.schedule import Schedule
from ...models.schedule import polynomial as poly
from ...models.schedule.piecewise import Piece
from ...models.schedule.polynomial import Coefficients
from ...models.types import Array
from ..exact.bernstein import Bernstein
from .collocation import CHECK_POINTS, propose, rule

Modes = tuple[str, ...]
"""Which of several valid forms of the inequalities a step uses, in the system's own words."""


@final
@dataclass(frozen=True)
class Step:
    """One step of a witness.

    Attributes
    ----------
    start, stop : Fraction
        Time interval, s.
    shape : coefficients of g on the whole schedule piece, in its own [0, 1] variable
    part : tuple (j, n)
        The step is the j-th of n equal parts of the schedule piece.
    controls : mapping
        Component name to Bernstein coefficients on the step; floats at their exact binary value.
    modes : tuple of str
        The forms of the inequalities that were proved.
    """

    start: Fraction
    stop: Fraction
    shape: Coefficients
    part: tuple[int, int]
    controls: Mapping[str, tuple[float, ...]]
    modes: Modes

    @property
    def length(self) -> Fraction:
        """Duration, s."""
        return self.stop - self.start

    @property
    def gain_square(self) -> Bernstein:
        """g^2 on the step, exact."""
        return gain_square(self.shape, self.part)

    def end_state(self) -> dict[str, float]:
        """Values at the end of the step."""
        return {name: c[-1] for name, c in self.controls.items()}


class ComparisonSystem(ABC):
    """Differential inequalities whose solutions bound every trajectory of the closed loop.

    `names` and `signs` list the components and their side: +1 an upper bound, -1 a lower one.
    """

    names: tuple[str, ...]
    signs: tuple[int, ...]

    @abstractmethod
    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """Forms of the inequalities to try from this state on a step of `length` s, best first.

        `peak`: see `rate`.
        """

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """State at the start of a step in these modes: bounds may jump to their loose side."""
        del modes
        return tuple(state)

    @abstractmethod
    def rate(
        self, gain_square: float, state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Right-hand side in floats, pushed by `slack` in the safe direction.

        `peak` is the greatest g^2 on the schedule piece, the scale of the slack.
        """

    @abstractmethod
    def conditions(
        self, gain_square: Bernstein, x: Sequence[Bernstein], dx: Sequence[Bernstein], modes: Modes
    ) -> Iterator[Bernstein]:
        """Polynomials that are >= 0 on the step iff the inequalities hold there."""


class CannotProceedError(Exception):
    """No step from this instant could be proved; carries the time (s) and the proved steps."""

    def __init__(self, time: Fraction, steps: Sequence[Step]) -> None:
        super().__init__(f"no step could be proved from t = {float(time):g} s")
        self.time = time
        self.steps = tuple(steps)


@lru_cache(maxsize=65536)
def gain_square(shape: Coefficients, part: tuple[int, int]) -> Bernstein:
    """g^2 on one part of a schedule piece, exact."""
    j, n = part
    g = poly.compose_affine(shape, Fraction(j, n), Fraction(1, n))
    return Bernstein.from_powers(poly.multiply(g, g))


@lru_cache(maxsize=65536)
def _float_gains(
    shape: Coefficients, part: tuple[int, int], degree: int
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """g^2 at the collocation nodes and at the check points of one part of a piece."""
    powers = np.array([float(c) for c in reversed(shape)] or [0.0])
    x = (part[0] + np.concatenate([rule(degree).nodes, CHECK_POINTS])) / part[1]
    values = (np.polyval(powers, x) ** 2).tolist()
    return tuple(values[:degree]), tuple(values[degree:])


@lru_cache(maxsize=4096)
def _peak(shape: Coefficients) -> float:
    """About the greatest g^2 on a whole schedule piece: the scale of the slack."""
    powers = [float(c) for c in reversed(shape)] or [0.0]
    return float(np.max(np.polyval(powers, np.linspace(0.0, 1.0, 17)) ** 2))


@final
@dataclass
class Stepper:
    """Proves steps of one comparison system, remembering which step sizes worked.

    Attributes
    ----------
    degree : degree of the polynomials
    slack : relative slack of the right-hand sides, traded against the number of steps
    finest : a schedule piece is cut into at most this many parts (a power of 2)
    """

    system: ComparisonSystem
    degree: int = 4
    slack: float = 2e-4
    finest: int = 4096
    proved: int = 0
    _levels: dict[tuple[Coefficients, Fraction], int] = field(default_factory=dict)

    def remember(self, other: Stepper) -> None:
        """Take over the step sizes that worked for another system on the same schedule."""
        self._levels |= other._levels

    def run(self, schedule: Schedule, start: Fraction, stop: Fraction, state: Sequence[float]) -> list[Step]:
        """Proved steps over [start, stop]; both must be knots of the schedule or cut zero pieces only.

        Raises
        ------
        CannotProceedError
            If from some instant no form and no step size can be proved.
        """
        steps: list[Step] = []
        for piece in schedule.pieces_between(start, stop):
            clipped = _clip(piece, start, stop)
            try:
                new = self._piece(clipped, state)
            except CannotProceedError as stuck:
                raise CannotProceedError(stuck.time, (*steps, *stuck.steps)) from None
            steps += new
            if new:
                state = tuple(new[-1].controls[name][-1] for name in self.system.names)
        return steps

    def _piece(self, piece: Piece, state: Sequence[float]) -> list[Step]:
        key = (piece.shape, piece.length)
        n = self._levels.get(key, 1)
        j, steps = 0, list[Step]()
        while j < n:
            step = self._attempt(piece, (j, n), state)
            if step is None:
                n, j = 2 * n, 2 * j
                if n > self.finest:
                    raise CannotProceedError(piece.start + piece.length * Fraction(j, n), steps)
                continue
            steps.append(step)
            state = tuple(step.controls[name][-1] for name in self.system.names)
            j += 1
            while n > 1 and j % 2 == 0 and j < n and self._may_grow(steps):
                n, j = n // 2, j // 2
        self._levels[key] = min(s.part[1] for s in steps)
        return steps

    def _may_grow(self, steps: Sequence[Step]) -> bool:
        """Two proved steps of one size in a row: try the double."""
        return len(steps) >= 2 and steps[-1].part[1] == steps[-2].part[1] and steps[-1].part[0] % 4 == 3

    def _attempt(self, piece: Piece, part: tuple[int, int], state: Sequence[float]) -> Step | None:
        j, n = part
        start = piece.start + piece.length * Fraction(j, n)
        stop = piece.start + piece.length * Fraction(j + 1, n)
        peak = _peak(piece.shape)
        for modes in self.system.choices(state, peak, float(stop - start)):
            first = self.system.loosened(state, modes)
            proposal = self._propose(piece.shape, part, float(stop - start), first, modes)
            if proposal is None:
                continue
            controls = {
                name: tuple(column)
                for name, column in zip(self.system.names, proposal.T.tolist(), strict=True)
            }
            step = Step(start, stop, piece.shape, part, controls, modes)
            if is_proved(self.system, step):
                self.proved += 1
                return step
        return None

    def _propose(
        self,
        shape: Coefficients,
        part: tuple[int, int],
        length: float,
        state: Sequence[float],
        modes: Modes,
    ) -> Array | None:
        """Collocate, then discard proposals whose defect already shows in floats."""
        system, peak = self.system, _peak(shape)
        node_gains, check_gains = _float_gains(shape, part, self.degree)

        def rates(points: Array, gains: Sequence[float], slack: float) -> Array:
            rows = zip(gains, points.tolist(), strict=True)
            return np.array([system.rate(g, row, modes, peak, slack) for g, row in rows])

        try:
            with np.errstate(all="ignore"):
                controls = propose(
                    lambda points: rates(points, node_gains, self.slack), np.array(state), length, self.degree
                )
            if controls is None or not np.all(np.isfinite(controls)):
                return None
            controls[0] = state  # steps meet exactly
            r = rule(self.degree)
            values = r.check_values @ controls
            exact = rates(values, check_gains, 0.0)
        except (OverflowError, ZeroDivisionError):
            return None
        margin = np.array(system.signs) * (r.check_slopes @ controls / length - exact)
        return controls if np.all(margin >= -1e-13 * np.abs(values) / length) else None


def is_proved(system: ComparisonSystem, step: Step) -> bool:
    """Whether every inequality of the step holds on all of it: exact, rounding nothing."""
    length = step.length
    both = [Bernstein.with_derivative(step.controls[name], length) for name in system.names]
    x, dx = [value for value, _ in both], [slope for _, slope in both]
    return all(c.is_nonnegative() for c in system.conditions(step.gain_square, x, dx, step.modes))


def _clip(piece: Piece, start: Fraction, stop: Fraction) -> Piece:
    """Return the part of a piece inside [start, stop], as a piece of its own."""
    if piece.start >= start and piece.end <= stop:
        return piece
    first, last = max(piece.start, start), min(piece.end, stop)
    offset = (first - piece.start) / piece.length
    return Piece(first, last, poly.compose_affine(piece.shape, offset, (last - first) / piece.length))

"""The converged filter: R for b0 = 1 and a periodic schedule, in closed form.

On each polynomial piece of g^2, R' = -lambda R + 2 g^2 has the solution q(t) + C exp(-lambda (t - t0))
with one polynomial q; periodicity fixes C. Its minimum bounds inf R of every trajectory from
above: 1 + b0 <= 2, and any start is forgotten (whatever R(0), limit inferior <= this minimum).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, final

from ...models.schedule import Schedule
from ...models.schedule import polynomial as poly
from ...models.schedule.piecewise import Piece
from ..exact.ball import ball, float_above, float_below, horner
from ..exact.bisection import Box, minimum_below

RELATIVE_WIDTH = 1e-9
MAX_EVALUATIONS = 20_000


@final
@dataclass(frozen=True)
class ConvergedFloor:
    """Enclosure of the least converged R and where it is attained.

    Attributes
    ----------
    low, high : bounds of the minimum, s
    instant : a time in the period at which R <= high, s
    """

    low: float
    high: float
    instant: float


@final
@dataclass(frozen=True)
class _Solution:
    """R on one piece: q in tau = t - start, and R at the start as a ball."""

    piece: Piece
    particular: poly.Coefficients
    decay: Fraction
    initial: Any

    def value(self, tau: Any) -> Any:
        """R at start + tau; tau and the result are balls."""
        particular = [ball(c) for c in self.particular]
        free = self.initial - horner(particular, ball(0))
        return horner(particular, tau) + free * (-ball(self.decay) * tau).exp()

    def rate(self, low: Any, high: Any) -> Any:
        """Ball around R' on [low, high], from R' = -lambda R + 2 g^2 and a ball around R there.

        R is at least R(low) exp(-lambda (high - low)) and at most R(low) plus the integral of 2 g^2,
        however small R is beside g^2. (The closed form itself cancels badly on intervals.)
        """
        g = horner([ball(c) for c in self.piece.shape], low.union(high) / ball(self.piece.length))
        width = high - low
        intake = 2 * (g * g).union(ball(0))
        first = self.value(low)
        value = (first * (-ball(self.decay) * width).exp()).union(first + intake * width)
        return 2 * g * g - ball(self.decay) * value


def particular_solution(gain: poly.Coefficients, decay: Fraction) -> poly.Coefficients:
    """Polynomial q with q' + lambda q = 2 g^2, exact."""
    forcing = poly.scale(poly.multiply(gain, gain), Fraction(2))
    q: poly.Coefficients = ()
    term = forcing
    factor = 1 / decay
    while term:
        q = poly.add(q, poly.scale(term, factor))
        term = poly.derivative(term)
        factor = -factor / decay
    return q


@final
@dataclass(frozen=True)
class ConvergedFilter:
    """The periodic steady state of the filter for b0 = 1.

    Attributes
    ----------
    schedule : periodic schedule
    decay : lambda, 1/s, > 0
    """

    schedule: Schedule
    decay: Fraction

    def __post_init__(self) -> None:
        if self.schedule.period is None:
            raise ValueError("a converged filter needs a periodic schedule")
        if self.decay <= 0:
            raise ValueError(f"lambda must be > 0, received {float(self.decay):g}")

    @cached_property
    def _solutions(self) -> tuple[_Solution, ...]:
        forced = self._march(ball(0))
        last = forced[-1]
        end = last.value(ball(last.piece.length))
        forgotten = (-ball(self.decay) * ball(self.schedule.end)).exp()
        return self._march(end / (1 - forgotten))

    def _march(self, initial: Any) -> tuple[_Solution, ...]:
        solutions: list[_Solution] = []
        for piece in self.schedule.profile.pieces:
            q = particular_solution(piece.local_coefficients(), self.decay)
            solutions.append(_Solution(piece, q, self.decay, initial))
            initial = solutions[-1].value(ball(piece.length))
        return tuple(solutions)

    def at(self, t: Fraction) -> tuple[float, float]:
        """Floats around R(t), s, for t in [0, period]."""
        inside = (s for s in self._solutions if s.piece.start <= t <= s.piece.end)
        solution = next(inside)
        value = solution.value(ball(t - solution.piece.start))
        return float_below(value), float_above(value)

    def floor(self) -> ConvergedFloor:
        """Enclosure of the least R over a period."""
        high, instant = min((_attained(s) for s in self._solutions), key=lambda pair: pair[0])
        low = min(_lower_bound(s, high * (1 - RELATIVE_WIDTH)) for s in self._solutions)
        return ConvergedFloor(max(min(low, high), 0.0), high, instant)  # R is positive whatever is enclosed


def _attained(solution: _Solution) -> tuple[float, float]:
    """Small value of R on one piece, rounded up, and its time: a scan, then thirds of the best cell."""
    length = solution.piece.length

    def value(share: Fraction) -> float:
        return float_above(solution.value(ball(share * length)))

    shares = [Fraction(i, 32) for i in range(33)]
    best = min(shares, key=value)
    low, high = max(best - Fraction(1, 32), Fraction(0)), min(best + Fraction(1, 32), Fraction(1))
    for _ in range(50):
        a, b = Fraction(float((2 * low + high) / 3)), Fraction(float((low + 2 * high) / 3))
        low, high = (low, b) if value(a) < value(b) else (a, high)
    best = min(best, low, high, key=value)
    return value(best), float(solution.piece.start + best * length)


def _lower_bound(solution: _Solution, target: float) -> float:
    """Proved lower bound of R on one piece, at least `target` if that is true and easy."""

    def bound(box: Box) -> float:
        ((a, b),) = box
        rate = solution.rate(ball(a), ball(b))
        if float_below(rate) >= 0 or float_above(rate) <= 0:  # monotone: an end is least
            return min(float_below(solution.value(ball(t))) for t in (a, b))
        middle = Fraction(a) / 2 + Fraction(b) / 2
        reach = abs(rate) * ball(Fraction(b) - Fraction(a)) / 2
        return float_below(solution.value(ball(middle)) - reach)

    box = ((0.0, float_above(ball(solution.piece.length))),)
    return minimum_below(bound, box, target=target, max_evaluations=MAX_EVALUATIONS).value

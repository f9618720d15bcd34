"""Differential inequalities stated once, over any numbers: floats search for bounds, polynomials prove them.

A law's comparison system writes the slopes of its components with + - * / alone. Evaluated in floats they
propose a step; evaluated in exact Bernstein polynomials the same lines are the conditions that prove it; in
sizes, where every minus is a plus, they give the scale of the slack. Nothing is typed twice.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, final

from ..exact.bernstein import Bernstein, Quotient
from .stepping import ComparisonSystem, Modes

Slope = Any
"""A number of the arithmetic at hand; a tuple of them where the slope must be safe for each."""


class StatedSystem(ComparisonSystem):
    """A comparison system with its inequalities in one place.

    Parameters
    ----------
    **numbers : the law's parameters and the bounds of the body, exact or floats (at their binary value)
    """

    def __init__(self, **numbers: Fraction | float) -> None:
        self.floats = SimpleNamespace(**{name: float(value) for name, value in numbers.items()})
        self.exact = SimpleNamespace(**{name: Bernstein.constant(v) for name, v in numbers.items()})
        self.sizes = SimpleNamespace(**{name: Size(abs(float(value))) for name, value in numbers.items()})

    @abstractmethod
    def slopes(self, G: Any, x: Sequence[Any], modes: Modes, n: Any) -> Mapping[str, Slope]:
        """Return for each component the slope that its bound must have at least (at most, if it is lower).

        That is the greatest (least) slope that the bounded quantity can have where it touches the bound, the
        others anywhere within theirs. A component left out is given up: its bound stays as it is, and nothing
        is said of it but what `signs_of` says.

        Parameters
        ----------
        G : Any
            g^2.
        x : Sequence[Any]
            Components in the order of `names`.
        modes : Modes
            Which of the inequalities hold, as `choices` gives them.
        n : Any
            The numbers given when the system was built, in the same arithmetic.
        """

    @abstractmethod
    def signs_of(self, x: Sequence[Any], modes: Modes, n: Any) -> Iterator[Any]:
        """Everything that must be >= 0 for the slopes to be right; also what is divided by."""

    def pushed(
        self, slopes: Mapping[str, float], state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Push each slope outwards by `slack` times the size of its terms at g^2 = `peak`."""
        if slack == 0.0:
            return tuple(slopes.get(name, 0.0) for name in self.names)
        terms = self.slopes(Size(peak), [Size(abs(v)) for v in state], modes, self.sizes)
        sizes = {name: max(_each(slope), key=float) for name, slope in terms.items()}
        return tuple(
            slopes.get(name, 0.0) + sign * slack * float(sizes.get(name, 0.0))
            for name, sign in zip(self.names, self.signs, strict=True)
        )

    def rate(
        self, gain_square: float, state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Slopes in floats, pushed outwards; of several that must all be safe, the outermost."""
        slopes = dict(self.slopes(gain_square, state, modes, self.floats))
        for name, value in slopes.items():
            if type(value) is tuple:
                slopes[name] = outermost(value, self.signs[self.names.index(name)])
        return self.pushed(slopes, state, modes, peak, slack)

    def conditions(
        self, gain_square: Bernstein, x: Sequence[Bernstein], dx: Sequence[Bernstein], modes: Modes
    ) -> Iterator[Bernstein]:
        """Polynomials >= 0 iff every bound holds; the signs they rest on among them."""
        yield from self.signs_of(x, modes, self.exact)
        slopes = self.slopes(gain_square, x, modes, self.exact)
        for name, sign, slope in zip(self.names, self.signs, dx, strict=True):
            for stated in _each(slopes.get(name, ())):
                gap = slope - stated if sign > 0 else stated - slope
                yield gap.numerator if isinstance(gap, Quotient) else gap


def outermost(slope: Slope, sign: int) -> float:
    """Of slopes that must all be safe, in floats, the one that asks most of the bound."""
    values = _each(slope)
    return float(max(values) if sign > 0 else min(values))


def _each(slope: Slope) -> tuple[Any, ...]:
    return slope if isinstance(slope, tuple) else (slope,)


@final
class Size(float):
    """The size of a sum's terms: minus is plus."""

    def __add__(self, other: float) -> Size:
        return Size(float(self) + abs(float(other)))

    __radd__ = __add__
    __sub__ = __add__
    __rsub__ = __add__

    def __neg__(self) -> Size:
        return self

    def __mul__(self, other: float) -> Size:
        return Size(float(self) * abs(float(other)))

    __rmul__ = __mul__

    def __truediv__(self, other: float) -> Size:
        return Size(float(self) / abs(float(other)) if other else 0.0)

    def __rtruediv__(self, other: float) -> Size:
        return Size(abs(float(other)) / float(self) if self else 0.0)

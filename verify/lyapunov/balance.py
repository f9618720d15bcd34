"""Units for a search: powers of two in which the coefficients of a problem are near 1.

A solver of cone programs works to an absolute accuracy. In kilograms and seconds the terms of V' may
differ by ten orders of magnitude, in grams and milliseconds by others; what is found, and whether, must
not depend on that. Scaling every symbol, every group of terms and the rate by powers of two is exact,
and the powers that bring all coefficients nearest to 1 (least squares of their logarithms) follow any
change of units.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import log2
from typing import final

import numpy as np

from ..exact import matrix
from ..exact.polynomial import Exponents, Ring
from .gram_search import Gram
from .sums_of_squares import BLOCKS, Target

Problem = tuple[Ring, list[Target]]
_FIXED = {*BLOCKS[0], "g"}
"""Numbers without a unit: the attitude, which the sphere ties together, and g, which has a largest value."""


@final
@dataclass(frozen=True)
class Balance:
    """Powers of two: of each symbol, of each group of terms (by its common factor), of the rate, 1/s."""

    symbols: tuple[int, ...]
    groups: dict[tuple[tuple[str, int], ...], int]
    rate: int

    @property
    def unit(self) -> Fraction:
        """The rate, 1/s, that is 1 to the search."""
        return _power(self.rate)

    def scaled(self, problem: Problem) -> Problem:
        """Return a problem in these units."""
        ring, targets = problem
        return ring, [self._target(target) for target in targets]

    def _target(self, target: Target) -> Target:
        group = self.groups[_name(target)]
        fixed = {key: value * _power(group + self._of(key)) for key, value in target.fixed.items()}
        beside = {
            key: value * _power(group + self.rate + self._of(key)) for key, value in target.reference.items()
        }
        return replace(target, fixed=fixed, reference=beside)

    def restored(self, target: Target, gram: Gram) -> Gram:
        """Return a Gram matrix of a scaled target in the units of the problem."""
        group, basis = self.groups[_name(target)], gram.square.basis
        rows = [
            [x * _power(-group - self._of(a) - self._of(b)) for x, b in zip(row, basis, strict=True)]
            for row, a in zip(gram.matrix, basis, strict=True)
        ]
        return Gram(gram.square, matrix.rows(matrix.of(rows)))

    def _of(self, key: Exponents) -> int:
        return sum(e * power for e, power in zip(key, self.symbols, strict=True))


def balance(problems: Sequence[Problem]) -> Balance:
    """Choose the powers for problems of one ring and like terms."""
    ring = problems[0][0]
    place = {name: _unknown(name) for name in ring.names if name not in _FIXED}
    unknowns = sorted(set(place.values()))
    names = sorted({_name(target) for _, targets in problems for target in targets})
    rows: list[list[float]] = []
    right: list[float] = []
    for _, targets in problems:
        for target in targets:
            for terms, beside in ((target.fixed, 0.0), (target.reference, 1.0)):
                for key, value in terms.items():
                    powers = _powers(ring, place, unknowns, key)
                    group = [float(name == _name(target)) for name in names]
                    rows.append([*powers, *group, beside])
                    right.append(-_logarithm(value))
    found = np.rint(np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]).astype(int).tolist()
    by_symbol = dict(zip(unknowns, found, strict=False))
    symbols = tuple(by_symbol[place[name]] if name in place else 0 for name in ring.names)
    groups = dict(zip(names, found[len(unknowns) : -1], strict=True))
    return Balance(symbols, groups, found[-1])


def _unknown(name: str) -> str:
    """The three rates share a unit; every other symbol has its own."""
    return BLOCKS[1][0] if name in BLOCKS[1] else name


def _powers(ring: Ring, place: dict[str, str], unknowns: list[str], key: Exponents) -> list[float]:
    row = dict.fromkeys(unknowns, 0.0)
    for name, e in zip(ring.names, key, strict=True):
        if name in place:
            row[place[name]] += e
    return list(row.values())


def _name(target: Target) -> tuple[tuple[str, int], ...]:
    return tuple(sorted(target.common.items()))


def _logarithm(value: Fraction) -> float:
    """Logarithm to base 2 of |value|, whatever its size."""
    return log2(abs(value.numerator)) - log2(value.denominator)


def _power(exponent: int) -> Fraction:
    return Fraction(2) ** exponent

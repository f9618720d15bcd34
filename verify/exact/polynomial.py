"""Polynomials in named symbols over the rationals, by python-flint; some symbols may have negative powers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, final

from flint import Ordering, fmpq_mpoly_ctx

from .rational import fraction, rational

Exponents = tuple[int, ...]
Terms = Mapping[Exponents, Fraction]
MAX_TERMS = 3000
"""Terms of a polynomial: beyond, a law's expression is not one that anybody wrote down."""


class NotPolynomialError(ArithmeticError):
    """A division that leaves the ring, or an expression that grows beyond `MAX_TERMS`."""


@final
class Ring:
    """Polynomials in some symbols; those named `invertible` are known to be positive and may be divided by.

    Parameters
    ----------
    names : names of the symbols, each once
    invertible : those of them that may have negative powers

    Raises
    ------
    NotPolynomialError
        If two symbols have one name.
    """

    def __init__(self, names: Sequence[str], invertible: Sequence[str] = ()) -> None:
        if len(set(names)) != len(names):
            raise NotPolynomialError("two symbols have one name")
        self.names = tuple(names)
        self.index = {name: i for i, name in enumerate(self.names)}
        self.invertible = frozenset(self.index[name] for name in invertible)
        self.flint = fmpq_mpoly_ctx.get(self.names, Ordering.degrevlex)
        self.one: Exponents = (0,) * len(self.names)

    def __reduce__(self) -> tuple[Any, ...]:
        return Ring, (self.names, tuple(self.names[i] for i in sorted(self.invertible)))

    def constant(self, value: Fraction | float | int) -> Polynomial:
        """Return a number as a polynomial, a float at its binary value."""
        return Polynomial(self, self.flint.constant(rational(value)), self.one)

    def symbol(self, name: str) -> Polynomial:
        """Return a symbol as a polynomial."""
        return Polynomial(self, self.flint.gen(self.index[name]), self.one)

    def polynomial(self, terms: Terms) -> Polynomial:
        """Return the polynomial of these terms; exponents >= 0."""
        return Polynomial(self, self.flint.from_dict({e: rational(c) for e, c in terms.items()}), self.one)


@final
class Polynomial:
    """One polynomial, immutable: a flint polynomial over a monomial of invertible symbols.

    Attributes
    ----------
    ring : Ring
    above : fmpq_mpoly
    below : exponents of the monomial that divides it
    """

    def __init__(self, ring: Ring, above: Any, below: Exponents) -> None:
        self.ring, self.above, self.below = ring, above, below

    def __reduce__(self) -> tuple[Any, ...]:
        powers = {tuple(map(int, e)): fraction(c) for e, c in self.above.to_dict().items()}
        return _restored, (self.ring, powers, self.below)

    @cached_property
    def terms(self) -> Terms:
        """Exponents -> coefficient, none of them zero."""
        pairs = self.above.to_dict().items()
        return {tuple(int(a) - b for a, b in zip(e, self.below, strict=True)): fraction(c) for e, c in pairs}

    @property
    def degree(self) -> int:
        """Total degree; 0 for a constant."""
        return max((sum(e) for e in self.terms), default=0)

    def coefficient(self, exponents: Exponents) -> Fraction:
        """Return one coefficient, 0 if the monomial does not occur."""
        return self.terms.get(exponents, Fraction(0))

    def __bool__(self) -> bool:
        return bool(self.above)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Polynomial)
            and self.ring.names == other.ring.names
            and self.terms == other.terms
        )

    def __hash__(self) -> int:
        return hash(frozenset(self.terms.items()))

    def _over(self, below: Exponents) -> Any:
        """What stands above a multiple of the own denominator."""
        if below == self.below:
            return self.above
        extra = tuple(b - own for b, own in zip(below, self.below, strict=True))
        return self.above * self.ring.flint.term(exp_vec=extra)

    def __add__(self, other: Polynomial | Fraction | int) -> Polynomial:
        if not isinstance(other, Polynomial):
            other = self.ring.constant(other)
        below = tuple(map(max, self.below, other.below))
        return self._new(self._over(below) + other._over(below), below)

    __radd__ = __add__

    def __neg__(self) -> Polynomial:
        return Polynomial(self.ring, -self.above, self.below)

    def __sub__(self, other: Polynomial | Fraction | int) -> Polynomial:
        return self + (-other)

    def __rsub__(self, other: Polynomial | Fraction | int) -> Polynomial:
        return -self + other

    def __mul__(self, other: Polynomial | Fraction | int) -> Polynomial:
        if not isinstance(other, Polynomial):
            return Polynomial(self.ring, self.above * rational(other), self.below)
        if len(self.above) * len(other.above) > MAX_TERMS**2:
            raise NotPolynomialError("a polynomial has too many terms")
        return self._new(self.above * other.above, tuple(map(int.__add__, self.below, other.below)))

    __rmul__ = __mul__

    def __truediv__(self, other: Polynomial) -> Polynomial:
        return self * other.inverse()

    def __rtruediv__(self, other: Fraction | int) -> Polynomial:
        return self.inverse() * other

    def inverse(self) -> Polynomial:
        """Return 1 / this; only a number or a monomial of invertible symbols has one.

        Raises
        ------
        NotPolynomialError
            If this is neither.
        """
        terms = list(self.terms.items())
        if len(terms) != 1:
            raise NotPolynomialError("division by something that is not a monomial of positive symbols")
        ((powers, value),) = terms
        if any(e and i not in self.ring.invertible for i, e in enumerate(powers)):
            raise NotPolynomialError("division by a symbol not known to be positive")
        above = self.ring.flint.term(coeff=1 / rational(value), exp_vec=tuple(max(-e, 0) for e in powers))
        return Polynomial(self.ring, above, tuple(max(e, 0) for e in powers))

    def __pow__(self, power: int) -> Polynomial:
        if power < 0:
            return self.inverse() ** -power
        result = self.ring.constant(1)
        for _ in range(power):
            result = result * self
        return result

    def derivative(self, symbol: int) -> Polynomial:
        """Return the partial derivative with respect to the symbol of that number."""
        if self.below[symbol]:
            raise NotPolynomialError("the derivative by a divisor is not needed here")
        return Polynomial(self.ring, self.above.derivative(symbol), self.below)

    def modulo(self, other: Polynomial) -> Polynomial:
        """Return the remainder of the division by a polynomial, with respect to its leading term."""
        return Polynomial(self.ring, self.above % other.above, self.below)

    def substitute(self, name: str, value: Polynomial) -> Polynomial:
        """Replace a symbol by a polynomial; by one with an inverse where the symbol has negative powers."""
        i = self.ring.index[name]
        groups: dict[int, dict[Exponents, Fraction]] = {}
        rest = (*self.below[:i], 0, *self.below[i + 1 :])
        for powers, c in self.terms.items():
            kept = tuple(map(int.__add__, (*powers[:i], 0, *powers[i + 1 :]), rest))
            groups.setdefault(powers[i], {})[kept] = c
        result = self.ring.constant(0)
        for power, terms in groups.items():
            part = self.ring.polynomial(terms)
            result = result + Polynomial(self.ring, part.above, rest) * value**power
        return result

    def moved(self, centre: Sequence[Fraction]) -> Polynomial:
        """Return t -> p(centre + t), the Taylor coefficients at a point, of a polynomial without divisors."""
        moves = [x + rational(c) for x, c in zip(self.ring.flint.gens(), centre, strict=True)]
        return Polynomial(self.ring, self.above.compose(*moves), self.below)

    def _new(self, above: Any, below: Exponents) -> Polynomial:
        if len(above) > MAX_TERMS:
            raise NotPolynomialError("a polynomial has too many terms")
        return Polynomial(self.ring, above, below)


def _restored(ring: Ring, powers: Terms, below: Exponents) -> Polynomial:
    return Polynomial(ring, ring.polynomial(powers).above, below)

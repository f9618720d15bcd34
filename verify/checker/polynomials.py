"""Polynomials in named symbols over the rationals, and programs that make them."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TypeVar

from .exact_numbers import MAX_DIGITS, Invalid, exact, require, show
from .reading import Node

Exponents = tuple[int, ...]


class Ring:
    """Polynomials in named symbols over the rationals; symbols known to be positive may be inverted."""

    def __init__(self, names: Sequence[str], invertible: Sequence[str] = ()) -> None:
        if len(set(names)) != len(names):
            raise Invalid("two symbols have one name")
        self.names = tuple(names)
        self.index = {name: i for i, name in enumerate(self.names)}
        self.invertible = frozenset(self.index[name] for name in invertible)
        self.one: Exponents = (0,) * len(self.names)

    def constant(self, value: Fraction | int) -> Poly:
        """Return a number as a polynomial."""
        return Poly(self, {self.one: Fraction(value)} if value else {})

    def symbol(self, name: str) -> Poly:
        """Return a symbol as a polynomial."""
        if name not in self.index:
            raise Invalid(f"there is no symbol {name!r} here")
        i = self.index[name]
        return Poly(self, {(*self.one[:i], 1, *self.one[i + 1 :]): Fraction(1)})


class Poly:
    """One (Laurent) polynomial: exponents -> coefficient, without zero coefficients."""

    __slots__ = ("ring", "terms")

    def __init__(self, ring: Ring, terms: dict[Exponents, Fraction]) -> None:
        self.ring = ring
        self.terms = terms

    def __add__(self, other: Poly) -> Poly:
        terms = dict(self.terms)
        for key, value in other.terms.items():
            total = terms.get(key, 0) + value
            if total:
                terms[key] = total
            else:
                terms.pop(key, None)
        return Poly(self.ring, terms)

    def __neg__(self) -> Poly:
        return Poly(self.ring, {key: -value for key, value in self.terms.items()})

    def __sub__(self, other: Poly) -> Poly:
        return self + (-other)

    def __mul__(self, other: Poly) -> Poly:
        require(len(self.terms) * len(other.terms) <= MAX_TERMS**2, "a polynomial has too many terms")
        terms: dict[Exponents, Fraction] = {}
        for left, a in self.terms.items():
            for right, b in other.terms.items():
                key = tuple(map(int.__add__, left, right))
                terms[key] = terms.get(key, 0) + a * b
        return Poly(self.ring, {key: value for key, value in terms.items() if value})

    def scaled(self, factor: Fraction | int) -> Poly:
        """Return factor times this."""
        return Poly(self.ring, {k: v * factor for k, v in self.terms.items()} if factor else {})

    def inverse(self) -> Poly:
        """Return 1 / this; only a number or a monomial of positive symbols has one."""
        if len(self.terms) != 1:
            raise Invalid("division by something that is not a monomial of positive symbols")
        ((key, value),) = self.terms.items()
        if any(e and i not in self.ring.invertible for i, e in enumerate(key)):
            raise Invalid("division by a symbol not known to be positive")
        return Poly(self.ring, {tuple(-e for e in key): 1 / value})

    def power(self, n: int) -> Poly:
        """Return the n-th power, n >= 0, or any n for a monomial of positive symbols."""
        if n < 0:
            return self.inverse().power(-n)
        result = self.ring.constant(1)
        for _ in range(n):
            result = result * self
        return result

    def derivative(self, name: str) -> Poly:
        """Return the partial derivative with respect to a symbol."""
        i = self.ring.index[name]
        terms = {(*k[:i], k[i] - 1, *k[i + 1 :]): v * k[i] for k, v in self.terms.items() if k[i]}
        return Poly(self.ring, terms)

    def substitute(self, name: str, value: Poly) -> Poly:
        """Replace a symbol by a polynomial."""
        i = self.ring.index[name]
        groups: dict[int, dict[Exponents, Fraction]] = {}
        for key, coefficient in self.terms.items():
            groups.setdefault(key[i], {})[(*key[:i], 0, *key[i + 1 :])] = coefficient
        result = self.ring.constant(0)
        for exponent, terms in groups.items():
            result = result + Poly(self.ring, terms) * value.power(exponent)
        return result

    def at(self, values: dict[str, Fraction]) -> Fraction:
        """Return the value at given numbers for the symbols that occur."""
        total = Fraction(0)
        for key, coefficient in self.terms.items():
            for name, e in zip(self.ring.names, key, strict=True):
                if e:
                    coefficient *= values[name] ** e
            total += coefficient
        return total

    def uses(self, name: str) -> bool:
        """Whether a symbol occurs."""
        i = self.ring.index[name]
        return any(key[i] for key in self.terms)

    def text(self, limit: int | None = None) -> str:
        """Return the polynomial for people, whole or its first terms only."""
        parts: list[str] = []
        for key, value in sorted(self.terms.items(), reverse=True)[:limit]:
            powers = [
                name + (f"^{e}" if e != 1 else "") for name, e in zip(self.ring.names, key, strict=True) if e
            ]
            factor = [] if abs(value) == 1 and powers else [show(abs(value))]
            parts.append(("- " if value < 0 else "+ ") + " ".join(factor + powers))
        if limit is not None and len(self.terms) > limit:
            parts.append(f"+ ... ({len(self.terms)} terms)")
        return " ".join(parts).removeprefix("+ ") or "0"


MAX_TERMS = 3000
MAX_POWER = 60
MAX_BASIS = 400
"""Terms of a polynomial, powers in it, monomials of a Gram matrix: beyond, checking could take for ever."""


def require_modest(p: Poly, path: str) -> None:
    """Refuse a polynomial whose powers or numbers have grown beyond anything a law needs."""
    require(len(p.terms) <= MAX_TERMS, f"{path}: a polynomial has too many terms")
    powers = (abs(e) for key in p.terms for e in key)
    require(max(powers, default=0) <= MAX_POWER, f"{path}: a power is too high")
    sizes = (v.numerator.bit_length() + v.denominator.bit_length() for v in p.terms.values())
    require(max(sizes, default=0) <= 8 * MAX_DIGITS, f"{path}: a number is too long")


def on_sphere(p: Poly) -> Poly:
    """Return the normal form on |b| = 1: c^2 = 2 c - b1^2 - b2^2 - b3^2, where c = 1 - b0."""
    ring = p.ring
    i = ring.index["c"]
    c = ring.symbol("c")
    square = c.scaled(2)
    for name in ("b1", "b2", "b3"):
        square = square - ring.symbol(name).power(2)
    while any(key[i] > 1 for key in p.terms):
        low = {key: v for key, v in p.terms.items() if key[i] < 2}
        high = {(*k[:i], k[i] - 2, *k[i + 1 :]): v for k, v in p.terms.items() if k[i] > 1}
        p = Poly(ring, low) + Poly(ring, high) * square
    return p


_BINARY: dict[str, Callable[[Poly, Poly], Poly]] = {
    "add": lambda x, y: x + y,
    "sub": lambda x, y: x - y,
    "mul": lambda x, y: x * y,
    "div": lambda x, y: x * y.inverse(),
}
_UNARY: dict[str, Callable[[Poly], Poly]] = {
    "assign": lambda x: x,
    "neg": lambda x: -x,
    "sq": lambda x: x * x,
    "twice": lambda x: x.scaled(2),
    "inv": lambda x: x.inverse(),
}
TARGET = re.compile(r"v[0-9]{1,7}")


def run(program: Node, ring: Ring, symbols: dict[str, Poly]) -> dict[str, Poly]:
    """Carry out a program: lines "v7 = mul b1 v3" or "v2 = const 1/2", each name assigned once."""
    values = dict(symbols)
    for line in program.items():
        words = line.text().split()
        require(len(words) in (4, 5) and words[1] == "=", f"{line.path}: not an instruction")
        target, operation, operands = words[0], words[2], words[3:]
        require(
            bool(TARGET.fullmatch(target)) and target not in values, f"{line.path}: {target} assigned twice"
        )
        if operation == "const" and len(operands) == 1:
            values[target] = ring.constant(exact(operands[0]))
            continue
        require(all(name in values for name in operands), f"{line.path}: an operand is not defined")
        if operation in _UNARY and len(operands) == 1:
            values[target] = _UNARY[operation](values[operands[0]])
        elif operation in _BINARY and len(operands) == 2:
            values[target] = _BINARY[operation](values[operands[0]], values[operands[1]])
        else:
            raise Invalid(f"{line.path}: there is no operation {operation!r} of {len(operands)} operands")
        require_modest(values[target], line.path)
    return values


def pick(values: dict[str, Poly], place: Node) -> Poly:
    """Return the value that a place in the file names."""
    name = place.text()
    require(name in values, f"{place.path}: {name!r} is not defined")
    return values[name]


Triple = list[Poly]

Entry = TypeVar("Entry", int, Fraction, Poly)


def cross(x: Sequence[Entry], y: Sequence[Entry]) -> list[Entry]:
    """Return x cross y."""
    return [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]


def total(terms: Sequence[Poly], ring: Ring) -> Poly:
    """Return the sum."""
    result = ring.constant(0)
    for term in terms:
        result = result + term
    return result


def apply(A: Sequence[Sequence[Poly]], x: Triple, ring: Ring) -> Triple:
    """Return the product of a 3 by 3 matrix and a vector."""
    return [total([A[i][j] * x[j] for j in range(3)], ring) for i in range(3)]

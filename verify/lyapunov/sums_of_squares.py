"""Sums of squares on the unit sphere of quaternions: what may be squared, and what it multiplies to.

A polynomial in normal form (c^2 = 2 c - |bv|^2, c = 1 - b0) is to be written as
sum of factor_i times z_i'G_i z_i, every factor known to be >= 0. This file sets the linear
equations for the entries of G_i; finding and rounding them is elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, product
from typing import final

from ..exact.polynomial import Exponents, Polynomial, Ring

Terms = dict[Exponents, Fraction]
BLOCKS = (("c", "b1", "b2", "b3"), ("y1", "y2", "y3"))
"""Symbols whose degrees count together: attitude, rate; every other symbol counts alone."""


@final
@dataclass(frozen=True)
class Square:
    """One term of the sum: factors (name -> power) times z'Gz with z the monomials of `basis`."""

    factors: tuple[tuple[str, int], ...]
    factor: Polynomial
    basis: tuple[Exponents, ...]


@final
@dataclass(frozen=True)
class Target:
    """What one group of terms must sum to, its common factor taken out: fixed - rate * reference."""

    common: Mapping[str, int]
    fixed: Terms
    reference: Terms
    squares: tuple[Square, ...]


def split(
    gap: Polynomial,
    reference: Polynomial,
    signed: Sequence[str],
    gain_bound: Fraction | None,
    known: list[Target],
) -> list[Target]:
    """Split gap - rate * reference by powers of the symbols known to be positive.

    It is enough that each group, without its factor, is a sum of squares. Squares are taken over
    from `known` targets of the same support (of other inertias, say).
    """
    ring = gap.ring
    places = [ring.index[name] for name in signed if name in ring.index]
    groups: dict[tuple[int, ...], tuple[Terms, Terms]] = {}
    for which, p in enumerate((gap, reference)):
        for key, value in p.terms.items():
            rest = tuple(0 if i in places else e for i, e in enumerate(key))
            groups.setdefault(tuple(key[i] for i in places), ({}, {}))[which][rest] = value
    targets: list[Target] = []
    for powers, (fixed, ref) in sorted(groups.items()):
        common = {ring.names[i]: e for i, e in zip(places, powers, strict=True) if e}
        support = fixed.keys() | ref.keys()
        old = (t.squares for t in (*known, *targets) if t.fixed.keys() | t.reference.keys() == support)
        squares = next(old, None) or _squares(ring, set(places), support, gain_bound)
        targets.append(Target(common, fixed, ref, squares))
    return targets


def _squares(
    ring: Ring, signed: set[int], support: Set[Exponents], gain_bound: Fraction | None
) -> tuple[Square, ...]:
    """Terms to try: the plain square, and with g and gmax - g where g occurs with an odd power."""
    choices: list[tuple[tuple[str, int], ...]] = [()]
    g = ring.index["g"]
    if gain_bound is not None and any(key[g] % 2 for key in support):
        choices += [(("g", 1),), (("gmax-g", 1),), (("g", 1), ("gmax-g", 1))]
    polynomials = [_factor(ring, choice, gain_bound) for choice in choices]
    candidates = _candidates(ring, support, signed)
    bases = _prune(ring, [(p, list(candidates)) for p in polynomials], support)
    triples = zip(choices, polynomials, bases, strict=True)
    return tuple(Square(choice, p, tuple(basis)) for choice, p, basis in triples if basis)


def _factor(ring: Ring, powers: Sequence[tuple[str, int]], gain_bound: Fraction | None) -> Polynomial:
    result = ring.constant(1)
    for name, power in powers:
        if name == "gmax-g":
            assert gain_bound is not None
            base = ring.constant(gain_bound) - ring.symbol("g")
        else:
            base = ring.symbol(name)
        result = result * base**power
    return result


def _candidates(ring: Ring, support: Set[Exponents], signed: set[int]) -> list[Exponents]:
    """Monomials of at most half the degree, block by block and in total."""
    blocks = [[ring.index[name] for name in block] for block in BLOCKS]
    used = {i for block in blocks for i in block} | signed
    blocks += [[i] for i in range(len(ring.names)) if i not in used]
    degrees = [[sum(key[i] for i in block) for key in support] for block in blocks]
    halves = [-(-max(degree, default=0) // 2) for degree in degrees]
    largest = -(-max(sum(column) for column in zip(*degrees, strict=True)) // 2)
    choices = [_block_monomials(ring, block, half) for block, half in zip(blocks, halves, strict=True)]
    found = []
    for parts in product(*choices):
        key = tuple(map(sum, zip(*parts, strict=True)))
        if sum(key) <= largest:
            found.append(key)
    return found


def _block_monomials(ring: Ring, block: Sequence[int], degree: int) -> list[Exponents]:
    """Monomials in the symbols of a block up to a degree, c at most once (its square reduces)."""
    result = []
    c = ring.index["c"]
    for d in range(degree + 1):
        for chosen in combinations_with_replacement(block, d):
            if chosen.count(c) <= 1:
                result.append(tuple(chosen.count(i) for i in range(len(ring.names))))
    return result


def square_terms(ring: Ring, factor: Polynomial, left: Exponents, right: Exponents) -> Terms:
    """Return factor * left * right in normal form, for a factor without c."""
    key = tuple(map(int.__add__, left, right))
    c = ring.index["c"]
    if key[c] < 2:
        return {tuple(map(int.__add__, key, e)): v for e, v in factor.terms.items()}
    terms: Terms = {}
    for e, v in factor.terms.items():
        total = list(map(int.__add__, key, e))
        total[c] -= 1
        terms[tuple(total)] = 2 * v
        total[c] -= 1
        for name in BLOCKS[0][1:]:
            i = ring.index[name]
            terms[(*total[:i], total[i] + 2, *total[i + 1 :])] = -v
    return terms


def _prune(
    ring: Ring, pairs: list[tuple[Polynomial, list[Exponents]]], support: Set[Exponents]
) -> list[list[Exponents]]:
    """Drop monomials whose own square nothing could cancel: their row of G is zero."""
    table = [
        {
            (i, j): square_terms(ring, factor, basis[i], basis[j])
            for i in range(len(basis))
            for j in range(i + 1)
        }
        for factor, basis in pairs
    ]
    alive = [set(range(len(basis))) for _, basis in pairs]
    changed = True
    while changed:
        changed = False
        counts: dict[Exponents, int] = {}
        for which, products in enumerate(table):
            for (i, j), terms in products.items():
                if i in alive[which] and j in alive[which]:
                    for key in terms:
                        counts[key] = counts.get(key, 0) + 1
        for which, products in enumerate(table):
            for i in sorted(alive[which]):
                leading = max(products[i, i], key=lambda key: (sum(key), key))
                own = _own_square(ring, products[i, i], leading)
                if own not in support and counts[own] == 1:
                    alive[which].discard(i)
                    changed = True
    return [[basis[i] for i in sorted(alive[w])] for w, (_, basis) in enumerate(pairs)]


def _own_square(ring: Ring, terms: Terms, leading: Exponents) -> Exponents:
    """The monomial of a square that stands for it: c u^2 where c^2 was reduced, else the square itself."""
    c = ring.index["c"]
    with_c = [key for key in terms if key[c]]
    return max(with_c, key=lambda key: (sum(key), key)) if with_c else leading

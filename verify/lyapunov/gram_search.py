"""Gram matrices: found in floating point with Clarabel, rounded to rationals that fit exactly.

Nothing here is a proof. A result solves the linear equations exactly and its matrices are
positive definite in exact arithmetic; the stand-alone checker says so again from the file.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.types import Array
from ..exact import matrix
from ..exact.matrix import Matrix
from ..exact.polynomial import Exponents, Ring
from .cone_program import maximise_level
from .rounding import fit_exactly, rational_null_space
from .sums_of_squares import Square, Target, Terms, square_terms

FACES = 4
"""How often a search may restrict itself to a face of the cone."""
FLAT = 3e-7
"""Least eigenvalue, relative to the coefficients, below which a Gram matrix counts as singular."""


@final
@dataclass(frozen=True)
class Gram:
    """One term of a sum of squares with its exact Gram matrix over the monomials of `square.basis`."""

    square: Square
    matrix: Matrix


@final
@dataclass(frozen=True)
class _Equations:
    """A h = f: entries of all reduced Gram matrices (upper triangles) against coefficients."""

    rows: tuple[Exponents, ...]
    columns: tuple[tuple[int, int, int], ...]
    matrix: list[dict[int, Fraction]]


@final
@dataclass(frozen=True)
class Face:
    """Where a search ended: the face of the cone, its equations, and a point inside it.

    The point fits neighbouring problems too (another inertia of a box), which then need no search.
    """

    squares: tuple[Square, ...]
    bases: tuple[Matrix, ...]
    equations: _Equations
    guess: tuple[float, ...]
    level: float


@final
@dataclass(frozen=True)
class RateSearch:
    """A solver's largest rate and the multipliers that bound it; floating point, evidence of nothing."""

    rate: float
    multipliers: tuple[dict[Exponents, float], ...]

    def bound(self, targets: list[Target]) -> float:
        """Upper bound on the rate of a neighbouring problem, by the same multipliers."""
        pairs = list(zip(self.multipliers, targets, strict=True))
        fixed = sum(y.get(key, 0.0) * float(v) for y, t in pairs for key, v in t.fixed.items())
        reference = sum(y.get(key, 0.0) * float(v) for y, t in pairs for key, v in t.reference.items())
        return fixed / reference if reference else np.inf


def largest_rate(ring: Ring, targets: list[Target]) -> RateSearch | None:
    """Largest rate for which every target looks like a sum of squares; None if there is none."""
    sizes: list[int] = []
    rows: list[dict[int, float]] = []
    columns: list[tuple[int, int, int]] = []
    right: list[float] = []
    reference_column: list[float] = []
    keys = []
    for target in targets:
        bases = [matrix.rows(matrix.identity(len(square.basis))) for square in target.squares]
        equations = _equations(ring, target.squares, bases)
        fixed, reference = _vector(equations, target.fixed), _vector(equations, target.reference)
        if fixed is None or reference is None:
            return None
        rows += [{len(columns) + c: float(v) for c, v in row.items()} for row in equations.matrix]
        columns += [(len(sizes) + which, p, q) for which, p, q in equations.columns]
        sizes += [len(B) for B in bases]
        right += fixed.tolist()
        reference_column += reference.tolist()
        keys.append(equations.rows)
    found = maximise_level(
        sizes=sizes,
        equations=rows,
        columns=columns,
        right=np.array(right),
        level_column=np.array(reference_column),
        shift=0.0,
        cap=1e6,
    )
    if found is None:
        return None
    ends = np.cumsum([len(k) for k in keys])[:-1]
    duals = np.split(found.multipliers, ends)
    multipliers = tuple(dict(zip(k, y.tolist(), strict=True)) for k, y in zip(keys, duals, strict=True))
    return RateSearch(found.level, multipliers)


def find_gram(
    ring: Ring, target: Target, rate: Fraction, known: Face | None
) -> tuple[list[Gram], Face] | None:
    """Exact Gram matrices for fixed - rate * reference, or None if the search finds none.

    `known` is the face of a neighbouring problem, tried before a search of one's own.
    """
    goal = dict(target.fixed)
    for key, value in target.reference.items():
        goal[key] = goal.get(key, Fraction(0)) - rate * value
    goal = {key: value for key, value in goal.items() if value}
    known = known if known is not None and known.squares == target.squares else None
    if known is not None:
        grams = _exact(known, goal)
        if grams is not None:
            return grams, known
    face = _search(ring, target, goal, None if known is None else known.bases)
    grams = None if face is None else _exact(face, goal)
    return None if grams is None or face is None else (grams, face)


def _search(ring: Ring, target: Target, goal: Terms, start: tuple[Matrix, ...] | None) -> Face | None:
    """Go down the faces of the cone, from the whole of it or from a neighbour's, to an interior point."""
    bases = (
        [matrix.rows(matrix.identity(len(square.basis))) for square in target.squares]
        if start is None
        else list(start)
    )
    for _ in range(FACES):
        equations = _equations(ring, target.squares, bases)
        f = _vector(equations, goal)
        solved = None if f is None else _interior(equations, bases, f)
        if f is None or solved is None:
            return None
        level, grams = solved
        scale = max(1.0, float(np.max(np.abs(f), initial=0.0)))
        if level > FLAT * scale:
            return Face(target.squares, tuple(bases), equations, tuple(_upper(grams)), level)
        reduced = [rational_null_space(G, B, FLAT * 100 * scale) for G, B in zip(grams, bases, strict=True)]
        if all(len(new) == len(old) for new, old in zip(reduced, bases, strict=True)) or not any(reduced):
            return None
        bases = reduced
    return None


def _exact(face: Face, goal: Terms) -> list[Gram] | None:
    """Gram matrices on a face that fit the goal exactly; None if they do not exist or are not definite."""
    rows = face.equations.rows
    if not set(goal) <= set(rows):
        return None
    right = [goal.get(key, Fraction(0)) for key in rows]
    entries = fit_exactly(face.equations.matrix, right, list(face.guess), face.level)
    return None if entries is None else _assemble(face, entries)


def _equations(ring: Ring, squares: tuple[Square, ...], bases: list[Matrix]) -> _Equations:
    """Linear equations between reduced Gram entries H (G = B'HB) and coefficients."""
    columns: list[tuple[int, int, int]] = []
    effects: list[Terms] = []
    for which, (square, B) in enumerate(zip(squares, bases, strict=True)):
        products = {
            (i, j): square_terms(ring, square.factor, square.basis[i], square.basis[j])
            for i in range(len(square.basis))
            for j in range(i + 1)
        }
        sparse = [[(i, x) for i, x in enumerate(row) if x] for row in B]
        for p in range(len(B)):
            for q in range(p, len(B)):
                effect: Terms = {}
                for i, x in sparse[p]:
                    for j, y in sparse[q]:
                        weight = x * y * (1 if p == q else 2)
                        for key, value in products[max(i, j), min(i, j)].items():
                            effect[key] = effect.get(key, Fraction(0)) + weight * value
                columns.append((which, p, q))
                effects.append(effect)
    rows = sorted({key for effect in effects for key in effect})
    position = {key: n for n, key in enumerate(rows)}
    matrix: list[dict[int, Fraction]] = [{} for _ in rows]
    for n, effect in enumerate(effects):
        for key, value in effect.items():
            if value:
                matrix[position[key]][n] = value
    return _Equations(tuple(rows), tuple(columns), matrix)


def _vector(equations: _Equations, terms: Terms) -> Array | None:
    """Coefficients in the order of the rows; None if some monomial is out of reach."""
    if not set(terms) <= set(equations.rows):
        return None
    return np.array([float(terms.get(key, 0)) for key in equations.rows])


def _interior(equations: _Equations, bases: list[Matrix], f: Array) -> tuple[float, list[Array]] | None:
    """Gram matrices with the largest least eigenvalue, and that eigenvalue."""
    found = maximise_level(
        sizes=[len(B) for B in bases],
        equations=[{c: float(v) for c, v in row.items()} for row in equations.matrix],
        columns=equations.columns,
        right=f,
        level_column=np.zeros(len(f)),
        shift=1.0,
        cap=1e3,
    )
    return None if found is None else (found.level, list(found.matrices))


def _upper(grams: list[Array]) -> list[float]:
    return [float(G[p, q]) for G in grams for p in range(len(G)) for q in range(p, len(G))]


def _assemble(face: Face, entries: list[Fraction]) -> list[Gram] | None:
    """Gram matrices over the monomials from exact entries; None if one is not positive definite."""
    reduced = [[[Fraction(0)] * len(B) for _ in B] for B in face.bases]
    for (which, p, q), value in zip(face.equations.columns, entries, strict=True):
        reduced[which][p][q] = value
        reduced[which][q][p] = value
    result = []
    for square, B, H in zip(face.squares, face.bases, reduced, strict=True):
        if not B:
            continue
        if not matrix.is_positive_definite(H):
            return None
        result.append(Gram(square, matrix.congruent(H, B)))
    return result

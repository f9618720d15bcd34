"""Kind floquet: multipliers of a periodic linear plant."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from itertools import pairwise
from operator import mul

from .bernstein import Form, power_coefficients
from .exact_numbers import Matrix, require, show
from .floquet_exact import read_plant
from .kinds import kind
from .matrices import is_positive_definite, is_symmetric, matrix_product, norm
from .reading import Node
from .schedules import Profile

TERMS = 30
GRID = 2**128
"""Entries are multiples of 1/GRID; what is rounded away enters the radius."""

Grid = list[list[int]]
Enclosed = tuple[Grid, Fraction]
"""A matrix in multiples of 1/GRID, and a bound of the largest row sum of its error."""


def grid_product(A: Grid, B: Grid) -> Grid:
    """Return the product of two matrices of multiples of 1/GRID, rounded down: off by < 1/GRID an entry."""
    columns = list(zip(*B, strict=True))
    return [[sum(map(mul, row, column)) // GRID for column in columns] for row in A]


def monodromy(A: Matrix, F: Matrix, profile: Profile) -> tuple[Matrix, Fraction]:
    """Enclose the matrix that takes x(0) to x(T) for x' = (A - g(t) F) x: a centre and a radius.

    The radius bounds the largest row sum of the error. Each piece of g is cut so that the Taylor
    series of the transition matrix converges fast; its tail is bounded by a majorant. Where g is constant
    one step is squared; products are taken in pairs, so that the error grows with the transition matrices
    themselves, which stay small where the plant does, and not with the product of the steps' norms.
    """
    pieces = (across(A, F, profile, start, stop) for start, stop in pairwise(profile.knots))
    centre, radius = joined_all(pieces)
    return [[Fraction(x, GRID) for x in row] for row in centre], radius


def across(A: Matrix, F: Matrix, profile: Profile, start: Fraction, stop: Fraction) -> Enclosed:
    """Enclose the transition matrix over one piece of g."""
    size = (stop - start) * (norm(A) + norm(F))
    require(size < 10**5, "a piece of the schedule is too long for its plant")
    count, gain = 1, profile.gain(start, stop) if norm(F) else Form([0])
    while count < 2 * size:
        count *= 2
    if not any(power_coefficients(gain)[1:]):
        step = transition(A, F, gain, (stop - start) / count)
        while count > 1:
            step, count = joined(step, step), count // 2
        return step
    cuts = [start + (stop - start) * Fraction(j, count) for j in range(count + 1)]
    steps = halved(pairwise(cuts), lambda a, b: reach(A, F, profile.gain(a, b), b - a) > MAX_REACH)
    return joined_all(transition(A, F, profile.gain(a, b), b - a) for a, b in steps)


def joined_all(parts: Iterable[Enclosed]) -> Enclosed:
    """Return the product of parts that follow one another in time, joined in pairs of equal count."""
    held: list[tuple[int, Enclosed]] = []
    for part in parts:
        count, after = 1, part
        while held and held[-1][0] == count:
            after, count = joined(after, held.pop()[1]), 2 * count
        held.append((count, after))
    _, total = held.pop()
    while held:
        total = joined(total, held.pop()[1])
    return total


def joined(after: Enclosed, before: Enclosed) -> Enclosed:
    """Return the product of two enclosed matrices: |XY - xy| <= |x| |Y - y| + |X - x| (|y| + |Y - y|)."""
    (x, a), (y, b) = after, before
    radius = grid_norm(x) * b + a * (grid_norm(y) + b) + Fraction(len(x), GRID)
    return grid_product(x, y), Fraction(int(radius * GRID) + 1, GRID)


RATIO = 16
"""How many times its length a step's majorant is looked at."""
MAX_REACH = 12
"""Steps are halved until the majorant there is at most exp of this."""
MAX_HALVINGS = 12


def halved(
    steps: Iterable[tuple[Fraction, Fraction]], long: Callable[[Fraction, Fraction], bool]
) -> Iterator[tuple[Fraction, Fraction]]:
    """Return the steps in order, those that are too long cut in halves."""
    for step in steps:
        pending = [(*step, 0)]
        while pending:
            a, b, depth = pending.pop()
            if depth < MAX_HALVINGS and long(a, b):
                middle = (a + b) / 2
                pending += [(middle, b, depth + 1), (a, middle, depth + 1)]
            else:
                yield a, b


def reach(A: Matrix, F: Matrix, gain: Form, h: Fraction) -> Fraction:
    """Logarithm of the majorant of a step's Taylor series at `RATIO` times its length."""
    sizes = [abs(g) * norm(F) + (norm(A) if j == 0 else 0) for j, g in enumerate(power_coefficients(gain))]
    return sum((h * m * Fraction(RATIO) ** (j + 1) / (j + 1) for j, m in enumerate(sizes)), Fraction(0))


def grid_norm(A: Grid) -> Fraction:
    """Largest row sum of absolute values."""
    return Fraction(max(sum(map(abs, row)) for row in A), GRID)


def transition(A: Matrix, F: Matrix, gain: Form, h: Fraction) -> Enclosed:
    """Enclose the transition matrix over one step: Taylor terms X_k of X' = sum_j M_j x^j X, 0 <= x <= 1.

    (k + 1) X_{k+1} = sum_j M_j X_{k-j}, in multiples of 1/GRID. With m_j >= |M_j| the terms of
    exp(sum m_j x^(j+1)/(j+1)) dominate |X_k|; an error e put into one term, or into M, moves the
    sum by at most e exp(2 sum m_j); at x = RATIO the same series bounds the tail left out.
    """
    n, powers = len(A), power_coefficients(gain)
    M: list[Grid] = []
    for j, g in enumerate(powers):
        exact_rows = [[(A[r][c] if j == 0 else 0) - g * F[r][c] for c in range(n)] for r in range(n)]
        M.append([[round(h * x * GRID) for x in row] for row in exact_rows])
    term = [[GRID * (i == j) for j in range(n)] for i in range(n)]
    terms, total_ = [term], term
    for k in range(TERMS):
        rows = [[0] * n for _ in range(n)]
        for j in range(min(k, len(M) - 1) + 1):
            columns = list(zip(*terms[k - j], strict=True))
            rows = [
                [x + sum(map(mul, row, column)) for x, column in zip(known, columns, strict=True)]
                for known, row in zip(rows, M[j], strict=True)
            ]
        term = [[x // (GRID * (k + 1)) for x in row] for row in rows]
        terms.append(term)
        total_ = [[x + y for x, y in zip(*pair, strict=True)] for pair in zip(total_, term, strict=True)]
    sizes = [grid_norm(m) + Fraction(n, GRID) for m in M]
    moved = 3 ** (int(2 * sum(sizes, Fraction(0))) + 1)
    far = sum((m * Fraction(RATIO) ** (j + 1) / (j + 1) for j, m in enumerate(sizes)), Fraction(0))
    error = Fraction(n * (TERMS + len(M)), GRID) * moved + Fraction(3 ** (int(far) + 1), RATIO ** (TERMS + 1))
    return total_, error


@kind("floquet")
def check_floquet(data: Node, certificate: Node) -> list[str]:
    """Bound the spectral radius of a periodic linear plant's monodromy matrix M, on one side.

    Below r: P > 0 with M'PM < r^2 P. Above r: x'Px > 0 for some x, and M'PM > r^2 P, so that
    V = x'Px grows by more than r^2 a period. Both with room for the enclosure's radius.
    """
    A, F, profile, _, words = read_plant(data)
    claim, witness = certificate["claim"], certificate["witness"]
    if witness.has("scale"):  # x = D z has the same multipliers
        d = witness["scale"].vector(len(A))
        require(all(x > 0 for x in d), "scales must be positive")
        A, F = ([[x * d[j] / d[i] for j, x in enumerate(row)] for i, row in enumerate(M)] for M in (A, F))
    M, radius = monodromy(A, F, profile)
    side, r = claim["side"].text(), claim["radius"].number()
    require_change(M, radius, side, r, witness)
    fate = " (stable)" if side == "below" and r <= 1 else " (unstable)" if side == "above" and r >= 1 else ""
    return [
        f"every Floquet multiplier is below {show(r)} in modulus{fate}"
        if side == "below"
        else f"some Floquet multiplier is above {show(r)} in modulus{fate}",
        *words,
    ]


def require_change(M: Matrix, radius: Fraction, side: str, r: Fraction, witness: Node) -> None:
    """Check that V = x'Px falls below r^2 V, or grows above it, from x to M x, M known to `radius`."""
    n, P = len(M), witness["P"].matrix(len(M), len(M))
    require(is_symmetric(P), "P is not symmetric")
    require(side in ("below", "above") and r > 0, "a spectral radius lies below or above a positive number")
    error = n * radius
    room = (2 * n * norm(M) * error + error**2) * norm(P)
    grown = matrix_product([list(c) for c in zip(*M, strict=True)], matrix_product(P, M))
    sign = 1 if side == "below" else -1
    gap = [
        [sign * (r * r * P[i][j] - grown[i][j]) - (room if i == j else 0) for j in range(n)] for i in range(n)
    ]
    require(is_positive_definite(gap), "P does not change by more than r^2 in a period")
    if side == "below":
        require(is_positive_definite(P), "P is not positive definite")
    else:
        x = witness["x"].vector(n)
        value = sum((x[i] * P[i][j] * x[j] for i in range(n) for j in range(n)), Fraction(0))
        require(value > 0, "x'Px is not positive")

"""Rule out, in floats with an error allowance, pieces of the moving integral that hold no extreme.

A schedule of 1e5 windows has nearly 1e6 pieces. For each, Bernstein coefficients in floats bound
the moving integral from below and its ends from above; a piece is dropped only where its lower
bound exceeds the best upper bound by more than both allowances. What is left is decided in rationals.
The allowance for a number formed by at most N roundings from terms of total magnitude M is
2 N eps M (Higham, Accuracy and Stability of Numerical Algorithms, section 3.1); N = 500 covers
the longest chain here (powers and binomial sums of degree 6, then 10 halvings) several times over.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from ...models.types import Array
from .moving_integral import MovingIntegral, Segment, ShapeKey

Indices = NDArray[np.intp]
EPS = float(np.finfo(float).eps)
ROUNDINGS = 500
MAX_EXACT = 2000
"""Up to this many pieces all are decided in rationals and nothing is screened."""
FEW = 200
ROUNDS = 10


def screen(moving: MovingIntegral, segments: Sequence[Segment]) -> tuple[list[int], list[int]]:
    """Indices of the segments that may hold the minimum of F, and of those that may hold its maximum."""
    start, coefficients, allowance = _bernstein(moving, segments)
    values = start[:, None] + coefficients
    return _least(values, allowance), _least(-values, allowance)


def _least(box: Array, allowance: Array) -> list[int]:
    """Indices of rows of Bernstein coefficients that may hold the least value of all."""
    count = len(box)
    owner: Indices = np.arange(count, dtype=np.intp)
    settled: list[Indices] = []
    best = np.inf
    for _ in range(ROUNDS):
        best = min(best, float(np.min(np.minimum(box[:, 0], box[:, -1]) + allowance[owner])))
        keep = box.min(axis=1) - allowance[owner] <= best
        box, owner = box[keep], owner[keep]
        # halving a box that is flat to within its allowance cannot tell more
        flat = box.max(axis=1) - box.min(axis=1) <= allowance[owner]
        settled.append(owner[flat])
        box, owner = box[~flat], owner[~flat]
        if len(_distinct(owner, count)) <= FEW:
            break
        left, right = _halves(box)
        box, owner = np.concatenate([left, right]), np.concatenate([owner, owner])
    return [int(i) for i in _distinct(np.concatenate([*settled, owner]), count)]


def _distinct(owner: Indices, count: int) -> Indices:
    """The numbers below `count` that occur, ascending: by marking them, which needs no sorting."""
    present = np.zeros(count, dtype=bool)
    present[owner] = True
    return np.flatnonzero(present)


def _bernstein(moving: MovingIntegral, segments: Sequence[Segment]) -> tuple[Array, Array, Array]:
    """F at each start (n,), Bernstein coefficients of the increment (n, d + 1), and allowances (n,)."""
    rate = float(moving.clock.rate)
    width = np.array([s.width / rate for s in segments])
    prefix = np.array([x / moving.scale for x in moving.prefix])
    upper = prefix[[s.upper_index for s in segments]]
    lower = prefix[[s.lower_index for s in segments]]
    cycles = np.array([float(s.cycles) for s in segments]) * prefix[-1]
    squares = _table(moving.squares)
    primitives = _table(moving.square_primitives)
    up, up_size, up_partial = _along(squares, primitives, [s.upper for s in segments], width, rate)
    low, low_size, low_partial = _along(squares, primitives, [s.lower for s in segments], width, rate)
    start = cycles + (upper - lower) + (up_partial - low_partial)
    coefficients = (up - low) @ _power_to_bernstein(up.shape[1]).T
    local = (up_size + low_size) * 2.0 ** up.shape[1] + np.abs(up_partial) + np.abs(low_partial)
    magnitude = np.abs(cycles) + np.abs(upper) + np.abs(lower)
    allowance = 8 * EPS * magnitude + 2 * ROUNDINGS * EPS * local
    return start, coefficients, allowance


def _table(polynomials: Sequence[Sequence[object]]) -> Array:
    degree = max((len(p) for p in polynomials), default=1)
    table = np.zeros((len(polynomials), max(degree, 1)))
    for i, p in enumerate(polynomials):
        table[i, : len(p)] = [float(c) for c in p]  # type: ignore[arg-type]
    return table


def _along(
    squares: Array, primitives: Array, parts: Sequence[ShapeKey], width: Array, rate: float
) -> tuple[Array, Array, Array]:
    """Integral of g^2 along each part: coefficients in s, total magnitude, and what precedes the part.

    The integral over [0, s] of width * square(offset/length + s width/length).
    """
    which = np.array([p[0] for p in parts], dtype=np.intp)
    length = np.array([p[1] / rate for p in parts])
    share = np.array([p[2] / p[1] for p in parts])
    slope = width / length
    square = squares[which]
    d = square.shape[1]
    shifted, size = np.zeros_like(square), np.zeros(len(parts))
    for i in range(d):
        for j in range(i, d):
            term = comb(j, i) * square[:, j] * share ** (j - i) * slope**i
            shifted[:, i] += term
            size += np.abs(term)
    coefficients = np.concatenate([np.zeros((len(parts), 1)), shifted / np.arange(1, d + 1)], axis=1)
    primitive = primitives[which]
    before, before_size = np.zeros(len(parts)), np.zeros(len(parts))
    for j in range(primitive.shape[1] - 1, -1, -1):
        before = before * share + primitive[:, j]
        before_size = before_size * share + np.abs(primitive[:, j])
    return coefficients * width[:, None], size * width + before_size * length, before * length


def _power_to_bernstein(count: int) -> Array:
    n = count - 1
    return np.array(
        [[comb(i, j) / comb(n, j) if j <= i else 0.0 for j in range(count)] for i in range(count)]
    )


def _halves(box: Array) -> tuple[Array, Array]:
    row = box
    left, right = [row[:, 0]], [row[:, -1]]
    while row.shape[1] > 1:
        row = (row[:, :-1] + row[:, 1:]) / 2
        left.append(row[:, 0])
        right.append(row[:, -1])
    return np.stack(left, axis=1), np.stack(right[::-1], axis=1)

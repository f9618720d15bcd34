"""Polynomials on a cube as integers, every rounding counted."""

from __future__ import annotations

import math
from fractions import Fraction

from .peak_numbers import PEAK_BITS, Cubic, Local, Solid


def as_solid(p: Cubic, degree: int) -> Solid:
    """Integer coefficients, each rounded down by less than one unit."""
    span = range(degree + 1)
    return [
        [
            [math.floor(p.get((i, j, k), Fraction(0)) * 2**PEAK_BITS) for k in range(degree + 1 - i - j)]
            for j in range(degree + 1 - i)
        ]
        for i in span
    ]


def rounding_units(degree: int) -> int:
    """Bound, in units and absolute sum, of what one cut or the first rounding adds to a polynomial's error.

    A rounded coefficient of t^k is then moved by a half: its error is multiplied by at most 2^k.
    """
    return (degree + 1) * (degree + 2) * (degree + 3) // 6 << degree


def cut_solid(p: Solid) -> tuple[Solid, Solid]:
    """Both halves along the last coordinate, as polynomials of (last, first, middle).

    t = +-1/2 + t'/2: every coefficient is halved, rounded down, and moved by additions only. The
    absolute sum of an error there was does not grow; `rounding_units` bounds what is added.
    """
    size = len(p)
    low: Solid = [[[0] * (size - i - j) for j in range(size - i)] for i in range(size)]
    high: Solid = [[[0] * (size - i - j) for j in range(size - i)] for i in range(size)]
    for i, plane in enumerate(p):
        for j, line in enumerate(plane):
            up = [c >> k for k, c in enumerate(line)]
            down = list(up)
            for start in range(len(line) - 1):
                for k in range(len(line) - 2, start - 1, -1):
                    up[k] += up[k + 1]
                    down[k] -= down[k + 1]
            for k in range(len(line)):
                high[k][i][j] = up[k]
                low[k][i][j] = down[k]
    return low, high


def solid_sum(p: Solid) -> int:
    """Sum of the absolute values of all coefficients but the constant."""
    return sum(abs(c) for plane in p for line in plane for c in line) - abs(p[0][0][0])


def local(p: Solid, error: int) -> Local:
    """Coefficients up to second order, and a bound of everything else with the error."""
    c = [p[0][0][0], p[1][0][0], p[0][1][0], p[0][0][1], p[2][0][0], p[0][2][0], p[0][0][2]]
    c += [p[0][1][1], p[1][0][1], p[1][1][0]]
    return c, solid_sum(p) - sum(map(abs, c[1:])) + error


def square_above(v: list[Local], side: Local, limit: int) -> int:
    """Upper bound of |v|^2 where the polynomial `side` is >= 0 on the box, units 2^-2 PEAK_BITS.

    Second-order terms of the square are formed before absolute values are taken. If that is above
    the limit, a multiple of `side` is added so that slopes outwards of the region cancel.
    """
    total, beyond = [0] * 10, 0
    for (c, d1, d2, d3, q1, q2, q3, m1, m2, m3), tail in v:
        turn = abs(d1) + abs(d2) + abs(d3)
        bend = abs(q1) + abs(q2) + abs(q3) + abs(m1) + abs(m2) + abs(m3)
        two = 2 * c
        total[0] += c * c
        total[1] += two * d1
        total[2] += two * d2
        total[3] += two * d3
        total[4] += two * q1 + d1 * d1
        total[5] += two * q2 + d2 * d2
        total[6] += two * q3 + d3 * d3
        total[7] += two * m1 + 2 * d2 * d3
        total[8] += two * m2 + 2 * d1 * d3
        total[9] += two * m3 + 2 * d1 * d2
        beyond += 2 * (abs(c) + turn + bend) * tail + tail * tail + 2 * turn * bend + bend * bend
    least = _largest_quadratic(total) + beyond
    slopes, rest = side
    steep = sum(x * x for x in slopes[1:4])
    if least > limit and steep:
        lean = -(slopes[1] * total[1] + slopes[2] * total[2] + slopes[3] * total[3])
        tries = [lean // steep, *(-total[a] // slopes[a] for a in (1, 2, 3) if slopes[a])]
        for factor in tries:
            if factor > 0:
                moved = [x + factor * y for x, y in zip(total, slopes, strict=True)]
                least = min(least, _largest_quadratic(moved) + beyond + factor * rest)
    return least


def _largest_quadratic(c: list[int]) -> int:
    """Upper bound on [-1, 1]^3 of the quadratic with these coefficients, in the order of `Local`."""
    squares = max(c[4], 0) + max(c[5], 0) + max(c[6], 0)
    slopes, products = abs(c[1]) + abs(c[2]) + abs(c[3]), abs(c[7]) + abs(c[8]) + abs(c[9])
    return c[0] + slopes + squares + products


def components_above(v: list[Solid], box: list[int], error: int) -> int:
    """Upper bound of sum box_i |v_i| over the cube: sharp where no component changes its sign."""
    signs, flips = [], 0
    for p, width in zip(v, box, strict=True):
        reach = solid_sum(p) - abs(p[0][0][0]) + error
        flips += 2 * max(reach, 0) * width
        signs.append(width if p[0][0][0] >= 0 else -width)
    a, b, c = signs
    p, q, r = v
    total = 0
    for lines in zip(p, q, r, strict=True):
        for rows in zip(*lines, strict=True):
            total += sum(abs(a * x + b * y + c * z) for x, y, z in zip(*rows, strict=True))
    middle = a * p[0][0][0] + b * q[0][0][0] + c * r[0][0][0]
    return total - abs(middle) + middle + flips + error * sum(box)

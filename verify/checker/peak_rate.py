"""Proof that a potential's rate stays below its bound, by cutting boxes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from operator import mul

from .exact_numbers import require
from .peak_gauge import Gauge
from .peak_numbers import PEAK_BITS, PEAK_BOXES, Cubic, Local, Six, Solid, magnitude
from .peak_solids import as_solid, components_above, cut_solid, local, rounding_units, solid_sum, square_above


class Metrics:
    """Ellipsoids around K: matrices F, in units of 2^-shift, with max over K of v.H <= |F v| for every v.

    That holds if F Q F' >= (sum of l_k) I for Q = sum l_k M_k/L_k, whatever the l_k >= 0: on K,
    (v.H)^2 <= (v'Q^-1 v)(H'Q H). Floats choose l; Q is rounded down, F Q F' is decided in integers.
    """

    def __init__(self, gauge: Gauge) -> None:
        rows = [[[x / L for x in row] for row in M] for M, L in zip(gauge.rows, gauge.levels, strict=True)]
        largest = max(M[i][i] for M in rows for i in range(3))
        self._fine = 64 - magnitude(largest)
        scale = Fraction(2) ** self._fine
        self._exact = [
            [[math.floor(M[i][j] * scale) - 4 * (i == j) for j in range(3)] for i in range(3)] for M in rows
        ]
        self._rows = [
            (float(M[0][0]), float(M[0][1]), float(M[0][2]), float(M[1][1]), float(M[1][2]), float(M[2][2]))
            for M in rows
        ]
        self.shift = 40 + magnitude(largest) // 2
        self.even = [1.0 / len(rows)] * len(rows)
        self.fixed = len(rows) == 1
        self._known: dict[tuple[int, int, int], tuple[list[float], list[list[int]] | None]] = {}

    def about(self, v: list[float]) -> tuple[list[float], list[list[int]] | None]:
        """Multipliers and F that are good for v near this direction; remembered."""
        size = sum(map(abs, v)) or 1.0
        place = (round(24 * v[0] / size), round(24 * v[1] / size), round(24 * v[2] / size))
        if place not in self._known:
            a, b, c = (x / 24 for x in place)
            spread = [a * a + 1e-4, a * b, a * c, b * b + 1e-4, b * c, c * c + 1e-4]
            weights = self.improved(spread, self.even, 200)
            self._known[place] = weights, self.factor(weights)
        return self._known[place]

    def improved(self, spread: Six, weights: list[float], sweeps: int) -> list[float]:
        """Multipliers that nearly minimise the mean of |F v|^2, by its multiplicative iteration."""
        c0, c1, c2, c3, c4, c5 = spread
        for _ in range(sweeps):
            q0, q1, q2, q3, q4, q5 = self._sum(weights)
            i0, i1, i2 = q3 * q5 - q4 * q4, q2 * q4 - q1 * q5, q1 * q4 - q2 * q3
            i3, i4, i5 = q0 * q5 - q2 * q2, q1 * q2 - q0 * q4, q0 * q3 - q1 * q1
            a0, a1, a2 = i0 * c0 + i1 * c1 + i2 * c2, i0 * c1 + i1 * c3 + i2 * c4, i0 * c2 + i1 * c4 + i2 * c5
            b0, b1, b2 = i1 * c0 + i3 * c1 + i4 * c2, i1 * c1 + i3 * c3 + i4 * c4, i1 * c2 + i3 * c4 + i4 * c5
            d0, d1, d2 = i2 * c0 + i4 * c1 + i5 * c2, i2 * c1 + i4 * c3 + i5 * c4, i2 * c2 + i4 * c4 + i5 * c5
            s0, s1, s2 = a0 * i0 + a1 * i1 + a2 * i2, a0 * i1 + a1 * i3 + a2 * i4, a0 * i2 + a1 * i4 + a2 * i5
            s3, s4, s5 = b0 * i1 + b1 * i3 + b2 * i4, b0 * i2 + b1 * i4 + b2 * i5, d0 * i2 + d1 * i4 + d2 * i5
            loads = [
                m0 * s0 + m3 * s3 + m5 * s5 + 2 * (m1 * s1 + m2 * s2 + m4 * s4)
                for m0, m1, m2, m3, m4, m5 in self._rows
            ]
            moved = [l * math.sqrt(x) if x > 0 else 0.0 for l, x in zip(weights, loads, strict=True)]
            total = sum(moved)
            if not 0 < total < math.inf:
                break
            weights = [l / total + 1e-7 for l in moved]
        return weights

    def _sum(self, weights: list[float]) -> Six:
        return [sum(l * m[k] for l, m in zip(weights, self._rows, strict=True)) for k in range(6)]

    def factor(self, weights: list[float]) -> list[list[int]] | None:
        """F for the multipliers, proved; None if it does not come out."""
        total = sum(weights) * (1 + 1e-9)
        q0, q1, q2, q3, q4, q5 = (x / total for x in self._sum(weights))
        try:
            g0 = math.sqrt(q0)
            g1, g2 = q1 / g0, q2 / g0
            g3 = math.sqrt(q3 - g1 * g1)
            g4 = (q4 - g1 * g2) / g3
            g5 = math.sqrt(q5 - g2 * g2 - g4 * g4)
            f0, f3, f5 = 1 / g0, 1 / g3, 1 / g5
            f1, f4 = -g1 * f0 * f3, -g4 * f3 * f5
            f2 = -(g2 * f0 + g4 * f1) * f5
            scale = 2.0**self.shift
            F = [
                [round(f0 * scale), 0, 0],
                [round(f1 * scale), round(f3 * scale), 0],
                [round(f2 * scale), round(f4 * scale), round(f5 * scale)],
            ]
            lots = [round(l * 2**50) for l in weights]
        except (ArithmeticError, ValueError):
            return None
        Q = [
            [sum(map(mul, lots, column)) for column in zip(*lines, strict=True)]
            for lines in zip(*self._exact, strict=True)
        ]
        FQ = [[sum(map(mul, row, column)) for column in zip(*Q, strict=True)] for row in F]
        G = [[sum(map(mul, row, other)) for other in F] for row in FQ]
        least = sum(lots) * Fraction(2) ** (self._fine + 2 * self.shift)
        for i in range(3):
            G[i][i] -= math.ceil(least)
        first = G[0][0] * G[1][1] - G[0][1] * G[1][0]
        det = (
            G[2][2] * first
            - G[1][2] * (G[0][0] * G[2][1] - G[0][1] * G[2][0])
            + G[0][2] * (G[1][0] * G[2][1] - G[1][1] * G[2][0])
        )
        return F if G[0][0] > 0 and first > 0 and det > 0 else None

    def apply(self, F: list[list[int]], v: list[Local]) -> list[Local]:
        """Return F v, rounding included in the bound of the rest."""
        (p, q, r), tails = [c for c, _ in v], [tail for _, tail in v]
        shift, result = self.shift, []
        for a, b, c in F:
            values = [(a * x + b * y + c * z) >> shift for x, y, z in zip(p, q, r, strict=True)]
            rest = (abs(a) * tails[0] + abs(b) * tails[1] + abs(c) * tails[2]) >> shift
            result.append((values, rest + 11))
        return result


@dataclass
class RateBox:
    """One box of the search: the rate and the region on it, its depth, its error and an ellipsoid to try."""

    v: list[Solid]
    region: list[Solid]
    depth: int
    error: int
    weights: list[float]
    F: list[list[int]] | None


class RateProof:
    """Proof that v.H <= rate for every H in K wherever the region polynomials are >= 0, by cutting boxes."""

    def __init__(self, gauge: Gauge, rate: Fraction) -> None:
        self.metrics = Metrics(gauge)
        self.limit: int = math.floor(rate * rate * 2 ** (2 * PEAK_BITS))
        self.linear: int = math.floor(rate * 2 ** (PEAK_BITS + 30))
        self.box = None if gauge.box is None else [math.ceil(b * 2**30) for b in gauge.box]
        self.crumb: int = math.floor(rate * 2 ** (PEAK_BITS - 17))
        self.count = 0

    def run(self, v: list[Cubic], region: list[Cubic]) -> int:
        """Prove it; return how many boxes were needed."""
        degree = max(2, *(sum(e) for p in v for e in p))
        sides = [as_solid(p, max(2, *(sum(e) for e in p))) for p in region]
        first = [as_solid(p, degree) for p in v]
        stack = [RateBox(first, sides, 0, rounding_units(degree), self.metrics.even, None)]
        while stack:
            box = stack.pop()
            self.count += 1
            require(self.count <= PEAK_BOXES and box.depth < 80, "the rate of the potential is not proved")
            slack = [rounding_units(len(p) - 1) * (box.depth + 1) for p in box.region]
            if any(p[0][0][0] + solid_sum(p) + e < 0 for p, e in zip(box.region, slack, strict=True)):
                continue
            if not self._holds(box, local(box.region[0], slack[0])):
                stack += self._halves(box)
        return self.count

    def _holds(self, box: RateBox, side: Local) -> bool:
        """Whether the rate is proved on a box: by an ellipsoid (the parent's, a known, its own) or else."""
        v, metrics, limit = [local(p, box.error) for p in box.v], self.metrics, self.limit
        if box.F is not None:
            value = square_above(metrics.apply(box.F, v), side, limit)
            if value <= limit:
                return True
            if metrics.fixed or value > 4 * limit:
                return False
        unit = 2.0**-PEAK_BITS
        columns = [[float(c[k]) * unit for c, _ in v] for k in range(4)]
        box.weights, box.F = metrics.about(columns[0])
        if self._fits(box.F, v, side):
            return True
        spread = [
            sum(x[i] * x[j] for x in columns) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
        ]
        sweeps = 5 if box.depth < 20 else 40 if box.depth < 32 else 300
        box.weights = metrics.improved(spread, box.weights, sweeps)
        box.F = metrics.factor(box.weights)
        if self._fits(box.F, v, side):
            return True
        if self.box is None:
            return False
        return components_above(box.v, self.box, box.error) <= self.linear

    def _fits(self, F: list[list[int]] | None, v: list[Local], side: Local) -> bool:
        return F is not None and square_above(self.metrics.apply(F, v), side, self.limit) <= self.limit

    def _halves(self, box: RateBox) -> list[RateBox]:
        """Cut a box in two; terms of high order that no longer matter join the error."""
        v, error = box.v, box.error
        while len(v[0]) > 5:
            top = max(sum(abs(c) for plane in p for line in plane for c in line[-1:]) for p in v)
            if top > self.crumb:
                break
            v, error = [[[line[:-1] for line in plane[:-1]] for plane in p[:-1]] for p in v], error + top
        error += rounding_units(len(v[0]) - 1)
        cut, sides = [cut_solid(p) for p in v], [cut_solid(p) for p in box.region]
        return [
            RateBox([c[i] for c in cut], [c[i] for c in sides], box.depth + 1, error, box.weights, box.F)
            for i in (0, 1)
        ]

"""The argument by components: a cube of torques from rest to rest."""

from __future__ import annotations

from fractions import Fraction

from .exact_numbers import Vector, require
from .peak_gauge import Gauge
from .peak_numbers import axis_matrix, combination, root_interval
from .peak_separation import require_travel
from .peak_transfer import Transfer
from .reading import Node


def require_components(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """Travel of a cube of torques from rest to rest, each component of the momentum bounded by itself.

    Until the instant s let n = up, Y = int_0^t up^2; after it the same with time running backwards.
    K gives H in p n K, hence |H_i| <= r_i p n. Let B_i >= r_i, or 1 + kappa_i trial Y/up < B_i, where
    |(X x J^-1 X)_i| <= kappa_i for X in K, |X_j| <= B_j, |X_i| >= 1. For p <= trial then
    |H_i| <= p up + kappa_i p^2 Y: as long as every |H_j| <= B_j p n, |H_i| grows at most
    p w + kappa_i (p n)^2 wherever |H_i| >= p n; so |H_j| < B_j p n goes on, and it holds at first,
    because Y/up -> 0 where the windows first open. So at every instant H is in p n f times the part of
    K with |H_i| <= beta_i, f = max(1, max_i min(1 + kappa_i p Y/up, r_i)/beta_i).
    """
    require(d.words.startswith("every |torque_i(t)|"), "components are for the cube of torques")
    require(not any(d.rate) and d.end_rate == 0, "components are from rest to exact rest")
    travel, s, trial = (witness[name].number() for name in ("travel", "instant", "trial"))
    require(peak <= trial, "the peak is above the trial")
    r = [
        root_interval(gauge.largest(axis_matrix(i), row.vector()))[1]
        for i, row in enumerate(witness["widths"].items())
    ]
    B, box = witness["bounds"].vector(3), witness["box"].vector(3)
    require(len(r) == 3 and all(b >= 1 for b in B), "expected three widths, and bounds of at least 1")
    kappa = gyroscopic_bounds(gauge, B, witness["multipliers"])
    horizon = d.window.knots[-1]
    require(0 <= s <= horizon, "the instant must lie within the transfer")
    cells = [*d.window.cells(s), *d.window.mirrored().cells(horizon - s)]
    largest = max(ratio for _, ratio in cells)
    for width, bound, k in zip(r, B, kappa, strict=True):
        sure = bound >= width or 1 + k * trial * largest < bound
        require(sure, "a bound of a component is not proved")
    allowed = Fraction(0)
    for area, ratio in cells:
        grown = [min(1 + k * peak * ratio, x) / b for k, x, b in zip(kappa, r, box, strict=True)]
        allowed += peak * area * max(Fraction(1), *grown)
    require(allowed <= travel, "a transfer of that peak may travel enough")
    speed = gauge.speed(witness["speed"].vector())
    return require_travel(d, gauge.with_box(box), speed, travel, witness)


def gyroscopic_bounds(gauge: Gauge, B: Vector, place: Node) -> Vector:
    """kappa_i >= |(X x J^-1 X)_i| over X in K, |X_j| <= B_j, |X_i| >= 1: multipliers of both signs."""
    part, A = gauge.with_box(B), gauge.inverse
    lists = place.items()
    require(len(lists) == 6, "expected multipliers for three axes and two signs")
    kappa = [Fraction(0)] * 3
    for number, entry in enumerate(lists):
        i, sign = number // 2, 1 - 2 * (number % 2)
        j, k = (i + 1) % 3, (i + 2) % 3
        G = [[Fraction(0)] * 3 for _ in range(3)]
        for m in range(3):
            for row, column, value in ((j, m, A[k][m]), (k, m, -A[j][m])):
                G[row][column] += sign * value / 2
                G[column][row] += sign * value / 2
        *weights, floor = entry.vector()
        require(floor >= 0, "multipliers must not be negative")
        lifted = combination([Fraction(1), floor], [G, axis_matrix(i)])
        kappa[i] = max(kappa[i], part.largest(lifted, weights) - floor)
    return kappa

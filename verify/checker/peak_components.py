"""The argument by components: a cube of torques, each component of the momentum bounded by itself."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

from .exact_numbers import Matrix, Vector, require, show
from .peak_coast import coast_nodes, require_turn
from .peak_drift import (
    DriftCell,
    Stretch,
    Way,
    drift_cells,
    length_above,
    root_above,
    short_above,
    size_above,
    still,
    straight,
    stretches,
    ways,
)
from .peak_gauge import Gauge
from .peak_numbers import (
    PEAK_CELLS,
    PEAK_DRIFT_NODES,
    axis_matrix,
    combination,
    image,
    root_interval,
)
from .peak_separation import require_travel
from .peak_transfer import Transfer
from .peak_window import PeakWindow
from .reading import Node


def require_components(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """Travel of a cube of torques: until the instant s from a coast, after it to the target.

    Where the coast leads and the attitude are joined by a path as long as `peak_drift` says. After s
    the travel is that of the momentum. Both are counted in the gauge of the part |H_i| <= box_i of K.
    """
    require(d.words.startswith("every |torque_i(t)|"), "components are for the cube of torques")
    travel, s, end = (witness[name].number() for name in ("travel", "instant", "end"))
    require(0 <= s <= d.window.knots[-1], "the instant must lie within the transfer")
    gauge.require_rates_within(d.end_rate, end)
    widths = [
        root_interval(gauge.largest(axis_matrix(i), row.vector()))[1]
        for i, row in enumerate(witness["widths"].items())
    ]
    B, box = witness["bounds"].vector(3), witness["box"].vector(3)
    sound = len(widths) == 3 and all(b >= 1 for b in [*B, *box])
    require(sound, "expected three widths, and bounds of at least 1")
    attitude, slack, words = d.attitude, Fraction(0), ""
    if any(d.rate):
        turn, attitude = witness["coast"]["turn"].number(), witness["coast"]["attitude"].vector(4)
        nodes = coast_nodes(d.J, d.attitude, d.momentum, s / PEAK_DRIFT_NODES, PEAK_DRIFT_NODES)
        require_turn(nodes[-1].attitude, nodes[-1].error, attitude, turn)
        slack, words = turn * size_above(d.J), f"after a coast of {show(s)} s, "
        step = s / PEAK_DRIFT_NODES
        opening = opened(d.window, s, stretches(gauge, nodes, step), ways(gauge, nodes, step))
    else:
        opening = opened(d.window, s, [still()], [straight(gauge)])
    ends = [d.end_rate * length_above(row) for row in d.J]
    parts = ComponentTravel(gauge, widths, opening, list(closed(d.window, s)), end, ends)
    kappa = gyroscopic_bounds(gauge, B, parts.floor, witness["multipliers"])
    require(parts.bounds_hold(B, kappa, peak), "a bound of a component is not proved")
    require(parts.allowed(peak, kappa, box) + slack <= travel, "a transfer of that peak may travel enough")
    part, d = gauge.with_box(box), replace(d, attitude=attitude)
    speed = part.speed([*witness["speed"].vector(), *[Fraction(0)] * 3])
    return words + require_travel(d, part, speed, travel, witness)


Opening = list[tuple[DriftCell, Way]]


def opened(window: PeakWindow, until: Fraction, growths: list[Stretch], found: list[Way]) -> Opening:
    """Cells of [0, until], each with its way to where the coast leads."""
    return [(cell, found[cell.stretch]) for cell in drift_cells(window, until, growths)]


@dataclass(frozen=True)
class ClosingCell:
    """Part [a, b] of the time before the end, counted backwards, with dn the open time from the end."""

    length: Fraction
    area: Fraction
    before: Fraction
    time: Fraction
    integral: Fraction
    square: Fraction

    def travel(self, end: Fraction, p: Fraction) -> Fraction:
        """Integral of n = end + p dn."""
        return end * self.length + p * self.area

    def swell(self, end: Fraction, p: Fraction) -> Fraction:
        """Upper bound of (int_0^t n^2)/n: n rises, so it is at most int_0^t n too."""
        whole = end * self.time + p * self.integral
        if end + p * self.before == 0:
            return whole
        square = end**2 * self.time + 2 * end * p * self.integral + p**2 * self.square
        return min(whole, square / (end + p * self.before))


def closed(window: PeakWindow, s: Fraction) -> Iterator[ClosingCell]:
    """Cut the time from s to the end, backwards."""
    back, until = window.mirrored(), window.knots[-1] - s
    inside = {k for k in back.knots if 0 < k < until}
    edges = sorted({until * k / PEAK_CELLS for k in range(PEAK_CELLS + 1)} | inside)
    for a, b in pairwise(edges):
        area = back.opened(b) - back.opened(a)
        yield ClosingCell(b - a, area, back.up(a), b, back.opened(b), back.squared(b))


@dataclass(frozen=True)
class ComponentTravel:
    """Both sides of a transfer: what a peak allows.

    After s, backwards from the end, N(H) <= n = end + p dn and
        |H_i| <= max(h_i, end) + p dn + kappa_i int n^2,
    h_i (`ends`) the largest |(J w)_i| of the terminal rate: as long as every |H_j| < B_j n, |H_i| grows at
    most p w + kappa_i n^2 wherever |H_i| >= n. Widths are those of K: |H_i| <= width_i N(H).
    """

    gauge: Gauge
    widths: Vector
    opening: Opening
    closing: list[ClosingCell]
    end: Fraction
    ends: Vector

    @property
    def floor(self) -> Fraction:
        """|D_i| over p n where it reaches its bound, at least: 1 over the largest growth of n."""
        return 1 / max((cell.scale for cell, _ in self.opening), default=Fraction(1))

    def largest_ratios(self, kappa: Vector, p: Fraction) -> Vector:
        """Upper bounds of |D_i| before s and of |H_i| after it, over n."""
        most = [Fraction(1)] * 3
        for cell, _ in self.opening:
            swell = image(cell.swell, kappa)
            most = [max(most[i], cell.rise[i] + p * swell[i]) for i in range(3)]
        for part in self.closing:
            most = [max(most[i], self.closing_ratio(part, i, kappa, p)) for i in range(3)]
        return most

    def bounds_hold(self, B: Vector, kappa: Vector, p: Fraction) -> bool:
        """Whether every B_i is a width of K, or above every bound of component i over n."""
        most = self.largest_ratios(kappa, p)
        return all(b >= r or b > x for b, r, x in zip(B, self.widths, most, strict=True))

    def closing_ratio(self, cell: ClosingCell, i: int, kappa: Vector, p: Fraction) -> Fraction:
        """Upper bound of |H_i|/n on a cell after s."""
        least, beyond = self.end + p * cell.before, max(self.ends[i] - self.end, Fraction(0))
        more = beyond / least if beyond else Fraction(0)
        return 1 + more + kappa[i] * cell.swell(self.end, p)

    def allowed(self, p: Fraction, kappa: Vector, box: Vector) -> Fraction:
        """Upper bound of the travel of a transfer of peak p."""
        travel = Fraction(0)
        for cell, way in self.opening:
            travel += p * cell.area * self.opening_gauge(cell, way, kappa, p, box)
        for part in self.closing:
            ratios = [min(self.closing_ratio(part, i, kappa, p), self.widths[i]) / box[i] for i in range(3)]
            travel += part.travel(self.end, p) * max(Fraction(1), *ratios)
        return travel

    def opening_gauge(self, cell: DriftCell, way: Way, kappa: Vector, p: Fraction, box: Vector) -> Fraction:
        """Gauge of A x over the box |x_i| <= g_i within scale K, A near a mean of the ends of the way.

        K holds the cube and the box, of at least 1, too: their part holds the unit ball.
        """
        g, worst = self.opening_box(cell, kappa, p), Fraction(0)
        whole, unit = [math.ceil(x * 2**80) for x in g], Fraction(1, 2**160)
        for end in way.ends:
            squares = [
                min(form.largest(whole) * unit / L, cell.scale**2 * (1 + more))
                for form, L, more in zip(end.forms, self.gauge.levels, end.excess, strict=True)
            ]
            level = root_above(max(squares))
            sides = [min(x, r * level) / b for x, r, b in zip(end.reach(g), self.widths, box, strict=True)]
            worst = max(worst, level, *sides)
        return short_above(worst + way.bend * length_above(g))

    def opening_box(self, cell: DriftCell, kappa: Vector, p: Fraction) -> Vector:
        """Upper bounds of |D_i|/(p up)."""
        swell = image(cell.swell, kappa)
        return [min(cell.rise[i] + p * swell[i], self.widths[i] * cell.scale) for i in range(3)]


def gyroscopic_bounds(gauge: Gauge, B: Vector, floor: Fraction, place: Node) -> Vector:
    """Prove kappa_i >= |(X x J^-1 X)_i| over X in K, |X_j| <= B_j, |X_i| >= floor, for both signs."""
    lists = [entry.vector() for entry in place.items()]
    require(len(lists) == 6, "expected multipliers for three axes and two signs")
    part = gauge.with_box(B)
    pairs = [
        [gyroscopic_bound(part, i, sign, floor, lists[2 * i + k]) for k, sign in enumerate((1, -1))]
        for i in range(3)
    ]
    return [max(Fraction(0), *pair) for pair in pairs]


def gyroscopic_bound(part: Gauge, i: int, sign: int, floor: Fraction, multipliers: Vector) -> Fraction:
    """Upper bound of sign (X x J^-1 X)_i, by multipliers of the rows and of the floor."""
    G = gyroscopic_form(part.inverse, i)
    *weights, last = multipliers
    require(last >= 0, "multipliers must not be negative")
    lifted = combination([Fraction(sign), last], [G, axis_matrix(i)])
    return part.largest(lifted, weights) - last * floor**2


def gyroscopic_form(A: Matrix, i: int) -> Matrix:
    """Symmetric G with X'G X = (X x A X)_i."""
    j, k = (i + 1) % 3, (i + 2) % 3
    G: Matrix = [[Fraction(0)] * 3 for _ in range(3)]
    for m in range(3):
        for row, column, value in ((j, m, A[k][m]), (k, m, -A[j][m])):
            G[row][column] += value / 2
            G[column][row] += value / 2
    return G

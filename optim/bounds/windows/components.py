r"""Largest component: the momentum's components are bounded one by one as well.

From rest to rest under |torque_i| <= p w, write n(t) = up(t) until an instant s and the rest of
the open time after it. The invariant set K gives H in p n K. If moreover |H_j| <= B_j p n is known,
then wherever |H_i| >= p n the gyroscopic term (H x J^-1 H)_i is at most kappa_i (p n)^2, with

    kappa_i = max |(X x J^-1 X)_i|  over X in K, |X_j| <= B_j, |X_i| >= 1,

so |H_i| <= p up + kappa_i p^2 int_0^t up^2 until s (a first crossing is impossible), and the mirror
image after it: a smaller B_i, and again. All of it grows with p: computed at a trial peak it holds
for every smaller one, so that the bound is the lesser of the trial and of what follows from it.

For fixed beta >= 1, H is in p n max(1, max_i min(1 + kappa_i p Y/up, r_i)/beta_i) times the part of
K with |H_i| <= beta_i (Y = int up^2, r_i the half width of K), and a potential for that part gives a
bound. For J = c I, kappa = 0 and the part is the cube itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import final

import numpy as np

from ....models.rigid_body import RigidBody
from ....models.schedule import PiecewisePolynomial
from ....models.schedule import polynomial as univariate
from ....verify.exact.ball import square_root
from ....verify.exact.bisection import bisected
from ....verify.exact.matrix import Matrix, combination, is_positive_definite, shifted, unit
from ....verify.exact.rounding import grid_above
from ..sets.gauge import GaugeSet
from .travel import WindowTravel

CELLS = 96
_MARGIN = Fraction(1, 10**7)


@final
@dataclass(frozen=True)
class Cell:
    """Part of the opening side of a transfer.

    Attributes
    ----------
    area : Fraction
        Integral of up over the cell, s^2.
    ratio : Fraction
        Upper bound of Y/up on it, s^2.
    """

    area: Fraction
    ratio: Fraction


@final
@dataclass(frozen=True)
class TransferSides:
    """Both sides of a transfer in cells: from the start to an instant, and mirrored from the end."""

    window: PiecewisePolynomial
    instant: Fraction

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """Cells of both sides."""
        mirrored = mirror(self.window)
        horizon = self.window.knots[-1]
        return (*_cells(self.window, self.instant), *_cells(mirrored, horizon - self.instant))

    @cached_property
    def largest_ratio(self) -> Fraction:
        """Upper bound of Y/up over both sides."""
        return max((cell.ratio for cell in self.cells), default=Fraction(0))

    def travel_above(
        self, p: Fraction, kappa: tuple[Fraction, ...], widths: Widths, beta: Widths
    ) -> Fraction:
        """Upper bound of the travel of a transfer of peak p, in units of the part of K."""
        travel = Fraction(0)
        for cell in self.cells:
            factor = Fraction(1)
            for k, r, b in zip(kappa, widths, beta, strict=True):
                factor = max(factor, min(1 + k * p * cell.ratio, r) / b)
            travel += p * cell.area * factor
        return travel


Widths = tuple[Fraction, Fraction, Fraction]


def mirror(window: PiecewisePolynomial) -> PiecewisePolynomial:
    """Return the profile with time running backwards."""
    horizon = window.knots[-1]
    knots = tuple(horizon - k for k in reversed(window.knots))
    shapes = tuple(
        univariate.compose_affine(shape, Fraction(1), Fraction(-1)) for shape in reversed(window.shapes)
    )
    return PiecewisePolynomial(knots, shapes)


def _cells(window: PiecewisePolynomial, until: Fraction) -> list[Cell]:
    """Cells of [0, until]; Y/up <= min(Y(b)/up(a), int_0^b up) on [a, b] because both rise."""
    travel = WindowTravel(window)
    edges = sorted({until * k / CELLS for k in range(CELLS + 1)} | {k for k in window.knots if 0 < k < until})
    result = []
    for a, b in pairwise(edges):
        up = travel.up(a)
        ratio = travel.opened_area(b)
        if up > 0:
            ratio = min(ratio, travel.opened_square(b) / up)
        area = travel.opened_area(b) - travel.opened_area(a)
        if area > 0:
            result.append(Cell(_coarser(area), _coarser(ratio)))
    return result


def _coarser(x: Fraction) -> Fraction:
    """Round up to a short binary fraction."""
    return grid_above(x, 40)


@final
@dataclass(frozen=True)
class ComponentBounds:
    """Valid at every peak up to the trial: gyroscopic constants, and |H_i| <= B_i p n.

    Attributes
    ----------
    trial : Fraction
        Largest peak.
    kappa, B, widths : three Fraction
        kappa_i of the part |X_j| <= B_j; either B_i = r_i, the width, or 1 + kappa_i trial Y/up < B_i.
    multipliers : six tuples of Fraction
        For each axis and sign those that prove kappa_i: rows of the set, of the box, and the floor's.
    width_multipliers : three tuples of Fraction
        Those that prove r_i.
    """

    trial: Fraction
    kappa: Widths
    B: Widths
    widths: Widths
    multipliers: tuple[tuple[Fraction, ...], ...]
    width_multipliers: tuple[tuple[Fraction, ...], ...]


def component_bounds(
    momenta: GaugeSet, sides: TransferSides, trial: Fraction, *, rounds: int = 5
) -> ComponentBounds:
    """Iterate kappa and B from the widths of the invariant set.

    B is kept while it confirms itself, 1 + kappa(B) trial Y/up < B: that alone makes it valid, for
    |H_i| <= B_i p n holds where the windows first open and cannot cease.
    """
    proved = [momenta_width(momenta, axis) for axis in range(3)]
    widths: Widths = (proved[0][0], proved[1][0], proved[2][0])
    B, best = widths, None
    for _ in range(rounds):
        found = [gyroscopic_bound(momenta, B, axis) for axis in range(3)]
        kappa: Widths = (found[0][0], found[1][0], found[2][0])
        raised = [1 + k * trial * sides.largest_ratio for k in kappa]
        if not all(b >= r or x < b for b, r, x in zip(B, widths, raised, strict=True)):
            break
        multipliers = tuple(m for _, both in found for m in both)
        best = ComponentBounds(trial, kappa, B, widths, multipliers, tuple(m for _, m in proved))
        lower = [_coarser(x * (1 + _MARGIN)) for x in raised]
        following: Widths = (min(B[0], lower[0]), min(B[1], lower[1]), min(B[2], lower[2]))
        if all(b - f < Fraction(1, 1000) for b, f in zip(B, following, strict=True)):
            break
        B = following
    assert best is not None  # the widths confirm themselves
    return best


def momenta_width(momenta: GaugeSet, axis: int) -> tuple[Fraction, tuple[Fraction, ...]]:
    """Upper bound of |X_axis| over the set, and the multipliers that prove it."""
    square, multipliers = _dual_bound(unit(axis), list(momenta.matrices), list(momenta.levels), None)
    return square_root(square)[1], multipliers


def gyroscopic_form(body: RigidBody, axis: int) -> Matrix:
    """Symmetric G with X'G X = (X x J^-1 X)_axis."""
    A = body.exact_inverse
    j, k = (axis + 1) % 3, (axis + 2) % 3
    G = [[Fraction(0)] * 3 for _ in range(3)]
    for m in range(3):
        for row, column, value in ((j, m, A[k][m]), (k, m, -A[j][m])):
            G[row][column] += value / 2
            G[column][row] += value / 2
    return tuple(map(tuple, G))


def gyroscopic_bound(
    momenta: GaugeSet, B: Widths, axis: int
) -> tuple[Fraction, tuple[tuple[Fraction, ...], tuple[Fraction, ...]]]:
    """Upper bound of |X'G X| over X in the set, |X_j| <= B_j, |X_axis| >= 1; multipliers of both signs."""
    G = gyroscopic_form(momenta.body, axis)
    units = [unit(j) for j in range(3)]
    matrices = [*momenta.matrices, *units]
    levels = [*momenta.levels, *(b * b for b in B)]
    none = (Fraction(0),) * (len(matrices) + 1)
    if not any(any(row) for row in G):
        return Fraction(0), (none, none)
    both = []
    for sign in (1, -1):
        both.append(_dual_bound(shifted(G, Fraction(sign), Fraction(0)), matrices, levels, units[axis]))
    return _coarser(max(both[0][0], both[1][0])), (both[0][1], both[1][1])


def _dual_bound(
    G: Matrix, matrices: list[Matrix], levels: list[Fraction], floor: Matrix | None
) -> tuple[Fraction, tuple[Fraction, ...]]:
    """Sum l_k g_k^2 - rho with sum l_k M_k - rho floor - G >= 0, proved by minors; l (and rho)."""
    multipliers = _solve_dual(G, matrices, levels, floor)
    rows = matrices if floor is None else [*matrices, shifted(floor, Fraction(-1), Fraction(0))]
    values = levels if floor is None else [*levels, Fraction(-1)]
    slack = Fraction(max(float(m) for m in multipliers) + 1e-6) / 10**9
    for _ in range(40):
        lifted = [multipliers[0] + slack, *multipliers[1:]]
        if is_positive_definite(combination([*lifted, Fraction(-1)], [*rows, G])):
            bound = sum((m * g for m, g in zip(lifted, values, strict=True)), Fraction(0))
            return max(bound, Fraction(0)), tuple(lifted)
        slack *= 4
    raise ArithmeticError("no multipliers prove a bound of the quadratic form")


def _solve_dual(
    G: Matrix, matrices: list[Matrix], levels: list[Fraction], floor: Matrix | None
) -> list[Fraction]:
    """Multipliers by a small semidefinite program (only guesses: they are checked afterwards)."""
    import clarabel
    from scipy import sparse

    root = float(np.sqrt(2.0))
    places = ((0, 0, 1.0), (0, 1, root), (1, 1, 1.0), (0, 2, root), (1, 2, root), (2, 2, 1.0))
    size = max(abs(float(x)) for row in G for x in row)
    columns = [[-float(M[i][j]) * c / size for i, j, c in places] for M in matrices]
    values = [float(g) for g in levels]
    if floor is not None:
        columns.append([float(floor[i][j]) * c / size for i, j, c in places])
        values.append(-1.0)
    count = len(columns)
    rows = np.vstack([-np.eye(count), np.array(columns).T])
    right = np.concatenate([np.zeros(count), [-float(G[i][j]) * c / size for i, j, c in places]])
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    cones = [clarabel.NonnegativeConeT(count), clarabel.PSDTriangleConeT(3)]
    zero = sparse.csc_matrix((count, count))
    matrix = sparse.csc_matrix(rows)
    solution = clarabel.DefaultSolver(zero, np.array(values), matrix, right, cones, settings).solve()
    return [Fraction(max(float(value), 0.0)) for value in solution.x]


def peak_from_components(
    sides: TransferSides, bounds: ComponentBounds, beta: Widths, travel: Fraction
) -> Fraction:
    """Largest p found with travel_above(p) <= travel: every smaller peak is impossible; at most the trial."""
    area = np.array([float(cell.area) for cell in sides.cells])
    ratio = np.array([float(cell.ratio) for cell in sides.cells])
    kappa, widths, box = (np.array([float(x) for x in v]) for v in (bounds.kappa, bounds.widths, beta))

    def approximate(p: float) -> float:
        factors = np.minimum(1 + kappa * p * ratio[:, None], widths) / box
        return float(p * (area * np.maximum(1.0, factors.max(axis=1))).sum())

    high = float(bounds.trial)
    if approximate(high) > float(travel):
        high, _ = bisected(lambda p: approximate(p) <= float(travel), 0.0, high, steps=60)
    # The float figure only proposes; each candidate is decided in exact arithmetic.
    for margin in (0.0, 1e-12, 1e-10, 1e-8, 1e-6):
        candidate = min(Fraction(high * (1 - margin)), bounds.trial)
        if sides.travel_above(candidate, bounds.kappa, bounds.widths, beta) <= travel:
            return candidate
    return Fraction(0)

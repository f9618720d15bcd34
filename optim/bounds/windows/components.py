r"""Largest component: the momentum's components are bounded one by one as well.

Before an instant s the motion is compared with the coast from its start (at rest: with the start),
after it, backwards, with rest. The deviation D = H - h from the coast's momentum, and H itself after
s, lie in p n K, K the invariant set; moreover |D_i| <= p m_i, |H_i| <= p m_i. If |D_j| <= B_j p n is known,
then wherever |D_i| >= floor p n the gyroscopic term (D x J^-1 D)_i is at most kappa_i (p n)^2, with

    kappa_i = max |(X x J^-1 X)_i|  over X in K, |X_j| <= B_j, |X_i| >= floor,

which bounds m_i: a smaller B_i, and again. Of a peak, all of it holds for smaller ones: the bound is
the largest peak whose travel is too short. A rate allowed at the end counts as momentum `end` there:
n = end + p dn after s, |H_i| <= max(h_i, end) + p dn + kappa_i int n^2, h_i the largest of that rate.

For fixed beta >= 1 what is counted is in p n f times the part of K with |H_i| <= beta_i, f from its
components over beta, turned as the coast turns; a potential for that part gives a bound. For J = c I,
kappa = 0 and the part is the box itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import final

import numpy as np

from ....models.rigid_body import RigidBody
from ....models.schedule import PiecewisePolynomial
from ....models.schedule import polynomial as univariate
from ....models.types import Array
from ....verify.exact.ball import square_root
from ....verify.exact.matrix import Matrix, combination, is_positive_definite, shifted, unit
from ....verify.exact.rounding import significant_above
from ..sets.gauge import GaugeSet
from .drift import CELLS, MARGIN, Cells, Ways
from .travel import WindowTravel

_BITS = 40
_SIGNS = np.array([(1.0, a, b) for a in (1.0, -1.0) for b in (1.0, -1.0)])

Widths = tuple[Fraction, Fraction, Fraction]


def closing_cells(window: PiecewisePolynomial, until: Fraction) -> Array:
    """Cells [a, b] of the time `until` before the end, counted backwards, dn the open time from there.

    Columns: length, int dn over the cell, dn at a, b, int_0^b dn, int_0^b dn^2.
    """
    back = WindowTravel(_mirrored(window))
    inside = {k for k in back.window.knots if 0 < k < until}
    edges = sorted({until * k / CELLS for k in range(CELLS + 1)} | inside)
    rows = [
        (
            b - a,
            back.opened_area(b) - back.opened_area(a),
            back.up(a),
            b,
            back.opened_area(b),
            back.opened_square(b),
        )
        for a, b in pairwise(edges)
    ]
    return np.array([[float(x) for x in row] for row in rows]).reshape(-1, 6)


def _mirrored(window: PiecewisePolynomial) -> PiecewisePolynomial:
    """Return the profile with time running backwards."""
    horizon, one = window.knots[-1], Fraction(1)
    shapes = tuple(univariate.compose_affine(shape, one, -one) for shape in reversed(window.shapes))
    return PiecewisePolynomial(tuple(horizon - k for k in reversed(window.knots)), shapes)


@final
@dataclass(frozen=True)
class Sides:
    """Both sides of a transfer: what a peak allows. Floats, rounded up by `MARGIN`.

    Attributes
    ----------
    momenta : GaugeSet
        K.
    widths : array (3,)
        |X_i| over it, at most.
    opening : Cells
        The deviation from the coast before the split.
    ways : Ways
        How it is turned until the split.
    closing : array (n, 6)
        After the split, see `closing_cells`.
    end : float
        Gauge of the momentum at the end, at most.
    ends : array (3,)
        Components of it, at most.
    """

    momenta: GaugeSet
    widths: Array
    opening: Cells
    ways: Ways
    closing: Array
    end: float
    ends: Array

    @property
    def floor(self) -> float:
        """|D_i| over p n where it reaches its bound, at least."""
        return 1 / (float(self.opening.scale.max(initial=1.0)) * MARGIN)

    def _opening_box(self, kappa: Array, p: float) -> Array:
        """Upper bounds of |D_i|/(p up), (n, 3)."""
        cells = self.opening
        return np.minimum(cells.rise + p * cells.swell @ kappa, self.widths * cells.scale[:, None])

    def _closing_ratios(self, kappa: Array, p: float) -> Array:
        """Upper bounds of |H_i|/n after the split, (n, 3): int n^2/n is at most int n, because n rises."""
        _, _, before, time, integral, square = self.closing.T
        n = self.end + p * before
        whole = self.end * time + p * integral
        powers = self.end**2 * time + 2 * self.end * p * integral + p * p * square
        swell = np.minimum(whole, np.divide(powers, n, out=whole.copy(), where=n > 0))
        beyond = np.maximum(self.ends - self.end, 0.0)
        more = np.divide(beyond, n[:, None], out=np.zeros((len(n), 3)), where=n[:, None] > 0)
        return np.asarray(1 + more + swell[:, None] * kappa)

    def largest_ratios(self, kappa: Array, p: float) -> Array:
        """Upper bounds of |D_i| before the split and of |H_i| after it, over n; (3,)."""
        both = self.opening.rise + p * self.opening.swell @ kappa, self._closing_ratios(kappa, p)
        return np.asarray(np.concatenate([np.ones((1, 3)), *both]).max(axis=0) * MARGIN)

    def _turned(self, kappa: Array, p: float) -> tuple[Array, Array, Array]:
        """At both ends of each cell's way: gauge (n, 2) and components (n, 2, 3); and |x| at most, (n,)."""
        A, g = self.ways.ends, self._opening_box(kappa, p)
        M, levels = self.momenta.float_rows
        points = np.einsum("neij,cj,nj->neci", A, _SIGNS, g)
        squares = (np.einsum("neci,kij,necj->neck", points, M, points) / levels).max(axis=2)
        gaps = np.linalg.norm(np.einsum("neji,kjl,nelm->nekim", A, M, A) - M, axis=(3, 4))
        gaps = (gaps + 1e-13 * np.linalg.norm(M, axis=(1, 2))) * levels[0] / levels
        level = np.sqrt(np.minimum(squares, self.opening.scale[:, None, None] ** 2 * (1 + gaps)).max(axis=2))
        reach = np.minimum(np.einsum("neij,nj->nei", np.abs(A), g), self.widths * level[..., None])
        return level, reach, np.linalg.norm(g, axis=1)

    def components(self, kappa: Array, p: float) -> Array:
        """Largest components of what is counted, (3,): what a box of use has to hold."""
        after = np.minimum(self._closing_ratios(kappa, p), self.widths)
        reach = self._turned(kappa, p)[1].reshape(-1, 3)
        return np.asarray(np.concatenate([np.ones((1, 3)), reach, after]).max(axis=0))

    def allowed(self, p: float, kappa: Array, box: Array) -> float:
        """Upper bound of the travel of a transfer of peak p, in the part |H_i| <= box_i of K.

        That part holds the unit ball: K holds the cube, and the box is at least 1.
        """
        level, reach, size = self._turned(kappa, p)
        gauge = np.maximum(level, (reach / box).max(axis=2)).max(axis=1) + self.ways.bend * size
        ratios = np.minimum(self._closing_ratios(kappa, p), self.widths) / box
        n = self.end * self.closing[:, 0] + p * self.closing[:, 1]
        after = n @ np.maximum(1.0, ratios.max(axis=1))
        return float((p * self.opening.area @ gauge + after) * MARGIN)


@final
@dataclass(frozen=True)
class ComponentBounds:
    """Valid at the trial peak and below: gyroscopic constants, and |D_i|, |H_i| <= B_i n.

    Attributes
    ----------
    trial : float
        Largest peak.
    kappa, B, widths : three Fraction
        kappa_i of the part |X_j| <= B_j; either B_i is the width of K or above every ratio at the trial.
    multipliers : six tuples of Fraction
        For each axis and sign those that prove kappa_i: rows of the set, of the box, and the floor's.
    width_multipliers : three tuples of Fraction
        Those that prove the widths.
    """

    trial: float
    kappa: Widths
    B: Widths
    widths: Widths
    multipliers: tuple[tuple[Fraction, ...], ...]
    width_multipliers: tuple[tuple[Fraction, ...], ...]

    @property
    def rates(self) -> Array:
        """Floats above kappa, (3,)."""
        return np.array([float(k) for k in self.kappa]) * MARGIN

    def hold(self, sides: Sides, p: float) -> bool:
        """Whether every B_i is a width of K, or above every ratio that kappa gives at the peak p."""
        ratios = sides.largest_ratios(self.rates, p)
        return all(b >= r or b > x for b, r, x in zip(self.B, self.widths, ratios, strict=True))


def widths_of(momenta: GaugeSet) -> tuple[Widths, tuple[tuple[Fraction, ...], ...]]:
    """Upper bounds of |X_i| over the set, and the multipliers that prove them."""
    proved = [momenta_width(momenta, axis) for axis in range(3)]
    return (proved[0][0], proved[1][0], proved[2][0]), tuple(m for _, m in proved)


def component_bounds(momenta: GaugeSet, sides: Sides, trial: float, *, rounds: int = 5) -> ComponentBounds:
    """Iterate kappa and B from the widths of the invariant set.

    B is kept while it confirms itself, above every ratio that kappa(B) gives at the trial peak: that
    alone makes it valid, for |D_i| <= B_i p n holds where the windows first open and cannot cease.
    """
    widths, width_multipliers = widths_of(momenta)
    floor, B, best = Fraction(sides.floor), widths, None
    for _ in range(rounds):
        found = [gyroscopic_bound(momenta, B, axis, floor) for axis in range(3)]
        kappa: Widths = (found[0][0], found[1][0], found[2][0])
        multipliers = tuple(m for _, both in found for m in both)
        bounds = ComponentBounds(trial, kappa, B, widths, multipliers, width_multipliers)
        if not bounds.hold(sides, trial):
            break
        best = bounds
        lower = [
            significant_above(Fraction(float(x)) * (1 + Fraction(1, 10**7)), _BITS)
            for x in sides.largest_ratios(bounds.rates, trial)
        ]
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
    momenta: GaugeSet, B: Widths, axis: int, floor: Fraction = Fraction(1)
) -> tuple[Fraction, tuple[tuple[Fraction, ...], tuple[Fraction, ...]]]:
    """Bound |X'G X| over X in the set, |X_j| <= B_j, |X_axis| >= floor; multipliers of both signs."""
    G = gyroscopic_form(momenta.body, axis)
    units = [unit(j) for j in range(3)]
    matrices = [*momenta.matrices, *units]
    levels = [*momenta.levels, *(b * b for b in B)]
    none = (Fraction(0),) * (len(matrices) + 1)
    if not any(any(row) for row in G):
        return Fraction(0), (none, none)
    both = []
    for sign in (1, -1):
        signed = shifted(G, Fraction(sign), Fraction(0))
        both.append(_dual_bound(signed, matrices, levels, units[axis], floor))
    return significant_above(max(both[0][0], both[1][0]), _BITS), (both[0][1], both[1][1])


def _dual_bound(
    G: Matrix,
    matrices: list[Matrix],
    levels: list[Fraction],
    axis: Matrix | None,
    floor: Fraction = Fraction(1),
) -> tuple[Fraction, tuple[Fraction, ...]]:
    """Sum l_k g_k^2 - rho floor^2 with sum l_k M_k - rho (axis) - G >= 0, proved by minors; l (and rho)."""
    rows = matrices if axis is None else [*matrices, shifted(axis, Fraction(-1), Fraction(0))]
    values = levels if axis is None else [*levels, -(floor**2)]
    multipliers = _solve_dual(G, rows, values)
    slack = max(abs(x) for row in G for x in row) / 10**9
    for _ in range(40):
        lifted = [multipliers[0] + slack, *multipliers[1:]]
        if is_positive_definite(combination([*lifted, Fraction(-1)], [*rows, G])):
            bound = sum((m * g for m, g in zip(lifted, values, strict=True)), Fraction(0))
            return max(bound, Fraction(0)), tuple(lifted)
        slack *= 4
    raise ArithmeticError("no multipliers prove a bound of the quadratic form")


def _solve_dual(G: Matrix, rows: list[Matrix], levels: list[Fraction]) -> list[Fraction]:
    """Multipliers by a small semidefinite program (only guesses: they are checked afterwards)."""
    import clarabel
    from scipy import sparse

    root = float(np.sqrt(2.0))
    places = ((0, 0, 1.0), (0, 1, root), (1, 1, 1.0), (0, 2, root), (1, 2, root), (2, 2, 1.0))
    size, sizes = _largest(G), [_largest(M) for M in rows]  # in these, every number is near 1
    columns = [[-float(M[i][j]) * c / one for i, j, c in places] for M, one in zip(rows, sizes, strict=True)]
    count = len(columns)
    matrix = sparse.csc_matrix(np.vstack([-np.eye(count), np.array(columns).T]))
    right = np.concatenate([np.zeros(count), [-float(G[i][j]) * c / size for i, j, c in places]])
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    cones = [clarabel.NonnegativeConeT(count), clarabel.PSDTriangleConeT(3)]
    zero = sparse.csc_matrix((count, count))
    values = np.array([float(g) / one for g, one in zip(levels, sizes, strict=True)])
    solution = clarabel.DefaultSolver(zero, values, matrix, right, cones, settings).solve()
    return [Fraction(max(float(x), 0.0) * size / one) for x, one in zip(solution.x, sizes, strict=True)]


def _largest(M: Matrix) -> float:
    return max(abs(float(x)) for row in M for x in row)


def peak_from_components(sides: Sides, bounds: ComponentBounds, beta: Widths, travel: float) -> float:
    """Largest p found, at most the trial, for which less than the travel is allowed: no smaller peak will do.

    What a peak allows grows at least in proportion to it, but for what a rate allowed at the end adds:
    from above, the first step of the search is allowed already, and further ones creep up from there.
    """
    box, p, best = np.array([float(b) for b in beta]), bounds.trial, 0.0
    for _ in range(8):
        allowed = sides.allowed(p, bounds.rates, box)
        if allowed <= travel and bounds.hold(sides, p):
            best = max(best, p)
            if p == bounds.trial:
                break
        p = min(p * travel / allowed * (1 - 1e-12), bounds.trial)
        if p <= best * (1 + 1e-9):
            break
    return best

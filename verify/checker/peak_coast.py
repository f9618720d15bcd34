"""Where a coast leads, for ways that are counted from there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from operator import mul

from .exact_numbers import Matrix, Vector, require, show
from .matrices import inverse_matrix, is_positive_semidefinite
from .peak_gauge import Gauge
from .peak_numbers import (
    PEAK_COAST_BITS,
    PEAK_COAST_CELLS,
    PEAK_COAST_ORDER,
    PEAK_COAST_STEPS,
    axis_matrix,
    combination,
    exponential_above,
    image,
    length_interval,
    magnitude,
    quaternion_times,
    root_interval,
    rounded_up,
)
from .peak_transfer import Transfer
from .polynomials import cross
from .reading import Node


@dataclass(frozen=True)
class Departure:
    """Where the way is counted from: the start, or an attitude near C(until), where a coast leads.

    C keeps the momentum H0 of the start, fixed in space. Let d be the rest of the momentum in body axes
    and e the least travel that joins C to the attitude. Rows have the form a I + b J^-1, so that
        N(d)' <= p w + nu N(d),        e' <= N(d) + mu e
    with nu of d -> -(J^-1 h) x d and mu of y -> h x J^-1 y - J (J^-1 h x J^-1 y), |h| = |H0|; hence
    e(until) <= p int w(t) u (exp(mu u) + exp(nu u))/2 dt, u = until - t. From there on the travel to the
    target is what is left of the transfer, and `slack` joins C(until) to the attitude stated.
    """

    until: Fraction
    attitude: Vector
    deviation: Fraction
    slack: Fraction
    words: str

    @classmethod
    def none(cls, d: Transfer) -> Departure:
        """Return the start itself."""
        return cls(Fraction(0), d.attitude, Fraction(0), Fraction(0), "")

    @classmethod
    def read(cls, d: Transfer, gauge: Gauge, place: Node) -> Departure:
        """Read and prove a coast."""
        until, turn, slack = (place[name].number() for name in ("until", "turn", "slack"))
        require(0 < until <= d.window.knots[-1], "the coast must end within the transfer")
        attitude = place["attitude"].vector(4)
        require_turn(*coast_attitude(d.J, d.attitude, d.momentum, until), attitude, turn)
        gauge.require_rates_within(turn, slack)
        mu, nu = place["growth"].vector(2)
        require_growth(gauge, d.momentum, mu, nu)
        deviation = Fraction(0)
        for k in range(PEAK_COAST_CELLS):
            a, b = (until * (k + i) / PEAK_COAST_CELLS for i in (0, 1))
            factor = (exponential_above(mu * (until - a)) + exponential_above(nu * (until - a))) / 2
            deviation += d.window.moment(a, b, until) * factor
        words = f"after a coast of {show(until)} s, "
        return cls(until, attitude, deviation, slack, words)


def coast_attitude(J: Matrix, q: Vector, H: Vector, until: Fraction) -> tuple[Vector, Fraction]:
    """Quaternion after free motion from q with body momentum H, and a bound of the distance from it."""
    end = coast_nodes(J, q, H, until, 1)[-1]
    return end.attitude, end.error


@dataclass(frozen=True)
class CoastNode:
    """A quaternion and a body momentum near those of a coast, and bounds of their distances from it."""

    attitude: Vector
    error: Fraction
    momentum: Vector
    off: Fraction


def coast_nodes(J: Matrix, q: Vector, H: Vector, step: Fraction, count: int) -> list[CoastNode]:
    """Free motion from q with body momentum H != 0, after 0, 1, ... count steps.

    In parts of the time x in [0, 1], with g = H/sigma and u = B g, B = sigma part J^-1,
        g' = g x u,        q' = q (0, u)/2,
    Taylor polynomials in units of 2^-PEAK_COAST_BITS, B too, however long its numbers are. What they miss
    of the equations (the products beyond their degree, and every rounding) is a defect; |g| and the length
    of a difference of quaternions are conserved, so the errors grow at most as
    e' <= |B| (|g| + |its polynomial|) e + defect and as |q's polynomial| |B| e/2 + defect.
    """
    one, inverse = 1 << PEAK_COAST_BITS, inverse_matrix(J)
    size = length_interval(H)[1]
    sigma = Fraction(2) ** magnitude(size)
    fastest = root_interval(sum((x * x for row in inverse for x in row), Fraction(0)))[1]
    parts = math.ceil(8 * fastest * size * step)
    require(parts * count <= PEAK_COAST_STEPS, "the coast turns too far")
    require(1 < 2**64 * max(map(abs, q)) < 2**128, "the start quaternion is too long or too short")
    B = [[math.floor(x * sigma * step / parts * one) for x in row] for row in inverse]
    b, size = fastest * sigma * step / parts, size / sigma
    g, p = ([math.floor(x * one) for x in v] for v in ([h / sigma for h in H], q))
    off, error = Fraction(4, one), Fraction(4, one)
    nodes = [CoastNode(q, Fraction(0), H, Fraction(0))]
    for number in range(1, parts * count + 1):
        G, Q, U = coast_series(B, g, p)
        sizes = [[sum(map(abs, c)) for c in v] for v in (G, Q, U)]
        reach, length = (Fraction(sum(v), one) for v in sizes[:2])
        rounded = Fraction(4 * (PEAK_COAST_ORDER + 1) ** 2, one)
        grown = b * (size + reach)
        require(grown <= 1, "a step of the coast is too long")
        rounded *= 1 + reach  # the rounding of B grows with what it acts on
        off += rounded * (1 + reach) + Fraction(beyond(sizes[0], sizes[2]), one * one)
        off = rounded_up(off * (1 + grown + grown**2) * one) / one
        error += rounded * (1 + length) + Fraction(beyond(sizes[1], sizes[2]), one * one) + length * b * off
        error = rounded_up(error * one) / one
        g, p = ([sum(c) for c in zip(*v, strict=True)] for v in (G, Q))
        if number % parts == 0:
            reached = [Fraction(c, one) for c in p]
            nodes.append(CoastNode(reached, error, [sigma * Fraction(c, one) for c in g], sigma * off))
    return nodes


def coast_series(B: list[list[int]], g: list[int], p: list[int]) -> tuple[list[list[int]], ...]:
    """Coefficients of g, q and u in powers of the time; each is off by at most one unit for its order."""
    G, Q, U = [g], [p], []
    for k in range(PEAK_COAST_ORDER + 1):
        U.append([sum(map(mul, row, G[k])) >> PEAK_COAST_BITS for row in B])
        if k == PEAK_COAST_ORDER:
            break
        pairs = [(i, k - i) for i in range(k + 1)]
        scale = (k + 1) << PEAK_COAST_BITS
        turns = [cross(G[i], U[j]) for i, j in pairs]
        moves = [quaternion_times(Q[i], [0, *U[j]]) for i, j in pairs]
        G.append([sum(c) // scale for c in zip(*turns, strict=True)])
        Q.append([sum(c) // (2 * scale) for c in zip(*moves, strict=True)])
    return G, Q, U


def beyond(x: list[int], y: list[int]) -> int:
    """Upper bound of what a product has beyond the series, in squares of the unit."""
    n = PEAK_COAST_ORDER
    return sum(a * sum(y[max(n - i, 0) :]) for i, a in enumerate(x))


def require_turn(reached: Vector, radius: Fraction, q: Vector, turn: Fraction) -> None:
    """Prove that a rotation by at most `turn` joins q to whatever is within the radius of `reached`."""
    share = sum((a * b for a, b in zip(reached, q, strict=True)), Fraction(0))
    square = sum((c * c for c in q), Fraction(0))
    require(share > 0 and square > 0, "the attitude after the coast is not the one stated")
    off = [a - share / square * b for a, b in zip(reached, q, strict=True)]
    distance, length = length_interval(off)[1] + radius, length_interval(reached)[0] - radius
    # The arc is at most asin(distance/length) <= (pi/2) distance/length, the rotation twice that.
    sure = length > distance and Fraction(22, 7) * distance <= turn * length
    require(sure, "the attitude after the coast is not proved to be the one stated")


def require_growth(gauge: Gauge, H: Vector, mu: Fraction, nu: Fraction) -> None:
    """Prove mu and nu of `Departure`.

    A row's growth is y'M X y/(y'M y), X linear in h. Where N(y) = 1 by that row y'M y = L, and |y|^2 <= L_0:
    it is at most L_0/L times the largest eigenvalue of the symmetric part of M X.
    """
    require(mu >= 0 and nu >= 0, "growth must not be negative")
    unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
    require(gauge.rows[0] == unit and gauge.box is None, "the first row of the set must be the identity")
    stretch, turning = [], []
    for h in unit:
        w = image(gauge.inverse, h)
        moved = [image(gauge.inverse, y) for y in unit]
        held = [image(gauge.J, cross(w, c)) for c in moved]
        parted = [cross(h, c) for c in moved]
        stretch.append(
            [[x - y for x, y in zip(a, b, strict=True)] for a, b in zip(parted, held, strict=True)]
        )
        turning.append([cross(y, w) for y in unit])
    square = sum((x * x for x in H), Fraction(0))
    for M, L in zip(gauge.rows, gauge.levels, strict=True):
        for rate, X in ((mu, stretch), (nu, turning)):
            require_eigenvalues_within(M, X, square, rate * L / gauge.levels[0])


def require_eigenvalues_within(M: Matrix, X: list[Matrix], square: Fraction, bound: Fraction) -> None:
    """Prove that eigenvalues of S, the symmetric part of M sum h_i X_i, are <= bound for |h|^2 <= square.

    Each X is a list of columns. The trace of S is 0, so they are at most sqrt(2/3) |S|_F; and
    |S|_F^2 = h'G h with G_ij = tr S_i S_j.
    """
    parts: list[Vector] = []
    for columns in X:
        A = [image(M, c) for c in columns]
        S = [[(A[j][i] + A[i][j]) / 2 for j in range(3)] for i in range(3)]
        require(S[0][0] + S[1][1] + S[2][2] == 0, "a growth of volumes")
        parts.append([x for row in S for x in row])
    gram = [[sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0)) for q in parts] for p in parts]
    unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
    gap = combination([Fraction(3, 2) * bound**2, -square], [unit, gram])
    require(is_positive_semidefinite(gap), "the growth of a deviation is not proved")

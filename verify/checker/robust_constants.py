"""Constants of a body that the controller does not know, recomputed from the data.

The controller uses J0, the body J, (1 - below) J0 <= J <= (1 + above) J0; the torque acts through a rotation
M by at most theta; a constant thrust factor 1 + d is an inertia J/(1 + d). x = w + J^-1 M J0 zeta,
zeta = 2 g^2 kappa bv. Every constant is on its safe side; lo, hi, q = sqrt(hi/lo), mu = |M - 1|
as in docs/theory-robust.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from .body import read_inertia
from .exact_numbers import Matrix, require, show
from .floor_bounds import root_above
from .matrices import is_positive_semidefinite, is_symmetric
from .reading import Node

CELLS = 256
ZERO, ONE = Fraction(0), Fraction(1)
PI_HIGH = Fraction(31415926535897932384626433832795028842, 10**37)
ENTRIES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


@dataclass(frozen=True)
class Uncertain:
    """The uncertainty of the data."""

    relative: Fraction
    scale: tuple[Fraction, Fraction]
    thrust: tuple[Fraction, Fraction]
    stays: bool
    turn: Fraction
    push: Fraction

    @property
    def whole_scale(self) -> tuple[Fraction, Fraction]:
        """Interval of e in J/(1 + d) = (1 + e) J_shape."""
        (low, high), (weak, strong) = self.scale, self.thrust
        return (1 + low) / (1 + strong) - 1, (1 + high) / (1 + weak) - 1


def read_uncertainty(data: Node) -> Uncertain:
    """Read the uncertainty; what is not given is zero."""
    node = data["uncertainty"]

    def number(name: str) -> Fraction:
        return node[name].number() if node.has(name) else ZERO

    def interval(name: str) -> tuple[Fraction, Fraction]:
        if not node.has(name):
            return ZERO, ZERO
        low, high = node[name].vector(2)
        require(-1 < low <= 0 <= high, f"{name} must hold 0 and stay above -1")
        return low, high

    varies = node["thrust_error_varies"].text() if node.has("thrust_error_varies") else "per-firing"
    require(varies in ("never", "per-firing"), "unknown way for the thrust to vary")
    turn, push, relative = number("misalignment_deg"), number("disturbance"), number("inertia_relative")
    require(0 <= turn < 30 and push >= 0 and 0 <= relative < 1, "the uncertainty is out of range")
    thrust = interval("thrust_error")
    stays = varies == "never" or not any(thrust)
    return Uncertain(relative, interval("inertia_scale"), thrust, stays, turn, push)


def check_shape(data: Node, u: Uncertain, J: Matrix, shape: Fraction) -> None:
    """Check that rho J0 holds every deviation of the tolerance beside the relative error."""
    node, left = data["uncertainty"], shape - u.relative
    require(left >= 0 and shape < 1, "rho is too small for the inertia's relative error, or not below 1")
    if not node.has("inertia_tolerance"):
        return
    radius = node["inertia_tolerance"].matrix(3, 3)
    require(is_symmetric(radius) and all(x >= 0 for row in radius for x in row), "a tolerance must be >= 0")
    for signs in product((1, -1), repeat=6):  # convex: the corners decide
        D = [[left * J[i][j] for j in range(3)] for i in range(3)]
        for sign, (i, j) in zip(signs, ENTRIES, strict=True):
            D[i][j] += sign * radius[i][j]
            D[j][i] = D[i][j]
        require(is_positive_semidefinite(D), "rho is too small for the inertia's tolerance")


def root_below(value: Fraction) -> Fraction:
    """Return a rational <= sqrt(value)."""
    return value / root_above(value) if value > 0 else ZERO


@dataclass(frozen=True)
class RobustConstants:
    """The constants of one bin of common factors `scale`; `metric`: of the body that measures |x|."""

    lo: Fraction
    hi: Fraction
    determinant: Fraction
    shape: Fraction
    scale: tuple[Fraction, Fraction]
    metric: tuple[Fraction, Fraction]
    boost: Fraction
    sine: Fraction
    mu: Fraction

    @property
    def below(self) -> Fraction:
        """J >= (1 - below) J0."""
        return 1 - (1 + self.scale[0]) * (1 - self.shape)

    @property
    def above(self) -> Fraction:
        """J <= (1 + above) J0."""
        return (1 + self.scale[1]) * (1 + self.shape) - 1

    @property
    def least(self) -> Fraction:
        """Least principal inertia of the metric, or less."""
        return (1 + self.metric[0]) * (1 - self.shape) * self.lo

    @property
    def widening(self) -> Fraction:
        """|x|^2 in the metric is at most this times x'J0 x."""
        return (1 + self.metric[1]) * (1 + self.shape)

    @property
    def q(self) -> Fraction:
        """sqrt(hi/lo), from above."""
        return root_above(self.hi / self.lo)

    @property
    def skew(self) -> Fraction:
        """(q - 1/q)/sqrt 3: norm of a matrix without diagonal whose entries are half of q - 1/q."""
        return (self.q - 1 / self.q) / root_below(Fraction(3))

    def mean(self, e: Fraction) -> Fraction:
        """Common factor in J^-1 J0 - 1."""
        return (1 / (1 - self.shape) + 1 / (1 + self.shape)) / (2 * (1 + e)) - 1

    def spread(self, e: Fraction) -> Fraction:
        """Norm of the shape in J^-1 J0."""
        return (1 / (1 - self.shape) - 1 / (1 + self.shape)) / (2 * (1 + e))

    @property
    def m(self) -> Fraction:
        """Greatest |mean|."""
        return max(abs(self.mean(e)) for e in self.scale)

    @property
    def r(self) -> Fraction:
        """Greatest spread."""
        return self.spread(self.scale[0])

    @property
    def damping(self) -> Fraction:
        """X'M J0 x >= damping |x|_J^2."""
        loss = self.sine * self.skew + self.q * self.mu**2 / 2
        return max(ZERO, 1 - loss) / (1 + self.above)

    @property
    def braking(self) -> Fraction:
        """-bv'(J^-1 M J0 - 1) bv <= braking |bv|^2."""
        q = self.q
        shape = max(-self.mean(e) + self.spread(e) * (q + 1 / q) / 2 for e in self.scale)
        return max(ZERO, shape + self.mu * (q * q + 1) / (2 * (1 - self.below)))

    @property
    def accelerating(self) -> Fraction:
        """bv'(J^-1 M J0 - 1) bv <= accelerating |bv|^2."""
        q = self.q
        shape = max(self.mean(e) + self.spread(e) * (q + 1 / q) / 2 for e in self.scale)
        return max(ZERO, shape + self.mu * (q * q + 1) / (2 * (1 - self.below)))

    @property
    def measured_mismatch(self) -> Fraction:
        """|J0^1/2 (J^-1 M J0 - 1) bv| <= measured_mismatch |bv|."""
        return root_above(self.hi) * (self.m + self.r + self.mu * self.q / (1 - self.below))

    @property
    def metric_ratio(self) -> Fraction:
        """|x| in J0 is at most this times |x| in the metric."""
        return root_above(self.lo / self.least)

    @property
    def mismatch(self) -> Fraction:
        """|J^-1 M J0 - 1| <= mismatch."""
        return self.m + self.r * self.q + self.mu * self.q**2 / (1 - self.below)

    @property
    def gyroscopic(self) -> Fraction:
        """|x.B(bv, x)| <= gyroscopic |bv| |x|_J^2."""
        if not (self.r or self.mu):
            return ZERO
        q, rest = self.q, 1 - self.below
        ratio = q * root_above((1 + self.shape) / (1 - self.shape))
        whirl = (self.r * q + self.mu * q * q / rest) * (ratio - 1 / ratio) / 2
        return whirl + q * self.r * (1 + self.above) / rest + self.mu * q / rest

    def forcings(self) -> list[Fraction]:
        """Bound of the forcing over sqrt(S) for S up to the end of each cell."""
        if not (self.m or self.r or self.mu):
            return [ZERO] * CELLS
        q, rest, mu = self.q, 1 - self.below, self.mu
        tau = root_above(self.hi**3 / self.determinant) + q
        excess = max(self.above / root_below((1 + self.above) ** 3), self.below / root_below(rest**3))
        change = max(self.above / (1 + self.above), self.below / rest)
        turned = q * mu / root_below(rest) * ((1 + q * mu) / rest + change)
        wrench = root_above(self.hi) * (excess + turned)
        twist = self.r * (q + 1) + mu * (1 + self.mismatch) + mu * (q * q + q) / rest
        swirl = self.hi * twist / root_below(rest * self.lo)
        result, most = [], ZERO
        for cell in range(CELLS):
            low, high = Fraction(2 * cell, CELLS), Fraction(2 * cell + 2, CELLS)
            n = root_above(high * (2 - high)) if high < 1 else ONE
            alpha, beta = 2 - low, 4 * n
            if mu:
                size = alpha * wrench + beta * swirl
            else:
                square = alpha**2 + (beta * tau) ** 2 + 2 * alpha * beta * self.skew
                size = root_above(self.hi / rest) * (alpha * self.m + self.r * root_above(square))
            most = max(most, size * root_above((2 - low) * self.boost))
            result.append(most)
        return result


def read_constants(data: Node, place: Node, u: Uncertain, witness: Node) -> RobustConstants:
    """Constants of one bin: bounds of the eigenvalues and rho are read and checked, all else is computed."""
    J = read_inertia(data)
    lo, hi, shape = (witness[name].number() for name in ("lo", "hi", "shape"))
    require(0 < lo <= hi, "the bounds of the principal inertias are not bounds")
    for sign, bound in ((1, lo), (-1, hi)):
        gap = [[sign * (J[i][j] - (bound if i == j else 0)) for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "a principal inertia is out of its bounds")
    check_shape(data, u, J, shape)
    low, high = place["scale"].vector(2)
    require(-1 < low <= high, "a bin's factors are out of order")
    half = u.turn * PI_HIGH / 360
    scale = (low, high)
    metric, boost = (scale, ONE) if u.stays else (u.scale, 1 + u.thrust[1])
    determinant = (
        J[0][0] * (J[1][1] * J[2][2] - J[1][2] ** 2)
        - J[0][1] * (J[0][1] * J[2][2] - J[1][2] * J[0][2])
        + J[0][2] * (J[0][1] * J[1][2] - J[1][1] * J[0][2])
    )
    # sin x <= x - x^3/6 + x^5/120, and it grows below 90 deg
    sine = [x - x**3 / 6 + x**5 / 120 for x in (2 * half, half)]
    result = RobustConstants(lo, hi, determinant, shape, scale, metric, boost, sine[0], 2 * sine[1])
    require(result.above <= 2, "the inertia may be more than three times the controller's")
    # it also keeps M J0 positive, so that a damping of 0 is a bound: sin <= mu <= 2/(q^2 + 1)
    require(result.braking <= 1, "the thrust may push away from the target")
    return result


def require_scales(u: Uncertain, bins: list[tuple[Fraction, Fraction]]) -> None:
    """Check that the bins' factors cover every body; where the thrust differs between firings one must."""
    low, high = u.whole_scale
    if not u.stays:
        require(all(a <= low and high <= b for a, b in bins), "a bin must hold every thrust error at once")
        return
    require(any(a <= low <= b for a, b in bins), f"no bin holds the factor {show(1 + low)}")
    reached = low
    for a, b in sorted(bins):
        require(a <= reached, f"no bin holds the factor {show(1 + reached)}")
        reached = max(reached, b)
    require(reached >= high, f"no bin holds the factor {show(1 + high)}")


def describe_uncertainty(data: Node, u: Uncertain) -> list[str]:
    """Return the bodies and disturbances for people."""
    node, words = data["uncertainty"], []
    if u.relative:
        words.append(f"(1 - {show(u.relative)}) J0 <= J <= (1 + {show(u.relative)}) J0")
    if node.has("inertia_tolerance"):
        rows = node["inertia_tolerance"].matrix(3, 3)
        words.append(
            "each |J - J0| entry <= " + str([[show(x) for x in row] for row in rows]).replace("'", "")
        )
    if any(u.scale):
        words.append(f"all of it times a factor in [{show(1 + u.scale[0])}, {show(1 + u.scale[1])}]")
    if any(u.thrust):
        how = "the same for all time" if u.stays else "constant within each firing"
        words.append(f"torque times a factor in [{show(1 + u.thrust[0])}, {show(1 + u.thrust[1])}], {how}")
    if u.turn:
        words.append(f"torque turned by at most {show(u.turn)} deg, fixed")
    if u.push:
        words.append(f"a disturbance torque of at most {show(u.push)} N m, varying at will")
    return (
        ["for every body and thruster with", *(f"  {line}" for line in words)]
        if words
        else ["with nothing uncertain"]
    )

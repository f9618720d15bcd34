"""The bodies a robust claim speaks about, around the inertia J0 that the controller uses.

J = (1 + e) J_s with e in an interval and (1 - rho) J0 <= J_s <= (1 + rho) J0 in the order of quadratic forms.
A tolerance entry by entry is such a set: the order is convex in J, so its 64 corners decide.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import final

import numpy as np

from ...models.rigid_body import ExactMatrix, RigidBody, leading_minors
from ..exact.matrix import greatest_eigenvalue_above, is_positive_semidefinite, least_eigenvalue_below

ENTRIES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
FINE = 10**6
"""A tolerance's rho is a multiple of 1/FINE, rounded up."""


@final
@dataclass(frozen=True)
class InertiaBin:
    """Bounds of one interval of common factors.

    Attributes
    ----------
    lo, hi : rationals around the principal inertias of J0, kg m^2
    determinant : of J0, (kg m^2)^3
    shape : rho
    scale_low, scale_high : ends of the interval of e
    least : rational <= the least principal inertia of the body in whose metric |x| is measured
    """

    lo: Fraction
    hi: Fraction
    determinant: Fraction
    shape: Fraction
    scale_low: Fraction
    scale_high: Fraction
    metric_low: Fraction | None = None
    metric_high: Fraction | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.shape < 1:
            raise ValueError(f"the relative inertia error must lie in [0, 1), received {float(self.shape):g}")
        if not -1 < self.scale_low <= self.scale_high:
            raise ValueError("the common factor of the inertia must stay above 0")

    @property
    def below(self) -> Fraction:
        """rho_-: J >= (1 - rho_-) J0."""
        return 1 - (1 + self.scale_low) * (1 - self.shape)

    @property
    def above(self) -> Fraction:
        """rho_+: J <= (1 + rho_+) J0."""
        return (1 + self.scale_high) * (1 + self.shape) - 1

    @property
    def least(self) -> Fraction:
        """Rational <= the least principal inertia of the metric of |x|, kg m^2."""
        low = self.scale_low if self.metric_low is None else self.metric_low
        return (1 + low) * (1 - self.shape) * self.lo

    @property
    def widening(self) -> Fraction:
        """|x|^2 in that metric is at most this times x'J0 x."""
        high = self.scale_high if self.metric_high is None else self.metric_high
        return (1 + high) * (1 + self.shape)

    def mean(self, e: Fraction) -> Fraction:
        """m: the common factor in J^-1 J0 - 1 at a factor e."""
        return (1 / (1 - self.shape) + 1 / (1 + self.shape)) / (2 * (1 + e)) - 1

    def spread(self, e: Fraction) -> Fraction:
        """r: the shape's part in J^-1 J0 at a factor e."""
        return (1 / (1 - self.shape) - 1 / (1 + self.shape)) / (2 * (1 + e))

    @cached_property
    def greatest_mean(self) -> Fraction:
        """Greatest |m|: m falls with e."""
        return max(abs(self.mean(e)) for e in (self.scale_low, self.scale_high))

    @cached_property
    def greatest_spread(self) -> Fraction:
        """Greatest r: at the smallest factor."""
        return self.spread(self.scale_low)

    @classmethod
    def around(
        cls, body: RigidBody, shape: Fraction = Fraction(0), scale: tuple[Fraction, Fraction] | None = None
    ) -> InertiaBin:
        """Bin around the controller's body."""
        J = body.exact_inertia
        low, high = scale if scale is not None else (Fraction(0), Fraction(0))
        lo, hi = least_eigenvalue_below(J), greatest_eigenvalue_above(J)
        return cls(lo, hi, leading_minors(J)[2], shape, low, high)


def relative_error(body: RigidBody, tolerance: Sequence[Sequence[Fraction]]) -> Fraction:
    """Least rho found with -rho J0 <= D <= rho J0 for every symmetric |D_ij| <= tolerance_ij, proved.

    Raises
    ------
    ValueError
        If the tolerance reaches a singular inertia (rho >= 1).
    """
    corners = list(deviations(tolerance))
    root = np.linalg.inv(np.linalg.cholesky(body.inertia))
    size = max(float(np.abs(np.linalg.eigvalsh(root @ np.array(D, float) @ root.T)).max()) for D in corners)
    rho = Fraction(int(size * FINE * (1 + 1e-9)) + 1, FINE) if size else Fraction(0)
    while not all(_within(body.exact_inertia, D, rho) for D in corners):
        rho += Fraction(1, FINE)
    if rho >= 1:
        raise ValueError("the inertia's tolerance reaches a singular inertia: nothing follows")
    return rho


def deviations(tolerance: Sequence[Sequence[Fraction]]) -> Iterator[ExactMatrix]:
    """Corners of the tolerance up to a common sign, symmetric."""
    for signs in product((1, -1), repeat=5):
        D = [[Fraction(0)] * 3 for _ in range(3)]
        for sign, (i, j) in zip((1, *signs), ENTRIES, strict=True):
            D[i][j] = D[j][i] = sign * tolerance[i][j]
        yield tuple((row[0], row[1], row[2]) for row in D)


def _within(J: ExactMatrix, D: ExactMatrix, rho: Fraction) -> bool:
    return all(
        is_positive_semidefinite([[rho * J[i][j] + s * D[i][j] for j in range(3)] for i in range(3)])
        for s in (1, -1)
    )

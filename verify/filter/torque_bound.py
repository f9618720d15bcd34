"""A bound of the torque from certified bounds on the filter, the gain, the angle and the rate.

With w = Omega - 2 g^2 kappa bv and bv' = (b0 Omega + bv x Omega)/2 - g^2 kappa b0 bv the law reads

    u = q J bv - 2 g kappa bv x J Omega + 4 g^3 kappa^2 bv x J bv
        - g kappa J (b0 Omega + bv x Omega) - (g/2) kappa (1 + b0) J Omega,
    q = -4 g' kappa - 2 g kappa' + 2 g^3 kappa^2 b0.

n = |bv|, |Omega| <= y/sqrt(Jmin), |J Omega| <= sqrt(Jmax) y, |b0 Omega + bv x Omega| <= |Omega|,
|bv x J bv| <= n^2 (Jmax - Jmin)/2 bound each term. Persistence filter: kappa' = lambda kappa -
g^2 kappa^2 (1 + b0); adaptive scaling: 0 <= kappa' = gamma R g^2 f. The norm is Euclidean and so
bounds every component. Valid, and loose: a claim says by how much the study's largest torque is less.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from ...models.types import Array
from ..exact.ball import sqrt_above, sqrt_below
from ..exact.rounding import rounded_down, rounded_up
from .adaptive import AdaptiveSystem
from .certify import FilterLowerBound
from .comparison import BodyBounds
from .flowpipe import Box, LawComparison
from .persistence import PersistenceSystem

OUTWARD = 1 + 1e-12
"""Covers fewer than 1000 roundings (1.2e-16 each) of operations on numbers of one sign."""


@final
@dataclass(frozen=True)
class TorqueBound:
    """Euclidean torque bounds over the time covered by the floor; infinite where none is known.

    Attributes
    ----------
    applied : bound of |g u|, N m
    commanded : bound of |u|, N m
    instant : time at which the bound of |g u| is largest, s
    gain : bound of kappa, 1/s
    """

    applied: float
    commanded: float
    instant: float
    gain: float


@final
@dataclass(frozen=True)
class BoxColumns:
    """Boxes as arrays, (n,) each.

    Attributes
    ----------
    S, y : upper bounds of 1 - b0 and of |Omega|_J, kg^1/2 m rad/s
    low_filter, R : bounds of R from below and from above, s
    low, high : bounds of kappa, 1/s
    g, slope_low, slope_high : bound of |g|, bounds of g', 1/s
    start, stop : s
    """

    S: Array
    y: Array
    low_filter: Array
    R: Array
    low: Array
    high: Array
    g: Array
    slope_low: Array
    slope_high: Array
    start: Array
    stop: Array

    @classmethod
    def of(cls, boxes: Iterable[Box]) -> BoxColumns:
        """Gather boxes, at least one."""
        rows = [
            (b.cosine_gap, b.weighted_rate, b.filter_low, b.filter_high, b.gain_low, b.gain_high,
             b.gain_max, b.slope_low, b.slope_high, b.start, b.stop)
            for b in boxes
        ]  # fmt: skip
        return cls(*np.array(rows).T)

    def later(self, shift: float, scale: float) -> BoxColumns:
        """The same `shift` s later, s = sqrt(S) and y at most `scale` times theirs, S and y rounded up."""
        if scale == 1.0:
            return replace(self, start=self.start + shift, stop=self.stop + shift)
        return replace(
            self,
            S=np.nextafter(self.S * scale * scale * OUTWARD, np.inf),
            y=np.nextafter(self.y * scale, np.inf),
            start=self.start + shift,
            stop=self.stop + shift,
        )


def greatest_bv(S: Array) -> Array:
    """Bound of |bv| = sqrt(S' (2 - S')) over S' <= S."""
    inside = np.minimum(S, 1.0)
    bound: Array = np.sqrt(inside * (2.0 - inside)) * OUTWARD
    return bound


def torque_bound(floor: FilterLowerBound) -> TorqueBound:
    """Bound the torque over the time the floor covers, for every trajectory of its set."""
    boxes = [box for w in floor.flowpipes for box in (*w.boxes, *w.tail_boxes)]
    c = BoxColumns.of(boxes)
    applied, commanded = torque_bounds(floor.flowpipes[0].system, floor.bounds, c)
    worst = int(np.argmax(applied))
    return TorqueBound(
        applied=float(applied[worst]),
        commanded=float(np.max(commanded, initial=0.0)),
        instant=float(c.start[worst]),
        gain=float(c.high.max()),
    )


def torque_bounds(system: LawComparison, bounds: BodyBounds, c: BoxColumns) -> tuple[Array, Array]:
    """Bounds of |g u| and of |u| on each box, N m, (n,) each; infinite where the gain's are beyond numbers.

    Both are zero where g is: there u is not applied, and the law's u only mirrors g = 0.
    """
    least, greatest = rounded_down(bounds.least), rounded_up(bounds.greatest)
    root = sqrt_above(bounds.greatest)
    spin = c.y / sqrt_below(bounds.least)
    n = greatest_bv(c.S)
    with np.errstate(over="ignore", invalid="ignore"):
        q_low, q_high = _coefficient(system, c)
        commanded = (
            np.maximum(np.abs(q_low), np.abs(q_high)) * greatest * n
            + 2 * c.g * c.high * n * root * c.y
            + 2 * c.g**3 * c.high**2 * (greatest - least) * n**2
            + c.g * c.high * greatest * spin
            + c.g * c.high * root * c.y
        ) * OUTWARD
        inside = c.g > 0
        commanded = np.where(inside, np.where(np.isnan(commanded), np.inf, commanded), 0.0)
        return np.where(inside, commanded * c.g * OUTWARD, 0.0), commanded


def _coefficient(system: LawComparison, c: BoxColumns) -> tuple[Array, Array]:
    """Bounds of q; each term's interval, added, then widened by its rounding."""
    g, low, high = c.g, c.low, c.high
    slope = [-4 * s * k for s in (c.slope_low, c.slope_high) for k in (low, high)]
    b0_low = 1.0 - np.minimum(c.S, 2.0)
    square = 2 * g**3 * high**2
    terms = [(np.minimum.reduce(slope), np.maximum.reduce(slope))]
    if isinstance(system, PersistenceSystem):
        lam = rounded_up(system.decay)
        # -2 g kappa' + 2 g^3 kappa^2 b0 = -2 g lambda kappa + 2 g^3 kappa^2 (1 + 2 b0)
        terms.append((-2 * g * lam * high, np.zeros_like(g)))
        terms.append((np.minimum(square * (1 + 2 * b0_low), 0.0), 3 * square))
    elif isinstance(system, AdaptiveSystem):
        gamma, a = rounded_up(system.learning_rate), rounded_up(system.weight)
        intake = np.minimum(2 * (c.y**2 + 2 * a * c.S), 2 * a * (1 + c.y**2 / (4 * a)) ** 2)
        terms.append((-2 * g**3 * gamma * c.R * intake, np.zeros_like(g)))
        terms.append((np.minimum(square * b0_low, 0.0), square))
    else:
        raise TypeError(f"no torque bound is known for {type(system).__name__}")
    size = sum(np.maximum(np.abs(a), np.abs(b)) for a, b in terms)
    allowance = size * (OUTWARD - 1)
    return sum(a for a, _ in terms) - allowance, sum(b for _, b in terms) + allowance

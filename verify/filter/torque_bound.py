"""A bound of the torque from certified bounds on the filter, the gain, the angle and the rate.

With w = Omega - 2 g^2 kappa bv and bv' = (b0 Omega + bv x Omega)/2 - g^2 kappa b0 bv the law reads

    u = q J bv - 2 g kappa bv x J Omega + 4 g^3 kappa^2 bv x J bv
        - g kappa J (b0 Omega + bv x Omega) - d J Omega,
    q = -4 g' kappa - 2 g kappa' + 2 g^3 kappa^2 b0,   d = (g/2) kappa (1 + b0) in the paper's laws.

n = |bv|, |Omega| <= y/sqrt(Jmin), |J Omega| <= sqrt(Jmax) y, |b0 Omega + bv x Omega| <= |Omega|,
|bv x J bv| <= n^2 (Jmax - Jmin)/2 bound each term; each law's system says what it knows of kappa' and d.
The norm is Euclidean and so bounds every component. Valid, and loose: a claim says by how much the study's
largest torque is less.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from ...models.types import Array
from ..exact.ball import sqrt_above, sqrt_below
from ..exact.rounding import rounded_down, rounded_up
from .boxes import OUTWARD, BoxColumns, greatest_bv
from .certify import FilterLowerBound
from .comparison import BodyBounds
from .law_system import LawSystem


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


def torque_bound(floor: FilterLowerBound) -> TorqueBound:
    """Bound the torque over the time the floor covers, for every trajectory of its set."""
    boxes = [box for w in floor.flowpipes for box in (*w.boxes, *w.tail_boxes)]
    c = BoxColumns.of(boxes)
    applied, commanded = torque_bounds(floor.system, floor.bounds, c)
    worst = int(np.argmax(applied))
    return TorqueBound(
        applied=float(applied[worst]),
        commanded=float(np.max(commanded, initial=0.0)),
        instant=float(c.start[worst]),
        gain=float(c.high.max()),
    )


def torque_bounds(system: LawSystem, bounds: BodyBounds, c: BoxColumns) -> tuple[Array, Array]:
    """Bounds of |g u| and of |u| on each box, N m, (n,) each; infinite where the gain's are beyond numbers.

    Both are zero where g is: there u is not applied, and the law's u only mirrors g = 0.
    """
    least, greatest = rounded_down(bounds.least), rounded_up(bounds.greatest)
    root = sqrt_above(bounds.greatest)
    spin = c.y / sqrt_below(bounds.least)
    n = greatest_bv(c.S)
    with np.errstate(over="ignore", invalid="ignore"):
        _, damping = system.torque_terms(c)
        q_low, q_high = system.coefficient(c)
        commanded = (
            np.maximum(np.abs(q_low), np.abs(q_high)) * greatest * n
            + 2 * c.g * c.high * n * root * c.y
            + 2 * c.g**3 * c.high**2 * (greatest - least) * n**2
            + c.g * c.high * greatest * spin
            + damping * root * c.y
        ) * OUTWARD
        inside = c.g > 0
        commanded = np.where(inside, np.where(np.isnan(commanded), np.inf, commanded), 0.0)
        return np.where(inside, commanded * c.g * OUTWARD, 0.0), commanded

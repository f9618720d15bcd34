"""The least travel between two attitudes: a potential, proved, and what follows from it.

Claim: along every motion with J w = H, H(t) in n(t) K, that starts at the given attitude and
ends within the tolerance of the target quaternion,

    integral of n dt >= min( reach, (phi(start) - max phi(targets)) / c ),

where h(v) <= c for K on the region of paths of arc `arc_sum`, and reach is the travel below
which no path leaves that region. Proof: a path of travel below reach turns by at most
fastest_rate times it, its quaternion arc is half of that, so it stays in the region, where
|phi'| <= c n. If the travel is not below reach there is nothing to prove.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ....models.rigid_body import RigidBody
from ....models.types import Array
from ....verify.exact.ball import arc_below, length, square_root
from ....verify.exact.polynomial import Polynomial
from ....verify.exact.rounding import grid_above, grid_below
from ..sets.chart import Chart, Quaternion, Vector, chart_between
from ..sets.momentum_sets import MomentumSet
from ..sets.polynomials import AXES, RING, exponents
from ..sets.rate import momentum_rate_polynomials
from .fit import Fit, PotentialProgram
from .prove import BranchAndBound, Supremum

MAX_ARC = 3.0
"""Largest arc sum of a region, rad, below pi."""


@final
@dataclass(frozen=True)
class Target:
    """The quaternion +1 and everything within a tolerance.

    Attributes
    ----------
    radius : Fraction
        Largest |bv| allowed, >= 0.
    """

    radius: Fraction = Fraction(0)

    def arc_above(self) -> Fraction:
        """Upper bound of the quaternion arc asin(radius)."""
        if not self.radius:
            return Fraction(0)
        return self.radius / square_root(1 - self.radius**2)[0]

    def chord_above(self) -> Fraction:
        """Upper bound of the chord 2 sin(arc/2)."""
        if not self.radius:
            return Fraction(0)
        return square_root(2 - 2 * square_root(1 - self.radius**2)[0])[1]


@final
@dataclass(frozen=True)
class Separation:
    """A proved lower bound of the travel from an attitude to the target quaternion +1.

    Attributes
    ----------
    travel : Fraction
        The bound, N m s per unit of the momentum set times s.
    chart : Chart
        Coordinates and region.
    potential : Polynomial
        phi in scaled coordinates, exact.
    supremum : Supremum
        Proved largest rate c.
    difference, reach : Fraction
        phi(start) - max phi(targets), rounded down, and the travel of paths that may leave the region.
    """

    travel: Fraction
    chart: Chart
    potential: Polynomial
    supremum: Supremum
    difference: Fraction
    reach: Fraction


def separation(
    body: RigidBody,
    start: Quaternion,
    target: Target,
    program: PotentialProgram,
    prover: BranchAndBound,
    *,
    enough: float = np.inf,
) -> Separation:
    """Fit the potential of a program and prove what it gives.

    Fitting stops early once the travel is `enough`.
    """
    fit, chart, momenta = program.fit, program.chart, program.momenta
    best: Separation | None = None
    for _ in range(fit.proofs):
        unknowns = program.solve()[0]
        potential = _exact(program.coefficients(unknowns), fit.degree)
        found = proved_separation(body, start, target, momenta, chart, potential, prover)
        better = best is None or found.travel > best.travel * (1 + Fraction(3, 10**4))
        if best is None or found.travel > best.travel:
            best = found
        if found.supremum.seen <= 1 + fit.excess or not better or float(found.travel) >= enough:
            break
        program.constrain_about(found.supremum.worst, unknowns)
    assert best is not None
    return best


def _exact(coefficients: Array, degree: int) -> Polynomial:
    pairs = zip(exponents(degree)[1:], coefficients, strict=True)
    return RING.polynomial({e: Fraction(float(c)) for e, c in pairs if c != 0.0})


def _largest_rate(
    body: RigidBody, chart: Chart, potential: Polynomial, momenta: MomentumSet, prover: BranchAndBound
) -> Supremum:
    rate = momentum_rate_polynomials(potential, body.exact_inverse, chart.outer)
    return prover.supremum(rate, chart.region, momenta, degree=max(potential.degree + 1, 4))


def potential_program(
    body: RigidBody, start: Quaternion, target: Target, momenta: MomentumSet, *, guess: float, fit: Fit
) -> PotentialProgram:
    """Set up the program of a potential on the region of paths of travel `guess`."""
    arc = min(guess * float(momenta.fastest_rate()) / 2 + float(target.arc_above()) + 1e-4, MAX_ARC)
    chart = chart_between(start, arc)
    scale = float(chart.outer)
    x_start, x_target = chart.coordinates(start)[0], target_coordinates(chart)
    ends = (np.array([float(c) for c in x_start]) / scale, np.array([float(c) for c in x_target]) / scale)
    return PotentialProgram(fit, chart, ends, momenta, body.inverse_inertia)


def proved_separation(
    body: RigidBody,
    start: Quaternion,
    target: Target,
    momenta: MomentumSet,
    chart: Chart,
    potential: Polynomial,
    prover: BranchAndBound,
) -> Separation:
    """Prove the separation that a given potential gives on the region of a given chart."""
    supremum = _largest_rate(body, chart, potential, momenta, prover)
    difference = difference_below(chart, potential, start, target)
    reach = reach_below(chart, start, target, momenta.fastest_rate())
    by_potential = difference / Fraction(supremum.value) if supremum.value > 0 else Fraction(0)
    travel = max(min(reach, by_potential), Fraction(0))
    return Separation(travel, chart, potential, supremum, difference, reach)


def difference_below(chart: Chart, potential: Polynomial, start: Quaternion, target: Target) -> Fraction:
    """Lower bound of phi(start) - max phi over the targets, in exact arithmetic."""
    x, error = chart.coordinates(start)
    high = _largest_near(chart, potential, target_coordinates(chart), _target_radius(chart, target))
    return -_largest_near(chart, -potential, x, error * 2) - high


def reach_below(chart: Chart, start: Quaternion, target: Target, speed: Fraction) -> Fraction:
    """Travel that any path must make that leaves the region, rounded down."""
    x, error = chart.coordinates(start)
    slack = _arc_between(x, chart, 1) + 4 * error + _arc_between(target_coordinates(chart), chart, -1)
    return 2 * (chart.arc_sum - slack - target.arc_above()) / speed


def quick_separation(start: Quaternion, target: Target, speed: Fraction) -> Fraction:
    """Travel from the rotation angle alone: twice the quaternion arc over the fastest rate, rounded down."""
    arc = grid_below(arc_below(start[1:], start[0]), 80)
    return max(2 * (arc - target.arc_above()) / speed, Fraction(0))


def target_coordinates(chart: Chart) -> Vector:
    """Coordinates of the target quaternion +1: exactly minus the middle."""
    return -chart.middle[0], -chart.middle[1], -chart.middle[2]


def _target_radius(chart: Chart, target: Target) -> Fraction:
    """Upper bound of |x - x_target| over the targets: chord times sqrt((1 + |x|^2)(1 + |y|^2)) / 2."""
    chord = target.chord_above()
    if not chord:
        return chord
    size = length(target_coordinates(chart))[1]
    if size + chord > 1:
        raise ValueError("the terminal tolerance is too large for this chart")
    radius = chord
    for _ in range(3):
        product = (1 + size**2) * (1 + (size + radius) ** 2)
        radius = min(radius, chord * square_root(product)[1] / 2)
    return grid_above(radius, 60)


def _largest_near(chart: Chart, p: Polynomial, x: Sequence[Fraction], radius: Fraction) -> Fraction:
    """Upper bound of a polynomial of the scaled coordinates within a distance of x (unscaled)."""
    local = p.moved([c / chart.outer for c in x])
    size = radius / chart.outer
    value = local.coefficient(RING.one)
    if not size:
        return value
    value += length(local.coefficient(e) for e in AXES)[1] * size
    return value + sum((abs(c) * size ** sum(e) for e, c in local.terms.items() if sum(e) > 1), Fraction(0))


def _arc_between(x: Vector, chart: Chart, side: int) -> Fraction:
    """Upper bound of the quaternion arc between x and a model end point: twice the distance."""
    gap = tuple(c - side * chart.inner * n for c, n in zip(x, chart.direction, strict=True))
    return 2 * length(gap)[1]

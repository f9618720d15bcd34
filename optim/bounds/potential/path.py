"""The least travel from a start attitude to the target, by either quaternion sign.

Regions are chosen as small as the answer allows: a path that improves on the answer cannot leave
the spherical ellipse of its length, and the smaller the region the better a polynomial does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

import numpy as np

from ....models.rigid_body import RigidBody
from ..sets.chart import Quaternion, arc_to_identity
from ..sets.momentum_sets import MomentumSet, UnitBall, has_equal_inertias
from .fit import Fit, PotentialProgram
from .prove import BranchAndBound
from .separation import (
    MAX_ARC,
    Separation,
    Target,
    potential_program,
    quick_separation,
    separation,
)

_ROUGH = 4e-3
"""Excess of the rate where a potential only tells how large a region is needed."""


@final
@dataclass(frozen=True)
class PathOptions:
    """Effort of a path bound.

    Attributes
    ----------
    degree : int or None
        Degree of the potentials; None chooses 5 to 7 by the size of the region.
    tolerance : float
        What branch and bound may lose.
    trial, share : float
        Bound by components: the trial peak over the bound known, and where between 1 and B the
        box is put. Any values are valid.
    components : bool
        Whether to compute that bound: it needs a potential for each window profile.
    """

    degree: int | None = None
    tolerance: float = 8e-4
    trial: float = 1.12
    share: float = 0.6
    components: bool = True

    def __post_init__(self) -> None:
        if self.degree is not None and not 1 <= self.degree <= 9:
            raise ValueError(f"the degree of a potential must be 1 to 9, received {self.degree}")
        if self.trial <= 0 or not 0 <= self.share <= 1:
            raise ValueError(f"expected trial > 0, 0 <= share <= 1: received {self.trial}, {self.share}")
        if not 0 < self.tolerance < 1:
            raise ValueError(f"tolerance must be in (0, 1), received {self.tolerance}")

    def coarse(self) -> PathOptions:
        """Return options that cost little."""
        return replace(self, degree=min(self.degree or 4, 4), tolerance=max(self.tolerance, 2e-3))

    def degree_for(self, arc_sum: float, *, costly: bool) -> int:
        """Degree that pays for a region of that arc sum (rad), where fits are costly and where not."""
        if self.degree is not None:
            return self.degree
        first, second = (2.2, 2.7) if costly else (1.6, 2.5)
        return 5 if arc_sum < first else 6 if arc_sum < second else 7


@final
@dataclass(frozen=True)
class PathBound:
    """Proved least travel to the target.

    Attributes
    ----------
    travel : Fraction
        Every motion to the target, whichever sign, travels at least this.
    separations : tuple of (sign, Separation or None)
        The proof for each sign considered; None where the rotation angle alone suffices.
    """

    travel: Fraction
    separations: tuple[tuple[int, Separation | None], ...]


def path_bound(
    body: RigidBody,
    start: Quaternion,
    target: Target,
    momenta: MomentumSet,
    *,
    signs: tuple[int, ...] = (1, -1),
    options: PathOptions | None = None,
) -> PathBound:
    """Least travel in a momentum set from an attitude to rest's attitude, proved."""
    options = options or PathOptions()
    speed = momenta.fastest_rate()
    starts = {sign: _signed(start, sign) for sign in signs}
    order = sorted(signs, key=lambda sign: -float(starts[sign][0]))
    found: dict[int, Separation | None] = {}
    least: Fraction | None = None
    for sign in order:
        cheap = quick_separation(starts[sign], target, speed)
        if least is not None and cheap >= least:
            found[sign] = None
            continue
        limit = None if least is None else float(least) * 1.002
        result = _nearest(body, starts[sign], target, momenta, options, limit)
        travel = cheap
        if result is not None and result.travel > cheap:
            travel, found[sign] = result.travel, result
        else:
            found[sign] = None
        least = travel if least is None else min(least, travel)
    assert least is not None
    return PathBound(least, tuple((sign, found[sign]) for sign in order))


def _signed(q: Quaternion, sign: int) -> Quaternion:
    return q if sign > 0 else (-q[0], -q[1], -q[2], -q[3])


def _nearest(
    body: RigidBody,
    start: Quaternion,
    target: Target,
    momenta: MomentumSet,
    options: PathOptions,
    limit: float | None,
) -> Separation | None:
    """Proved separation on a region no larger than needed (or than `limit` asks)."""
    speed = float(momenta.fastest_rate())
    unit = np.array([float(c) for c in start])
    unit /= np.linalg.norm(unit)
    arc = arc_to_identity(unit)
    if arc < 1e-9 or arc <= float(target.arc_above()):
        return None
    guess = momenta.straight_travel(unit[1:], 2 * arc)
    if 2 * arc / speed >= 0.9995 * guess:
        return None  # the rotation about a fixed axis is shortest, and the angle alone says so
    if limit is not None:
        guess = min(guess, limit)
    widest = (MAX_ARC - 1e-3) * 2 / speed
    least = 2 * arc / speed * (1 + 1e-3)
    highest = max(min(guess, widest), least)
    guess = highest
    program: PotentialProgram | None = None

    smooth = isinstance(momenta, UnitBall)
    costly = not smooth and not has_equal_inertias(body)

    def degree_for(travel: float) -> int:
        return options.degree_for(travel * speed / 2, costly=costly)

    def made(degree: int) -> PotentialProgram:
        # Sets with edges gain least from a third proof, and theirs cost most.
        fit = Fit(degree=degree, proofs=3 if smooth else 2)
        return potential_program(body, start, target, momenta, guess=guess, fit=fit)

    if limit is None:
        value = 0.0
        for degree in (4, None):
            program = made(degree or degree_for(guess))
            value = max(value, program.solve(_ROUGH)[1])  # a higher degree may end its rounds early
            if degree is None and 0.96 * guess < value < 0.998 * guess:
                break
            guess = min(max(1.015 * value, least), highest)
            program = None
    best: Separation | None = None
    prover = BranchAndBound(tolerance=options.tolerance)
    degree = degree_for(guess)
    for attempt in range(2):
        program = program or made(degree if limit is None or attempt else min(degree, 5))
        found = separation(body, start, target, program, prover, enough=np.inf if limit is None else limit)
        program = None
        if best is None or found.travel > best.travel:
            best = found
        if limit is not None:
            if float(found.travel) >= limit / 1.002 or degree <= 5:
                break
            continue
        if found.travel < found.reach or guess >= highest:
            break
        degree = degree_for(guess)
        guess = min(1.015 * float(found.difference) / found.supremum.value, highest)
    return best

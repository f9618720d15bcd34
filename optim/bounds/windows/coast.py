"""Coasts: where the body would be without torque, enclosed, at the instants a bound may start from."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import floor, log2
from typing import Any, final

import numpy as np

from ....models.laws import FreeMotion
from ....models.schedule.polynomial import ZERO
from ....models.simulation import Phase
from ....verify.exact.ball import ball, exact_above, length
from ....verify.exact.rounding import grid_above, grid_near
from ....verify.flow.run_enclosure import EnclosedRun, ExactStart, NoEnclosureError
from ...problem import TransferProblem
from ..sets.chart import Quaternion

_MARGIN = Fraction(1, 2**36)
"""Turn allowed besides, rad, for the rounding of whoever checks."""
_INSTANTS = 16
"""At least so many in a transfer, unless the enclosure ends before."""


@final
@dataclass(frozen=True)
class Coast:
    """Free motion from the start of a transfer.

    Attributes
    ----------
    until : Fraction
        How long, s.
    attitude : four Fraction
        Quaternion close to the one reached, of any length.
    turn : Fraction
        Upper bound of the rotation angle between the two, rad.
    """

    until: Fraction
    attitude: Quaternion
    turn: Fraction = Fraction(0)


def coasts(problem: TransferProblem) -> tuple[Coast, ...]:
    """Coasts of a transfer, the one of no length first; the only one if the body starts at rest.

    Instants are multiples of a power of two, so that transfers which differ in the windows share them.
    """
    found = [Coast(Fraction(0), problem.attitude)]
    if problem.starts_at_rest:
        return tuple(found)
    step = Fraction(2) ** floor(log2(problem.horizon / _INSTANTS))
    instants = [step * k for k in range(floor(problem.horizon / step) + 1)]
    run = EnclosedRun(FreeMotion(), problem.body, ExactStart(near_unit(problem.attitude), problem.rate))
    for start, end in pairwise(instants):
        try:
            run.cross(Phase(start, end, start, (ZERO,)))
        except NoEnclosureError:
            break
        found.append(rounded_coast(end, run.state[:4]))
    return tuple(found)


def near_unit(q: Quaternion) -> Quaternion:
    """Same attitude, of length near 1."""
    length = Fraction(float(np.linalg.norm([float(c) for c in q])))
    return q[0] / length, q[1] / length, q[2] / length, q[3] / length


def rounded_coast(until: Fraction, balls: list[Any]) -> Coast:
    """Round an enclosed quaternion, near unit length.

    Within a distance r of a quaternion of length l directions differ by an arc of at most
    asin(r/l) <= (pi/2) r/l, rotations by twice that.
    """
    middle, r = [], Fraction(0)
    for x in balls:
        rounded = grid_near(exact_above(x), 64)
        middle.append(rounded)
        r += exact_above(abs(x - ball(rounded)))
    turn = grid_above(4 * r / (length(middle)[0] - r) + _MARGIN, 64)
    return Coast(until, (middle[0], middle[1], middle[2], middle[3]), turn)

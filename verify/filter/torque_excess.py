"""A torque limit refuted: a start of the set whose run certainly exceeds the limit at some instant."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ...models.lowering import UnknownOperationError
from ...models.norms import Norm
from ..exact.ball import ball, float_above, float_below
from ..exact.direction import rational_quaternion
from ..flow.run_enclosure import EnclosedRun, ExactStart, NoEnclosureError
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness
from .claims import limit_words
from .question import FloorQuestion, initial_gain_term

INWARD = (0.0, 1e-9, 1e-6)
"""By how much the start's error angle is shortened, relatively, until it is certainly inside the set."""


def refuted_limit(
    claim: Claim, question: FloorQuestion, *, quaternion: Sequence[float], rate: Sequence[Fraction], at: float
) -> Claim:
    """The claim REFUTED, if the run from a rational start near the given one certainly exceeds the limit.

    Parameters
    ----------
    claim : Claim
        "torque.limit", undecided.
    question : FloorQuestion
        What was asked: law, body, schedule, set, limit.
    quaternion : Sequence[float]
        (4,), scalar first; a rational one beside it is used, inside the set.
    rate : Sequence[Fraction]
        (3,), rad/s.
    at : float
        Time at which a simulation found the limit exceeded, s, > 0.

    Returns
    -------
    Claim
        As it came where it is not the torque itself that is limited, where the start is not certainly in
        the set, where the run could not be enclosed, or where its enclosure does not exclude the limit.
    """
    q, mission, limit = question, question.mission, question.mission.limit
    start = start_inside(q, quaternion, rate)
    if start is None or limit is None:
        return claim
    instant = Fraction(at).limit_denominator(10**6)
    try:
        torque = EnclosedRun(q.law, mission.body, start).torque_at(mission.schedule, instant)
    except (NoEnclosureError, UnknownOperationError):
        return claim
    if not limit.norm.limits_torque:
        return claim
    excess = _size_below(torque, limit.norm) - ball(limit.torque)
    if not excess > 0:
        return claim
    values: dict[str, float | list[float]] = {
        "quaternion": [float(x) for x in start.quaternion],
        "rate": [float(x) for x in start.rate],
        "time": float(instant),
        "torque": [float(x.mid()) for x in torque],
    }
    excess_found = Quantity(
        "excess", float_below(excess), float_above(excess), "N m", "torque beyond its limit", rigorous=True
    )
    how = "the run from this start, enclosed by interval Taylor steps in ball arithmetic"
    return replace(
        claim,
        statement=f"{limit_words(limit)} from every start with {q.initial.description}",
        verdict=Verdict.REFUTED,
        witness=Witness("from this start of the set, at this time", values, excess_found),
        evidence=(*claim.evidence, Evidence(EvidenceKind.WITNESS, how, source=claim.source)),
        reason="",
        next_step="",
    )


def start_inside(
    question: FloorQuestion, quaternion: Sequence[float], rate: Sequence[Fraction]
) -> ExactStart | None:
    """Rational start near the given one that is certainly in the question's set, or None."""
    length = math.hypot(*quaternion[1:])
    half = math.atan2(length, quaternion[0])
    for inward in INWARD:
        shorter = half * (1 - inward)
        scale = math.sin(shorter) / length if length else 0.0
        near = rational_quaternion([math.cos(shorter), *(scale * x for x in quaternion[1:])])
        start = ExactStart(near, tuple(rate))
        if _is_inside(question, start):
            return start
    return None


def _is_inside(question: FloorQuestion, start: ExactStart) -> bool:
    """Whether the start satisfies every bound of the set, decided in exact or ball arithmetic."""
    q, w = question.mission.starts, start.rate
    least_b0 = (ball(q.max_angle_deg) / 360).cos_pi()
    if q.max_angle_deg < 360 and not ball(start.quaternion[0]) >= least_b0:
        return False
    square = sum((x * x for x in w), Fraction(0))
    if q.max_weighted_rate is None:
        return square <= (q.max_rate or Fraction(0)) ** 2
    if q.max_rate is not None and square > q.max_rate**2:
        return False
    mission = question.mission
    gain, J = 2 * initial_gain_term(question.law, mission.schedule), mission.body.exact_inertia
    Omega = [x + gain * b for x, b in zip(w, start.quaternion[1:], strict=True)]
    weighted = sum((Omega[i] * J[i][j] * Omega[j] for i in range(3) for j in range(3)), Fraction(0))
    return weighted <= q.max_weighted_rate**2


def _size_below(torque: Sequence[Any], norm: Norm) -> Any:
    """Enclosure of a size that the torque's peak is not below: that of one block, or of one component."""
    sizes: list[Any] = []
    for block, at in norm.parts:
        if block.is_round:
            sizes.append(sum((x * x for x in torque[at]), ball(0)).sqrt())
        else:
            sizes += [abs(x) for x in torque[at]]
    return max(sizes, key=lambda x: float(x.lower()))

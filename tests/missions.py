"""Missions and questions about floors, built from loose names so that a test shows what it varies."""

from __future__ import annotations

from dataclasses import fields, replace
from fractions import Fraction as F
from typing import Any

from intermit.models.mission import InitialSet, InitialState, Mission, TorqueLimit
from intermit.models.norms import LARGEST_COMPONENT
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Schedule
from intermit.verify.filter.question import FloorQuestion
from intermit.verify.robust.answer import RobustQuestion

OWN = {f.name for f in fields(FloorQuestion)}
LOOSE = {
    "max_angle_deg", "max_rate", "max_weighted_rate", "attitude", "rate", "torque_limit", "torque_norm",
    "inertia_tolerance", "body", "schedule",
}  # fmt: skip


def mission_from(body: RigidBody, schedule: Schedule, quaternion, rate=(F(0),) * 3, **more: Any) -> Mission:
    """A mission from one state; the set of starts is what lies around it."""
    start = InitialState(tuple(float(x) for x in quaternion), tuple(F(x) for x in rate))
    return Mission(
        body=body, schedule=schedule, start=start, starts=InitialSet.around(start),
        horizon=more.pop("horizon", F(56)), **more,
    )  # fmt: skip


def question(law, body: RigidBody, schedule: Schedule, max_angle_deg: F, **more: Any) -> FloorQuestion:
    """What is asked of one law over a set of starts; names of `LOOSE` and of `FloorQuestion` may follow."""
    starts = InitialSet(max_angle_deg)
    base = Mission(
        body=body, schedule=schedule, start=starts.representative, starts=starts, horizon=F(56)
    )  # fmt: skip
    return other(FloorQuestion(law=law, mission=base), **more)


def other(question: FloorQuestion, **changes: Any) -> FloorQuestion:
    """The question with some of what it speaks of changed."""
    unknown = set(changes) - OWN - LOOSE
    assert not unknown, unknown
    m = question.mission
    of_set = {k: changes[k] for k in ("max_angle_deg", "max_rate", "max_weighted_rate") if k in changes}
    settled = {k: changes[k] for k in ("attitude", "rate") if k in changes}
    new: dict[str, Any] = {k: changes[k] for k in ("body", "schedule", "inertia_tolerance") if k in changes}
    new |= {"starts": replace(m.starts, **of_set)} if of_set else {}
    new |= {"tolerance": replace(m.tolerance, **settled)} if settled else {}
    if "torque_limit" in changes or "torque_norm" in changes:
        old = m.limit or TorqueLimit(F(1))
        new["limit"] = TorqueLimit(
            changes.get("torque_limit", old.torque), changes.get("torque_norm", old.norm or LARGEST_COMPONENT)
        )
    own = {k: v for k, v in changes.items() if k in OWN}
    return replace(question, **{"mission": replace(m, **new), **own})


def robust(law, body, schedule, uncertainty, max_angle_deg: F, **more: Any) -> RobustQuestion:
    """What is asked of one law on every body of an uncertainty; the names are those of `question`."""
    own = {k: more.pop(k) for k in ("horizon", "options") if k in more}
    mission = question(law, body, schedule, max_angle_deg, **more).mission
    return RobustQuestion(law=law, mission=replace(mission, uncertainty=uncertainty), **own)

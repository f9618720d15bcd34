"""Where a run starts: one state, or a set of states; always as an error from the target attitude."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from ..models.apart import apart
from ..models.attitude import conjugate, quaternion_product
from ..models.mission import ANGLE_ALLOWANCE, InitialSet, InitialState
from ..models.rigid_body import RigidBody
from .document import Document
from .errors import ScenarioError
from .schema import AttitudeTable, InitialTable, ScenarioFile

UNIT_TOLERANCE = Fraction(1, 10**6)
"""How far a quaternion's squared norm may be from 1; within it, it is normalised."""


def build(
    file: ScenarioFile, document: Document, body: RigidBody, *, starts_in_window: bool
) -> tuple[InitialState, InitialSet]:
    """Return the initial state and set; each is derived from the other where only one is given.

    Raises
    ------
    ScenarioError
        If neither is given, a quaternion is not unit, an axis is zero or lacks its angle, or the
        state lies outside the set.
    """
    target = attitude(file.target, document, "target")
    given = _given(file)
    if given is None and file.initial_set is None:
        raise ScenarioError(document.where("initial"), "required (or [initial_set]), but missing")
    if given is not None:
        state = _state(given, target, document)
    else:
        assert file.initial_set is not None
        state = InitialSet(file.initial_set.max_angle_deg).representative
    if file.initial_set is not None:
        table = file.initial_set
        bounds = InitialSet(table.max_angle_deg, table.max_rate, table.max_weighted_rate)
        if given is not None:
            _check_inside(state, bounds, document, body, starts_in_window=starts_in_window)
    else:
        bounds = InitialSet.around(state)
    return state, bounds


FAST = 1
"""rad/s, 57 deg/s: a start rate above it deserves a look at its unit."""
NEARLY_ONE = Fraction(966, 1000)
"""cos(15 deg): a last entry above it, read as a scalar, would be a turn below 30 deg."""


def doubtful_readings(file: ScenarioFile, document: Document) -> tuple[str, ...]:
    """Warnings that spell out how a start was read, where it looks like another unit or order."""
    found = []
    for key, table in (("target", file.target), ("initial", file.initial)):
        q = None if table is None else table.quaternion
        if q is None or abs(q[3]) < NEARLY_ONE:
            continue
        angle, other = (math.degrees(2 * math.acos(min(1.0, abs(float(x))))) for x in (q[0], q[3]))
        found.append(
            f"{document.where(f'{key}.quaternion')}: read scalar first, a turn of {angle:.6g} deg; if the "
            f"scalar stands last, move it to the front: a turn of {other:.6g} deg"
        )
    rates = {"initial.rate": math.hypot(*(float(x) for x in file.initial.rate)) if file.initial else 0.0}
    if file.initial_set is not None and file.initial_set.max_rate is not None:
        rates["initial_set.max_rate"] = float(file.initial_set.max_rate)
    for key, rate in rates.items():
        if rate > FAST:
            found.append(
                f"{document.where(key)}: read as rad/s, and {rate:.6g} rad/s are {math.degrees(rate):.6g} "
                f"deg/s; if deg/s are meant, {rate:.6g} deg/s are {math.radians(rate):.6g} rad/s"
            )
    return tuple(found)


def _given(file: ScenarioFile) -> InitialTable | None:
    """Return the table of the state; None where it says no more than when the run starts, beside a set."""
    table = file.initial
    if table is not None and file.initial_set is not None and table.model_fields_set <= {"time"}:
        return None
    return table


def attitude(table: AttitudeTable, document: Document, key: str) -> tuple[float, ...]:
    """Return the unit quaternion, scalar first, of a table that gives it or an axis and an angle."""
    if table.quaternion is not None and table.axis is None and table.angle_deg is None:
        square = sum((x * x for x in table.quaternion), Fraction(0))
        if abs(square - 1) > UNIT_TOLERANCE:
            norm = math.sqrt(square)
            raise ScenarioError(
                document.where(f"{key}.quaternion"),
                f"must be a unit quaternion, scalar first, received norm {apart(norm, 1, digits=7)[0]}",
            )
        norm = math.sqrt(square)
        return tuple(float(x) / norm for x in table.quaternion)
    if table.quaternion is None and table.axis is not None and table.angle_deg is not None:
        square = sum((x * x for x in table.axis), Fraction(0))
        if square == 0:
            raise ScenarioError(document.where(f"{key}.axis"), "must not be zero")
        if abs(table.angle_deg) >= 360:
            raise ScenarioError(
                document.where(f"{key}.angle_deg"),
                f"must lie between -360 and 360, received {float(table.angle_deg):g}",
            )
        half = math.radians(float(table.angle_deg)) / 2
        factor = math.sin(half) / math.sqrt(square)
        return (math.cos(half), *(factor * float(x) for x in table.axis))
    raise ScenarioError(document.where(key), "expected either quaternion, or axis with angle_deg")


def _state(table: InitialTable, target: tuple[float, ...], document: Document) -> InitialState:
    q = attitude(table, document, "initial")
    error = q if target[0] == 1.0 else _relative(target, q)
    return InitialState((error[0], error[1], error[2], error[3]), table.rate)


def _relative(target: tuple[float, ...], q: tuple[float, ...]) -> tuple[float, ...]:
    """conj(target) q: the attitude as seen from the target."""
    product = np.array(quaternion_product(conjugate(target), q))
    return tuple(float(x) for x in product / np.linalg.norm(product))


def _check_inside(
    state: InitialState, bounds: InitialSet, document: Document, body: RigidBody, *, starts_in_window: bool
) -> None:
    """Refuse a state outside its set; within a window the weighted rate depends on the law: not checked."""
    allowance = float(ANGLE_ALLOWANCE)
    if state.angle_deg > float(bounds.max_angle_deg) + allowance:
        own, most = apart(state.angle_deg, bounds.max_angle_deg)
        raise ScenarioError(
            document.where("initial_set.max_angle_deg"),
            f"the initial state's error angle, {own} deg, lies outside {most} deg",
        )
    rate = state.exact_rate
    square = sum((x * x for x in rate), Fraction(0))
    if bounds.max_rate is None and bounds.max_weighted_rate is None and square > 0:
        raise ScenarioError(
            document.where("initial_set.max_rate"),
            "required (or max_weighted_rate) since the initial state turns, but missing",
        )
    if bounds.max_rate is not None and square > bounds.max_rate**2:
        own, most = apart(math.sqrt(square), bounds.max_rate)
        raise ScenarioError(
            document.where("initial_set.max_rate"),
            f"the initial state's rate, {own} rad/s, lies outside {most} rad/s",
        )
    if bounds.max_weighted_rate is None or starts_in_window:
        return
    J = body.exact_inertia
    weighted = sum((rate[i] * J[i][j] * rate[j] for i in range(3) for j in range(3)), Fraction(0))
    if weighted > bounds.max_weighted_rate**2:
        own, most = apart(math.sqrt(weighted), bounds.max_weighted_rate)
        raise ScenarioError(
            document.where("initial_set.max_weighted_rate"),
            f"the initial state's sqrt(w' J w), {own} sqrt(kg m^2)/s, lies outside {most}",
        )

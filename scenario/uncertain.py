"""[uncertainty]: what the controller does not know, as exact sets."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ..models.rigid_body import RigidBody
from ..models.uncertainty import Uncertainty
from .document import Document
from .errors import ScenarioError
from .schema import ScenarioFile
from .spacecraft import known_to

WIDE = 10
"""Times below which an interval must stay: a factor of 11 on an inertia or a thrust is a slip of the key."""


def build(file: ScenarioFile, document: Document, body: RigidBody) -> Uncertainty:
    """Return the uncertainty; nominal where the table is missing.

    Raises
    ------
    ScenarioError
        If a set is empty or senseless, or the inertia's tolerance is given for two meanings at once.
    """
    table = file.uncertainty
    where = document.where("uncertainty")
    if table.inertia_tolerance is not None and file.spacecraft.inertia_tolerance is not None:
        raise ScenarioError(
            f"{where}.inertia_tolerance",
            "spacecraft.inertia_tolerance is given too: there it speaks of a controller that knows the true "
            "inertia, here of one that computes with the inertia as stated; give one of them",
        )
    try:
        return Uncertainty(
            inertia_tolerance=known_to(table.inertia_tolerance, body, f"{where}.inertia_tolerance"),
            inertia_relative=table.inertia_relative,
            inertia_scale=_interval(table.inertia_scale, f"{where}.inertia_scale"),
            thrust_error=_interval(table.thrust_error, f"{where}.thrust_error"),
            thrust_error_varies=table.thrust_error_varies,
            misalignment_deg=table.misalignment_deg,
            disturbance=table.disturbance,
        )
    except ValueError as error:
        raise ScenarioError(where, str(error)) from None


def _interval(value: Any, where: str) -> tuple[Fraction, Fraction]:
    """[low, high], or one number for both sides."""
    if isinstance(value, Fraction):
        if value < 0:
            raise ScenarioError(
                where, f"a number stands for both sides and must be >= 0, received {float(value):g}"
            )
        value = [-value, value]
    if len(value) != 2 or not all(isinstance(x, Fraction) for x in value):
        raise ScenarioError(where, "expected a number or [low, high]")
    low, high = value
    if high > WIDE:
        raise ScenarioError(where, f"a relative error must be <= {WIDE}, received {float(high):g}")
    return low, high

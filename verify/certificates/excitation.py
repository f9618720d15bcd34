"""Persistent excitation as a certificate: the extremes of the moving integral, for the checker to confirm."""

from __future__ import annotations

from fractions import Fraction

from ...models.schedule import Schedule
from .. import checker
from ..schedule.excitation import excitation
from .format import Certificate, certificate_text
from .schedule import schedule_data

MAX_PIECES = 400
"""Longer tables get no certificate: the checker looks at every interval between knots."""


def excitation_certificate(schedule: Schedule, length: Fraction) -> Certificate | None:
    """Certificate that g is C1 and mu1 <= integral of g^2 over any T <= mu2; None if there is none.

    Parameters
    ----------
    schedule : Schedule
        The schedule whose g it is about.
    length : Fraction
        T, s.
    """
    if len(schedule.profile.shapes) > MAX_PIECES:
        return None
    found = excitation(schedule, length)
    if found.least.low <= 0:
        return None
    claim = {"length": length, "least": found.least.low, "greatest": found.greatest.high}
    certificate = Certificate("schedule-excitation", {"schedule": schedule_data(schedule)}, claim)
    findings = checker.check_text(certificate_text([certificate]))
    return certificate if all(finding.valid for finding in findings) else None

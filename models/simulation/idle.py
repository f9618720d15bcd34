"""Idle leads: from rest, nothing happens before the first window of a law without states of its own."""

from __future__ import annotations

from fractions import Fraction

from numpy.typing import ArrayLike

from ..laws import Law
from ..schedule import Schedule


def idle_lead(law: Law, schedule: Schedule, rate: ArrayLike) -> Fraction:
    """Return the time, s, that a run may leave out at its start, exactly; 0 if that is short or uncertain.

    A body at rest stays at rest while g = 0. Left out is only what is longer than the rest of a finite table,
    and only for laws without controller states, signals of time or resets: these may change meanwhile.

    Parameters
    ----------
    law : Law
        The law that is run.
    schedule : Schedule
        Its windows.
    rate : ArrayLike
        (3,), rad/s: the rate at the start of the run.
    """
    import numpy as np

    hooks = type(law).reset_instants is Law.reset_instants
    if (
        schedule.period is not None
        or np.any(np.asarray(rate))
        or law.controller_states
        or law.signals
        or not hooks
    ):
        return Fraction(0)
    profile = schedule.profile
    acting = [knot for shape, knot in zip(profile.shapes, profile.knots, strict=False) if any(shape)]
    first = min([schedule.windows[0].on, *acting[:1]])
    return first if first > schedule.end - first else Fraction(0)

"""Idle leads: from rest, nothing but a law's own states changes before the first window."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike

from ..closed_loop import close_loop
from ..laws import Law
from ..schedule import Schedule
from ..types import Array
from .coasting import coasting_decay
from .integrate import LEAST_FILTER_STATE, divides_by_filter


def idle_lead(law: Law, schedule: Schedule, rate: ArrayLike) -> tuple[Fraction, Array | None]:
    """Return the time, s, that a run may leave out at its start, exactly, and the controller states then.

    A body at rest stays at rest while g = 0, and controller states that only decay are known. Left out is
    only what is longer than the rest of a finite table; nothing for a law with signals of time, resets or
    other controller states, nor where a gain divides by a filter state of which nothing is left.

    Parameters
    ----------
    law : Law
        The law that is run.
    schedule : Schedule
        Its windows.
    rate : ArrayLike
        (3,), rad/s: the rate at the start of the run.
    """
    nothing = Fraction(0), None
    lead = schedule.idle_lead
    if not lead or np.any(np.asarray(rate)) or law.signals:
        return nothing
    if type(law).reset_instants is not Law.reset_instants:
        return nothing
    loop = close_loop(law)
    decay = coasting_decay(loop)
    if decay is None:
        return nothing
    initial = np.array([float(state.initial) for state in law.controller_states])
    states = initial * np.exp(-decay * float(lead))
    if divides_by_filter(loop) and states[list(loop.controller_states).index("R")] < LEAST_FILTER_STATE:
        return nothing
    return lead, states

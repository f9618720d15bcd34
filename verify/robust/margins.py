"""How much more of each channel is still proved, the others as they are."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ...models.uncertainty import Uncertainty
from ..exact.margin_search import greatest_certified
from ..verdict import Quantity
from .answer import RobustQuestion

MOST = Fraction(16)
"""Times its size to which a channel is grown at most."""
UNITS = {"inertia_tolerance": "kg m^2", "misalignment_deg": "deg", "disturbance": "N m"}
LABELS = {
    "inertia_tolerance": "largest entry of the inertia's tolerance, in proportion, certified up to",
    "inertia_relative": "relative inertia error, certified up to",
    "inertia_scale": "upper end of the inertia's factor less 1, both ends in proportion, certified up to",
    "thrust_error": "larger end of the thrust's factor less 1, both ends in proportion, certified up to",
    "misalignment_deg": "misalignment, certified up to",
    "disturbance": "disturbance, certified up to",
}


def channel_margins(
    question: RobustQuestion, is_proved: Callable[[RobustQuestion], bool]
) -> Iterator[Quantity]:
    """Largest size of each channel for which the claims were proved with the others as stated.

    Parameters
    ----------
    question : RobustQuestion
        One whose claims are proved.
    is_proved : Callable[[RobustQuestion], bool]
        Tries another.
    """
    for name in question.mission.uncertainty.channels:

        def holds(extra: Fraction, name: str = name) -> bool:
            try:
                other = question.about(_grown(question.mission.uncertainty, name, 1 + extra))
            except ValueError:
                return False
            return is_proved(other)

        found = greatest_certified(holds, Fraction(1, 2), limit=MOST - 1, steps=3)
        size = _size(getattr(question.mission.uncertainty, name)) * (1 + found.certified)
        yield replace(found, certified=size).quantity(f"robust_{name}", UNITS.get(name, ""), LABELS[name])


def _grown(uncertainty: Uncertainty, name: str, factor: Fraction) -> Uncertainty:
    changes: dict[str, Any] = {name: _scaled(getattr(uncertainty, name), factor)}
    return replace(uncertainty, **changes)


def _scaled(value: Any, factor: Fraction) -> Any:
    return tuple(_scaled(x, factor) for x in value) if isinstance(value, tuple) else value * factor


def _size(value: Any) -> Fraction:
    """Largest magnitude in a channel."""
    if isinstance(value, tuple):
        return max((_size(x) for x in value), default=Fraction(0))
    return abs(Fraction(value))

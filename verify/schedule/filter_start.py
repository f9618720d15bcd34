"""The filter's initial state: positive, and not above what g can sustain."""

from __future__ import annotations

from fractions import Fraction

from ...models.schedule import Schedule
from ...models.schedule import polynomial as poly
from ..claim_table import CLAIM_KEYS, stated
from ..exact.bernstein import least_value
from ..exact.rational_quantity import rational_quantity
from ..verdict import Claim, Evidence, EvidenceKind, Verdict, Witness

SOURCE = CLAIM_KEYS["filter.start"].source
WIDTH = Fraction(1, 10**12)


def filter_start_claim(schedule: Schedule, *, decay: Fraction, initial: Fraction) -> Claim:
    """Decide 0 < R(0) <= 2 max g^2 / lambda, with which R <= 2 max g^2 / lambda for ever.

    Without the second half R <= max(R(0), 2 max g^2 / lambda) still holds; R(0) > 0 keeps R > 0.

    Parameters
    ----------
    schedule : Schedule
        The schedule whose g drives the filter.
    decay : Fraction
        lambda, 1/s, > 0.
    initial : Fraction
        R(0), s.

    Returns
    -------
    Claim
        "filter.start". UNDECIDED only if R(0) equals the bound to 12 digits.

    Raises
    ------
    ValueError
        If R(0) or lambda is not positive.
    """
    if initial <= 0 or decay <= 0:
        raise ValueError(f"expected R(0) > 0 and lambda > 0, received {float(initial)} and {float(decay)}")
    key = "filter.start"
    low, high = (2 * g**2 / decay for g in greatest_gain(schedule))
    statement = f"0 < R(0) = {float(initial):g} s <= 2 max g^2 / lambda = {float(low):.6g} s"
    evidence = Evidence(
        EvidenceKind.THEOREM,
        "R' <= -lambda R + 2 g^2; the greatest g by Bernstein coefficients",
        source=SOURCE,
    )
    ceiling = rational_quantity("filter_ceiling", max(low, initial), max(high, initial), "s", "R stays below")
    if initial <= low:
        room = rational_quantity("room", low - initial, high - initial, "s", "R(0) may grow by")
        return stated(key, statement, Verdict.PROVED, (evidence,), (ceiling,), (room,))
    if initial <= high:
        reason, step = "R(0) equals the bound to twelve digits", "change R(0) by one part in 1e11"
        return stated(
            key, statement, Verdict.UNDECIDED, (evidence,), (ceiling,), reason=reason, next_step=step
        )
    excess = rational_quantity("excess", initial - high, initial - low, "s", "R(0) lies above the bound by")
    witness = Witness("the initial filter state", {"R(0)": float(initial)}, excess)
    return stated(key, statement, Verdict.REFUTED, (evidence,), (ceiling,), witness=witness)


def greatest_gain(schedule: Schedule) -> tuple[Fraction, Fraction]:
    """Rationals around the greatest g over the schedule, 1e-12 apart at most; the lower one is attained."""
    low, high, _ = greatest_gain_at(schedule)
    return low, high


def greatest_gain_at(schedule: Schedule) -> tuple[Fraction, Fraction, Fraction]:
    """The same, and an instant at which the lower one is attained, s."""
    first: dict[poly.Coefficients, int] = {}
    for i, shape in enumerate(schedule.profile.shapes):
        if shape:
            first.setdefault(shape, i)
    if not first:
        return Fraction(0), Fraction(0), Fraction(0)
    least = least_value([poly.scale(shape, Fraction(-1)) for shape in first], WIDTH)
    i, knots = list(first.values())[least.index], schedule.profile.knots
    return -least.high, -least.low, knots[i] + least.argument * (knots[i + 1] - knots[i])

"""Where in the period the converged filter is least, and what the schedule does there."""

from __future__ import annotations

from fractions import Fraction

from ...models.schedule import Schedule
from ...verify.filter.converged import ConvergedFloor


def floor_note(schedule: Schedule, converged: ConvergedFloor | None) -> str:
    """One sentence on why R_min is what it is; empty for a finite table."""
    period = schedule.period
    if converged is None or period is None:
        return ""
    at = Fraction(converged.instant)
    pieces = list(schedule.pieces_between(Fraction(0), 2 * period))
    here = next(piece for piece in pieces if piece.start <= at + period <= piece.end)
    zero = [i for i, piece in enumerate(pieces) if not piece.shape and piece.start < at + period]
    if not zero:
        return ""
    first = last = zero[-1]
    while first > 0 and not pieces[first - 1].shape:
        first -= 1
    start, length = pieces[first].start, pieces[last].end - pieces[first].start
    fall = f"g fell over {float(pieces[first - 1].length):.3g} s, " if first > 0 else "g "
    text = (
        f"converged, R is least at t = {float(at):.4g} s of the period: {fall}was zero for "
        f"{float(length):.4g} s from {float(start % period):.6g} s on"
    )
    if here.shape:
        passed = float(at + period - here.start)
        text += f", and {passed:.3g} s of its rise over {float(here.length):.3g} s had passed"
    return text

"""A schedule from measured thrust: monotone cubic interpolation with exact coefficients.

Between two samples g is the cubic Hermite polynomial with the slopes of Fritsch and Butland
(SIAM J. Sci. Stat. Comput. 5, 1984; "PCHIP"): the weighted harmonic mean of the neighbouring
secants where these have one sign, 0 where they do not. So g is C1, monotone between samples,
never above the largest or below the least, and zero where two neighbouring samples are. At the
first and the last sample the slope is 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import nextafter
from typing import final

from ..apart import apart
from .piecewise import Piece
from .polynomial import Coefficients, polynomial
from .profiles import contiguous
from .schedule import Schedule, Window

ZERO = Fraction(0)


@final
@dataclass(frozen=True)
class ThrustSample:
    """Thrust at an instant: time, s, and g = thrust / full thrust, dimensionless, both exact."""

    time: Fraction
    gain: Fraction


def normalised(
    times: Sequence[Fraction],
    thrusts: Sequence[Fraction],
    *,
    zero_below: Fraction,
    full_thrust: Fraction | None = None,
) -> tuple[ThrustSample, ...]:
    """Samples of g = thrust / full_thrust, 0 where that is below `zero_below`.

    Parameters
    ----------
    times : Sequence[Fraction]
        Instants, shape (n,), s.
    thrusts : Sequence[Fraction]
        Thrust at them, shape (n,), all in one unit.
    zero_below : Fraction
        Threshold on g in [0, 1): noise below it, negative readings included, counts as no thrust.
    full_thrust : Fraction or None
        Thrust at which g = 1; by default the largest sample.

    Raises
    ------
    ValueError
        If no sample is positive or the threshold is not in [0, 1).
    """
    full = max(thrusts, default=ZERO) if full_thrust is None else full_thrust
    if full <= 0:
        raise ValueError("no sample shows any thrust")
    if not 0 <= zero_below < 1:
        raise ValueError(f"zero_below must lie in [0, 1), received {float(zero_below):g}")
    gains = (thrust / full for thrust in thrusts)
    cut = (gain if gain > 0 and gain >= zero_below else ZERO for gain in gains)
    return tuple(ThrustSample(time, gain) for time, gain in zip(times, cut, strict=True))


def measured_schedule(
    samples: Sequence[ThrustSample],
    *,
    period: Fraction | None = None,
    thruster_rise: Fraction = ZERO,
    thruster_fall: Fraction = ZERO,
) -> Schedule:
    """Schedule whose g interpolates the samples; its windows are the intervals on which g is not zero.

    Raises
    ------
    ValueError
        If there are fewer than three samples, times do not increase from 0 on, a gain is negative,
        all are zero, or the first or last is not zero (g must be C1 with nothing before and after).
    """
    _check(samples)
    slopes = pchip_slopes(samples)
    known: dict[Coefficients, Coefficients] = {}
    pieces: list[Piece] = []
    for a, b, slope, next_slope in zip(samples, samples[1:], slopes, slopes[1:], strict=False):
        shape = _hermite(a, b, slope, next_slope)
        pieces.append(Piece(a.time, b.time, known.setdefault(shape, shape)))
    windows: list[Window] = []
    for piece in pieces:
        if not piece.shape:
            continue
        if windows and windows[-1].off == piece.start:
            windows[-1] = Window(windows[-1].on, piece.end)
        else:
            windows.append(Window(piece.start, piece.end))
    return Schedule(
        windows=tuple(windows),
        profile=contiguous(pieces, period),
        period=period,
        thruster_rise=thruster_rise,
        thruster_fall=thruster_fall,
    )


def _check(samples: Sequence[ThrustSample]) -> None:
    if len(samples) < 3:
        raise ValueError(f"expected at least three thrust samples, received {len(samples)}")
    if samples[0].time < 0:
        raise ValueError(f"the first sample is at {float(samples[0].time):g} s: times start at 0 s")
    for a, b in pairwise(samples):
        if b.time <= a.time:
            later, earlier = apart(b.time, a.time)
            raise ValueError(f"a sample at {later} s follows one at {earlier} s")
    if any(sample.gain < 0 for sample in samples):
        raise ValueError("thrust must not be negative")
    if all(sample.gain == 0 for sample in samples):
        raise ValueError("no sample shows any thrust")
    for name, sample in (("first", samples[0]), ("last", samples[-1])):
        if sample.gain != 0:
            raise ValueError(
                f"the {name} sample ({float(sample.time):g} s) must be zero, received "
                f"g = {float(sample.gain):g}: g must be C1 with no thrust before and after the record"
            )


def pchip_slopes(samples: Sequence[ThrustSample]) -> list[Fraction]:
    """Slopes dg/dt at the samples, 1/s: Fritsch and Butland's inside, 0 at the ends.

    Each is a float taken as an exact rational, rounded towards 0, which keeps the interpolant monotone.
    """
    steps = [b.time - a.time for a, b in pairwise(samples)]
    rises = [b.gain - a.gain for a, b in pairwise(samples)]
    slopes = [ZERO]
    for h0, h1, r0, r1 in zip(steps, steps[1:], rises, rises[1:], strict=False):
        if r0 * r1 <= 0:
            slopes.append(ZERO)
            continue
        w0, w1 = 2 * h1 + h0, h1 + 2 * h0
        slopes.append(_towards_zero((w0 + w1) / (w0 * h0 / r0 + w1 * h1 / r1)))
    return [*slopes, ZERO]


def _towards_zero(value: Fraction) -> Fraction:
    nearest = float(value)
    return Fraction(nearest if abs(Fraction(nearest)) <= abs(value) else nextafter(nearest, 0.0))


def _hermite(a: ThrustSample, b: ThrustSample, slope: Fraction, next_slope: Fraction) -> Coefficients:
    """Cubic in s = (t - a.time)/(b.time - a.time) with the given values and slopes at both ends."""
    step, rise = b.time - a.time, b.gain - a.gain
    d0, d1 = step * slope, step * next_slope
    return polynomial(a.gain, d0, 3 * rise - 2 * d0 - d1, d0 + d1 - 2 * rise)

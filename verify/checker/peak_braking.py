"""The argument by path and momentum together: a coast that slows down."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from .exact_numbers import require, show
from .peak_coast import coast_attitude, require_growth, require_turn
from .peak_drift import UNIT, root_above, short_above
from .peak_gauge import Gauge
from .peak_numbers import PEAK_BRAKING_CELLS, exponential_above
from .peak_separation import require_travel
from .peak_transfer import Transfer
from .reading import Node


def require_braking(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """Compare the transfer with a motion of momentum s(t) H0, fixed in space, 0 <= s <= 1.

    That motion is the coast at the time theta = int s. N(H - H0) <= p up and N(H) <= end + p dn, so
    for any s, N being the size of a vector,
        N(H - s H0)^2 = s N(H - H0)^2 + (1 - s) N(H)^2 - s (1 - s) N(H0)^2 <= rho^2,
    and the distance e to it grows at most by rho + s mu e, mu as in `Departure`. Where rho^2 < 0 nothing
    has both momenta. So the travel from where the coast leads to the target is at most e at the end.
    """
    require(gauge.rows == [UNIT], "braking is for the ball of momenta")
    travel, end = witness["travel"].number(), witness["end"].number()
    gauge.require_rates_within(d.end_rate, end)
    shares, window = witness["shares"].vector(), d.window
    require(all(0 <= s <= 1 for s in shares), "shares of the momentum lie between 0 and 1")
    horizon, start = window.knots[-1], gauge.size(d.momentum)[0]
    marks = {horizon * k / PEAK_BRAKING_CELLS for k in range(PEAK_BRAKING_CELLS + 1)}
    edges = sorted(marks | set(window.knots))
    require(len(shares) == len(edges) - 1, "one share for each cell of the transfer")
    place = witness["coast"]
    turn, slack, mu = (place[name].number() for name in ("turn", "slack", "growth"))
    attitude = place["attitude"].vector(4)
    left = sum((s * (b - a) for s, (a, b) in zip(shares, pairwise(edges), strict=True)), Fraction(0))
    require(left > 0, "the coast must take some time")
    words = f"against a coast of {show(left)} s that slows down, "
    require_turn(*coast_attitude(d.J, d.attitude, d.momentum, left), attitude, turn)
    gauge.require_rates_within(turn, slack)
    require_growth(gauge, d.momentum, mu, Fraction(0))
    allowed = slack
    for s, (a, b) in zip(shares, pairwise(edges), strict=True):
        away, back = peak * window.up(b), end + peak * (window.first[-1] - window.up(a))
        square = s * away**2 + (1 - s) * back**2 - s * (1 - s) * start**2
        rho = root_above(short_above(max(square, Fraction(0))))
        allowed += rho * (b - a) * exponential_above(mu * left)
        left -= s * (b - a)
    require(allowed <= travel, "a transfer of that peak may travel enough")
    speed, d = gauge.speed(witness["speed"].vector()), replace(d, attitude=attitude)
    return words + require_travel(d, gauge, speed, travel, witness)

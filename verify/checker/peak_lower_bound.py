"""Kind peak-lower-bound: no torque of a smaller peak makes the transfer."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from .exact_numbers import require, show
from .kinds import kind
from .peak_braking import require_braking
from .peak_coast import Departure
from .peak_components import gyroscopic_form, require_components
from .peak_drift import length_above
from .peak_gauge import Gauge
from .peak_separation import require_travel
from .peak_transfer import Transfer
from .reading import Node


@kind("peak-lower-bound")
def check_peak_lower_bound(data: Node, certificate: Node) -> list[str]:
    """Prove that no torque of a smaller peak makes the transfer."""
    d, witness, peak = Transfer.read(data), certificate["witness"], certificate["claim"]["peak"].number()
    require(peak > 0 and d.window.first[-1] > 0, "the peak must be positive and the window must open")
    gauge = Gauge(d.J, d.torques, [row.vector(2) for row in witness["rows"].items()])
    arguments = {
        "momentum": require_momentum,
        "axis": require_axis,
        "path": require_path,
        "braking": require_braking,
        "components": require_components,
    }
    name = witness["argument"].text()
    require(name in arguments, "the argument is momentum, axis, path, braking or components")
    return [
        f"no torque with {d.words} and p < {show(peak)} {d.unit} takes the start to the target:",
        *d.describe(),
        arguments[name](d, gauge, peak, witness),
    ]


def require_momentum(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """N must fall from the start to the end by what windows and peak allow."""
    end = witness["end"].number()
    gauge.require_rates_within(d.end_rate, end)
    start = gauge.size(d.momentum)[0]
    require(start - end >= peak * d.window.first[-1], "a torque of that peak may absorb the momentum")
    return "the momentum cannot be absorbed by less"


def require_axis(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """A component of the momentum that free motion conserves must fall by what windows and peak allow."""
    axis = witness["axis"].number()
    require(
        axis in (0, 1, 2) and d.torques is not None, "expected an axis 0, 1 or 2, and torques with corners"
    )
    i = int(axis)
    still = not any(any(row) for row in gyroscopic_form(gauge.inverse, i))
    require(still, "free motion does not conserve that component of the momentum")
    most = max(abs(t[i]) for t in d.torques or [])
    end = d.end_rate * length_above(d.J[i])
    enough = abs(d.momentum[i]) - end >= peak * most * d.window.first[-1]
    require(enough, "a torque of that peak may absorb the momentum")
    return f"the momentum about axis {'xyz'[i]}, which free motion conserves, cannot be absorbed by less"


def require_path(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """Windows and peak allow less travel than the way takes."""
    travel, s, end = (witness[name].number() for name in ("travel", "instant", "end"))
    gauge.require_rates_within(d.end_rate, end)
    start, horizon = gauge.size(d.momentum)[1], d.window.knots[-1]
    after = Departure.read(d, gauge, witness["coast"]) if witness.has("coast") else Departure.none(d)
    require(after.until <= s <= horizon, "the instant must lie within the transfer, after the coast")
    area = d.window.area(s) - d.window.opened(after.until) + after.deviation
    allowed = start * (s - after.until) + end * (horizon - s) + after.slack + peak * area
    require(allowed <= travel, "a transfer of that peak may travel enough")
    d = replace(d, attitude=after.attitude)
    return after.words + require_travel(d, gauge, gauge.speed(witness["speed"].vector()), travel, witness)

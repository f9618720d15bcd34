"""A robust floor as a certificate: its flowpipes written out, for the stand-alone checker."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import inf, nextafter

from ...models.closed_loop import close_loop
from ...models.uncertainty import Uncertainty
from ..certificates.format import Certificate
from ..certificates.schedule import schedule_data
from ..filter.certificate import scaled_integers, set_data
from ..filter.flowpipe import Flowpipe
from ..flow.stepping import Step
from ..lyapunov.forms import law_form
from .answer import RobustFloor, RobustQuestion
from .bodies import BodyBin, shape_error
from .consequences import Consequences

KIND = "robust-floor"
HELD = "held"
"""A word of a step's forms that only says how it was proposed."""


def robust_certificate(floor: RobustFloor, found: Consequences) -> Certificate:
    """Certificate of R >= floor, and of what follows for angle and rate."""
    q, settled = floor.question, floor.question.mission.tolerance
    claim: dict[str, object] = {"floor": Fraction(floor.value)}
    if floor.horizon is not None:
        claim["horizon"] = floor.horizon
    elif found.ratio is not None:
        claim |= {"ratio": Fraction(found.ratio), "ratio_from": found.ratio_from}
    if found.settling is not None:
        claim["settling"] = {
            "time": Fraction(found.settling),
            "attitude": settled.attitude,
            "rate": settled.rate,
        }
    bounds = [(Fraction(0), found.largest_gap, found.largest_rate)]
    if found.ultimate is not None:
        u = found.ultimate
        bounds.append((Fraction(u.start), u.gap, u.rate))
    claim["bounds"] = [
        {"from": start, "gap": Fraction(_above(gap)), "rate": Fraction(_above(rate))}
        for start, gap, rate in bounds
    ]
    inertia = floor.parts[0][0].constants.inertia
    witness = {
        "lo": inertia.lo,
        "hi": inertia.hi,
        "shape": shape_error(q.mission.body, q.mission.uncertainty),
        "bins": [_bin(part, pipe) for part, pipe in floor.parts],
    }
    return Certificate(KIND, robust_data(q), claim, witness)


def _above(value: float) -> float:
    """A float a little above: the checker rounds its roots by its own rule."""
    return nextafter(value * (1 + 1e-11), inf)


def robust_data(q: RobustQuestion) -> dict[str, object]:
    """What the claims speak about: the loop that the controller knows, and what it does not know."""
    return {
        "inertia": q.mission.body.exact_inertia,
        "law": law_form(close_loop(q.law)),
        "parameters": q.law.parameters,
        "initial": {state.name: state.initial for state in q.law.controller_states},
        "schedule": schedule_data(q.mission.schedule),
        "initial_set": set_data(q.mission.starts),
        "uncertainty": uncertainty_data(q.mission.uncertainty),
    }


def uncertainty_data(u: Uncertainty) -> dict[str, object]:
    """The channels that are not nominal."""
    data = {name: getattr(u, name) for name in u.channels}
    if "thrust_error" in data:
        data["thrust_error_varies"] = u.thrust_error_varies
    return data


def _bin(part: BodyBin, pipe: Flowpipe) -> dict[str, object]:
    entry: dict[str, object] = {
        "scale": list(part.scale),
        "s": [Fraction(pipe.initial.s_low), Fraction(pipe.initial.s_high)],
        "y": Fraction(pipe.initial.y_high),
        "steps": _steps(pipe.steps),
    }
    if pipe.tail is not None:
        tail: dict[str, object] = {"steps": _steps(pipe.tail.steps)}
        if pipe.tail.ratios:
            tail["ratio"] = Fraction(max(pipe.tail.ratios.values()))
        if "L" in pipe.tail.limits:
            tail["gain_limit"] = Fraction(pipe.tail.limits["L"])
        entry["tail"] = tail
    return entry


def _steps(steps: Iterable[Step]) -> list[dict[str, object]]:
    return [
        {
            "until": step.stop,
            "forms": [word for word in step.modes if word != HELD],
            "bounds": {name: scaled_integers(c) for name, c in step.controls.items()},
        }
        for step in steps
    ]

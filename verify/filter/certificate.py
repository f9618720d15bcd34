"""A certified floor as a certificate: flowpipes written out, for the stand-alone checker."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import frexp
from typing import TYPE_CHECKING

from ...models.closed_loop import close_loop
from .. import checker
from ..certificates.format import Certificate, certificate_text
from ..certificates.schedule import schedule_data
from ..flow.stepping import Step
from ..lyapunov.forms import law_form
from .certify import FilterLowerBound
from .flowpipe import Flowpipe

if TYPE_CHECKING:
    from ...models.mission import InitialSet
    from .convergence import Convergence
    from .question import FloorQuestion
    from .torque_bound import TorqueBound

FLOOR, WITHOUT_FILTER = "filter-floor", "comparison"
"""Kinds of certificates of laws with a filter state R, and of laws without."""
MANTISSA = 53
"""Bits of a float's mantissa."""


def floor_certificate(
    question: FloorQuestion,
    floor: FilterLowerBound,
    *,
    convergence: Convergence | None = None,
    torque: TorqueBound | None = None,
) -> Certificate:
    """Certificate of R >= floor, of convergence where every flowpipe has a repeating part, and of more.

    Parameters
    ----------
    question : FloorQuestion
        What was asked: law, body, schedule, set.
    floor : FilterLowerBound
        What was proved: its flowpipes are the witness.
    convergence : Convergence, optional
        Its settling time for the question's tolerances is claimed too.
    torque : TorqueBound, optional
        Its bound of |g u| is claimed too.
    """
    settled, data = question.mission.tolerance, question_data(question)
    system = floor.system
    claim: dict[str, object] = {}
    if system.floor_component is not None:
        claim["floor"] = Fraction(floor.value)
    tails = [w.tail for w in floor.flowpipes]
    if floor.horizon is not None:
        claim["horizon"] = floor.horizon
    else:
        ratios = [max(t.ratios.values(), default=0.0) for t in tails if t is not None]
        claim["ratio"] = Fraction(max(ratios))
        claim["ratio_from"] = max(t.start for t in tails if t is not None)
    if convergence is not None and convergence.settling is not None:
        time = Fraction(convergence.settling)
        claim["settling"] = {"time": time, "attitude": settled.attitude, "rate": settled.rate}
    if torque is not None:
        claim["torque"] = Fraction(torque.applied)
    kind = WITHOUT_FILTER if system.floor_component is None else FLOOR
    named = {"system": system.system_name} if system.system_name else {}
    return Certificate(kind, data, claim, named | _flowpipes(floor))


def refusal(certificate: Certificate, floor: FilterLowerBound) -> str:
    """Why the checker does not accept a certificate that rests on a system from outside; empty if it does.

    Such a system counts only with its own part of the checker, which states its inequalities once more.
    """
    system = floor.system
    if not system.system_name:
        return ""
    if system.part is None:
        return f"the comparison system {system.system_name} brings no part of the checker"
    findings = checker.check_text(certificate_text([certificate]), (system.part,))
    return next((finding.reason for finding in findings if not finding.valid), "")


def question_data(question: FloorQuestion) -> dict[str, object]:
    """What a floor's claims speak about: body, the law's equations and start, schedule and initial set.

    Raises
    ------
    NotAlgebraicError
        If the law uses more than + - * /.
    """
    q, mission = question, question.mission
    data: dict[str, object] = {
        "inertia": mission.body.exact_inertia,
        "law": law_form(close_loop(q.law)),
        "parameters": q.law.parameters,
        "initial": {state.name: state.initial for state in q.law.controller_states},
        "schedule": schedule_data(mission.schedule),
        "initial_set": set_data(mission.starts),
    }
    if mission.inertia_tolerance is not None:
        data["inertia_tolerance"] = mission.inertia_tolerance
    return data


def set_data(starts: InitialSet) -> dict[str, object]:
    """Write down the initial set; a bound that it does not have is left out."""
    bounds = {
        "max_angle_deg": starts.max_angle_deg,
        "max_rate": starts.max_rate,
        "max_weighted_rate": starts.max_weighted_rate,
    }
    return {name: value for name, value in bounds.items() if value is not None}


def _flowpipes(floor: FilterLowerBound) -> dict[str, object]:
    return {
        "coupling": Fraction(floor.bounds.coupling),
        "greatest_inertia": floor.bounds.greatest,
        "box": {"s": Fraction(floor.initial.s_high), "y": Fraction(floor.initial.y_high)},
        "bins": [_bin(w) for w in floor.flowpipes],
    }


def _bin(witness: Flowpipe) -> dict[str, object]:
    i = witness.initial
    entry: dict[str, object] = {
        "s": [Fraction(i.s_low), Fraction(i.s_high)],
        "y": [Fraction(i.y_low), Fraction(i.y_high)],
        "steps": _steps(witness.steps),
    }
    if witness.tail is not None:
        ratio = max(witness.tail.ratios.values(), default=0.0)
        entry["tail"] = {"ratio": Fraction(ratio), "steps": _steps(witness.tail.steps)}
    return entry


def _steps(steps: Iterable[Step]) -> list[dict[str, object]]:
    return [
        {
            "until": step.stop,
            "forms": list(step.modes[:3]),  # what follows only says how the step was proposed
            "bounds": {name: scaled_integers(c) for name, c in step.controls.items()},
        }
        for step in steps
    ]


def scaled_integers(values: Sequence[float]) -> list[int]:
    """[e, n_0, n_1, ...] with values[i] = n_i 2^e exactly."""
    parts = [frexp(v) for v in values]
    exponents = [e - MANTISSA for m, e in parts if m != 0.0]
    if not exponents:
        return [0, *(0 for _ in values)]
    e = min(exponents)
    integers = [int(m * 2**MANTISSA) << max(x - MANTISSA - e, 0) for m, x in parts]
    shift = min((n & -n).bit_length() - 1 for n in integers if n)
    return [e + shift, *(n >> shift for n in integers)]

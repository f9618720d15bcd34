"""The certificate of a Euclidean lower bound: everything a stranger needs to prove it again.

The witness holds the travel, the instant at which it is split, bounds of the principal inertias
and, for each target sign, the chart and the potential with its rate. The stand-alone checker
repeats the branch and bound in integers; it shares no code with this package.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ...verify.certificates import Certificate
from ..norms import Euclidean
from ..problem import TransferProblem
from .momentum_sets import UnitBall, greatest_inertia_above, least_inertia_below
from .path import PathOptions
from .separation import Separation
from .travel import WindowTravel, least_peak

KIND = "peak-lower-bound"


def peak_certificate(problem: TransferProblem, *, options: PathOptions | None = None) -> Certificate | None:
    """Certificate of the shortest-path bound of a Euclidean problem; None if that bound is 0.

    Raises
    ------
    TypeError
        If the norm is not Euclidean: the bounds of other norms have no certificate yet.
    """
    from .bound import path_of, start_momentum

    if not isinstance(problem.norm, Euclidean):
        raise TypeError(f"there is no certificate for the {problem.norm.name} norm yet")
    ball = UnitBall(problem.body)
    path = path_of(problem, ball, options or PathOptions())
    travel = Fraction((path.travel * 2**60).__floor__(), 2**60)
    start = ball.size_above(start_momentum(problem))
    end = ball.size_of_rate(problem.terminal.rate)
    found = least_peak(WindowTravel(problem.window), travel, start, end)
    peak = Fraction((found.value * 2**60).__floor__(), 2**60)
    if peak <= 0:
        return None
    separations = dict(path.separations)
    witness = {
        "travel": travel,
        "instant": found.instant,
        "inertia_above": least_inertia_below(problem.body),
        "inertia_below": greatest_inertia_above(problem.body),
        "separations": [_separation(separations[sign]) for sign in problem.signs],
    }
    return Certificate(KIND, _data(problem), {"peak": peak}, witness)


def _data(problem: TransferProblem) -> dict[str, Any]:
    return {
        "inertia": problem.body.exact_inertia,
        "transfer": {
            "window": {"knots": problem.window.knots, "shapes": problem.window.shapes},
            "attitude": problem.attitude,
            "rate": problem.rate,
            "tolerance": {"attitude": problem.terminal.attitude, "rate": problem.terminal.rate},
            "signs": problem.signs,
        },
    }


def _separation(proof: Separation | None) -> dict[str, Any]:
    if proof is None:
        return {"by": "angle"}
    chart = proof.chart
    return {
        "by": "potential",
        "chart": {
            "middle": chart.middle,
            "direction": chart.direction,
            "inner": chart.inner,
            "outer": chart.outer,
        },
        "potential": [[*e, c] for e, c in proof.potential.items()],
        "rate": Fraction(proof.supremum.value),
    }

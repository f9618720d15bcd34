"""The certificate of a lower bound: everything a stranger needs to prove it again.

The data are the transfer; the claim is the peak. The witness names the argument (momentum, path or
components), the rows of the set of momenta and whatever turns the proof into algebra: multipliers,
the instant at which the transfer is split, and for each target sign the chart and the potential
with its rate. The stand-alone checker repeats the branch and bound; it shares no code with this package.
"""

from __future__ import annotations

from fractions import Fraction

from ...models.norms import EUCLIDEAN, LARGEST_COMPONENT, Norm
from ...verify import checker
from ...verify.certificates import Certificate, certificate_text
from ...verify.exact.rounding import grid_above, grid_below, rounded_down
from ..problem import TransferProblem
from .argument import (
    AxisArgument,
    BrakingArgument,
    ComponentsArgument,
    MomentumArgument,
    NamedBound,
    PathArgument,
)
from .bound import LowerBound
from .potential.path import PathBound
from .potential.separation import Separation
from .prepare import Measured
from .sets.polynomials import exponents
from .windows.travel import peak_at

KIND = "peak-lower-bound"
MAX_THRUSTERS = 12
"""Thrusters that the checker takes: it tries every choice of them."""
_BITS = 120
_LESS = 1 - Fraction(1, 2**64)
"""The checker rounds its square roots: a travel is claimed a trifle smaller."""
_A_TRIFLE_LESS = 1 - Fraction(1, 2**60)
"""A peak, where the travel allowed is not in proportion to it."""


def peak_certificate(problem: TransferProblem, bound: NamedBound) -> Certificate | None:
    """Certificate of one of a problem's lower bounds; None if it claims nothing or the format cannot say it.

    The peak claimed is the bound's value, or one float less.
    """
    if not has_certificate(problem.norm):
        return None
    argument = bound.argument
    witness: dict[str, object] = {"rows": argument.momenta.pairs}
    if isinstance(argument, MomentumArgument):
        exact = _absorbed(argument.measured, witness)
    elif isinstance(argument, AxisArgument):
        exact = bound.exact * _LESS
        witness |= {"argument": "axis", "axis": argument.axis}
    else:
        radius = argument.measured.radius[1]
        travel = _down(argument.path.travel / radius * _LESS)
        witness |= {"travel": travel, "speed": argument.momenta.speed_multipliers}
        witness["separations"] = _separations(problem, argument.path, radius)
        if isinstance(argument, PathArgument):
            exact = _allowing(argument, travel, witness)
        elif isinstance(argument, BrakingArgument):
            exact = bound.exact * _A_TRIFLE_LESS
            witness |= _braking_witness(argument)
        else:
            exact = bound.exact * _A_TRIFLE_LESS
            witness |= _component_witness(argument)
    peak = Fraction(rounded_down(min(exact, bound.exact)))
    return Certificate(KIND, transfer_data(problem), {"peak": peak}, witness) if peak > 0 else None


def largest_certificate(problem: TransferProblem, bound: LowerBound) -> tuple[NamedBound, Certificate] | None:
    """Return the largest bound whose certificate the stand-alone checker confirms; None if all are 0."""
    for named in bound.all:
        certificate = peak_certificate(problem, named)
        if certificate is None:
            continue
        if all(finding.valid for finding in checker.check_text(certificate_text([certificate]))):
            return named, certificate
    return None


def transfer_data(problem: TransferProblem) -> dict[str, object]:
    """What a lower bound speaks about, as certificates say it."""
    return {
        "inertia": problem.body.exact_inertia,
        "transfer": {
            "torque": _torque(problem.norm),
            "window": {"knots": problem.window.knots, "shapes": problem.window.shapes},
            "attitude": problem.attitude,
            "rate": problem.rate,
            "tolerance": {"attitude": problem.terminal.attitude, "rate": problem.terminal.rate},
            "signs": problem.signs,
        },
    }


def has_certificate(norm: Norm) -> bool:
    """Whether the certificate's format can say what limits the torque."""
    thrusters = all(block.is_one_sided for block in norm.blocks) and len(norm.axes) <= MAX_THRUSTERS
    return norm.is_ball or norm.is_cube or thrusters


def _torque(norm: Norm) -> dict[str, object]:
    if norm.is_ball:
        return {"by": EUCLIDEAN.key}
    return {"by": LARGEST_COMPONENT.key} if norm.is_cube else {"by": "thrusters", "axes": norm.axes}


def _absorbed(measured: Measured, witness: dict[str, object]) -> Fraction:
    """Peak that the momentum argument gives with a size of the end rounded up, which enters the witness."""
    low, high = measured.radius
    end = _up(measured.end / low)
    witness |= {"argument": "momentum", "end": end}
    total = measured.prepared.windows.total
    return (measured.start[0] / high - end) / total if total else Fraction(0)


def _allowing(argument: PathArgument, travel: Fraction, witness: dict[str, object]) -> Fraction:
    """Peak that the path argument gives with a travel rounded down; enters instant and end in the witness."""
    measured, departure = argument.measured, argument.departure
    radius, coast = measured.radius[0], departure.coast
    start, end, slack = (_up(x / radius) for x in (measured.start[1], measured.end, departure.slack))
    witness |= {"argument": "path", "instant": argument.instant, "end": end}
    if coast.until:
        witness["coast"] = {
            "until": coast.until,
            "attitude": coast.attitude,
            "turn": coast.turn,
            "slack": slack,
            "growth": [departure.growth.distance, departure.growth.momentum],
        }
    return peak_at(
        measured.prepared.windows,
        argument.instant,
        travel - slack,
        start,
        end,
        after=coast.until,
        deviation=_up(departure.deviation / _LESS),
    )


def _braking_witness(argument: BrakingArgument) -> dict[str, object]:
    measured, coast, radius = argument.measured, argument.coast, argument.measured.radius[0]
    return {
        "argument": "braking",
        "end": _up(measured.end / radius),
        "shares": argument.shares,
        "coast": {
            "attitude": coast.attitude,
            "turn": coast.turn,
            "slack": _up(argument.slack / radius),
            "growth": argument.growth,
        },
    }


def _component_witness(argument: ComponentsArgument) -> dict[str, object]:
    bounds, coast = argument.bounds, argument.coast
    witness: dict[str, object] = {
        "argument": "components",
        "instant": coast.until,
        "end": argument.end,
        "box": argument.box,
        "bounds": bounds.B,
        "widths": bounds.width_multipliers,
        "multipliers": bounds.multipliers,
    }
    if not argument.measured.prepared.problem.starts_at_rest:
        witness["coast"] = {"attitude": coast.attitude, "turn": coast.turn}
    return witness


def _separations(problem: TransferProblem, path: PathBound, scale: Fraction) -> list[dict[str, object]]:
    found = dict(path.separations)
    return [_separation(found[sign], scale) for sign in problem.signs]


def _separation(proof: Separation | None, scale: Fraction) -> dict[str, object]:
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
        "potential": [
            [*e, c] for e in exponents(proof.potential.degree) if (c := proof.potential.coefficient(e))
        ],
        "rate": Fraction(proof.supremum.value) * scale,
    }


def _down(x: Fraction) -> Fraction:
    return grid_below(x, _BITS)


def _up(x: Fraction) -> Fraction:
    return grid_above(x, _BITS)

"""Transfers that cannot be, in the user's words, by arguments that hold for every controller."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ....models.apart import apart
from ....models.schedule.polynomial import antiderivative, evaluate
from ...problem import TransferProblem


@final
@dataclass(frozen=True)
class Explanation:
    """Why a transfer is impossible or hopeless, and what to change.

    Attributes
    ----------
    impossible : bool
        True if no torque whatever makes the transfer; False if only the stated limit rules it out.
    certain : bool
        False if it is a warning and no argument: the transfer may exist all the same.
    """

    reason: str
    next_step: str
    impossible: bool
    certain: bool = True


def open_time(problem: TransferProblem) -> Fraction:
    """Integral of w over the transfer, s, exact."""
    parts = (p.length * evaluate(antiderivative(p.shape), Fraction(1)) for p in problem.window.pieces)
    return sum(parts, Fraction(0))


def arrives_by_itself(problem: TransferProblem) -> bool:
    """Whether the start is already at rest within the terminal tolerances, so that no torque is needed."""
    vector = sum(x * x for x in problem.attitude[1:])
    whole = sum(x * x for x in problem.attitude)
    near = vector <= problem.terminal.attitude**2 * whole
    return near and problem.starts_at_rest


def absorption_peak(problem: TransferProblem) -> float:
    """Least peak that could take up the start's momentum, whatever happens to the attitude.

    |J w| changes no faster than |torque|, since w x J w is orthogonal to J w; so
    |J w(0)| <= |J w(tf)| + reach * p * integral of w, with `reach` the largest |torque| of
    unit effort and |J w(tf)| <= Jmax times the rate tolerance.
    """
    momentum = float(np.linalg.norm(problem.start_momentum))
    allowed = float(problem.body.principal_inertias[-1]) * float(problem.terminal.rate)
    return max(0.0, momentum - allowed) / (problem.norm.reach * float(open_time(problem)))


def travel_peak(problem: TransferProblem) -> float:
    """Least peak that could make the rotation from rest, from the smallest principal inertia.

    |J w(t)| <= reach * p * min(window time before t, window time after t) plus what the rate
    tolerance leaves at the end, and the path is no longer than its integral over Jmin. A quick
    screen in ordinary floating point; the certified bounds are sharper.
    """
    if not problem.starts_at_rest:
        return 0.0
    angle = max(0.0, problem.angle - 2.0 * math.asin(float(problem.terminal.attitude)))
    inertias = problem.body.principal_inertias
    left = float(inertias[-1]) * float(problem.terminal.rate) * float(problem.horizon)
    path = float(inertias[0]) * angle - left
    return max(0.0, path) / (problem.norm.reach * _travel_integral(problem))


def _travel_integral(problem: TransferProblem) -> float:
    """Integral of min(up, dn), a little above: up and dn are the window times before and after t."""
    knots = np.array([float(k) for k in problem.window.knots])
    used = np.zeros(len(knots))
    for i, piece in enumerate(problem.window.pieces):
        used[i + 1] = used[i] + float(piece.length * evaluate(antiderivative(piece.shape), Fraction(1)))
    total, value = used[-1], 0.0
    for i in range(len(knots) - 1):
        grid = np.linspace(knots[i], knots[i + 1], 65)
        piece = list(problem.window.pieces)[i]
        s = (grid - grid[0]) / (grid[-1] - grid[0])
        primitive = [float(c) for c in antiderivative(piece.shape)] or [0.0]
        inner = np.polynomial.polynomial.polyval(s, primitive) * float(piece.length)
        up = used[i] + inner
        value += float(np.trapezoid(np.minimum(up, total - up), grid))
    return value * (1.0 + 1e-3)


def missing_direction(problem: TransferProblem) -> Explanation | None:
    """Say along which axis the thrusters cannot push, if there is one; it proves nothing.

    Transfers that need no push that way are made all the same: look at it after a search has failed.
    """
    missing = problem.norm.missing_direction
    if missing is None:
        return None
    who = "one-sided thrusters" if problem.norm.is_one_sided else "thrusters"
    axis = ", ".join(f"{round(float(x), 3) + 0.0:.3f}" for x in missing)
    return Explanation(
        f"no start led to a feasible transfer, and the {who} cannot push along ({axis}) at all",
        "add a thruster that pushes that way, so that every torque can be made; or try more starts",
        impossible=False,
        certain=False,
    )


def explain(problem: TransferProblem, limit: float | None = None) -> Explanation | None:
    """Say why no torque, or none within `limit` (norm's unit), makes the transfer; None if one may."""
    if arrives_by_itself(problem):
        return None
    total = open_time(problem)
    tf = float(problem.horizon)
    if total == 0:
        return Explanation(
            f"no thruster window opens before tf = {tf:g} s, so that no torque acts at all",
            "choose a later tf, or a schedule that opens earlier",
            impossible=True,
        )
    if limit is None:
        return None
    unit = problem.norm.unit
    momentum = float(np.linalg.norm(problem.start_momentum))
    absorb, travel = absorption_peak(problem), travel_peak(problem)
    if absorb > limit:
        needed, most = apart(absorb, limit, digits=3)
        return Explanation(
            f"the windows before tf = {tf:g} s (total {float(total):.4g} s) cannot absorb the start's "
            f"momentum of {momentum:.4g} N m s: needs {needed} {unit}, limit {most} {unit}",
            "allow more torque, more window time or a later tf, or start with less rate",
            impossible=False,
        )
    if travel > limit:
        needed, most = apart(travel, limit, digits=3)
        return Explanation(
            f"the windows before tf = {tf:g} s (total {float(total):.4g} s) are too short to turn "
            f"{math.degrees(problem.angle):.4g} deg to the tolerance: needs at least {needed} {unit}, "
            f"limit {most} {unit}",
            "allow more torque, more window time, a later tf or a larger tolerance",
            impossible=False,
        )
    return None

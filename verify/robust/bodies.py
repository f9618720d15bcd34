"""From the uncertainty of a scenario to bins of bodies, each with its constants and its disturbance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from typing import final

from ...models.rigid_body import RigidBody
from ...models.uncertainty import Uncertainty
from .constants import Constants, Misalignment
from .inertia_set import InertiaBin, relative_error

Interval = tuple[Fraction, Fraction]


@final
@dataclass(frozen=True)
class BodyBin:
    """One interval of common factors of the inertia that the loop behaves as if it had.

    Attributes
    ----------
    scale : the interval of e
    constants : what the comparison system needs
    push : bound of D/sqrt(Jmin) in the metric of |x|, sqrt(kg m^2)/s^2
    """

    scale: Interval
    constants: Constants
    push: Fraction


def shape_error(body: RigidBody, uncertainty: Uncertainty) -> Fraction:
    """Rho of all that is uncertain of the inertia but its common factor.

    Raises
    ------
    ValueError
        If it reaches a singular inertia.
    """
    rho = uncertainty.inertia_relative
    if uncertainty.inertia_tolerance is not None:
        rho += relative_error(body, uncertainty.inertia_tolerance)
    if rho >= 1:
        raise ValueError("the inertia's tolerances reach a singular inertia: nothing follows")
    return rho


def whole_scale(uncertainty: Uncertainty) -> Interval:
    """Interval of e: inertia factors over thrust factors, since (1 + d) u on J moves as u on J/(1 + d)."""
    (low, high), (weak, strong) = uncertainty.inertia_scale, uncertainty.thrust_error
    return (1 + low) / (1 + strong) - 1, (1 + high) / (1 + weak) - 1


def body_bins(body: RigidBody, uncertainty: Uncertainty, bins: int) -> Iterator[BodyBin]:
    """Bins that cover every body: one where the thrust differs between firings, else `bins` of them.

    A bin is for factors that stay: between firings that differ |x|_J is continuous in the true J alone.
    """
    u, shape = uncertainty, shape_error(body, uncertainty)
    low, high = whole_scale(u)
    turn = Misalignment.of(u.misalignment_deg)
    stays = u.thrust_error_varies == "never" or not any(u.thrust_error)
    count = bins if stays and low < high else 1
    edges = [low + (high - low) * Fraction(i, count) for i in range(count + 1)]
    for e in pairwise(edges):
        inertia, boost, weakest = InertiaBin.around(body, shape, e), Fraction(1), 1 + u.thrust_error[0]
        if not stays:
            inertia = replace(inertia, metric_low=u.inertia_scale[0], metric_high=u.inertia_scale[1])
            boost, weakest = 1 + u.thrust_error[1], Fraction(1)
        constants = Constants(inertia, turn, boost)
        yield BodyBin(e, constants, u.disturbance / weakest * constants.inverse_root)

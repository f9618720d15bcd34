"""Members of an uncertain family: bodies, thrusters and disturbances at the ends of what is allowed.

Worst cases sit at ends: eigenvalues of J0^-1/2 J J0^-1/2 at 1 +- rho, factors at their limits, the greatest
disturbance, fixed or following the motion. What is drawn here is simulated; it proves nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final, get_args

import numpy as np

from .laws import Law
from .rigid_body import RigidBody
from .types import Array
from .uncertain import Direction, Member
from .uncertainty import Uncertainty

BITS = 40
"""Entries of a drawn inertia are rounded towards the believed one to this many bits after its size."""


@final
@dataclass(frozen=True)
class DrawnMember:
    """A loop of the family: the law behind its thrusters, and the body it acts on."""

    law: Member
    body: RigidBody


def draw_members(
    law: Law, believed: RigidBody, uncertainty: Uncertainty, count: int, rng: np.random.Generator
) -> list[DrawnMember]:
    """Draw extreme members, independent of each other.

    Parameters
    ----------
    law, believed : Law, RigidBody
        What is flown, and the inertia that it computes with.
    uncertainty : Uncertainty
        What the members may differ by.
    count : int
        How many.
    rng : np.random.Generator
        Source of chance.
    """
    return [_draw(law, believed, uncertainty, rng) for _ in range(count)]


def _draw(law: Law, believed: RigidBody, u: Uncertainty, rng: np.random.Generator) -> DrawnMember:
    factor = 1.0 + float(u.inertia_scale[rng.integers(2)])
    body = RigidBody(_rounded(believed, factor * _shape(believed, u, rng), u))
    d = 1.0 + float(u.thrust_error[rng.integers(2)])
    thrust = d * _turn(np.radians(float(u.misalignment_deg)), rng)
    ways = get_args(Direction)
    toward: Direction = ways[rng.integers(len(ways))] if u.disturbance else "fixed"
    size = float(u.disturbance) * (1 - 1e-12)
    disturbance = _unit(rng) * size if toward == "fixed" else np.array([size * rng.choice([-1, 1]), 0, 0])
    return DrawnMember(Member.of(law, believed, thrust=thrust, disturbance=disturbance, toward=toward), body)


def _shape(believed: RigidBody, u: Uncertainty, rng: np.random.Generator) -> Array:
    """J0 and a deviation at the ends of the relative error and of the tolerance."""
    J0 = believed.inertia
    values, vectors = np.linalg.eigh(J0)
    root = vectors @ np.diag(np.sqrt(values)) @ vectors.T
    axes = (np.eye(3), vectors, np.linalg.qr(rng.normal(size=(3, 3)))[0])[rng.integers(3)]
    signs = rng.choice([-1.0, 1.0], 3)
    J: Array = J0 + float(u.inertia_relative) * root @ (axes @ np.diag(signs) @ axes.T) @ root
    if u.inertia_tolerance is not None:
        corner = np.triu(rng.choice([-1.0, 1.0], (3, 3)))
        corner = corner + np.triu(corner, 1).T
        J = J + corner * np.array([[float(x) for x in row] for row in u.inertia_tolerance])
    return J


def _rounded(
    believed: RigidBody, J: Array, u: Uncertainty
) -> tuple[tuple[Fraction, Fraction, Fraction], ...]:
    """Exact and symmetric; a nominal body stays the believed one to the last bit."""
    if not (u.inertia_relative or u.inertia_tolerance or any(u.inertia_scale)):
        return believed.exact_inertia
    inward = believed.inertia + (J - believed.inertia) * (1 - 2.0**-BITS)
    rows = [[Fraction(float(inward[min(i, j), max(i, j)])) for j in range(3)] for i in range(3)]
    return tuple((row[0], row[1], row[2]) for row in rows)


def _turn(angle: float, rng: np.random.Generator) -> Array:
    """Rotation by the angle about a random axis."""
    x = _unit(rng)
    S = np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    R: Array = np.eye(3) + np.sin(angle) * S + (1 - np.cos(angle)) * S @ S
    return R


def _unit(rng: np.random.Generator) -> Array:
    x = rng.normal(size=3)
    unit: Array = x / np.linalg.norm(x)
    return unit

"""How the size of a torque is measured: the three thruster arrangements a peak can be asked for.

Every arrangement is a convex set of torques reachable with unit effort: a ball, a cube, or the
set {B f : 0 <= f_j <= 1} of one-sided thrusters. The *peak* of a torque is the least effort
that reaches it (the gauge of that set); the *support* of a direction is the most that unit
effort can do along it, which is what bounds and switching functions need.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from ..models.types import Array


class Norm(ABC):
    """A thruster arrangement. Torques are body-frame, N m; all arrays have the vector last."""

    @property
    @abstractmethod
    def name(self) -> str:
        """Words for reports, e.g. "largest component"."""

    @property
    @abstractmethod
    def unit(self) -> str:
        """Unit of the peak: N m, or N if the axes of thrusters are given in m."""

    @property
    @abstractmethod
    def control_matrix(self) -> Array:
        """B of torque = B v, with v the quantities that are limited, shape (3, m)."""

    @abstractmethod
    def peak(self, torque: ArrayLike) -> Array:
        """Least effort that produces the torque, shape (..., 3) -> (...); inf if none does."""

    @abstractmethod
    def effort(self, control: ArrayLike) -> Array:
        """Effort of a control v, shape (..., m) -> (...); never below `peak(B v)`."""

    @abstractmethod
    def consumption(self, control: ArrayLike) -> Array:
        """Impulse spent each second by a control v, shape (..., m) -> (...): what the propellant pays for."""

    @abstractmethod
    def support(self, direction: ArrayLike) -> Array:
        """Largest direction . torque over torques of unit effort, shape (..., 3) -> (...)."""


class _OfTheTorque(Norm):
    """What is limited is the torque itself: v = torque."""

    @property
    def unit(self) -> str:
        """Unit of the peak."""
        return "N m"

    @property
    def control_matrix(self) -> Array:
        """The identity, (3, 3)."""
        return np.eye(3)

    def effort(self, control: ArrayLike) -> Array:
        """The peak of the torque."""
        return self.peak(control)


@final
@dataclass(frozen=True)
class Euclidean(_OfTheTorque):
    """|torque| <= p: a gimballed or well-spread set of thrusters."""

    @property
    def name(self) -> str:
        """Words for reports."""
        return "Euclidean"

    def peak(self, torque: ArrayLike) -> Array:
        """Euclidean length."""
        return np.asarray(np.linalg.norm(np.asarray(torque, dtype=float), axis=-1))

    def consumption(self, control: ArrayLike) -> Array:
        """Euclidean length."""
        return self.peak(control)

    def support(self, direction: ArrayLike) -> Array:
        """Euclidean length (the ball is its own polar)."""
        return self.peak(direction)


@final
@dataclass(frozen=True)
class LargestComponent(_OfTheTorque):
    """|torque_i| <= p for each body axis i: a pair of thrusters for each axis."""

    @property
    def name(self) -> str:
        """Words for reports."""
        return "largest component"

    def peak(self, torque: ArrayLike) -> Array:
        """Largest absolute component."""
        return np.asarray(np.abs(np.asarray(torque, dtype=float)).max(axis=-1))

    def consumption(self, control: ArrayLike) -> Array:
        """Sum of absolute components: each axis has thrusters of its own."""
        return np.asarray(np.abs(np.asarray(control, dtype=float)).sum(axis=-1))

    def support(self, direction: ArrayLike) -> Array:
        """Sum of absolute components (polar of the cube)."""
        return np.asarray(np.abs(np.asarray(direction, dtype=float)).sum(axis=-1))


@final
@dataclass(frozen=True)
class ThrusterAxes(Norm):
    """Thruster j gives the torque f_j axes[j] with 0 <= f_j <= p: one-sided thrust.

    Attributes
    ----------
    axes : tuple of m triples of Fraction
        Torque for unit force of each thruster, body frame, m (lever arm times direction).
        Whether they push both ways along each body axis is `spans_all_directions`
        (without it some torques cannot be made at all).
    """

    axes: tuple[tuple[Fraction, Fraction, Fraction], ...]

    def __post_init__(self) -> None:
        if not self.axes or not self.control_matrix.any():
            raise ValueError(
                f"one thruster at least must give a torque: received {len(self.axes)} without any"
            )

    @classmethod
    def from_rows(cls, rows: Sequence[Sequence[Fraction | int | float | str]]) -> ThrusterAxes:
        """Build from one row of three numbers for each thruster; strings and fractions stay exact."""
        if any(len(row) != 3 for row in rows):
            raise ValueError("each thruster axis must have three numbers (torque per unit force, m)")
        return cls(tuple((Fraction(r[0]), Fraction(r[1]), Fraction(r[2])) for r in rows))

    @property
    def name(self) -> str:
        """Words for reports."""
        return f"{len(self.axes)} one-sided thrusters"

    @property
    def unit(self) -> str:
        """Unit of the peak: a force."""
        return "N"

    @cached_property
    def control_matrix(self) -> Array:
        """One column for each thruster, (3, m), m."""
        return np.array([[float(x) for x in axis] for axis in self.axes]).reshape(-1, 3).T

    @cached_property
    def facets(self) -> tuple[Array, Array]:
        """Normals (n, 3) and heights (n,) of the torque set {B f : 0 <= f <= 1}.

        The set is a zonotope, so each facet normal is a cross product of two axes, either way.
        """
        columns = self.control_matrix.T
        _, sizes, directions = np.linalg.svd(columns)
        rank = int((sizes > 1e-12 * sizes[0]).sum())
        # a flat set has facets along its own plane or line too: cross products with what is normal to it
        columns = np.vstack([columns, sizes[0] * directions[rank:]])
        found = [np.cross(a, b) for a, b in combinations(columns, 2)]
        lengths = [float(np.linalg.norm(n)) for n in found]
        normals = [n / size for n, size in zip(found, lengths, strict=True) if size > 1e-12 * max(lengths)]
        both = np.array([sign * n for n in normals for sign in (1.0, -1.0)])
        return both, self.support(both)

    @cached_property
    def spans_all_directions(self) -> bool:
        """Whether every torque can be made (0 is inside the torque set)."""
        heights = self.facets[1]
        return bool(heights.min() > 1e-9 * heights.max())

    def peak(self, torque: ArrayLike) -> Array:
        """Least largest force: the gauge of the zonotope, from its facets."""
        normals, heights = self.facets
        reach = np.asarray(torque, dtype=float) @ normals.T
        floor = 1e-12 * heights.max()
        dead = heights <= floor
        ratio = np.where(dead, np.where(reach > floor, np.inf, 0.0), reach / np.where(dead, 1.0, heights))
        return np.asarray(np.maximum(ratio.max(axis=-1), 0.0))

    def effort(self, control: ArrayLike) -> Array:
        """Largest force; inf if a force is negative (thrust is one-sided)."""
        force = np.asarray(control, dtype=float)
        return np.where(force.min(axis=-1) < 0.0, np.inf, force.max(axis=-1))

    def consumption(self, control: ArrayLike) -> Array:
        """Sum of the forces."""
        return np.asarray(np.asarray(control, dtype=float).sum(axis=-1))

    def support(self, direction: ArrayLike) -> Array:
        """Sum over the thrusters of the positive part of direction . axis."""
        reach = np.asarray(direction, dtype=float) @ self.control_matrix
        return np.asarray(np.maximum(reach, 0.0).sum(axis=-1))

"""How the size of a torque is measured: one object, a product of blocks, for every part of the package.

A norm says what thrusters can do with unit effort: a torque is B v, and the controls v fall into
blocks, each limited by itself. A `Ball` limits the length of its controls, a `Box` each of them, both
ways or one way (thrust cannot pull). The *effort* of a control is the largest over its blocks; the
*peak* of a torque is the least effort that makes it; the *support* of a direction is the most that
unit effort does along it. Whoever needs more than these goes through `blocks` one by one, so that a
new norm is one new object.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, reduce
from itertools import combinations, product
from typing import Any, Literal, cast, final

import numpy as np
from numpy.typing import ArrayLike

from .norm_blocks import Ball, Block, Box
from .types import Array
from .zonotope import zonotope_vertices

Axis = tuple[Fraction, Fraction, Fraction]
BODY_AXES: tuple[Axis, ...] = tuple(
    (Fraction(int(i == 0)), Fraction(int(i == 1)), Fraction(int(i == 2))) for i in range(3)
)
"""Torque of each control where the controls are the torque's own components."""


@final
@dataclass(frozen=True)
class Norm:
    """A way to measure torques in the body frame; in all arrays the vector is last.

    Attributes
    ----------
    key : str
        Its word in files: "component", "euclidean", "thrusters".
    name : str
        Words for reports, e.g. "largest component".
    blocks : tuple of Block
        What limits the controls, in order; their sizes add up to the number of axes.
    axes : tuple of m triples of Fraction
        Torque of one unit of each control; the body axes, so that v is the torque, unless given.
    unit : str
        Unit of the peak and of a control: N m, or N if the axes are given in m.
    """

    key: str
    name: str
    blocks: tuple[Block, ...]
    axes: tuple[Axis, ...] = BODY_AXES
    unit: str = "N m"

    def __post_init__(self) -> None:
        count = sum(block.size for block in self.blocks)
        if count != len(self.axes):
            raise ValueError(f"the blocks hold {count} controls, but there are {len(self.axes)} axes")
        if not self.control_matrix.any():
            raise ValueError(f"one axis at least must give a torque: received {count} without any")
        if not (self.limits_torque or self._is_polytope or self._inverse is not None):
            raise ValueError("a norm with a ball needs three controls with independent axes")

    @property
    def parts(self) -> Iterator[tuple[Block, slice]]:
        """Every block and the place of its controls among all."""
        start = 0
        for block in self.blocks:
            yield block, slice(start, start + block.size)
            start += block.size

    @cached_property
    def control_matrix(self) -> Array:
        """B of torque = B v, with v the quantities that are limited, shape (3, m)."""
        return np.array([[float(x) for x in axis] for axis in self.axes]).reshape(-1, 3).T

    @cached_property
    def limits_torque(self) -> bool:
        """Whether the torque itself is limited, by its components in body axes and both ways alike.

        The torque's length is then never below its peak.
        """
        return self.axes == BODY_AXES and not self.is_one_sided

    @property
    def is_one_sided(self) -> bool:
        """Whether some control cannot be negative."""
        return any(block.is_one_sided for block in self.blocks)

    @property
    def is_ball(self) -> bool:
        """Whether unit effort makes the torques of length at most 1, N m."""
        return self.axes == BODY_AXES and self.blocks == (Ball(3),)

    @property
    def is_cube(self) -> bool:
        """Whether unit effort makes the torques with components at most 1, N m."""
        return self.axes == BODY_AXES and not any(b.is_one_sided or b.is_round for b in self.blocks)

    @property
    def _is_polytope(self) -> bool:
        return not any(block.is_round for block in self.blocks)

    @cached_property
    def _inverse(self) -> Array | None:
        """Inverse of B where it has one, (3, 3)."""
        B = self.control_matrix
        return np.asarray(np.linalg.inv(B)) if B.shape == (3, 3) and np.linalg.matrix_rank(B) == 3 else None

    def effort(self, control: ArrayLike) -> Array:
        """Effort of a control v, shape (..., m) -> (...); never below `peak(B v)`."""
        v = np.asarray(control, dtype=float)
        return reduce(np.maximum, [block.effort(v[..., at]) for block, at in self.parts])

    def consumption(self, control: ArrayLike) -> Array:
        """Impulse spent each second by a control v, shape (..., m) -> (...): what the propellant pays for.

        The length of a ball's controls, the sizes of a box's added up.
        """
        v = np.asarray(control, dtype=float)
        return reduce(np.add, [block.consumption(v[..., at]) for block, at in self.parts])

    def clipped(self, control: Array) -> Array:
        """The control with those that cannot be negative at least 0."""
        if not self.is_one_sided:
            return control
        return np.concatenate([block.clipped(control[..., at]) for block, at in self.parts], axis=-1)

    def control_support(self, direction: ArrayLike) -> Array:
        """Largest direction . v over controls of unit effort, shape (..., m) -> (...)."""
        d = np.asarray(direction, dtype=float)
        return reduce(np.add, [block.support(d[..., at]) for block, at in self.parts])

    def support(self, direction: ArrayLike) -> Array:
        """Largest direction . torque over torques of unit effort, shape (..., 3) -> (...)."""
        return self.control_support(np.asarray(direction, dtype=float) @ self.control_matrix)

    def peak(self, torque: ArrayLike) -> Array:
        """Least effort that produces the torque, shape (..., 3) -> (...); inf if none does."""
        t = np.asarray(torque, dtype=float)
        if self.limits_torque:
            return self.effort(t)
        if not self._is_polytope:
            assert self._inverse is not None
            return self.effort(t @ self._inverse.T)
        normals, heights = self.facets
        reach, floor = t @ normals.T, 1e-12 * heights.max()
        dead = heights <= floor
        ratio = np.where(dead, np.where(reach > floor, np.inf, 0.0), reach / np.where(dead, 1.0, heights))
        return np.asarray(np.maximum(ratio.max(axis=-1), 0.0))

    def peak_expression(self, torque: Any) -> Any:
        """`peak` of a symbolic torque (3,).

        Raises
        ------
        ValueError
            If some torques cannot be made at all.
        """
        import casadi as ca

        if not (self.limits_torque or self.spans_all_directions):
            raise ValueError(f"{self.name} cannot make every torque, so that none has a peak for certain")
        if self._is_polytope and not self.limits_torque:
            normals, heights = self.facets
            return ca.mmax(ca.DM(normals / heights[:, None]) @ torque)
        control = torque
        if not self.limits_torque:
            assert self._inverse is not None
            control = ca.DM(self._inverse) @ torque
        efforts = [block.effort_expression(control[at]) for block, at in self.parts]
        return reduce(ca.fmax, efforts)

    def limited(self, torque: Any, limit: float) -> Any:
        """A symbolic torque (3,) brought within a peak, block by block.

        Raises
        ------
        ValueError
            If it is not the torque itself that is limited: how thrusters share it out is not known.
        """
        import casadi as ca

        if not self.limits_torque:
            raise ValueError(f"a torque is limited by its components or its length, not by {self.name}")
        parts = [block.limited(torque[at], limit) for block, at in self.parts]
        return parts[0] if len(parts) == 1 else ca.vertcat(*parts)

    @cached_property
    def facets(self) -> tuple[Array, Array]:
        """Normals (n, 3) and heights (n,) of the set of torques of unit effort, for a norm without balls.

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
    def missing_direction(self) -> Array | None:
        """Direction along which no torque can be made at all, (3,); None if every torque can be made."""
        if self._is_polytope:
            normals, heights = self.facets
            spans = bool(heights.min() > 1e-9 * heights.max())
            return None if spans else np.asarray(normals[int(np.argmin(heights))])
        one_sided = [at.start for block, at in self.parts if block.is_one_sided]
        if not one_sided:
            return None
        assert self._inverse is not None
        row = self._inverse[one_sided[0]]
        return np.asarray(-row / np.linalg.norm(row))

    @property
    def spans_all_directions(self) -> bool:
        """Whether every torque can be made (0 is inside the set of torques)."""
        return self.missing_direction is None

    @cached_property
    def reach(self) -> float:
        """Upper bound of the length of a torque of unit effort, N m."""
        lengths = np.linalg.norm(self.control_matrix, axis=0)
        gram = self.control_matrix.T @ self.control_matrix
        apart = bool((gram == np.diag(np.diag(gram))).all())
        sizes = [block.reach(lengths[at], apart=apart) for block, at in self.parts]
        if apart and len(sizes) > 1:
            return float(np.linalg.norm(sizes))
        return float(sum(sizes))

    def corners(self) -> list[Axis]:
        """Torques whose convex hull holds every torque of unit effort, exact.

        Raises
        ------
        ValueError
            If a ball has no corners (three controls or more).
        """
        if self._is_polytope:  # every control from its low end up: a zonotope
            lows = [
                Fraction(0 if block.is_one_sided else -1) for block in self.blocks for _ in range(block.size)
            ]
            spans = [tuple((1 - low) * x for x in axis) for low, axis in zip(lows, self.axes, strict=True)]
            x, y, z = self._torque(lows)
            return [(x + a, y + b, z + c) for a, b, c in zonotope_vertices(cast("list[Axis]", spans))]
        of_blocks = [block.corners() for block in self.blocks]
        return [self._torque([x for part in choice for x in part]) for choice in product(*of_blocks)]

    def _torque(self, control: Sequence[Fraction]) -> Axis:
        pairs = list(zip(control, self.axes, strict=True))
        x, y, z = (sum((v * axis[i] for v, axis in pairs if v), Fraction(0)) for i in range(3))
        return x, y, z


EUCLIDEAN = Norm("euclidean", "Euclidean", (Ball(3),))
"""|torque| <= p: a gimballed or well-spread set of thrusters."""
LARGEST_COMPONENT = Norm("component", "largest component", (Box(3),))
"""|torque_i| <= p for each body axis i: a pair of thrusters for each axis."""
NormWord = Literal["component", "euclidean"]
"""Words of the norms that a file or an option may name: the keys of `NORMS`."""
NORMS = {norm.key: norm for norm in (LARGEST_COMPONENT, EUCLIDEAN)}
"""The norms, by their word."""
MEASURED = tuple(NORMS.values())
"""Norms in which the torque of a run is measured unless others are asked for."""


def thrusters(axes: Sequence[Sequence[Fraction | int | float | str]]) -> Norm:
    """Norm of one-sided thrusters: thruster j gives the torque f_j axes[j] with 0 <= f_j <= p.

    Parameters
    ----------
    axes : m rows of three numbers
        Torque for unit force of each thruster, body frame, m (lever arm times direction); strings and
        fractions stay exact. Some torques cannot be made at all unless they push both ways along every
        direction (`spans_all_directions`).

    Raises
    ------
    ValueError
        If no thruster gives a torque, or a row has not three numbers.
    """
    if any(len(row) != 3 for row in axes):
        raise ValueError("each thruster axis must have three numbers (torque per unit force, m)")
    exact = tuple((Fraction(r[0]), Fraction(r[1]), Fraction(r[2])) for r in axes)
    if not any(any(axis) for axis in exact):
        raise ValueError(f"one thruster at least must give a torque: received {len(exact)} without any")
    return Norm("thrusters", f"{len(exact)} one-sided thrusters", (Box(len(exact), low=0),), exact, "N")

"""The blocks of a norm: controls limited together by their length, or each by itself."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Any, final

import numpy as np

from .types import Array

Point = tuple[Fraction, ...]


class Block(ABC):
    """Some controls of a norm, and the efforts they take; in all arrays the controls are last."""

    size: int

    @property
    @abstractmethod
    def is_one_sided(self) -> bool:
        """Whether its controls cannot be negative."""

    @property
    @abstractmethod
    def is_round(self) -> bool:
        """Whether the controls share one limit of their length, so that their direction turns freely."""

    @abstractmethod
    def effort(self, control: Array) -> Array:
        """Least p with the control within p times the block, (..., size) -> (...)."""

    @abstractmethod
    def effort_expression(self, control: Any) -> Any:
        """`effort` of a symbolic column."""

    @abstractmethod
    def limited(self, control: Any, limit: float) -> Any:
        """A symbolic column brought within `limit` times the block."""

    @abstractmethod
    def consumption(self, control: Array) -> Array:
        """Impulse spent each second, (..., size) -> (...)."""

    @abstractmethod
    def clipped(self, control: Array) -> Array:
        """The control with what cannot be negative at least 0."""

    @abstractmethod
    def support(self, direction: Array) -> Array:
        """Largest direction . v over the block, (..., size) -> (...)."""

    @abstractmethod
    def reach(self, lengths: Array, *, apart: bool) -> float:
        """Upper bound of |B v| over the block, from the lengths of B's columns; `apart`: at right angles."""

    @abstractmethod
    def corners(self) -> list[Point]:
        """Points whose convex hull holds the block, exact."""


@final
@dataclass(frozen=True)
class Ball(Block):
    """|v| <= p for `size` controls together."""

    size: int

    def __post_init__(self) -> None:
        if self.size < 2:
            raise ValueError(f"a ball holds two controls or more, received {self.size}: one is a box")

    @property
    def is_one_sided(self) -> bool:
        """No: a ball is the same in every direction."""
        return False

    @property
    def is_round(self) -> bool:
        """Yes."""
        return True

    def effort(self, control: Array) -> Array:
        """Length."""
        return np.asarray(np.linalg.norm(control, axis=-1))

    def effort_expression(self, control: Any) -> Any:
        """Length."""
        import casadi as ca

        return ca.norm_2(control)

    def limited(self, control: Any, limit: float) -> Any:
        """Scaled back, its direction kept."""
        import casadi as ca

        return control * ca.fmin(1, limit / ca.fmax(ca.norm_2(control), np.finfo(float).tiny))

    def consumption(self, control: Array) -> Array:
        """Length."""
        return self.effort(control)

    def clipped(self, control: Array) -> Array:
        """The control itself."""
        return control

    def support(self, direction: Array) -> Array:
        """Length (the ball is its own polar)."""
        return self.effort(direction)

    def reach(self, lengths: Array, *, apart: bool) -> float:
        """The longest column where all are at right angles, else the root of the sum of squares."""
        return float(lengths.max()) if apart else float(np.linalg.norm(lengths))

    def corners(self) -> list[Point]:
        """Corners of a polygon of 16 sides around the disc, with rational points of contact.

        Raises
        ------
        ValueError
            For three controls or more.
        """
        if self.size != 2:
            raise ValueError(f"a ball of {self.size} controls has no corners")
        steps = [Fraction(k, 4) for k in range(-4, 4)]
        half = [((1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)) for t in steps]
        contacts = half + [(-x, -y) for x, y in half]
        pairs = zip(contacts, contacts[1:] + contacts[:1], strict=True)
        # tangents at the unit vectors u and v meet at (u + v) / (1 + u . v)
        return [((a + c) / (1 + a * c + b * d), (b + d) / (1 + a * c + b * d)) for (a, b), (c, d) in pairs]


@final
@dataclass(frozen=True)
class Box(Block):
    """low p <= v_j <= p for each of `size` controls by itself.

    Attributes
    ----------
    low : int
        -1 for both ways, 0 for one-sided thrust.
    """

    size: int
    low: int = -1

    def __post_init__(self) -> None:
        if self.size < 1 or self.low not in (-1, 0):
            raise ValueError(f"expected a size >= 1 and low -1 or 0, received {self.size} and {self.low}")

    @property
    def is_one_sided(self) -> bool:
        """Whether `low` is 0."""
        return self.low == 0

    @property
    def is_round(self) -> bool:
        """No: each control has limits of its own."""
        return False

    def effort(self, control: Array) -> Array:
        """Largest size; one-sided: largest, or inf if one is negative."""
        if self.low:
            return np.asarray(np.abs(control).max(axis=-1))
        return np.where(control.min(axis=-1) < 0.0, np.inf, control.max(axis=-1))

    def effort_expression(self, control: Any) -> Any:
        """Largest size; one-sided: largest, or inf if one is negative."""
        import casadi as ca

        if self.low:
            return ca.mmax(ca.fabs(control))
        return ca.if_else(ca.mmin(control) < 0, np.inf, ca.mmax(control))

    def limited(self, control: Any, limit: float) -> Any:
        """Each control clipped."""
        import casadi as ca

        return ca.fmin(ca.fmax(control, self.low * limit), limit)

    def consumption(self, control: Array) -> Array:
        """Sizes added up: each control has thrusters of its own."""
        return np.asarray((np.abs(control) if self.low else control).sum(axis=-1))

    def clipped(self, control: Array) -> Array:
        """One-sided: at least 0."""
        return control if self.low else np.maximum(control, 0.0)

    def support(self, direction: Array) -> Array:
        """Sizes added up (polar of the cube); one-sided: positive parts added up."""
        return np.asarray((np.abs(direction) if self.low else np.maximum(direction, 0.0)).sum(axis=-1))

    def reach(self, lengths: Array, *, apart: bool) -> float:
        """Lengths added up, or the root of their squares' sum where they are at right angles."""
        return float(np.sqrt((lengths**2).sum())) if apart else float(lengths.sum())

    def corners(self) -> list[Point]:
        """Every choice of both ends."""
        return list(product((Fraction(self.low), Fraction(1)), repeat=self.size))

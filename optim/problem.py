"""The transfer every room of `optim` talks about: from a start to rest at the target, through windows.

Find a torque with peak(torque(t)) <= p w(t) that takes the body from (attitude, rate) at t = 0
to rest at the identity attitude at t = horizon, exactly or within tolerances. The data are
exact rationals, so that what is proved about the problem is proved about what the user wrote.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from fractions import Fraction
from functools import cached_property
from typing import final

import numpy as np

from ..models.mission import Mission
from ..models.norms import EUCLIDEAN, Norm
from ..models.rigid_body import RigidBody
from ..models.schedule import PiecewisePolynomial, Schedule
from ..models.schedule.piecewise import Piece
from ..models.schedule.polynomial import ZERO, compose_affine, polynomial
from ..models.types import Array

Quaternion = tuple[Fraction, Fraction, Fraction, Fraction]
Vector = tuple[Fraction, Fraction, Fraction]
Number = Fraction | int | float | str


class WindowProfile(Enum):
    """What limits the torque inside a window."""

    FULL = "full"
    """w = 1 wherever the schedule's g is not identically zero: every torque a law makes fits in it."""
    GAIN = "gain"
    """w = g: the peak of a law is then sup |u| with torque = g u."""


@final
@dataclass(frozen=True)
class Terminal:
    """How close to rest at the target the transfer must end: Euclidean balls, 0 for exactly.

    Attributes
    ----------
    attitude : Fraction
        Largest |bv| = |sin(Phi/2)| allowed, below 1; either quaternion sign.
    rate : Fraction
        Largest |w| allowed, rad/s.
    """

    attitude: Fraction = Fraction(0)
    rate: Fraction = Fraction(0)

    def __post_init__(self) -> None:
        if not 0 <= self.attitude < 1:
            raise ValueError(
                f"terminal attitude tolerance is |bv|, in [0, 1): received {float(self.attitude):g}"
            )
        if self.rate < 0:
            raise ValueError(f"terminal rate tolerance must be >= 0 rad/s: received {float(self.rate):g}")

    @property
    def is_exact(self) -> bool:
        """Whether the transfer must end exactly at rest at the target."""
        return self.attitude == 0 and self.rate == 0


@final
@dataclass(frozen=True)
class TransferProblem:
    """One transfer through windows, exact.

    Attributes
    ----------
    body : RigidBody
        Inertia.
    window : PiecewisePolynomial
        w(t) on [0, horizon], between 0 and 1, dimensionless; gaps are explicit zero pieces.
    attitude : four Fraction
        Start quaternion, scalar first, of any length > 0: the attitude is that of its direction
        (so that rational data describe an attitude exactly).
    rate : three Fraction
        Start rate, rad/s, body frame.
    norm : Norm
        How torque is measured.
    terminal : Terminal
        Terminal tolerances.
    signs : tuple of +1 and -1
        Target quaternion signs to consider: the same attitude, reached from the two sides.
    """

    body: RigidBody
    window: PiecewisePolynomial
    attitude: Quaternion
    rate: Vector = (Fraction(0), Fraction(0), Fraction(0))
    norm: Norm = EUCLIDEAN
    terminal: Terminal = field(default_factory=Terminal)
    signs: tuple[int, ...] = (1, -1)

    def __post_init__(self) -> None:
        if len(self.attitude) != 4 or not any(self.attitude):
            raise ValueError("start attitude must be a quaternion of four numbers, not all zero")
        if len(self.rate) != 3:
            raise ValueError(f"start rate must have three numbers (rad/s), received {len(self.rate)}")
        if self.window.knots[0] != 0:
            raise ValueError(
                f"the window profile must start at 0 s, received {float(self.window.knots[0]):g} s"
            )
        if not self.signs or any(s not in (1, -1) for s in self.signs):
            raise ValueError(f"target signs must be +1 or -1, received {self.signs}")

    @classmethod
    def through(
        cls,
        schedule: Schedule,
        *,
        body: RigidBody,
        horizon: Number,
        attitude: Sequence[Number],
        rate: Sequence[Number] = (0, 0, 0),
        norm: Norm | None = None,
        terminal: Terminal | None = None,
        profile: WindowProfile = WindowProfile.FULL,
    ) -> TransferProblem:
        """State the transfer for a schedule, from t = 0 to `horizon` (s)."""
        q = tuple(Fraction(x) for x in attitude)
        w = tuple(Fraction(x) for x in rate)
        if len(q) != 4:
            raise ValueError(f"start attitude must have four numbers (scalar first), received {len(q)}")
        if len(w) != 3:
            raise ValueError(f"start rate must have three numbers (rad/s), received {len(w)}")
        return cls(
            body=body,
            window=window_profile(schedule, Fraction(horizon), profile),
            attitude=(q[0], q[1], q[2], q[3]),
            rate=(w[0], w[1], w[2]),
            norm=norm or EUCLIDEAN,
            terminal=terminal or Terminal(),
        )

    @classmethod
    def of(
        cls,
        mission: Mission,
        norm: Norm,
        *,
        horizon: Fraction | None = None,
        terminal: Terminal | None = None,
        profile: WindowProfile = WindowProfile.FULL,
    ) -> TransferProblem:
        """State a mission's transfer for any controller whatever, on the nominal body.

        Parameters
        ----------
        mission : Mission
            Body, schedule and start.
        norm : Norm
            How torque is measured.
        horizon : Fraction, optional
            Transfer time, s; the mission's horizon without one.
        terminal : Terminal, optional
            How near to rest at the target it must end; the mission's tolerances without one.
        profile : WindowProfile
            What limits the torque inside a window.
        """
        settled = mission.tolerance
        return cls.through(
            mission.schedule,
            body=mission.body,
            horizon=mission.horizon if horizon is None else horizon,
            attitude=mission.start.exact_quaternion,
            rate=mission.start.exact_rate,
            norm=norm,
            terminal=Terminal(settled.attitude, settled.rate) if terminal is None else terminal,
            profile=profile,
        )

    @property
    def horizon(self) -> Fraction:
        """Transfer time tf, s."""
        return self.window.knots[-1]

    def until(self, horizon: Fraction) -> TransferProblem:
        """State the same transfer with an earlier (or the same) transfer time.

        Raises
        ------
        ValueError
            If the horizon is not in (0, the problem's own].
        """
        if not 0 < horizon <= self.horizon:
            raise ValueError(
                f"the transfer time must be in (0, {float(self.horizon):g}] s, received {float(horizon):g} s"
            )
        pieces = [_cut(piece, horizon) for piece in self.window.pieces if piece.start < horizon]
        knots = (Fraction(0), *(piece.end for piece in pieces))
        window = PiecewisePolynomial(knots, tuple(piece.shape for piece in pieces))
        return replace(self, window=window)

    def without_idle(self) -> tuple[TransferProblem, Fraction]:
        """State the same transfer without long idle ends; and the instant, s, from which its time counts.

        Both cuts are exact. A body at rest stays so while no torque acts: the transfer may begin with the
        first window. Without torque |J w| is constant: one that must end exactly at rest is at rest since the
        last window, so the transfer may end with it. Ends shorter than the windows' own span stay, so that
        ordinary transfers keep their time.
        """
        if not self.open_pieces:
            return self, Fraction(0)
        first, last = self.open_pieces[0].start, self.open_pieces[-1].end
        span = last - first
        shorter = self
        if self.terminal.rate == 0 and self.horizon - last > span:
            shorter = self.until(last)
        if not self.starts_at_rest or first <= span:
            return shorter, Fraction(0)
        return shorter.from_instant(first, self.attitude, self.rate), first

    def from_instant(self, instant: Fraction, attitude: Quaternion, rate: Vector) -> TransferProblem:
        """State what is left of the transfer from a knot of the window profile on, from the state there."""
        pieces = [piece for piece in self.window.pieces if piece.start >= instant]
        knots = (Fraction(0), *(piece.end - instant for piece in pieces))
        window = PiecewisePolynomial(knots, tuple(piece.shape for piece in pieces))
        return replace(self, window=window, attitude=attitude, rate=rate)

    @cached_property
    def unit_attitude(self) -> Array:
        """Start quaternion as floats, unit length, (4,)."""
        q = np.array([float(x) for x in self.attitude])
        return np.asarray(q / np.linalg.norm(q))

    @cached_property
    def start_rate(self) -> Array:
        """Start rate as floats, (3,), rad/s."""
        return np.array([float(x) for x in self.rate])

    @cached_property
    def start_momentum(self) -> Array:
        """J w at the start as floats, (3,), N m s."""
        return self.body.inertia @ self.start_rate

    @property
    def starts_at_rest(self) -> bool:
        """Whether the start rate is exactly zero."""
        return not any(self.rate)

    @cached_property
    def angle(self) -> float:
        """Rotation angle from the start to the target on SO(3), in [0, pi], rad (float)."""
        q = self.unit_attitude
        return 2.0 * math.atan2(float(np.linalg.norm(q[1:])), abs(float(q[0])))

    @cached_property
    def open_pieces(self) -> tuple[Piece, ...]:
        """Pieces of w that are not identically zero, in order of time."""
        return tuple(piece for piece in self.window.pieces if piece.shape != ZERO)


def window_profile(schedule: Schedule, horizon: Fraction, profile: WindowProfile) -> PiecewisePolynomial:
    """w(t) on [0, horizon] of a schedule, exact; a piece that goes on beyond the horizon is cut there."""
    if horizon <= 0:
        raise ValueError(f"the transfer time must be > 0 s, received {float(horizon):g} s")
    if profile is WindowProfile.GAIN:
        pieces = [_cut(piece, horizon) for piece in schedule.pieces_between(Fraction(0), horizon)]
    else:
        pieces = []
        for window in schedule.support_between(Fraction(0), horizon):
            on, off = max(window.on, Fraction(0)), min(window.off, horizon)
            pieces.append(Piece(on, off, polynomial(1)))
    knots, shapes = [Fraction(0)], []
    for piece in pieces:
        if piece.start > knots[-1]:
            knots.append(piece.start)
            shapes.append(ZERO)
        knots.append(piece.end)
        shapes.append(piece.shape)
    if knots[-1] < horizon:
        knots.append(horizon)
        shapes.append(ZERO)
    return PiecewisePolynomial(tuple(knots), tuple(shapes))


def _cut(piece: Piece, horizon: Fraction) -> Piece:
    """Return the part of a piece before the horizon."""
    if piece.end <= horizon:
        return piece
    part = (horizon - piece.start) / piece.length
    return Piece(piece.start, horizon, compose_affine(piece.shape, Fraction(0), part))


def quaternion_from_axis_angle(axis: Sequence[float], angle: float) -> Quaternion:
    """Quaternion of a rotation by `angle` (rad) about `axis` (any length > 0): rational, near unit length."""
    length = math.sqrt(math.fsum(x * x for x in axis))
    if len(axis) != 3 or length == 0.0:
        raise ValueError(f"rotation axis must have three numbers, not all zero: received {list(axis)}")
    half = angle / 2
    x, y, z = (Fraction(math.sin(half) * a / length) for a in axis)
    return Fraction(math.cos(half)), x, y, z

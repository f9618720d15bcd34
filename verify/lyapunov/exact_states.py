"""States with rational coordinates, and V' there exactly.

Quaternions are taken on the rational points of the sphere: bv = s n with (b0, s) on the unit
circle and n on the unit sphere, both from rational parameters, so that |bv| is rational too and
laws that use it can be evaluated without rounding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

import casadi as ca

from ...models.closed_loop import INERTIA_ENTRIES, ClosedLoop
from ...models.laws import Expression
from ...models.lowering import FIELD, Program, evaluate, walk
from ..exact.matrix import Rows, inverse
from .candidates import Candidate


class IrrationalError(ArithmeticError):
    """A root of a number that is not the square of a rational."""


def exact_root(value: Fraction) -> Fraction:
    """Square root of the square of a rational."""
    if value < 0:
        raise IrrationalError("root of a negative number")
    root = Fraction(math.isqrt(value.numerator), math.isqrt(value.denominator))
    if root * root != value:
        raise IrrationalError(f"the root of {value} is not rational")
    return root


EXACT: Mapping[str, Any] = {**FIELD, "sqrt": exact_root, "fabs": abs, "fmin": min, "fmax": max}
"""Operations on rationals."""


@final
@dataclass(frozen=True)
class ExactState:
    """A state of a closed loop with rational coordinates.

    Attributes
    ----------
    quaternion : (4,), unit norm exactly
    rate : (3,), rad/s
    controller : controller states by name
    gain, gain_rate : g and g' (1/s)
    floor : k* = 1/R_min where the storage function has it, 1/s
    signals : the law's functions of time and their rates, in the order of `ClosedLoop.time`
    """

    quaternion: tuple[Fraction, ...]
    rate: tuple[Fraction, ...]
    controller: Mapping[str, Fraction]
    gain: Fraction
    gain_rate: Fraction
    floor: Fraction = Fraction(1)
    signals: tuple[Fraction, ...] = ()

    def __post_init__(self) -> None:
        if sum(x * x for x in self.quaternion) != 1:
            raise ValueError("the quaternion must have unit norm exactly")

    def floats(self) -> dict[str, float | list[float]]:
        """Nearest floats, by name."""
        values: dict[str, float | list[float]] = {
            "quaternion": [float(x) for x in self.quaternion],
            "rate": [float(x) for x in self.rate],
        }
        values |= {name: float(x) for name, x in self.controller.items()}
        return values | {"g": float(self.gain), "g_rate": float(self.gain_rate)}

    def claimed(self, signals: Sequence[str]) -> dict[str, object]:
        """Exact coordinates as a certificate states them."""
        timed = dict(zip((x for name in signals for x in (name, f"{name}_rate")), self.signals, strict=True))
        return {
            "quaternion": self.quaternion,
            "rate": self.rate,
            "controller": self.controller,
            "g": self.gain,
            "g_rate": self.gain_rate,
            "k_target": self.floor,
            **timed,
        }


@final
class ExactDerivative:
    """V', W and the claimed right side of a candidate at rational states."""

    def __init__(self, candidate: Candidate, inertia: Rows, *, weight: Fraction = Fraction(1)) -> None:
        loop = candidate.loop
        self._loop, self._weight = loop, weight
        rate = loop.total_derivative(candidate.value)  # by J^-1: a law's own word on kappa' is no evidence
        right = ca.SX.nan() if candidate.right_side is None else candidate.right_side
        self._has_right = candidate.right_side is not None
        extra = [x if x is not None else ca.SX.sym("unused") for x in (candidate.floor, candidate.weight)]
        self._program = program_of(
            loop, extra, [rate, candidate.reference, right if self._has_right else rate]
        )
        self._body = body_entries(inertia)

    def at(self, state: ExactState) -> tuple[Fraction, Fraction, Fraction]:
        """(V', W, claimed right side), exactly."""
        arguments = [*loop_arguments(self._loop, state, self._body), [state.floor], [self._weight]]
        rate, reference, right = evaluate(self._program, EXACT, arguments, Fraction)
        return rate[0], reference[0], right[0]


def program_of(loop: ClosedLoop, extra: Sequence[Expression], results: Sequence[Expression]) -> Program:
    """Program of expressions of a loop: arguments (state, time, parameters, body, *extra)."""
    return walk(ca.Function("exact", [*loop.arguments, *extra], list(results)))


def loop_arguments(loop: ClosedLoop, state: ExactState, body: Sequence[Fraction]) -> list[list[Fraction]]:
    """Arguments (state, time, parameters, body) of a loop's program at a rational state."""
    names = [s.name for s in loop.law.controller_states]
    controller = [state.controller[name] for name in names]
    time = [state.gain, state.gain_rate, *state.signals]
    if len(time) < loop.time.shape[0]:
        time += [Fraction(0)] * (loop.time.shape[0] - len(time))
    return [
        [*state.quaternion, *state.rate, *controller],
        time,
        list(loop.law.parameters.values()),
        list(body),
    ]


def body_entries(inertia: Rows) -> list[Fraction]:
    """Return the exact numbers of `ClosedLoop.body`: J's upper triangle, then that of J^-1."""
    return [M[i][j] for M in (inertia, inverse(inertia)) for i, j in INERTIA_ENTRIES]

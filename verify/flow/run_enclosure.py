"""One run enclosed: the state at given times, in balls that certainly hold it.

Interval Taylor steps in ball arithmetic (Moore 1966, ch. 8; Nedialkov, Jackson & Corliss 1999): the
coefficients of the solution come from the closed loop's own expressions, evaluated on truncated
series; the remainder from the same over a box that holds the solution during the step. The start
is one exact point, so the boxes' growth from step to step (the wrapping effect) stays small over
the first windows; where it does not, or the law uses an operation without a series, there is no
enclosure, and the run says so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

from flint import arb, arb_series, ctx

from ...models.closed_loop import INERTIA_ENTRIES, ClosedLoop, close_loop
from ...models.laws import Law
from ...models.lowering import FIELD, Program, UnknownOperationError, evaluate, shared, walk
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ...models.schedule.polynomial import derivative
from ...models.simulation import Phase, phases_between
from ..exact.ball import ball, horner

Balls = list[Any]
ORDER = 14
"""Terms of each step's Taylor polynomial; past it costs more than it lengthens the steps."""
LOCAL_ERROR = 1e-13
"""Remainder of a step that is aimed at, relative to each state or to 1."""
SLACK = 0.05
"""By how much the box of a step is wider than what the polynomial reaches in it."""
MAX_STEPS = 4000
WIDEST = 1e-3
"""Radius of a state, relative to it or to 1, beyond which the enclosure is given up."""

SERIES: Mapping[str, Callable[..., Any]] = {
    **FIELD,
    "inv": lambda x: x.inv(),
    "sqrt": lambda x: x.sqrt(),
    "exp": lambda x: x.exp(),
    "log": lambda x: x.log(),
    "sin": lambda x: x.sin(),
    "cos": lambda x: x.cos(),
    "tan": lambda x: x.tan(),
    "atan": lambda x: x.atan(),
}
"""Operations on truncated power series with ball coefficients."""


class NoEnclosureError(ArithmeticError):
    """No enclosure was reached; the message says where and why."""


@final
@dataclass(frozen=True)
class ExactStart:
    """A start with rational coordinates at t = 0: unit quaternion (4,), scalar first; rate (3,), rad/s."""

    quaternion: tuple[Fraction, ...]
    rate: tuple[Fraction, ...]


@final
class EnclosedRun:
    """The run of a law from an exact start, carried forward phase by phase.

    Parameters
    ----------
    law, body : the closed loop, without saturation, at the nominal inertia
    start : state at t = 0; controller states begin at the law's own values

    Raises
    ------
    UnknownOperationError
        If the law uses an operation that has no series here.
    """

    def __init__(self, law: Law, body: RigidBody, start: ExactStart) -> None:
        self._law = law
        ctx.cap = max(ctx.cap, ORDER + 1)  # no series is cut short
        loop = close_loop(law)
        self._rates, self._torque = _programs(loop)
        entries = [M[i][j] for M in (body.exact_inertia, body.exact_inverse) for i, j in INERTIA_ENTRIES]
        self._constants = [[_constant(x) for x in law.parameters.values()], [_constant(x) for x in entries]]
        exact = (*start.quaternion, *start.rate, *(s.initial for s in law.controller_states))
        self._state: Balls = [ball(x) for x in exact]

    @property
    def state(self) -> Balls:
        """State at the end of the last phase crossed, in the order of `ClosedLoop.state`."""
        return list(self._state)

    def torque_at(self, schedule: Schedule, until: Fraction) -> Balls:
        """Applied torque g u at a time > 0, s, as three balls, N m; may be asked once.

        Raises
        ------
        NoEnclosureError
            If the state could not be enclosed up to then.
        """
        phase = None
        for phase in phases_between(schedule, self._law, Fraction(0), until):
            self.cross(phase)
        assert phase is not None
        time = _time_series(phase, ball(until - phase.origin), 1)
        state = [arb_series([x], prec=1) for x in self._state]
        (torque,) = evaluate(self._torque, SERIES, [state, time, *self._constants], _constant)
        return [x[0] for x in torque]

    def cross(self, phase: Phase) -> None:
        """Carry the state from the start of a phase, where the last one ended, to its end.

        Raises
        ------
        NoEnclosureError
            If the state could not be enclosed up to there.
        """
        if phase.resets:
            raise NoEnclosureError(f"the law decides anew at t = {float(phase.start):g} s")
        now, step = phase.start, phase.end - phase.start
        for _ in range(MAX_STEPS):
            tau = ball(now - phase.origin)
            coefficients = self._coefficients(phase, self._state, tau, ORDER - 1)
            step = min(_rounded(_reach(coefficients)), 2 * step, phase.end - now)
            step = self._advance(phase, tau, coefficients, step)
            now += step
            if any(x.rad() > WIDEST * (1 + abs(x.mid())) for x in self._state):
                raise NoEnclosureError(f"the enclosure is too wide from t = {float(now):g} s on")
            if now == phase.end:
                return
        raise NoEnclosureError(f"{MAX_STEPS} steps do not reach beyond t = {float(now):g} s")

    def _advance(self, phase: Phase, tau: Any, coefficients: list[Balls], step: Fraction) -> Fraction:
        """Take a step, halved until a box holds the solution during it; return its length, s.

        While the solution is in the box, x(t) = sum c_k t^k + c_ORDER(some point of the box) t^ORDER.
        If that lies inside the box for all t of the step, the solution cannot leave it.
        """
        for _ in range(40):
            h, during = ball(step), _interval(step)
            reached = [horner(own, during) for own in coefficients]
            box = [x + arb(0, SLACK * (1e-6 + float(x.rad()))) for x in reached]
            try:
                rests = [own[ORDER] for own in self._coefficients(phase, box, tau + during, ORDER)]
            except NoEnclosureError:  # the box reaches a pole
                step /= 2
                continue
            held = [x + rest * during**ORDER for x, rest in zip(reached, rests, strict=True)]
            small = all(
                x.is_finite() and (rest * h**ORDER).rad() < LOCAL_ERROR * (1 + abs(x.mid()))
                for x, rest in zip(held, rests, strict=True)
            )
            if small and all(b.contains_interior(x) for x, b in zip(held, box, strict=True)):
                pairs = zip(coefficients, rests, strict=True)
                self._state = [horner(own, h) + rest * h**ORDER for own, rest in pairs]
                return step
            step /= 2
        at = float(tau.mid()) + float(phase.origin)
        raise NoEnclosureError(f"no step is short enough at t = {at:g} s")

    def _coefficients(self, phase: Phase, state: Balls, tau: Any, highest: int) -> list[Balls]:
        """Taylor coefficients 0 to `highest` of the solution through a box at local time tau.

        Raises
        ------
        NoEnclosureError
            If the box reaches a pole or a branch point of the state rate.
        """
        found: list[Balls] = [[x] for x in state]
        for order in range(1, highest + 1):
            series = [arb_series(list(own), prec=order) for own in found]
            time = _time_series(phase, tau, order)
            try:
                (rates,) = evaluate(self._rates, SERIES, [series, time, *self._constants], _constant)
            except UnknownOperationError:
                raise
            except (ValueError, ZeroDivisionError):
                raise NoEnclosureError("the state rate has no series here") from None
            for own, rate in zip(found, rates, strict=True):
                if rate.prec < order:
                    raise NoEnclosureError("a series was cut short")
                own.append(rate[order - 1] / order)
        if not all(x.is_finite() for own in found for x in own):
            raise NoEnclosureError("the state rate has no series here")
        return found


def _programs(loop: ClosedLoop) -> tuple[Program, Program]:
    """(state rate, applied torque) of (state, time, parameters, body)."""
    rates, torque = loop.function("rates", loop.state_rate), loop.function("torque", loop.applied_torque)
    return shared(walk(rates)), shared(walk(torque))


def _constant(value: Fraction | float) -> Any:
    return arb_series([ball(value)], prec=ORDER + 1)


def _time_series(phase: Phase, tau: Any, order: int) -> list[Any]:
    """g, g', then each signal and its rate, as series about a local time tau."""
    variable = arb_series([tau, 1], prec=order)
    return [
        horner([_constant(c) for c in row], variable)
        for coefficients in phase.coefficients
        for row in (coefficients, derivative(coefficients))
    ]


def _interval(step: Fraction) -> Any:
    """The ball [0, step]."""
    half = ball(step / 2)
    return half + half * arb(0, 1)


def _reach(coefficients: list[Balls]) -> float:
    """Step for which the last term would be about LOCAL_ERROR, s."""
    worst = max(float(abs(own[ORDER - 1].mid())) / (1 + float(abs(own[0].mid()))) for own in coefficients)
    return float("inf") if worst == 0 else (LOCAL_ERROR / worst) ** (1 / (ORDER - 1))


def _rounded(step: float) -> Fraction:
    """A short binary fraction, so that times stay short."""
    return Fraction(round(min(step, 1e6) * 2**20) or 1, 2**20)

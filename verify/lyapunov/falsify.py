"""Falsifier: a multi-start gradient search for a state and a schedule phase with V' > 0.

Coordinates in which V'/W is smooth down to the equilibrium and of order one for every body: half
the error angle theta on a logarithmic scale, its axis, J^(1/2) Omega/theta, controller states, and
the time within one piece of the schedule. A violation found in floats is moved to rationals and
evaluated again exactly; only then is it one. Finding none proves nothing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

import casadi as ca
import numpy as np

from ...models.closed_loop import body_values
from ...models.laws import Expression
from ...models.lowering import evaluate
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ...models.types import Array
from ..exact.direction import near, rational_quaternion
from ..verdict import Witness
from .candidates import Candidate
from .exact_states import EXACT, ExactState, loop_arguments, program_of
from .refutation import Refutation, at_state
from .search_units import SearchUnits, inverse_root

MIN_ANGLE = 1e-3
"""Least half error angle searched, rad: V'/W tends to its limit at the equilibrium like its square."""
ROUNDING = 1e-12
"""Values of V'/W (1/s) below this are rounding."""
MAX_RATIO = 20.0
"""Largest component of J^(1/2) Omega over half the error angle, in the unit of `SearchUnits.ratio`."""


@final
@dataclass(frozen=True, kw_only=True)
class Falsifier:
    """How to search: random points, of which the best start a gradient search on each piece of g.

    Attributes
    ----------
    points : random states tried on each piece
    starts : how many of them start a search
    seed : of the random states
    largest : upper end of the controller states searched, in units of the start (see `SearchUnits`)
    """

    points: int = 400
    starts: int = 8
    seed: int = 1
    largest: float = 5.0

    def __post_init__(self) -> None:
        if self.points < 1 or not 1 <= self.starts <= self.points or self.largest <= 1:
            raise ValueError("falsifier: expected points >= starts >= 1 and largest > 1")


@final
@dataclass(frozen=True)
class Falsification:
    """What the search found.

    Attributes
    ----------
    worst : largest V'/W found, 1/s, in floats; violations that exact evaluation denies are left out
    refutation : exact state with V' > 0, or None
    evaluations : how often V' was evaluated
    reason : why a violation seen in floats has no exact witness, if so
    """

    worst: float
    refutation: Refutation | None
    evaluations: int
    reason: str = ""

    @property
    def witness(self) -> Witness | None:
        """The state as a witness against V' <= 0."""
        return None if self.refutation is None else self.refutation.witness

    @property
    def summary(self) -> str:
        """The search in a few words."""
        return (
            self.reason
            or f"a gradient search of {self.evaluations} evaluations found V'/W <= {self.worst:.3g} 1/s"
        )


def falsify(
    candidate: Candidate,
    body: RigidBody,
    *,
    schedule: Schedule | None = None,
    weight: Fraction = Fraction(1),
    options: Falsifier | None = None,
) -> Falsification:
    """Search for V' > 0.

    Parameters
    ----------
    candidate : Candidate
        The storage function, its law and what is claimed of V'.
    body : RigidBody
        The body.
    schedule : Schedule or None
        Phases to search, one piece after another; without it a smooth unit pulse of a unit of time.
    weight : Fraction
        The weight a where the storage function leaves it free.
    options : Falsifier, optional
        How hard to search; its defaults without one.
    """
    options = options or Falsifier()
    search = _Search(candidate, body, weight, options)
    for coefficients, length in _pieces(schedule, 1 / search.units.target):
        search.on_piece(coefficients, length)
    search.found.sort(key=lambda item: -item[0])
    reason, spurious = "", 0
    for value, z, coefficients in search.found:
        if value <= ROUNDING:
            break
        refutation, reason = search.exact_refutation(z, coefficients)
        if refutation is not None:
            return Falsification(value, refutation, search.evaluations)
        spurious += 1  # cancellation in floats: no violation at the exact state
    values = [value for value, _, _ in search.found[spurious:]]
    return Falsification(values[0] if values else search.found[0][0], None, search.evaluations, reason)


def _pieces(schedule: Schedule | None, time: Fraction) -> list[tuple[tuple[Fraction, ...], Fraction]]:
    """Distinct pieces of g: coefficients in the time since its start, and duration."""
    if schedule is None:
        return [((Fraction(0), Fraction(0), 3 / time**2, -2 / time**3), time), ((), time)]
    profile = schedule.profile
    return list({(piece.local_coefficients(), piece.length) for piece in profile.pieces})


class _Search:
    """One search: the objective, its gradient, and what was found so far."""

    def __init__(self, candidate: Candidate, body: RigidBody, weight: Fraction, options: Falsifier) -> None:
        self._candidate, self._body, self._weight, self._options = candidate, body, weight, options
        self._states = [s.name for s in candidate.loop.law.controller_states]
        self._signals = candidate.loop.time.shape[0] - 2
        self._random = np.random.default_rng(options.seed)
        self._root = inverse_root(body)
        self.units = SearchUnits.of(candidate, body, weight)
        self._objective, self._gradient = _objective(candidate, body, weight, self.units)
        self.evaluations = 0
        self.found: list[tuple[float, Array, tuple[Fraction, ...]]] = []

    def on_piece(self, coefficients: tuple[Fraction, ...], length: Fraction) -> None:
        """Search one piece of g."""
        from scipy.optimize import minimize

        if len(coefficients) > DEGREE + 1:  # searched by its first terms; a violation is evaluated exactly
            coefficients = coefficients[: DEGREE + 1]
        padded = np.zeros(DEGREE + 2)
        padded[: len(coefficients)] = [float(c * length**i) for i, c in enumerate(coefficients)]
        padded[-1] = float(length)
        low, high = self._bounds()
        points = low + (high - low) * self._random.random((self._options.points, len(low)))
        values = np.array([float(self._objective(p, padded)) for p in points])
        self.evaluations += len(points)
        order = np.argsort(values)
        # the search stops by the size of its steps and slopes: rates may be 1e-3 or 1e3 1/s
        size = float(np.median(np.abs(values))) or 1.0
        for start in points[order[: self._options.starts]]:
            result = minimize(
                lambda z: (
                    float(self._objective(z, padded)) / size,
                    np.asarray(self._gradient(z, padded)).ravel() / size,
                ),
                start,
                jac=True,
                method="L-BFGS-B",
                bounds=list(zip(low, high, strict=True)),
            )
            self.evaluations += int(result.nfev)
            x = np.asarray(result.x)
            self.found.append((-float(result.fun) * size, self._restored(x, float(length)), coefficients))

    def _bounds(self) -> tuple[Array, Array]:
        """Box of (log theta, axis (3), J^(1/2) Omega/theta (3), states, signals, time), in units."""
        largest = self._options.largest
        low = [math.log(MIN_ANGLE), -1, -1, -1, *[-MAX_RATIO] * 3]
        high = [math.log(math.pi), 1, 1, 1, *[MAX_RATIO] * 3]
        above_floor = self._candidate.floor is not None
        for name in self._states:
            floor = float(1 / self.units.target / self.units.states[name]) if above_floor else 0.05
            low.append(floor if name == "R" else 0.0)
            high.append(largest)
        low += [-1.0] * self._signals + [0.0]
        high += [1.0] * self._signals + [1.0]
        return np.array(low), np.array(high)

    def _restored(self, z: Array, length: float) -> Array:
        """Coordinates in the units of the law."""
        states = [float(self.units.states[name]) for name in self._states]
        sizes = np.array([1.0] * 4 + [self.units.ratio] * 3 + states + [1.0] * self._signals + [length])
        return np.asarray(z * sizes)

    def exact_refutation(self, z: Array, coefficients: Sequence[Fraction]) -> tuple[Refutation | None, str]:
        """Move a violation to rationals and evaluate V' there."""
        J = [list(row) for row in self._body.exact_inertia]
        try:
            found = at_state(self._candidate, J, self._weight, self._exact_state(z, coefficients))
        except (ArithmeticError, ValueError) as error:
            return None, f"V' > 0 was seen in floats but could not be evaluated exactly: {error}"
        if found is None:
            return None, "V' > 0 was seen in floats but not at the rational state beside it"
        return found, ""

    def _exact_state(self, z: Array, coefficients: Sequence[Fraction]) -> ExactState:
        theta = math.exp(z[0])
        axis = z[1:4] / np.linalg.norm(z[1:4])
        quaternion = rational_quaternion([math.cos(theta), *(math.sin(theta) * axis)])
        omega = [near(float(x), 10**9) for x in theta * (self._root @ z[4:7])]
        end = 7 + len(self._states)
        controller = {name: near(float(x), 10**6) for name, x in zip(self._states, z[7:end], strict=True)}
        if self._candidate.floor is not None and "R" in controller:
            controller["R"] = max(controller["R"], 1 / self.units.target)
        tau = near(float(z[-1]), 10**6)
        gain = sum((c * tau**i for i, c in enumerate(coefficients)), Fraction(0))
        gain_rate = sum((i * c * tau ** (i - 1) for i, c in enumerate(coefficients) if i), Fraction(0))
        signals = tuple(Fraction(float(x)).limit_denominator(10**6) for x in z[end:-1])
        state = ExactState(quaternion, tuple(omega), controller, gain, gain_rate, self.units.target, signals)
        shift = self._exact_shift(state)
        rate = tuple(x - y for x, y in zip(omega, shift, strict=True))
        return ExactState(quaternion, rate, controller, gain, gain_rate, self.units.target, signals)

    def _exact_shift(self, state: ExactState) -> list[Fraction]:
        loop = self._candidate.loop
        program = program_of(loop, [], [self._candidate.shift])
        body = [Fraction(0)] * 12  # the shift does not use the inertia
        return evaluate(program, EXACT, loop_arguments(loop, state, body), Fraction)[0]


DEGREE = 7
"""Largest degree of a piece of g that the search takes."""


def _objective(
    candidate: Candidate, body: RigidBody, weight: Fraction, units: SearchUnits
) -> tuple[Any, Any]:
    """-V'/W and its gradient: CasADi functions of the coordinates, and of g's coefficients and duration."""
    loop = candidate.loop
    signals = loop.time.shape[0] - 2
    n = len(loop.controller_states)
    z, coefficients = ca.SX.sym("z", 7 + n + signals + 1), ca.SX.sym("coefficients", DEGREE + 2)
    theta, axis = ca.exp(z[0]), z[1:4] / ca.sqrt(ca.sumsqr(z[1:4]) + 1e-12)
    tau = z[-1]
    g = sum((coefficients[i] * tau**i for i in range(DEGREE + 1)), ca.SX(0))
    replaced: dict[str, Expression] = {"b0": ca.cos(theta), "bv": ca.sin(theta) * axis}
    rate = loop.total_derivative(candidate.value) if candidate.derivative is None else candidate.derivative
    reference = ca.SX(candidate.reference)
    symbols = [loop.plant.b0, loop.plant.bv, *loop.controller_states.values(), loop.time]
    time = ca.vertcat(g, ca.jacobian(g, tau) / coefficients[-1], z[7 + n : 7 + n + signals])
    values = [
        replaced["b0"],
        replaced["bv"],
        *(z[7 + i] * float(u) for i, u in enumerate(units.states.values())),
        time,
    ]
    for symbol, number in ((candidate.floor, units.target), (candidate.weight, weight)):
        if symbol is not None:
            symbols, values = [*symbols, symbol], [*values, ca.SX(float(number))]
    symbols = [*symbols, loop.parameters, loop.body]
    values = [*values, ca.SX(loop.parameter_values()), ca.SX(body_values(body))]
    w = theta * units.ratio * ca.mtimes(ca.DM(inverse_root(body)), z[4:7]) - ca.SX(candidate.shift)
    rate, reference = ca.substitute([ca.SX(rate), reference], [loop.plant.w], [w])
    rate, reference = ca.substitute([rate, reference], symbols, values)
    # the small terms keep the ratio finite where W vanishes; they lower it by less than 1e-4 of itself
    value = -rate / (ca.fabs(reference) + units.reference * (1e-6 * ca.sin(theta) ** 2 + 1e-14))
    arguments = [z, coefficients]
    return ca.Function("f", arguments, [value]), ca.Function("df", arguments, [ca.gradient(value, z)])

"""What a law is, read off its equations: whether its R is the filter, and which theorem covers it.

A law's name, its class and what it says of itself are no evidence: a class derived from a built-in one may
override anything. Its expressions are compared as polynomials, in exact rationals, with the equations that a
theorem is about.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.closed_loop import ClosedLoop, close_loop
from ...models.laws import LAWS, Expression, Law
from ...models.laws.scaled import filter_rate
from .. import checker
from ..certificates.format import as_text
from ..certificates.program import NotAlgebraicError
from ..exact.polynomial import NotPolynomialError
from ..lyapunov.forms import law_form
from ..lyapunov.normal_form import vanishes


class NoComparisonError(ValueError):
    """A law that no comparison theorem covers, with the reason."""


@final
@dataclass(frozen=True)
class ComparedLaw:
    """A law of the family Omega = w + 2 g^2 kappa bv, with the numbers that stand in its equations.

    Attributes
    ----------
    adaptive : kappa is the state k, else 1/R
    decay : lambda, 1/s, > 0
    learning_rate, weight : gamma, 1/(kg m^2 s), and a, kg m^2/s^2, > 0; zero where kappa = 1/R
    initial_filter, initial_gain : R(0), s, > 0, and k(0), 1/s, >= 0
    """

    adaptive: bool
    decay: Fraction
    learning_rate: Fraction
    weight: Fraction
    initial_filter: Fraction
    initial_gain: Fraction


@contextmanager
def checked_law(law: Law) -> Iterator[checker.Node]:
    """Write a law down as the stand-alone checker reads it: {"law": its program, "parameters": its numbers}.

    Raises
    ------
    NoComparisonError
        If the law resets its states or is not algebraic, and whatever `checker.Invalid` is raised within.
    """
    if has_resets(law):
        raise NoComparisonError(f"{law_words(law)} resets its states: no comparison theorem covers a jump")
    try:
        form = law_form(close_loop(law))
        yield checker.Node(as_text({"law": form, "parameters": law.parameters}), "law")
    except (NotAlgebraicError, checker.Invalid) as error:
        raise NoComparisonError(f"no comparison theorem covers {law_words(law)}: {error}") from None


def compared_law(law: Law) -> ComparedLaw:
    """Return which law of the family this is.

    Raises
    ------
    NoComparisonError
        If its equations are not those of the family, its states jump, or its initial values or
        parameters are not covered.
    """
    states = sorted(state.name for state in law.controller_states)
    if states not in (["R"], ["R", "k"]):
        raise NoComparisonError(
            f"no comparison theorem covers {law_words(law)}: its controller states are "
            f"{', '.join(states) if states else 'none'}, those of the theorems R, or R and k"
        )
    gamma = weight = Fraction(0)
    with checked_law(law) as data:
        scaled = checker.read_scaled(data)
        adaptive = "k" in scaled.loop.states
        if adaptive:
            gamma, weight = checker.gain_numbers(scaled)
    loop = close_loop(law)
    kappa = loop.controller_states["k"] if adaptive else 1 / loop.controller_states["R"]
    if loop.control.gain is None or not _vanishes(loop, loop.control.gain - kappa):
        raise NoComparisonError(
            f"no comparison theorem covers {law_words(law)}: the gain it states (Control.gain) is not the "
            f"kappa = {'k' if adaptive else '1/R'} of its torque"
        )
    start = {state.name: Fraction(state.initial) for state in law.controller_states}
    if start["R"] <= 0 or start.get("k", Fraction(0)) < 0:
        raise NoComparisonError(f"{law_words(law)}: a proof needs R(0) > 0 and k(0) >= 0")
    return ComparedLaw(adaptive, scaled.lam, gamma, weight, start["R"], start.get("k", Fraction(0)))


def follows_filter(loop: ClosedLoop) -> bool:
    """Whether the law's state R obeys R' = -lambda R + g^2 (1 + b0), as polynomials, and never jumps."""
    R, decay = loop.controller_states.get("R"), loop.parameter_symbols.get("lambda")
    if R is None or decay is None or has_resets(loop.law):
        return False
    expected = filter_rate(loop.plant, loop.time_symbols, R, decay)
    return _vanishes(loop, loop.control.state_rates["R"] - expected)


def _vanishes(loop: ClosedLoop, expression: Expression) -> bool:
    """Whether an expression is seen to be the zero polynomial in the loop's symbols."""
    try:
        return vanishes(loop, expression)
    except (NotAlgebraicError, NotPolynomialError):
        return False


def has_resets(law: Law) -> bool:
    """Whether a law may reset its states at instants of its own."""
    return "reset_instants" in vars(law) or type(law).reset_instants is not Law.reset_instants


def law_words(law: Law) -> str:
    """Name of a law for messages: a built-in one's own, else that of its class."""
    return f"law {law.name}" if LAWS.get(law.name) is type(law) else f"law {type(law).__name__}"

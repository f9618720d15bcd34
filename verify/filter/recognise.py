"""Which law a law is: what is proved of it rests on its equations as polynomials, never on name or class."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final

from ...models.closed_loop import ClosedLoop, close_loop
from ...models.laws import Law
from ...models.laws.scaled import filter_rate
from .. import checker
from ..certificates.format import as_text
from ..certificates.program import NotAlgebraicError, write_lines
from ..lyapunov.forms import law_form, symbol_names

INITIAL = {"R": "R0", "k": "k0"}
"""The parameter that each controller state of the family starts from."""


def follows_filter(loop: ClosedLoop) -> bool:
    """Whether the law's state R obeys R' = -lambda R + g^2 (1 + b0), as polynomials; its name is no proof."""
    R, decay = loop.controller_states.get("R"), loop.parameter_symbols.get("lambda")
    if R is None or decay is None:
        return False
    expected = filter_rate(loop.plant, loop.time_symbols, R, decay)
    symbols = symbol_names(loop)
    try:
        lines = write_lines(symbols, [loop.control.state_rates["R"] - expected])
        ring = checker.Ring(list(symbols))
        program = checker.Node(list(lines.instructions), "filter")
        values = checker.run(program, ring, {name: ring.symbol(name) for name in symbols})
    except (NotAlgebraicError, checker.Invalid):
        return False
    return not values[lines.results[0][0]].terms


@final
@dataclass(frozen=True)
class Recognised:
    """What a law was found to be.

    Attributes
    ----------
    kind : "persistence-filter" or "adaptive-scaling" if its torque, its controller rates and its initial
        controller states are that law's, identically; else None
    reason : why it is neither; empty if it is one
    form : the law as certificates write it; empty if it is neither
    """

    kind: str | None
    reason: str
    form: dict[str, Any]


@lru_cache(maxsize=64)
def recognise(law: Law) -> Recognised:
    """Compare a law with the two whose comparison systems are proved, as polynomials in every symbol.

    Neither the law's class nor its name counts: a class that derives from a built-in law and changes its
    torque is another law, and a law of the user's own with the same equations is the same law.
    """
    name = type(law).__name__
    if _resets(law):
        return Recognised(None, f"law {name} resets its states, which no comparison system here covers", {})
    try:
        form = law_form(close_loop(law))
        kind = checker.family_of(checker.Node(as_text(form), "law"))
    except (NotAlgebraicError, checker.Invalid) as error:
        return Recognised(None, f"law {name}: {error}", {})
    if kind is None:
        what = "its torque and controller rates are not those of persistence-filter or adaptive-scaling"
        return Recognised(None, f"no comparison system is known for law {name}: {what}", {})
    for state in law.controller_states:
        if state.initial != law.parameters[INITIAL[state.name]]:
            reason = f"law {name}: {state.name} does not start at its parameter {INITIAL[state.name]}"
            return Recognised(None, reason, {})
    return Recognised(kind, "", form)


def _resets(law: Law) -> bool:
    """Whether a law may reset its states: it has hooks of its own for that, in its class or on itself."""
    hooks = ("reset_instants", "reset")
    own = getattr(law, "__dict__", {})
    return any(getattr(type(law), hook) is not getattr(Law, hook) or hook in own for hook in hooks)

"""What `spacecraft.inertia_tolerance` means for a claim: every inertia within it, and the law knows which."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ...models.laws import Law
from ...scenario import Scenario
from ...verify.verdict import Claim

WIDENED = (
    "filter.floor",
    "convergence",
    "torque.limit",
    "lyapunov.derivative",
    "lambda.paper",
    "lambda.sharp",
    "lambda.rate",
)
"""Keys of the claims that are decided over the whole tolerance."""


def say_inertia(claims: Iterable[Claim], scenario: Scenario, law: Law) -> tuple[Claim, ...]:
    """Add to each widened claim's statement which inertias it speaks of, and whether the law knows them."""
    if scenario.inertia_tolerance is None:
        return tuple(claims)
    words = "; for every inertia within spacecraft.inertia_tolerance"
    if _uses_inertia(law):
        words += ", which the law knows and computes with (for a law that does not: [uncertainty])"
    return tuple(replace(c, statement=c.statement + words) if c.key in WIDENED else c for c in claims)


def _uses_inertia(law: Law) -> bool:
    """Whether the law's torque or its states' rates depend on the inertia."""
    import casadi as ca

    from ...models.closed_loop import close_loop

    loop = close_loop(law)
    terms = [ca.SX(loop.control.torque), *(ca.SX(rate) for rate in loop.control.state_rates.values())]
    return bool(ca.depends_on(ca.veccat(*terms), loop.body))

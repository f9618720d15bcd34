"""Whether a law's state R is the persistence filter: claims about R rest on its rate, not on its name."""

from __future__ import annotations

from ...models.closed_loop import ClosedLoop
from ...models.laws.scaled import filter_rate
from .. import checker
from ..certificates.program import NotAlgebraicError, write_lines
from ..lyapunov.forms import symbol_names


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

"""Laws and storage functions in the words of a certificate: names, instructions, where results stand."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import casadi as ca

from ...models.closed_loop import INERTIA_NAMES, PLANT_STATES, ClosedLoop
from ...models.laws import LAWS, Expression
from ..certificates.program import NotAlgebraicError, write_lines
from .candidates import Candidate

FLOOR = "k_target"
WEIGHT = "weight"


def symbol_names(loop: ClosedLoop) -> dict[str, Expression]:
    """Scalar symbols of a loop by the names certificates use (J^-1 has none: proofs do without)."""
    symbols = {name: loop.state[i] for i, name in enumerate(PLANT_STATES)}
    symbols |= dict(loop.controller_states)
    symbols |= {"g": loop.time_symbols.g, "g_rate": loop.time_symbols.g_rate}
    for name, signal in loop.time_symbols.signals.items():
        symbols |= {name: signal, f"{name}_rate": loop.time_symbols.signal_rates[name]}
    symbols |= dict(loop.parameter_symbols)
    return symbols | {name: loop.body[i] for i, name in enumerate(INERTIA_NAMES)}


def law_form(loop: ClosedLoop) -> dict[str, object]:
    """Law as certificate data: designated torque and controller rates as instructions.

    A name only annotates: it is written where the law is a built-in one.

    Raises
    ------
    NotAlgebraicError
        If the law uses more than + - * /, or says what becomes of its torque: a proof is about g u alone.
    """
    control = loop.control
    if control.thrust is not None or control.disturbance is not None:
        raise NotAlgebraicError(
            "it says itself what its thrusters make of its torque (Control.thrust, Control.disturbance), "
            "and proofs speak of a body on which g u acts"
        )
    rates = [control.state_rates[name] for name in loop.controller_states]
    lines = write_lines(symbol_names(loop), [ca.SX(control.torque), *(ca.SX(r) for r in rates)])
    law = loop.law
    return {
        **({"name": law.name} if LAWS.get(law.name) is type(law) else {}),
        "parameters": list(loop.parameter_symbols),
        "states": list(loop.controller_states),
        "signals": list(loop.time_symbols.signals),
        "program": list(lines.instructions),
        "torque": list(lines.results[0]),
        "rates": {n: r[0] for n, r in zip(loop.controller_states, lines.results[1:], strict=True)},
    }


def storage_form(
    candidate: Candidate, *, weight: Fraction | None = None, identity: bool = False
) -> dict[str, object]:
    """Storage function as part of a claim.

    Parameters
    ----------
    candidate : Candidate
        The storage function and its law.
    weight : Fraction or None
        Settles a free weight a.
    identity : bool
        Whether the claim is about the stated right side of V', or about W.

    Raises
    ------
    NotAlgebraicError
        If an expression uses more than + - * /.
    """
    symbols = symbol_names(candidate.loop)
    if candidate.floor is not None:
        symbols[FLOOR] = candidate.floor
    if candidate.weight is not None:
        symbols[WEIGHT] = candidate.weight
    other: Expression = candidate.right_side if identity else candidate.reference
    momentum = candidate.momentum_gradient
    lines = write_lines(symbols, [candidate.value, other, *([] if momentum is None else [momentum])])
    shift = write_lines({k: v for k, v in symbols.items() if k not in PLANT_STATES[4:]}, [candidate.shift])
    form: dict[str, object] = {
        "shift_program": list(shift.instructions),
        "shift": list(shift.results[0]),
        "program": list(lines.instructions),
        "value": lines.results[0][0],
        "right_side" if identity else "reference": lines.results[1][0],
    }
    if momentum is not None:
        form["momentum_gradient"] = list(lines.results[2])
    if candidate.weight is not None and weight is not None:
        form["weight"] = weight
    return form


def inertia_data(
    inertia: tuple[tuple[Fraction, ...], ...], tolerance: tuple[tuple[Fraction, ...], ...] | None
) -> dict[str, object]:
    """Inertia, and its tolerance if any entry has one, as certificate data."""
    data: dict[str, object] = {"inertia": inertia}
    if tolerance is not None and any(x > 0 for row in tolerance for x in row):
        data["inertia_tolerance"] = tolerance
    return data


def parameter_data(loop: ClosedLoop) -> Mapping[str, Fraction]:
    """Exact parameters of the law as certificate data."""
    return loop.law.parameters

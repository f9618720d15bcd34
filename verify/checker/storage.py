"""A storage function and its derivative along the closed loop."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from .closed_loop import RATE, Loop, along, move
from .exact_numbers import require
from .known_laws import true_name
from .matrices import inverse_matrix
from .polynomials import Poly, Triple, apply, on_sphere, pick, run, total
from .reading import Node


@dataclass(frozen=True)
class Derivative:
    """V and its derivative along the closed loop, the reference W, and the shift y - w."""

    value: Poly
    rate: Poly
    outputs: dict[str, Poly]
    shift: Triple


def differentiate(loop: Loop, law: Node, storage: Node) -> Derivative:
    """Derive V' from the law, the storage function and the equations of the rigid body."""
    ring, symbols = loop.ring, loop.symbols
    free = run(storage["shift_program"], ring, symbols)
    shift = [pick(free, place) for place in storage["shift"].items()]
    plain = len(shift) == 3 and not any(_uses_a_rate(loop, p) for p in shift)
    require(plain, "the shift must be three functions of the state, g and the signals")
    true_name(loop, law)
    motion = move(loop, law, shift)
    known = {**symbols, **{f"w{i + 1}": motion.rate[i] for i in range(3)}}
    outputs = run(storage["program"], ring, known)
    value = on_sphere(pick(outputs, storage["value"]))
    require(not _uses_a_rate(loop, value), "the storage function must not use g' or the rate of a signal")
    gradient = _momentum_gradient(loop, storage, outputs, [value.derivative(name) for name in RATE])
    turning = total([gradient[i] * motion.momentum[i] for i in range(3)], ring)
    rate = along(value, motion.rates) + turning
    return Derivative(value, on_sphere(rate), outputs, shift)


def _uses_a_rate(loop: Loop, p: Poly) -> bool:
    return any(p.uses(f"{name}_rate") for name in ("g", *loop.signals))


def _momentum_gradient(loop: Loop, storage: Node, outputs: dict[str, Poly], gradient: Triple) -> Triple:
    """Return q with J q = dV/dy: as the file gives it, checked; or by the inverse of a numeric J."""
    if storage.has("momentum_gradient"):
        q = [pick(outputs, place) for place in storage["momentum_gradient"].items()]
        product = apply(loop.J, q, loop.ring)
        require(
            len(q) == 3 and all(not on_sphere(product[i] - gradient[i]).terms for i in range(3)),
            "J times the momentum gradient is not dV/dy",
        )
        return q
    one = loop.ring.one
    require(
        all(entry.terms.keys() <= {one} for row in loop.J for entry in row), "J has no inverse in symbols"
    )
    numbers = [[entry.terms.get(one, Fraction(0)) for entry in row] for row in loop.J]
    inverse = [[loop.ring.constant(x) for x in row] for row in inverse_matrix(numbers)]
    return apply(inverse, gradient, loop.ring)

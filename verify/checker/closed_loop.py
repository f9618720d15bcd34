"""The closed loop: rigid body, law and storage function."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from .exact_numbers import Invalid, Matrix, require
from .polynomials import TARGET, Exponents, Poly, Ring, Triple, apply, cross, on_sphere, pick, run, total
from .reading import Node

INERTIA = ("J11", "J12", "J13", "J22", "J23", "J33")
ATTITUDE = ("b1", "b2", "b3")
RATE = ("y1", "y2", "y3")
RESERVED = frozenset(
    (
        "b0",
        "w1",
        "w2",
        "w3",
        "u1",
        "u2",
        "u3",
        "V",
        "W",
        "c",
        "s",
        "g",
        "g_rate",
        "k_target",
        "weight",
        *ATTITUDE,
        *RATE,
        *INERTIA,
    )
)
"""Names that laws may not give to their states, signals and parameters."""


@dataclass(frozen=True)
class Loop:
    """Symbols of one closed loop, in the coordinates (c, b, y): c = 1 - b0, y = w + shift.

    Attributes
    ----------
    states, signals : names of the controller states, and of the law's functions of time
    J : entries of the inertia, symbols or numbers
    symbols : what programs may use, except the rate w
    """

    ring: Ring
    states: tuple[str, ...]
    signals: tuple[str, ...]
    J: Sequence[Sequence[Poly]]
    symbols: dict[str, Poly]


def read_loop(data: Node, storage: Node, *, symbolic: bool, J: Matrix | None) -> Loop:
    """Set up the symbols for a law: its parameters as positive symbols or numbers, J symbols or numbers."""
    law = data["law"]
    weight = storage["weight"].number() if storage.has("weight") else None
    states = tuple(node.text() for node in law["states"].items())
    signals = tuple(node.text() for node in law["signals"].items())
    parameters = [node.text() for node in law["parameters"].items()]
    timed = [name for signal in signals for name in (signal, f"{signal}_rate")]
    require_names([*states, *timed, *parameters])
    positive = ["k_target", *(["R"] if "R" in states else []), *(["weight", *parameters] if symbolic else [])]
    names = ["k_target", "s", *(["weight", *parameters] if symbolic else []), *states, "g", "g_rate", *timed]
    names += ["c", *ATTITUDE, *RATE, *(INERTIA if J is None else ())]
    ring = Ring(names, positive)
    symbols = {name: ring.symbol(name) for name in names if name not in ("c", "s", *RATE)}
    symbols["b0"] = ring.constant(1) - ring.symbol("c")
    for name in parameters:
        value = data["parameters"][name].number() if not symbolic else None
        require(name not in symbols or symbolic, f"the name {name!r} is used twice")
        if value is not None:
            symbols[name] = ring.constant(value)
    if weight is not None and not symbolic:
        require(weight > 0 and "weight" not in symbols, "the weight must be positive, and no parameter")
        symbols["weight"] = ring.constant(weight)
    entries = dict(zip(INERTIA, _upper(J, ring, symbols), strict=True))
    symbols.update(entries)
    table = [[entries[f"J{min(i, j)}{max(i, j)}"] for j in (1, 2, 3)] for i in (1, 2, 3)]
    return Loop(ring, states, signals, table, symbols)


def require_names(names: Sequence[str]) -> None:
    """Refuse names with a meaning of their own, and what is no name and would read as words of a claim."""
    for name in names:
        require(name.isidentifier() and len(name) <= 60, f"{name[:60]!r} is no name for a symbol")
        require(
            name not in RESERVED and not TARGET.fullmatch(name),
            f"the name {name!r} has a meaning of its own",
        )


def _upper(J: Matrix | None, ring: Ring, symbols: dict[str, Poly]) -> list[Poly]:
    if J is None:
        return [symbols[name] for name in INERTIA]
    return [ring.constant(J[i][j]) for i in range(3) for j in range(i, 3)]


def law_polynomials(law: Node) -> dict[str, dict[Exponents, Fraction]]:
    """Return torque and controller rates of a law as polynomials, and its lists of names, for comparison."""
    result = {str(i): p.terms for i, p in enumerate(law_values(law))}
    return result | {f"{key} {name}": {} for key, names in _law_names(law).items() for name in names}


def same_law(left: object, right: object) -> bool:
    """Whether two laws, as certificates hold them, have the same torque and rates as polynomials."""
    try:
        first, second = (law_polynomials(Node(law, "law")) for law in (left, right))
    except (Invalid, LookupError):
        return False
    return first == second


def _law_names(law: Node) -> dict[str, tuple[str, ...]]:
    keys = ("parameters", "states", "signals")
    return {key: tuple(node.text() for node in law[key].items()) for key in keys}


def law_values(law: Node) -> list[Poly]:
    """Return torque and controller rates of a law as polynomials in the symbols that laws may use."""
    lists = _law_names(law)
    timed = [f"{name}{end}" for name in lists["signals"] for end in ("", "_rate")]
    require_names([*lists["states"], *timed, *lists["parameters"]])
    names = ["b0", *ATTITUDE, "w1", "w2", "w3", *lists["states"], "g", "g_rate", *timed]
    names += [*lists["parameters"], *INERTIA]
    ring = Ring(names, [name for name in names if name == "R" or name in lists["parameters"]])
    values = run(law["program"], ring, {name: ring.symbol(name) for name in names})
    places = [*law["torque"].items(), *(law["rates"][name] for name in lists["states"])]
    return [pick(values, place) for place in places]


@dataclass(frozen=True)
class Motion:
    """The closed loop in the coordinates (c, b, y): w, the rates of everything but y, and J y'."""

    rate: Triple
    torque: Triple
    rates: dict[str, Poly]
    momentum: Triple


def move(loop: Loop, law: Node, shift: Triple) -> Motion:
    """Derive the motion for y = w + shift from the law and the equations of the rigid body.

    b0' = -bv.w/2, bv' = (b0 w + bv x w)/2, J w' = -w x J w + g u: these three lines are the
    checker's own.
    """
    ring, symbols = loop.ring, loop.symbols
    w = [ring.symbol(name) - shift[i] for i, name in enumerate(RATE)]
    known = {name: value for name, value in symbols.items() if name not in ("k_target", "weight")}
    control = run(law["program"], ring, known | {f"w{i + 1}": w[i] for i in range(3)})
    torque = [pick(control, place) for place in law["torque"].items()]
    require(len(torque) == 3, "the torque must have three components")
    b, b0 = [ring.symbol(name) for name in ATTITUDE], symbols["b0"]
    turn = cross(b, w)
    rates = {"c": total([b[i] * w[i] for i in range(3)], ring).scaled(Fraction(1, 2))}
    rates |= {ATTITUDE[i]: (b0 * w[i] + turn[i]).scaled(Fraction(1, 2)) for i in range(3)}
    rates |= {name: pick(control, law["rates"][name]) for name in loop.states}
    rates |= {name: symbols[f"{name}_rate"] for name in ("g", *loop.signals)}
    gyro = cross(w, apply(loop.J, w, ring))
    momentum = [symbols["g"] * torque[i] - gyro[i] for i in range(3)]
    shift_rate = apply(loop.J, [along(p, rates) for p in shift], ring)
    momentum = [on_sphere(momentum[i] + shift_rate[i]) for i in range(3)]
    return Motion(w, torque, rates, momentum)


def along(p: Poly, rates: dict[str, Poly]) -> Poly:
    """Return the derivative of a polynomial that is free of y."""
    return total([p.derivative(name) * rate for name, rate in rates.items() if p.uses(name)], p.ring)
